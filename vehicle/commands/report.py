"""`python -m vehicle report`: one HTML file of one run, or of several beside each other."""

from __future__ import annotations

import argparse
from pathlib import Path

from vehicle.commands.command_line import Parser, ProgressLine, command
from vehicle.commands.options import FORCE_HELP, command_parser, message_options
from vehicle.errors import ConfigurationError

NAME = "report.html"


def parser() -> Parser:
    """The options of the command."""
    found = command_parser("report", "Findings, figures, moving modes and tables of runs as one HTML file.")
    found.add_argument(
        "runs",
        nargs="+",
        type=Path,
        metavar="RUN",
        help="folder of a run, as runs/low; the others are compared with the first",
    )
    found.add_argument(
        "--output",
        type=Path,
        metavar="FILE.html",
        help=f"the file; {NAME} in the folder of a single run, and here for several, by default",
    )
    found.add_argument("--force", action="store_true", help=FORCE_HELP)
    message_options(found, quiet=True)
    return found


def _job(options: argparse.Namespace) -> None:
    from vehicle.output.folder import write_text
    from vehicle.report.finished_run import read_run
    from vehicle.report.page import report_page

    path: Path = options.output or (options.runs[0] / NAME if len(options.runs) == 1 else Path(NAME))
    check_report(path, "--output", force=options.force)
    missing = next((run for run in options.runs if not run.is_dir()), None)
    if missing is not None:
        raise ConfigurationError(f"{missing}: is no folder; give the folder of a run, as runs/low")
    progress = ProgressLine("report    ", enabled=not options.quiet)
    write_text(path, report_page([read_run(run) for run in options.runs], progress))
    if not options.quiet:
        print(f"report      {path}, {path.stat().st_size / 1e6:.1f} MB")


def check_report(path: Path, option: str, *, force: bool) -> None:
    """Refuse a path where no report can be written, before anything is computed.

    Args:
        path: of the report.
        option: that names it.
        force: replace a report.

    Raises:
        ConfigurationError: another ending, or something is there that is no report or must not be replaced.
    """
    if path.suffix != ".html":
        raise ConfigurationError(f"{option} {path}: a report is written as .html; give FILE.html")
    if path.is_dir():
        raise ConfigurationError(f"{option} {path}: is a folder; give FILE.html")
    if path.exists() or path.is_symlink():
        if not force:
            raise ConfigurationError(f"{option} {path}: exists; give --force to replace it, or another name")
        if not path.is_file() or MARK not in path.read_bytes()[:2000]:
            raise ConfigurationError(f"{option} {path}: exists and is no report of this program; give another name")


MARK = b'<meta name="generator" content="vehicle-on-shaker">'
"""Stands in the head of every report."""


main = command(parser, _job)
