"""March the cars of `tests/core/recorded_march.py` with checks of every access to memory and of undefined operations.

    python tools/core_sanitized.py

The core is compiled with -fsanitize=address,undefined of the C compiler at hand. The records of the marches come from
real runs with all laws, single and double precision; a process of numpy and this core marches them again, in both
variants of the processor. Memory of numpy is checked too, because AddressSanitizer replaces malloc.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
if str(ROOT) not in sys.path:
    sys.path.insert(0, str(ROOT))

from vehicle.core.build import compile_core  # noqa: E402
from vehicle.core.header import SOURCES  # noqa: E402
from vehicle.core.library import COMPILERS, platform_name  # noqa: E402

CHECKS = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-g", "-O1"]
CALLBACK = [
    f"tests/core/test_{name}.py" for name in ("laws", "lengths", "equal_rows", "own_law", "own_friction", "spectra")
]
CALLBACK += ["tests/engines/simulation/test_sparse_rows.py"]
"""Tests that run with it: single laws, records of wrong lengths, every law in the rows of MuJoCo in both variants."""


def main() -> int:
    """Build the core with checks, march with it and run tests of the callback; return the exit status."""
    compiler = next(name for name in ("gcc", *COMPILERS) if shutil.which(name))
    with tempfile.TemporaryDirectory() as place:
        folder, marches = Path(place) / "source", str(Path(place) / "marches")
        shutil.copytree(SOURCES, folder)
        library = folder / "core.so"
        compile_core(
            [compiler], platform_name().split("-")[0], library, ["-fPIC", *CHECKS], ["-shared", "-lm", *CHECKS]
        )
        subprocess.run([sys.executable, "-m", "tests.core.recorded_march", marches], cwd=ROOT, check=True)
        # the C++ library too: the checks refuse an exception of C++, as matplotlib throws, where it is loaded later
        runtimes = [
            subprocess.check_output([compiler, f"-print-file-name={name}"], text=True).strip()
            for name in ("libasan.so", "libstdc++.so")
        ]
        environment = {
            **os.environ,
            "LD_PRELOAD": ":".join(runtimes),
            "ASAN_OPTIONS": "detect_leaks=0",
            "VEHICLE_CORE": str(library),
        }
        checks = ["tests.core.march_again", marches], ["pytest", "-q", "-n", "0", *CALLBACK]
        return max(
            subprocess.run([sys.executable, "-m", *check], cwd=ROOT, env=environment).returncode for check in checks
        )


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    sys.exit(main())
