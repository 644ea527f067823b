"""A car: its vehicle file read, its model built, its matrices, and its runs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.drawing.notebook.cards import car_card
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.load_rows import LoadRows, load_rows
from vehicle.engines.linear.matrices import CarMatrices, car_matrices
from vehicle.engines.linear.modes import Mode, car_modes, require_stable
from vehicle.engines.linear.natural_modes import grows
from vehicle.engines.linear.response import frequency_response as exact_response
from vehicle.engines.linear.step_error import accurate_step, require_accurate_step
from vehicle.engines.linear.varied import Terms, VariedCar
from vehicle.engines.reduced.march import has_compiler
from vehicle.engines.reduced.pole_model import PoleModel, pole_model
from vehicle.engines.reduced.run import simulate_reduced
from vehicle.engines.simulation.car_model import CarModel, build_model
from vehicle.engines.simulation.judgement import require_finite, require_samples
from vehicle.engines.simulation.static_trim import StaticTrim
from vehicle.engines.simulation.stepping import Progress, simulate
from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.body_model import body_model
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.parameters.optional_keys import optional_paths
from vehicle.model.parameters.paths import assignments
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.model.parameters.varied import Family
from vehicle.model.parameters.vehicle import Vehicle, load_vehicle, vehicle_of
from vehicle.model.parameters.whole_body import varied_table
from vehicle.names import ENGINES
from vehicle.runs.car.road import Road
from vehicle.runs.car.run import Run
from vehicle.signals.excitation.evaluation_start import evaluation_start
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.excitation.signal_file import read_signal

Overrides = Iterable[str] | Mapping[str, Any]
"""Other values of parameters: path to value, or texts "path=value"."""


class Car:
    """Car on a shaker or a road: its parameters, model, matrices, modes and runs.

    Args:
        vehicle: parameters; those of the Ford-Focus-like car of Bommer 2006 by default.
        folder: where the vehicle file lies, searched first for its superelement.
    """

    def __init__(self, vehicle: Vehicle | None = None, *, folder: Path | None = None) -> None:
        self.vehicle = load_vehicle() if vehicle is None else vehicle
        self.folder = folder
        self.origin: dict[str, object] = {"file": None, "overrides": []}
        self.overrides: tuple[str, ...] = ()
        self._checked: set[str] = set()
        self._stepped: Car | None = None
        self._base: Car | None = None
        self._family = Family(self.vehicle, folder or Path(), self._anew)

    @classmethod
    def load(cls, path: Path | str | None = None, overrides: Overrides = ()) -> Car:
        """Read a car from a vehicle file.

        Args:
            path: TOML file, or the name of a shipped car; that of Bommer 2006 by default.
            overrides: path to value, as {"damper.coulomb_friction": 93.75}; or texts "damper.coulomb_friction=93.75".

        Returns:
            The car.

        Raises:
            ConfigurationError: the file, a name or a value is wrong.
        """
        file = None if path is None else vehicle_file(Path(path))
        changes = assignments(overrides)
        car = cls(load_vehicle(file, changes), folder=None if file is None else file.parent)
        car.origin = {"file": None if file is None else str(file), "overrides": changes}
        car.overrides = tuple(changes)
        car._family = Family(car.vehicle, car.folder or Path(), lambda more: load_vehicle(file, [*changes, *more]))
        return car

    def varied(self, overrides: Overrides) -> Car:
        """This car with other values in their places, for many cars of one kind.

        Where the values move numbers of laws and masses alone, its matrices and static loads come from terms of this
        car, which are read once (`vehicle.engines.linear.varied`), and its MuJoCo model is built only where it is asked
        for. Every other car is built, as by `load`.

        Args:
            overrides: as of `load`, after those of this car.

        Raises:
            ConfigurationError: a name or a value is wrong.
        """
        more = assignments(overrides)
        car = Car(self._family.vehicle_of(more, self.overrides), folder=self.folder)
        car.overrides = (*self.overrides, *more)
        car.origin = {**self.origin, "overrides": list(car.overrides)}
        car._base = self
        return car

    def _anew(self, overrides: Iterable[str]) -> Vehicle:
        """This car with other values, composed anew from its table."""
        own, folder = self.vehicle.table, self.folder
        optional = partial(optional_paths, own, folder or Path())
        return vehicle_of(varied_table(own, list(overrides), optional, self.overrides), folder)

    def __repr__(self) -> str:
        """One line."""
        changes = f", {'; '.join(self.overrides)}" if self.overrides else ""
        return f"Car({self.vehicle.name}, wheels {', '.join(self.vehicle.wheels)}{changes})"

    def _repr_html_(self) -> str:
        return car_card(self)

    @cached_property
    def trimmed_body(self) -> Superelement:
        """The superelement of the free trimmed body: of its file, or computed from a design on these hardpoints."""
        return body_model(self.vehicle, self.folder)

    @cached_property
    def model(self) -> CarModel:
        """The assembled, compiled and trimmed MuJoCo model."""
        return build_model(self.vehicle, self.trimmed_body)

    @cached_property
    def _terms(self) -> Terms:
        return Terms(self.model, self.matrices, self.trimmed_body)

    @cached_property
    def _from_terms(self) -> VariedCar | None:
        """What the terms of another car make of this one; None where it has to be built."""
        return None if self._base is None else self._base._terms.car_of(self.vehicle)

    @cached_property
    def matrices(self) -> CarMatrices:
        """Mass, damping and stiffness matrices of the same model in its design position."""
        if self._from_terms:
            return self._from_terms.matrices
        # By what the car is, not by what this process has compiled: the same car has the same matrices to the bit.
        return car_matrices(self.model.model, self.model.static, compiled=self._base is not None)

    @property
    def static(self) -> StaticTrim:
        """Preloads, and static loads of the tyres and of other contacts with the ground."""
        return self._from_terms.static if self._from_terms else self.model.static

    @cached_property
    def poles(self) -> PoleModel:
        """The same matrices as scalar equations of the poles: what the reduced engine marches."""
        return pole_model(self.matrices)

    @cached_property
    def load_rows(self) -> LoadRows:
        """Forces of all elements and the suspension travel as rows over the same matrices."""
        return load_rows(self.model, self.matrices)

    def check(self, engine: str = "mujoco") -> None:
        """Refuse a car that cannot be run, before anything is: for each engine once.

        Args:
            engine: as of `run`; the time step is asked of "mujoco" alone.

        Raises:
            ConfigurationError: no such car can be, a motion of it grows by itself, or the step does not answer it.
        """
        if engine in self._checked:
            return
        if engine == "mujoco":
            self.stepped()
        elif np.any(grows(self.poles.poles)):
            require_stable(self.model, self.matrices, self.poles.poles)
        self._checked.add(engine)

    def stepped(self) -> Car:
        """This car with a step that answers it: its own, or where none is given the largest that does.

        Raises:
            ConfigurationError: the given step does not, or none.
        """
        if self.vehicle.solver.timestep is not None:
            if "mujoco" not in self._checked:
                require_accurate_step(self.model, self.matrices)
                self._checked.add("mujoco")
            return self
        if self._stepped is None:
            step = accurate_step(self.model, self.matrices)
            solver = {**self.vehicle.table["solver"], "timestep": step}
            car = Car(vehicle_of({**self.vehicle.table, "solver": solver}, self.folder), folder=self.folder)
            car.origin, car.overrides = self.origin, self.overrides
            car._checked = {*self._checked, "mujoco"}
            self._stepped = car
        return self._stepped

    def modes(self, damper: str = "stuck", highest: float = 60.0) -> list[Mode]:
        """Modes of the assembled car up to a frequency [Hz], with the dampers "stuck" or "sliding"."""
        model = self._base.model if self._base and self._from_terms else self.model
        names = model.superelement.mode_names
        return car_modes(self.matrices, stuck=_is_stuck(damper), highest=highest, names=names)

    def matrix_frf(
        self, channels: Sequence[str], frequency: npt.ArrayLike, *, damper: str = "stuck", wheel: str | None = None
    ) -> npt.NDArray[np.complex128]:
        """Linear FRFs [m/s2 per m] at given frequencies [Hz], shape (channels, frequencies).

        Args:
            channels: accelerations.
            frequency: lines [Hz].
            damper: "stuck" or "sliding", all of them.
            wheel: whose plate moves; that of the shaker by default.
        """
        wheel = wheel or self.vehicle.shaker_wheel
        self.vehicle.require_wheels((wheel,))
        self.vehicle.require_channels(channels, self.vehicle.acceleration_channels)
        form = first_order(self.matrices.system, stuck=_is_stuck(damper))
        driven = [float(name == wheel) for name in self.vehicle.wheels]
        return exact_response(form, frequency, channels, "acceleration", driven=driven)

    def run(
        self,
        source: Signal | Road | Path | str,
        progress: Progress | None = None,
        *,
        engine: str = "mujoco",
        channels: Sequence[str] | None = None,
        skip: float | None = None,
    ) -> Run:
        """Simulate the car on a signal or a road.

        Args:
            source: displacement of the plates; a file of it or the name of a shipped one, as "low.csv"; or a road, as
                Road("C", speed=80), on which the tyres roll.
            progress: called with the finished fraction now and then (MuJoCo only; the reduced engine is done at once).
            engine: "mujoco"; "reduced", hundreds of times faster, linear but for the dampers; "auto", which takes the
                reduced one and falls back to MuJoCo where the motion leaves its validity or numba is missing.
            channels: names of the recorded channels, those on request (`vehicle.requested_channels`) among
                them; by default all but those.
            skip: time at the beginning that comfort and slip shares leave out [s]; by default 0, on a road until the
                last wheel has risen with it, at least 2.

        Returns:
            The run; `run.recording.statistics.engine` says which engine made it, `run.engine_reason` why.

        Raises:
            ConfigurationError: the engine or a channel does not exist, a value of the road or `skip` is out of range, a
                motion of the car grows by itself, or the time step of MuJoCo does not answer it.
            DataError: a file cannot be read or holds bad data.
            MissingPartError: the reduced engine was asked for and numba is not installed.
            SimulationError: the run could not be carried through.
        """
        if isinstance(source, Road):
            drive = source.under(self.vehicle, self.overrides)
            signal = drive.signal()
            start = evaluation_start({drive.name: signal.duration}, skip, drive.skip)
            car = self.varied(drive.overrides) if drive.overrides else self
            run = car.run(replace(signal, source=drive.name), progress, engine=engine, channels=channels)
            return replace(run, skip=start, road=drive.summary(signal))
        signal = (
            source if isinstance(source, Signal) else read_signal(find_input(source), wheel=self.vehicle.shaker_wheel)
        )
        start = evaluation_start({signal.source: signal.duration}, skip, 0.0)
        run = self._simulated(signal, progress, engine, channels)
        return replace(run, skip=start) if start else run

    def _simulated(self, signal: Signal, progress: Progress | None, engine: str, channels: Sequence[str] | None) -> Run:
        """Return the run on a signal; arguments and errors as of `run`."""
        if engine not in ENGINES:
            raise ConfigurationError(f"engine: found {engine!r}, allowed are {', '.join(ENGINES)}")
        known = self.vehicle.channels
        self.vehicle.require_channels(channels or (), (*known, *self.vehicle.requested_channels))
        self.vehicle.require_wheels(signal.wheels)
        names = known if channels is None else channels
        more = [name for name in names if name not in known]
        loads = [name for name in more if name in self.vehicle.load_channels]
        require_samples(signal.duration * self.vehicle.solver.record_rate, len(names))
        reason = "asked for"
        if engine == "auto" and not has_compiler():
            reason = "numba, which the reduced engine needs, is not installed"
        elif engine != "mujoco":
            self.check("reduced")
            recording = simulate_reduced(
                self.poles,
                signal,
                dampers=[damper.law for damper in self.vehicle.composition.dampers],
                record_rate=self.vehicle.solver.record_rate,
                tyre_load=self.static.tyre_load,
                channels=channels,
                loads=self.load_rows if loads else None,
            )
            require_finite(recording)
            if engine == "reduced" or recording.statistics.within_validity:
                if engine == "auto":
                    reason = "the motion stayed within the validity of the reduced engine"
                return Run(car=self, signal=signal, recording=recording, engine_reason=reason)
            reason = "; ".join(recording.statistics.warnings)
        car = self.stepped()
        recording = simulate(car.model, signal, progress=progress, requested=more)
        require_finite(recording)
        if channels is not None:
            recording = recording.only(channels)
        return Run(car=car, signal=signal, recording=recording, engine_reason=reason)


def _is_stuck(damper: str) -> bool:
    if damper not in ("stuck", "sliding"):
        raise ConfigurationError(f"damper: found {damper!r}, allowed are stuck, sliding")
    return damper == "stuck"
