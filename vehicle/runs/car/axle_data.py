"""Stiffnesses, masses and geometry of an axle of a car in its design position.

Rates, masses, ride frequency and roll stiffness are those of `vehicle.engines.kinematics.axle_ride`, for both wheels;
the roll stiffness of the tyres is K_t t_p^2 / 2, with the track t_p of the patches. Geometry and motion ratios are
those of ideal joints.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from vehicle.engines.kinematics.axle_curves import design_axle, design_slopes, position_rate
from vehicle.engines.kinematics.axle_ride import axle_ride
from vehicle.engines.kinematics.wheel_geometry import WheelGeometry
from vehicle.runs.car.axle import direction_to_middle


@dataclass(frozen=True, kw_only=True, slots=True)
class RollStiffness:
    """Roll stiffness of an axle [N m/rad]."""

    springs: float  # springs, bushings and preloads
    bars: float  # springs on hinges between the sides: anti-roll bar, torsion of a beam
    tyres: float  # tyres

    @property
    def suspension(self) -> float:
        """Springs and bars [N m/rad]."""
        return self.springs + self.bars

    @property
    def total(self) -> float:
        """Suspension and tyres in series [N m/rad]."""
        return self.suspension * self.tyres / (self.suspension + self.tyres)


@dataclass(frozen=True, kw_only=True, slots=True)
class AxleData:
    """Axle of a car in its design position; values of one wheel are those of the right one. None: not defined."""

    name: str  # table of the vehicle file
    template: str  # its template
    wheels: tuple[str, ...]  # names of the wheels
    x_m: float  # position of the wheel centres along the car [m]
    front: bool  # True for an axle in front of the centre of gravity
    track_m: float  # distance of the contact points [m]
    radius_m: float  # loaded radius [m]
    load_n: Mapping[str, float]  # static load by wheel [N]
    unsprung_kg: float  # unsprung mass of both wheels
    sprung_kg: float  # mass that the axle carries above its unsprung mass
    wheel_rate_n_per_m: float  # stiffness at the wheel without its tyre
    spring_n_per_m: float | None  # stiffness of the springs of one side in their static position
    spring_ratio: float | None  # compression of the spring per wheel travel [-]
    spring_at_wheel_n_per_m: float | None  # sum of k i^2 of the springs of one side
    damper_ratio: float | None  # compression of the damper per wheel travel [-]
    damper_n_s_per_m: float | None  # damping constant of the modes with sliding dampers: the smallest slope of the law
    tyre_n_per_m: float  # vertical stiffness of the tyre
    ride_rate_n_per_m: float  # wheel rate and tyre in series
    ride_frequency_hz: float | None  # undamped frequency of the sprung mass on the ride rate
    bump_steer_deg_per_m: float  # toe-in per wheel travel in the design position, with ideal joints
    roll: RollStiffness  # roll stiffness
    geometry: WheelGeometry  # roll centre, swing arms, support angles, steering axis
    # True if geometry and ratios are those of ideal joints; False if ideal joints lock the axle, so that its bushings
    # yield
    ideal: bool

    def __repr__(self) -> str:
        """One line."""
        return (
            f"AxleData({self.name}, {sum(self.load_n.values()):.0f} N, wheel rate "
            f"{1e-3 * self.wheel_rate_n_per_m:.2f} N/mm, roll centre {1e3 * self.geometry.roll_centre_height_m:.0f} mm)"
        )


def axle_data(car: Any, name: str) -> AxleData:
    """Compute the data of an axle.

    Args:
        car: the car, with standing tyres.
        name: table of the axle in the vehicle file.

    Raises:
        ConfigurationError: the table has no wheel.
        SimulationError: the axle has no equilibrium near its design position.
    """
    vehicle = car.vehicle
    wheels = [wheel for wheel in vehicle.composition.wheels if wheel.axle == name]
    right = wheels[0]
    loads = {wheel.name: float(car.static.tyre_load[wheel.name]) for wheel in wheels}
    ride = axle_ride(car.model, name)
    track = abs(wheels[0].patch[1] - wheels[1].patch[1])
    towards = direction_to_middle(car, name)
    moving, geometry = design_axle(car.model.model, car.model.static.preload, wheels, towards)
    motion = position_rate(moving, [0.0, 0.0], opposite=False)
    springs = [
        (spring.pull(0.0)[1], -float(ratio))
        for spring, ratio in zip(moving.parts.springs, motion.springs, strict=True)
        if right.side * moving.data.site_xpos[spring.lower][1] > 0.0
    ]
    dampers = [
        -float(ratio)
        for strut, ratio in zip(moving.parts.struts, motion.dampers, strict=True)
        if right.side * moving.data.xanchor[strut.joint][1] > 0.0
    ]
    own_damper = next(
        (damper for damper in vehicle.composition.dampers if damper.name.endswith(f"_{right.name}")), None
    )
    return AxleData(
        name=name,
        template=str(vehicle.table[name]["template"]),
        wheels=tuple(loads),
        x_m=right.center[0],
        front=towards > 0.0,
        track_m=track,
        radius_m=right.center[2] - right.patch[2],
        load_n=loads,
        unsprung_kg=len(wheels) * ride.unsprung_mass,
        sprung_kg=len(wheels) * ride.sprung_mass,
        wheel_rate_n_per_m=ride.wheel.stiffness,
        spring_n_per_m=sum(stiffness for stiffness, _ in springs) if springs else None,
        spring_ratio=springs[0][1] if springs else None,
        spring_at_wheel_n_per_m=sum(stiffness * ratio**2 for stiffness, ratio in springs) if springs else None,
        damper_ratio=dampers[0] if dampers else None,
        damper_n_s_per_m=None
        if own_damper is None
        else float(car.matrices.viscous[vehicle.composition.dampers.index(own_damper)]),
        tyre_n_per_m=ride.tyre.stiffness,
        ride_rate_n_per_m=ride.ride.stiffness,
        ride_frequency_hz=None if math.isnan(ride.ride_frequency) else ride.ride_frequency,
        bump_steer_deg_per_m=design_slopes(moving)["toe_deg_per_m"] or 0.0,
        roll=RollStiffness(springs=ride.roll_springs, bars=ride.roll_bars, tyres=ride.tyre_roll.stiffness),
        geometry=geometry,
        ideal=moving.ideal,
    )
