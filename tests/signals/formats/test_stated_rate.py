"""Rates that a file states in attributes, and long tables in containers other than text."""

from typing import Any

import numpy as np
import pytest

from tests.signals.formats.channel_times import times
from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats import hdf_format, mixed_sources
from vehicle.signals.formats.reader import read
from vehicle.signals.formats.stated_rate import number_of, stated_step

VALUES = np.sin(np.arange(1500.0))

RATES = {
    "sample_rate": 100.0, "SampleRate": np.array([100]), "Sampling_Frequency": np.float32(100.0), "fs": 100,
    "Fs [Hz]": 100, "sampling_rate_hz": np.array([[100.0]]), "fs_kHz": 0.1, "samplerate": "100 Hz", "dt": 0.01,
    "SamplingFreq": b"100", "dt_ms": 10.0, "sample_interval": np.array([0.01]), "SamplingPeriod": "10 ms",
    "time_step": 0.01, "Abtastrate": "100", "wf_increment": 0.01, "samples_per_second": 100,
}  # fmt: skip


@pytest.mark.parametrize("name", RATES)
def test_names_of_rates_and_steps(name):
    step, remark = stated_step({"units": "m/s2", name: RATES[name]})
    assert step == pytest.approx(0.01, rel=1e-6) and not remark


@pytest.mark.parametrize("name", ["dx", "rate", "delta", "increment", "step"])
def test_names_that_may_be_of_another_quantity_are_asked(name):
    value = 100.0 if name == "rate" else 0.01
    step, remark = stated_step({name: value})
    assert step is None and remark.endswith("of the samples, set --rate 100")


@pytest.mark.parametrize(
    "numbers", [{"dots": 100.0}, {"fs": "fast"}, {"fs": np.zeros(2)}, {"dt": -0.01}, {"dt": "1 mm"}]
)
def test_other_numbers_state_no_rate(numbers):
    assert stated_step(numbers) == (None, "")


def test_two_rates_that_contradict_each_other():
    assert stated_step({"fs": 100.0, "dt": 0.01}) == (0.01, "")
    step, remark = stated_step({"fs": 100.0, "dt": 0.02})
    assert step is None and "'fs' = 100, 'dt' = 0.02" in remark and "--rate" in remark


@pytest.mark.parametrize("place", ["array", "group", "file", "number", "starting_time"])
def test_the_rate_of_an_array_of_hdf5(tmp_path, place):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        array = file.create_dataset("run/seat_z", data=VALUES)
        array.attrs["units"] = np.array(["m/s2"], dtype=h5py.string_dtype())  # as most writers make them
        if place == "number":
            file["run/fs"] = 100.0
        elif place == "starting_time":  # NWB
            file["run/starting_time"] = 0.5
            file["run/starting_time"].attrs["rate"] = np.array([100.0])
        else:
            {"array": array, "group": file["run"], "file": file}[place].attrs["sample_rate"] = np.array([100.0])
    channel = read(tmp_path / "a.h5").channels[0]
    assert channel.rate == pytest.approx(100.0) and channel.unit == "m/s2"
    assert times(channel)[0] == (0.5 if place == "starting_time" else 0.0)


@pytest.mark.parametrize("kind", ["signed", "spectrum"])
def test_attributes_of_length_one(tmp_path, kind):
    """Start and step beside accelerations of both signs are those of the time; others may be those of a spectrum."""
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["seat_z"] = VALUES if kind == "signed" else np.abs(VALUES)
        for name, value in {"start": [0.0], "delta": [0.01], "step": [0.01]}.items():
            file["seat_z"].attrs[name] = np.array(value)
        file["seat_z"].attrs["unit"] = np.array([b"g"])
    found = read(tmp_path / "a.h5")
    assert found.channels[0].unit == "g"
    if kind == "signed":
        assert found.channels[0].rate == pytest.approx(100.0)
        assert "'delta' = 0.01 " in found.notices[0] and "100 Hz" in found.notices[0]
    else:
        assert found.channels[0].axis is None and "--rate 100" in found.notices[0]


def test_a_long_text_is_no_number():
    """Its digits were tried in all divisions: minutes for a comment of a megabyte."""
    assert number_of("1" * 1_000_000 + "!") == (None, "") and number_of(" 0.01 s ") == (0.01, "s")


def test_a_group_of_many_arrays_is_searched_once(tmp_path, monkeypatch):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        for n in range(20):
            file[f"run/channel {n}"] = VALUES[:10]
    searched: list[str] = []

    def numbers(group: Any) -> dict[str, float]:
        searched.append(group.name)
        return {"fs": 100.0}

    monkeypatch.setattr(hdf_format, "_numbers", numbers)
    assert all(channel.rate == pytest.approx(100.0) for channel in read(tmp_path / "a.h5").channels)
    assert searched == ["/run"]


def test_equal_times_are_counted_once(tmp_path, monkeypatch):
    counted: list[int] = []

    def rows_at_once(time: Vector) -> int:
        counted.append(time.size)
        return 1

    monkeypatch.setattr(mixed_sources, "rows_at_once", rows_at_once)
    (tmp_path / "a.csv").write_text("\n".join(["Time [s],a,b,c", *(f"{n / 100},{n},{-n},0.5" for n in range(50))]))
    assert len(read(tmp_path / "a.csv").channels) == 3 and counted == [50]


def long_table() -> dict[str, Any]:
    return {"time_s": np.repeat(np.arange(500) / 100.0, 3), "sensor": ["x", "y", "z"] * 500, "acc_mps2": VALUES}


@pytest.mark.parametrize("kind", ["texts", "categories", "numbers"])
def test_a_long_table_of_parquet_is_refused_as_in_text(tmp_path, kind):
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    columns = long_table()
    if kind == "categories":
        columns["sensor"] = arrow.array(columns["sensor"]).dictionary_encode()
    elif kind == "numbers":
        columns["sensor"] = np.tile([4, 7, 9], 500)
    parquet.write_table(arrow.table(columns), tmp_path / "long.parquet")
    with pytest.raises(DataError, match=r"column 'sensor' alternates between '[x4]', "):
        read(tmp_path / "long.parquet")


def test_a_long_frame_of_pandas_whose_texts_are_not_readable(tmp_path):
    h5py = pytest.importorskip("h5py")
    columns = long_table()
    with h5py.File(tmp_path / "long.h5", "w") as file:  # the layout of `DataFrame.to_hdf`, which needs PyTables
        frame = file.create_group("log")
        frame.attrs.update({"pandas_type": "frame", "nblocks": np.array([2])})
        frame["axis0"], frame["axis1"] = [b"acc_mps2", b"sensor"], (columns["time_s"] * 1e9).astype("int64")
        frame["axis1"].attrs["kind"] = "timedelta64"
        frame["block0_items"], frame["block0_values"] = [b"acc_mps2"], VALUES[:, None]
        frame["block1_items"] = [b"sensor"]
        frame.create_dataset("block1_values", (1,), h5py.vlen_dtype(np.uint8))  # of pickled objects
    with pytest.raises(DataError, match="3 rows for each time, and the column 'sensor' is not readable"):
        read(tmp_path / "long.h5")


@pytest.mark.parametrize("kind", ["array of records", "arrays", "text with numbers"])
def test_a_long_table_in_other_files(tmp_path, kind):
    columns = long_table()
    path = tmp_path / "long"
    if kind == "text with numbers":
        rows = zip(columns["time_s"], np.tile([1, 2, 3], 500), columns["acc_mps2"], strict=True)
        path.write_text("\n".join(["time_s,sensor,acc_mps2", *(f"{t:.2f},{n},{a:.5f}" for t, n, a in rows)]))
    else:
        h5py = pytest.importorskip("h5py")
        with h5py.File(path, "w") as file:
            if kind == "arrays":
                for name, values in columns.items():
                    file[name] = np.array(values, dtype=h5py.string_dtype()) if name == "sensor" else values
            else:
                types = [("time_s", float), ("sensor", "S1"), ("acc_mps2", float)]
                file["log"] = np.array(list(zip(*columns.values(), strict=True)), dtype=types)
    with pytest.raises(DataError, match="mixes rows of different sources"):
        read(path)


def test_pairs_of_times_in_parquet(tmp_path):
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    time = np.arange(1500) / 200.0
    columns = {"Time [s]": time, "Seat Z [m/s2]": VALUES, "Time [s].1": 0.004 + 2.0 * time, "Rail Z [m/s2]": VALUES}
    parquet.write_table(arrow.table(columns), tmp_path / "pairs.parquet")
    found = read(tmp_path / "pairs.parquet")
    assert found["Seat Z"].rate == pytest.approx(200.0) and np.allclose(times(found["Rail Z"]), 0.004 + 2.0 * time)
    stamps = {name: (1.7e9 + values) * 1e9 for name, values in columns.items() if name[0] == "T"}
    columns |= {name: arrow.array(values.astype("int64"), arrow.timestamp("ns")) for name, values in stamps.items()}
    parquet.write_table(arrow.table(columns), tmp_path / "pairs.parquet")
    found = read(tmp_path / "pairs.parquet")
    assert np.allclose(times(found["Rail Z"]), 0.004 + 2.0 * time, atol=1e-6)
