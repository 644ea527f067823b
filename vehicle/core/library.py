"""The library of the core: shipped for this platform, or compiled from its sources with the C compiler at hand.

The environment variable VEHICLE_CORE names another library, for example with memory checks (`tools/core_sanitized.py`).
A library fits the sources whose digest it returns as its stamp. If no shipped library fits, because the sources have
changed, it is compiled once into a private cache folder (`cache_folder`), from which the next process loads it.
"""

import ctypes
import os
import platform
import shlex
import shutil
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path

from vehicle.core.build import compile_core, digest
from vehicle.core.cache_folder import cache_folder
from vehicle.core.header import SOURCES
from vehicle.errors import MissingPartError

BINARIES = Path(__file__).parent / "binaries"

SUFFIXES = {"linux": "so", "darwin": "dylib", "windows": "dll"}
"""Suffix of a library by operating system."""

MACHINES = {"amd64": "x86_64", "arm64": "aarch64"}
"""Other names of processors."""

COMPILERS = ("cc", "gcc", "clang")
"""Commands that are tried in this order; the environment variable CC comes before them."""


@cache
def core() -> ctypes.CDLL:
    """Return the library of the core, loaded once in a process.

    Raises:
        MissingPartError: no shipped library fits and there is no C compiler, or it fails.
    """
    stamp, chosen = digest(), os.environ.get("VEHICLE_CORE")
    library = _loaded(Path(chosen) if chosen else BINARIES / platform_name() / f"core.{_suffix()}", stamp)
    if library is None and chosen:
        raise MissingPartError(
            f"environment variable VEHICLE_CORE: {chosen} cannot be loaded, or was built from another version of "
            "the sources; build it again"
        )
    if library is None:
        library = _loaded(_compiled(stamp), stamp)
    if library is None:
        raise MissingPartError(
            f"the compiled core for {platform_name()} cannot be loaded; install a C compiler (gcc or clang), or a "
            "wheel of this package for this platform"
        )
    return library


def variant() -> str:
    """Return the variant of the core that runs on this processor, for example "AVX2, x86_64-linux"."""
    try:
        number = int(core().core_variant())
    except MissingPartError:
        return "missing"
    return {3: "AVX2, ", 2: "SSE2, "}.get(number, "") + platform_name()


def platform_name() -> str:
    """Return processor and operating system: "x86_64-linux"."""
    machine = platform.machine().lower()
    return f"{MACHINES.get(machine, machine)}-{platform.system().lower()}"


def _suffix() -> str:
    return SUFFIXES.get(platform.system().lower(), "so")


def _loaded(path: Path, stamp: str) -> ctypes.CDLL | None:
    """Return the library of a file; None if it cannot be loaded or belongs to other sources."""
    try:
        library = ctypes.CDLL(str(path))
    except OSError:
        return None
    library.core_stamp.restype = ctypes.c_char_p
    return library if library.core_stamp() == stamp.encode() else None


def _compiled(stamp: str) -> Path:
    """Return the library of the present sources from the cache folder, after compiling it there if it is missing.

    Raises:
        MissingPartError: there is no C compiler, or it fails.
    """
    kept = cache_folder() / f"core-{stamp[:16]}.{_suffix()}"
    if kept.is_file():
        return kept
    compiler = shlex.split(os.environ.get("CC", "")) or [name for name in COMPILERS if shutil.which(name)][:1]
    if not compiler:
        raise MissingPartError(
            f"the compiled core for {platform_name()} is missing or outdated, and no C compiler was found to "
            "build it; install gcc or clang, or set the environment variable CC to the command of a C compiler"
        )
    with tempfile.TemporaryDirectory(dir=kept.parent) as folder:
        sources = Path(folder) / "source"
        shutil.copytree(SOURCES, sources)
        library = sources / f"core.{_suffix()}"
        # A law without its function would else be found missing by the loader alone, which does not name it.
        options = [
            "-Wno-psabi",
            "-Werror=implicit-function-declaration",
            *([] if sys.platform == "win32" else ["-fPIC"]),
        ]
        try:
            compile_core(compiler, platform_name().split("-")[0], library, options, ["-shared", "-lm"])
        except (OSError, subprocess.CalledProcessError) as error:
            lines = (getattr(error, "stderr", "") or str(error)).strip().splitlines()
            # The first line of a compiler contains only the path of an include.
            fault = next((line for line in lines if "error" in line), lines[0])
            raise MissingPartError(
                f"the core cannot be compiled with {' '.join(compiler)}: {fault}; correct vehicle/core/source if you "
                "have changed it, otherwise set the environment variable CC to the command of another C compiler"
            ) from None
        library.replace(kept)
    return kept
