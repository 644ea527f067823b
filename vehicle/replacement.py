"""Replace files and folders in one step: written under another name, synchronised with the disk, then renamed.

Whatever ends the process, the old content keeps its name until the new content is complete. A loss of power is no
different: a name is moved to new content only after this content is on the disk.
"""

import errno
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

NOT_SUPPORTED = {errno.EINVAL, errno.ENOSYS, errno.ENOTSUP, errno.EOPNOTSUPP}
"""Errors of a kernel or a file system without the exchange of two names, or without synchronisation."""

EXCHANGE = 2
"""RENAME_EXCHANGE of Linux, and RENAME_SWAP of macOS."""

AT_FDCWD = -100
"""Relative names are relative to the working folder; renameat2(2)."""

_being_made: set[Path] = set()
"""Hidden folders and files of this process, which nobody reads before they are complete."""


def synchronise(path: Path) -> None:
    """Write a file, or the names in a folder, from the memory of the system to the disk.

    Raises:
        OSError: the disk is full or damaged.
    """
    folder = path.is_dir()
    if folder and os.name == "nt":
        return  # Windows has no such call; NTFS keeps the order of its changes itself
    descriptor = os.open(path, os.O_RDONLY if folder else os.O_RDWR)
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in NOT_SUPPORTED:
            raise
    finally:
        os.close(descriptor)


def synchronise_folder(folder: Path) -> None:
    """Write all files of a folder and of those below to the disk, then the names; see `synchronise`."""
    inner = sorted(folder.rglob("*"))
    for path in (path for path in inner if not path.is_dir()):
        synchronise(path)
    for path in (*(path for path in reversed(inner) if path.is_dir()), folder):
        synchronise(path)


def exchange(first: Path, second: Path) -> bool:
    """Exchange the names of two files or folders of one file system in one step.

    Returns:
        False if kernel or file system cannot; nothing is changed then.

    Raises:
        OSError: the names cannot be exchanged.
    """
    import ctypes

    names = os.fsencode(first), os.fsencode(second)
    try:
        if sys.platform.startswith("linux"):
            code = ctypes.CDLL(None, use_errno=True).renameat2(AT_FDCWD, names[0], AT_FDCWD, names[1], EXCHANGE)
        elif sys.platform == "darwin":
            code = ctypes.CDLL(None, use_errno=True).renamex_np(*names, EXCHANGE)
        else:
            return False
    except AttributeError:  # an older C library
        return False
    if not code:
        return True
    number = ctypes.get_errno()
    if number in NOT_SUPPORTED:
        return False
    raise OSError(number, os.strerror(number), str(second))


@contextmanager
def being_made(path: Path) -> Iterator[None]:
    """Declare a hidden folder or file, renamed when it is complete: it, and files in it, are written directly."""
    _being_made.add(path.absolute())
    try:
        yield
    finally:
        _being_made.discard(path.absolute())


def folder_being_made(path: Path) -> Path | None:
    """Return the nearest folder of `being_made` that contains a file; None if there is none."""
    return next((parent for parent in path.absolute().parents if parent in _being_made), None)


def is_being_made(path: Path) -> bool:
    """True if a file is in a folder of `being_made`, or is a temporary file of `replaced_file`."""
    return path.absolute() in _being_made or folder_being_made(path) is not None


@contextmanager
def replaced_file(path: Path) -> Iterator[Path]:
    """Yield a name for a new file in the same folder; on success, it takes the place of the file, else it is removed.

    Args:
        path: final name. It is yielded itself if it `is_being_made`: a writer of a file can be used in this context.

    Raises:
        OSError: the file cannot be written; an existing file is unchanged.
    """
    if is_being_made(path):
        yield path
        return
    temporary = path.with_name(f".{path.name}.{os.getpid()}.partial{path.suffix}")
    try:
        with being_made(temporary):
            yield temporary
        synchronise(temporary)
        temporary.replace(path)
    finally:
        with suppress(OSError):  # an undeletable file is found by the next command
            temporary.unlink(missing_ok=True)
    with suppress(OSError):  # the file is complete and has its name
        synchronise(path.parent)
