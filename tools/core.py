"""Build the core for all platforms with the compiler of the wheel ziglang; equal sources give equal bytes.

    python -m pip install ziglang==0.17.1
    python tools/core.py [PLATFORM ...]

The sources are in vehicle/core/source. stamp.json beside the libraries has the digest of the sources and the SHA-256 of
each library, which a test compares.
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
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from vehicle.core import build
from vehicle.core.build import SOURCES, compile_core, digest
from vehicle.core.library import BINARIES


class Target(NamedTuple):
    """Platform: target of the compiler, library, and further options of compilation and linking."""

    name: str
    library: str
    options: tuple[str, ...] = ("-fPIC",)
    linked: tuple[str, ...] = ("-shared",)


TARGETS = {
    "x86_64-linux": Target("x86_64-linux-gnu.2.17", "core.so", linked=("-shared", "-lm")),
    "aarch64-linux": Target("aarch64-linux-gnu.2.17", "core.so", linked=("-shared", "-lm")),
    "x86_64-windows": Target("x86_64-windows-gnu", "core.dll", options=()),
    "x86_64-darwin": Target("x86_64-macos.11.0", "core.dylib"),
    "aarch64-darwin": Target("aarch64-macos.11.0", "core.dylib"),
    "wasm32-wasi": Target(
        "wasm32-wasi",
        "core.wasm",
        options=("-msimd128", "-mexec-model=reactor"),
        linked=("-mexec-model=reactor", "-Wl,--export-dynamic"),
    ),
}

WARNINGS = ("-Wall", "-Wextra", "-Wshadow", "-Werror", "-Wno-psabi", "-fno-sanitize=all")

# zig names processors with underscores.
PROCESSORS = {"x86_64": {2: ["-mcpu=x86_64_v2", "-DAT_ONCE=4"], 3: ["-mcpu=x86_64_v3", "-DAT_ONCE=8"]}}


def build_target(platform: str, target: Target) -> None:
    """Build the library of a platform."""
    compiler = [sys.executable, "-m", "ziglang", "cc", "-target", target.name]
    with tempfile.TemporaryDirectory() as place:
        # The same folder name for all: paths of sources must not be in the libraries.
        folder = Path(place) / "source"
        shutil.copytree(SOURCES, folder)
        library = folder / target.library
        try:
            compile_core(
                compiler, platform.split("-")[0], library, [*target.options, *WARNINGS], [*target.linked, "-s"]
            )
        except subprocess.CalledProcessError as error:
            sys.exit(f"{platform}: {error.stderr}")
        destination = BINARIES / platform / target.library
        destination.parent.mkdir(parents=True, exist_ok=True)
        destination.write_bytes(library.read_bytes())
    print(f"{platform}: {destination.stat().st_size} bytes", flush=True)


def main() -> None:
    """Build the libraries of the platforms that are named, or of all, and the stamp."""
    build.PROCESSORS.update(PROCESSORS)
    for platform in sys.argv[1:] or TARGETS:
        build_target(platform, TARGETS[platform])
    files = sorted(path for path in BINARIES.rglob("core.*") if path.is_file())
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
