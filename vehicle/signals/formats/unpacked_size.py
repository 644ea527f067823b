"""Size of compressed data, checked before it is unpacked: one limit for every container that the program reads."""

import io
import zipfile
from typing import BinaryIO

from vehicle.errors import DataError
from vehicle.signals.formats.text import MEMORY_LIMIT

FREELY = 100_000_000
"""Maximum size of data that are unpacked at any compression ratio [byte]: a constant channel of one hour is smaller."""

DENSEST = 200
"""Maximum compression ratio of larger data [-]: sensor noise gives up to 20, zeros 1000."""

MOST_ENTRIES = 10_000
"""Maximum number of files in an archive: each is a file on the disk, or a step of a reader."""


def require_unpacked(
    label: object, size: float, packed: float, *, limit: float | None = None, freely: float | None = None,
    densest: float = DENSEST,
) -> None:  # fmt: skip
    """Refuse data that would fill the memory, or that are far denser than measurements.

    Args:
        size: size of the unpacked data by their headers [byte].
        packed: size in the file [byte].
        limit: maximum size [byte]; `MEMORY_LIMIT` by default.
        freely: size up to which every compression ratio is accepted [byte]; `FREELY` by default.
        densest: maximum compression ratio above it [-].
    """
    limit, freely = MEMORY_LIMIT if limit is None else limit, FREELY if freely is None else freely
    if size > limit:
        raise DataError(
            f"{label}: unpacked, its data need {size / 1024**3:.3g} GiB but may need at most {limit / 1024**3:.3g} "
            "GiB; cut the record into parts"
        )
    if size > freely and size > densest * packed:
        raise DataError(
            f"{label}: the data are almost constant, unlike a sensor: {size / 1e6:.3g} MB are "
            f"compressed to {packed / 1e6:.3g} MB, {size / max(packed, 1.0):.0f} to 1, must be at most "
            f"{densest:g} to 1; record again"
        )


def require_archive(
    label: object, file: BinaryIO, *, limit: float | None = None, freely: float | None = None, densest: float = DENSEST
) -> None:
    """Refuse a ZIP archive whose files would be too large, too dense or too many.

    The sizes are those of its directory, beyond which Python's `zipfile` does not unpack.
    """
    try:
        with zipfile.ZipFile(file) as archive:
            entries = archive.infolist()
    except (zipfile.BadZipFile, OSError, NotImplementedError, ValueError) as error:
        raise DataError(f"{label}: cannot be read as a ZIP archive ({error}); save or export it again") from None
    if len(entries) > MOST_ENTRIES:
        raise DataError(
            f"{label}: found {len(entries)} files in the archive, must be at most {MOST_ENTRIES}; save or export it "
            "again"
        )
    size, packed = sum(entry.file_size for entry in entries), file.seek(0, io.SEEK_END)
    file.seek(0)
    require_unpacked(label, size, packed, limit=limit, freely=freely, densest=densest)
