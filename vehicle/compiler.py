"""Registration of functions for numba, and the cache folder of compiled code.

`jitable` marks a function of numbers, arrays and records for calls from compiled code, and leaves it unchanged in
Python; `overloaded` marks a function whose compiled form is another function. `numba_module` loads numba at the first
use. numba's search for a cache folder fails for a read-only package without a home folder. The next process executes
code from the cache, so folders writable by others are not used.
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
"""Environment variable that numba reads at import; child processes inherit it."""

PACKAGE = Path(__file__).parent
COMPILING = ("engines/simulation",)
"""Packages with functions whose compiled form is cached."""

OPTIONS: dict[str, Any] = {"boundscheck": False, "error_model": "numpy", "fastmath": {"reassoc", "contract", "nsz"}}
"""Compiler options: division as in numpy; sums in any order and fused products for SIMD, which changes round-off."""

CALLED: dict[str, Any] = {"forceinline": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""Further options of functions that only compiled code calls. Inlined by LLVM: inlining by numba gives wrong loops.
Without inlining, a process that compiles calls the function from another module than a process that loads the callers,
which changes round-off. Entries for Python and C take a tenth of the compiling time."""

Function = TypeVar("Function", bound=Callable[..., Any])
_marked: list[tuple[Callable[..., Any], Callable[[Any], Any] | None]] = []
_loaded: list[Any] = []


def jitable(function: Function) -> Function:
    """Mark a function for inlining into compiled callers, and return it unchanged."""
    _mark(function, None)
    return function


def overloaded(compiled: Callable[[Any], Any]) -> Callable[[Function], Function]:
    """Return a decorator of a function with another form in compiled code; in Python the function is unchanged.

    Args:
        compiled: function of the module numba that returns the typing function of `numba.extending.overload`.
    """

    def mark(function: Function) -> Function:
        _mark(function, compiled)
        return function

    return mark


def _mark(function: Callable[..., Any], compiled: Callable[[Any], Any] | None) -> None:
    """Keep a function until numba is loaded, or register it."""
    _marked.append((function, compiled))
    if _loaded:
        _register()


def numba_module() -> Any:
    """Import numba and register all marked functions.

    Raises:
        ImportError: numba is not installed.
    """
    prepare_compiler_cache()
    numba = importlib.import_module("numba")
    if not _loaded:
        _loaded.append(numba)
    _register()
    return numba


def _register() -> None:
    """Register the marked functions with numba."""
    while _marked:
        function, compiled = _marked.pop(0)
        extending = _loaded[0].extending
        if compiled is None:
            extending.register_jitable(**CALLED, **OPTIONS)(function)
        else:
            extending.overload(function, jit_options=CALLED | OPTIONS)(compiled(_loaded[0]))


@cache
def stamp() -> int:
    """Return a hash of the sources of the compiled functions and of the versions of MuJoCo and numpy.

    The cache of numba depends only on the file of the entry function and on its closure values: this hash.
    """
    versions = (importlib.import_module("mujoco").__version__, importlib.import_module("numpy").__version__)
    digest = hashlib.sha256(repr(versions).encode())
    rooms = (path for room in ("model/laws", *COMPILING) for path in (PACKAGE / room).glob("*.py"))
    for path in (Path(__file__), *sorted(rooms)):
        digest.update(path.read_bytes())
    return int.from_bytes(digest.digest()[:6], "big")


@cache
def prepare_compiler_cache() -> None:
    """Choose the cache folder of compiled code; call this before numba is imported.

    Order: NUMBA_CACHE_DIR from the environment, `__pycache__` next to the sources (numba's default), $XDG_CACHE_HOME or
    ~/.cache, a private folder in the temporary folder, a new temporary folder. The first writable folder is used.
    """
    environment_folder = os.environ.get(VARIABLE)
    if environment_folder:
        if _writable(Path(environment_folder)):
            return
    elif all(_writable(PACKAGE / room / "__pycache__") for room in COMPILING):
        return
    os.environ[VARIABLE] = chosen = str(cache_folder())
    if "numba" in sys.modules:
        sys.modules["numba"].config.CACHE_DIR = chosen


def cache_folder() -> Path:
    """Return a folder outside the package for compiled code: the first writable candidate, else a new temporary one."""
    folder = next((folder for folder in _candidates() if _writable(folder)), None)
    return Path(tempfile.mkdtemp(prefix="vehicle-")) if folder is None else folder


def _candidates() -> list[Path]:
    """Return candidate cache folders outside the package, preferred first."""
    candidates = []
    named = os.environ.get("XDG_CACHE_HOME", "")
    home = Path(os.path.expanduser("~"))  # noqa: PTH111 - Path.home() raises where there is none
    if Path(named).is_absolute():
        candidates.append(Path(named) / "vehicle")
    elif home.is_absolute() and home.is_dir():
        candidates.append(home / ".cache" / "vehicle")
    shared = Path(tempfile.gettempdir()) / f"vehicle-{os.geteuid()}"
    if _private(shared):
        candidates.append(shared)
    return candidates


def _private(folder: Path) -> bool:
    """Return True if a folder exists, or can be made, that belongs to this user alone."""
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        status = folder.lstat()
    except OSError:
        return False
    return stat.S_ISDIR(status.st_mode) and status.st_uid == os.geteuid() and not status.st_mode & 0o077


def _writable(folder: Path) -> bool:
    """Return True if a file can be created in a folder, which is made if missing; tested by creating a file."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False
