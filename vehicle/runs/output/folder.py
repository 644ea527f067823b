"""Folder of a run: written under a temporary name and renamed when complete."""

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
    """Yield a temporary folder; on success it is renamed to `path`, on failure removed.

    Args:
        path: final folder; a link is resolved.
        force: replace files of an earlier run.
        protect: input files; a folder that contains one of them is never replaced.

    Yields:
        The temporary folder, in the same parent folder.

    Raises:
        ConfigurationError: see `check_output`, or another process writes there.
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
    """Make, or continue, the folder of a study, a sweep or a search, which write their files step by step.

    Args:
        folder: the folder.
        force: write into a folder with results.
        resume: continue with the finished rows.
        rows: name of the file of finished rows, which `force` deletes; empty for a job that cannot be continued.

    Returns:
        The folder.

    Raises:
        ConfigurationError: the folder has results, and not exactly one of both is set; or it has files of the user; or
            another process writes there.
        OutputError: the folder cannot be made, or is no folder.
    """
    if resume and force:
        raise ConfigurationError("--resume keeps the finished rows, --force deletes them: set only one of them")
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
    """Check an output folder before the computation.

    Returns:
        The folder without links.

    Raises:
        ConfigurationError: it exists without `force`, is a file, holds an input, the working folder, or files that no
            run wrote.
        OutputError: its parent cannot be written.
    """
    try:
        folder = path.resolve()
        current = Path.cwd()
    except (OSError, RuntimeError) as error:
        raise OutputError(f"--output {path}: cannot be reached ({error}); choose another folder") from None
    for file in protect:
        source = file.resolve()
        if folder == source or folder in source.parents:
            raise ConfigurationError(f"--output {path}: holds the input {file}; choose another folder")
    if folder == current or folder in current.parents:
        raise ConfigurationError(f"--output {path}: is the working folder, or contains it; set another folder")
    if folder.exists() and not folder.is_dir():
        raise ConfigurationError(f"--output {path}: is a file; give a folder")
    if folder.exists() and not force:
        raise ConfigurationError(f"--output {path}: exists; give --force to replace it, or another folder")
    parent = next(parent for parent in folder.parents if parent.exists())
    if not os.access(parent, os.W_OK) or not parent.is_dir():
        raise OutputError(f"--output {path}: {parent} cannot be written; choose another folder")
    if folder.exists():
        refuse_foreign(folder)
    return folder


def check_file(
    path: Path, option: str = "--output", *, ending: str = "", force: bool, protect: tuple[Path, ...] = ()
) -> None:
    """Check the path of a single output file before the computation.

    Args:
        path: path of the file.
        option: option that names the file.
        ending: required ending, as ".csv".
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
    """Check files that are added to a folder with other files.

    Args:
        folder: the folder; it need not exist.
        names: names of the files, relative to the folder.
        force: replace files of the program.

    Raises:
        ConfigurationError: the folder is a file, or a file is in the way.
        OutputError: the folder cannot be written.
    """
    if folder.exists() and not folder.is_dir():
        raise ConfigurationError(f"--output {folder}: is a file; give a folder")
    for name in names:
        check_file(folder / name, force=force)


_claimed: set[Path] = set()
"""Folders and files that this command has locked until its end, see `claim`."""


class OccupiedError(ConfigurationError):
    """Error if another process writes to the same folder or file."""


@contextmanager
def claim(path: Path) -> Iterator[None]:
    """Lock a folder or a file that a command writes later; `folder_lock` in this process does not block.

    Args:
        path: resolved path.

    Raises:
        OccupiedError, OutputError: see `folder_lock`.
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
    """Lock a folder or a file against writing by other processes.

    The kernel releases the lock of a process that ends, so the lock file of a killed process does not block.

    Raises:
        OccupiedError: another process writes there; the message contains its process id.
        OutputError: the parent of the folder cannot be written.
    """
    if folder in _claimed:
        yield
        return
    path = folder.parent / f".{folder.name}.lock"
    new_folders = [parent for parent in path.parents if not parent.exists()]
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
            pass  # the file system does not support locks
        os.truncate(descriptor, 0)
        os.write(descriptor, f"{os.getpid()}\n".encode())
        try:
            yield
        finally:
            path.unlink(missing_ok=True)
    finally:
        os.close(descriptor)
        with suppress(OSError):  # a folder that is in use by now
            for parent in new_folders:
                parent.rmdir()


def _opened(path: Path) -> int:
    """Open a lock file, whose folder another process may remove in between."""
    for _ in range(5):
        path.parent.mkdir(parents=True, exist_ok=True)
        with suppress(FileNotFoundError):
            return os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o644)
    return os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o644)


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Yield a temporary name for a file; on success, rename it and add its name and digest to the list of its folder.

    Args:
        path: final name.

    Yields:
        A path with the same ending, where the body writes the file.

    Raises:
        ConfigurationError: the existing file is of the user, or was edited.
        OutputError: the file cannot be written; the temporary file is deleted.
    """
    if path.is_dir():
        raise OutputError(f"{path}: cannot be written: is a folder; nothing is left behind")
    refuse_foreign_file(path)
    temporary = path.with_name(f".{os.getpid()}.{path.name}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        note(path, UNFINISHED)
        yield temporary
        note(path, digest_of(temporary))
        temporary.replace(path)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror or error}; nothing is left behind") from None
    finally:
        temporary.unlink(missing_ok=True)


def write_whole(path: Path, write: Callable[[Path], object]) -> None:
    """Write a file with a function that writes it to a path, see `whole_file`."""
    with whole_file(path) as temporary:
        write(temporary)


def write_text(path: Path, text: str) -> None:
    """Write a text file, see `write_whole`."""
    write_whole(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))


def write_json(path: Path, content: Any) -> None:
    """Write JSON with an indent of two blanks; NaN raises a ValueError."""
    write_text(path, json.dumps(content, indent=2, allow_nan=False) + "\n")
