"""Locks of folders and files against writing by other processes."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from vehicle.errors import ConfigurationError, OutputError
from vehicle.leftovers import PLAIN, lock_file, say, take_lock

_claimed: set[Path] = set()
"""Folders and files that this command has locked until its end, see `claim`."""


class OccupiedError(ConfigurationError):
    """Error if another process writes to the same folder or file."""


@contextmanager
def claim(path: Path) -> Iterator[None]:
    """Lock a resolved path that a command writes later; `folder_lock` in this process does not block.

    Raises:
        OccupiedError, OutputError: see `folder_lock`.
    """
    if path in _claimed:
        raise OccupiedError(f"--output {path}: would be written twice by this command; give another name")
    with folder_lock(path), claimed(path):
        yield


@contextmanager
def claimed(path: Path) -> Iterator[None]:
    """Let `folder_lock` in this process pass for a path that another lock protects."""
    _claimed.add(path)
    try:
        yield
    finally:
        _claimed.discard(path)


def is_claimed(path: Path) -> bool:
    """True if this process has locked a path with `claim`, or another lock of this process protects it."""
    return path in _claimed


@contextmanager
def folder_lock(folder: Path) -> Iterator[None]:
    """Lock a folder or a file against writing by other processes.

    The kernel releases the lock of a process that ends, so the lock file of a killed process does not block. On a
    file system without locks the lock file itself is the lock, and the user removes the lock file of a killed process.

    Raises:
        OccupiedError: another process writes there; the message contains its process id.
        OutputError: the parent of the folder cannot be written.
    """
    if folder in _claimed:
        yield
        return
    path = lock_file(folder)
    new_folders = [parent for parent in path.parents if not parent.exists()]
    descriptor = -1
    try:
        try:
            descriptor, is_new = _opened(path)
            _lock(descriptor, folder, is_new=is_new)
            os.ftruncate(descriptor, 0)
            os.write(descriptor, f"{os.getpid()}\n".encode())
        except OSError as error:
            if descriptor >= 0 and os.name != "nt":
                with suppress(OSError):
                    path.unlink()
            raise OutputError(f"{folder}: cannot be written: {error.strerror}; choose another --output") from None
        try:
            yield
        finally:
            if os.name == "nt":  # an open file cannot be removed there; nor one that another process locks from here on
                os.close(descriptor)
                descriptor = -1
            try:
                path.unlink(missing_ok=True)
            except OSError as error:
                if os.name != "nt":  # there, the process that has opened it meanwhile removes it
                    say(f"{path}: the lock file remains ({error.strerror}); the next command there removes it")
    finally:
        if descriptor >= 0:
            with suppress(OSError):
                os.close(descriptor)
        with suppress(OSError):  # a folder that is in use by now
            for parent in new_folders:
                parent.rmdir()


def _lock(descriptor: int, folder: Path, *, is_new: bool) -> None:
    """Lock an open file; raise OccupiedError if another process holds the lock."""
    remedy = "wait until it ends"
    try:
        locked = take_lock(descriptor)
    except OSError:  # the file system does not support locks
        locked, remedy = is_new, f"if it has ended, remove {lock_file(folder).name}"
    # Without a name, the other process finished between the two calls; with two, writing would change another file.
    if not locked or (os.name != "nt" and os.fstat(descriptor).st_nlink != 1):
        os.lseek(descriptor, 0, os.SEEK_SET)
        owner = os.read(descriptor, 20).decode(errors="replace").strip()
        raise OccupiedError(
            f"--output {folder}: process {owner or '(unknown)'} is writing there; {remedy}, or give another folder"
        )


def _opened(path: Path) -> tuple[int, bool]:
    """Open a lock file, whose folder another process may remove in between; True if it did not exist."""
    flags = os.O_RDWR | os.O_CREAT | PLAIN
    for _ in range(5):
        path.parent.mkdir(parents=True, exist_ok=True)
        with suppress(FileNotFoundError):
            try:
                return os.open(path, flags | os.O_EXCL, 0o644), True
            except FileExistsError:
                return os.open(path, flags, 0o644), False
    return os.open(path, flags, 0o644), False
