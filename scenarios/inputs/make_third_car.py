"""Write the shipped record of a worn damper: `python -m scenarios.inputs.make_third_car [--output DIR]`."""

import argparse
from pathlib import Path

import numpy as np
import scipy

from vehicle.runs.car import Car, Road
from vehicle.signals.formats.shipped_record import RECORD_FOLDER
from vehicle.signals.records.resampled import decimate

CHANGES = {
    "rear.left.damper.viscous": 600,
    "load.driver.mass": 75,
    "load.driver.at": "seat",
    "rear.bushings.tyre.stiffness.z": 2.3e5,
}
"""The third car in the workshop: a rear damper at 40 % of its 1500 N s/m, a driver, tyres of 1.05 times the
stiffness."""

SPEED, SECONDS, SETTLING, RATE = 80.0, 40.0, 4.0, 100.0
"""Speed [km/h], length of the record and of the drive before it [s], sampling rate [Hz]."""

TILT = (6.0, -4.0)
"""Phone on the seat rail: angles about its x and its y axis [deg]; y points forward, z upwards."""

NOISE, SPEED_NOISE = 0.02, 0.3
"""RMS noise of the accelerations [m/s2] and of the speed [km/h]."""


def main() -> None:
    """Write the record."""
    parser = argparse.ArgumentParser(
        prog="python -m scenarios.inputs.make_third_car", description="Write the shipped record of a drive."
    )
    parser.add_argument("--output", type=Path, default=RECORD_FOLDER, help="folder for the CSV file")
    folder: Path = parser.parse_args().output
    folder.mkdir(parents=True, exist_ok=True)
    drive = Road("C", SPEED, duration=SETTLING + SECONDS, seed=63, period="record")
    run = Car.load("sedan", CHANGES).run(drive, "reduced", channels=[f"seat_rail_acc_{axis}" for axis in "xyz"])
    rng, factor = np.random.default_rng(63), round(1.0 / (RATE * (run.time[1] - run.time[0])))
    x, y, z = (decimate(run[f"seat_rail_acc_{axis}"], factor)[int(SETTLING * RATE) :] for axis in "xyz")
    # x of the car points backwards and y to the right; the phone has y forward and x to the right.
    upright = np.array([y, -x, z + 9.80665])
    phone = scipy.spatial.transform.Rotation.from_euler("xy", TILT, degrees=True).as_matrix() @ upright
    phone += NOISE * rng.standard_normal(phone.shape)
    lines = [
        "# a drive of 40 s at 80 km/h, simulated: phone on the seat rail, y forward, nearly flat; the satellite speed",
        "# comes once a second. Made by: python -m scenarios.inputs.make_third_car",
        "Time [s],Acc X [m/s2],Acc Y [m/s2],Acc Z [m/s2],GPS speed [km/h]",
    ]
    for row, values in enumerate(phone.T[: int(SECONDS * RATE)]):
        fix = f"{SPEED + SPEED_NOISE * rng.standard_normal():.1f}" if row % int(RATE) == 0 else ""
        lines.append(f"{row / RATE:.2f},{','.join(f'{value:.3f}' for value in values)},{fix}")
    file = folder / "third_car.csv"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    print(f"{file}: {file.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
