"""HDF5, MAT 7.3, MDF, TDMS and XLSX: files of the foreign libraries; a missing one is one sentence."""

import json
import sys

import numpy as np
import pytest

from tests.validation import foreign, validated
from vehicle.commands.inspect import main as inspect
from vehicle.errors import DataError
from vehicle.signals.formats import hdf_format
from vehicle.signals.formats.channel import Channel, uniform_axis
from vehicle.signals.formats.reader import read_record

TIME = uniform_axis(3000, 1.0 / 2000.0)
SINE = 3.0 * np.sin(2.0 * np.pi * 7.0 * TIME)

EXTRAS = {
    "hdf5": (b"\x89HDF\r\n\x1a\n" + bytes(600), "h5py"),
    "mdf": (b"MDF     4.10    " + bytes(600), "asammdf"),
    "tdms": (b"TDSm" + bytes(600), "nptdms"),
}


@pytest.mark.parametrize("name", EXTRAS)
def test_a_missing_extra_is_one_sentence(tmp_path, monkeypatch, capsys, name):
    data, package = EXTRAS[name]
    path = tmp_path / "foreign"
    path.write_bytes(data)
    monkeypatch.setitem(sys.modules, package, None)
    assert inspect([str(path)]) == 5
    said = capsys.readouterr().err
    assert f"needs {package}, which is not installed; install it with: pip install 'vehicle-on-shaker[{name}]'" in said
    assert said.count("\n") == 1


def check(path, form, digits=1e-12):
    """The one form of what all files below hold: a shaker in mm and a sensor in g, 2000 Hz."""
    found = read_record(path)
    shaker, sensor = found.channels[:2]
    assert (found.format, shaker.name, shaker.unit, sensor.unit) == (form, "Shaker FR", "mm", "g")
    assert shaker.rate == pytest.approx(2000.0, rel=1e-9)
    libraries = {"mdf": "asammdf", "tdms": "npTDMS", "xlsx": "openpyxl", "hdf5": "h5py"}
    for words, values, exact, size, unit in (
        ("displacement in mm", shaker.si_values, 1e-3 * SINE, 3e-3, "m"),
        ("acceleration in g", sensor.si_values, 9.80665 * 0.1 * SINE, 3.0, "m/s2"),
    ):
        validated(
            "File readers", f"{path.name}, {form} file, {words}", values, exact, abs=size * digits, unit=unit,
            source=foreign(libraries[form]),
        )  # fmt: skip
    return found


def test_mdf_with_names_twice_and_two_rasters(tmp_path):
    asammdf = pytest.importorskip("asammdf")
    path = tmp_path / "log.mf4"
    with asammdf.MDF(version="4.10") as file:
        one = [("Shaker FR", SINE, "mm"), ("Acc", 0.1 * SINE, "g"), ("count", np.arange(3000, dtype=np.int16), "V")]
        file.append([asammdf.Signal(v, TIME, unit=u, name=n) for n, v, u in one])
        file.append([asammdf.Signal(SINE[::10], TIME[::10], unit="mm", name="Shaker FR")])
        file.save(path)
    found = check(path, "mdf")
    assert [one.name for one in found.channels] == ["Shaker FR", "Acc", "count", "Shaker FR"]
    assert found.channels[3].rate == pytest.approx(200.0)
    np.testing.assert_array_equal(found.channels[2].values, np.arange(3000))
    data = path.read_bytes()
    for share in (0.2, 0.6, 0.95):
        path.write_bytes(data[: int(share * len(data))])
        try:
            held = read_record(path)  # what stands at the end is an index that a reader can do without
        except DataError:
            continue
        for ours, theirs in zip(held.channels, found.channels, strict=False):
            np.testing.assert_array_equal(ours.values, theirs.values)


def test_tdms(tmp_path):
    nptdms = pytest.importorskip("nptdms")
    path = tmp_path / "log.bin"
    known = {"wf_increment": 1.0 / 2000.0, "wf_samples": 7, "wf_start_offset": 0.0}
    made = [
        nptdms.ChannelObject("group", name, values, known | {"unit_string": unit})
        for name, values, unit in (("Shaker FR", SINE, "mm"), ("Acc", 0.1 * SINE, "g"))
    ]
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment(made)
    found = check(path, "tdms")
    assert found.start == "" and found.channels[0].place == "group"
    path.write_bytes(path.read_bytes()[:9000])
    try:
        assert read_record(path).channels[0].values.size < 3000
    except DataError as error:
        assert "truncated" in str(error)


def test_xlsx(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    path = tmp_path / "export.bin"
    book = openpyxl.Workbook()
    book.active.append(["Logger", None])
    sheet = book.create_sheet("data")
    for row in (["test; first", ""], ["Time", "Shaker FR", "Acc"], ["s", "mm", "g"]):
        sheet.append(row)
    for values in zip(TIME.tolist(), SINE.tolist(), (0.1 * SINE).tolist(), strict=True):
        sheet.append(values)
    book.save(path)
    found = check(path, "xlsx")
    assert found.notices == ("sheet 'data' of 2",)
    path.write_bytes(path.read_bytes()[:-300] + bytes(8))
    with pytest.raises(DataError):
        read_record(path)


def test_matlab_7_3(tmp_path):
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "export.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, label, values, unit in (("A", "Shaker FR", SINE, "mm"), ("B", "Acc", 0.1 * SINE, "g")):
            top = file.create_group(name)
            top.attrs["MATLAB_class"] = np.bytes_("struct")

            def text(group, key, words):
                one = group.create_dataset(key, data=np.array([[ord(sign)] for sign in words], dtype=np.uint16))
                one.attrs["MATLAB_class"] = np.bytes_("char")

            x, y = top.create_group("x_values"), top.create_group("y_values")
            x["increment"] = [[1.0 / 2000.0]]
            x["start_value"] = [[0.0]]
            y["values"] = values[np.newaxis, :]
            text(x.create_group("quantity"), "label", "s")
            text(y.create_group("quantity"), "label", unit)
            text(top.create_group("function_record"), "name", label)
    with path.open("r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file".ljust(128))
    check(path, "hdf5")


def test_hdf5_is_written_and_read(tmp_path):
    pytest.importorskip("h5py")
    path = tmp_path / "ours.h5"
    response = Channel(
        name="acc", values=SINE[:50] + 1j * SINE[50:100], unit="(m/s2)/m", axis=uniform_axis(50, 0.25, 1.0),
        kind="frequency", function="frequency response", place="12", direction="+Z", reference="1+Z",
    )  # fmt: skip
    shaker = Channel(name="Shaker FR", values=SINE, unit="mm", axis=TIME)
    hdf_format.write(path, (shaker, Channel(name="Acc", values=0.1 * SINE, unit="g", axis=TIME), response), "test")
    last = check(path, "hdf5").channels[2]
    np.testing.assert_array_equal(last.values, response.values)
    assert last.axis is not None and response.axis is not None
    np.testing.assert_allclose(last.axis, response.axis)
    for name in ("name", "unit", "kind", "function", "place", "direction", "reference"):
        assert getattr(last, name) == getattr(response, name)


def test_inspect_speaks_plain_numbers(tmp_path, capsys):
    """Missing values and complex lines give no NaN in JSON."""
    path = tmp_path / "log.csv"
    path.write_text("time [s];a [mm];b [g]\n" + "".join(f"{n};1,5;\n" for n in range(9)), encoding="utf-8")
    assert inspect([str(path), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["channels"]
    assert found[0]["rms"] == pytest.approx(1.5e-3) and found[1]["rms"] is None
