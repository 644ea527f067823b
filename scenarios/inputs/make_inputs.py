"""Write the shipped inputs: `python -m scenarios.inputs.make_inputs [--output DIR]`."""

import argparse
from pathlib import Path

from scenarios.signals.bump import BUMP_START_S, NOISE_RMS, NOISE_SEED, bump
from scenarios.signals.four_post import HIGHEST_HZ, LOWEST_HZ, ROAD_CLASS, SPEED_KMH, four_post
from scenarios.signals.four_post import SEED as FOUR_POST_SEED
from scenarios.signals.random_road import random_road
from vehicle.signals.excitation.band import (
    LOWEST_FREQUENCY_HZ,
    SHAKER_EDGE_HZ,
    SHAKER_ROLL_OFF_ORDER,
    UPPER_BAND_EDGE_HZ,
)
from vehicle.signals.excitation.input_files import INPUT_FOLDER, find_input
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.excitation.signal_file import read_signal, write_signal

LEVELS = {"low": 1.06e-4, "mid": 3.17e-4, "high": 5.25e-4}
"""RMS of the displacement [m] (thesis sections 3.2 and 3.3)."""

HEIGHTS = {"bump_1p5mm": 1.5e-3, "bump_7p5mm": 7.5e-3}
"""Peak height of the bump [m] (thesis section 3.2.2), A of the printed formula read as height."""

SEED = 2006
"""One seed for all levels: the same road, scaled. The year of the source; not chosen for any result."""

FRAME = "frame: z up, positive displacement lifts the plate; SI units; made by: python -m scenarios.inputs.make_inputs"


FOUR_POST = {
    "heave": "all four plates alike",
    "pitch": "front plates against rear plates",
    "roll": "right plates against left plates",
    "warp": "plates of one diagonal against those of the other",
    "four_plates": "four plates that move independently of each other, for FRFs to each",
}
"""Inputs of a four-post rig, and how their plates move."""

QUICK_DURATION = 5.0
"""Length of the signals with --quick [s]."""


def level_signal(level: str, wheel: str, *, quick: bool) -> Signal:
    """Return the shipped input of a level, or a short input of the same spectrum and level."""
    if not quick:
        return read_signal(find_input(f"{level}.csv"), wheel=wheel)
    return random_road(
        rms=LEVELS[level],
        seed=SEED,
        duration=QUICK_DURATION,
        wheel=wheel,
        lower_band_edge=SHAKER_EDGE_HZ,
        roll_off_order=SHAKER_ROLL_OFF_ORDER,
    )


def make_inputs() -> dict[str, tuple[Signal, list[str]]]:
    """Return name to signal and comments of every shipped input file."""
    band = (
        f"{SHAKER_EDGE_HZ:g} to {UPPER_BAND_EDGE_HZ:g} Hz (lower edge Butterworth of order {SHAKER_ROLL_OFF_ORDER}, "
        f"lines from {LOWEST_FREQUENCY_HZ:g} Hz)"
    )
    inputs: dict[str, tuple[Signal, list[str]]] = {}
    for name, rms in LEVELS.items():
        signal = random_road(
            rms=rms, seed=SEED, wheel="fl", lower_band_edge=SHAKER_EDGE_HZ, roll_off_order=SHAKER_ROLL_OFF_ORDER
        )
        inputs[name] = (
            signal,
            [
                f"{name}: random displacement of the plate under the wheel on the shaker, constant velocity PSD "
                "(displacement PSD ~ 1/f^2)",
                f"RMS {rms:.2e} m (exact), band {band}, seed {SEED}, {signal.duration:g} s at 1000 Hz",
                "begins and ends at rest (half cosine of 0.5 s at both ends); low, mid and high are one signal, scaled",
                FRAME,
            ],
        )
    for name, height in HEIGHTS.items():
        signal = bump(amplitude=height, wheel="fl")
        inputs[name] = (
            signal,
            [
                f"{name}: x = A/2 (1 - cos(6 pi (t - {BUMP_START_S:g} s))), one period, peak height A = {height:.1e} m",
                f"plus random noise, RMS {NOISE_RMS:.0e} m before and after the bump, constant velocity PSD "
                f"{band}, seed {NOISE_SEED}, {signal.duration:g} s at 1000 Hz",
                FRAME,
            ],
        )
    for name, how in FOUR_POST.items():
        signal = four_post(name)
        inputs[name] = (
            signal,
            [
                f"{name}: random displacement of {how}, constant velocity PSD",
                f"RMS {1e3 * signal.rms('fr'):.3f} mm of each plate: class {ROAD_CLASS} of ISO 8608 at {SPEED_KMH:g} "
                f"km/h, band {LOWEST_HZ:g} to {HIGHEST_HZ:g} Hz, seed {FOUR_POST_SEED}, {signal.duration:g} s at "
                f"{1.0 / signal.timestep:g} Hz",
                "begins and ends at rest (half cosine of 0.5 s at both ends)",
                FRAME,
            ],
        )
    return inputs


def main() -> None:
    """Write all files and print their names."""
    parser = argparse.ArgumentParser(
        prog="python -m scenarios.inputs.make_inputs", description="Write the shipped inputs."
    )
    parser.add_argument("--output", type=Path, default=INPUT_FOLDER, help="folder for the CSV files")
    folder: Path = parser.parse_args().output
    folder.mkdir(parents=True, exist_ok=True)
    for name, (signal, comments) in make_inputs().items():
        write_signal(folder / f"{name}.csv", signal, comments, plain=True)
        print(f"{folder / name}.csv: RMS {signal.rms(signal.wheels[0]):.6e} m, {signal.duration:g} s")


if __name__ == "__main__":
    main()
