"""Measures of the targets of a file in a search, each with its input."""

from collections.abc import Mapping

from vehicle.errors import ConfigurationError, DataError
from vehicle.runs.car import Car, Run
from vehicle.runs.car.road import Road
from vehicle.runs.figures.value import require_unit
from vehicle.runs.targets.target import Target
from vehicle.studies.sweeps.measure import FigureMeasure, SingleMeasure, measure_of


def measures_of(
    car: Car, figures: Mapping[str, Target], duration: float | None
) -> list[tuple[str | Road, FigureMeasure | SingleMeasure]]:
    """Return each input of the targets and the measure of its figures."""
    groups: dict[tuple[str, float | None], list[tuple[str, Target]]] = {}
    for name, figure in figures.items():
        if figure.run or not (figure.road or figure.obstacle or figure.signal):
            raise ConfigurationError(
                f"{name}: a search needs the input of the target; set road or obstacle with speed, or signal, "
                "and remove run"
            )
        if not figure.signal and figure.speed is None:
            raise ConfigurationError(f"{name}: speed [km/h] is missing; a search needs it")
        groups.setdefault((figure.road or figure.obstacle or figure.signal, figure.speed), []).append((name, figure))
    measures = []
    for (source_name, speed), group in groups.items():
        source: str | Road = source_name
        if speed is not None:
            source = Road(source_name, speed, duration=duration if len(source_name) == 1 else None)
        try:
            run = car.run(source, engine="reduced", stated_errors=False)
            chosen = {name: _checked(name, target, run) for name, target in group}
        except DataError as error:
            raise ConfigurationError(f"{source_name}: {error}") from None
        random = run.road is not None and run.signal.random
        measures.append((source, measure_of(car.vehicle, chosen, run.skip, random=random)))
    return measures


def _checked(name: str, target: Target, run: Run) -> Target:
    """Return a target with its channels by name."""
    try:
        chosen = target.recorded_in(run.channels)
        chosen.channels_of(run.car.vehicle)
        require_unit(chosen, target.unit, run.recording.units)
        chosen.require(run.car.vehicle)
        chosen.figure.on_input(chosen, run.car.vehicle, run.signal.left_obstacle)
    except ConfigurationError as error:
        raise ConfigurationError(f"{name}: {error}") from None
    return chosen
