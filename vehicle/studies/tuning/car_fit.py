"""Parameters of a car fitted to measurements."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.idle import idle_parameters
from vehicle.model.parameters.paths import full_path, overrides_of, value_of
from vehicle.model.parameters.ranges import Range
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car import Car
from vehicle.studies.tuning.fit_result import TuningResult
from vehicle.studies.tuning.frf_target import FrfTarget
from vehicle.studies.tuning.least_squares import fit
from vehicle.studies.tuning.measured_targets import MeasuredTarget
from vehicle.studies.tuning.record_target import RecordTarget

Bounds = Sequence[float]
"""Lower and upper bound of a parameter in its unit, and where given the start of the fit."""


def tune_car(
    car: Car,
    parameters: Mapping[str, Bounds] | Sequence[Range],
    measurements: Sequence[MeasuredTarget | FrfTarget | RecordTarget],
    *,
    progress: Callable[[int, float], None] | None = None,
) -> TuningResult:
    """Fit parameters of a car to measured FRFs and time histories by weighted least squares.

    Args:
        car: the car; `car.varied(result.values)` is the fitted one.
        parameters: path to (lower, upper) or (lower, upper, start) in the unit of the parameter; the value of the car
            is the default start.
        measurements: results of `measured_responses` and `measured_histories`.
        progress: called with the number of evaluations and the root of the mean square of the weighted residuals.

    Returns:
        Values with standard errors and correlation, what the data cannot identify, and residual statistics.

    Raises:
        ConfigurationError: a parameter that the car does not have or that does nothing, or bounds out of order.
        DataError: a measurement that no run can be compared with.
        SimulationError: a run gives no finite residuals.
    """
    ranges = ranges_of(car.vehicle, parameters)
    require_fittable(ranges, car.vehicle)
    targets = [one.target if isinstance(one, MeasuredTarget) else one for one in measurements]
    return fit(ranges, targets, lambda values: car.varied(overrides_of(car.vehicle, values)), progress=progress)


def ranges_of(vehicle: Vehicle, parameters: Mapping[str, Bounds] | Sequence[Range]) -> tuple[Range, ...]:
    """Return the parameters of a fit with their starts.

    Args:
        vehicle: the car, whose values are the default starts.
        parameters: as in `tune_car`.

    Raises:
        ConfigurationError: a path that is no number of the car, or bounds out of order.
    """
    if not isinstance(parameters, Mapping):
        return tuple(parameters)
    found = []
    for path, bounds in parameters.items():
        if len(bounds) not in (2, 3):
            raise ConfigurationError(
                f"parameter {path}: found {bounds}, must be (lower, upper) or (lower, upper, start)"
            )
        overrides_of(vehicle, {path: bounds[0]})  # refuses what is no number of the car
        start = bounds[2] if len(bounds) == 3 else value_of(vehicle, path)
        found.append(Range(path=path, low=bounds[0], high=bounds[1], start=start))
    return tuple(found)


def require_fittable(parameters: Sequence[Range], vehicle: Vehicle) -> None:
    """Refuse parameters that do nothing, and bounds within which no such damper can be.

    Args:
        parameters: to be fitted.
        vehicle: the car.

    Raises:
        ConfigurationError: a parameter of a law that is off, or a friction at rest that may fall below that of sliding.
    """
    idle = idle_parameters(vehicle, [f"{one.path}={one.start!r}" for one in parameters])
    if idle:
        raise ConfigurationError(f"--fit {idle[0]}; give --set with it")
    whole = {full_path(vehicle.table, one.path): one for one in parameters}
    for path, static in whole.items():
        sliding = whole.get(path.removesuffix("stribeck_friction") + "coulomb_friction")
        if path.endswith(".stribeck_friction") and sliding is not None and static.low < sliding.high:
            raise ConfigurationError(
                f"--fit {static.path}={static.low:g}:{static.high:g}: the friction at rest must stay at or above that "
                f"of sliding, {sliding.path}={sliding.low:g}:{sliding.high:g}; give bounds that do not overlap"
            )
