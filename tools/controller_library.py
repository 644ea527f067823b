"""Build the library of the controller FMU of the tests, for Linux, with the compiler of the wheel ziglang.

    python -m pip install ziglang==0.17.1
    python tools/controller_library.py

Equal sources give equal bytes. stamp.json beside the library has the digests of both, which a test compares.
"""

from __future__ import annotations

import hashlib
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tools.fmu_runtime import OPTIONS, TARGETS, WARNINGS, compiler

FOLDER = Path(__file__).resolve().parents[1] / "tests" / "data" / "controller"
FILES = ("skyhook.c", "skyhook.so")
"""Source and library."""


def digests() -> dict[str, str]:
    """Return the SHA-256 of source and library by name."""
    return {name: hashlib.sha256((FOLDER / name).read_bytes()).hexdigest() for name in FILES}


def main() -> None:
    """Build the library and the stamp."""
    source, library = FILES
    target, _ = TARGETS["x86_64-linux"]
    warnings = [name for name in WARNINGS if name != "-Wconversion"]
    compiler("-target", target, *OPTIONS, *warnings, "-shared", "-s", "-o", library, source, "-lm", folder=FOLDER)
    (FOLDER / "stamp.json").write_text(json.dumps(digests(), indent=2) + "\n", encoding="utf-8")
    print(f"{library}: {(FOLDER / library).stat().st_size} bytes")


if __name__ == "__main__":
    main()
