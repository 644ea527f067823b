"""Tables of eight cars for the batch stepping: their poles, damper laws and weights of outputs.

The law of a damper, v + g (friction + curve) = a, is piecewise linear with nodes (x, F). Its inverse has the nodes
(x + g F, F), so the force is a sum over the segments of their rises times shares between 0 and 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.engines.reduced.batch_factors import CarFactors
from vehicle.engines.reduced.batch_layout import LANES, TILE, TableRows, aligned_table
from vehicle.model.laws.curve import BEYOND
from vehicle.model.laws.damper import RECORD, damper_curve, pack
from vehicle.model.parameters.force_elements import Damper

Vector = npt.NDArray[np.float64]
Table = npt.NDArray[Any]


@lru_cache(maxsize=64)
def damper_nodes(damper: Damper) -> tuple[Table, float, Vector]:
    """Return the data of a damper in a batch.

    Args:
        damper: laws of the damper.

    Returns:
        Its record, the velocity of full friction [m/s], and the nodes of its law without D v and F(0): x, half of the
        curve, friction over its limit; (nodes, 3).
    """
    curve, record = damper_curve(damper), pack(damper)
    full = 0.5 * np.pi / damper.smoothing
    base_slope, end_segments = curve.least_slope, ((-BEYOND, curve.slopes[0]), (BEYOND, curve.slopes[-1]))
    ends = [end for end, slope in end_segments if slope > base_slope]
    nodes = np.unique(np.concatenate([curve.knots, ends, [-full, full]]))
    excess_force = curve.force(nodes) - curve.force(0.0) - base_slope * nodes
    return record, full, np.column_stack([nodes, 0.5 * excess_force, np.clip(nodes / full, -1.0, 1.0)])


class BatchTable:
    """Table of a group of cars; idle lanes repeat the last car.

    Args:
        cars: factors of the cars.
        dampers: damper laws of each car.
        start: (z, z') of the driven plates at the first instant; (2, m).

    Attributes:
        pairs, reals, plates: numbers of pole pairs, real poles and driven plates.
        states: number of terms of an output: states of a sample, and plate displacements.
        initial: states of the first sample; (..., LANES).
        rows: first rows of the sections.
        table: the table, which the batch stepping changes; (rows, LANES).
        laws: records of the dampers if a friction limit depends on the velocity, (d, LANES); otherwise empty.
    """

    def __init__(self, cars: Sequence[CarFactors], dampers: Sequence[Sequence[Damper]], start: Vector) -> None:
        self.cars = [*cars, *[cars[-1]] * (LANES - len(cars))]
        laws = [*dampers, *[dampers[-1]] * (LANES - len(cars))]
        d, m = len(dampers[0]), start.shape[1]
        self.pairs, self.reals = max(car.pairs for car in cars), max(car.reals for car in cars)
        self.plates, inputs = m, 2 * (d + m)
        self.states = 2 * self.pairs + self.reals + 2 * (d + m)
        damper_data = [[damper_nodes(damper) for damper in data_of_car] for data_of_car in laws]
        node_count = max(len(nodes) for data_of_car in damper_data for _, _, nodes in data_of_car)
        sizes = {"real": self.reals * (1 + inputs + d), "slip": d * m, "gain": d * d, "ramp": d * d}
        sizes |= {
            "law": 3 * d * node_count,
            "limit": d,
            "full": d,
            "viscous": d,
            "inputs": inputs,
            "velocity": d,
            "earlier": d,
            "hold": d,
        }
        sizes |= {"stuck": d, "stick": d, "work": d * (4 + 4 * node_count) + TILE}
        # The pairs come first.
        section_ends = np.cumsum([self.pairs * (2 + 2 * inputs + 2 * d), *sizes.values()]).tolist()
        self.sections = {name: slice(*section_ends[k : k + 2]) for k, name in enumerate(sizes)} | {
            "pair": slice(0, section_ends[0])
        }
        begins = {name: self.sections[name].start for name in sizes}
        self.rows = TableRows(pairs=self.pairs, reals=self.reals, pieces=node_count - 1, **begins)
        self.table, self.initial = aligned_table(section_ends[-1]), aligned_table(self.states - m)
        self.initial[-m:] = start[1][:, None]
        record = np.zeros((d, LANES), dtype=RECORD)
        for lane, (car, data_of_car) in enumerate(zip(self.cars, damper_data, strict=True)):
            pairs, reals = car.rows()
            record[:, lane] = [array for array, _, _ in data_of_car]
            pair_start, real_start = car.start(*start)
            self.initial[: len(pair_start), lane] = pair_start
            self.initial[2 * self.pairs :, lane][: len(real_start)] = real_start
            # Repeating the last node gives segments of zero length.
            law = [nodes[np.minimum(np.arange(node_count), len(nodes) - 1)] for _, _, nodes in data_of_car]
            values = dict(zip(("slip", "gain", "ramp"), car.gains, strict=True))
            values |= {"pair": pairs, "real": reals, "law": np.array(law), "limit": record["friction_limit"][:, lane]}
            values |= {
                "full": np.array([full for _, full, _ in data_of_car]),
                "viscous": record["viscous_damping"][:, lane],
            }
            for name, array in values.items():
                first = self.sections[name].start
                self.table[first : first + array.size, lane] = array.ravel()
        self.table[self.sections["stuck"]] = self.table[self.sections["stick"]] = 1.0
        varying = any(damper.friction_law != "coulomb" for data_of_car in dampers for damper in data_of_car)
        self.laws = record if varying else record[:0]

    def tiles(self, weights: Sequence[Vector]) -> Table:
        """Arrange the weights of outputs in tiles of TILE outputs.

        Args:
            weights: weights of each car, see `CarFactors.weights`.

        Returns:
            Table (..., LANES) whose rows are (tiles, states and plate displacements, TILE).
        """
        states, tile_count, pole_count = self.states, -(-len(weights[0]) // TILE), 2 * self.pairs + self.reals
        table = aligned_table(tile_count * states * TILE)
        view = table.reshape(tile_count, states, TILE, LANES)
        padded = np.zeros((tile_count * TILE, states))
        for lane, car in enumerate(self.cars):
            # Weights stay zero for poles that only other cars have.
            padded[:] = 0.0
            car_weights, (p, q) = weights[min(lane, len(weights) - 1)], (2 * car.pairs, car.reals)
            padded[: len(car_weights), :p], padded[: len(car_weights), pole_count:] = (
                car_weights[:, :p],
                car_weights[:, p + q :],
            )
            padded[: len(car_weights), 2 * self.pairs : 2 * self.pairs + q] = car_weights[:, p : p + q]
            view[..., lane] = padded.reshape(tile_count, TILE, states).transpose(0, 2, 1)
        return table
