"""The package as it is installed: built as a wheel, run by its console script in an empty folder."""

import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from tests.patience import HANG

ROOT = Path(__file__).resolve().parents[2]
INSTALL = [sys.executable, "-m", "pip", "--disable-pip-version-check", "install", "--quiet", "--no-deps", "--no-index"]


def setuptools_version() -> tuple[int, ...]:
    from importlib.metadata import version

    return tuple(int(number) for number in re.findall(r"\d+", version("setuptools"))[:2])


@pytest.mark.skipif(
    importlib.util.find_spec("setuptools") is None or setuptools_version() < (70, 1),
    reason="needs the locked setuptools of the extra dev: versions before 70.1 build no wheel by themselves",
)
def test_the_wheel_runs_in_an_empty_folder(tmp_path):
    source, installed, here = tmp_path / "source", tmp_path / "installed", tmp_path / "here"
    kept = shutil.ignore_patterns("__pycache__")
    for name in ("vehicle", "scenarios"):
        shutil.copytree(ROOT / name, source / name, ignore=kept)
    for name in ("pyproject.toml", "README.md"):
        shutil.copy(ROOT / name, source / name)
    here.mkdir()
    # Offline, with the setuptools of this environment.
    sdist = f"from setuptools import build_meta; build_meta.build_sdist({str(tmp_path)!r})"
    subprocess.run([sys.executable, "-c", sdist], cwd=source, check=True, capture_output=True, timeout=HANG)
    (packed,) = tmp_path.glob("*.tar.gz")
    build = [*INSTALL[:-3], "--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir", str(tmp_path), str(packed)]
    build[build.index("install")] = "wheel"
    subprocess.run(build, cwd=here, check=True, capture_output=True, timeout=HANG)
    (wheel,) = tmp_path.glob("*.whl")
    subprocess.run([*INSTALL, "--target", str(installed), str(wheel)], cwd=here, check=True, timeout=HANG)
    archive = zipfile.ZipFile(wheel)
    names = archive.namelist()
    # Every file, data too: a pattern of package-data that fits no file says nothing.
    shipped = {path.relative_to(source).as_posix() for path in (source / "vehicle").rglob("*") if path.is_file()}
    assert {"vehicle/py.typed", "vehicle/signals/inputs/low.csv"} <= shipped
    assert shipped <= set(names), shipped - set(names)
    # The studies of the publications run from a clone; a top-level `scenarios` is nothing for anyone's environment.
    assert {name.split("/")[0].split("-")[0] for name in names} == {"vehicle", "vehicle_on_shaker"}
    assert [name for name in shipped if archive.read(name) != (source / name).read_bytes()] == []
    before = _contents(installed)

    without_home = {name: value for name, value in os.environ.items() if name not in ("HOME", "XDG_CACHE_HOME")}

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [str(installed / "bin" / "vehicle"), *arguments],
            cwd=here,
            env=without_home | {"PYTHONPATH": str(installed)},
            capture_output=True,
            text=True,
            timeout=HANG,
        )

    done = run("modes", "--json")
    assert done.returncode == 0 and done.stderr == "", done.stderr
    assert len(json.loads(done.stdout)["modes"]) > 20
    # The shipped inputs are part of it.
    done = run("shaker", "--input", "lov.csv", "--debug")
    assert done.returncode == 2 and "did you mean low.csv?" in done.stderr
    assert done.stderr.endswith("low.csv, mid.csv, pitch.csv, roll.csv, warp.csv\n")
    # And it is the installed package that answered, not the sources that this test runs in.
    assert str(installed) in done.stderr
    assert list(here.iterdir()) == []
    assert run("--version").stdout.startswith("vehicle-on-shaker ")  # of the metadata: there is no pyproject.toml
    done = run("shaker", "--input", "low.csv", "--engine", "reduced", "--report", "--quiet")
    assert done.returncode == 0 and done.stderr == "", done.stderr
    assert {"summary.json", "frf.csv", "report.html"} <= {path.name for path in (here / "runs" / "low").iterdir()}
    assert _contents(installed) == before  # an installation that cannot be written serves as well


def _contents(folder: Path) -> dict[str, float]:
    """Return the time of change of each file in a folder, without compiled Python."""
    return {str(path): path.stat().st_mtime for path in folder.rglob("*") if path.is_file() and path.suffix != ".pyc"}
