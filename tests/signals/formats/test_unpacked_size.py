"""Compressed files that would fill the memory are refused by their headers, before anything is unpacked."""

import io
import struct
import tracemalloc
import zipfile
import zlib

import numpy as np
import pytest

from vehicle.errors import DataError
from vehicle.signals.formats.reader import read
from vehicle.signals.formats.unpacked_size import MOST_ENTRIES, require_archive, require_unpacked

SAMPLES = 8_000_000
"""Values and times of one channel: 128 MB."""


def hdf5(path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w") as file:
        file.create_dataset("force", shape=(2 * SAMPLES,), dtype="f8", chunks=(1000,), compression="gzip")


def parquet(path):
    arrow = pytest.importorskip("pyarrow")
    writer = pytest.importorskip("pyarrow.parquet")
    writer.write_table(arrow.table({"time [s]": np.zeros(SAMPLES), "force [N]": np.zeros(SAMPLES)}), path)


def matlab(path):
    inside = struct.pack("<II", 14, 16 * SAMPLES) + bytes(16 * SAMPLES)
    packed = zlib.compress(inside, 1)
    head = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM"
    path.write_bytes(head + struct.pack("<II", 15, len(packed)) + packed)


def mdf(path):
    asammdf = pytest.importorskip("asammdf")
    with asammdf.MDF(version="4.10") as file:
        zeros = np.zeros(SAMPLES)
        file.append([asammdf.Signal(samples=zeros, timestamps=zeros, name="force", unit="N")], common_timebase=True)
        file.save(path, overwrite=True, compression=2)


def sheet(path):
    openpyxl = pytest.importorskip("openpyxl")
    book, small = openpyxl.Workbook(), io.BytesIO()
    book.active.append(["time [s]", "force [N]"])
    book.save(small)
    row = b'<row><c t="n"><v>0</v></c><c t="n"><v>0</v></c></row>'
    with zipfile.ZipFile(small) as source, zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as goal:
        for name in source.namelist():
            content = source.read(name)
            if name.endswith("sheet1.xml"):
                content = content.replace(b"</sheetData>", 500_000 * row + b"</sheetData>")
            goal.writestr(name, content)


def arrays(path):
    np.savez_compressed(path, time=np.arange(SAMPLES) * 0.0, force=np.zeros(SAMPLES))


BOMBS = {"h5": hdf5, "parquet": parquet, "mat": matlab, "mf4": mdf, "xlsx": sheet, "npz": arrays}


@pytest.mark.parametrize("ending", BOMBS)
def test_a_dense_file_is_refused_without_unpacking_it(tmp_path, ending):
    path = tmp_path / f"bomb.{ending}"
    BOMBS[ending](path)
    tracemalloc.start()
    with pytest.raises(DataError, match=rf"bomb\.{ending}: .* MB are compressed to .* to 1, must be at most"):
        read(path)
    assert tracemalloc.get_traced_memory()[1] < 20e6
    tracemalloc.stop()


def test_the_limits():
    require_unpacked("a", 1e8, 0.0)
    require_unpacked("a", 1e9, 1e7)
    with pytest.raises(DataError, match=r"^a: .* 2\.79 GiB .* 2 GiB"):
        require_unpacked("a", 3e9, 3e9)
    many = io.BytesIO()
    with zipfile.ZipFile(many, "w") as archive:
        for number in range(MOST_ENTRIES + 1):
            archive.writestr(str(number), b"")
    for file, message in ((many, " 10001 files .* 10000"), (io.BytesIO(b"PK"), "ZIP archive")):
        with pytest.raises(DataError, match=f"^a: .*{message}"):
            require_archive("a", file)
