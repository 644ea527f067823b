"""Ride numbers of an axle: wheel rate, ride rate, unsprung mass, ride frequency, damping ratio, roll stiffness.

The body is held. The wheels of the axle move by equal travel z; phi is the motion of all coordinates of the axle per
unit travel in static equilibrium, with bushings as they are and contact patches that roll freely:

    wheel rate      K_w = dF/dz of a wheel            (tangent in the design position)
    ride rate       K_r = K_w K_t / (K_w + K_t)       (in series with the tyre, K_t)
    unsprung mass   m_u = phi' M phi / wheels         (kinetic energy of the axle parts, m_u z'^2 / 2 for each wheel)
    sprung mass     m_s = F / g - m_u                 (F: static wheel load)
    ride frequency  f   = sqrt(K_r / m_s) / 2 pi
    damper ratio    i_d = phi of the damper           (damper travel per wheel travel)
    damping ratio   zeta = c i_d^2 / (2 sqrt(K_r m_s)), c = (F_d(v) - F_d(-v)) / 2 v at v = 0.1 m/s of the damper
    roll stiffness  K_phi = K_o t^2 / 2               (wheel rate K_o over opposite travel, track t; without the tyres)

Source: Gillespie, Fundamentals of Vehicle Dynamics, chapter 5 (ride rate, undamped natural frequency of the sprung
mass); Dixon, Tires, Suspension and Handling, section 5.12 (roll stiffness of an axle).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.engines.simulation.axle_curves import SMALL, design_slopes
from vehicle.engines.simulation.axle_statics import AxleStatics
from vehicle.engines.simulation.car_model import CarModel
from vehicle.model.laws.damper import damper_curve
from vehicle.model.parameters.composition import PlacedDamper, PlacedWheel

Vector = npt.NDArray[np.float64]

DAMPER_VELOCITY = 0.1
"""Damper velocity [m/s] at which a damper counts as a viscous constant: low-speed damping, which rules body motions."""


@dataclass(frozen=True, kw_only=True, slots=True)
class AxleRide:
    """Ride numbers of one wheel of an axle, see the equations of this module.

    Attributes:
        wheel_rate, ride_rate, tyre_stiffness: [N/m].
        unsprung_mass, sprung_mass: of one wheel [kg].
        ride_frequency: undamped [Hz].
        damping_ratio: of the sprung mass on ride rate and dampers [-]; 0 without dampers.
        roll_stiffness: of the axle without the tyres [N m/rad].
    """

    wheel_rate: float
    ride_rate: float
    tyre_stiffness: float
    unsprung_mass: float
    sprung_mass: float
    ride_frequency: float
    damping_ratio: float
    roll_stiffness: float


def axle_ride(car: CarModel, axle: str) -> AxleRide:
    """Compute the ride numbers of an axle.

    Args:
        car: car in static equilibrium, with standing tyres.
        axle: table of the axle in the vehicle file, with two wheels.

    Returns:
        The numbers; the frequency is nan if its stiffness or its mass is not positive.
    """
    wheels = [wheel for wheel in car.vehicle.composition.wheels if wheel.axle == axle]
    statics = AxleStatics(car.model, car.static.preload, wheels=wheels)
    equal, opposite = (_wheel_rate(statics, opposite=value) for value in (False, True))
    phi = _travel_shape(AxleStatics(car.model, car.static.preload, wheels=wheels))
    mass = np.zeros((car.model.nv, car.model.nv))
    data = mujoco.MjData(car.model)
    mujoco.mj_forward(car.model, data)
    mujoco.mj_fullM(car.model, data, mass)
    parts = np.zeros(car.model.nv)
    parts[statics.columns] = phi[statics.columns]
    unsprung = float(parts @ mass @ parts) / len(wheels)
    load = float(np.mean([car.static.tyre_load[wheel.name] for wheel in wheels]))
    tyre = _tyre_stiffness(car, wheels)
    sprung = load / car.vehicle.gravity - unsprung if car.vehicle.gravity else math.nan
    ride_rate = equal * tyre / (equal + tyre)
    damping = sum(
        damper_constant(damper) * float(phi[_damper_dof(car, damper)]) ** 2
        for damper in axle_dampers(car, axle)
    ) / len(wheels)  # fmt: skip
    track = max(wheel.center[1] for wheel in wheels) - min(wheel.center[1] for wheel in wheels)
    critical = 2.0 * _root(ride_rate * sprung)
    return AxleRide(
        wheel_rate=equal,
        ride_rate=ride_rate,
        tyre_stiffness=tyre,
        unsprung_mass=unsprung,
        sprung_mass=sprung,
        ride_frequency=_root(ride_rate / sprung) / (2.0 * math.pi),
        damping_ratio=damping / critical if critical else math.nan,
        roll_stiffness=opposite * track**2 / 2.0,
    )


def axle_dampers(car: CarModel, axle: str) -> list[PlacedDamper]:
    """Return the dampers of an axle: those whose numbers are in its table."""
    return [damper for damper in car.vehicle.composition.dampers if damper.path.split(".")[0] == axle]


def damper_constant(damper: PlacedDamper) -> float:
    """Return the secant constant of a damper at `DAMPER_VELOCITY`, mean of bump and rebound [N s/m]."""
    rebound, bump = damper_curve(damper.law).force(np.array([DAMPER_VELOCITY, -DAMPER_VELOCITY]))
    return float(rebound - bump) / (2.0 * DAMPER_VELOCITY)


def _damper_dof(car: CarModel, damper: PlacedDamper) -> int:
    return int(car.model.jnt_dofadr[car.model.joint(damper.joint).id])


def _wheel_rate(statics: AxleStatics, *, opposite: bool) -> float:
    return float(design_slopes(statics, opposite=opposite)["wheel_rate_n_per_m"] or math.nan)


def _travel_shape(statics: AxleStatics) -> Vector:
    """Return the motion of the coordinates per unit of equal wheel travel, by central differences; (n,)."""
    positions = []
    for travel in (-SMALL, SMALL):
        statics.solve([travel] * len(statics.wheels))
        positions.append(statics.data.qpos.copy())
    motion = np.zeros(statics.model.nv)
    mujoco.mj_differentiatePos(statics.model, motion, 2.0 * SMALL, *positions)
    return motion


def _tyre_stiffness(car: CarModel, wheels: list[PlacedWheel]) -> float:
    """Return the mean vertical stiffness of the tyres of some wheels [N/m]."""
    laws = {link.carrier: link.law for link in car.vehicle.composition.connections if link.ground}
    return float(np.mean([laws[wheel.plate].stiffness[2] for wheel in wheels]))  # type: ignore[union-attr]


def _root(value: float) -> float:
    return math.sqrt(value) if value > 0.0 else math.nan
