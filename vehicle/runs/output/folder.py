"""Folder of a run: written under a temporary name, renamed when complete, never half-finished under its own name."""

from __future__ import annotations

import fcntl
import json
import os
import shutil
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError, OutputError
from vehicle.runs.output.written_files import (
    MARKER,
    UNFINISHED,
    digest_of,
    discard,
    mark,
    note,
    refuse_foreign,
    refuse_foreign_file,
)


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
            refuse_foreign(folder, changes_only=resume and begun)
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


def check_file(
    path: Path, option: str = "--output", *, ending: str = "", force: bool, protect: tuple[Path, ...] = ()
) -> None:
    """Refuse the path of a single file before anything is computed.

    Args:
        path: of the file.
        option: that names it.
        ending: that its name must have, as ".csv".
        force: replace a file that the program wrote.
        protect: input files, which are never replaced.

    Raises:
        ConfigurationError: another ending, a folder, an input, a file that exists without `force`, or one that the
            program did not write.
        OutputError: its folder cannot be made or written.
    """
    if ending and path.suffix != ending:
        raise ConfigurationError(f"{option} {path}: this file is written as {ending}; give FILE{ending}")
    if path.is_dir():
        raise ConfigurationError(f"{option} {path}: is a folder; give FILE{ending}")
    if any(file.resolve() == path.resolve() for file in protect):
        raise ConfigurationError(f"{option} {path}: is an input of this command; give another name")
    if path.exists() or path.is_symlink():
        if not force:
            raise ConfigurationError(f"{option} {path}: exists; give --force to replace it, or another name")
        refuse_foreign_file(path, option)
    above = next(folder for folder in path.absolute().parents if folder.exists())
    if not above.is_dir():
        raise ConfigurationError(f"{option} {path}: {above.name} is a file, no folder; give another name")
    if not os.access(above, os.W_OK):
        raise OutputError(f"{option} {path}: {above} cannot be written; choose another folder")


def check_files(folder: Path, names: Iterable[str], *, force: bool) -> None:
    """Refuse to write files into a folder that may hold others in addition.

    Args:
        folder: the folder; it need not exist.
        names: of the files, relative to it.
        force: replace those that the program wrote.

    Raises:
        ConfigurationError: the folder is a file, or a file is in the way.
        OutputError: the folder cannot be written.
    """
    if folder.exists() and not folder.is_dir():
        raise ConfigurationError(f"--output {folder}: is a file; give a folder")
    for name in names:
        check_file(folder / name, force=force)


_claimed: set[Path] = set()
"""Folders and files that this command has locked until its end, as of `claim`."""


class OccupiedError(ConfigurationError):
    """Another process writes there."""


@contextmanager
def claim(path: Path) -> Iterator[None]:
    """Lock a folder or a file that a command writes later; `folder_lock` of this process passes meanwhile.

    Args:
        path: without links.

    Raises:
        OccupiedError, OutputError: as of `folder_lock`.
    """
    if path in _claimed:
        raise OccupiedError(f"--output {path}: is written twice by this command; give another name")
    with folder_lock(path):
        _claimed.add(path)
        try:
            yield
        finally:
            _claimed.discard(path)


@contextmanager
def folder_lock(folder: Path) -> Iterator[None]:
    """Keep other processes from writing into the same folder, or the same file, meanwhile.

    The kernel drops the lock of a process that dies, so that the file a killed one leaves behind locks nothing.

    Raises:
        OccupiedError: another process writes there; the message has its number.
        OutputError: the parent of the folder cannot be written.
    """
    if folder in _claimed:
        yield
        return
    path = folder.parent / f".{folder.name}.lock"
    made = [parent for parent in path.parents if not parent.exists()]
    try:
        descriptor = _opened(path)
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written: {error.strerror}; choose another --output") from None
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if not os.fstat(descriptor).st_nlink:
                raise BlockingIOError  # the other one finished between the two calls
        except BlockingIOError:
            owner = os.read(descriptor, 20).decode(errors="replace").strip()
            raise OccupiedError(
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
        with suppress(OSError):  # a folder that is in use by now
            for parent in made:
                parent.rmdir()


def _opened(path: Path) -> int:
    """Open a lock file, whose folder another process may remove in between."""
    for _ in range(5):
        path.parent.mkdir(parents=True, exist_ok=True)
        with suppress(FileNotFoundError):
            return os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o644)
    return os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o644)


def write_whole(path: Path, write: Callable[[Path], object]) -> None:
    """Write one file under a temporary name and rename it; the list of its folder gets its name and digest.

    Args:
        path: final name.
        write: writes the file at the path it is given; the ending of the name is kept.

    Raises:
        ConfigurationError: a file is there that the program did not write, or that was changed since.
        OutputError: the file cannot be written; nothing is left behind.
    """
    if path.is_dir():
        raise OutputError(f"{path}: cannot be written: is a folder; nothing is left behind")
    refuse_foreign_file(path)
    temporary = path.with_name(f".{os.getpid()}.{path.name}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        note(path, UNFINISHED)
        write(temporary)
        note(path, digest_of(temporary))
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
