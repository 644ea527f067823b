"""Folder of a run: written under a temporary name, renamed when complete, never half-finished under its own name."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError, OutputError


@contextmanager
def output_folder(path: Path, *, force: bool, protect: Path | None = None) -> Iterator[Path]:
    """Give a temporary folder; on success it becomes `path`, on failure it is removed.

    Args:
        path: final folder.
        force: replace an existing folder.
        protect: input file; a folder that holds it is never replaced.

    Yields:
        The temporary folder, beside the final one.

    Raises:
        ConfigurationError: the folder exists and `force` is not set, or it would destroy the input.
        OutputError: the folder cannot be written.
    """
    check_output(path, force=force, protect=protect)
    temporary = path.parent / f".{path.name}.{os.getpid()}.partial"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        _remove_stale(path)
        temporary.mkdir()
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror}; choose another --output") from None
    try:
        yield temporary
        if path.exists():
            if not force:  # another run was faster
                raise ConfigurationError(f"{path}: exists by now; another run wrote it; give --force or --output")
            discarded = path.parent / f".{path.name}.{os.getpid()}.old"
            path.rename(discarded)
            temporary.rename(path)
            shutil.rmtree(discarded)
        else:
            temporary.rename(path)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror or error}; nothing is left behind") from None
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


def check_output(path: Path, *, force: bool, protect: Path | None = None) -> None:
    """Refuse an output folder before anything is computed.

    Raises:
        ConfigurationError: it exists without `force`, is a file, or holds the input.
        OutputError: its parent cannot be written.
    """
    if protect is not None:
        folder, source = path.resolve(), protect.resolve()
        if folder == source or folder in source.parents:
            raise ConfigurationError(f"--output {path}: holds the input {protect}; choose another folder")
    if path.exists() and not path.is_dir():
        raise ConfigurationError(f"--output {path}: is a file; give a folder")
    if path.exists() and not force:
        raise ConfigurationError(f"--output {path}: exists; give --force to replace it, or another folder")
    parent = next(place for place in path.resolve().parents if place.exists())
    if not os.access(parent, os.W_OK) or not parent.is_dir():
        raise OutputError(f"--output {path}: {parent} cannot be written; choose another folder")


def write_whole(path: Path, write: Callable[[Path], None]) -> None:
    """Write one file under a temporary name and rename it.

    Args:
        path: final name.
        write: writes the file at the path it is given; the ending of the name is kept.

    Raises:
        OutputError: the file cannot be written; nothing is left behind.
    """
    temporary = path.with_name(f".{os.getpid()}.{path.name}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write(temporary)
        temporary.replace(path)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror or error}; nothing is left behind") from None
    finally:
        temporary.unlink(missing_ok=True)


def write_json(path: Path, content: Any) -> None:
    """Write JSON with sorted structure kept, two blanks of indent, and no NaN."""
    write_whole(path, lambda file: _write_text(file, json.dumps(content, indent=2, allow_nan=False) + "\n"))


def _write_text(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")


def _remove_stale(path: Path) -> None:
    """Remove what a killed run left behind; a run that still lives keeps its folder."""
    for left in path.parent.glob(f".{path.name}.*.partial"):
        number = left.name.removeprefix(f".{path.name}.").removesuffix(".partial")
        if number.isdigit() and not _alive(int(number)):
            shutil.rmtree(left, ignore_errors=True)


def _alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True
