"""Fit of a car to measurements with its last steps in MuJoCo, and the agreement with the data before and after."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.paths import full_path, overrides_of, unit_of, value_of
from vehicle.model.parameters.ranges import Range
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car import Car, Run
from vehicle.signals.analysis.frf_agreement import log_ratio
from vehicle.signals.analysis.response_name import ResponseName
from vehicle.studies.tuning.car_fit import tune
from vehicle.studies.tuning.fit_result import TuningResult, known
from vehicle.studies.tuning.fit_size import state_fit_size
from vehicle.studies.tuning.frf_target import FrfTarget
from vehicle.studies.tuning.full_steps import FullSteps, full_steps
from vehicle.studies.tuning.level_target import LevelTarget
from vehicle.studies.tuning.limits_of_data import OFTEN_WRONG, refusal, unexplained, what_data_leave_open
from vehicle.studies.tuning.measured_targets import MeasuredTarget
from vehicle.studies.tuning.record_target import RecordTarget
from vehicle.threads import one_blas_thread


@dataclass(frozen=True, kw_only=True, slots=True)
class Agreement:
    """Error of the model against one channel of a measurement, before and after the fit."""

    measurement: str  # name of the measurement
    channel: str  # channel; of an FRF its output
    plate: str  # input of an FRF, for example "plate_fr"; empty for a time history
    label: str  # channel, with its plate if the measurement has FRFs to several
    measure: str  # quantity: "magnitude", "phase" or "history"
    unit: str  # dB, deg, or % of the RMS of the measured history
    before: float  # before, after: RMS of the error over the fitted frequencies or times
    after: float


@dataclass(frozen=True, kw_only=True, eq=False)
class TunedCar:
    """Car fitted to measurements."""

    start: Car  # the car before the fit
    result: TuningResult  # the fit: values, standard errors, correlation, residual statistics
    measurements: tuple[MeasuredTarget, ...]  # the measurements with the fitted delays
    engine: str  # engine of the last steps; "reduced" if there were none
    final: FullSteps | None  # the last steps with the complete model; None without them

    @cached_property
    def fitted(self) -> Car:
        """Car with the fitted values."""
        return self.start.with_(overrides_of(self.start.vehicle, self.result.values))

    @property
    def settings(self) -> tuple[str, ...]:
        """Return the values of --set for the fitted car, in addition to the start car; empty if the fit is refused."""
        if self.refusal:
            return ()
        values = self.result.values
        restated = self.fitted.overrides[len(self.start.overrides) + len(values) :]
        return (*(f"{path}={value:.8g}" for path, value in values.items()), *restated)

    @cached_property
    def refusal(self) -> str:
        """Reason why the values must not be used: at a bound, or an error above 100 %; otherwise empty."""
        return refusal(self.result, [(name, after) for name, _, after, _ in self._shares])

    @cached_property
    def unexplained(self) -> str:
        """Statement on a large remaining error, see `limits_of_data.unexplained`; empty if small or refused."""
        return "" if self.refusal else unexplained(self._shares, _unfitted(self.start.vehicle, self.result.values))

    @property
    def determined(self) -> bool:
        """True if the fit explains the measurement and its data determine all parameters."""
        return not (self.refusal or self.unexplained or what_data_leave_open(self.result))

    @property
    def total_error(self) -> tuple[float, float]:
        """Error before and after the fit [%]: root of the mean square over all channels, each over its measured RMS.

        Unlike the weighted residuals, whose weights each fit takes from its own residuals, it can be compared between
        fits of one measurement.
        """
        shares = np.array([(before, after) for _, before, after, _ in self._shares]).reshape(-1, 2)
        before, after = np.sqrt(np.mean(shares**2, axis=0)).tolist()
        return before, after

    @cached_property
    def _shares(self) -> list[tuple[str, float, float, float]]:
        """Name of each compared channel; its error before and after, and its known noise, over its RMS [%]."""
        return [
            (f"{channel} in {each.target.name}", *shares)
            for each, tables in zip(self.measurements, self._errors, strict=True)
            for channel, *shares in zip(
                _labels(each.target), *(table[:, -1].tolist() for table in tables), _noise(each.target), strict=True
            )
            if np.isfinite(shares[0])
        ]

    @cached_property
    def _errors(self) -> tuple[tuple[Vector, Vector], ...]:
        """Errors of each measurement before and after the fit, see `_model_errors`."""
        return tuple(
            (_model_errors(each.target, self.start), _model_errors(each.target, self.fitted))
            for each in self.measurements
        )

    @cached_property
    def agreement(self) -> tuple[Agreement, ...]:
        """Errors of all compared channels with the models of the fit: matrices of a stuck car, or reduced engine."""
        rows: list[Agreement] = []
        for measurement, errors in zip(self.measurements, self._errors, strict=True):
            target = measurement.target
            if not isinstance(target, RecordTarget):
                measures: tuple[tuple[str, str], ...] = (("magnitude", "dB"), ("phase", "deg"))
                names: Sequence[ResponseName] = target.data.names
            else:
                measures = (("history", "% of RMS"),)
                names = [ResponseName(channel) for channel in target.record.channels]
            for row, (name, label) in enumerate(zip(names, _labels(target), strict=True)):
                for column, (measure, unit) in enumerate(measures):
                    before, after = (float(table[row, column]) for table in errors)
                    if not np.isfinite(before):  # all points of the channel are excluded
                        continue
                    rows.append(
                        Agreement(
                            measurement=target.name,
                            channel=name.output,
                            plate=name.input,
                            label=label,
                            measure=measure,
                            unit=unit,
                            before=before,
                            after=after,
                        )
                    )
        return tuple(rows)

    def summary(self) -> dict[str, Any]:
        """Return values, standard errors and all statistics as plain data."""
        result, vehicle = self.result, self.start.vehicle
        return {
            "car": vehicle.name,
            "unexplained": self.unexplained,
            "measurements": [{"name": each.target.name, "notices": list(each.notices)} for each in self.measurements],
            "parameters": [
                {
                    "path": parameter.path,
                    "unit": unit_of(vehicle, parameter.path),
                    "value": result.values[parameter.path],
                    "standard_error": known(result.errors[parameter.path]),
                    "noise_error": known(result.standard_errors[parameter.path]),
                    "half_sample_shift": known(result.lag_shifts.get(parameter.path)),
                    "start": parameter.start,
                    "low": parameter.low,
                    "high": parameter.high,
                }
                for parameter in result.parameters
            ],
            "delays": [
                {
                    "measurement": self.measurements[delay.target].target.name,
                    "group": delay.group,
                    "delay_s": result.solution[delay.path],
                    "standard_error_s": known(result.errors[delay.path]),
                    "noise_error_s": known(result.standard_errors[delay.path]),
                }
                for delay in result.delays
            ],
            "set": list(self.settings),
            "refusal": self.refusal,
            "left_open": list(what_data_leave_open(result)),
            "free": list(result.free),
            "correlation": result.correlation.tolist(),
            "converged": result.converged,
            "message": result.message,
            "cars_computed": result.evaluations,
            "error_percent": dict(zip(("before", "after"), self.total_error, strict=True)),
            "weighted_residual": {"before": result.before, "after": result.after},
            "agreement": [
                {key: value for key, value in asdict(row).items() if key != "label"} | {"plate": row.plate or None}
                for row in self.agreement
            ],
            "engine": self.engine,
            "moved_by_engine": None if self.final is None else dict(self.final.moved),
        }


@one_blas_thread()
def tuned_car(
    car: Car,
    parameters: Sequence[Range],
    measurements: Sequence[MeasuredTarget],
    *,
    engine: str = "mujoco",
    progress: Callable[[int, float], None] | None = None,
    simulated: Callable[[int], None] | None = None,
) -> TunedCar:
    """Fit parameters of a car with the fast models, then finish the fit with an engine.

    Args:
        measurements: results of `measured_responses` and `measured_histories`.
        engine: engine of the last steps, see `full_steps`; "reduced" ends after the fit with the fast models.
        progress: see `tune`.
        simulated: called with the number of runs of the last steps.

    Raises:
        ConfigurationError, DataError, SimulationError: see `tune`.
    """
    state_fit_size(car.vehicle, measurements, len(parameters), engine)
    result = tune(car, parameters, measurements, progress=progress)
    final = None
    if engine != "reduced" and any(each.signal is not None for each in measurements):
        count = 0

        def models(values: Mapping[str, float]) -> list[Car | Run]:
            nonlocal count
            varied = car.with_(overrides_of(car.vehicle, values))
            listed: list[Car | Run] = []
            for each in measurements:
                if each.signal is None:
                    listed.append(varied)
                    continue
                listed.append(each.target.run(varied, engine))
                count += 1
                if simulated is not None:
                    simulated(count)
            return listed

        final = full_steps(result, [each.target for each in measurements], models)
        result = final.result
    fitted = [
        replace(each, target=each.target.settled(result.groups(number))) for number, each in enumerate(measurements)
    ]
    return TunedCar(
        start=car.with_(overrides_of(car.vehicle, {entry.path: entry.start for entry in result.parameters})),
        result=result,
        measurements=tuple(fitted),
        engine=engine if final is not None else "reduced",
        final=final,
    )


def _labels(target: FrfTarget | LevelTarget | RecordTarget) -> tuple[str, ...]:
    """Return the names of the compared channels."""
    return tuple(target.record.channels) if isinstance(target, RecordTarget) else target.data.labels


def _unfitted(vehicle: Vehicle, fitted: Iterable[str]) -> list[str]:
    """Return two parameters of a car that were not fitted, as examples for a further fit."""
    fitted_paths, examples = {full_path(vehicle.table, path) for path in fitted}, []
    for end in OFTEN_WRONG:
        for path in (end, f"front.{end}"):
            with suppress(ConfigurationError):
                if value_of(vehicle, path) > 0.0 and full_path(vehicle.table, path) not in fitted_paths:
                    examples.append(path)
                    break
    return examples[:2]


def _noise(target: FrfTarget | LevelTarget | RecordTarget) -> list[float]:
    """Return the noise that the coherence of FRFs states, over the RMS of each channel [%]; 0 for time histories."""
    if isinstance(target, RecordTarget):
        return [0.0] * len(_labels(target))
    power = np.where(np.isfinite(target.deviation), np.abs(target.data.response) ** 2, 0.0)
    # Re and Im of ln H have this standard deviation each.
    noise = 2.0 * np.sum(np.nan_to_num(target.deviation) ** 2 * power, axis=1)
    shares = 100.0 * np.sqrt(noise / np.maximum(power.sum(axis=1), np.finfo(float).tiny))
    return [float(share) for share in shares]


def _model_errors(target: FrfTarget | LevelTarget | RecordTarget, car: Car) -> Vector:
    """Return the errors of a car against a measurement.

    Returns:
        Time histories: RMS error over the RMS of the measurement [%], (channels, 1). FRFs: RMS over frequency of the
        magnitude [dB], of the phase [deg], and of |H - Hm| over the RMS |Hm| [%], (channels, 3); NaN for a channel
        without an included point.
    """
    if isinstance(target, RecordTarget):
        return np.asarray(100.0 * np.sqrt(np.mean(target.residuals(car) ** 2, axis=1))[:, None])
    rows = np.isfinite(target.deviation).any(axis=1)
    tables = np.isfinite(target.deviation), target.data.response, target.model_response(car)
    used, measured, model = (table[rows] for table in tables)
    logarithm = np.where(used, log_ratio(measured, model), np.nan)
    size, angle = (np.sqrt(np.nanmean(part**2, axis=1)) for part in (logarithm.real, logarithm.imag))
    missed, whole = (np.nansum(np.where(used, np.abs(part) ** 2, 0.0), axis=1) for part in (model - measured, measured))
    errors = np.full((rows.size, 3), np.nan)
    errors[rows] = np.stack([20.0 / np.log(10.0) * size, np.degrees(angle), 100.0 * np.sqrt(missed / whole)], axis=1)
    return errors
