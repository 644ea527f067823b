"""Damaged files of every format: exit code 3 and one sentence, or the same numbers; never a traceback."""

import io

import numpy as np
import pytest
from scipy.io import savemat, wavfile

from vehicle.commands.inspect import main as inspect
from vehicle.errors import DataError
from vehicle.records import hdf_format, rpc_format, uff_writer
from vehicle.records.channel import Channel, uniform_axis
from vehicle.records.reader import read_record

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


@pytest.mark.parametrize("form", ["csv", "npz", "mat", "wav", "uff", "rpc", "hdf5"])
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


@pytest.mark.parametrize("form", ["npz", "wav", "uff", "rpc"])
def test_cut_files_are_refused_whole(tmp_path, form):
    data, path = good(form, tmp_path), tmp_path / "cut"
    for left in range(len(data) // 20, len(data) - 8, len(data) // 12):
        path.write_bytes(data[:left])
        with pytest.raises(DataError):
            read_record(path)
