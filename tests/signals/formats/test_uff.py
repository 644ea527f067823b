"""Universal files: real foreign ones, those of the foreign library, and each trap made in code."""

from pathlib import Path

import numpy as np
import pytest

from tests.validation import foreign, validated
from vehicle.errors import DataError
from vehicle.signals.formats.reader import read_record

DATA = Path(__file__).resolve().parents[2] / "data" / "uff"
N = 8


def function(values, *, kind=2, spacing=1, step=1e-3, code=12, label="m/s2", unit_164=None, node=12, direction=3,
             points=None, binary=False, order="<", function=1, axis=17, axis_label="s", id1="Sensor A", size=None,
             tail=b""):  # fmt: skip
    """A file with one dataset 58, as bytes."""
    values = np.asarray(values, dtype=float)
    per = {2: 1, 4: 1, 5: 2, 6: 2}[kind] + (spacing == 0)
    points = values.size // per if points is None else points
    width = 4 if kind in (2, 5) else 8
    raw = values.astype(f"{order}f{width}").tobytes()
    size = len(raw) if size is None else size
    first = (
        f"    58b{1 if order == '<' else 2:6d}{2:6d}{11:12d}{size:12d}" + f"{0:6d}{0:6d}{0:12d}{0:12d}"
        if binary
        else "    58"
    )
    head = [
        "    -1", first, id1, "NONE", "01-Mar-26 10:00:00", "NONE", "NONE",
        f"{function:5d}{0:10d}{0:5d}{0:10d} {'NONE':<10}{node:10d}{direction:4d} {'NONE':<10}{0:10d}{0:4d}",
        f"{kind:10d}{points:10d}{spacing:10d}{0.0:13.5e}{step:13.5e}{0.0:13.5e}",
        f"{axis:10d}{0:5d}{0:5d}{0:5d} {'NONE':<20} {axis_label:<20}",
        f"{code:10d}{0:5d}{0:5d}{0:5d} {'NONE':<20} {label:<20}",
        *[f"{0:10d}{0:5d}{0:5d}{0:5d} {'NONE':<20} {'NONE':<20}"] * 2,
    ]  # fmt: skip
    if unit_164 is not None:
        system = f"{9:10d}{'USER_DEFINED':<20}{0:10d}"
        factors = [f"{number:25.16e}".replace("e", "D") for number in (unit_164, 1.0, 1.0)]
        head = ["    -1", "   164", system, "".join(factors), f"{-273.15:25.16e}", "    -1", *head]
    text = ("\n".join(line.rstrip() for line in head) + "\n").encode("cp1252")
    body = raw if binary else b""
    if not binary:
        rows = [values[n : n + 6] for n in range(0, values.size, 6)]
        body = "\n".join("".join(f"{value:13.5e}" for value in row) for row in rows).encode()
        body += b"\n"
    return text + body + tail + b"    -1\n"


def read(tmp_path, data):
    path = tmp_path / "any.dat"
    path.write_bytes(data)
    return read_record(path)


@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("order", ["<", ">"])
def test_a_function_is_read_with_place_and_unit(tmp_path, binary, order):
    values = np.linspace(-1.0, 1.0, 11)
    found = read(tmp_path, function(values, binary=binary, order=order, tail=b"\n" if binary else b""))
    (channel,) = found.channels
    assert (found.format, found.start, channel.name) == ("uff", "01-Mar-26 10:00:00", "Sensor A")
    assert (channel.place, channel.direction, channel.unit, channel.quantity) == ("12", "+Z", "m/s2", "acceleration")
    words = f"{'binary' if binary else 'text'}, {'little' if order == '<' else 'big'} endian"
    validated(
        "File readers", f"function of a universal file, {words}", channel.si_values, values, abs=5e-6, unit="m/s2",
        source="closed form: the values that were written, six digits",
    )  # fmt: skip
    assert channel.rate == 1000.0


def test_steps_that_were_rounded_are_a_clock(tmp_path):
    (channel,) = read(tmp_path, function(np.ones(N), step=1.0 / 65536.0)).channels
    assert (
        channel.rate == 65536.0
        and "1.52588e-05 s is rounded; the sampling rate is assumed to be 65536" in channel.remark
    )
    (channel,) = read(tmp_path, function(np.ones(N), step=0.0)).channels
    assert channel.rate is None and channel.remark == "no time step in the file"


@pytest.mark.parametrize(
    ("given", "unit", "factor"),
    [
        ({"label": "g"}, "g", 9.80665),
        ({"label": "g", "unit_164": 1.0}, "g", 9.80665),
        ({"label": "m/s²"}, "m/s²", 1.0),
        ({"label": "mm", "code": 8, "unit_164": 1000.0}, "mm", 1e-3),
        ({"label": "NONE", "code": 8, "unit_164": 1000.0}, "mm", 1e-3),
        ({"label": "NONE", "unit_164": 1.0}, "m/s2", 1.0),
        ({"label": "mm", "code": 0}, "mm", 1e-3),
        ({"label": "NONE"}, "", None),
        ({"label": "NONE", "code": 0, "unit_164": 1.0}, "", None),
        ({"label": "mm"}, "", None),  # an acceleration in mm
        ({"label": "mm", "code": 8, "unit_164": 1.0}, "", None),  # dataset 164 says metres
    ],
)
def test_units_are_those_that_the_file_tells_or_open(tmp_path, given, unit, factor):
    (channel,) = read(tmp_path, function(np.full(N, 2.0), **given)).channels
    assert channel.unit == unit
    if factor is None:
        assert channel.si_unit == "" and (channel.remark or given["label"] == "NONE")
    else:
        said = ", ".join(f"{key} {value}" for key, value in given.items())
        validated(
            "File readers", f"2 units of a universal file in SI, {said}", channel.si_values, 2.0 * factor, rel=1e-12,
            source="closed form: SI factors of the units, dataset 164",
        )  # fmt: skip


def test_frequency_responses_of_even_and_uneven_lines(tmp_path):
    response = np.arange(1.0, 7.0) + 1j * np.arange(6.0, 0.0, -1.0)
    flat = np.column_stack([response.real, response.imag]).ravel()
    known = {"kind": 5, "function": 4, "axis": 18, "axis_label": "Hz", "label": "(1/N)*(m/s²)", "code": 1}
    (even,) = read(tmp_path, function(flat, step=0.5, **known)).channels
    uneven = np.column_stack([0.5 * np.arange(6), flat.reshape(-1, 2)]).ravel()
    (other,) = read(tmp_path, function(uneven, spacing=0, step=0.0, **(known | {"axis": 0}))).channels
    for channel in (even, other):
        assert (channel.kind, channel.function, channel.si_unit) == ("frequency", "frequency response", "(m/s2)/(N)")
        np.testing.assert_allclose(channel.si_values, response, rtol=1e-5)
        assert channel.axis is not None
        np.testing.assert_allclose(channel.axis, 0.5 * np.arange(6))


def test_fortran_exponents_and_cut_blanks(tmp_path):
    data = function(np.full(7, -1.5e-3), code=0, label="V").replace(b"e-03", b"D-03")
    (channel,) = read(tmp_path, data).channels
    np.testing.assert_allclose(channel.values, -1.5e-3)


GOOD = function(np.linspace(1.0, 2.0, 50), binary=True)
TEXT = function(np.linspace(1.0, 2.0, 50))


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (GOOD[:-60], r"dataset 58 at byte 0 \(function 1\) states 200"),
        (TEXT[:-60], "has no end; the file is truncated"),
        (TEXT[:300], "ends within its header|has no end"),
        (function(np.ones(N), points=2_500_000), r"dataset 58 at byte 0 \(function 1\) states 2500000 numbers"),
        (function(np.ones(N), points=2_500_000, binary=True, size=10_000_000), r"dataset 58 at byte 0 \(function 1\)"),
        (function(np.ones(N), points=-5), "found data type 2, -5 points"),
        (function(np.ones(N), points=6, binary=True), "32 bytes of data for 6 numbers of 4 bytes"),
        (GOOD.replace(b"\x00\x00\x80?", b"\x00\x00\xc0\x7f"), "not finite"),
        (GOOD.replace(b"58b     1", b"58b     3"), "byte order 3"),
        (GOOD.replace(b"\x00\x00\x80?", b"\x80?"), "no end after its 200 bytes of data|not finite"),
        (TEXT.replace(b"1.00000e+00", b"1.0x000e+00"), "has an invalid number"),
        (
            b"    -1\n    15\n         1\n    -1\n",
            ("dataset 15 at byte 0 does not match the format that it states \\(node \\[1\\] with 0 coordinates\\)"),
        ),
        (
            b"    -1\n   161\n         1\n    -1\n",
            r"no time history, FRF, mode shape or node, only the datasets 161 \(1\)",
        ),
    ],
)
def test_damaged_files_are_refused(tmp_path, data, message):
    with pytest.raises(DataError, match=message):
        read(tmp_path, data)


def test_real_foreign_files():
    """Files of the project pyuff (MIT): what they hold, or why not."""
    sine = read_record(DATA / "binary8byte.uff").channels[0]
    assert (sine.unit, sine.rate, sine.values.size) == ("g", 100.0, 250)
    validated(
        "File readers", "peak of a sine of 1 g in a real universal file", np.max(sine.si_values), 9.80665, rel=1e-3,
        unit="m/s2", source="foreign code: pyuff, file of its tests",
    )  # fmt: skip
    (response,) = read_record(DATA / "non_ascii_header.uff").channels
    assert (response.unit, response.si_unit) == ("(1/N)*(m/s²)", "(m/s2)/(N)")
    catman = read_record(DATA / "time-history-not-all-columns-filled.uff").channels[0]
    assert (catman.unit, catman.rate, catman.values.size) == ("m/s²", 20000.0, 13)
    with pytest.raises(DataError, match=r"dataset 58 at byte 0 \(function 1\) states 2508876 numbers"):
        read_record(DATA / "dataset_milestone_in_header.uff")


def test_files_of_the_foreign_library(tmp_path):
    pyuff = pytest.importorskip("pyuff")
    time = np.arange(400) / 2048.0
    values = np.sin(40.0 * time)
    path = tmp_path / "foreign.uff"
    others = dict.fromkeys(("z_axis_spec_data_type", "orddenom_spec_data_type", "ref_node", "ref_dir"), 0)
    pyuff.UFF(str(path)).write_sets(
        pyuff.prepare_58(
            binary=0, id1="Sensor", func_type=1, rsp_node=3, rsp_dir=-1, **others, ord_data_type=4, num_pts=400,
            abscissa_spacing=1, abscissa_min=0.0, abscissa_inc=1.0 / 2048.0, abscissa_spec_data_type=17,
            abscissa_axis_units_lab="s", ordinate_spec_data_type=8, ordinate_axis_units_lab="mm", x=time, data=values,
        ),
        mode="overwrite",
    )  # fmt: skip
    (channel,) = read_record(path).channels
    assert (channel.place, channel.direction, channel.rate, channel.si_unit) == ("3", "-X", 2048.0, "m")
    validated(
        "File readers", "universal file of a foreign library, mm", channel.si_values, 1e-3 * values, rel=1e-11,
        abs=1e-16, unit="m", source=foreign("pyuff"),
    )  # fmt: skip
