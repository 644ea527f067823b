"""Build the core, and the libraries of FMUs and pages that contain it, with the compiler of the wheel ziglang.

    make tools
    .venv/bin/python tools/core.py [core|fmu|page] [PLATFORM ...] [--fmi-headers FOLDER] [--check]

The sources are in vehicle/core/source and vehicle/handover/fmu/runtime; equal sources give equal bytes. stamp.json
beside the libraries has the digest of the sources and the SHA-256 of each library, which tests compare. With the C
headers of FMI 2.0 and 3.0, as in fmpy/c-code of the wheel FMPy, the compiler compares every function of an FMU with
its declaration in the standard.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
from importlib import metadata
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from vehicle.core import build, library
from vehicle.core.build import VARIANTS, compile_core, digest
from vehicle.core.header import SOURCES

RUNTIME = Path(__file__).resolve().parents[1] / "vehicle" / "handover" / "fmu" / "runtime"
FMU_BINARIES = RUNTIME.parent / "binaries"
COMPILER = (sys.executable, "-m", "ziglang", "cc")
WARNINGS = ("-Wall", "-Wextra", "-Wshadow", "-Werror", "-Wno-psabi", "-fno-sanitize=all")
MARCH = tuple(name for name in VARIANTS if name != "outputs.c")
SPECTRA = "spectra.c"
FMI = ("fmi2.c", "fmi3.c")
PAGE = ("web_page.c", "web_spectra.c", "web_levels.c")


class Target(NamedTuple):
    """Platform: target of the compiler, ending of a library, and further options of compilation and linking."""

    name: str
    ending: str
    options: tuple[str, ...] = ("-fPIC",)
    linked: tuple[str, ...] = ("-shared",)


class Product(NamedTuple):
    """Library for several platforms: its stem, folder and platforms; options; files of the runtime that are left out.

    Without `runtime` it is the core alone, with it the march of the core and the runtime, which reads outputs.
    """

    stem: str
    binaries: Path
    platforms: tuple[str, ...]
    runtime: bool = False
    options: tuple[str, ...] = ()
    without: tuple[str, ...] = ()


TARGETS = {
    "x86_64-linux": Target("x86_64-linux-gnu.2.17", "so", linked=("-shared", "-lm")),
    "aarch64-linux": Target("aarch64-linux-gnu.2.17", "so", linked=("-shared", "-lm")),
    "x86_64-windows": Target("x86_64-windows-gnu", "dll", options=()),
    "x86_64-darwin": Target("x86_64-macos.11.0", "dylib"),
    "aarch64-darwin": Target("aarch64-macos.11.0", "dylib"),
    "wasm32-wasi": Target(
        "wasm32-wasi",
        "wasm",
        # Without this pass of LLVM addresses have constant offsets, which browsers run a tenth faster.
        options=("-msimd128", "-mexec-model=reactor", "-mllvm", "-disable-lsr"),
        linked=("-mexec-model=reactor", "-Wl,--export-dynamic"),
    ),
}

PRODUCTS = {
    "core": Product("core", library.BINARIES, tuple(TARGETS)),
    "fmu": Product(
        "car",
        FMU_BINARIES,
        ("x86_64-linux", "x86_64-windows", "x86_64-darwin", "aarch64-darwin"),
        runtime=True,
        options=("-DEMBEDDED",),
        without=(*PAGE, SPECTRA),
    ),
    "page": Product(
        "page",
        FMU_BINARIES,
        ("wasm32-wasi",),
        runtime=True,
        options=("-DEMBEDDED",),
        without=(*FMI, "fmi_instance.c", "instance.c"),
    ),
}

# zig names processors with underscores.
PROCESSORS = {"x86_64": {2: ["-mcpu=x86_64_v2", "-DAT_ONCE=4"], 3: ["-mcpu=x86_64_v3", "-DAT_ONCE=8"]}}


def copy_sources(product: Product, folder: Path) -> None:
    """Copy the sources of a library to a new folder."""
    folder.mkdir(parents=True)
    of_core = sorted(SOURCES.glob("*.[ch]"))
    if product.runtime:
        of_core = [path for path in of_core if path.suffix == ".h" or path.name in (*MARCH, SPECTRA)]
    of_runtime = sorted(RUNTIME.glob("*.[ch]")) if product.runtime else []
    for path in [*of_core, *of_runtime]:
        if path.name not in product.without:
            shutil.copy(path, folder)


def stamp_of(product: Product) -> dict[str, object]:
    """Return what stamp.json has for a library: digest of its sources, compiler, SHA-256 of each file."""
    with tempfile.TemporaryDirectory() as place:
        copy_sources(product, Path(place) / "source")
        sources = digest(Path(place) / "source")
    files = [product.binaries / name / f"{product.stem}.{TARGETS[name].ending}" for name in product.platforms]
    return {
        "sources": sources,
        "libraries": {
            path.relative_to(product.binaries).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(files)
        },
    }


def built(product: Product, platform: str, folder: Path, headers: str | None = None) -> Path:
    """Build the library of a platform in a new folder named source, and return its path.

    The name of the folder is the same for all: paths of sources must not be in the libraries.
    """
    target = TARGETS[platform]
    source = folder / "source"
    copy_sources(product, source)
    result = source / f"{product.stem}.{target.ending}"
    options = [*target.options, *product.options, *WARNINGS]
    compiler = [*COMPILER, "-target", target.name]
    try:
        for name in FMI if headers and product.stem == "car" else ():
            checked = ["-std=gnu11", *product.options, "-DFMI_HEADERS_OF_STANDARD", f"-I{headers}", "-c", name]
            subprocess.run([*compiler, *checked, "-o", "checked.o"], cwd=source, check=True, text=True)
        # Without it, the linker for Windows writes the present time into the library.
        os.environ["SOURCE_DATE_EPOCH"] = "0"
        linked = [*target.linked, "-s"]
        compile_core(compiler, platform.split("-")[0], result, options, linked, single=not product.runtime)
    except subprocess.CalledProcessError as error:
        sys.exit(f"{platform}: {error.stderr}")
    return result


def build_target(product: Product, platform: str, headers: str | None, *, check: bool) -> bool:
    """Build the library of a platform; put it into the package, or return whether the one there has the same bytes."""
    with tempfile.TemporaryDirectory() as folder:
        content = built(product, platform, Path(folder), headers).read_bytes()
    destination = product.binaries / platform / f"{product.stem}.{TARGETS[platform].ending}"
    same = check and destination.read_bytes() == content
    if not check:
        destination.parent.mkdir(parents=True, exist_ok=True)
        destination.write_bytes(content)
    verdict = f"{len(content)} bytes" if not check else "same bytes" if same else "OTHER bytes"
    print(f"{destination.relative_to(RUNTIME.parents[2])}: {verdict}", flush=True)
    return same or not check


def main() -> None:
    """Build the libraries and platforms that are named, or all, and their stamps."""
    parser = argparse.ArgumentParser()
    parser.add_argument("names", nargs="*", choices=[[], *PRODUCTS, *TARGETS])
    parser.add_argument("--fmi-headers")
    parser.add_argument("--check", action="store_true", help="compare with the libraries of the package; write nothing")
    given = parser.parse_args()
    headers = given.fmi_headers and str(Path(given.fmi_headers).resolve())
    build.PROCESSORS.update(PROCESSORS)
    same = [
        build_target(PRODUCTS[name], platform, headers, check=given.check)
        for name in [name for name in PRODUCTS if name in given.names] or list(PRODUCTS)
        for platform in PRODUCTS[name].platforms
        if platform in given.names or not set(given.names) & set(TARGETS)
    ]
    if given.check:
        sys.exit(not all(same))
    for binaries in {product.binaries for product in PRODUCTS.values()}:
        stamps = {name: stamp_of(product) for name, product in PRODUCTS.items() if product.binaries == binaries}
        stamp = {"compiler": f"ziglang {metadata.version('ziglang')}", **stamps}
        (binaries / "stamp.json").write_text(json.dumps(stamp, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
