"""Damaged files of every format, 110 of them: exit code 3 and one sentence, or the same numbers; never a traceback."""

import io
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat, wavfile

from vehicle.commands.inspect import main as inspect
from vehicle.errors import DataError
from vehicle.signals.formats import hdf_format, rpc_format, uff_writer
from vehicle.signals.formats.channel import Channel, uniform_axis
from vehicle.signals.formats.geometry import Geometry, ModeShape
from vehicle.signals.formats.reader import read_record
from vehicle.signals.records.choice import Choice, choose

TIME = uniform_axis(600, 1.0 / 1024.0)
SINE = 1e-3 * np.sin(40.0 * TIME)
CHANNELS = (Channel(name="a", values=SINE, unit="m", axis=TIME, place="p", direction="+Z"),)


def good(form, folder):
    """A file as bytes, and whether every number of it must come back: those of WAV and MAT are not known by name."""
    path = folder / "good"
    if form == "csv":
        path.write_text(
            "logger\ntime [s];a [m]\n" + "".join(f"{t:.9f};{v:.9e}\n" for t, v in zip(TIME, SINE, strict=True))
        )
    elif form == "npz":
        with path.open("wb") as file:
            np.savez(file, time=TIME, a=SINE, units=np.array(["a [m]"]))
    elif form == "mat":
        held = io.BytesIO()
        savemat(held, {"a": SINE, "t": TIME})
        path.write_bytes(held.getvalue())
    elif form == "wav":
        wavfile.write(path, 1024, SINE.astype(np.float32))
    elif form == "hdf5":
        pytest.importorskip("h5py")
        hdf_format.write(path, CHANNELS, "x")
    elif form == "mdf":
        asammdf = pytest.importorskip("asammdf")
        with asammdf.MDF(version="4.10") as file:
            file.append([asammdf.Signal(SINE, TIME, unit="m", name="a")])
            path = Path(file.save(path, overwrite=True))
    elif form == "tdms":
        nptdms = pytest.importorskip("nptdms")
        with nptdms.TdmsWriter(str(path)) as writer:
            about = {"wf_increment": float(TIME[1]), "unit_string": "m"}
            writer.write_segment([nptdms.ChannelObject("group", "a", SINE, properties=about)])
    elif form == "xlsx":
        openpyxl = pytest.importorskip("openpyxl")
        book = openpyxl.Workbook()
        for row in (["time [s]", "a [m]"], *np.column_stack([TIME, SINE])[:50].tolist()):
            book.active.append(row)
        book.save(path)
    elif form == "modes":
        shape = np.ones((2, 6), dtype=complex)
        modes = [
            ModeShape(number=n, frequency=5.0 * n, points=("p", "q"), shape=shape, is_complex=True) for n in (1, 2)
        ]
        geometry = Geometry(points={"p": (0.0, 1.0, 2.0), "q": (3.0, 4.0, 5.0)}, lines=[("p", "q")])
        uff_writer.write(path, (), "x", geometry, modes)
    else:
        {"uff": uff_writer.write, "rpc": rpc_format.write}[form](path, CHANNELS, "x")
    return path.read_bytes()


def damages(data):
    """Ten of each: cut, a hole, bytes turned, a number of the header changed."""
    random = np.random.default_rng(1)
    yield from (data[: int(share * len(data))] for share in (0.02, 0.1, 0.4, 0.8))
    middle = len(data) // 2
    yield data[:middle] + data[middle + 37 :]
    yield data[:60] + data[61:]
    for _ in range(4):
        changed = bytearray(data)
        for place in random.integers(0, min(len(data), 1500), 3):
            changed[place] = int(random.integers(0, 256))
        yield bytes(changed)


FORMS = ("csv", "npz", "mat", "wav", "uff", "modes", "rpc", "hdf5", "mdf", "tdms", "xlsx")


@pytest.mark.parametrize("form", FORMS)
def test_damaged_files_end_with_one_sentence(tmp_path, capsys, form):
    data, path = good(form, tmp_path), tmp_path / "damaged"
    count = refused = 0
    for damaged in damages(data):
        path.write_bytes(damaged)
        code = inspect([str(path)])
        said = capsys.readouterr()
        count += 1
        assert code in (0, 3), said.err
        if code == 3:
            refused += 1
            assert said.err.startswith(f"error: {path}") and said.err.count("\n") == 1, said.err
    assert count == 10 and refused >= 3


@pytest.mark.parametrize("form", ["npz", "wav", "uff", "modes", "rpc", "tdms"])
def test_cut_files_are_refused_whole(tmp_path, form):
    data, path = good(form, tmp_path), tmp_path / "cut"
    for left in range(len(data) // 20, len(data) - 8, len(data) // 12):
        path.write_bytes(data[:left])
        with pytest.raises(DataError):
            read_record(path)


@pytest.mark.parametrize("form", ["uff", "rpc"])
def test_the_other_byte_order_is_no_vibration(tmp_path, form):
    """The header says the other order: numbers beyond all sensors, or none."""
    data, path = good(form, tmp_path), tmp_path / "turned"
    turned = (
        data.replace(b"58b     1", b"58b     2") if form == "uff" else data.replace(b"LITTLE_END", b"BIG_END\0\0\0")
    )
    assert turned != data
    path.write_bytes(turned)
    with pytest.raises(DataError, match=r"byte order|not finite|limits|beyond"):
        read_record(path)


@pytest.mark.parametrize("unit", ["qq", "m/s3", "\x80", "kg m"])
def test_a_broken_unit_is_shown_and_never_used(tmp_path, unit):
    path = tmp_path / "log.csv"
    path.write_text(f"time [s];a [{unit}]\n" + "".join(f"{t:.9f};{v:.9e}\n" for t, v in zip(TIME, SINE, strict=True)))
    (channel,) = read_record(path).channels
    assert channel.unit == unit and channel.si_unit == ""
    with pytest.raises(DataError, match=r"has the unknown unit .*; set --unit fr=UNIT"):
        choose(read_record(path), Choice(channels={"fr": "a"}))
