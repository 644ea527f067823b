"""Large tables are in a temporary file: equal values, few pages in memory, no file left, memory where no disk is."""

import mmap
import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from vehicle import mapped_table as module
from vehicle.engines.simulation.recording import Recording
from vehicle.mapped_table import release, table_of
from vehicle.runs.car import Car
from vehicle.signals.excitation.input_files import find_input

PAGES = Path("/proc/self/statm")
"""File of Linux with the pages of this process; proc_pid_statm(5)."""

pytestmark = pytest.mark.skipif(
    not (hasattr(os, "posix_fallocate") and hasattr(mmap.mmap, "madvise")), reason="no space can be reserved"
)


def resident() -> float:
    """Return the resident memory of this process [byte]."""
    return float(PAGES.read_text(encoding="ascii").split()[1]) * os.sysconf("SC_PAGE_SIZE")


def is_mapped(values: np.ndarray) -> bool:
    owner: object = values
    while isinstance(owner, np.ndarray):
        owner = owner.base
    return isinstance(getattr(owner, "obj", owner), mmap.mmap)


@pytest.mark.skipif(not PAGES.exists(), reason="resident memory is read on Linux")
def test_a_large_table_leaves_the_memory_and_keeps_its_values(tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    before, table = resident(), table_of((16, 1, 1_000_001))
    for row in table[:, 0]:
        row[:] = np.arange(row.size)
    assert resident() - before > 100e6
    release(table[3, 0, 5:])  # any part of it
    assert resident() - before < 10e6
    assert np.array_equal(table[15, 0], np.arange(1_000_001.0)) and list(tmp_path.iterdir()) == []


@pytest.mark.skipif("CS_GNU_LIBC_VERSION" not in getattr(os, "confstr_names", {}), reason="memory of glibc")
def test_beside_a_large_table_a_freed_array_leaves_the_memory():
    """By itself glibc would keep its memory, as arrays of this size were freed before."""
    # In a process of its own, whose heap has no free part of this size.
    text = """
import numpy as np
from tests.system.test_mapped_table import resident, table_of
table = table_of((16, 1_000_001))
for _ in range(2):
    arrays = [np.ones(3_000_000), np.ones(1_000_000)]
    held = resident()
    arrays.clear()
    assert held - resident() > 30e6
"""
    subprocess.run([sys.executable, "-c", text], cwd=Path(__file__).parents[2], check=True)


@pytest.mark.parametrize("fault", ["no space", "space lost", "small"])
def test_a_table_without_space_on_the_disk_is_in_memory(fault, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    if fault == "no space":
        monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=1e3))
    if fault == "space lost":
        monkeypatch.setattr(os, "posix_fallocate", full)
    size = 1000 if fault == "small" else 1_000_000
    table = table_of((16, size))
    assert not is_mapped(table)
    release(table)  # nothing to do
    monkeypatch.undo()
    assert is_mapped(table_of((16, 1_000_000)))


@pytest.mark.parametrize("engine", ["reduced", "mujoco"])
def test_a_run_in_a_file_has_the_same_bits(engine, monkeypatch):
    def recorded() -> Recording:
        return car.run(signal, engine).recording

    car = Car.load()
    signal = car.run(find_input("low.csv"), "reduced", channels=["seat_rail_acc_z"]).signal
    signal = type(signal)(
        time=signal.time[:2001], displacement={wheel: z[:2001] for wheel, z in signal.displacement.items()}
    )
    usual = recorded()
    monkeypatch.setattr(module, "MAPPED_FROM", 1e3)
    mapped = recorded()
    assert all(map(is_mapped, mapped.channels.values())) and not any(map(is_mapped, usual.channels.values()))
    assert {name: values.tobytes() for name, values in mapped.channels.items()} == {
        name: values.tobytes() for name, values in usual.channels.items()
    }
