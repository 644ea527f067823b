"""`python -m vehicle report`: write the report of one run, or of several runs compared, as an HTML file."""

import argparse
from pathlib import Path

from vehicle.commands.command_line import ProgressLine, command
from vehicle.commands.destination import REPORT, output_file_of
from vehicle.commands.film_options import check_film_options, film_options, take_settings
from vehicle.commands.options import (
    command_parser,
    film_name,
    head_options,
    measure_option,
    message_options,
    output_options,
)
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("report", "Write findings, figures, moving modes and tables of runs into one HTML file.")
    parser.add_argument(
        "runs",
        nargs="+",
        type=Path,
        metavar="RUN",
        help="folder of a run, for example runs/low; further runs are compared with the first",
    )
    parser.add_argument(
        "--targets",
        metavar="FILE.toml",
        help="start the report with the check of these targets (figures with limits); 'ride' is a shipped file "
        "to copy and change",
    )
    measure_option(parser, "report")
    film_options(
        parser,
        "render a film of two runs of one input side by side, and put it into the report; both are simulated again "
        "for it. film.mp4 here by default",
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


def _job(options: argparse.Namespace) -> None:
    from vehicle.handover.page.report_file import write_report

    missing = next((run for run in options.runs if not run.is_dir()), None)
    if missing is not None:
        raise ConfigurationError(f"{missing}: is not a folder; give the folder of a run, for example runs/low")
    default = options.runs[0] / REPORT if len(options.runs) == 1 else Path(REPORT)
    check_film_options(options)
    path, film = output_file_of(options, default, ending=".html"), None
    if options.video is not None:
        if len(options.runs) != 2:
            raise ConfigurationError(
                f"--video: shows two runs side by side, found {len(options.runs)}; for a film of a single run, give "
                "--video to shaker"
            )
        film = _film(options)
    write_report(
        options.runs,
        path,
        force=options.force,
        progress=ProgressLine("report    ", enabled=not options.quiet),
        targets=options.targets,
        measure=options.measure,
        notice=None if options.quiet else lambda text: print(f"note        {text}"),
        film=film,
        author=options.author,
        project=options.project,
    )
    if not options.quiet:
        print(f"report      {path}, {path.stat().st_size / 1e6:.1f} MB")


def _film(options: argparse.Namespace) -> Path:
    """Write the film of two runs, print how exact the film is, and return the path."""
    from vehicle.drawing.rendering.backend import require_film
    from vehicle.drawing.rendering.crew import drawing_jobs
    from vehicle.runs.output.folder import write_whole
    from vehicle.runs.output.free_names import free_file, named_file
    from vehicle.runs.report.pair_film import film_of_two

    named = film_name(options.video, "film.mp4")
    chosen = options.video or options.force
    path = named_file(options.held, named, "--video", force=options.force) if chosen else free_file(options.held, named)
    require_film()
    progress = ProgressLine("film      ", enabled=not options.quiet)
    said: list[str] = []

    def make(file: Path) -> None:
        said.append(film_of_two(options.runs, file, take_settings(options), jobs=drawing_jobs(), progress=progress))

    write_whole(path, make)
    if not options.quiet:
        print(f"film        {path}: {said[0]}")
    return path


main = command(parser, _job)
