"""Report of finished runs as a file."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.handover.page.trial_section import trial
from vehicle.leftovers import mention
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.figures.chosen_figure import chosen_figure
from vehicle.runs.output.folder import check_file, write_text
from vehicle.runs.output.saved_run import file_of_run
from vehicle.runs.report.finished_run import read_run
from vehicle.runs.report.page import report_page
from vehicle.runs.targets.verdict import missing_runs, read_targets
from vehicle.signals.records.run_summary import read_summary


def write_report(
    runs: Path | str | Sequence[Path | str],
    file: Path | str,
    *,
    force: bool = False,
    progress: Callable[[float], None] | None = None,
    targets: Path | str | None = None,
    measure: Sequence[str] = (),
    levels: str = "",
    notice: Callable[[str], None] | None = None,
    film: Path | str | None = None,
    author: str = "",
    project: str = "",
) -> Path:
    """Write the report of one run, or of several compared with the first, as one HTML file.

    Args:
        runs: folders of runs, as "runs/low"; `save_run` writes them.
        file: name of the report, with the ending .html.
        force: replace a report that was written there before.
        progress: called with the finished fraction.
        targets: TOML file of figures with limits, or "ride" for the shipped one; the report begins with the verdict.
        measure: further figures by their names in the catalogue (`Run.figure`).
        levels: motion of the plates, for example "heave", for a chart of FRFs at every level (`Car.levels`).
        notice: called with a line on targets without a run, and the commands that make these runs.
        film: film of two runs side by side, as `film_of_two` writes it, for the page; none by default.
        author, project: names in the head of the page; may be empty.

    Returns:
        The file.

    Raises:
        ConfigurationError: no run, a folder that holds none, another ending, or a file that exists without `force`.
        DataError: a file of a run is missing or damaged.
        OutputError: the file cannot be written.
    """
    folders = [Path(runs)] if isinstance(runs, Path | str) else [Path(run) for run in runs]
    for folder in folders:
        mention(folder)
    missing = next((folder for folder in folders if not folder.is_dir()), None)
    if missing is not None:
        raise ConfigurationError(f"{missing}: is not a folder; give the folder of a run, for example runs/low")
    path = Path(file)
    check_file(path, ending=".html", force=force)
    figures = None if targets is None else read_targets(targets)
    require_figures(folders, measure)
    finished = [read_run(folder) for folder in folders]
    if notice is not None and figures is not None and (text := missing_runs(figures, finished)):
        notice(text)
    pair = None if film is None else Path(film)
    page = report_page(
        finished,
        progress,
        trial=partial(trial, measure=measure),
        targets=figures,
        measure=measure,
        levels=levels,
        pair=pair,
        author=author,
        project=project,
    )
    write_text(path, page)
    return path


def require_figures(folders: Sequence[Path], measure: Sequence[str]) -> None:
    """Check the names of figures for the cars of finished runs, before anything is drawn.

    Args:
        folders: folders of runs.
        measure: names of figures, see `Run.figure`.

    Raises:
        ConfigurationError: a folder holds no run, or its car lacks a figure.
        DataError: a file of a run is missing or damaged.
    """
    for folder in folders if measure else ():
        vehicle = load_vehicle(file_of_run(folder, read_summary(folder), "vehicle"))
        for name in measure:
            chosen_figure(name, vehicle, "--measure")
