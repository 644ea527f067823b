"""Run the tests of the core with checks of every access to memory and of undefined operations.

    python tools/core_sanitized.py [TEST FILES]

The core is compiled with -fsanitize=address,undefined of the C compiler at hand, and loaded in the place of the shipped
one; memory of numpy is checked too, because AddressSanitizer replaces malloc. By default: the marches of real runs with
all laws, single and double precision, in both variants of the processor.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
if str(ROOT) not in sys.path:
    sys.path.insert(0, str(ROOT))

from vehicle.core.build import SOURCES, compile_core  # noqa: E402
from vehicle.core.library import COMPILERS, platform_name  # noqa: E402

CHECKS = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-g", "-O1"]
TESTS = ["tests/core", "tests/engines/reduced/test_time_step.py", "tests/engines/simulation/test_sparse_rows.py"]


def main() -> int:
    """Build the core with checks, and run the tests with it; return the exit status."""
    compiler = next(name for name in ("gcc", *COMPILERS) if shutil.which(name))
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "source"
        shutil.copytree(SOURCES, folder)
        library = folder / "core.so"
        compile_core(
            [compiler], platform_name().split("-")[0], library, ["-fPIC", *CHECKS], ["-shared", "-lm", *CHECKS]
        )
        runtime = subprocess.run([compiler, "-print-file-name=libasan.so"], capture_output=True, text=True, check=True)
        environment = {
            **os.environ,
            "LD_PRELOAD": runtime.stdout.strip(),
            "ASAN_OPTIONS": "detect_leaks=0",
            "VEHICLE_CORE": str(library),
        }
        tests = sys.argv[1:] or TESTS
        return subprocess.run([sys.executable, "-m", "pytest", "-n", "0", *tests], cwd=ROOT, env=environment).returncode


if __name__ == "__main__":
    sys.exit(main())
