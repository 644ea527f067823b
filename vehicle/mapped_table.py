"""Large tables in a temporary file: only the pages in use are in memory, and the file ends with the table.

The file has no name from the start, so that nothing is left behind, even by a killed process. Its space is reserved
before it is used: a mapped page without space on the disk would end the process. Without that space, or on a system
that cannot reserve it, the table is in memory.
"""

import ctypes
import math
import mmap
import os
import shutil
import tempfile
from pathlib import Path

import numpy as np

from vehicle.arrays import Complex, Vector

MAPPED_FROM = 128e6
"""Minimum size of a table in a file [byte]: 250 s of 64 channels at 1 kHz. Writing a smaller one would take longer than
a program has use for its memory."""

LARGE_FILES = Path("/var/tmp")
"""Folder of large temporary files, on a disk; /tmp is often in memory. Source: file-hierarchy(7), systemd."""


MMAP_THRESHOLD, LARGE_ARRAY = -3, 2**20
"""Option of `mallopt`, and the size from which an array returns its memory to the system when it ends [byte].

By itself glibc keeps freed arrays of up to 32 MB for later ones. Source: mallopt(3), M_MMAP_THRESHOLD."""


def scratch_folder() -> Path:
    """Return the folder of the temporary files: TMPDIR if it is set, else `LARGE_FILES` if it exists."""
    named = "TMPDIR" in os.environ or not os.access(LARGE_FILES, os.W_OK)
    return Path(tempfile.gettempdir()) if named else LARGE_FILES


def size_in_memory(size: float) -> float:
    """Return the memory of a table of some size [byte]: 0 if it will be in a file."""
    mapped = size >= MAPPED_FROM and hasattr(os, "posix_fallocate") and hasattr(mmap.mmap, "madvise")
    return 0.0 if mapped and shutil.disk_usage(scratch_folder()).free > size else size


def table_of(shape: tuple[int, ...]) -> Vector:
    """Return a table whose values are undefined, in a temporary file from `MAPPED_FROM` on; see `release`."""
    size = 8 * math.prod(shape)
    if size_in_memory(size):
        return np.empty(shape)
    try:
        with tempfile.TemporaryFile(dir=scratch_folder()) as file:
            os.posix_fallocate(file.fileno(), 0, size)
            if hasattr(libc := ctypes.CDLL(None), "mallopt"):
                libc.mallopt(MMAP_THRESHOLD, LARGE_ARRAY)
            return np.frombuffer(mmap.mmap(file.fileno(), size), dtype=np.float64).reshape(shape)
    except OSError:  # no space, or a file system without files of this kind
        return np.empty(shape)


def release(part: Vector | Complex) -> None:
    """Take the pages of the table that contains an array out of memory; the next access reads them from the file.

    Source: madvise(2), MADV_DONTNEED on a shared mapping of a file: "subsequent accesses of pages in the range will
    succeed, but will result in repopulating the memory contents from the up-to-date contents of the underlying mapped
    file".
    """
    owner: object = part
    while isinstance(owner, np.ndarray):
        owner = owner.base
    owner = owner.obj if isinstance(owner, memoryview) else owner
    if isinstance(owner, mmap.mmap):
        owner.madvise(mmap.MADV_DONTNEED)
