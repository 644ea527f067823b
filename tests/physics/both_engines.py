"""A car on a road of class B in both engines: RMS of channels over MuJoCo, and the energy balance of MuJoCo."""

import numpy as np

from tests.validation import validated
from vehicle.runs.car import Road


def compare_engines(car, channels, *, rms, energy, subject="Reduced engine"):
    """Check the RMS of channels and the energy balance, under the names of both rows of the validation page."""
    road = Road("B", speed=60, duration=5, period="record")
    stepped, run = (car.run(road, engine=engine) for engine in ("mujoco", "reduced"))
    validated(
        subject, rms, np.squeeze([np.std(run[each]) / np.std(stepped[each]) for each in channels]), 1.0, abs=2e-3,
        source="second derivation: time integration in MuJoCo",
    )  # fmt: skip
    energies = stepped.recording.statistics.energies
    assert energies is not None
    validated(
        "Bushings, springs and stops", energy, energies.residual, 0.0, abs=3e-4, source="conservation: energy balance"
    )
