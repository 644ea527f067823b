"""Tables of eight cars as the march in lanes takes them: their poles, the laws of their dampers, weights of outputs.

The law of a damper, v + g (friction + curve) = a, is a line between nodes (x, F), and so is its inverse, with the nodes
(x + g F, F): the force is a sum over its pieces of shares between 0 and 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.engines.reduced.lane_factors import CarFactors
from vehicle.engines.reduced.lane_rows import LANES, TILE, Rows, aligned
from vehicle.model.laws.curve import BEYOND
from vehicle.model.laws.damper import RECORD, damper_curve, pack
from vehicle.model.parameters.force_elements import Damper

Vector = npt.NDArray[np.float64]
Table = npt.NDArray[Any]


@lru_cache(maxsize=64)
def damper_lane(damper: Damper) -> tuple[Table, float, Vector]:
    """What a damper gives its lane.

    Args:
        damper: its laws.

    Returns:
        Its record, the velocity at which its friction is full [m/s], and the nodes of its law without D v and F(0):
        x, half of the curve, friction over its limit; (nodes, 3).
    """
    curve, record = damper_curve(damper), pack(damper)
    full = 0.5 * np.pi / damper.smoothing
    least, outer = curve.least_slope, ((-BEYOND, curve.slopes[0]), (BEYOND, curve.slopes[-1]))
    ends = [end for end, slope in outer if slope > least]
    nodes = np.unique(np.concatenate([curve.knots, ends, [-full, full]]))
    rising = curve.force(nodes) - curve.force(0.0) - least * nodes
    return record, full, np.column_stack([nodes, 0.5 * rising, np.clip(nodes / full, -1.0, 1.0)])


class LaneTable:
    """The table of a group of cars; idle lanes hold the last car again.

    Args:
        cars: their factors.
        dampers: the laws of each car.
        start: (z, z') of the driven plates at the first instant; (2, m).

    Attributes:
        pairs, reals, plates: numbers of poles and of driven plates.
        states: numbers that an output of a sample is a sum over: states of a sample, and heights of the plates.
        begin: states of the first sample; (..., LANES).
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
        made = [[damper_lane(damper) for damper in own] for own in laws]
        most = max(len(nodes) for own in made for _, _, nodes in own)
        sizes = {"real": self.reals * (1 + inputs + d), "slip": d * m, "gain": d * d, "ramp": d * d}
        sizes |= {
            "law": 3 * d * most,
            "limit": d,
            "full": d,
            "viscous": d,
            "inputs": inputs,
            "velocity": d,
            "earlier": d,
            "hold": d,
        }
        sizes |= {"stuck": d, "stick": d, "room": d * (4 + 4 * most) + TILE}
        # The pairs come first.
        ends = np.cumsum([self.pairs * (2 + 2 * inputs + 2 * d), *sizes.values()]).tolist()
        self.place = {name: slice(*ends[k : k + 2]) for k, name in enumerate(sizes)} | {"pair": slice(0, ends[0])}
        begins = {name: self.place[name].start for name in sizes}
        self.rows = Rows(pairs=self.pairs, reals=self.reals, pieces=most - 1, **begins)
        self.table, self.begin = aligned(ends[-1]), aligned(self.states - m)
        self.begin[-m:] = start[1][:, None]
        record = np.zeros((d, LANES), dtype=RECORD)
        for lane, (car, own) in enumerate(zip(self.cars, made, strict=True)):
            pairs, reals = car.rows()
            record[:, lane] = [one for one, _, _ in own]
            here, there = car.start(*start)
            self.begin[: len(here), lane] = here
            self.begin[2 * self.pairs :, lane][: len(there)] = there
            # The last node again makes a piece of no length.
            law = [nodes[np.minimum(np.arange(most), len(nodes) - 1)] for _, _, nodes in own]
            values = dict(zip(("slip", "gain", "ramp"), car.gains, strict=True))
            values |= {"pair": pairs, "real": reals, "law": np.array(law), "limit": record["friction_limit"][:, lane]}
            values |= {"full": np.array([full for _, full, _ in own]), "viscous": record["viscous_damping"][:, lane]}
            for name, one in values.items():
                first = self.place[name].start
                self.table[first : first + one.size, lane] = one.ravel()
        self.table[self.place["stuck"]] = self.table[self.place["stick"]] = 1.0
        varying = any(damper.friction_law != "coulomb" for own in dampers for damper in own)
        self.laws = record if varying else record[:0]

    def tiles(self, weights: Sequence[Vector]) -> Table:
        """Weights of outputs, TILE of them together.

        Args:
            weights: of each car, as of `CarFactors.weights`.

        Returns:
            (tiles, states and heights, TILE) as the rows of a table (..., LANES).
        """
        states, number, end = self.states, -(-len(weights[0]) // TILE), 2 * self.pairs + self.reals
        table = aligned(number * states * TILE)
        view = table.reshape(number, states, TILE, LANES)
        wide = np.zeros((number * TILE, states))
        for lane, car in enumerate(self.cars):
            # Poles that others have and this one has not.
            wide[:] = 0.0
            own, (p, q) = weights[min(lane, len(weights) - 1)], (2 * car.pairs, car.reals)
            wide[: len(own), :p], wide[: len(own), end:] = own[:, :p], own[:, p + q :]
            wide[: len(own), 2 * self.pairs : 2 * self.pairs + q] = own[:, p : p + q]
            view[..., lane] = wide.reshape(number, TILE, states).transpose(0, 2, 1)
        return table
