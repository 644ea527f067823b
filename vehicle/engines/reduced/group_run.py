"""Run of a group block by block: up to eight cars in single precision, or one in double precision."""

import ctypes
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.core.library import core
from vehicle.core.records import checked, packed
from vehicle.engines.linear.displacement_laws import forces_at_start
from vehicle.engines.linear.load_rows import LoadRows
from vehicle.engines.reduced.car_table import CarTable, damper_nodes
from vehicle.engines.reduced.feedback import Feedback, feedback_at_rest, sensor_laws, sensor_outputs
from vehicle.engines.reduced.load_outputs import load_outputs
from vehicle.engines.reduced.plate_samples import InputSamples, plate_samples
from vehicle.engines.reduced.pole_model import Outputs, PoleModel
from vehicle.engines.reduced.step_factors import CarFactors
from vehicle.engines.reduced.table_layout import BLOCK, INNER_BLOCK, LANES, PAST, SINGLE, TILE, aligned_table
from vehicle.engines.reduced.validity import Validity, check_stride, rotating_bodies, tyre_outputs
from vehicle.engines.simulation.recorded_acceleration import AHEAD, WEIGHTS
from vehicle.engines.simulation.recording import Statistics
from vehicle.mapped_table import release
from vehicle.model.laws.controller_fmu import controllers
from vehicle.model.laws.law_exceptions import exceptions_of_laws
from vehicle.model.parameters.force_elements import Damper
from vehicle.signals.excitation.signal import Signal

SAMPLES = 64 * INNER_BLOCK
"""Samples in a block of plate displacements."""

PART = 65_536
"""Samples of a part of a recording that is computed as a whole, which limits the memory of splines and loads."""


def parts_of(samples: int) -> Iterator[slice]:
    """Return the parts of a recording, of `PART` samples each."""
    return (slice(first, min(first + PART, samples)) for first in range(0, samples, PART))


def time_steps(signal: Signal, record_rate: float, longest: float) -> tuple[int, int]:
    """Return the number of samples of a run and of steps between two samples.

    Args:
        signal: displacement of the plates.
        record_rate: rate of the samples [Hz].
        longest: maximum time step [s].
    """
    # The small terms are for a duration or step that is a whole multiple except for round-off.
    interval = 1.0 / record_rate
    return int(np.floor(signal.duration / interval + 1e-6)) + 1, int(np.ceil(interval / longest - 1e-9))


def packed_cars(
    models: Sequence[PoleModel],
    factors: Sequence[CarFactors],
    dampers: Sequence[Sequence[Damper]],
    tyre_load: Sequence[Mapping[str, float] | None],
    start: Vector,
    timestep: float,
    element: np.dtype[Any],
    whole: bool = False,
) -> tuple[CarTable, Feedback]:
    """Return table and feedback of cars at rest for the core.

    Args:
        models, factors, dampers: pole models, factors and damper laws of the cars.
        tyre_load: static tyre loads [N] of the cars; None if no current loads act on slopes.
        start, element, whole: see `CarTable`.
        timestep: time step [s].
    """
    columns = factors[0].columns
    listed = [(model, laws, columns, static) for model, laws, static in zip(models, dampers, tyre_load, strict=True)]
    sensors, sides = [sensor_outputs(*car) for car in listed], [model.matrices.sides for model in models]
    heard = [sensor_laws(*car) for car in listed if car[0].laws]
    cars = CarTable(factors, dampers, start, element, sensors, [side.static for side in sides], heard, whole)
    owners, tyres = factors[0].sliders.dampers, len(columns) if tyre_load[0] is not None else 0
    return cars, feedback_at_rest(dampers[0], owners, sides[0].dampers, tyres, factors[0].plate_inputs, timestep)


def march_fields(cars: CarTable, feedback: Feedback, reading: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields of the record March that stay in a run, without its memory.

    Args:
        cars, feedback: cars and their feedback, see `packed_cars`.
        reading: fields of their outputs; levels begin with the tyre loads.
    """
    fields = dict(reading) | feedback._asdict()
    fields |= {"rows": cars.rows, "table": cars.table, "poles": cars.poles, "laws": cars.laws, "pieces": cars.pieces}
    return fields | {"inputs": cars.inputs, "sums": cars.sums, "plates": cars.plates, "dampers": cars.dampers}


class GroupRun:
    """Run of a group: cars with equal channels on one signal, or one car in double precision.

    Args:
        models, factors, dampers, tyre_load: pole models, factors, damper laws and static tyre loads [N] of the cars.
        signal: displacement of the plates, with the run-outs of the tyres, which are equal in a group.
        interval: time between two samples [s].
        every: steps between two samples.
        element: number type, see `vehicle.engines.reduced.table_layout`.
        present_load: slope forces of rolling tyres by their current load, see `car_factors`.
        loads: load channels of the car in double precision.
    """

    def __init__(
        self,
        models: Sequence[PoleModel],
        factors: Sequence[CarFactors],
        dampers: Sequence[Sequence[Damper]],
        tyre_load: Sequence[Mapping[str, float]],
        signal: Signal,
        interval: float,
        every: int,
        element: np.dtype[Any],
        present_load: bool = False,
        loads: LoadRows | None = None,
    ) -> None:
        self.models, self.factors, self.dampers, self.tyre_load = models, factors, dampers, tyre_load
        self.interval, self.every, self.timestep, self.loads = interval, every, interval / every, loads
        self.driven, self.element = signal.wheels, element
        steps = int(np.floor(signal.duration / interval + 1e-6)) * every
        self.plates = plate_samples(signal, self.timestep, steps, AHEAD * every)
        lines = models[0].matrices.lines
        lines.require_length(signal.duration)
        self.inputs = InputSamples(self.plates, lines, self.timestep) if len(lines) else self.plates
        # A row has (z, z', slope excess) of each plate; the first two are the start.
        start = self.inputs[0:1].reshape(-1, 3).T[:2]
        self.start, loads_of_tyres = start, tyre_load if present_load else [None] * len(models)
        self.cars, self.feedback = packed_cars(models, factors, dampers, loads_of_tyres, start, self.timestep, element)

    def fill(self, table: Vector, rows_of_cars: Sequence[int], channels: Sequence[str]) -> list[Validity]:
        """Simulate the cars, fill their rows of the table, and return the validity of the motion of each car.

        Args:
            table: time histories; (channels, all cars, samples).
            rows_of_cars: rows of the cars of this group.
            channels: names of the channels; `friction_<index>` is the mean nonlinear force of a damper,
                `law_<index>` the force g of a law over displacement.
        """
        matrices = self.models[0].matrices
        system, laws, bodies = matrices.system, self.models[0].laws, rotating_bodies(matrices)
        count, load_names = len(self.dampers[0]), () if self.loads is None else self.loads.names
        # Rows of a sample: positions, levels (tyre loads; load channels), then of the dampers: velocities, forces,
        # friction, coefficients, then the forces of the laws over displacement.
        position_names = [name for name in channels if name in system.outputs]
        tyre_wheels = {f"tyre_{wheel}_force_z": wheel for wheel in system.inputs}
        # First rows, each rounded up to whole tiles of three outputs.
        levels = TILE * -(-len(position_names) // TILE)
        watched = TILE * -(-len(tyre_wheels) // TILE)
        speeds = levels + watched + TILE * -(-len(load_names) // TILE)
        rows = {name: row for row, name in enumerate(position_names)}
        rows |= {name: levels + row for row, name in enumerate(tyre_wheels)}
        rows |= {name: levels + watched + row for row, name in enumerate(load_names)}
        for index, damper in enumerate(matrices.damper_names):
            names = f"{damper}_velocity", f"{damper}_force", f"friction_{index}"
            rows |= {name: speeds + part * count + index for part, name in enumerate(names)}
        for k, index in enumerate(self.feedback.controlled.tolist()):
            rows[f"{matrices.damper_names[index]}_coefficient"] = speeds + 3 * count + k
        curves = speeds + 3 * count + len(self.feedback.controlled)
        rows |= {f"law_{index}": curves + index for index in range(len(laws))}
        static_values, plate_rows = np.zeros((len(channels), self.cars.table.shape[1])), dict[int, int]()
        for row, name in enumerate(channels):
            if name in tyre_wheels:
                static_values[row, : len(self.models)] = [load[tyre_wheels[name]] for load in self.tyre_load]
            elif self.loads is not None and name in load_names:
                static_values[row] = self.loads.static[load_names.index(name)]
            elif speeds + count <= rows.get(name, 0) < speeds + 2 * count:
                # The tables count forces from rest: the output adds the static force of the law.
                static_values[row, : len(self.models)] = [
                    damper_nodes(laws[rows[name] - speeds - count])[0]["rest_force"] for laws in self.dampers
                ]
            elif name not in rows:
                wheel, table[row, rows_of_cars] = name.removeprefix("plate_").removesuffix("_displacement"), 0.0
                if wheel in self.driven:
                    plate_rows[row] = 3 * self.driven.index(wheel)
        every, samples = self.every, table.shape[2]
        for part in parts_of(samples * bool(plate_rows)):
            displacements = self.plates[part.start * every : part.stop * every : every]
            for row, column in plate_rows.items():
                table[row, rows_of_cars, part] = displacements[:, column]
        modal_weights = [car.weights(model.modal) for car, model in zip(self.factors, self.models, strict=True)]
        positions, rotations = list[Vector](), list[Vector]()
        for model, shape in zip(self.models, modal_weights, strict=True):
            # Acceleration channels from positions, see `recorded_acceleration`; rotations about three axes.
            car_rows, size = model.matrices, model.matrices.system.size
            at = np.array([car_rows.system.outputs[name][:size] for name in position_names]).reshape(-1, size)
            positions.append(at @ shape)
            rotations.append(np.concatenate([car_rows.body_rows[body][3:] for body in bodies]) @ shape)
        linear = [self._levels(model, watched) for model in self.models]
        levels_of_cars = [car.weights_of(outputs) for car, outputs in zip(self.factors, linear, strict=True)]
        reading = {
            "positions": self.cars.tiles(positions),
            "levels": self.cars.tiles(levels_of_cars),
            "rotations": self.cars.tiles(rotations),
            "loads": len(tyre_wheels),
            "tyre_of": np.array([law.plate for law in laws], dtype=np.int64),
            "watched": watched,
            "check_every": check_stride(self.interval),
            "always": any(name in tyre_wheels or name in load_names for name in channels),
            "wanted": np.array([rows.get(name, -1) for name in channels], dtype=np.int64),
            "offset": static_values,
            # Over differences d_k = y_k - y_(k-1) a sum of w_k y_k has the weights w_k + w_(k+1) + ... (Abel), because
            # the w_k add up to zero: the large common part of the positions drops out before it costs digits.
            "weights": (np.cumsum(WEIGHTS[::-1])[None, ::-1][:, 1:] / self.interval**2).astype(self.element),
        }
        width = curves + len(laws)
        y = aligned_table((PAST + INNER_BLOCK) * width, self.element)
        first_sample = y[(PAST - 1) * width :][:width]
        for lane, (car, _) in enumerate(self.cars.lanes):
            # First sample: a car at rest over plates with any displacement.
            outputs, columns = linear[car], self.factors[car].columns
            start = self.start[:, : len(columns)]
            initial = np.hstack([outputs.height[:, columns], outputs.velocity[:, columns]]) @ start.ravel()
            first_sample[levels:, lane][: len(initial)] = initial
            excess = forces_at_start(laws, columns, start)
            first_sample[curves:, lane] = excess
            for law, force in zip(laws, excess, strict=True):
                if law.plate >= 0:
                    # Its load is the linear one less g.
                    first_sample[levels + law.plate, lane] -= force
        # An output of a damper is half of the step before and half of the step after; there is no step before the
        # first sample.
        first_sample[speeds + 3 * count : curves] = 0.5 * self.feedback.settings["softest"][:, None]
        peaks = aligned_table(len(bodies) + 2 * watched, self.element)
        controls = [
            (damper, law.controlled)
            for damper, law in zip(matrices.damper_names, self.dampers[0], strict=True)
            if law.controlled
        ]
        with controllers(self.feedback.settings, controls, self.timestep) as check, exceptions_of_laws():
            self._step_blocks(reading, y, peaks, table, rows_of_cars)
            check()
        return [
            self._validity(peaks[:, lane].astype(float), model, bodies, static)
            for lane, (model, static) in enumerate(zip(self.models, self.tyre_load, strict=True))
        ]

    def _levels(self, model: PoleModel, watched: int) -> Outputs:
        """Return the levels of a car as outputs: linear tyre loads, filled up to `watched` rows, then loads."""
        tyres = tyre_outputs(model)
        idle = ((0, watched - len(tyres.poles)), (0, 0))
        outputs = tyres.changed(lambda rows: np.pad(rows, idle))
        return outputs if self.loads is None else outputs + load_outputs(model, self.loads)

    def _step_blocks(
        self, reading: Mapping[str, Any], y: Vector, peaks: Vector, table: Vector, rows_of_cars: Sequence[int]
    ) -> None:
        """Advance the cars block by block: fill the record March of the core, and call it, for each block."""
        cars, every, m = self.cars, self.every, self.cars.plates
        x = aligned_table((INNER_BLOCK + 1) * cars.states + BLOCK, self.element)
        # In single precision, differences of the states of rolling cars would lose digits: the core keeps their
        # changes.
        kept = self.element == SINGLE and self.models[0].slope.shape[1] > 0
        changes = aligned_table(((INNER_BLOCK + 1) * cars.rows["states"] + BLOCK) * kept, self.element)
        x[: len(cars.initial)] = cars.initial
        constant = march_fields(cars, self.feedback, reading)
        constant |= {"every": every, "x": x, "changes": changes, "y": y, "peaks": peaks, "out": table}
        constant |= {"cars": np.array(rows_of_cars, dtype=np.int64)}
        march = core().core_march_f if self.element == SINGLE else core().core_march_d
        # The last accelerations need AHEAD samples after the end.
        sample, end = 1, table.shape[2] + AHEAD
        while sample < end:
            size, step = min(SAMPLES, end - sample), (sample - 1) * every
            plates = self.inputs[step : step + size * every + 1]
            rates = np.zeros((len(plates), 4 * m), dtype=self.element)
            # Columns of the core: z', mean z' of the step that begins here, z, V tan(beta) - z'.
            rates[:, :m], rates[:, 2 * m : 3 * m], rates[:, 3 * m :] = plates[:, 1::3], plates[:, 0::3], plates[:, 2::3]
            rates[:-1, m : 2 * m] = np.diff(plates[:, 0::3], axis=0) / self.timestep
            displacements = plates[::every, 0::3]
            # z of each sample, and its difference from the sample before.
            plate_z = np.hstack([displacements[1:], np.diff(displacements, axis=0)]).astype(self.element)
            block = {"rates": rates, "plate_z": plate_z, "first": sample, "step": step}
            record = checked("March", packed("March", constant | block), LANES if self.element == SINGLE else 1)
            march(ctypes.c_void_p(record.address))
            release(table)
            sample += size

    @staticmethod
    def _validity(
        car_peaks: Vector, model: PoleModel, bodies: Sequence[str], tyre_load: Mapping[str, float]
    ) -> Validity:
        """Return the validity of the motion of a car from its peaks; see `outputs.c` of the core for their order."""
        # After the rotations a minimum and a maximum of each level alternate.
        rotations, low = car_peaks[: len(bodies)], car_peaks[len(bodies) :: 2]
        wheels = model.matrices.system.inputs
        return Validity(
            angles=dict(zip(bodies, np.sqrt(rotations).tolist(), strict=True)),
            loads={wheel: tyre_load[wheel] + load for wheel, load in zip(wheels, low.tolist(), strict=False)},
            one_sided=model.matrices.one_sided,
        )

    def statistics(self, validity: Validity, samples: int, wall_time: float) -> Statistics:
        """Return the statistics of the run of a car.

        Args:
            validity: extremes of its motion.
            samples: number of samples.
            wall_time: computing time [s].
        """
        return Statistics(
            engine="reduced",
            callback="native",
            timestep=self.timestep,
            steps=(samples - 1) * self.every,
            wall_time=wall_time,
            warnings=validity.warnings(),
            within_validity=validity.within_limits,
            energies=None,
        )
