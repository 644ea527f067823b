"""Logs of a CAN bus, frames of pandas, Parquet, arrays of HDF5 and objects of MATLAB."""

import struct

import numpy as np
import pytest

from tests.signals.formats.can_logs import Frame, blf
from tests.signals.formats.channel_times import times
from tests.signals.formats.logger_files import DBC, TEXTS
from vehicle.commands.inspect import main as inspect
from vehicle.errors import ConfigurationError, DataError, MissingPartError
from vehicle.signals.formats import rpc_format
from vehicle.signals.formats.channel import Channel, uniform_axis
from vehicle.signals.formats.reader import read_record

LOGS = ("bus.asc", "bus.log", "bus.trc", "bus2.trc")


@pytest.mark.parametrize("name", LOGS)
def test_a_bus_log_is_named_and_decoded(tmp_path, capsys, name):
    pytest.importorskip("asammdf")
    path, database = tmp_path / name, tmp_path / "car.dbc"
    path.write_text(TEXTS[name])
    database.write_text(DBC)
    assert inspect([str(path)]) == 3
    said = capsys.readouterr().err
    assert "log of a CAN bus" in said and "0x64" in said and "set --dbc FILE" in said
    channels = {one.name: one for one in read_record(path, [database]).channels}
    assert (channels["AccZ"].unit, channels["AccZ"].place, channels["Speed"].unit) == ("g", "Body 0x64", "km/h")
    np.testing.assert_allclose(channels["AccZ"].values, 0.01 * (256 + np.arange(6)) - 1.0)
    np.testing.assert_allclose(times(channels["AccZ"]), 0.02 * np.arange(6), atol=1e-6)
    assert inspect([str(path), "--dbc", str(database)]) == 0
    database.write_text(DBC.replace("BO_ 100", "BO_ 101"))
    with pytest.raises(DataError, match=r"the messages of the log \(0x64.*\); use the"):
        read_record(path, [database])


def test_a_database_is_asked_for_and_checked(tmp_path):
    pytest.importorskip("asammdf")
    path = tmp_path / "bus.log"
    path.write_text(TEXTS["bus.log"])
    (tmp_path / "bad.dbc").write_text("nothing")
    other = tmp_path / "log.csv"
    other.write_text("t [s],a [g]\n" + "".join(f"{n}.0,{n}.5\n" for n in range(9)))
    for log, database, message in (
        (path, tmp_path / "none.dbc", "--dbc .*none.dbc: "),
        (path, tmp_path / "bad.dbc", "--dbc .*bad.dbc"),
        (other, path, r"--dbc .*MDF, BLF, \.asc, \.trc, candump"),
    ):
        with pytest.raises(ConfigurationError, match=message):
            read_record(log, [database])


def raw_mdf(path, with_signals):
    """Raw frames of identifier 0x64 at 50 Hz as data loggers of CAN write them, and perhaps a decoded channel."""
    asammdf = pytest.importorskip("asammdf")
    from asammdf.blocks import v4_constants as v4c
    from asammdf.blocks.source_utils import Source

    kind = np.dtype(
        [("CAN_DataFrame.BusChannel", "u1"), ("CAN_DataFrame.ID", "<u4"), ("CAN_DataFrame.IDE", "u1"),
         ("CAN_DataFrame.DLC", "u1"), ("CAN_DataFrame.DataLength", "u1"), ("CAN_DataFrame.DataBytes", "(4,)u1")]
    )  # fmt: skip
    frames = np.zeros(6, dtype=kind)
    frames["CAN_DataFrame.BusChannel"], frames["CAN_DataFrame.ID"] = 1, 100
    frames["CAN_DataFrame.DLC"] = frames["CAN_DataFrame.DataLength"] = 4
    frames["CAN_DataFrame.DataBytes"][:, 0], frames["CAN_DataFrame.DataBytes"][:, 1] = np.arange(6), 1
    bus = Source("CAN", "CAN", "", source_type=v4c.SOURCE_BUS, bus_type=v4c.BUS_TYPE_CAN)
    times = 0.02 * np.arange(6)
    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(frames, times, name="CAN_DataFrame", source=bus)], acq_source=bus)
        file.groups[0].channel_group.flags |= v4c.FLAG_CG_BUS_EVENT | v4c.FLAG_CG_PLAIN_BUS_EVENT
        if with_signals:
            file.append([asammdf.Signal(np.arange(6.0), times, name="Acc", unit="g")])
        file.save(path, overwrite=True)


def test_raw_frames_in_mdf_are_no_channels(tmp_path):
    path, database = tmp_path / "bus.mf4", tmp_path / "car.dbc"
    raw_mdf(path, with_signals=False)
    database.write_text(DBC)
    with pytest.raises(DataError, match=r"MDF 4\.10.* 6 raw frames of 1 messages \(0x64\)"):
        read_record(path)
    channels = {one.name: one for one in read_record(path, [database]).channels}
    np.testing.assert_allclose(channels["AccZ"].values, 0.01 * (256 + np.arange(6)) - 1.0)
    raw_mdf(path, with_signals=True)
    found = read_record(path)
    assert [one.name for one in found.channels] == ["Acc"] and "6 raw frames of a CAN bus" in found.notices[0]


def test_frames_of_pandas_in_hdf5(tmp_path):
    """The layout that `DataFrame.to_hdf` writes, made by h5py: pandas needs PyTables for it."""
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "frame.h5"
    with h5py.File(path, "w") as file:
        group = file.create_group("run/data")
        group.attrs.update({"pandas_type": np.bytes_("frame"), "nblocks": 2, "ndim": 2})
        group["axis0"] = np.array([b"count", b"acc_z_g", b"Speed [km/h]"])
        group["axis1"] = 1770664802000000000 + 10000000 * np.arange(8)
        group["axis1"].attrs["kind"] = np.bytes_("datetime64")
        group["block0_items"], group["block1_items"] = np.array([b"acc_z_g", b"Speed [km/h]"]), np.array([b"count"])
        group["block0_values"] = np.column_stack([0.1 * np.arange(8), 36.0 + np.arange(8)])
        group["block1_values"] = np.arange(8)[:, np.newaxis]
        for block in ("block0_values", "block1_values"):
            group[block].attrs["transposed"] = True
    found = read_record(path)
    assert [(one.name, one.unit, one.place) for one in found.channels] == [
        ("count", "", "run/data"), ("acc_z_g", "g", "run/data"), ("Speed", "km/h", "run/data")]  # fmt: skip
    assert found.start == "2026-02-09T19:20:02.000+00:00"
    np.testing.assert_allclose(times(found.channels[2]), 0.01 * np.arange(8), atol=1e-12)
    np.testing.assert_allclose(found.channels[2].si_values, 10.0 + np.arange(8) / 3.6)
    with h5py.File(path, "a") as file:
        file["run/data"].attrs["pandas_type"] = np.bytes_("frame_table")
    with pytest.raises(DataError, match=r"import pandas; pandas.read_hdf\('frame.h5', 'run/data'\).to_csv"):
        read_record(path)


def test_rows_and_records_in_hdf5(tmp_path):
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "rows.h5"
    records = np.zeros(8, dtype=[("time_s", "f8"), ("acc_z_g", "f4"), ("id", "S4")])
    records["time_s"], records["acc_z_g"] = 0.01 * np.arange(8), np.arange(8)
    with h5py.File(path, "w") as file:
        file["one"] = np.arange(20.0)[np.newaxis, :]
        file["three"] = np.arange(90.0).reshape(3, 30)
        file["wide"] = np.arange(12.0).reshape(3, 4)
        file["log"] = records
    found = read_record(path)
    channels = {one.name: one for one in found.channels}
    assert list(channels) == ["acc_z_g", "one", "three(1,:)", "three(2,:)", "three(3,:)", "wide(:,1)", "wide(:,2)",
                              "wide(:,3)", "wide(:,4)"]  # fmt: skip
    assert channels["one"].values.size == 20
    np.testing.assert_array_equal(channels["three(2,:)"].values, 30.0 + np.arange(30))
    assert channels["acc_z_g"].unit == "g" and channels["acc_z_g"].rate == pytest.approx(100.0)
    assert "fields of 'log' without numbers are ignored: 'id'" in found.notices


def test_objects_of_matlab_7_3_are_refused_with_the_line_that_converts(tmp_path):
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "table.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        file["T"] = np.array([[3707764736, 2, 1, 1, 1, 1]], dtype=np.uint32)
        file["T"].attrs.update({"MATLAB_class": np.bytes_("table"), "MATLAB_object_decode": np.int32(3)})
    with path.open("r+b") as raw:
        raw.write(b"MATLAB 7.3 MAT-file".ljust(128))
    with pytest.raises(DataError, match=r"writetable\(T, 'T.csv'\)"):
        read_record(path)


def test_objects_of_matlab_5(tmp_path):
    """An element of class 17 as MATLAB writes it: flags, three names, and pointers that are no data."""

    def part(kind, data):
        return struct.pack("<II", kind, len(data)) + data.ljust(-(-len(data) // 8) * 8, b"\0")

    def matrix(flags, *parts):
        body = part(6, struct.pack("<II", flags, 0)) + b"".join(parts)
        return struct.pack("<II", 14, len(body)) + body

    pointers = matrix(13, part(5, struct.pack("<ii", 6, 1)), part(1, b""), part(6, struct.pack("<6I", 3707764736, 2, 1, 1, 1, 1)))  # noqa: E501  # fmt: skip
    table = matrix(17, part(1, b"T"), part(1, b"MCOS"), part(1, b"timetable"), pointers)
    plain = matrix(6, part(5, struct.pack("<ii", 4, 1)), part(1, b"acc"), part(9, struct.pack("<4d", 1, 2, 3, 4)))
    head = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<H", 0x0100) + b"IM"
    path = tmp_path / "table.mat"
    path.write_bytes(head + table)
    with pytest.raises(DataError, match=r"writetimetable\(T, 'T.csv'\)"):
        read_record(path)
    path.write_bytes(head + table + plain)
    found = read_record(path)
    assert [one.name for one in found.channels] == ["acc"] and "ignored: T: " in found.notices[-1]


def test_parquet(tmp_path):
    pyarrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    path = tmp_path / "log.bin"
    stamps = pyarrow.array(1770664802000000000 + 10000000 * np.arange(8), pyarrow.timestamp("ns"))
    values = 0.1 * np.arange(8)
    columns = {"when": stamps, "acc_z_g": values, "Speed (km/h)": 36.0 + values, "label": ["x"] * 8}
    parquet.write_table(pyarrow.table(columns), path)
    found = read_record(path)
    assert [(one.name, one.unit) for one in found.channels] == [("acc_z_g", "g"), ("Speed", "km/h")]
    np.testing.assert_allclose(times(found.channels[0]), 0.01 * np.arange(8), atol=1e-12)
    np.testing.assert_array_equal(found.channels[0].values, values)
    assert found.start == "2026-02-09T19:20:02.000+00:00" and "ignored: 'label'" in found.notices[0]
    data = path.read_bytes()
    for broken in (data[:-20], data[:200], b"PAR1" + bytes(600)):
        path.write_bytes(broken)
        with pytest.raises(DataError, match="cannot be read as Parquet"):
            read_record(path)


def test_blf_is_read_whole_or_refused(tmp_path, monkeypatch):
    import sys

    pytest.importorskip("can")
    pytest.importorskip("asammdf")
    path, database = tmp_path / "bus.blf", tmp_path / "car.dbc"
    database.write_text(DBC)
    frames = [Frame(0.02 * n, 1, "Rx", 100, False, bytes([n % 256, 1, 0, 0])) for n in range(8000)]
    blf(path, frames)
    found = read_record(path, [database])
    assert found.format == "blf" and found["AccZ"].values.size == 8000
    np.testing.assert_allclose(times(found["AccZ"]), 0.02 * np.arange(8000), atol=1e-6)
    data = path.read_bytes()
    for broken in (data[:-50], data[: len(data) // 2], data[:200], data[:5000] + bytes(60) + data[5060:]):
        path.write_bytes(broken)
        with pytest.raises(DataError, match=r"truncated|cannot be read as BLF|not a whole object"):
            read_record(path, [database])
    # a log that was not closed: its size is unknown, and its last container ends early
    path.write_bytes(data[:16] + bytes(16) + data[32 : len(data) // 2])
    with pytest.raises(DataError, match=r"cannot be read as BLF|not a whole object"):
        read_record(path, [database])
    monkeypatch.setitem(sys.modules, "can", None)
    with pytest.raises(MissingPartError, match=r"needs can, .* pip install 'vehicle-on-shaker\[can\]'"):
        read_record(path, [database])


def test_parquet_without_its_library(tmp_path, monkeypatch):
    import sys

    path = tmp_path / "log.parquet"
    path.write_bytes(b"PAR1" + bytes(600))
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(MissingPartError, match=r"needs pyarrow, .* pip install 'vehicle-on-shaker\[parquet\]'"):
        read_record(path)


@pytest.mark.parametrize(
    ("head", "said"),
    [
        (b"\x1aE\xdf\xa3\x9fB\x86\x81\x01B\x82\x84mide" + bytes(200), r"enDAQ IDE .* endaq.ide.to_pandas\("),
        (b"ULog\x01\x12\x35" + bytes(200), "PX4 ULog, not supported.* `ulog2csv"),
    ],
)
def test_what_is_not_read_is_refused_with_the_line_that_exports(tmp_path, head, said):
    path = tmp_path / "log.x"
    path.write_bytes(head)
    with pytest.raises(DataError, match=said):
        read_record(path)


@pytest.mark.parametrize("count", [300, 256, 5000])
def test_rpc_has_no_samples_that_nobody_measured(tmp_path, count):
    path = tmp_path / "rig.rsp"
    time = uniform_axis(count, 1.0 / 512.0)
    made = [Channel(name=n, values=np.sin(9.0 * time + p), unit="mm", axis=time) for n, p in (("a", 0.0), ("b", 1.0))]
    rpc_format.write(path, tuple(made), "test")
    data = path.read_bytes()
    assert read_record(path).channels[0].values.size == count
    path.write_bytes(data.replace(b"SAMPLES\0", b"SOMPLES\0"))
    (one, _) = read_record(path).channels
    assert one.values.size == count
    np.testing.assert_allclose(one.values, made[0].values, atol=1e-7)
    head = dict(zip(*[iter(part.strip(b"\0") for part in _halves(data))] * 2, strict=False))
    assert int(head[b"FRAMES"]) * int(head[b"PTS_PER_FRAME"]) - count < 128  # of a reader that ignores SAMPLES


def _halves(data):
    for at in range(0, 12 * 512, 128):
        yield data[at : at + 32]
        yield data[at + 32 : at + 128]
