"""Fit of parameters of a car to measured FRFs and time histories."""

import math
from collections.abc import Callable, Mapping, Sequence

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.idle import idle_parameters
from vehicle.model.parameters.paths import full_path, overrides_of, value_of
from vehicle.model.parameters.ranges import LENGTH_OF_ONE, Range, is_coordinate
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car import Car
from vehicle.studies.tuning.fit_result import TuningResult
from vehicle.studies.tuning.frf_target import FrfTarget
from vehicle.studies.tuning.inertia_about_cog import about_cog
from vehicle.studies.tuning.least_squares import fit
from vehicle.studies.tuning.level_target import LevelTarget
from vehicle.studies.tuning.measured_targets import MeasuredTarget
from vehicle.studies.tuning.record_target import RecordTarget
from vehicle.studies.tuning.response_delays import DelayRange, start_delay

Bounds = Sequence[float]
"""Lower bound, upper bound and optionally start value of a parameter, in the unit of the parameter."""


def tune(
    car: Car,
    parameters: Mapping[str, Bounds] | Sequence[Range],
    measurements: Sequence[MeasuredTarget | FrfTarget | LevelTarget | RecordTarget],
    *,
    progress: Callable[[int, float], None] | None = None,
) -> TuningResult:
    """Fit parameters of a car to measured FRFs and time histories by weighted least squares.

    Args:
        car: the car; `car.with_(result.values)` is the fitted one.
        parameters: path to (lower, upper) or (lower, upper, start) in the unit of the parameter; the value of the car
            is the default start.
        measurements: results of `measured_responses` and `measured_histories`.
        progress: called with the number of evaluations and the root of the mean square of the weighted residuals.

    Returns:
        Values with standard errors and correlation, delays of groups of channels, unidentifiable parameters, and
        residual statistics.

    Raises:
        ConfigurationError: the car lacks a parameter, a parameter has no effect, or bounds are out of order.
        DataError: a measurement cannot be compared with a run.
        SimulationError: a run gives residuals that are not finite.
    """
    ranges = ranges_of(car.vehicle, parameters)
    require_fittable(ranges, car.vehicle)
    targets = [
        measurement.target if isinstance(measurement, MeasuredTarget) else measurement for measurement in measurements
    ]
    start = car.with_(overrides_of(car.vehicle, {entry.path: entry.start for entry in ranges}))
    delays = [delay for number, target in enumerate(targets) for delay in delays_of(target, number, start)]

    def fitted(car: Car, ranges: Sequence[Range], begin: Mapping[str, float]) -> TuningResult:
        def build(values: Mapping[str, float]) -> Car:
            return car.with_(overrides_of(car.vehicle, values))

        return fit(ranges, targets, build, delays=delays, begin=begin, progress=progress)

    begin: dict[str, float] = {}
    if (restatement := about_cog(start, ranges)) is not None:
        restated, restated_ranges, values_about_origin = restatement
        first = fitted(restated, restated_ranges, {})
        begin = {**first.solution, **values_about_origin(first.values)}
        if not all(entry.low < begin[entry.path] < entry.high for entry in ranges):
            begin = {}
    return fitted(car, ranges, begin)


def delays_of(target: FrfTarget | LevelTarget | RecordTarget, number: int, start: Car) -> list[DelayRange]:
    """Return the unknown delays of a measurement; each begins at the delay of best agreement with the car."""
    lags = target.lags(start) if target.delays.groups else {}
    delays = []
    for group in target.delays.groups:
        group_lags = [lag for channel, lag in lags.items() if target.delays.fitted.get(channel) == group]
        begin = start_delay([lag.delay for lag in group_lags], [lag.error for lag in group_lags])
        path = f"delay of the {group} of {target.name}" + (f" ({number + 1})" if number else "")
        delays.append(DelayRange(path=path, group=group, target=number, start=begin))
    return delays


def ranges_of(vehicle: Vehicle, parameters: Mapping[str, Bounds] | Sequence[Range]) -> tuple[Range, ...]:
    """Return the fitted parameters with bounds, see `tune`, and start values, by default those of a vehicle."""
    if not isinstance(parameters, Mapping):
        return tuple(parameters)
    ranges = []
    for path, bounds in parameters.items():
        if len(bounds) not in (2, 3):
            raise ConfigurationError(f"parameter {path}: must be (lower, upper) or (lower, upper, start), not {bounds}")
        overrides_of(vehicle, {path: bounds[0]})  # raises if the path is not a numeric parameter of the car
        start = bounds[2] if len(bounds) == 3 else value_of(vehicle, path)
        length = LENGTH_OF_ONE if is_coordinate(vehicle, path) else math.nan
        ranges.append(Range(path=path, low=bounds[0], high=bounds[1], start=start, length=length))
    return tuple(ranges)


def require_fittable(parameters: Sequence[Range], vehicle: Vehicle) -> None:
    """Check that every parameter has an effect and that static friction cannot fall below sliding friction."""
    idle = idle_parameters(vehicle, [f"{parameter.path}={parameter.start!r}" for parameter in parameters])
    if idle:
        raise ConfigurationError(f"--parameters {idle[0]}; add --set")
    whole = {full_path(vehicle.table, parameter.path): parameter for parameter in parameters}
    for path, static in whole.items():
        sliding = whole.get(path.removesuffix("stribeck_friction") + "coulomb_friction")
        if path.endswith(".stribeck_friction") and sliding is not None and static.low < sliding.high:
            raise ConfigurationError(
                f"--parameters {static.path}={static.low:g}:{static.high:g}: static friction must not be below sliding "
                f"friction, {sliding.path}={sliding.low:g}:{sliding.high:g}; set bounds that do not overlap"
            )
