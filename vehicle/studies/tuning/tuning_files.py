"""Files of a fit: fitted vehicle file, numbers, pictures, report."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from vehicle.runs.output.folder import write_files, write_json, write_text
from vehicle.runs.output.own_files import parameters_text, write_own_files
from vehicle.studies.tuning.posterior_text import NamedPosterior, posterior_summary
from vehicle.studies.tuning.record_target import RecordTarget
from vehicle.studies.tuning.tuned_car import TunedCar
from vehicle.studies.tuning.tuning_figures import plot_corner, plot_correlation, plot_histories, plot_responses
from vehicle.studies.tuning.tuning_page import CORRELATION, POSTERIOR, tuning_page

VEHICLE, NUMBERS, REPORT = "vehicle.toml", "tune.json", "report.html"
"""Names of the fitted vehicle file, the numbers and the report."""


def figures_of(tuned: TunedCar, posteriors: Sequence[NamedPosterior] = ()) -> dict[str, Callable[[Path], None]]:
    """Return the name of each picture with the function that writes the picture to a path."""
    figures: dict[str, Callable[[Path], None]] = {}
    for number, measurement in enumerate(tuned.measurements, 1):
        target = measurement.target
        if not isinstance(target, RecordTarget):
            figures[f"frf_{number}_{target.name}"] = partial(
                plot_responses, target=target, start=tuned.start, fitted=tuned.fitted, source=target.name
            )
        else:
            figures[f"time_{number}_{target.name}"] = partial(
                plot_histories, target=target, start=tuned.start, fitted=tuned.fitted, source=target.name
            )
    if len(tuned.result.free) > 1:
        figures[CORRELATION] = partial(plot_correlation, result=tuned.result)
    if posteriors:
        figures[POSTERIOR] = partial(plot_corner, posterior=posteriors[0][1])
    return figures


def write_tuning(
    folder: Path,
    tuned: TunedCar,
    command: str,
    posteriors: Sequence[NamedPosterior] = (),
    *,
    author: str = "",
    project: str = "",
) -> tuple[str, ...]:
    """Write the files of a fit.

    Returns:
        Names of the files, the vehicle file first.

    Raises:
        OutputError: a file cannot be written.
    """
    names = ", ".join(each.target.name for each in tuned.measurements)
    write_text(folder / VEHICLE, parameters_text(tuned.fitted, f"fitted to {names}: {command}"))
    copies = write_own_files(folder, tuned.fitted)
    more = {"posterior": posterior_summary(posteriors)} if posteriors else {}
    write_json(folder / NUMBERS, {**tuned.summary(), **more, "command": command})
    figures = figures_of(tuned, posteriors)
    write_files(folder, {f"{name}.png": draw for name, draw in figures.items()})
    page = tuning_page(tuned, figures, command, posteriors, author=author, project=project)
    write_text(folder / REPORT, page)
    return (VEHICLE, REPORT, NUMBERS, *(f"{name}.png" for name in figures), *copies.values())
