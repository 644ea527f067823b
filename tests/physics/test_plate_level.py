"""A record of the plates that begins at another height than zero: the car stands settled at the first sample."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal

LEVELS = {"fr": 0.012, "fl": -0.004}
CHANNELS = ["knuckle_fr_acc_z", "seat_rail_acc_z", "tyre_fr_force_z"]


@pytest.mark.parametrize("engine", ["mujoco", "reduced"])
def test_a_level_of_the_plates_does_not_change_the_run(high_piece, engine):
    car = Car.load("focus")
    plates = {"fr": high_piece.displacement["fr"], "fl": 0.5 * high_piece.displacement["fr"][::-1]}
    plates = {wheel: z - z[0] for wheel, z in plates.items()}
    records = [
        Signal(time=high_piece.time, displacement={wheel: z + share * LEVELS[wheel] for wheel, z in plates.items()})
        for share in (0.0, 1.0)
    ]
    level, lifted = (car.run(record, engine=engine, channels=CHANNELS) for record in records)
    for channel in CHANNELS:
        # At rest at the first sample, too: a step of 12 mm would be 25 m/s2 at the knuckle.
        exact = np.asarray(level[channel])
        validated(
            "Reduced engine" if engine == "reduced" else "Integration in MuJoCo",
            f"largest difference of {channel} over its peak, plates lifted by 12 and -4 mm, {engine}",
            np.max(np.abs(np.asarray(lifted[channel]) - exact)) / np.max(np.abs(exact - exact[0])), 0.0, abs=1e-7,
            source="conservation: accelerations do not depend on the height at which the car stands",
        )  # fmt: skip


@pytest.mark.parametrize("engine", ["mujoco", "reduced"])
def test_a_plate_at_a_constant_level_does_not_count_as_moving(high_piece, engine):
    z = high_piece.displacement["fr"][:200]
    signal = Signal(time=high_piece.time[:200], displacement={"fr": z - z[0], "fl": np.full(200, 0.005)})
    run = Car.load("focus").run(signal, engine=engine, channels=["seat_rail_acc_z"])
    assert run.recording.excited == ("fr",)
