"""Archives of arrays are judged by their headers; numbers beyond every sensor are refused by their cells."""

import warnings

import numpy as np
import pytest

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.signals.excitation.iso_road import IsoRoad, drive
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.signals.formats import unpacked_size
from vehicle.signals.formats.reader import read_record


def test_arrays_that_are_no_channels_stay_unread(tmp_path, monkeypatch):
    file = tmp_path / "many.npz"
    np.savez_compressed(file, time=np.arange(100) / 100.0, a=np.ones(100), image=np.zeros((400, 500)))
    monkeypatch.setattr(unpacked_size, "MEMORY_LIMIT", 10_000)  # less than the image
    assert [one.name for one in read_record(file).channels] == ["a"]
    np.savez_compressed(file, image=np.zeros((400, 500)))
    with pytest.raises(DataError, match="the array 'time' is missing; found no array of one dimension"):
        read_record(file)


def test_an_archive_of_nothing_but_zeros_is_refused_before_it_is_unpacked(tmp_path, monkeypatch):
    file = tmp_path / "zeros.npz"
    np.savez_compressed(file, time=np.zeros(100_000), a=np.zeros(100_000))
    monkeypatch.setattr(unpacked_size, "FREELY", 1_000_000)
    monkeypatch.setattr(np, "load", lambda *_, **__: pytest.fail("was unpacked"))
    with pytest.raises(DataError, match=r"1\.6 MB are compressed to .* must be at most 200 to 1"):
        read_record(file)
    monkeypatch.setattr(unpacked_size, "MEMORY_LIMIT", 1_000_000)
    with pytest.raises(DataError, match=r"its data need 0\.00149 GiB"):
        read_record(file)


def test_a_cell_beyond_every_sensor(tmp_path):
    file = tmp_path / "big.csv"
    rows = [f"{k / 1000.0},{1e-3 * np.sin(0.1 * k)}" for k in range(400)]
    rows[39] = "0.039,1e200"
    file.write_text("time [s],displacement [m]\n" + "\n".join(rows) + "\n", encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for accept in (False, True):
            with pytest.raises(DataError, match=r"big\.csv:41:2: column 'displacement \[m\]' is '1e200'"):
                read_signal(file, wheel="fl", accept_implausible=accept)


def test_a_road_that_fits_into_no_memory_is_refused_at_once():
    road = IsoRoad(level=CLASSES["C"], seed=1, track=1.5)
    with pytest.raises(ConfigurationError, match=r"1\.12e\+05 GB.*--duration .*--rate"):
        drive(road, speed=20.0, wheels={"fr": (0.0, "right"), "fl": (0.0, "left")}, duration=1e9)
