"""Memory and disk of a run are stated before it starts, and refused where they do not fit."""

import ctypes
import os
import shutil
from types import SimpleNamespace

import pytest

from vehicle import machine, mapped_table
from vehicle.commands import shaker
from vehicle.errors import ConfigurationError
from vehicle.runs.output import run_size as module
from vehicle.runs.output.run_size import BYTES, run_size
from vehicle.signals.formats.formats import WRITTEN


def test_every_format_has_its_size():
    assert set(BYTES) == set(WRITTEN)


def test_a_long_run_is_stated_with_its_remedy(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "free_memory", lambda: 1e11)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=1e11))
    elsewhere = SimpleNamespace(stat=lambda: SimpleNamespace(st_dev=-1))
    monkeypatch.setattr(module, "scratch_folder", lambda: elsewhere)
    assert run_size(tmp_path / "new" / "run", 60.0, 1000.0, 100, ["npz"], reduced=True) == ""
    text = run_size(tmp_path / "new" / "run", 3600.0, 1000.0, 100, ["npz", "csv"], reduced=True)
    # 3.6e6 samples of 100 channels: 2.88 GB in a temporary file on another disk, 0.35 GB + 0.94 GB in memory; 8 and 13
    # byte a sample in the files.
    assert text.startswith("100 channels of 3600 s need about 1.3 GB of memory and 7.6 GB on the disk; for less,")
    assert "--channels" in text
    text = run_size(tmp_path, 3600.0, 1000.0, 5, ["npz"], reduced=False)
    assert "need about 1.3 GB of memory and 0.14 GB on" in text
    # Without a disk that has the space, the recording is in memory.
    with monkeypatch.context() as patch:
        patch.setattr(mapped_table, "MAPPED_FROM", float("inf"))
        text = run_size(tmp_path / "new" / "run", 3600.0, 1000.0, 100, ["npz", "csv"], reduced=True)
        # 5 channels are 0.14 GB, but in MuJoCo at least 64 are recorded: 1.84 GB.
        few = [run_size(tmp_path, 3600.0, 1000.0, 5, ["npz"], reduced=reduced) for reduced in (True, False)]
    assert text.startswith("100 channels of 3600 s need about 4.2 GB of memory and 7.6 GB on the disk; for less,")
    assert "need about 1.4 GB of memory" in few[0] and "need about 3.1 GB of memory" in few[1]
    # A temporary file on the disk of the results takes its space.
    monkeypatch.setattr(module, "scratch_folder", lambda: tmp_path)
    text = run_size(tmp_path / "new" / "run", 3600.0, 1000.0, 100, ["npz", "csv"], reduced=True)
    assert "and 10 GB on the disk; for less," in text
    # The free memory is of this moment: it is stated, at any size, and refuses nothing.
    monkeypatch.setattr(module, "physical_memory", lambda: 1e11)
    monkeypatch.setattr(module, "free_memory", lambda: 2e8)
    text = run_size(tmp_path, 60.0, 1000.0, 5, ["npz"], reduced=True)
    assert text.startswith("5 channels of 60 s need about 0.37 GB of memory (free now: 0.2 GB) and 0.0024 GB on the")


def test_what_exceeds_the_free_disk_or_the_memory_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "physical_memory", lambda: 1e9)
    with pytest.raises(ConfigurationError, match=r"need 1\.29 GB of memory .* 1 GB; for less"):
        run_size(tmp_path, 3600.0, 1000.0, 100, ["npz"], reduced=True)
    monkeypatch.setattr(module, "physical_memory", lambda: 1e11)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=1e9))
    with pytest.raises(
        ConfigurationError, match=r"need 2\.88 GB on the disk but may need at most the free 1 GB; for less"
    ):
        run_size(tmp_path, 3600.0, 1000.0, 100, ["npz"], reduced=True)


def test_the_size_is_that_of_the_files(tmp_path, capsys, monkeypatch):
    """The command states it before the run; here from the first byte on."""
    monkeypatch.setattr(module, "STATED_FROM", 1.0)
    words = ["--input", "low.csv", "--engine", "reduced", "--format", "csv", "--no-figures", "--quiet"]
    assert shaker.main([*words, "--output", str(tmp_path / "run")]) == 0
    said = capsys.readouterr().err
    stated = float(said.partition("memory and ")[2].split()[0]) * 1e9
    files = sum(path.stat().st_size for path in (tmp_path / "run").glob("time.*"))
    assert stated == pytest.approx(files, rel=0.15)  # text has fewer digits where numbers are short


@pytest.mark.skipif(os.name == "nt", reason="reads /proc/meminfo")
def test_memory_is_that_of_linux_and_of_its_container(tmp_path, monkeypatch):
    monkeypatch.setattr(machine, "MEMINFO", tmp_path / "meminfo")
    monkeypatch.setattr(machine, "CONTAINER", tmp_path)
    whole = machine.physical_memory()
    assert whole == float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES")
    assert machine.free_memory() == whole  # the system does not say
    (tmp_path / "meminfo").write_text("MemFree: 1 kB\nMemAvailable:  30000 kB\nSwapFree:  2000 kB\n")
    assert machine.free_memory() == 32000.0 * 1024.0
    (tmp_path / "memory.current").write_text("6000000\n")
    (tmp_path / "memory.max").write_text("max\n")
    assert machine.physical_memory() == whole and machine.free_memory() == 32000.0 * 1024.0
    (tmp_path / "memory.max").write_text("8000000\n")
    assert machine.physical_memory() == 8e6 and machine.free_memory() == 2e6


def test_free_memory_of_windows_is_with_the_page_file(monkeypatch):
    """MEMORYSTATUSEX: length and load, all and free memory, all and free with the page file."""

    def fill(status):
        status[1:5] = [16, 8, 24, 12]
        return 1

    kernel = SimpleNamespace(GlobalMemoryStatusEx=fill)
    monkeypatch.setattr(ctypes, "windll", SimpleNamespace(kernel32=kernel), raising=False)
    monkeypatch.setattr(machine, "os", SimpleNamespace(name="nt"))
    assert (machine.physical_memory(), machine.free_memory()) == (16.0, 12.0)
