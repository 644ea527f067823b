"""Check that the figures of a measure exist on the inputs of a study, before its first run."""

from collections.abc import Sequence

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car
from vehicle.studies.sweeps.case import Input, overrides_of, signal_of
from vehicle.studies.sweeps.measure import Measure, figures_of
from vehicle.studies.sweeps.sweep_inputs import file_of


def require_on_inputs(measure: Measure, car: Car, ends: Sequence[Sequence[str]], sources: Sequence[Input]) -> None:
    """Check that each figure exists on each input, at least for one of the given variations of a car.

    Args:
        measure: measure of the study.
        ends: variations, texts "path=value".
    """
    for chosen in figures_of(measure):
        for source in sources if chosen.figure.asks_input else ():
            reasons = []
            for end in ends:
                overrides = (*car.overrides, *overrides_of(source), *end)
                try:
                    vehicle = load_vehicle(file_of(car) or FOCUS_FILE, overrides)
                    chosen.figure.on_input(chosen, vehicle, signal_of(source).left_obstacle)
                except ConfigurationError as error:
                    reasons.append(error)
            if len(reasons) == len(ends):
                raise ConfigurationError(f"{chosen.title} on {source.name}: {reasons[0]}")
