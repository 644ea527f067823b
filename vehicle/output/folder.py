"""Folder of a run: written under a temporary name, renamed when complete, never half-finished under its own name."""

from __future__ import annotations

import fcntl
import json
import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError, OutputError
from vehicle.output.written_files import MARKER, discard, mark, note, refuse_foreign


@contextmanager
def output_folder(path: Path, *, force: bool, protect: tuple[Path, ...] = ()) -> Iterator[Path]:
    """Give a temporary folder; on success it becomes `path`, on failure it is removed.

    Args:
        path: final folder; behind a link, the folder that it leads to.
        force: replace what a run wrote there before.
        protect: input files; a folder that holds one of them is never replaced.

    Yields:
        The temporary folder, beside the final one.

    Raises:
        ConfigurationError: as of `check_output`, or another process writes there.
        OutputError: the folder cannot be written.
    """
    path = check_output(path, force=force, protect=protect)
    temporary = path.parent / f".{path.name}.{os.getpid()}.partial"
    with folder_lock(path):
        try:
            for left in path.parent.glob(f".{path.name}.*.partial"):
                shutil.rmtree(left, ignore_errors=True)  # of a killed run: a living one holds the lock
            temporary.mkdir()
            mark(temporary)
        except OSError as error:
            raise OutputError(f"{path}: cannot be written: {error.strerror}; choose another --output") from None
        try:
            yield temporary
            if path.exists():
                if not force:  # made meanwhile
                    raise ConfigurationError(f"{path}: exists by now; give --force or another --output")
                refuse_foreign(path)
                discarded = path.parent / f".{path.name}.{os.getpid()}.old"
                path.rename(discarded)
                temporary.rename(path)
                discard(discarded)
            else:
                temporary.rename(path)
        except OSError as error:
            raise OutputError(f"{path}: cannot be written: {error.strerror or error}; nothing is left behind") from None
        finally:
            shutil.rmtree(temporary, ignore_errors=True)


def prepare_folder(folder: Path, *, force: bool, resume: bool = False, rows: str = "") -> Path:
    """Make, or take up, a folder whose files are written one after the other: of a study, a sweep or a search.

    Args:
        folder: where to.
        force: write into a folder that holds results already.
        resume: go on with the rows that are there.
        rows: name of the file of finished rows, which `force` throws away; empty where nothing can be gone on with.

    Returns:
        The folder.

    Raises:
        ConfigurationError: it holds results, and neither or both is asked for; or files that no run wrote; or another
            process writes there.
        OutputError: it cannot be made or is not a folder.
    """
    if resume and force:
        raise ConfigurationError("--resume keeps the finished rows, --force throws them away: give one of them")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        begun = (folder / rows).exists() if rows else any(path.name != MARKER for path in folder.iterdir())
        if begun and not (resume or force):
            ways = (
                "finished runs; --resume goes on, --force starts anew"
                if rows
                else ("files already; give another folder, or --force to overwrite")
            )
            raise ConfigurationError(f"--output {folder}: holds {ways}")
        with folder_lock(folder.resolve()):
            if not (resume and begun):
                refuse_foreign(folder)
            mark(folder)
            if force and rows:
                (folder / rows).unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(f"--output {folder}: cannot be made: {error.strerror}; give another folder") from None
    return folder


def check_output(path: Path, *, force: bool, protect: tuple[Path, ...] = ()) -> Path:
    """Refuse an output folder before anything is computed.

    Returns:
        The folder without links.

    Raises:
        ConfigurationError: it exists without `force`, is a file, holds an input, the working folder, or files that no
            run wrote.
        OutputError: its parent cannot be written.
    """
    try:
        folder = path.resolve()
        here = Path.cwd()
    except (OSError, RuntimeError) as error:
        raise OutputError(f"--output {path}: cannot be reached ({error}); choose another folder") from None
    for file in protect:
        source = file.resolve()
        if folder == source or folder in source.parents:
            raise ConfigurationError(f"--output {path}: holds the input {file}; choose another folder")
    if folder == here or folder in here.parents:
        raise ConfigurationError(f"--output {path}: is the working folder, or holds it; give a folder of its own")
    if folder.exists() and not folder.is_dir():
        raise ConfigurationError(f"--output {path}: is a file; give a folder")
    if folder.exists() and not force:
        raise ConfigurationError(f"--output {path}: exists; give --force to replace it, or another folder")
    parent = next(place for place in folder.parents if place.exists())
    if not os.access(parent, os.W_OK) or not parent.is_dir():
        raise OutputError(f"--output {path}: {parent} cannot be written; choose another folder")
    if folder.exists():
        refuse_foreign(folder)
    return folder


def check_film(path: Path, *, force: bool) -> None:
    """Refuse the path of a film outside the folder of its run, before anything is computed.

    Raises:
        ConfigurationError: it exists without `force`, or is no film: nothing but a film is replaced by one.
        OutputError: its folder does not exist or cannot be written.
    """
    if path.exists() or path.is_symlink():
        if not force:
            raise ConfigurationError(f"--video {path}: exists; give --force to replace it, or another name")
        if not _is_film(path):
            raise ConfigurationError(f"--video {path}: exists and is no film; give another name")
    if not path.parent.is_dir() or not os.access(path.parent, os.W_OK):
        raise OutputError(f"--video {path}: {path.parent} is no folder that can be written; choose another one")


def _is_film(path: Path) -> bool:
    """Whether a file begins with a box of the type `ftyp`, behind four bytes of its length (ISO/IEC 14496-12, 4.3)."""
    if not path.is_file():
        return False
    with path.open("rb") as file:
        return file.read(8)[4:] == b"ftyp"


@contextmanager
def folder_lock(folder: Path) -> Iterator[None]:
    """Keep other processes from writing into the same folder meanwhile.

    The kernel drops the lock of a process that dies, so that the file a killed one leaves behind locks nothing.

    Raises:
        ConfigurationError: another process writes there; the message has its number.
        OutputError: the parent of the folder cannot be written.
    """
    path = folder.parent / f".{folder.name}.lock"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o644)
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written: {error.strerror}; choose another --output") from None
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if not os.fstat(descriptor).st_nlink:
                raise BlockingIOError  # the other one finished between the two calls
        except BlockingIOError:
            owner = os.read(descriptor, 20).decode(errors="replace").strip()
            raise ConfigurationError(
                f"--output {folder}: process {owner or '(unknown)'} is writing there; wait for it, or give another "
                "folder"
            ) from None
        except OSError:
            pass  # a file system without locks
        os.truncate(descriptor, 0)
        os.write(descriptor, f"{os.getpid()}\n".encode())
        try:
            yield
        finally:
            path.unlink(missing_ok=True)
    finally:
        os.close(descriptor)


def write_whole(path: Path, write: Callable[[Path], object]) -> None:
    """Write one file under a temporary name and rename it; a marked folder lists it.

    Args:
        path: final name.
        write: writes the file at the path it is given; the ending of the name is kept.

    Raises:
        OutputError: the file cannot be written; nothing is left behind.
    """
    temporary = path.with_name(f".{os.getpid()}.{path.name}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        note(path)
        write(temporary)
        temporary.replace(path)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror or error}; nothing is left behind") from None
    finally:
        temporary.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write a text file, as `write_whole` does."""
    write_whole(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))


def write_json(path: Path, content: Any) -> None:
    """Write JSON with sorted structure kept, two blanks of indent, and no NaN."""
    write_text(path, json.dumps(content, indent=2, allow_nan=False) + "\n")
