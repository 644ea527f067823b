"""Finds the superelement that a vehicle file names: beside that file, or among those of the package."""

from __future__ import annotations

from functools import lru_cache
from importlib import resources
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.flexbody.superelement import Superelement
from vehicle.flexbody.superelement_file import read_superelement

PACKAGE_FOLDER = Path(str(resources.files("vehicle.flexbody")))


def find_superelement(name: str, folder: Path | None = None) -> Superelement:
    """Read a superelement by file name.

    Args:
        name: file name without folders; parameter validation allows letters, digits, '_', '.', '-' only.
        folder: folder of the vehicle file, searched first.

    Returns:
        The superelement.

    Raises:
        ConfigurationError: no such file in either folder, or a link that leads out of it.
        DataError: the file is bad.
    """
    folders = [place for place in (folder, PACKAGE_FOLDER) if place is not None]
    for place in folders:
        file = place / name
        if file.is_file():
            if file.resolve().parent != place.resolve():
                raise ConfigurationError(
                    f"body.superelement: {name} is a link that leads out of {place}; put the file itself there"
                )
            status = file.stat()
            return _read_once(file, status.st_mtime_ns, status.st_size)
    known = sorted(file.name for file in PACKAGE_FOLDER.glob("*.toml"))
    raise ConfigurationError(
        f"body.superelement: no file {name!r} beside the vehicle file nor in the package, which has {', '.join(known)}"
    )


# A sweep builds thousands of cars on one body; a superelement cannot be changed once it is read.
@lru_cache(maxsize=8)
def _read_once(file: Path, modified: int, size: int) -> Superelement:
    """Read a superelement again only where its file has changed."""
    return read_superelement(file)
