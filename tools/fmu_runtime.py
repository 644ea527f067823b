"""Build the libraries of FMUs for all platforms from vehicle/runs/fmu/runtime, with the compiler of the wheel ziglang.

    python -m pip install ziglang==0.17.1
    python tools/fmu_runtime.py [FOLDER WITH THE C HEADERS OF FMI 2.0 AND 3.0]

Equal sources give equal bytes. With the folder, as fmpy/c-code of the wheel FMPy, the compiler also compares every
function with its declaration in the headers of the standard. stamp.json beside the libraries has the digest of the
sources, which a test compares.
"""

from __future__ import annotations

import hashlib
import json
import shutil
import subprocess
import sys
import tempfile
from importlib import metadata
from pathlib import Path

FMU = Path(__file__).resolve().parents[1] / "vehicle" / "runs" / "fmu"
SOURCES, BINARIES = FMU / "runtime", FMU / "binaries"
TARGETS = {
    "x86_64-linux": ("x86_64-linux-gnu.2.17", "car.so"),
    "x86_64-windows": ("x86_64-windows-gnu", "car.dll"),
    "x86_64-darwin": ("x86_64-macos.11.0", "car.dylib"),
    "aarch64-darwin": ("aarch64-macos.11.0", "car.dylib"),
}
# Products and sums are rounded one by one: all platforms give equal bits.
OPTIONS = ["-std=c11", "-O2", "-ffp-contract=off", "-fvisibility=hidden", "-fno-sanitize=all", "-fPIC"]
WARNINGS = ["-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror"]


def digest() -> str:
    """Return the SHA-256 of the names and contents of the sources."""
    found = hashlib.sha256()
    for path in sorted(SOURCES.glob("*.[ch]")):
        found.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return found.hexdigest()


def compiler(*arguments: str, folder: Path) -> None:
    """Run the C compiler."""
    subprocess.run([sys.executable, "-m", "ziglang", "cc", *arguments], cwd=folder, check=True)


def main() -> None:
    """Build all libraries, and the stamp."""
    names = sorted(path.name for path in SOURCES.glob("*.c"))
    with tempfile.TemporaryDirectory() as place:
        # The same folder name for all: paths of sources must not be in the libraries.
        folder = Path(place) / "runtime"
        shutil.copytree(SOURCES, folder)
        if len(sys.argv) > 1:
            headers = str(Path(sys.argv[1]).resolve())
            for name in ("fmi2.c", "fmi3.c"):
                options = ["-std=c11", "-DFMI_HEADERS_OF_STANDARD", f"-I{headers}", "-c", name, "-o", f"{name}.o"]
                compiler(*options, folder=folder)
            print("functions agree with the headers of the standard")
        for platform, (target, library) in TARGETS.items():
            compiler("-target", target, *OPTIONS, *WARNINGS, "-shared", "-s", "-o", library, *names, folder=folder)
            destination = BINARIES / platform / library
            destination.parent.mkdir(parents=True, exist_ok=True)
            destination.write_bytes((folder / library).read_bytes())
            print(f"{destination.relative_to(FMU)}: {destination.stat().st_size} bytes")
    files = sorted(path for path in BINARIES.rglob("car.*") if path.is_file())
    stamp = {
        "sources": digest(),
        "compiler": f"ziglang {metadata.version('ziglang')}",
        "libraries": {
            path.relative_to(BINARIES).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest() for path in files
        },
    }
    (BINARIES / "stamp.json").write_text(json.dumps(stamp, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
