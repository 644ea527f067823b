"""Tables of eight cars as the march in lanes takes them: factors of a step, laws of the dampers, weights of outputs.

With y = xi - kappa z, kappa = -b_z/s, and r = b_c + b_z/s, a step h with z' a quadratic of its ends and mean m gives

    y+ = E y + r ((M0 - 4 M1 + 3 M2) z' + (3 M2 - 2 M1) z'+ + 6 (M1 - M2) m) + e (M0 f + (M1 - M0/2) slope)

with M_j the moments of the exponential. eta = y - r (3 M2 - 2 M1) z' knows the beginning of a step alone.

The law of a damper, v + g (friction + curve) = a, is a line between nodes (x, F), and so is its inverse, with the nodes
(x + g F, F): the force is a sum over its pieces of shares between 0 and 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import factorial
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.laws.curve import BEYOND
from vehicle.laws.damper import RECORD, damper_curve, pack
from vehicle.parameters.elements import Damper
from vehicle.reduced.lane_rows import LANES, TILE, Rows, aligned
from vehicle.reduced.pole_model import Outputs, PoleModel
from vehicle.reduced.step_factors import phi_functions

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]
Table = npt.NDArray[Any]


LOOSEST = 0.1
"""Largest effect of the other dampers on one, over its own, with which a few turns solve a step in single precision."""

SLOWEST = 1e-2
"""Slowest pole [rad/s] that can be marched as a difference from rest."""


def fits(model: PoleModel, dampers: Sequence[Damper], timestep: float) -> bool:
    """Whether the march in lanes knows a car: no damper is controlled, none depends on another, no pole rests.

    Args:
        model, dampers: of the car.
        timestep: [s].
    """
    if any(damper.controlled is not None for damper in dampers) or np.min(np.abs(model.poles)) < SLOWEST:
        return False
    gain = np.abs((model.slip @ (model.force * timestep * phi_functions(model.poles * timestep, 1)[0][:, None])).real)
    return bool(np.all(gain.sum(axis=1) <= (1.0 + LOOSEST) * np.diag(gain)))


class CarFactors:
    """What a car gives its lane.

    Args:
        model: the car.
        timestep: h [s].
        columns: its driven plates.
    """

    def __init__(self, model: PoleModel, timestep: float, columns: Sequence[int]) -> None:
        chosen, h, s = list(columns), timestep, model.poles[:, None]
        self.chosen, self.pairs, self.reals, slip = chosen, model.pairs, len(model.poles) - model.pairs, model.slip
        phi = phi_functions(model.poles * h, 3)
        m0, m1, m2 = (h * factorial(j) * phi[j][:, None] for j in range(3))
        decay = np.exp(s * h)
        self.static = -(model.height / s)[:, chosen]
        residue = model.velocity[:, chosen] - self.static
        self.ahead = residue * (3.0 * m2 - 2.0 * m1)
        self.force, self.ramp = model.force * m0, model.force * (m1 - 0.5 * m0)
        begin = residue * (m0 - 4.0 * m1 + 3.0 * m2) + decay * self.ahead
        self.decay, self.slip = decay, slip.T
        self.inputs = np.hstack([decay * self.force, decay * self.ramp, begin, residue * 6.0 * (m1 - m2)])
        self.slip_plate = (slip @ self.ahead).real
        self.gain, self.slope_gain = (slip @ self.force).real, (slip @ self.ramp).real

    def poles(self, heights: Vector, rates: Vector) -> tuple[Vector, Vector]:
        """Rows of the pairs and of the real poles, as `advance` takes them, of a car at rest in its design position.

        Args:
            heights, rates: (z, z') of the driven plates at the first instant; (m,) each.

        Returns:
            State, decay, inputs, damper velocities: (p, ...) with real and imaginary parts, (q, ...).
        """
        eta = (-self.static @ heights - self.ahead @ rates)[:, None]
        p = self.pairs
        parts = [part for one in (eta, self.decay, self.inputs) for part in (one[:p].real, one[:p].imag)]
        pairs = np.hstack([*parts, self.slip[:p].real, -self.slip[:p].imag])
        return pairs, np.hstack([one[p:].real for one in (eta, self.decay, self.inputs, self.slip)])

    def weights(self, outputs: Outputs) -> tuple[Vector, Vector, Vector]:
        """Weights of the pairs, the real poles, and of mean forces, slopes, z' and z; (outputs, ...) each."""
        rows, p = outputs.poles, self.pairs
        pairs = np.stack([rows[:, :p].real, -rows[:, :p].imag], axis=2).reshape(len(rows), 2 * p)
        direct = [(rows @ one).real for one in (self.force, self.ramp, self.ahead, self.static)]
        direct[2] += outputs.velocity[:, self.chosen]
        direct[3] += outputs.height[:, self.chosen]
        return pairs, rows[:, p:].real, np.hstack(direct)


def full_velocity(damper: Damper) -> float:
    """Velocity at which the friction of a damper is full [m/s]."""
    return 0.5 * np.pi / damper.smoothing


def law_nodes(damper: Damper) -> Vector:
    """Nodes of the law of a damper without D v and F(0): x, half of the curve, friction over its limit; (nodes, 3)."""
    curve, full = damper_curve(damper), full_velocity(damper)
    outer = ((-BEYOND, curve.slopes[0]), (BEYOND, curve.slopes[-1]))
    ends = [end for end, slope in outer if slope > curve.least_slope]
    nodes = np.unique(np.concatenate([curve.knots, ends, [-full, full]]))
    rising = curve.force(nodes) - curve.force(0.0) - curve.least_slope * nodes
    return np.column_stack([nodes, 0.5 * rising, np.clip(nodes / full, -1.0, 1.0)])


class LaneTable:
    """The table of a group of cars; idle lanes hold the last car again.

    Args:
        cars: their factors.
        dampers: the laws of each car.
        start: (z, z') of the driven plates at the first instant; (2, m).

    Attributes:
        pairs, reals, plates: numbers of poles and of driven plates.
        states: numbers that an output of a sample is a sum over.
        rows: its sections.
        table: what the march changes; (rows, LANES).
        laws: records of the dampers where a friction limit varies, (d, LANES); else none.
    """

    def __init__(self, cars: Sequence[CarFactors], dampers: Sequence[Sequence[Damper]], start: Vector) -> None:
        self.cars = [*cars, *[cars[-1]] * (LANES - len(cars))]
        laws = [*dampers, *[dampers[-1]] * (LANES - len(cars))]
        d, m = len(dampers[0]), start.shape[1]
        self.pairs, self.reals = max(car.pairs for car in cars), max(car.reals for car in cars)
        self.plates, inputs = m, 2 * (d + m)
        self.states = 2 * self.pairs + self.reals + 2 * (d + m)
        nodes = [[law_nodes(damper) for damper in own] for own in laws]
        most = max(len(one) for own in nodes for one in own)
        sizes = {"real": self.reals * (2 + inputs + d), "slip": d * m, "gain": d * d, "ramp": d * d}
        sizes |= {"law": 3 * d * most, "limit": d, "full": d, "inputs": inputs, "velocity": d, "earlier": d, "hold": d}
        sizes |= {"stuck": d, "stick": d, "room": d * (4 + 4 * most) + TILE}
        # The pairs come first.
        ends = np.cumsum([self.pairs * (4 + 2 * inputs + 2 * d), *sizes.values()]).tolist()
        self.place = {name: slice(*ends[k : k + 2]) for k, name in enumerate(sizes)} | {"pair": slice(0, ends[0])}
        begins = {name: self.place[name].start for name in sizes}
        self.rows = Rows(pairs=self.pairs, reals=self.reals, pieces=most - 1, **begins)
        self.table = aligned(ends[-1])
        record = np.zeros((d, LANES), dtype=RECORD)
        for lane, (car, own, law) in enumerate(zip(self.cars, laws, nodes, strict=True)):
            pairs, reals = car.poles(*start)
            record[:, lane] = [pack(damper) for damper in own]
            # The last node again makes a piece of no length.
            law = [np.vstack([one, np.repeat(one[-1:], most - len(one), axis=0)]) for one in law]
            self._put(lane, "pair", pairs)
            self._put(lane, "real", reals)
            for name, values in (("slip", car.slip_plate), ("gain", car.gain), ("ramp", car.slope_gain)):
                self._put(lane, name, values)
            self._put(lane, "law", np.array(law))
            self._put(lane, "full", np.array([full_velocity(damper) for damper in own]))
            self._put(lane, "limit", record["friction_limit"][:, lane])
        self.table[self.place["stuck"]] = self.table[self.place["stick"]] = 1.0
        varying = any(damper.friction_law != "coulomb" for own in dampers for damper in own)
        self.laws = record if varying else record[:0]

    def _put(self, lane: int, name: str, values: Vector) -> None:
        """Write numbers of a car into the first rows of a section."""
        first = self.place[name].start
        self.table[first : first + values.size, lane] = values.ravel()

    def tiles(self, outputs: Sequence[Outputs], each: int = TILE) -> Table:
        """Weights of outputs of each car, TILE rows together.

        Args:
            outputs: as many of each car.
            each: how many of them share a tile.

        Returns:
            (tiles, states and heights, TILE) as the rows of a table (..., LANES).
        """
        count = len(outputs[0].poles)
        states, number = self.states, -(-count // each)
        table = aligned(number * states * TILE)
        view = table.reshape(number, states, TILE, LANES)
        for lane, car in enumerate(self.cars):
            pairs, reals, direct = car.weights(outputs[min(lane, len(outputs) - 1)])
            wide = np.zeros((number * each, states))
            first = 2 * self.pairs
            wide[:count, : pairs.shape[1]], wide[:count, first : first + car.reals] = pairs, reals
            wide[:count, first + self.reals :] = direct
            view[:, :, :each, lane] = wide.reshape(number, each, states).transpose(0, 2, 1)
        return table
