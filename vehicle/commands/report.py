"""`python -m vehicle report`: write the report of one run, or of several runs compared, as an HTML file."""

from __future__ import annotations

import argparse
from pathlib import Path

from vehicle.commands.command_line import ProgressLine, command
from vehicle.commands.destination import REPORT, output_file_of
from vehicle.commands.options import command_parser, head_options, message_options, output_options
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
    path = output_file_of(options, default, ending=".html")
    write_report(
        options.runs,
        path,
        force=options.force,
        progress=ProgressLine("report    ", enabled=not options.quiet),
        targets=options.targets,
        author=options.author,
        project=options.project,
    )
    if not options.quiet:
        print(f"report      {path}, {path.stat().st_size / 1e6:.1f} MB")


main = command(parser, _job)
