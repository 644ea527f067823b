"""`python -m vehicle report`: write an HTML report of one run, or of several runs compared."""

from dataclasses import dataclass
from pathlib import Path

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.film_options import film_options
from vehicle.commands.options import (
    command_parser,
    head_options,
    measure_option,
    message_options,
    output_options,
    setting_options,
)
from vehicle.commands.parser import Parser
from vehicle.drawing.rendering.film_settings import FilmSettings
from vehicle.errors import ConfigurationError
from vehicle.runs.output.destination import REPORT, Destination
from vehicle.settings import Settings, part, setting


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("report", "Write findings, figures, moving modes and tables of runs into one HTML file.")
    setting_options(parser, ReportSettings, "runs", "targets", "level_map")
    measure_option(parser, "report")
    film_options(
        parser,
        "render a video of two runs of one input side by side and put it into the report; both are simulated again. "
        "Default: film.mp4 in this folder",
    )
    head_options(parser)
    output_options(
        parser,
        None,
        default=f"{REPORT} in the folder of a single run, in the current folder for several runs",
        metavar="FILE.html",
    )
    message_options(parser, quiet=True)
    return parser


@dataclass(frozen=True, kw_only=True, slots=True)
class ReportSettings(Settings):
    """Settings of a report.

    Attributes:
        measure: further figures of the report.
        film: film of two runs side by side.
        destination: the report; by default `REPORT` in the folder of a single run.
        author, project: names at the top.
    """

    runs: tuple[Path, ...] = setting(
        "folder of a run, for example runs/low; further runs are compared with the first. Or the folder of a diagnosis",
        flag="runs",
        nargs="+",
        type=Path,
        metavar="RUN",
    )
    targets: str | None = setting(
        "start the report with a check of these targets (figures with limits); 'ride' is a shipped file to copy "
        "and change",
        metavar="FILE.toml",
    )
    level_map: str = setting(
        "add the FRFs at every level and the level at which each damper slips, for this motion of the plates: heave, "
        "pitch, roll, warp, a wheel, or shares as fl=1,fr=1@90",
        "",
        metavar="NAME",
    )
    measure: tuple[str, ...] = ()
    film: FilmSettings = part(FilmSettings)
    destination: Destination = part(Destination)
    author: str = ""
    project: str = ""


def _job(settings: ReportSettings, console: Console) -> None:
    from vehicle.handover.page.report_file import require_figures, write_report
    from vehicle.studies.diagnosis.diagnosis_files import SUMMARY

    missing = next((run for run in settings.runs if not run.is_dir()), None)
    if missing is not None:
        raise ConfigurationError(f"{missing}: is not a folder; give the folder of a run, for example runs/low")
    if any((run / SUMMARY).is_file() for run in settings.runs):
        _report_diagnosis(settings, console)
        return
    default = settings.runs[0] / REPORT if len(settings.runs) == 1 else Path(REPORT)
    path, film = settings.destination.file(default, ending=".html"), None
    if settings.film.video is not None:
        if len(settings.runs) != 2:
            raise ConfigurationError(
                f"--video: needs two runs, found {len(settings.runs)}; for a video of one run use --video of shaker"
            )
        require_figures(settings.runs, settings.measure)
        film = _film(settings, console)
    write_report(
        settings.runs,
        path,
        force=settings.destination.force,
        progress=console.progress("report    "),
        targets=settings.targets,
        measure=settings.measure,
        levels=settings.level_map,
        notice=lambda text: console.say(f"note        {text}"),
        film=film,
        author=settings.author,
        project=settings.project,
    )
    console.say(f"report      {path}, {path.stat().st_size / 1e6:.1f} MB")


def _report_diagnosis(settings: ReportSettings, console: Console) -> None:
    """Write the report of the folder of `diagnose`."""
    from vehicle.runs.output.folder import write_text
    from vehicle.studies.diagnosis.diagnosis_page import diagnosis_page

    if len(settings.runs) > 1 or settings.targets or settings.measure or settings.level_map or settings.film.video:
        raise ConfigurationError(
            f"report: {settings.runs[0]} is a diagnosis, which has a report of its own; give its folder alone, without "
            "--targets, --measure, --level-map and --video"
        )
    folder = settings.runs[0]
    path = settings.destination.file(folder / REPORT, ending=".html")
    write_text(path, diagnosis_page(folder, author=settings.author, project=settings.project))
    console.say(f"report      {path}, {path.stat().st_size / 1e6:.1f} MB")


def _film(settings: ReportSettings, console: Console) -> Path:
    """Write the film of two runs, print how exact the film is, and return the path."""
    from vehicle.drawing.rendering.backend import require_film
    from vehicle.drawing.rendering.crew import drawing_jobs
    from vehicle.runs.output.folder import write_whole
    from vehicle.runs.output.free_names import free_file
    from vehicle.runs.report.pair_film import film_of_two

    named, destination = settings.film.path("film.mp4"), settings.destination
    chosen = settings.film.video or destination.force
    path = destination.further_file(named, "--video") if chosen else free_file(destination.held, named)
    require_film()
    said: list[str] = []

    def make(file: Path) -> None:
        progress, take = console.progress("video     "), settings.film.values()
        said.append(film_of_two(settings.runs, file, take, jobs=drawing_jobs(), progress=progress))

    write_whole(path, make)
    console.say(f"video       {path}: {said[0]}")
    return path


main = command(parser, ReportSettings, _job)
