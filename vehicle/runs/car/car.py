"""A car: its vehicle file read, its model built, its matrices, and its runs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Complex
from vehicle.drawing.notebook.cards import car_card
from vehicle.engines.linear.car_matrices import CarMatrices, car_matrices
from vehicle.engines.linear.car_modes import Mode, car_modes, require_stable
from vehicle.engines.linear.load_rows import LoadRows, load_rows
from vehicle.engines.linear.natural_modes import grows
from vehicle.engines.linear.variant_matrices import CarVariant, VariantTerms
from vehicle.engines.reduced.pole_model import PoleModel, pole_model
from vehicle.engines.reduced.quadratic_forms import QuadraticForms, quadratic_forms
from vehicle.engines.simulation.car_model import CarModel, build_model
from vehicle.engines.simulation.static_trim import StaticTrim
from vehicle.engines.simulation.stepping import Progress
from vehicle.errors import ConfigurationError
from vehicle.handed_down import HANDED
from vehicle.leftovers import mention
from vehicle.model.flexbody.body_model import body_model, equal_files, own_body_file
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.laws.controller_fmu import require_controllers
from vehicle.model.parameters.further_forces import new_tables
from vehicle.model.parameters.optional_keys import optional_paths
from vehicle.model.parameters.parameter_list import parameter_at
from vehicle.model.parameters.paths import Overrides, assignments
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.model.parameters.vehicle import Vehicle, load_file, load_vehicle, varied_file, vehicle_of
from vehicle.model.parameters.vehicle_variants import VehicleVariants
from vehicle.model.parameters.whole_body import restated
from vehicle.runs.car.given_forces import GivenForce, with_histories
from vehicle.runs.car.linear_response import force_frf, is_stuck, plate_frf
from vehicle.runs.car.origin import Origin
from vehicle.runs.car.outside_tests import with_range_notice
from vehicle.runs.car.road import Road
from vehicle.runs.car.road_estimate import RoadEstimate, road_estimate
from vehicle.runs.car.road_precision import with_duration
from vehicle.runs.car.run import Run
from vehicle.runs.car.simulated_run import simulated_run
from vehicle.runs.car.steady_car import SteadyCar
from vehicle.runs.car.stepped_car import stepped_car
from vehicle.signals.excitation.evaluation_start import evaluation_start
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.road_drive import evaluated_from
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.threads import one_blas_thread

if TYPE_CHECKING:
    from vehicle.model.parameters.parameter_list import Parameter
    from vehicle.runs.car.car_data import CarData


class Car(SteadyCar):
    """Car on a shaker or a road: its parameters, model, matrices, modes and runs.

    Args:
        vehicle: parameters; those of the Ford-Focus-like car of Bommer 2006 by default.
        folder: folder of the vehicle file, searched first for its superelement.
    """

    def __init__(self, vehicle: Vehicle | None = None, *, folder: Path | None = None) -> None:
        self.vehicle = load_vehicle() if vehicle is None else vehicle
        self.folder = folder
        self.origin: Origin = {"file": None, "overrides": []}
        self.overrides: tuple[str, ...] = ()
        self._checked: set[str] = set()
        self._stepped: Car | None = None
        self._base: Car | None = None
        self._step: tuple[str, ...] = ()
        self._driven: dict[tuple[str, ...], Car] = {}

    @classmethod
    def load(cls, path: Path | str | None = None, overrides: Overrides = ()) -> Car:
        """Read a car from a vehicle file.

        Args:
            path: TOML file, or the name of a shipped car; default: the car of Bommer 2006.
            overrides: {"damper.coulomb_friction": 93.75}, or texts "damper.coulomb_friction=93.75". A wrong file, name
                or value raises a `ConfigurationError`.
        """
        file = None if path is None else mention(vehicle_file(Path(path)))
        table, vehicle = load_file(file, changes := assignments(overrides))
        car = cls(vehicle, folder=None if file is None else file.parent)
        car.origin = {"file": None if file is None else str(file), "overrides": changes}
        car.overrides, car._table = tuple(changes), table
        return car

    def with_(self, overrides: Overrides) -> Car:
        """Return a car with other parameters; this car is not changed.

        Changes add to earlier ones; the inertia of the body follows another mass or CoG (docs/vehicle-file.md).
        `overrides` lists all steps: `Car.load(file, variant.overrides)` loads the same car.
        Variants of laws and masses are fast: their matrices come from terms of this car, computed once.
        A wrong name or value raises a `ConfigurationError`.
        """
        more = assignments(overrides)
        vehicle = self._variants.variant(more)
        optional = partial(optional_paths, vehicle.table, self._home)
        more += restated(self.vehicle.table, vehicle.table, self.overrides, optional)
        car = Car(vehicle, folder=self.folder)
        car.overrides = (*self.overrides, *more)
        car.origin = {"file": self.origin["file"], "overrides": list(car.overrides)}
        car._base, car._step = self, tuple(more)
        return car

    def with_channel(self, name: str, at: str | Sequence[float], *, on: str = "body") -> Car:
        """Return this car with a further output point: channels `NAME_acc_x`, `_y`, `_z`.

        Args:
            name: name of the point, for example "tunnel".
            at: coordinates in the design position [m], or the name of a hardpoint.
            on: part that the point moves with; an unknown one raises a `ConfigurationError`.
        """
        if any(output.name == name for output in self.vehicle.composition.outputs):
            raise ConfigurationError(f"with_channel: the car already has an output {name!r}; choose another name")
        point = at if isinstance(at, str) else np.asarray(at).tolist()
        return self.with_({f"outputs.{name}.at": point, f"outputs.{name}.on": on})

    def _of_drive(self, overrides: tuple[str, ...]) -> Car:
        """Return the car of a drive; the last is stored with its matrices and second order for a further run."""
        if not overrides:
            return self
        self._driven = driven = {overrides: self._driven.get(overrides) or self.with_(overrides)}
        return driven[overrides]

    # Made by the first variant: a cycle, and the cars of a sweep must be freed without the garbage collector.
    @cached_property
    def _variants(self) -> VehicleVariants:
        return VehicleVariants(self.vehicle, self._home, self._anew)

    @property
    def _home(self) -> Path:
        return self.folder or Path()

    @cached_property
    def _table(self) -> Mapping[str, Any]:
        """Return the table of the vehicle file; in a variant of a loaded car, `curve` still names the law files."""
        if self._base is None:
            return self.vehicle.table
        try:
            return varied_file(self._base._table, self._step, self._home)
        except ConfigurationError:  # the variation sets numbers that a file has given
            return self.vehicle.table

    def _anew(self, overrides: Iterable[str]) -> Vehicle:
        """Return the parameters of this car with other values, composed again from the vehicle table."""
        return vehicle_of(varied_file(self._table, overrides, self._home), self.folder)

    def __getstate__(self) -> dict[str, Any]:
        """Return the parameters, which make the same car in another process; models and matrices are built there."""
        state = dict.fromkeys(("vehicle", "folder", "origin", "overrides", "_base", "_step", "_table"))
        return {name: self.__dict__[name] for name in state if name in self.__dict__}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Make a car of its parameters."""
        self.__dict__ |= {"_checked": set(), "_stepped": None, "_driven": {}, **state}

    def save(self, file: Path | str, *, force: bool = False) -> Path:
        """Write the car as a vehicle file, from which `Car.load` makes the same car; see `vehicle.save_car`."""
        return Path(HANDED["save_car"](self, file, force=force))

    def show(self) -> CarData:
        """Return masses, loads, stiffnesses, frequencies, geometry and parameters; `print` shows them."""
        from vehicle.runs.car.car_data import car_data

        return car_data(self)

    def search(self, words: str = "") -> list[Parameter]:
        """Return the parameters (default: all) with these words in path or meaning: value, unit, range, source."""
        from vehicle.runs.car.car_data import car_parameters

        return [parameter for parameter in car_parameters(self) if parameter.matches(words)]

    def __getitem__(self, path: str) -> Parameter:
        """Return a parameter with value, unit, range and source; every path that `with_` sets has one.

        Args:
            path: whole path or its end, for example "front.damper.viscous" or "damper.viscous"; of one component
                "tyre.stiffness.z"; "*.damper.viscous" for all parameters with this end, if they are equal. No parameter
                of the path, several, or a table raise a `ConfigurationError`.
        """
        from vehicle.runs.car.car_data import source_file

        return parameter_at(self.vehicle, path, source_file(self), lambda: [*self._optional, *new_tables([path])])

    @cached_property
    def _optional(self) -> list[str]:
        return optional_paths(self.vehicle.table, self._home)

    def __eq__(self, other: object) -> bool:
        """True if all parameters and the body models are equal, however the values were set."""
        if not isinstance(other, Car):
            return NotImplemented
        files = (own_body_file(car.vehicle, car.folder) for car in (self, other))
        return self.vehicle == other.vehicle and equal_files(*files)

    def __hash__(self) -> int:
        """Return the hash of name and wheels, which equal cars share."""
        return hash((self.vehicle.name, self.vehicle.wheels))

    def __repr__(self) -> str:
        """One line."""
        changes = f", {'; '.join(self.overrides)}" if self.overrides else ""
        return f"Car({self.vehicle.name}, wheels {', '.join(self.vehicle.wheels)}{changes})"

    def _repr_html_(self) -> str:
        return car_card(self)

    @cached_property
    @one_blas_thread()
    def trimmed_body(self) -> Superelement:
        """Superelement of the free trimmed body: from its file, or computed from a design on these hardpoints."""
        return body_model(self.vehicle, self.folder)

    @cached_property
    @one_blas_thread()
    def model(self) -> CarModel:
        """Assembled, compiled and trimmed MuJoCo model."""
        return build_model(self.vehicle, self.trimmed_body)

    @cached_property
    def _terms(self) -> VariantTerms:
        return VariantTerms(self.model, self.matrices, self.trimmed_body)

    @cached_property
    @one_blas_thread()
    def _from_terms(self) -> CarVariant | None:
        """Matrices from the terms of the base car; None if this car must be built."""
        return None if self._base is None else self._base._terms.variant(self.vehicle)

    @cached_property
    @one_blas_thread()
    def matrices(self) -> CarMatrices:
        """Mass, damping and stiffness matrices of the same model in its design position."""
        if self._from_terms:
            return self._from_terms.matrices
        return car_matrices(self.model.model, self.model.static, self.vehicle.composition.forces)

    @property
    def geometry(self) -> Car:
        """Car whose model has the geometry of this car: its base car if they differ only in laws and masses."""
        return self._base.geometry if self._base and self._from_terms else self

    def geometry_motion(self, coordinates: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return displacements, (n, ...), over the velocity coordinates of `geometry`: another mass has other modes."""
        if not (self._base and self._from_terms):
            return coordinates
        return self._base.geometry_motion(self._from_terms.change.reference_motion(coordinates))

    @property
    def static(self) -> StaticTrim:
        """Preloads, and static loads of the tyres and of other contacts with the ground."""
        return self._from_terms.static if self._from_terms else self.model.static

    @cached_property
    @one_blas_thread()
    def poles(self) -> PoleModel:
        """Modal form of the same matrices, one scalar equation per pole, for the reduced engine."""
        return pole_model(self.matrices)

    @cached_property
    @one_blas_thread()
    def quadratic_forms(self) -> QuadraticForms:
        """Second order of the equations of motion, for the errors of the reduced engine."""
        return quadratic_forms(self.model, self.poles)

    @cached_property
    @one_blas_thread()
    def load_rows(self) -> LoadRows:
        """Output rows for the forces of all elements and the suspension travel, in the coordinates of the matrices."""
        return load_rows(self.model, self.matrices)

    @one_blas_thread()
    def check(self, engine: str = "mujoco") -> None:
        """Check once that the car is stable and, for "mujoco", that its time step is small enough.

        Raises:
            ConfigurationError, DataError, MissingPartError: car, time step or FMU of a controller cannot be used.
        """
        if engine in self._checked:
            return
        require_controllers([damper.law.controlled for damper in self.vehicle.composition.dampers])
        if engine == "mujoco":
            self.stepped()
        elif np.any(grows(self.poles.poles)):
            require_stable(self.model, self.matrices, self.poles.poles)
        self._checked.add(engine)

    @one_blas_thread()
    def stepped(self) -> Car:
        """Return this car with the time step of its file, or the largest step that passes all checks.

        Raises:
            ConfigurationError: the given step is too large, or no step is small enough.
        """
        if self._stepped is None and "mujoco" not in self._checked:
            stepped = stepped_car(self)
            self._stepped = None if stepped is self else stepped  # a car holds no reference to itself
            self._checked.add("mujoco")
        return self._stepped or self

    @one_blas_thread()
    def modes(self, damper: str = "stuck", highest: float = 60.0) -> list[Mode]:
        """Return the modes of the assembled car up to a frequency [Hz], with the dampers "stuck" or "sliding"."""
        names = self.geometry.model.superelement.mode_names
        return car_modes(self.matrices, stuck=is_stuck(damper), highest=highest, names=names)

    @one_blas_thread()
    def matrix_frf(
        self, channels: Sequence[str], frequency: npt.ArrayLike, *, damper: str = "stuck", wheel: str | None = None
    ) -> Complex:
        """Return linear FRFs of acceleration channels to a plate [m/s2 per m], shape (channels, frequencies).

        Args:
            channels: names of acceleration channels.
            frequency: frequencies [Hz].
            damper: state of all dampers, "stuck" or "sliding".
            wheel: wheel on the plate; default: the shaker wheel.
        """
        return plate_frf(self, channels, frequency, is_stuck(damper), wheel or self.vehicle.shaker_wheel)

    @one_blas_thread()
    def force_frf(
        self, channels: Sequence[str], frequency: npt.ArrayLike, *, force: str, damper: str = "stuck"
    ) -> Complex:
        """Return linear FRFs to an applied force [m/s2 per N or N m]; further arguments as in `matrix_frf`.

        H(jw) of (s^2 M + s C + K) u = l, s = jw, with the row l of the force; its history plays no part.

        `force` is the name of a force, for example "crank_torque" of [force.crank_torque].
        """
        return force_frf(self, channels, frequency, is_stuck(damper), force)

    @one_blas_thread()
    def estimate(self, source: Road, channels: Sequence[str] = ()) -> RoadEstimate:
        """Return comfort and tyre loads on all roads of a class without a run, by statistical linearisation.

        Args:
            source: class and speed, for example road("C", 80).
            channels: further acceleration channels, for `RoadEstimate.rms`.

        Raises:
            ConfigurationError, SimulationError: a car or road that is not covered (docs/theory/estimate.md).
        """
        return road_estimate(self, source.under(self.vehicle, self.overrides), channels)

    @one_blas_thread()
    def run(
        self,
        source: Signal | Road | Path | str,
        engine: str = "mujoco",
        *,
        progress: Progress | None = None,
        channels: Sequence[str] | None = None,
        skip: float | None = None,
        forces: Mapping[str, GivenForce] | None = None,
        stated_errors: bool = True,
    ) -> Run:
        """Simulate the car on a signal or a road; `run.engine_reason` is the reason for the choice of the engine.

        Args:
            source: displacement of the plates: a `Signal`, a file or the name of a shipped one, for example "low.csv";
                or a road, for example road("C", 80), on which the tyres roll.
            engine: "mujoco"; "reduced", 3 times faster (sweeps tens), with all laws but linear geometry; "auto":
                "reduced", and "mujoco" if the motion leaves the valid range.
            progress: called with the finished fraction (MuJoCo only).
            channels: names of the recorded channels; default: all but `vehicle.requested_channels`.
            skip: excluded time at the beginning [s]; default: 0, on a road at least 2, until the last wheel has risen.
            forces: {"crank_torque": values}, in place of the history in the vehicle file: values at the times of the
                signal, or a function of the times [s] that returns them [N or N m].
            stated_errors: compute the errors from linear geometry; without them, the time is 0.4 of a first reduced
                run and 0.7 of a further one, and the valid range is narrower (`vehicle.engines.reduced.validity`).

        Raises:
            ConfigurationError, DataError: an unknown name, a value out of range, an unstable car, a bad file.
            SimulationError: the run failed.
        """
        if isinstance(source, Road):
            drive = with_duration(self, evaluated_from(source.under(self.vehicle, self.overrides), skip))
            start = evaluation_start({drive.name: (signal := drive.signal()).duration}, skip, drive.skip)
            car, named = self._of_drive(drive.overrides), replace(signal, source=drive.name)
            run = car.run(named, engine, progress=progress, channels=channels, skip=start, forces=forces,
                          stated_errors=stated_errors)  # fmt: skip
            return replace(run, road=drive.summary(signal))
        wheel = self.vehicle.shaker_wheel
        signal = source if isinstance(source, Signal) else read_signal(find_input(source), wheel=wheel)
        start = evaluation_start({signal.source: signal.duration}, skip, 0.0)
        driven = with_histories(self, forces, signal.time) if forces else self
        car, recording, reason = simulated_run(driven, signal, progress, engine, channels, stated=stated_errors)
        return with_range_notice(Run(car=car, signal=signal, recording=recording, engine_reason=reason, skip=start))
