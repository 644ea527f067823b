"""Change of a periodic state by a change of the car: one linear solve by the same splitting.

The state w = W - G p, p = phi(w) has the derivative by a parameter

    dw = q - G dp,   q = dW - dG p,      dp = D dw + dphi,   D = phi'(w) at each instant,

a periodic state of the same car with the linear laws D and the drive q. Rolling tyres add the force of the change of
their load, where they touch the plate. q and dphi are central differences of the car at the fixed state, in which no
sample changes from sticking to slipping, so that they are smooth; the differences of two whole states are not.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.engines.steady.driven_car import DrivenCar
from vehicle.engines.steady.law_ports import Polygon, Port, Stribeck
from vehicle.engines.steady.splitting import PeriodicForces, periodic_forces
from vehicle.errors import ConfigurationError, SimulationError

TOLERANCE = 1e-8
"""Residual of the linear solve over its largest force."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Tangent(Port):
    """Linear law p = D w + offset with another slope D at each instant.

    Attributes:
        slopes, offset: D and offset; (1, samples).
        falling: largest -D.
    """

    slopes: Vector
    offset: Vector
    falling: float

    @property
    def fall(self) -> float:
        """See `Port`."""
        return self.falling

    @property
    def odd(self) -> bool:
        """See `Port`."""
        return False

    def force(self, sums: Vector, scaling: Vector, sign: float) -> Vector:
        """See `Port`."""
        return np.asarray((self.slopes * sums + scaling * self.offset) / (self.slopes + scaling))


def change_of_state(
    car: DrivenCar, state: PeriodicForces, less: DrivenCar, more: DrivenCar, step: float
) -> PeriodicForces:
    """Return the derivatives of forces, motions and slope velocities by a parameter.

    Args:
        car: the car, whose laws have no memory.
        state: its periodic state.
        less, more: cars with the parameter one step lower and higher.
        step: the step, in the unit of the parameter.

    Raises:
        ConfigurationError: the step adds or removes a law.
        SimulationError: the linear solve does not end.
    """
    if not len(less.ports) == len(car.ports) == len(more.ports):
        raise ConfigurationError("gradient: the parameter adds a law to the car, so there is no derivative; change it")
    forces = car.cycle.amplitudes(state.force[0])
    motions, loads, offsets = [], [], []
    for varied in (less, more):
        motions.append(
            varied.drive
            - np.einsum("ijk,jk->ik", varied.effects, forces)
            + np.einsum("iwk,wk->ik", varied.slopes, state.slope[0])
        )
        offsets.append([_law(port).at(motion) for port, motion in zip(varied.ports, state.motion[0], strict=True)])
        if varied.present is not None:
            loads.append(varied.present.changes(forces[None], state.slope) / varied.present.load[:, None])
    drive: Complex = np.asarray(0.5 * (motions[1] - motions[0]) / step, dtype=np.complex128)
    offset: Vector = np.asarray(0.5 * (np.asarray(offsets[1]) - np.asarray(offsets[0])) / step)
    laws = [
        Tangent(
            base=port.base,
            of_velocity=port.of_velocity,
            share=port.share,
            slopes=_law(port).slope(motion)[None],
            offset=change[None],
            falling=port.fall,
        )
        for port, motion, change in zip(car.ports, state.motion[0], offset, strict=True)
    ]
    present = car.present
    if present is not None:
        touching = car.cycle.histories(present.changes(forces[None], state.slope)) > -present.load[:, None]
        change = 0.5 * (loads[1] - loads[0]) / step * present.load[:, None]
        present = replace(present, plates=change, rate=present.rate * touching, least=-np.inf)
    result = periodic_forces(
        laws, car.cycle, car.effects[None], drive[None], car.scaling(), present=present, tolerance=TOLERANCE
    )
    if not result.ended[0]:
        raise SimulationError("gradient: the linear solve does not end; use finite steps with sweep")
    return result


def _law(port: Port) -> Polygon | Stribeck:
    """Return a law without memory."""
    assert isinstance(port, Polygon | Stribeck)
    return port
