"""Tables of the cars in a vector for the time stepping: their poles, damper laws and weights of outputs.

The law of a damper, v + g (friction + curve) = a, is piecewise linear with nodes (x, F). Its inverse has the nodes
(x + g F, F), so the force is a sum over the segments of their rises times shares between 0 and 1.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.engines.linear.displacement_laws import DisplacementLaw, forces_at_start
from vehicle.engines.reduced.pole_model import Outputs
from vehicle.engines.reduced.step_factors import CarFactors
from vehicle.engines.reduced.table_layout import BLOCK, DOUBLE, TILE, Counts, aligned_table, section_sizes
from vehicle.errors import SimulationError
from vehicle.model.laws.curve import BEYOND
from vehicle.model.laws.damper import RECORD, damper_curve, pack
from vehicle.model.parameters.force_elements import Damper

Table = npt.NDArray[Any]


CONSTANT = ("coulomb", "presliding")
"""Friction laws whose limit does not depend on the velocity."""


@lru_cache(maxsize=64)
def damper_nodes(damper: Damper, whole: bool = False) -> tuple[Table, float, Vector]:
    """Return the data of a damper.

    Args:
        damper: laws of the damper.
        whole: with its outer segments, for a curve that changes during a run.

    Returns:
        Its record, the velocity of full friction [m/s], 0 without a friction line, and the nodes of its law without
        D v and F(0): x, half of the curve, friction over its limit; (nodes, 3).
    """
    curve, record = damper_curve(damper), pack(damper)
    # The friction line (2/pi) L eps v reaches its limit L at v = pi/(2 eps).
    full = 0.5 * np.pi / damper.smoothing
    base_slope, end_segments = curve.least_slope, ((-BEYOND, curve.slopes[0]), (BEYOND, curve.slopes[-1]))
    # The curve of a controlled damper, and the line for a law by address, change in each step.
    changing = damper.controlled is not None or damper.function is not None
    ends = [end for end, slope in end_segments if slope > base_slope or changing or whole]
    nodes = np.unique(np.concatenate([curve.knots, ends, [-full, full]]))
    # The poles contain D v, D the smallest slope, and the trim F(0). Halved: the force is the mean of both ends of a
    # step.
    excess_force = curve.force(nodes) - curve.force(0.0) - base_slope * nodes
    if damper.friction_law == "presliding":
        # Jenkins elements have the friction; no velocity counts as stuck.
        return record, 0.0, np.column_stack([nodes, 0.5 * excess_force, np.zeros_like(nodes)])
    return record, full, np.column_stack([nodes, 0.5 * excess_force, np.clip(nodes / full, -1.0, 1.0)])


class CarTable:
    """Table of a group: cars in single precision, whose idle columns repeat the last car, or one in double precision.

    Args:
        cars: factors of the cars.
        dampers: damper laws of each car.
        start: (z, z') of the driven plates at the first instant, then of the applied forces; (2, m).
        element: number type.
        sensors: sensors of each car, see `vehicle.engines.reduced.feedback.sensor_outputs`.
        static: side forces of each car at rest; (2 k,), none by default.
        heard: contributions of the forces of the laws over displacement to the sensors of each car; (sensors, laws),
            none by default.
        whole: damper laws with their outer segments, see `damper_nodes`.

    Attributes:
        dampers, plates: numbers d of dampers and m of driven plates and histories of applied forces.
        states: number of terms of an output in a column: states of a sample, and plate displacements.
        inputs, sums: numbers of inputs of a step, and of damper velocities and sensors.
        initial: states of the first sample; (..., columns).
        rows: numbers of the record Sections: of states of pole pairs in a column, a multiple of BLOCK, of states of all
            poles, of Gauss-Seidel iterations over the forces, of elements, and first rows of the sections.
        table: the table, which the time stepping changes; (rows, columns).
        poles: factors of the poles in blocks, see `_packed_poles`; (rows, columns).
        pieces: largest number of segments of each damper law; (d,).
        laws: records of the dampers if a friction limit depends on the velocity, (d, columns) or, in double precision,
            (d, 1); otherwise empty.
    """

    def __init__(
        self,
        cars: Sequence[CarFactors],
        dampers: Sequence[Sequence[Damper]],
        start: Vector,
        element: np.dtype[Any],
        sensors: Sequence[Outputs],
        static: Sequence[Vector] = (),
        heard: Sequence[Vector] = (),
        whole: bool = False,
    ) -> None:
        self.element, lanes = element, aligned_table(1, element).shape[1]
        # Single precision: a column is a car. Double precision: column k of four has the poles k, k + 4, ... of the
        # one car.
        split = lanes if element == DOUBLE else 1
        self.lanes = [(min(lane, len(cars) - 1) if split == 1 else 0, slice(lane % split, None, split))
                      for lane in range(lanes)]  # fmt: skip
        self.cars = cars
        laws = [law for car in cars for law in car.laws]
        # The largest car of the group decides all sizes; -(-a // b) rounds a/b up. Poles and elements of rubber
        # friction are distributed over the parts of a car.
        layers = -(-max((law.elements.shape[1] for law in laws), default=0) // split)
        pairs, reals = (-(-max(getattr(car, name) for car in cars) // split) for name in ("pairs", "reals"))
        # Real poles begin a block, so that the sums of a car do not depend on the poles of others.
        pairs = BLOCK // 2 * -(-2 * pairs // BLOCK)
        # Record, velocity of full friction and nodes of each damper of each car; the damper with most nodes decides.
        damper_data = [[damper_nodes(damper, whole) for damper in data_of_car] for data_of_car in dampers]
        node_counts = np.max([[len(nodes) for _, _, nodes in data_of_car] for data_of_car in damper_data], axis=0)
        node_count, self.pieces = int(np.max(node_counts, initial=1)), np.asarray(node_counts - 1, dtype=np.int64)
        groups, elements = cars[0].sliders.stiffness.shape
        counts = Counts(
            dampers=len(dampers[0]),
            plates=start.shape[1],
            inputs=cars[0].step.shape[1] - 1,
            sensors=len(sensors[0].poles),
            sides=len(static[0]) if static else 0,
            pieces=node_count - 1,
            groups=groups,
            elements=elements,
            curves=len(cars[0].laws),
            corners=max((len(law.breakpoints) for law in laws if not law.friction), default=0),
            rubbers=sum(law.friction for law in cars[0].laws),
            layers=layers,
        )
        d, m, g, curves, rubbers = counts.dampers, counts.plates, len(cars[0].strokes), counts.curves, counts.rubbers
        # Terms of an output: states of the poles, mean forces and slopes of the dampers (2 d), scalar forces (g), z'
        # and z (2 m).
        self.dampers, self.pairs, self.plates, self.states = d, pairs, m, 2 * pairs + reals + 2 * (d + m) + g
        self.inputs, self.sums = counts.inputs, d + g + counts.sensors
        # Sections follow one another in the table: each begins where the last one ends.
        sizes = section_sizes(counts)
        section_ends = np.cumsum([0, *sizes.values()]).tolist()
        first_rows = dict(zip(sizes, section_ends, strict=False))
        blocks = -(-(2 * pairs + reals) // BLOCK)
        # For each state E - 1, a factor for each input, and a weight in each sum.
        pole_rows = blocks * BLOCK * (1 + self.inputs + self.sums)
        self.table, self.poles = (aligned_table(rows, element) for rows in (section_ends[-1], pole_rows))
        self.initial = self.at_rest(start)
        record = np.zeros((d, lanes), dtype=RECORD)
        rows_of_cars = [car.rows(car_sensors.poles) for car, car_sensors in zip(cars, sensors, strict=True)]
        for lane, (car, part) in enumerate(self.lanes):
            record[:, lane] = [array for array, _, _ in damper_data[car]]
            # Repeating the last node gives segments of zero length.
            law = [nodes[np.minimum(np.arange(node_count), len(nodes) - 1)] for _, _, nodes in damper_data[car]]
            self.poles[:, lane] = _packed_poles([rows[part] for rows in rows_of_cars[car]], pairs, blocks).ravel()
            slip, gain, ramp = cars[car].gains
            columns, sliders = cars[car].columns, cars[car].sliders
            at_start, stiff = start[:, : len(columns)], sliders.stiffness > 0.0
            # Sums over the poles are added over the parts of a car, with the contribution of the plates once.
            once = float(part.start == 0)
            values = {
                "slip": once * slip,
                "level": once * cars[car].levels,
                "gain": gain,
                "ramp": ramp,
                "law": np.array(law),
                "limit": record["friction_limit"][:, lane],
                "viscous": record["viscous_damping"][:, lane],
                "full": np.array([full for _, full, _ in damper_data[car]]),
                "direct": cars[car].weights_of(sensors[car])[:, cars[car].states :],
                # At rest all poles are zero; what is left is k z + c z' of the tyres.
                "sensors": sensors[car].height[:, columns] @ at_start[0]
                + sensors[car].velocity[:, columns] @ at_start[1],
                "rest": static[car] if static else np.zeros(0),
                "spring": sliders.stiffness,
                "give": np.divide(1.0, sliders.stiffness, out=np.zeros(stiff.shape), where=stiff),
                "share": sliders.limit,
            }
            if curves:
                # G: displacement at the end of a step by a unit of the mean force of the same law [m/N].
                effect = np.diag(gain)[d + groups :]
                tables, friction = cars[car].laws[: curves - rubbers], cars[car].laws[curves - rubbers :]
                # Neighbouring elements stay in one column: a slider depends on those that move before it, `before` of
                # vector.h.
                rubber = _rubber(friction, effect[curves - rubbers :], split * layers)
                values |= {name: rows.reshape(rubbers, split, layers)[:, part.start] for name, rows in rubber.items()}
                values |= {
                    "own": 0.5 * effect,
                    "corner": _corners(tables, effect[: curves - rubbers], counts.corners),
                    "excess": forces_at_start(cars[car].laws, columns, at_start),
                    "heard": heard[car] if heard else np.zeros(0),
                }
            for name, array in values.items():
                self.table[first_rows[name] :, lane][: array.size] = array.ravel()
        # At rest every damper with a friction line sticks.
        for name in ("stuck", "stick"):
            self.table[first_rows[name] :][:d] = self.table[first_rows["full"] :][:d] > 0.0
        iterations = cars[0].iterations if element == DOUBLE else cars[0].single_iterations
        numbers = {"pairs": 2 * pairs, "states": 2 * pairs + reals, "iterations": iterations}
        self.rows = {**counts._asdict(), **numbers, **first_rows}
        varying = sizes["rest"] > 0
        every = [damper for data_of_car in dampers for damper in data_of_car]
        varying |= any(damper.friction_law not in CONSTANT or damper.friction_function for damper in every)
        # One record for each car: eight columns in single precision, one of the four equal columns in double
        # precision.
        self.laws = np.ascontiguousarray(record[:, : lanes // split] if varying else record[:0])

    def at_rest(self, start: Vector) -> Table:
        """Return the states of the first sample of cars at rest over moving plates; (states - m, columns).

        Args:
            start: (z, z') of the driven plates at the first instant; (2, m).
        """
        initial = aligned_table(self.states - self.plates, self.element)
        # Rows: states of the poles, forces of the last step, which are zero at rest, and z'.
        initial[-self.plates :] = start[1][:, None]
        for lane, (car, part) in enumerate(self.lanes):
            pair_start, real_start = (states[part] for states in self.cars[car].start(*start))
            # As reals, complex states alternate real and imaginary parts, as in a block of `poles.c`.
            initial[: 2 * len(pair_start), lane] = np.ascontiguousarray(pair_start).view(np.float64)
            initial[2 * self.pairs :, lane][: len(real_start)] = real_start
        return initial

    def tiles(self, weights: Sequence[Vector]) -> Table:
        """Arrange the weights of outputs in tiles of TILE outputs, zero for the outputs that fill the last tile.

        Args:
            weights: weights of each car, (outputs, states and plate displacements); see `CarFactors.weights`.

        Returns:
            Table (rows, columns), a column for each car; rows: (tiles, states and plates, TILE) in C order.
        """
        tile_count = -(-len(weights[0]) // TILE)
        # First term after the states of the poles, see `states`.
        poles = self.states - 2 * (len(self.cars[0].slip) + self.plates) - len(self.cars[0].strokes)
        table = aligned_table(tile_count * self.states * TILE, self.element)
        view = table.reshape(tile_count, self.states, TILE, table.shape[1])
        for lane, (car, part) in enumerate(self.lanes):
            # Weights stay zero for poles that only other cars have.
            padded, p, states = np.zeros((tile_count * TILE, self.states)), self.cars[car].pairs, self.cars[car].states
            rows, count = padded[: len(weights[car])], len(weights[car])
            # (outputs, pairs, real and imaginary part): a column takes whole pairs.
            pairs = weights[car][:, : 2 * p].reshape(count, p, 2)[:, part].reshape(count, 2 * len(range(p)[part]))
            reals = weights[car][:, 2 * p : states][:, part]
            rows[:, : pairs.shape[1]], rows[:, 2 * self.pairs :][:, : reals.shape[1]] = pairs, reals
            if part.start == 0:
                rows[:, poles:] = weights[car][:, states:]
            # (tiles, states, TILE): the core reads the weights of three outputs for a state at once.
            view[..., lane] = padded.reshape(tile_count, TILE, self.states).transpose(0, 2, 1)
        return table


def _packed_poles(rows: Sequence[Vector], pairs: int, blocks: int) -> Vector:
    """Return the factors of the poles of a column, (blocks, ...), in blocks of BLOCK states, as `poles.c` reads them.

    A block has the real and imaginary parts of E - 1 of four pairs, or E - 1 of eight real poles; for each input of
    a step its factors in the changes of the states; and for each sum the weights of the states.
    """
    pair, real, pair_sums, real_sums = rows
    p, q, n, w = len(pair), len(real), real.shape[1] - 1, real_sums.shape[1]
    factors, reals = np.zeros((blocks * BLOCK, 1 + n + w)), slice(2 * pairs, 2 * pairs + q)
    # A row of a pair is (Re E-1, Im E-1, Re of n inputs, Im of n inputs): reshaped, each part is a separate row.
    factors[: 2 * p, 0] = pair[:, :2].ravel()
    factors[: 2 * p, 1 : 1 + n] = pair[:, 2:].reshape(2 * p, n)
    factors[: 2 * p, 1 + n :] = pair_sums.reshape(2 * p, w)
    factors[reals, : 1 + n], factors[reals, 1 + n :] = real, real_sums
    # (blocks, 1 + n + w, BLOCK): for each factor, the values of the eight states of a block are contiguous.
    return factors.reshape(blocks, BLOCK, 1 + n + w).transpose(0, 2, 1).reshape(blocks, -1)


def _corners(laws: Sequence[DisplacementLaw], effects: Vector, count: int) -> Vector:
    """Return the laws g over r = x + G g(x)/2 as sides, breakpoints and slope changes; (laws, count, 3).

    G are the effects of their forces on their displacements [m/N]; laws with fewer breakpoints have zeros.
    """
    numbers = np.zeros((len(laws), count, 3))
    for row, law, effect in zip(numbers, laws, effects.tolist(), strict=True):
        filled = 0
        # Outwards from rest on either side, so that the slope of a segment is the sum of the changes up to it.
        for side in (1.0, -1.0):
            chosen = np.flatnonzero(np.copysign(1.0, law.breakpoints) == side)
            chosen = chosen[np.argsort(np.abs(law.breakpoints[chosen]), kind="stable")]
            slopes = side * np.cumsum(law.changes[chosen])
            _require_rising(law, 1.0 + 0.5 * effect * slopes)
            # A segment of slope k over x has the slope k/(1 + G k/2) over r = x + G g(x)/2.
            steepness = slopes / (1.0 + 0.5 * effect * slopes)
            part = row[filled : filled + len(chosen)]
            part[:, 0] = side
            # The breakpoint over r, times the side: the core evaluates max(0, side r - this).
            part[:, 1] = side * (law.breakpoints[chosen] + 0.5 * effect * law.force(law.breakpoints[chosen]))
            part[:, 2] = side * np.diff(steepness, prepend=0.0)
            filled += len(chosen)
    return numbers


def _rubber(laws: Sequence[DisplacementLaw], effects: Vector, count: int) -> dict[str, Vector]:
    """Return the sections of rubber friction for the time step, (laws, count) each; see `scalar_elements.h`.

    The effects G are those of the forces on the displacements [m/N]; laws with fewer elements have zeros.
    """
    stiff, stroke, part, reach, weight = np.zeros((5, len(laws), count))
    for row, (law, effect) in enumerate(zip(laws, effects.tolist(), strict=True)):
        stiffness, strokes = law.elements
        size = len(stiffness)
        # S of `scalar_elements.h`: stiffness of the elements that slide before element i, and of all in the end.
        sliding = np.cumsum(np.append(0.0, stiffness))
        rising = 1.0 - 0.5 * effect * sliding
        _require_rising(law, rising)
        stiff[row, :size], stroke[row, :size], part[row, :size] = stiffness, strokes, rising[:-1]
        # e_i = p_i x_i + G/2 (sum of k_j x_j before i).
        reach[row, :size] = rising[:-1] * strokes + 0.5 * effect * np.cumsum(np.append(0.0, (stiffness * strokes)[:-1]))
        # w_i = S'/p' - S/p.
        weight[row, :size] = np.diff(sliding / rising)
    return {"stiff": stiff, "stroke": stroke, "part": part, "reach": reach, "weight": weight}


def _require_rising(law: DisplacementLaw, slopes: Vector) -> None:
    """Check that all slopes of x + G g(x)/2 of a law are positive."""
    if np.any(slopes <= 0.0):
        raise SimulationError(
            f"{law.name}: the stiffness at rest is zero or negative in this car, so the reduced engine cannot compute "
            "the segments of the curve that are softer still; use --engine mujoco"
        )
