"""Ride parameters of an axle: wheel rate, ride rate, unsprung mass, ride frequency, damping ratio, roll stiffness.

The body is fixed. The wheels of the axle move by equal travel z, slowly, with bushings as they are and contact patches
that roll freely; K_o is the wheel rate over opposite travel:

    wheel rate      K_w = dF/dz of a wheel            (tangent in the design position)
    ride rate       K_r = K_w K_t / (K_w + K_t)       (in series with the tyre, K_t)
    unsprung mass   m_u = sum of m dz_m / dz / wheels (mass that rises with the wheels, z_m its height)
    sprung mass     m_s = F / g - m_u                 (F: static wheel load)
    ride frequency  f   = sqrt(K_r / m_s) / 2 pi
    damper ratio    i_d = damper travel per wheel travel
    damping ratio   zeta = sum of c i_d^2 / (2 sqrt(K_r m_s)), c = (F_d(v) - F_d(-v)) / 2 v at v = 0.1 m/s
    roll stiffness  K_phi = K_o t_c t_p / 2           (tracks t_c of wheel centres, t_p of patches; without tyres)

By virtual work m_s g is the load that the springs carry, so K_r and m_s belong together. Source: Gillespie,
Fundamentals of Vehicle Dynamics, chapter 5 (ride rate, undamped natural frequency of the sprung mass); Dixon, Tires,
Suspension and Handling, section 5.12 (roll stiffness of an axle).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vehicle.engines.simulation.axle_curves import design_slopes, opposite_rates, position_rate
from vehicle.engines.simulation.axle_statics import AxleStatics
from vehicle.engines.simulation.car_model import CarModel
from vehicle.model.laws.damper import damper_curve
from vehicle.model.parameters.composition import PlacedDamper, PlacedWheel

DAMPER_VELOCITY = 0.1
"""Damper velocity [m/s] at which a damper counts as a viscous constant: low-speed damping, which rules body motions."""


@dataclass(frozen=True, kw_only=True, slots=True)
class AxleRide:
    """Ride parameters of one wheel of an axle; see the equations of this module.

    Attributes:
        wheel_rate, ride_rate, tyre_stiffness: [N/m].
        unsprung_mass, sprung_mass: of one wheel [kg].
        ride_frequency: undamped [Hz].
        damping_ratio: of the sprung mass on ride rate and dampers [-]; 0 without dampers.
        roll_springs: roll stiffness of the axle by springs, bushings and preloads [N m/rad].
        roll_bars: roll stiffness of the axle by springs on hinges between the sides [N m/rad].
    """

    wheel_rate: float
    ride_rate: float
    tyre_stiffness: float
    unsprung_mass: float
    sprung_mass: float
    ride_frequency: float
    damping_ratio: float
    roll_springs: float
    roll_bars: float

    @property
    def roll_stiffness(self) -> float:
        """Roll stiffness of the axle without the tyres [N m/rad]."""
        return self.roll_springs + self.roll_bars


def axle_ride(car: CarModel, axle: str) -> AxleRide:
    """Compute the ride parameters of an axle.

    Args:
        car: car in static equilibrium, with standing tyres.
        axle: table of the axle in the vehicle file, with two wheels.

    Returns:
        The parameters; the frequency is nan if its stiffness or its mass is not positive.

    Raises:
        SimulationError: the axle has no equilibrium near its design position.
    """
    wheels = [wheel for wheel in car.vehicle.composition.wheels if wheel.axle == axle]
    statics = AxleStatics(car.model, car.static.preload, wheels=wheels)
    rate = float(design_slopes(statics)["wheel_rate_n_per_m"] or math.nan)
    roll = opposite_rates(statics)
    motion = position_rate(statics, [0.0] * len(wheels), opposite=False)
    load = float(np.mean([car.static.tyre_load[wheel.name] for wheel in wheels]))
    unsprung = float(motion.mass_moment) / len(wheels)
    sprung = load / car.vehicle.gravity - unsprung if car.vehicle.gravity else math.nan
    tyre = _tyre_stiffness(car, wheels)
    ride_rate = rate * tyre / (rate + tyre)
    ratios = {
        str(car.model.joint(strut.joint).name): float(ratio)
        for strut, ratio in zip(statics.parts.struts, motion.dampers, strict=True)
    }
    damping = sum(damper_constant(damper) * ratios[damper.joint] ** 2 for damper in axle_dampers(car, axle))
    critical = 2.0 * _root(ride_rate * sprung)
    arm = 0.5 * _track([wheel.center[1] for wheel in wheels]) * _track([wheel.patch[1] for wheel in wheels])
    return AxleRide(
        wheel_rate=rate,
        ride_rate=ride_rate,
        tyre_stiffness=tyre,
        unsprung_mass=unsprung,
        sprung_mass=sprung,
        ride_frequency=_root(ride_rate / sprung) / (2.0 * math.pi),
        damping_ratio=damping / len(wheels) / critical if critical else math.nan,
        roll_springs=arm * roll[0],
        roll_bars=arm * roll[1],
    )


def axle_dampers(car: CarModel, axle: str) -> list[PlacedDamper]:
    """Return the dampers of an axle: those whose numbers are in its table."""
    return [damper for damper in car.vehicle.composition.dampers if damper.path.split(".")[0] == axle]


def damper_constant(damper: PlacedDamper) -> float:
    """Return the secant constant of a damper at `DAMPER_VELOCITY`, mean of bump and rebound [N s/m]."""
    rebound, bump = damper_curve(damper.law).force(np.array([DAMPER_VELOCITY, -DAMPER_VELOCITY]))
    return float(rebound - bump) / (2.0 * DAMPER_VELOCITY)


def _track(positions: list[float]) -> float:
    """Return the distance of the outermost positions across the car [m]."""
    return max(positions) - min(positions)


def _tyre_stiffness(car: CarModel, wheels: list[PlacedWheel]) -> float:
    """Return the mean vertical stiffness of the tyres of some wheels [N/m]."""
    laws = {link.carrier: link.law for link in car.vehicle.composition.connections if link.ground}
    return float(np.mean([laws[wheel.plate].stiffness[2] for wheel in wheels]))  # type: ignore[union-attr]


def _root(value: float) -> float:
    return math.sqrt(value) if value > 0.0 else math.nan
