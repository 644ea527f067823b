"""Compiled code is kept: in a read-only installation, and without a home folder."""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

import pytest

from vehicle import compiler


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
