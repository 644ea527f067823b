"""Destination of the results from --output and --force; chosen and locked before anything is computed."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from vehicle.errors import ConfigurationError

REPORT = "report.html"
"""Default name of a report."""


def output_folder_of(options: argparse.Namespace, default: Path, *, protect: tuple[Path, ...] = ()) -> Path:
    """Choose the folder of the results.

    Args:
        default: folder without --output; if it exists, the next free name is taken, with a notice.
        protect: input files; a folder that holds one of them is never replaced.

    Returns:
        The folder, locked until the command ends.

    Raises:
        ConfigurationError: the folder of --output exists, and --force is missing or it contains files of the user.
        OutputError: it cannot be written.
    """
    from vehicle.runs.output.free_names import free_folder, named

    if is_named(options) or options.force:
        return named(
            options.held, (options.output if is_named(options) else default), force=options.force, protect=protect
        )
    return _said(options, default, free_folder(options.held, default, protect=protect))


def study_folder_of(options: argparse.Namespace, default: Path, *, rows: Sequence[str] = ()) -> Path:
    """Choose the folder of a study, a sweep or a search; its files are made in `study_folder`.

    Args:
        default: folder without --output, see `output_folder_of`.
        rows: names of the files of finished rows, see `study_folder`.

    Returns:
        The folder, locked until the command ends.

    Raises:
        ConfigurationError, OutputError: see `check_study`.
    """
    from vehicle.runs.output.folder import check_study
    from vehicle.runs.output.free_names import free_folder
    from vehicle.runs.output.locks import claim

    resume = getattr(options, "resume", False)
    if not (is_named(options) or options.force or resume):
        return _said(options, default, free_folder(options.held, default))
    folder = options.output if is_named(options) else default
    options.held.enter_context(claim(folder.resolve()))
    check_study(folder, force=options.force, resume=resume, rows=rows)
    return folder


def output_files_of(options: argparse.Namespace, folder: Path, names: Sequence[str]) -> list[Path]:
    """Choose the files that a command adds to a folder with other files.

    Args:
        folder: folder without --output; if one of the files exists, all get the next free number, with a notice.
        names: of the files.

    Returns:
        The files, locked until the command ends.

    Raises:
        ConfigurationError: a file exists in the folder of --output, and --force is missing or it is of the user.
        OutputError: the folder cannot be written.
    """
    from vehicle.runs.output.folder import check_files
    from vehicle.runs.output.free_names import free_files
    from vehicle.runs.output.locks import claim

    if is_named(options) or options.force:
        folder = options.output if is_named(options) else folder
        check_files(folder, names, force=options.force)
        options.held.enter_context(claim(folder.resolve() / names[0]))
        return [folder / name for name in names]
    files = free_files(options.held, folder, names)
    _said(options, folder / names[0], files[0])
    return files


def output_file_of(
    options: argparse.Namespace, default: Path, *, ending: str = "", protect: tuple[Path, ...] = ()
) -> Path:
    """Choose the file of the results; return value and errors are those of `output_folder_of`.

    Args:
        default: file without --output; if it exists, the next free name is taken, with a notice.
        ending: required ending of the name.
        protect: input files; they are never replaced.
    """
    from vehicle.runs.output.free_names import free_file, named_file

    if is_named(options) or options.force:
        path = options.output if is_named(options) else default
        return named_file(options.held, path, ending=ending, force=options.force, protect=protect)
    return _said(options, default, free_file(options.held, default))


def is_named(options: argparse.Namespace) -> bool:
    """True if the command line has --output."""
    return "output" in options.given


def _said(options: argparse.Namespace, default: Path, chosen: Path) -> Path:
    """Print a notice if the chosen path is not the default; return the chosen path."""
    if chosen != default and not getattr(options, "quiet", False):
        print(f"notice: {default} exists; writing {chosen} (--force replaces {default})", file=sys.stderr)
    return chosen


def report_path(options: argparse.Namespace, output: Path) -> Path:
    """Return the path of the report; a plain name is in the output folder."""
    name = Path(options.report or REPORT)
    if name.suffix != ".html":
        raise ConfigurationError(f"--report {name}: must end in .html; give FILE.html")
    return path_beside(name, "--report", output, options)


def path_beside(name: Path, option: str, output: Path, options: argparse.Namespace) -> Path:
    """Check a path: a plain name in the output folder, or a free path outside this folder."""
    from vehicle.runs.output.free_names import named_file

    if name.parent == Path():
        return name
    folder = output.resolve()
    if name.resolve().parent == folder:
        return Path(name.name)
    if folder in name.resolve().parents:
        raise ConfigurationError(
            f"{option} {name}: must be a file name without a folder, in the output folder; set {name.name}"
        )
    return named_file(options.held, name, option, force=options.force)
