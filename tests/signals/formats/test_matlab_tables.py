"""Tables and timetables of MATLAB in files of version 7 and 7.3, as mat-io writes them."""

import sys
import warnings

import numpy as np
import pytest

from tests.signals.formats.channel_times import times
from vehicle.errors import DataError, MissingPartError
from vehicle.signals.formats.reader import read
from vehicle.signals.records.choice import Choice, choose

matio = pytest.importorskip("matio")
pandas = pytest.importorskip("pandas")

TIME = np.arange(3000) / 512.0
SEAT, PLATE = np.sin(2 * np.pi * 3.0 * TIME), 2.0 * np.cos(2 * np.pi * 5.0 * TIME)


def saved(path, variables, version):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the unit of durations
        matio.save_to_mat(str(path), variables, version=version)
    return path


def timetable(index):
    frame = pandas.DataFrame({"SeatZ": SEAT, "Shaker FL": PLATE}, index=index)
    frame.index.name = "Time"
    return frame


def changed(path, version, change):
    """Change the properties of the timetable of a file, and write it again."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        variables = matio.load_from_mat(str(path), raw_data=True)
        record = variables["log"].properties["any"]
        fields = {name: record[0, 0][name] for name in record.dtype.names}
        change(fields)
        new = np.empty((1, 1), dtype=[(name, object) for name in fields])
        for name, value in fields.items():
            new[0, 0][name] = value
        opaque = matio.utils.MatlabOpaque(properties={"any": new}, classname="timetable")
        matio.save_to_mat(str(path), {"log": opaque}, version=version, saveobj_classes=["timetable"])


@pytest.mark.parametrize("version", ["v7", "v7.3"])
def test_durations_keep_their_digits(tmp_path, version):
    """512 Hz has steps of 1.953125 ms, which a data frame of mat-io rounds to whole milliseconds."""
    index = pandas.to_timedelta(np.rint(TIME * 1e9).astype("int64"), unit="ns")
    found = read(saved(tmp_path / "log.mat", {"log": timetable(index)}, version))
    assert [channel.name for channel in found.channels] == ["SeatZ", "Shaker FL"]
    assert np.allclose(times(found["SeatZ"]), TIME, atol=1e-9) and np.array_equal(found["SeatZ"].values, SEAT)
    assert found["Shaker FL"].rate == pytest.approx(512.0, rel=1e-9)


@pytest.mark.parametrize("version", ["v7", "v7.3"])
def test_dates_begin_at_their_first(tmp_path, version):
    index = pandas.Timestamp("2026-11-26 10:00") + pandas.to_timedelta(np.rint(TIME * 1e9).astype("int64"), unit="ns")
    found = read(saved(tmp_path / "log.mat", {"log": timetable(index)}, version))
    assert np.allclose(times(found["SeatZ"]), TIME, atol=1e-6) and found.start.startswith("2026-11-26T10:00:00")
    chosen = choose(found, Choice(channels={"z": "SeatZ"}, units={"z": "m/s2"}))
    assert 1.0 / chosen.step == pytest.approx(512.0, rel=1e-6)


@pytest.mark.parametrize("version", ["v7", "v7.3"])
def test_units_and_a_constant_rate(tmp_path, version):
    path = saved(tmp_path / "log.mat", {"log": timetable(pandas.to_timedelta(range(3000), unit="s"))}, version)

    def change(fields):
        duration = fields["rowTimes"]
        origin = matio.utils.MatlabOpaque(properties={**duration.properties, "millis": np.array([[500.0]])},
                                          classname="duration")  # fmt: skip
        step = matio.utils.MatlabOpaque(properties={**duration.properties, "millis": np.array([[np.nan]])},
                                        classname="duration")  # fmt: skip
        times = np.empty((1, 1), dtype=[(n, object) for n in ("origin", "specifiedAsRate", "stepSize", "sampleRate")])
        times[0, 0] = (origin, np.array([[True]]), step, np.array([[512.0]]))
        units = np.empty((1, 2), dtype=object)
        units[0, :] = [np.array(["m/s2"]), np.array(["mm"])]
        fields |= {"rowTimes": times, "varUnits": units}

    changed(path, version, change)
    found = read(path)
    assert [channel.unit for channel in found.channels] == ["m/s2", "mm"]
    assert np.allclose(times(found["SeatZ"]), 0.5 + TIME)


@pytest.mark.parametrize("version", ["v7", "v7.3"])
def test_a_table_with_a_column_of_times_and_texts(tmp_path, version):
    frame = pandas.DataFrame({"Time_s": TIME, "SeatZ": SEAT, "Marker": ["start", *["run"] * 2999]})
    found = read(saved(tmp_path / "log.mat", {"log": frame, "K": np.arange(5.0)}, version))
    assert [channel.name for channel in found.channels] == ["SeatZ", "K"]
    assert np.allclose(times(found["SeatZ"]), TIME) and "columns without numbers are ignored: 'Marker'" in found.notices


@pytest.mark.parametrize("version", ["v7", "v7.3"])
@pytest.mark.parametrize("kind", ["string", "category"])
def test_a_long_table_is_refused(tmp_path, version, kind):
    sensor = pandas.Series(["x", "y", "z"] * 1000)
    frame = pandas.DataFrame({"time_s": np.repeat(TIME[:1000], 3), "sensor": sensor, "acc": SEAT})
    frame = frame.astype({"sensor": "category"}) if kind == "category" else frame
    with pytest.raises(DataError, match="mixes rows of different sources: column 'sensor' alternates"):
        read(saved(tmp_path / "long.mat", {"log": frame}, version))


@pytest.mark.parametrize("version", ["v7", "v7.3"])
def test_without_the_library_the_extra_is_named(tmp_path, monkeypatch, version):
    frame = pandas.DataFrame({"time": TIME, "SeatZ": SEAT})
    path = saved(tmp_path / "log.mat", {"log": frame}, version)
    both = saved(tmp_path / "both.mat", {"log": frame, "K": np.arange(5.0)}, version)
    monkeypatch.setitem(sys.modules, "matio", None)
    with pytest.raises(MissingPartError, match=r"needs matio, which is not installed; .*vehicle-on-shaker\[matlab\]"):
        read(path)
    found = read(both)
    assert [channel.name for channel in found.channels] == ["K"] and "[matlab]" in " ".join(found.notices)


@pytest.mark.parametrize("version", ["v7", "v7.3"])
def test_a_truncated_file_is_refused(tmp_path, version):
    path = saved(tmp_path / "log.mat", {"log": pandas.DataFrame({"time": TIME, "SeatZ": SEAT})}, version)
    path.write_bytes(path.read_bytes()[: path.stat().st_size * 2 // 3])
    with pytest.raises(DataError):
        read(path)


def test_a_timetable_has_its_row_times_only(tmp_path):
    """Columns of durations and times beside the row times were the clocks of their neighbours."""
    frame = timetable(pandas.to_timedelta(np.rint(TIME * 1e9).astype("int64"), unit="ns"))
    frame.insert(1, "Time of lap in s", np.mod(TIME, 2.0) + 0.001)
    frame.insert(1, "LapDuration", pandas.to_timedelta(np.arange(3000) * 3, unit="s"))
    found = read(saved(tmp_path / "log.mat", {"log": frame}, "v7"))
    assert np.allclose(times(found["Shaker FL"]), TIME) and found["LapDuration"].unit == "ms"
