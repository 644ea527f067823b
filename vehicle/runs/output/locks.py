"""Locks of folders and files against writing by other processes."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from vehicle.errors import ConfigurationError, OutputError
from vehicle.runs.output.notices import say

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


def lock_file(path: Path) -> Path:
    """Return the lock file of a folder or a file."""
    return path.parent / f".{path.name}.lock"


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
    path = lock_file(folder)
    new_folders = [parent for parent in path.parents if not parent.exists()]
    descriptor = -1
    try:
        try:
            descriptor = _opened(path)
            _lock(descriptor, folder)
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
                    say(f"{path}: the lock is left ({error.strerror}); the next command there removes it")
    finally:
        if descriptor >= 0:
            with suppress(OSError):
                os.close(descriptor)
        with suppress(OSError):  # a folder that is in use by now
            for parent in new_folders:
                parent.rmdir()


def _lock(descriptor: int, folder: Path) -> None:
    """Lock an open file; raise OccupiedError if another process holds the lock."""
    try:
        if os.name == "nt":
            import msvcrt

            os.lseek(descriptor, LOCKED_BYTE, os.SEEK_SET)
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined, unused-ignore]
            os.lseek(descriptor, 0, os.SEEK_SET)
        else:
            import fcntl

            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        if os.name != "nt" and not os.fstat(descriptor).st_nlink:
            raise BlockingIOError  # the other one finished between the two calls
    except (BlockingIOError, PermissionError):
        os.lseek(descriptor, 0, os.SEEK_SET)
        owner = os.read(descriptor, 20).decode(errors="replace").strip()
        raise OccupiedError(
            f"--output {folder}: process {owner or '(unknown)'} is writing there; wait until it ends, or "
            "give another folder"
        ) from None
    except OSError:
        pass  # the file system does not support locks


LOCKED_BYTE = 1 << 20
"""Position of the locked byte under Windows, which cannot be read; the process id is before it."""


def _opened(path: Path) -> int:
    """Open a lock file, whose folder another process may remove in between."""
    flags = os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0)
    for _ in range(5):
        path.parent.mkdir(parents=True, exist_ok=True)
        with suppress(FileNotFoundError):
            return os.open(path, flags, 0o644)
    return os.open(path, flags, 0o644)
