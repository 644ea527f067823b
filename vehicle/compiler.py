"""Functions for compiled code, and where numba keeps it: beside the sources, in the user's cache, or temporarily.

`jitable` marks a function of plain numbers, arrays and records that compiled code calls by its name; it stays what it
is in Python. numba itself is loaded by `numba_module`, at the first need. Its own search
for a folder ends with an error where the package is read-only and there is no home folder. What is kept there is loaded
and run by the next process, so a folder that others could have written is not used.
"""

from __future__ import annotations

import hashlib
import importlib
import os
import stat
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

VARIABLE = "NUMBA_CACHE_DIR"
"""numba reads this when it is imported; processes that are started from here inherit it."""

PACKAGE = Path(__file__).parent
COMPILING = ("engines/simulation", "engines/reduced")
"""Rooms with functions whose compiled form is kept."""

OPTIONS: dict[str, Any] = {"boundscheck": False, "error_model": "numpy", "fastmath": {"reassoc", "contract", "nsz"}}
"""Division as numpy has it; sums in any order, with fused products, so that they fill the vector units: round-off."""

Function = TypeVar("Function", bound=Callable[..., Any])
_marked: list[Callable[..., Any]] = []
_loaded: list[Any] = []


def jitable(function: Function) -> Function:
    """Mark a function that is put into the compiled code which calls it, and return it as it is."""
    _marked.append(function)
    if _loaded:
        _register()
    return function


def numba_module() -> Any:
    """The compiler, which knows all marked functions.

    Raises:
        ImportError: numba is not installed.
    """
    prepare_compiler_cache()
    numba = importlib.import_module("numba")
    if not _loaded:
        _loaded.append(importlib.import_module("numba.extending").register_jitable)
    _register()
    return numba


def _register() -> None:
    """Make the marked functions known to the compiler."""
    while _marked:
        # Put into their callers by LLVM. Not by numba: its loops err. Not left to be called: a process that compiles
        # takes each from its own module, and one that loads the callers from theirs, whose sums are rounded otherwise.
        _loaded[0](forceinline=True, **OPTIONS)(_marked.pop(0))


@cache
def stamp() -> int:
    """A number that changes with the sources of the compiled functions and with what they stand on.

    numba keeps compiled code by the file of its entry function alone, and by what that closes over: this number.
    """
    versions = (importlib.import_module("mujoco").__version__, importlib.import_module("numpy").__version__)
    digest = hashlib.sha256(repr(versions).encode())
    rooms = (path for room in ("model/laws", *COMPILING) for path in (PACKAGE / room).glob("*.py"))
    for path in (Path(__file__), *sorted(rooms)):
        digest.update(path.read_bytes())
    return int.from_bytes(digest.digest()[:6], "big")


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
