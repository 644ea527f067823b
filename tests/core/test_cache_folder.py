"""Folder of a core that is compiled on this machine: without a home folder, not where others write."""

import os
import tempfile

import pytest

from vehicle.core.cache_folder import cache_folder


@pytest.fixture
def places(monkeypatch, tmp_path):
    """Neither a home folder nor a named cache; the temporary folder is that of the test."""
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setenv("HOME", str(tmp_path / "nowhere"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    return tmp_path


def test_the_first_place_that_can_be_written_is_taken(places, monkeypatch):
    shared = places / f"vehicle-{os.geteuid()}"
    assert cache_folder() == shared and shared.stat().st_mode & 0o777 == 0o700
    (places / "home").mkdir()
    monkeypatch.setenv("HOME", str(places / "home"))
    assert cache_folder() == places / "home" / ".cache" / "vehicle"
    monkeypatch.setenv("XDG_CACHE_HOME", str(places / "named"))
    assert cache_folder() == places / "named" / "vehicle"


def test_a_folder_that_others_can_write_is_not_taken(places):
    shared = cache_folder()
    shared.chmod(0o777)  # others could have put their code there
    other = cache_folder()
    assert other != shared and other.stat().st_mode & 0o777 == 0o700
