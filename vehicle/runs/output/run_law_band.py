"""Comfort and slip of a run with the softest and with the firmest dampers of the band of their fitted laws."""

from collections.abc import Sequence
from typing import Any

from vehicle.runs.car import Run
from vehicle.runs.car.law_band import banded_laws, laws_by_path
from vehicle.runs.output.run_comfort import comfort_values
from vehicle.signals.records.law_band_summary import EdgeSummary, LawBandSummary


def law_band_values(
    run: Run, edges: Sequence[Any], *, stated_errors: bool = True
) -> tuple[LawBandSummary | None, list[str]]:
    """Run the cars of both edges on the input of a run with its engine; return their values, and their warnings.

    Args:
        run: run of the car with its fitted laws.
        edges: softest and firmest car, see `Car.law_band`; none for no values.
        stated_errors: see `Car.run`.
    """
    if not edges:
        return None, []
    engine, values, warnings = run.recording.statistics.engine, [], list[str]()
    for name, car in zip(("softest", "firmest"), edges, strict=True):
        edge = car.run(run.signal, engine, skip=run.skip, stated_errors=stated_errors)
        statistics = edge.recording.statistics
        warnings += [f"with the {name} law of the band: {text}" for text in statistics.warnings]
        values.append(
            EdgeSummary(
                weighted_rms={point: value.weighted for point, value in comfort_values(edge).items()},
                slip_share={wheel: edge.slip_share(wheel) for wheel in car.vehicle.damped_wheels},
                energy_residual=statistics.energies.residual if statistics.energies else None,
            )
        )
    dampers = banded_laws(laws_by_path(run.car.vehicle.composition.dampers))
    return LawBandSummary(dampers=list(dampers), soft=values[0], firm=values[1]), warnings
