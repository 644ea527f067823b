"""Curves, slopes and geometry of an axle on a kinematics rig: over wheel travel, in the design position, under load."""

import math
from collections.abc import Sequence
from dataclasses import fields, replace

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.kinematics.axle_statics import AxlePosition, AxleStatics, WheelPose
from vehicle.engines.kinematics.wheel_geometry import WheelGeometry, WheelMotion, wheel_geometry
from vehicle.errors import SimulationError
from vehicle.model.parameters.composition import PlacedWheel

SMALL = 1e-3
"""Travel [m] to both sides for the central differences of the slopes in the design position."""

STEP = 1e-4
"""Travel [m] to both sides for the velocities of the wheels: truncation below 1e-7, round-off below 1e-6."""

SLOPES = {
    "load_n": "wheel_rate_n_per_m",
    "camber_deg": "camber_deg_per_m",
    "toe_deg": "toe_deg_per_m",
    "lateral_m": "lateral_per_m",
    "patch_lateral_m": "patch_lateral_per_m",
    "strut_length_m": "spring_ratio",
}
"""Names of the slopes over the wheel travel, by the field of `WheelPose`."""


def travel_curve(
    axle: AxleStatics, travels: Sequence[float], *, opposite: bool = False, load: Vector | None = None
) -> list[WheelPose]:
    """Compute the poses of the right wheel over its travel.

    Args:
        axle: axle with two wheels, right and left.
        travels: ascending travels of the right wheel [m], upwards positive.
        opposite: True to move the left wheel by the negative travel and to reverse its load.
        load: force [N] and moment [N m] on each wheel at its contact point, in the axes of the car, (6,).

    Raises:
        SimulationError: the axle has no equilibrium at a travel; see `AxleStatics.solve`.
    """
    loads = _loads(opposite, load)
    poses = {z: axle.solve(_travels(z, opposite), loads)[0] for z in _outwards(travels)}
    return [poses[z] for z in travels]


def design_slopes(axle: AxleStatics, *, opposite: bool = False, load: Vector | None = None) -> dict[str, float | None]:
    """Compute slopes over the wheel travel in the design position, by central differences over 1 mm.

    Args:
        axle, opposite, load: see `travel_curve`.

    Returns:
        Slope by the names in `SLOPES`; None for a quantity that is not defined with ideal joints.
    """
    loads = _loads(opposite, load)
    down, up = (axle.solve(_travels(z, opposite), loads)[0] for z in (-SMALL, SMALL))
    slopes = {name: (getattr(up, key) - getattr(down, key)) / (2.0 * SMALL) for key, name in SLOPES.items()}
    return {name: None if math.isnan(value) else value for name, value in slopes.items()}


def opposite_rates(axle: AxleStatics) -> tuple[float, float]:
    """Compute the wheel rate of an axle for opposite travel in two parts, both [N/m].

    Returns:
        Rate without springs on hinges, and what these add: an anti-roll bar, the torsion of a beam.

    Raises:
        SimulationError: see `AxleStatics.solve`.
    """
    parts, joints = axle.parts, axle.parts.joints
    both = design_slopes(axle, opposite=True)["wheel_rate_n_per_m"] or math.nan
    # The part of the springs on hinges is the difference of two solutions, with and without these springs.
    hinges = {joint for joint in joints if axle.model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE}
    if not hinges:
        return both, 0.0
    axle.parts = replace(parts, joints=tuple(joint for joint in joints if joint not in hinges))
    try:
        without = design_slopes(axle, opposite=True)["wheel_rate_n_per_m"] or math.nan
    finally:
        axle.parts = parts
    return without, both - without


def geometry_curve(
    axle: AxleStatics, travels: Sequence[float], *, towards: float, opposite: bool = False, load: Vector | None = None
) -> list[WheelGeometry]:
    """Compute the geometry of the right wheel over its travel; arguments and errors as in `travel_curve`.

    Args:
        axle, travels, opposite, load: see `travel_curve`.
        towards: +1 for a front axle, -1 for a rear axle; see `wheel_geometry`.
    """
    loads = _loads(opposite, load)
    geometry = {}
    for z in _outwards(travels):
        both = _travels(z, opposite)
        rolling, bouncing = (wheel_motions(axle, both, opposite=way, loads=loads) for way in (True, False))
        geometry[z] = wheel_geometry(rolling, bouncing, towards)
    return [geometry[z] for z in travels]


def design_axle(
    model: mujoco.MjModel, preload: Vector, wheels: Sequence[PlacedWheel], towards: float
) -> tuple[AxleStatics, WheelGeometry]:
    """Compute the geometry of an axle in the design position, with ideal joints where they let the wheels move.

    Args:
        model, preload, wheels: see `AxleStatics`.
        towards: see `geometry_curve`.

    Returns:
        The axle, with the bushings of the car (`AxleStatics.ideal` is False) if ideal joints would lock it; the
        geometry of its right wheel.

    Raises:
        SimulationError: see `AxleStatics.solve`.
    """
    axle = AxleStatics(model, preload, wheels=wheels, ideal=True)
    try:
        return axle, geometry_curve(axle, [0.0], towards=towards)[0]
    except SimulationError:
        axle = AxleStatics(model, preload, wheels=wheels)
        return axle, geometry_curve(axle, [0.0], towards=towards)[0]


def wheel_motions(
    axle: AxleStatics, travels: Sequence[float], *, opposite: bool, loads: Vector | None = None
) -> list[WheelMotion]:
    """Compute the velocities of both wheels of an axle per unit of travel of the right wheel.

    Args:
        axle: axle with two wheels, right and left.
        travels: travels of both wheels [m], upwards positive.
        opposite: True if the left wheel moves down where the right one moves up.
        loads: see `AxleStatics.solve`.

    Raises:
        SimulationError: see `AxleStatics.solve`.
    """
    rate = position_rate(axle, travels, opposite=opposite, loads=loads)
    axle.solve(travels, loads)
    now, motions = axle.position(), []
    for index, (centre, _) in enumerate(axle.at_rest):
        frame = now.frames[index]
        # dR/dz R' = [w]x per wheel travel; w is half of its skew part.
        turn = rate.frames[index] @ frame.T
        axis = None if np.isnan(now.steering_axes[index]).any() else now.steering_axes[index]
        motions.append(
            WheelMotion(
                side=float(np.sign(centre[1])),
                centre=now.centres[index],
                contact=axle.lowest_point(index),
                velocity=rate.centres[index],
                rotation=0.5 * np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]),
                steering_axis=axis,
            )
        )
    return motions


def position_rate(
    axle: AxleStatics, travels: Sequence[float], *, opposite: bool, loads: Vector | None = None
) -> AxlePosition:
    """Compute the derivative of the position of an axle by the travel of its right wheel, by central differences.

    Args:
        axle, travels, opposite, loads: see `wheel_motions`.

    Raises:
        SimulationError: see `AxleStatics.solve`.
    """
    ends = []
    for step in (-STEP, STEP):
        axle.solve([z + dz for z, dz in zip(travels, _travels(step, opposite), strict=True)], loads)
        ends.append(axle.position())
    names = [entry.name for entry in fields(AxlePosition)]
    return AxlePosition(**{key: (getattr(ends[1], key) - getattr(ends[0], key)) / (2.0 * STEP) for key in names})


def _outwards(travels: Sequence[float]) -> list[float]:
    """Return ascending travels from the design position down, then up: each solution begins at a neighbouring one."""
    return [*(z for z in travels[::-1] if z < 0.0), *(z for z in travels if z >= 0.0)]


def _travels(travel: float, opposite: bool) -> list[float]:
    """Return the travels of the right and the left wheel [m]."""
    return [travel, -travel if opposite else travel]


def _loads(opposite: bool, load: Vector | None) -> Vector | None:
    """Return the loads of the right and the left wheel, (2, 6)."""
    return None if load is None else np.array([load, -load if opposite else load])
