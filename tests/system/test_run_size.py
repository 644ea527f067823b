"""Memory and disk of a run are stated before it starts, and refused where they do not fit."""

import shutil
from types import SimpleNamespace

import pytest

from vehicle.commands import shaker
from vehicle.errors import ConfigurationError
from vehicle.machine import free_memory, physical_memory
from vehicle.runs.output import run_size as module
from vehicle.runs.output.run_size import BYTES, run_size
from vehicle.signals.formats.formats import WRITTEN


def test_every_format_has_its_size():
    assert set(BYTES) == set(WRITTEN)


def test_a_long_run_is_stated_with_its_remedy(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "free_memory", lambda: 1e11)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=1e11))
    assert run_size(tmp_path / "new" / "run", 60.0, 1000.0, 100, ["npz"]) == ""
    text = run_size(tmp_path / "new" / "run", 3600.0, 1000.0, 100, ["npz", "csv"])
    # 3.6e6 samples of 100 channels: 2.88 GB, and 0.3 GB + 1 GB beside; 8 and 13 byte a sample on the disk.
    assert text.startswith("100 channels of 3600 s need about 4.2 GB of memory and 7.6 GB on the disk; for less,")
    assert "--channels" in text


def test_what_exceeds_the_free_disk_or_memory_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "free_memory", lambda: 3e9)
    with pytest.raises(ConfigurationError, match=r"need 4\.19 GB of memory, must be at most the free 3 GB; for less"):
        run_size(tmp_path, 3600.0, 1000.0, 100, ["npz"])
    monkeypatch.setattr(module, "free_memory", lambda: 1e11)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=1e9))
    with pytest.raises(ConfigurationError, match=r"need 2\.88 GB on the disk, must be at most the free 1 GB; for less"):
        run_size(tmp_path, 3600.0, 1000.0, 100, ["npz"])


def test_the_size_is_that_of_the_files(tmp_path, capsys, monkeypatch):
    """The command states it before the run; here from the first byte on."""
    monkeypatch.setattr(module, "STATED_FROM", 1.0)
    words = ["--input", "low.csv", "--engine", "reduced", "--format", "csv", "--no-figures", "--quiet"]
    assert shaker.main([*words, "--output", str(tmp_path / "run")]) == 0
    said = capsys.readouterr().err
    stated = float(said.partition("memory and ")[2].split()[0]) * 1e9
    files = sum(path.stat().st_size for path in (tmp_path / "run").glob("time.*"))
    assert stated == pytest.approx(files, rel=0.15)  # text has fewer digits where numbers are short


def test_free_memory_is_a_part_of_the_memory_or_all_of_it():
    assert free_memory() > 1e7
    assert physical_memory() > 1e8
