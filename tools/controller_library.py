"""Build the library of the controller FMU of the tests, for Linux, with the compiler of the wheel ziglang.

    make tools
    .venv/bin/python tools/controller_library.py

Equal sources give equal bytes. stamp.json beside the library has the digests of both, which a test compares.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tools.core import COMPILER, TARGETS

FOLDER = Path(__file__).resolve().parents[1] / "tests" / "data" / "controller"
FILES = ("skyhook.c", "skyhook.so")
"""Source and library."""

OPTIONS = ("-std=c11", "-O2", "-ffp-contract=off", "-fvisibility=hidden", "-fno-sanitize=all", "-s")
WARNINGS = ("-Wall", "-Wextra", "-Wshadow", "-Werror")


def digests() -> dict[str, str]:
    """Return the SHA-256 of source and library by name."""
    return {name: hashlib.sha256((FOLDER / name).read_bytes()).hexdigest() for name in FILES}


def main() -> None:
    """Build the library and the stamp."""
    source, library = FILES
    target = ["-target", TARGETS["x86_64-linux"].name, "-shared", "-o", library, source, "-lm"]
    subprocess.run([*COMPILER, *OPTIONS, *WARNINGS, *target], cwd=FOLDER, check=True)
    (FOLDER / "stamp.json").write_text(json.dumps(digests(), indent=2) + "\n", encoding="utf-8")
    print(f"{library}: {(FOLDER / library).stat().st_size} bytes")


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    main()
