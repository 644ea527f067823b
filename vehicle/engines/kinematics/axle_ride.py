"""Ride parameters of an axle: wheel rate, ride rate, unsprung mass, ride frequency, damping ratio, roll stiffness.

The body is fixed. The wheels of the axle move by equal travel z, slowly, with bushings as they are and contact patches
that roll freely; index o: by opposite travel. Stuck dampers keep their length; sliding dampers have no rate.

    wheel rate      K_w = dF/dz of a wheel            (tangent in the design position)
    wheel damping   C_w = sum of c i_d^2, c = (F_d(v) - F_d(-v)) / 2 v at v = 0.1 m/s; 0 for stuck dampers
    damper ratio    i_d = damper travel per wheel travel
    ride rate       K_r = K_w K_t / (K_w + K_t)       (in series with the tyre, K_t and C_t)
    ride damping    C_r = (C_w K_t^2 + C_t K_w^2) / (K_w + K_t)^2
    unsprung mass   m_u = sum of m dz_m / dz / wheels (mass that rises with the wheels, z_m its height)
    spring load     N = F - m_u g                     (F: static wheel load)
    sprung mass     m_s = N / g
    ride frequency  f = sqrt(K_r / m_s) / 2 pi
    damping ratio   zeta = C_r / (2 sqrt(K_r m_s))
    roll stiffness  K_phi = K_o t_c t_p / 2           (tracks t_c of wheel centres, t_p of patches; without tyres)
    roll damping    C_phi = C_o t_c t_p / 2

By virtual work the springs carry N, so K_r and m_s belong together. The ride rate and the ride
damping are those of a wheel without mass between suspension and tyre: with s = j w, (K_w + s C_w) in series with
(K_t + s C_t) is K_r + s C_r to the first order in s.

Source: Gillespie, Fundamentals of Vehicle Dynamics, chapter 5 (ride rate, undamped natural frequency of the sprung
mass); Dixon, Tires, Suspension and Handling, section 5.12 (roll stiffness of an axle).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from vehicle.engines.kinematics.axle_curves import design_slopes, opposite_rates, position_rate
from vehicle.engines.kinematics.axle_statics import AxlePosition, AxleStatics
from vehicle.engines.simulation.car_model import CarModel
from vehicle.model.laws.damper import viscous_law
from vehicle.model.parameters.composition import PlacedWheel
from vehicle.model.parameters.force_elements import Damper

DAMPER_VELOCITY = 0.1
"""Damper velocity [m/s] at which a damper counts as a viscous constant: low-speed damping, which rules body motions."""

DamperState = Literal["stuck", "sliding"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Support:
    """Stiffness [N/m or N m/rad] with a damping constant [N s/m or N m s/rad] in parallel."""

    stiffness: float
    damping: float

    def in_series(self, other: Support) -> Support:
        """Return two supports in series without mass between them, to the first order in the frequency."""
        total = self.stiffness + other.stiffness
        return Support(
            stiffness=self.stiffness * other.stiffness / total,
            damping=(self.damping * other.stiffness**2 + other.damping * self.stiffness**2) / total**2,
        )

    def times(self, factor: float) -> Support:
        """Return several equal supports in parallel, or a support on a lever of the length sqrt(factor)."""
        return Support(stiffness=factor * self.stiffness, damping=factor * self.damping)

    def frequency(self, mass: float) -> float:
        """Return the undamped natural frequency of a mass or inertia [Hz]; nan without positive numbers."""
        return _root(self.stiffness / mass) / (2.0 * math.pi)

    def damping_ratio(self, mass: float) -> float:
        """Return the damping ratio of a mass or inertia [-]; nan without positive numbers."""
        critical = 2.0 * _root(self.stiffness * mass)
        return self.damping / critical if critical else math.nan


@dataclass(frozen=True, kw_only=True, slots=True)
class AxleRide:
    """Ride parameters of one wheel of an axle; see the equations of this module.

    Attributes:
        wheel, tyre: rate and damping of the suspension at the wheel, and of the tyre.
        unsprung_mass, sprung_mass: of one wheel [kg]; the sprung mass is nan without gravity.
        spring_load: N of one wheel [N].
        roll_springs: roll stiffness of the axle by springs, bushings and preloads [N m/rad].
        roll_bars: roll stiffness of the axle by springs on hinges between the sides [N m/rad].
        roll_damping: C_phi [N m s/rad].
        track: distance of the patches [m].
    """

    wheel: Support
    tyre: Support
    unsprung_mass: float
    sprung_mass: float
    spring_load: float
    roll_springs: float
    roll_bars: float
    roll_damping: float
    track: float

    @property
    def ride(self) -> Support:
        """Ride rate and ride damping of a wheel."""
        return self.wheel.in_series(self.tyre)

    @property
    def ride_frequency(self) -> float:
        """Undamped natural frequency of the sprung mass [Hz]; nan if its rate or its mass is not positive."""
        return self.ride.frequency(self.sprung_mass)

    @property
    def damping_ratio(self) -> float:
        """Damping ratio of the sprung mass on ride rate and ride damping [-]."""
        return self.ride.damping_ratio(self.sprung_mass)

    @property
    def roll(self) -> Support:
        """Return the roll stiffness and roll damping of the axle without the tyres."""
        return Support(stiffness=self.roll_springs + self.roll_bars, damping=self.roll_damping)

    @property
    def tyre_roll(self) -> Support:
        """Return the roll stiffness and roll damping of the tyres, K_t t_p^2 / 2."""
        return self.tyre.times(0.5 * self.track**2)


def axle_ride(car: CarModel, axle: str, dampers: DamperState = "sliding", *, roll: bool = True) -> AxleRide:
    """Compute the ride parameters of an axle.

    Args:
        car: car in static equilibrium, with standing tyres.
        axle: table of the axle in the vehicle file, with two wheels.
        dampers: "stuck" or "sliding".
        roll: False leaves out roll stiffness and roll damping, which take most of the time; they are nan.

    Raises:
        SimulationError: the axle has no equilibrium near its design position.
    """
    wheels = [wheel for wheel in car.vehicle.composition.wheels if wheel.axle == axle]
    # Also with stuck dampers the mass that rises with the wheels is that of the axle that moves on its springs.
    free = AxleStatics(car.model, car.static.preload, wheels=wheels)
    equal = position_rate(free, [0.0] * len(wheels), opposite=False)
    opposite = position_rate(free, [0.0] * len(wheels), opposite=True) if roll else None
    stuck = dampers == "stuck"
    held = AxleStatics(car.model, car.static.preload, wheels=wheels, locked=True) if stuck else free
    springs, bars = opposite_rates(held) if roll else (math.nan, math.nan)
    load, gravity = _mean([car.static.tyre_load[wheel.name] for wheel in wheels]), car.vehicle.gravity
    unsprung = float(equal.mass_moment) / len(wheels)
    tracks = [float(np.ptp([getattr(wheel, point)[1] for wheel in wheels])) for point in ("center", "patch")]
    # Roll by phi: centres move by +-phi t_c/2, the couple of the wheel forces has the arm t_p.
    arm = 0.5 * tracks[0] * tracks[1]
    damping, roll_damping = (
        math.nan if motion is None else 0.0 if stuck else _wheel_damping(car, axle, free, motion)
        for motion in (equal, opposite)
    )
    return AxleRide(
        wheel=Support(stiffness=float(design_slopes(held)["wheel_rate_n_per_m"] or math.nan), damping=damping),
        tyre=_tyre(car, wheels),
        unsprung_mass=unsprung,
        sprung_mass=load / gravity - unsprung if gravity else math.nan,
        spring_load=load - unsprung * gravity,
        roll_springs=arm * springs,
        roll_bars=arm * bars,
        roll_damping=arm * roll_damping,
        track=tracks[1],
    )


def axle_rides(car: CarModel, dampers: DamperState = "sliding", *, roll: bool = True) -> dict[str, AxleRide]:
    """Compute the ride parameters of all axles with wheels, by the tables of the vehicle file; see `axle_ride`."""
    names = dict.fromkeys(wheel.axle for wheel in car.vehicle.composition.wheels)
    return {name: axle_ride(car, name, dampers, roll=roll) for name in names}


def _wheel_damping(car: CarModel, axle: str, statics: AxleStatics, motion: AxlePosition) -> float:
    """Return the sum of c i_d^2 of the dampers of an axle for a motion of its wheels, per wheel [N s/m]."""
    ratios = {
        str(car.model.joint(strut.joint).name): float(ratio)
        for strut, ratio in zip(statics.parts.struts, motion.dampers, strict=True)
    }
    total = 0.0
    for damper in car.vehicle.composition.dampers:
        if damper.path.split(".")[0] == axle:
            total += damper_constant(damper.law) * ratios[damper.joint] ** 2
    return total / len(statics.wheels)


def damper_constant(law: Damper) -> float:
    """Return (F_d(v) - F_d(-v)) / 2 v at `DAMPER_VELOCITY`, the mean of bump and rebound, without friction [N s/m]."""
    rebound, bump = viscous_law(law).force(np.array([DAMPER_VELOCITY, -DAMPER_VELOCITY]))
    return float(rebound - bump) / (2.0 * DAMPER_VELOCITY)


def _tyre(car: CarModel, wheels: Sequence[PlacedWheel]) -> Support:
    """Return the mean vertical stiffness and damping of the tyres of some wheels."""
    laws = {link.carrier: link.law for link in car.vehicle.composition.connections if link.ground}
    tyres = [law for wheel in wheels if (law := laws[wheel.plate]) is not None]
    return Support(
        stiffness=_mean([law.stiffness[2] for law in tyres]), damping=_mean([law.damping[2] for law in tyres])
    )


def _mean(values: Sequence[float]) -> float:
    return float(np.mean(values))


def _root(value: float) -> float:
    return math.sqrt(value) if value > 0.0 else math.nan
