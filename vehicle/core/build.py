"""Commands that compile the core from its sources, with any C compiler that has the vector extensions of GCC.

Files of `VARIANTS` are compiled once for each number type and processor (`NAME` in vector.h), files of `DOUBLE` in
double precision only, all others once. Products and sums are rounded one by one (-ffp-contract=off): all compilers and
processors give equal bits.
"""

import hashlib
import subprocess
from collections.abc import Sequence
from pathlib import Path

from vehicle.core.header import SOURCES

VARIANTS = ("forces.c", "march.c", "outputs.c", "poles.c")
"""Files in double and single precision: the march, which other libraries contain in double precision."""

DOUBLE = ("callback.c", "reading.c")
"""Files for each processor in double precision only."""

OPTIONS = ["-std=gnu11", "-O3", "-ffp-contract=off", "-fno-math-errno", "-fvisibility=hidden"]
"""Language, optimisation and exactness."""

PROCESSORS = {"x86_64": {2: ["-march=x86-64-v2", "-DAT_ONCE=4"], 3: ["-march=x86-64-v3", "-DAT_ONCE=8"]}}
"""Variants by machine: number in `core_variant`, and options."""


def digest(sources: Path = SOURCES) -> str:
    """Return the SHA-256 of names and contents of the sources: the stamp of a library."""
    result = hashlib.sha256()
    for path in sorted(sources.glob("*.[ch]")):
        result.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return result.hexdigest()


def compile_core(
    compiler: Sequence[str],
    machine: str,
    library: Path,
    options: Sequence[str] = (),
    linked: Sequence[str] = (),
    single: bool = True,
) -> None:
    """Compile and link the core in a folder of its own, into which the sources are copied.

    Args:
        compiler: command of the compiler, with its target.
        machine: processor: x86_64, aarch64, wasm32.
        library: library that is written; its folder is the work folder and has the sources.
        options: further options of the compilation.
        linked: further options of the linking.
        single: with single precision.

    Raises:
        CalledProcessError: the compiler fails.
    """
    folder = library.parent
    stamp = f'-DSTAMP="{digest(folder)}"'
    objects = []

    def compiled(source: str, name: str, *further: str) -> None:
        objects.append(f"{name}.o")
        _run([*compiler, *OPTIONS, *options, *further, "-c", source, "-o", objects[-1]], folder)

    processors = PROCESSORS.get(machine, {1: ["-DAT_ONCE=4"]})
    for source in sorted(path.name for path in folder.glob("*.c")):
        stem = source.removesuffix(".c")
        if source not in (*VARIANTS, *DOUBLE):
            # The oldest processor runs the files that exist once; they take little of the time.
            compiled(source, stem, stamp, "-Os", *processors[min(processors)])
            continue
        for number, chosen in processors.items():
            for letter, real in (("d", "double"), ("f", "float"))[: 2 if single and source in VARIANTS else 1]:
                variant = f"{letter}{number}"
                compiled(source, f"{stem}_{variant}", f"-DVARIANT={variant}", f"-DREAL={real}", *chosen)
    _run([*compiler, *linked, "-o", library.name, *objects], folder)


def _run(command: Sequence[str], folder: Path) -> None:
    """Run a command of the compiler."""
    subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True)
