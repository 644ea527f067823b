"""Run of a car in its periodic state: no start-up, and exact derivatives by its parameters."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.engines.linear.load_rows import stop_rows
from vehicle.engines.reduced.car_table import damper_nodes
from vehicle.engines.reduced.validity import Validity, rotating_bodies, rotation_outputs
from vehicle.engines.simulation.recording import Recording, Statistics
from vehicle.engines.simulation.tyre_contact import lift_off_notices, pulling_tyres
from vehicle.engines.steady.channel_rows import channel_rows, plain_rows
from vehicle.engines.steady.driven_car import DrivenCar
from vehicle.engines.steady.law_ports import Play
from vehicle.engines.steady.plate_lines import plate_lines, require_period
from vehicle.engines.steady.splitting import PeriodicForces
from vehicle.engines.steady.tangent import change_of_state
from vehicle.errors import ConfigurationError
from vehicle.names import channel_units
from vehicle.runs.car.outside_tests import with_range_notice
from vehicle.runs.car.road import Road
from vehicle.runs.car.road_precision import with_duration
from vehicle.runs.car.run import Run
from vehicle.runs.car.simulated_run import NOT_COMPUTED, simulated_run, with_notices
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.road_drive import RoadDrive
from vehicle.signals.excitation.signal import Signal, uniform_time
from vehicle.signals.excitation.signal_file import read_signal

if TYPE_CHECKING:
    from vehicle.runs.car.car import Car

RATE = 4000.0
"""Minimum rate of the samples of the state [Hz]: the force of friction jumps between two samples, so that the error of
an RMS falls as 1/rate; with 4 kHz it is 0.005 % at the seat rail and 0.01 % at a knuckle."""

TOLERANCE = 1e-4
"""Residual of the state over its largest force; with 1e-8 no RMS of `focus_road` and `sedan` differs by 4e-6."""

FINER = 1e-7
"""Residual of a state whose derivative is computed."""

RUN_IN = 8.0
"""Time before the evaluated period [s] in which the weighting filters (0.4 Hz) settle to 1e-6."""

STEP = 1e-4
"""Relative step of a parameter: the state stays the same, so that the difference has an error of 1e-7."""

MARCHED = 40.0
"""Time of a march in place of a state that does not end [s], at least four periods."""

SLOWEST_CHECK = 60.0
"""Highest frequency of rotations of parts for the valid range [Hz]."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class SteadyRun(Run):
    """Run of `Car.steady`: the evaluated span is one period of the state.

    Attributes:
        state: forces, motions and slope velocities of the ports; None for a run in time.
        drive: car between its ports; None for a run in time.
    """

    state: PeriodicForces | None = None
    drive: DrivenCar | None = None
    _pairs: dict[str, tuple[float, Run, Run]] = field(default_factory=dict)

    @overload
    def gradient(self, paths: str, figure: str = ...) -> float: ...
    @overload
    def gradient(self, paths: list[str] | tuple[str, ...], figure: str = ...) -> dict[str, float]: ...
    def gradient(self, paths: str | list[str] | tuple[str, ...], figure: str = "weighted") -> float | dict[str, float]:
        """Return the derivative of a figure by parameters, in the unit of the figure per unit of the parameter.

        The derivative of the state is the solution of one linear system (`vehicle.engines.steady.tangent`); the figure
        is differentiated along it.

        Args:
            paths: parameters, for example "front.damper.viscous", or a list of them.
            figure: a smooth figure of `Run.figure`, for example "weighted", "tyre_load_rms" or "rms:seat rail z"; a
                share of time jumps from sample to sample and has no derivative.

        Returns:
            The derivative, or path to derivative.

        Raises:
            ConfigurationError: a parameter without a number other than 0, a figure that jumps, or a state that a run in
                time has replaced.
        """
        if isinstance(paths, str):
            return self._derivative(paths, figure)
        return {path: self._derivative(path, figure) for path in paths}

    def sensitivity(self, path: str) -> dict[str, Vector]:
        """Return the derivative of each channel by a parameter over the time of the run; see `gradient`."""
        step, less, more = self._pair(path)
        return {name: 0.5 * (more.recording[name] - less.recording[name]) / step for name in self.channels}

    def _derivative(self, path: str, figure: str) -> float:
        if figure.partition(":")[0].split("_")[0] in JUMPING:
            raise ConfigurationError(
                f"gradient: {figure} counts samples, and jumps; choose an RMS, comfort or a tyre load"
            )
        step, less, more = self._pair(path)
        return 0.5 * (more.figure(figure) - less.figure(figure)) / step

    def _pair(self, path: str) -> tuple[float, Run, Run]:
        """Return the step of a parameter, and the runs one step lower and higher along the derivative of the state."""
        if path not in self._pairs:
            self._pairs[path] = self._varied(path)
        return self._pairs[path]

    def _varied(self, path: str) -> tuple[float, Run, Run]:
        if self.state is None or self.drive is None:
            raise ConfigurationError("gradient: a run in time has no derivative; use sweep")
        value = self.car[path].value
        if isinstance(value, bool) or not isinstance(value, int | float) or value == 0.0:
            raise ConfigurationError(
                f"gradient: {path} is {value!r}, must be a number other than 0; choose a component"
            )
        step = STEP * abs(value)
        cars = [self.car.with_({path: value + sign * step}) for sign in (-1.0, 1.0)]
        less, more = (
            DrivenCar(car.poles, _laws(car), car.static.tyre_load, self.drive.plates, self.drive.period) for car in cars
        )
        state = self.drive.state(FINER, start=self.state)
        change = change_of_state(self.drive, state, less, more, step)
        runs = []
        for sign, car, driven in ((-1.0, cars[0], less), (1.0, cars[1], more)):
            moved = replace(
                state,
                force=state.force + sign * step * change.force,
                motion=state.motion + sign * step * change.motion,
                slope=state.slope + sign * step * change.slope,
            )
            channels = _histories(car, driven, moved, self.channels)
            recording = replace(self.recording, channels=_extended(channels, self.recording.time.size, self._first))
            runs.append(Run(car=car, signal=self.signal, recording=recording, skip=self.skip, road=self.road))
        return step, runs[0], runs[1]

    @property
    def _first(self) -> int:
        """Return the first sample of the evaluated period."""
        return round(self.skip / self.recording.timestep)


JUMPING = ("stick", "slip", "saturated", "first", "settling")
"""First words of figures that count samples."""


def car_steady(car: Car, source: Signal | Road | Any, channels: Sequence[str] | None) -> SteadyRun:
    """Return the periodic state of a car; see `Car.steady`."""
    if isinstance(source, Road):
        drive = with_duration(car, source.under(car.vehicle, car.overrides))
        if not isinstance(drive, RoadDrive) or drive.span is None or drive.envelope is not None:
            raise ConfigurationError(
                f"steady: {source!r} does not repeat; take a road class with its default period and contact patch, "
                "or Car.run"
            )
        signal = replace(drive.signal(), source=drive.name)
        run = _state(car._of_drive(drive.overrides), signal, signal.duration - drive.span, channels)
        return replace(run, road=drive.summary(signal))
    signal = source if isinstance(source, Signal) else read_signal(find_input(source), wheel=car.vehicle.shaker_wheel)
    if signal.slope_velocity:
        raise ConfigurationError(f"steady: {signal.source} has the slopes of cams; use Car.run")
    require_period(signal, 0.0)
    before = max(1, math.ceil(RUN_IN / signal.duration))
    period = {wheel: values[:-1] for wheel, values in signal.displacement.items()}
    displacement = {wheel: np.append(np.tile(each, before + 1), each[0]) for wheel, each in period.items()}
    size = next(iter(displacement.values())).size
    whole = replace(
        signal, time=uniform_time(samples=size, timestep=signal.timestep), displacement=displacement, profile={}
    )
    return _state(car, whole, before * signal.duration, channels)


def _state(car: Car, signal: Signal, begin: float, channels: Sequence[str] | None) -> SteadyRun:
    """Return the state on a signal that is one period from `begin` [s] on."""
    require_period(signal, begin)
    vehicle, period = car.vehicle, signal.duration - begin
    names = tuple(vehicle.channels if channels is None else channels)
    vehicle.require_channels(names, (*vehicle.channels, *vehicle.requested_channels))
    vehicle.require_wheels(signal.wheels)
    rate = vehicle.solver.record_rate
    count = round(period * rate)
    if abs(count - period * rate) > 1e-6 * count:
        raise ConfigurationError(
            f"steady: a period of {period:g} s is no whole number of samples at solver.record_rate={rate:g} Hz; "
            "choose another rate"
        )
    car.check("reduced")
    started = clock.perf_counter()
    finer = math.ceil(RATE / rate)
    finer += count * finer % 2
    plates = plate_lines(signal, vehicle.wheels, begin, count * finer // 2)
    driven = DrivenCar(car.poles, _laws(car), car.static.tyre_load, plates, period)
    # On a road the iteration never ends with Jenkins elements, whose port is a displacement.
    state = None if any(isinstance(port, Play) for port in driven.ports) else driven.state(TOLERANCE)
    if state is None or not state.ended[0]:
        return _marched(car, signal, begin, names)
    histories = _histories(car, driven, state, names)
    size, first = round(signal.duration * rate) + 1, round(begin * rate)
    statistics = _statistics(car, driven, state, histories, rate)
    recording = Recording(
        time=uniform_time(samples=size, timestep=1.0 / rate),
        channels=_extended(histories, size, first),
        units=channel_units(names),
        excited=_excited(signal),
        pose_time=np.zeros(0),
        poses=np.zeros((0, 0)),
        statistics=replace(statistics, wall_time=clock.perf_counter() - started),
    )
    reason = f"periodic state, {int(state.iterations[0])} iterations"
    run = SteadyRun(
        car=car, signal=signal, recording=recording, engine_reason=reason, skip=begin, state=state, drive=driven
    )
    return with_range_notice(run)


def _laws(car: Car) -> list[Any]:
    return [damper.law for damper in car.vehicle.composition.dampers]


def _excited(signal: Signal) -> tuple[str, ...]:
    return tuple(wheel for wheel in signal.wheels if np.ptp(signal.displacement[wheel]) > 0.0)


def _extended(histories: dict[str, Vector], size: int, first: int) -> dict[str, Vector]:
    """Return histories of one period as records of n samples, in which a period begins at a sample."""
    return {name: np.resize(np.roll(each, first % each.size), size) for name, each in histories.items()}


def _histories(car: Car, driven: DrivenCar, state: PeriodicForces, names: Sequence[str]) -> dict[str, Vector]:
    """Return the histories of channels in a period."""
    model, laws, interval = driven.model, _laws(car), 1.0 / car.vehicle.solver.record_rate
    asked = set(names) & set(car.vehicle.load_channels)
    loads = car.load_rows if asked else stop_rows(model.matrices, laws)
    plates = {f"plate_{wheel}_displacement": row for row, wheel in enumerate(car.vehicle.wheels)}
    rows = [name for name in names if name not in plates]
    forces, motions = (driven.cycle.amplitudes(each[0]) for each in (state.force, state.motion))
    lines = driven.lines(channel_rows(model, rows, loads), forces, motions, state.slope[0], interval)
    statics = {f"tyre_{wheel}_force_z": load for wheel, load in car.static.tyre_load.items()}
    statics |= dict(zip(loads.names, loads.static.tolist(), strict=True))
    for name, law in zip(model.matrices.damper_names, laws, strict=True):
        preload = damper_nodes(law)[0]["rest_force"]
        statics[f"{name}_force"] = float(preload) + statics.get(f"{name}_stop_force", 0.0)
    every = driven.cycle.samples // round(driven.period / interval)
    table = dict(zip(rows, lines, strict=True)) | {
        name: driven.plates[row] for name, row in plates.items() if name in names
    }
    return {name: statics.get(name, 0.0) + driven.cycle.histories(table[name])[::every] for name in names}


def _statistics(
    car: Car, driven: DrivenCar, state: PeriodicForces, histories: dict[str, Vector], rate: float
) -> Statistics:
    """Return the warnings and notices of a run in time."""
    model, wheels = driven.model, car.vehicle.wheels
    bodies, count = (
        rotating_bodies(model.matrices),
        min(driven.plates.shape[1], math.ceil(SLOWEST_CHECK * driven.period)),
    )
    forces, motions = (driven.cycle.amplitudes(each[0])[:, :count] for each in (state.force, state.motion))
    rows = plain_rows(model, rotation_outputs(model, bodies))
    lines = driven.lines(rows, forces, motions, state.slope[0][:, :count], 1.0)
    spectrum = np.pad(lines, ((0, 0), (0, 1))) * count
    spectrum[:, 0] *= 2.0
    angles = np.fft.irfft(spectrum, 2 * count).reshape(len(bodies), 3, -1)
    largest = np.sqrt((angles**2).sum(axis=1).max(axis=1))
    validity = Validity(
        angles=dict(zip(bodies, largest.tolist(), strict=True)), loads={}, one_sided=model.matrices.one_sided
    )
    tyres = {wheel: histories[f"tyre_{wheel}_force_z"] for wheel in wheels if f"tyre_{wheel}_force_z" in histories}
    one_sided = [wheel for wheel in tyres if wheel in model.matrices.one_sided]
    pulled, pulls = pulling_tyres({wheel: tyres[wheel] for wheel in tyres if wheel not in one_sided}, rate)
    lifted = lift_off_notices(histories, one_sided, car.static.tyre_load, rate)
    return Statistics(
        engine="reduced",
        callback="native",
        timestep=driven.period / driven.cycle.samples,
        steps=driven.cycle.samples,
        wall_time=0.0,
        warnings=(*validity.warnings(), *pulled),
        energies=None,
        notices=(*pulls, *lifted, NOT_COMPUTED),
        within_validity=validity.within_limits,
    )


def _marched(car: Car, signal: Signal, begin: float, names: Sequence[str]) -> SteadyRun:
    """Return the last period of a run in time over several periods, with its change from the period before."""
    rate, period = car.vehicle.solver.record_rate, signal.duration - begin
    first, count = round(begin / signal.timestep), max(4, math.ceil(MARCHED / period))
    displacement = {
        wheel: np.concatenate([values[:first], np.tile(values[first:-1], count), values[-1:]])
        for wheel, values in signal.displacement.items()
    }
    size = next(iter(displacement.values())).size
    long = replace(
        signal, time=uniform_time(samples=size, timestep=signal.timestep), displacement=displacement, profile={},
        repeats_after=None,
    )  # fmt: skip
    _, recording, _ = simulated_run(car, long, None, "reduced", names, stated=False)
    samples = round(period * rate)
    last = {name: recording[name][-samples - 1 : -1] for name in names}
    before = {name: recording[name][-2 * samples - 1 : -samples - 1] for name in names}
    change = max(
        abs(float(np.std(before[name])) / moved - 1.0) for name in names if (moved := float(np.std(last[name])))
    )
    said = (
        f"RMS values of period {count} of a run in time, which differ from the period before by up to "
        f"{number(100.0 * change, 2)} %: with presliding or rubber friction, or where nearly all dampers stick, the "
        "iteration for the periodic state does not end"
    )
    size = round(signal.duration * rate) + 1
    kept = replace(
        recording,
        time=uniform_time(samples=size, timestep=1.0 / rate),
        channels=_extended(last, size, round(begin * rate)),
    )
    run = SteadyRun(
        car=car, signal=signal, recording=with_notices(kept, [said]), engine_reason="run in time", skip=begin
    )
    return with_range_notice(run)
