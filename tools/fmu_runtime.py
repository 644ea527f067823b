"""Build the libraries of FMUs for all platforms, and the module of web pages, with the compiler of the wheel ziglang.

    python -m pip install ziglang==0.17.1
    python tools/fmu_runtime.py [FOLDER WITH THE C HEADERS OF FMI 2.0 AND 3.0]

The sources are in vehicle/handover/fmu/runtime; equal sources give equal bytes. With the folder, as fmpy/c-code of the
wheel FMPy, the compiler also compares every function with its declaration in the headers of the standard. stamp.json
beside the libraries has the digest of the sources, which a test compares.
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

FMU = Path(__file__).resolve().parents[1] / "vehicle" / "handover" / "fmu"
SOURCES, BINARIES = FMU / "runtime", FMU / "binaries"
TARGETS = {
    "x86_64-linux": ("x86_64-linux-gnu.2.17", "car.so"),
    "x86_64-windows": ("x86_64-windows-gnu", "car.dll"),
    "x86_64-darwin": ("x86_64-macos.11.0", "car.dylib"),
    "aarch64-darwin": ("aarch64-macos.11.0", "car.dylib"),
}
# The module of a web page needs no functions from outside.
WEB_TARGET, WEB_MODULE, WEB_SOURCE = "wasm32-wasi", "wasm32/car.wasm", "web_page.c"
WEB_SOURCES = [WEB_SOURCE, "car_data.c", "instance.c", "time_step.c"]
WEB_OPTIONS = ["-mexec-model=reactor", "-msimd128", "-Wl,--export-dynamic"]
# Products and sums are rounded one by one: all platforms give equal bits.
OPTIONS = ["-std=c11", "-O2", "-ffp-contract=off", "-fvisibility=hidden", "-fno-sanitize=all", "-s"]
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


def _keep(built: Path, destination: Path) -> None:
    """Copy a library to its place in the package."""
    destination.parent.mkdir(parents=True, exist_ok=True)
    destination.write_bytes(built.read_bytes())
    print(f"{destination.relative_to(FMU)}: {destination.stat().st_size} bytes")


def main() -> None:
    """Build all libraries, and the stamp."""
    names = sorted(path.name for path in SOURCES.glob("*.c") if path.name != WEB_SOURCE)
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
            compiler("-target", target, *OPTIONS, "-fPIC", *WARNINGS, "-shared", "-o", library, *names, folder=folder)
            _keep(folder / library, BINARIES / platform / library)
        module = folder / Path(WEB_MODULE).name
        options = [*OPTIONS, *WEB_OPTIONS, *WARNINGS, "-o", module.name]
        compiler("-target", WEB_TARGET, *options, *WEB_SOURCES, folder=folder)
        _keep(module, BINARIES / WEB_MODULE)
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
