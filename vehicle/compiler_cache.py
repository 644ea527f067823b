"""Where numba keeps compiled code: beside the sources, else in the user's cache, else in a private temporary folder.

numba's own search ends with an error where the package is read-only and there is no home folder. What is kept there is
loaded and run by the next process, so a folder that others could have written is not used.
"""

from __future__ import annotations

import os
import stat
import sys
import tempfile
from functools import cache
from pathlib import Path

VARIABLE = "NUMBA_CACHE_DIR"
"""numba reads this when it is imported; processes that are started from here inherit it."""

PACKAGE = Path(__file__).parent
COMPILING = ("simulation", "reduced")
"""Rooms with compiled functions."""


@cache
def prepare_compiler_cache() -> None:
    """Choose the folder of compiled code; to be called before numba is imported.

    Order: NUMBA_CACHE_DIR as given, `__pycache__` beside the sources (numba's own first choice), $XDG_CACHE_HOME or
    ~/.cache, a folder of the user's below the temporary one, a new one there. The first that can be written is taken.
    """
    given = os.environ.get(VARIABLE)
    if given:
        if _writable(Path(given)):
            return
    elif all(_writable(PACKAGE / room / "__pycache__") for room in COMPILING):
        return
    place = next((place for place in _places() if _writable(place)), None)
    chosen = tempfile.mkdtemp(prefix="vehicle-") if place is None else str(place)
    os.environ[VARIABLE] = chosen
    if "numba" in sys.modules:
        sys.modules["numba"].config.CACHE_DIR = chosen


def _places() -> list[Path]:
    """Folders outside the package, best first."""
    found = []
    named = os.environ.get("XDG_CACHE_HOME", "")
    home = Path(os.path.expanduser("~"))  # noqa: PTH111 - Path.home() raises where there is none
    if Path(named).is_absolute():
        found.append(Path(named) / "vehicle")
    elif home.is_absolute() and home.is_dir():
        found.append(home / ".cache" / "vehicle")
    shared = Path(tempfile.gettempdir()) / f"vehicle-{os.geteuid()}"
    if _private(shared):
        found.append(shared)
    return found


def _private(folder: Path) -> bool:
    """Whether a folder exists, or could be made, that belongs to this user alone."""
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        found = folder.lstat()
    except OSError:
        return False
    return stat.S_ISDIR(found.st_mode) and found.st_uid == os.geteuid() and not found.st_mode & 0o077


def _writable(folder: Path) -> bool:
    """Whether a file can be made in a folder, which is made where it is missing; asked by doing it."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False
