"""Both engines on roads with rolling tyres: what is odd in the road agrees, what is even are products of motions.

Of a road and the same road upside down, half the difference of two histories holds all that is linear and the
friction; half their sum holds what is of second order in the motion, as the present wheel load on a slope or an arm
that swings. The reduced engine knows the load, and not the arms.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import numpy.typing as npt
import pytest

from vehicle.car import Car
from vehicle.excitation.iso_road import CLASSES, IsoRoad, Side, drive
from vehicle.excitation.signal import Signal
from vehicle.reduced.run import simulate_reduced

Vector = npt.NDArray[np.float64]

SPEED, SKIP = 80.0 / 3.6, 1000


def road(car: Car, level: float, duration: float) -> Signal:
    """A road for all wheels of a car, with tracks of 1.5 m."""
    foremost = min(wheel.center[0] for wheel in car.vehicle.composition.wheels)
    wheels: dict[str, tuple[float, Side]] = {
        wheel.name: (wheel.center[0] - foremost, "right" if wheel.side > 0.0 else "left")
        for wheel in car.vehicle.composition.wheels
    }
    return drive(IsoRoad(level=level, seed=1, track=1.5, patch=0.1), speed=SPEED, wheels=wheels, duration=duration)


def histories(car: Car, signal: Signal, engine: str) -> dict[str, Vector]:
    """Accelerations after the rise of the road."""
    run = car.run(signal, engine=engine)
    return {name: run[name][SKIP:] for name in car.vehicle.acceleration_channels}


def rms(values: Vector) -> float:
    return float(np.std(values))


@pytest.mark.parametrize(("name", "level"), [("sedan", "B"), ("focus_road", "A")])
def test_engines_differ_by_products_of_motions_alone(name: str, level: str) -> None:
    car = Car.load(name, [f"driving.speed={SPEED}", "solver.timestep=0.0005"])
    signal = road(car, CLASSES[level], 2.5)
    down = replace(signal, displacement={wheel: -z for wheel, z in signal.displacement.items()})
    few, whole = ([histories(car, one, engine) for one in (signal, down)] for engine in ("reduced", "mujoco"))
    worst: dict[str, list[tuple[float, str]]] = {"odd": [], "level": [], "even": []}
    for channel, own in whole[0].items():
        odd, even = ([0.5 * (run[0][channel] + sign * run[1][channel]) for run in (few, whole)] for sign in (-1.0, 1.0))
        worst["odd"].append((rms(odd[0] - odd[1]) / rms(own), channel))
        worst["level"].append((abs(rms(odd[0]) / rms(odd[1]) - 1.0), channel))
        worst["even"].append((rms(even[0] - even[1]) / rms(own), channel))
    print(name, level, {kind: sorted(values, reverse=True)[:6] for kind, values in worst.items()})
    assert pairwise
    assert simulate_reduced
    assert SKIP < 0
