"""Position and loads of a car in steady acceleration: pitch, roll, travel and load of each wheel, anti-dive.

Signs of ISO 8855: pitch with the nose down and roll with the right side down are positive. The support of an axle is
the share of its linkage in the load transfer m a h / l (Milliken, Race Car Vehicle Dynamics, chapter 17),

    100 s tan(angle) l / h,    and the travel that it takes from the springs of a wheel: X tan(angle) / k,

with the share s of the axle in the brake or drive force, X of a wheel, the angle of the line to the swing centre in the
side view (from the contact for brakes and for motors in the wheels, from the wheel centre for drive by shafts), and the
wheel rate k, all in the design position. Pitch, roll and travel come from the equilibrium of the whole car.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from vehicle.engines.simulation.steady_positions import steady_positions
from vehicle.model.parameters.driving import driven_wheels
from vehicle.model.parameters.placed_force import DRIVING
from vehicle.runs.car.axle_data import AxleData


@dataclass(frozen=True, kw_only=True, slots=True)
class WheelInAcceleration:
    """Wheel of a car in steady acceleration.

    Attributes:
        name: name of the wheel.
        load_n, load_change_n: tyre load, and its difference from that at rest [N].
        travel_m: travel against the body from that at rest, compression positive [m].
        along_n, across_n: force of the road, forwards and to the left positive [N].
        friction: horizontal force over load [-].
    """

    name: str
    load_n: float
    load_change_n: float
    travel_m: float
    along_n: float
    across_n: float
    friction: float


@dataclass(frozen=True, kw_only=True, slots=True)
class AxleSupport:
    """Support of an axle by its linkage: anti-dive or anti-squat if positive, at the other end anti-lift.

    Attributes:
        name: name of the axle.
        percent: share of the load transfer that the linkage carries [%].
        travel_m: travel that it takes from the springs of a wheel [m].
    """

    name: str
    percent: float
    travel_m: float


@dataclass(frozen=True, kw_only=True, slots=True)
class SteadyData:
    """Car in steady acceleration.

    Attributes:
        acceleration, lateral: acceleration of the car [m/s2], forwards and to the left positive.
        pitch_deg, roll_deg: angles of the body, nose down and right side down positive.
        wheels: its wheels.
        supports: supports of its axles; empty in a bend at constant speed.
    """

    acceleration: float
    lateral: float
    pitch_deg: float
    roll_deg: float
    wheels: tuple[WheelInAcceleration, ...]
    supports: tuple[AxleSupport, ...]


def steady_data(car: Any, still: Any, axles: Sequence[AxleData], cog_height: float) -> SteadyData | None:
    """Compute the data of a car in steady acceleration; None for a car at rest.

    Args:
        car: the car.
        still: the same car at rest.
        axles: data of its axles at rest.
        cog_height: height of its centre of gravity above the ground at rest [m].
    """
    driving, placed = car.vehicle.driving, {wheel.name: wheel for wheel in car.vehicle.composition.wheels}
    if not driving.accelerates:
        return None
    frame, positions = steady_positions(car.model)
    wheels = [
        WheelInAcceleration(
            name=name,
            load_n=z,
            load_change_n=z - still.static.tyre_load[name],
            travel_m=travel,
            along_n=-x,
            across_n=-y,
            friction=math.hypot(x, y) / z,
        )
        for name, (travel, x, y, z) in positions.items()
    ]
    supports = []
    if driving.acceleration:
        shares, wheelbase = driven_wheels(driving, placed.values()), abs(axles[1].x_m - axles[0].x_m)
        along = {wheel.name: abs(wheel.along_n) for wheel in wheels}
        torques = [force.name for force in car.vehicle.composition.forces if force.path == DRIVING]
        for axle in axles:
            wheel_name, geometry = axle.wheels[0], axle.geometry
            by_shafts = f"drive_{wheel_name}" in torques
            slope = math.tan(math.radians(geometry.drive_support_deg if by_shafts else geometry.brake_support_deg))
            supports.append(
                AxleSupport(
                    name=axle.name,
                    percent=100.0 * len(axle.wheels) * shares[wheel_name] * slope * wheelbase / cog_height,
                    travel_m=along[wheel_name] * slope / axle.wheel_rate_n_per_m,
                )
            )
    return SteadyData(
        acceleration=driving.acceleration,
        lateral=driving.lateral,
        # ISO 8855 has x to the front and y to the left.
        pitch_deg=math.degrees(math.asin(frame[2, 0])),
        roll_deg=math.degrees(math.atan2(-frame[2, 1], frame[2, 2])),
        wheels=tuple(wheels),
        supports=tuple(supports),
    )
