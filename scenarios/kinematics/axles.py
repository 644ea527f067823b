"""Axles on the rig: curves over travel, slopes, compliance; the same with one point moved."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from vehicle.engines.kinematics.axle_curves import SMALL, design_slopes, travel_curve
from vehicle.engines.kinematics.axle_statics import WheelPose
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.paths import value_of
from vehicle.runs.car import Car
from vehicle.runs.car.axle import axle_statics

FORCE = 1000.0
"""Force at each contact point for compliance [N]."""

LEAST_GAIN = 1.0
"""Change of the toe slope that counts [deg/m2]: 0.001 deg per 100 mm for 10 mm."""

POINT = "front.hardpoints.tie_inner.z"
"""Default coordinate that is moved."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Axle:
    """Kinematics and compliance of an axle of a car, as measured on the rig."""

    label: str  # name of the car and of the axle
    template: str  # template of the axle
    equal: list[WheelPose]  # equal, opposite: poses of the right wheel over equal and opposite travel of both wheels
    opposite: list[WheelPose]
    slopes: dict[str, float | None]  # slopes, rolling: slopes in the design position over equal and opposite travel
    rolling: dict[str, float | None]
    from_spring: float  # wheel rate of the spring with ideal joints, k i^2 + F di/dz [N/m]; nan for a spring on a slide
    across: WheelPose  # across, along: pose under a force to the right and to the rear on both wheels
    along: WheelPose


def measured(car: Car, name: str, travels: Sequence[float]) -> Axle:
    """Measure all curves of an axle of a car, given by name, over travels of the right wheel [m]."""
    statics = axle_statics(car, name, ideal=False)
    pushed = [statics.solve([0.0, 0.0], np.array([force] * 2))[0] for force in FORCE * np.eye(6)[[1, 0]]]
    ideal, from_spring = axle_statics(car, name, ideal=True), math.nan
    if spring := next(iter(statics.parts.springs), None):
        low, design, high = (ideal.solve([z, z])[0].strut_length_m for z in (-SMALL, 0.0, SMALL))
        ratio, bend = (high - low) / (2.0 * SMALL), (high - 2.0 * design + low) / SMALL**2
        # Virtual work: the load of the wheel is the pull of the spring times dL/dz.
        force, rate = spring.pull(0.0)
        from_spring = rate * ratio**2 - force * bend
    return Axle(
        label=f"{car.vehicle.name}, {name}",
        template=str(car.vehicle.table[name]["template"]),
        equal=travel_curve(statics, travels),
        opposite=travel_curve(statics, travels, opposite=True),
        slopes=design_slopes(statics),
        rolling=design_slopes(statics, opposite=True),
        from_spring=from_spring,
        across=pushed[0],
        along=pushed[1],
    )


def axles_of(cars: Sequence[Car], travels: Sequence[float]) -> list[Axle]:
    """Measure every axle with wheels; an axle with the same table in several cars is measured once."""
    axles, seen = [], []
    for car in cars:
        for name in dict.fromkeys(wheel.axle for wheel in car.vehicle.composition.wheels):
            if car.vehicle.table[name] not in seen:
                seen.append(car.vehicle.table[name])
                axles.append(measured(car, name, travels))
    return axles


@dataclass(frozen=True, kw_only=True, slots=True)
class Moved:
    """An axle with one coordinate of a point moved."""

    label: str  # car
    shifts: tuple[float, ...]  # of the coordinate [m], ascending, 0 in the middle
    curves: list[list[WheelPose]]  # poses over equal travel for each
    toe_slopes: tuple[float, ...]  # dtoe/dz in the design position for each [deg/m]
    closed_form: float  # d(toe slope)/d(shift) [deg/m2]; nan where the point is not the height of a tie rod's inner end

    @property
    def gain(self) -> float:
        """Return the change of the toe slope with the shift [deg/m2]."""
        return (self.toe_slopes[-1] - self.toe_slopes[0]) / (self.shifts[-1] - self.shifts[0])

    @property
    def neutral(self) -> float:
        """Return the shift for constant toe over small travel [m]; nan for a point without effect on toe."""
        steers = abs(self.gain) > LEAST_GAIN
        return -self.toe_slopes[len(self.shifts) // 2] / self.gain if steers else math.nan


def bump_steer_gain(car: Car, axle: str, path: str) -> float:
    """Return the change of the slope of toe per height of the inner end of the tie rod [deg/m2].

    The rod keeps its length: with the inner end higher by d, its outer end, which rises by dz, must give way by
    d dz / s, s = (O - I) . (k x (O - A)): the knuckle turns about its steering axis k through the lower ball A.
    """
    wheel_names = {wheel.axle: wheel.name for wheel in car.vehicle.composition.wheels if wheel.side > 0.0}[axle]
    names = ("tie_outer", "tie_inner", "lower_ball", "strut_top")
    if path != f"{axle}.hardpoints.tie_inner.z" or any(
        f"{name}_{wheel_names}" not in car.vehicle.points for name in names
    ):
        return math.nan
    outer, inner, ball, top = (np.array(car.vehicle.points[f"{name}_{wheel_names}"]) for name in names)
    axis = (top - ball) / np.linalg.norm(top - ball)
    return float(np.degrees(axis[2] / ((outer - inner) @ np.cross(axis, outer - ball))))


def moved_axles(files: Sequence[Path], path: str, shift: float, travels: Sequence[float]) -> list[Moved]:
    """Measure the axles of all cars with a point, with its coordinate lower, unchanged and higher."""
    axle, labels, seen = path.partition(".")[0], [], []
    shifts = (-shift, 0.0, shift)
    for file in files:
        car = Car.load(file)
        if axle not in car.vehicle.table or car.vehicle.table[axle] in seen:
            continue
        seen.append(car.vehicle.table[axle])
        try:
            old = value_of(car.vehicle, path)
        except ConfigurationError:
            continue
        cars = [car if not step else Car.load(file, [f"{path}={old + step!r}"]) for step in shifts]
        statics = [axle_statics(entry, axle, ideal=False) for entry in cars]
        labels.append(
            Moved(
                label=car.vehicle.name,
                shifts=shifts,
                curves=[travel_curve(entry, travels) for entry in statics],
                toe_slopes=tuple(float(design_slopes(entry)["toe_deg_per_m"] or 0.0) for entry in statics),
                closed_form=bump_steer_gain(car, axle, path),
            )
        )
    if not labels:
        raise ConfigurationError(f"--point {path}: no car has it; give the coordinate of a hardpoint, as {POINT}")
    return labels
