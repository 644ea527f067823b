"""Compiled code is kept: in a read-only installation, without a home folder, and for the next process; in silence."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from tests.patience import HANG
from vehicle import compiler

ROOT = Path(__file__).resolve().parents[2]

SECOND_PROCESS = """
from vehicle.engines.reduced.time_stepping import compiled_stepping
from vehicle.runs.car import Car
from vehicle.signals.excitation.random_road import random_road
Car.load().run(random_road(rms=1e-4, seed=1, wheel="fr", duration=1.5), engine="reduced", channels=["seat_rail_acc_z"])
march = compiled_stepping()
print(sum(march.stats.cache_hits.values()), sum(march.stats.cache_misses.values()))
"""


@pytest.fixture
def places(monkeypatch, tmp_path):
    """No place is chosen yet; the temporary folder is that of the test."""
    monkeypatch.delenv(compiler.VARIABLE, raising=False)
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.delitem(sys.modules, "numba", raising=False)
    yield tmp_path
    os.environ.pop(compiler.VARIABLE, None)


def chosen():
    compiler.prepare_compiler_cache.__wrapped__()
    return os.environ.get(compiler.VARIABLE)


def test_the_first_place_that_can_be_written_is_taken(places, monkeypatch):
    assert chosen() is None, "numba keeps it beside the sources"
    (places / "file").write_text("")
    monkeypatch.setattr(compiler, "PACKAGE", places / "file")  # as a read-only installation: nothing can be made
    home = places / "home"
    home.mkdir()
    monkeypatch.setenv("HOME", str(home))
    assert chosen() == str(home / ".cache" / "vehicle")
    monkeypatch.delenv(compiler.VARIABLE)
    monkeypatch.setenv("HOME", str(places / "nowhere"))
    shared = places / f"vehicle-{os.geteuid()}"
    assert chosen() == str(shared)
    assert shared.stat().st_mode & 0o777 == 0o700
    monkeypatch.delenv(compiler.VARIABLE)
    shared.chmod(0o777)  # others could have put their code there
    other = chosen()
    assert other is not None and Path(other) != shared and Path(other).stat().st_mode & 0o777 == 0o700
    # A choice of the user that cannot be written is no error.
    monkeypatch.setenv(compiler.VARIABLE, str(places / "file" / "cache"))
    assert chosen() != str(places / "file" / "cache")


def test_the_next_process_finds_it(tmp_path):
    """The reduced engine was compiled anew by every process: four seconds before a run of 10 ms."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), compiler.VARIABLE: str(tmp_path / "cache")}
    said = []
    for _ in range(2):
        done = subprocess.run(
            [sys.executable, "-c", SECOND_PROCESS], env=environment, capture_output=True, text=True, timeout=HANG
        )
        assert done.returncode == 0 and done.stderr == "", done.stderr
        said.append(done.stdout.strip())
    assert said == ["0 1", "1 0"]
