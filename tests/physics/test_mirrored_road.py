"""A symmetric car on a mirrored road in MuJoCo: its mirrored motion, with an error of first order."""

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal

SYMMETRIC = [
    "engine.hardpoints.linear_mount=[0.68, -0.46, 1.05]",
    "engine.bushings.linear_mount.stiffness=[2e5, 2e5, 2.5e5]",
    "engine.bushings.linear_mount.damping=[400.0, 400.0, 200.0]",
    "engine.bushings.linear_mount.maxwell_stiffness=1e5",
    "engine.bushings.linear_mount.maxwell_damping=2000.0",
]
"""The sedan with the engine mount of its right side on both sides: no other part of it is asymmetric."""

OTHER = {"fr": "fl", "fl": "fr", "rr": "rl", "rl": "rr"}


def mirror_errors(car: Car) -> dict[str, float]:
    """Return the RMS difference between a run and the mirror image of the run on the mirrored road, over the RMS."""
    wheels = car.vehicle.wheels
    signals = [
        random_road(rms=2e-3, seed=seed, wheel="fr", duration=1.0, taper_length=0.2) for seed in range(len(wheels))
    ]
    time = signals[0].time
    displacement = {wheel: signal.displacement["fr"] for wheel, signal in zip(wheels, signals, strict=True)}
    run = car.run(Signal(time=time, displacement=displacement))
    mirrored = {OTHER[wheel]: height for wheel, height in displacement.items()}
    image = car.run(Signal(time=time, displacement=mirrored))
    errors = {}
    for wheel, other in OTHER.items():
        for axis, sign in (("x", 1.0), ("y", -1.0), ("z", 1.0)):
            own, seen = run[f"knuckle_{wheel}_acc_{axis}"], image[f"knuckle_{other}_acc_{axis}"]
            errors[f"{wheel}_{axis}"] = float(np.std(own - sign * seen) / np.std(own))
    return errors


def test_mujoco_mirrors_with_an_error_of_first_order():
    """Its gyroscopic and centrifugal forces are late by half a step, differently on the sides of the tree of bodies."""
    coarse, fine = (mirror_errors(Car.load("sedan", [*SYMMETRIC, f"solver.timestep={step}"])) for step in (1e-3, 5e-4))
    assert max(coarse.values()) < 2.5e-3
    # Between two steps a pure first order is a ratio of 2; second order is 4.
    order = [float(np.log2(coarse[name] / fine[name])) for name in coarse]
    assert np.mean(order) == pytest.approx(1.0, abs=0.2)
