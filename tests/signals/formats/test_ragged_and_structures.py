"""Remarks of single rows, names beyond their columns, structures of MATLAB, durations, formulas, directions."""

import json
import re

import numpy as np
import pytest
from scipy.io import savemat

from tests.signals.formats.test_uff import function
from tests.validation import foreign, validated
from vehicle.commands.comfort import main as comfort
from vehicle.errors import DataError
from vehicle.signals.formats.reader import read_record
from vehicle.signals.records.choice import Choice, choose
from vehicle.signals.records.measured import read_measured

RATE = 100.0
TIME = np.arange(1500) / RATE
SEAT = 0.4 * np.sin(2 * np.pi * 3.0 * TIME)
PLATE = 2.0 * np.sin(2 * np.pi * 2.0 * TIME)


def rows(remarks, delimiter=", "):
    """Rows of number, clock, two values, and the remarks of some rows."""
    return [
        delimiter.join([str(n + 1), f"04/29/2026 11:59:{n / RATE:06.3f}", f"{SEAT[n]:.5f}", f"{PLATE[n]:.5f}",
                        *([remarks[n]] if n in remarks else [])])
        for n in range(TIME.size)
    ]  # fmt: skip


@pytest.mark.parametrize(
    "head", ["Sample, Date/Time, Seat Z (m/s2), Plate (mm), Events", "Sample, Date/Time, Seat Z (m/s2), Plate (mm)"]
)
@pytest.mark.parametrize(
    "remarks", [{0: "DAQ Start"}, {0: "Start", 893: "bump"}, {2: "a", 3: "b, loud", 700: "c", 1499: "end"}]
)
def test_a_last_column_of_remarks_may_be_ragged(tmp_path, head, remarks):
    path = tmp_path / "events.txt"
    path.write_text("\n".join(["Header Size:  7", "Sampling Rate:  100", head, *rows(remarks)]) + "\n")
    found = read_record(path)
    assert [(one.name, one.unit) for one in found.channels] == [("Sample", ""), ("Seat Z", "m/s2"), ("Plate", "mm")]
    assert all(one.rate == RATE for one in found.channels)
    validated(
        "File readers", f"text file with {len(remarks)} remarks in {'a column' if 'Events' in head else 'no column'}",
        np.array([one.values for one in found.channels[1:]]), np.array([SEAT, PLATE]), abs=6e-6,
        source="closed form: the values that were written, five decimals",
    )  # fmt: skip
    assert any("Events" in text if "Events" in head else "remarks behind" in text for text in found.notices)


def test_a_number_beyond_the_columns_is_no_remark(tmp_path):
    path = tmp_path / "wide.txt"
    path.write_text(
        "\n".join(["t [s],a [g]", *(f"{t:.2f},{a:.4f}" for t, a in zip(TIME, SEAT, strict=True)), "15.00,1,5"])
    )
    with pytest.raises(DataError, match="1502:3: the row has 3 cells, but the header"):
        read_record(path)


def unv(name, *, node=12, direction=3, title="NONE", label="m/s2"):
    """A universal file whose names need not fit their columns."""
    text = function(SEAT, step=1.0 / RATE, direction=direction, label=label).decode()
    text = text.replace(f" {'NONE':<10}{12:10d}{direction:4d} ", f" {name:<10}{node:10d}{direction:4d} ", 1)
    unit_line = f"{12:10d}{0:5d}{0:5d}{0:5d} {'NONE':<20} {label}"
    assert unit_line in text
    return text.replace(unit_line, f"{12:10d}{0:5d}{0:5d}{0:5d} {title:<20} {label}", 1).encode()


@pytest.mark.parametrize(
    ("name", "place"),
    [("Seat", "Seat"), ("TenLetters", "TenLetters"), ("PF-I-0301z+seat", "PF-I-0301z+seat"),
     ("SeatRailZ_12", "SeatRailZ_12"), ("front seat left", "front seat left"), ("NONE", "12")],
)  # fmt: skip
def test_names_beyond_their_columns_of_a_universal_file(tmp_path, name, place):
    path = tmp_path / "long.unv"
    path.write_bytes(unv(name))
    (channel,) = read_record(path).channels
    assert (channel.place, channel.direction) == (place, "+Z")


def test_a_title_beyond_its_column_leaves_the_unit(tmp_path):
    path = tmp_path / "title.unv"
    path.write_bytes(unv("Seat", title="AccelerationOfTheSeatRail"))
    (channel,) = read_record(path).channels
    assert (channel.unit, channel.quantity) == ("m/s2", "acceleration")
    path.write_bytes(unv("Seat rail of row 2 without").replace(b"        12   3 NONE", b"        12   x NONE"))
    with pytest.raises(DataError, match=r"dataset 58 at byte 0 \(function 1\) has an invalid header \(the line"):
        read_record(path)


def test_a_history_against_an_axis_is_turned_as_a_response(tmp_path):
    """One fact, one answer: direction -Z turns a history as it turns a frequency response."""
    response = np.array([1.0, 2.0] * 8)
    found = {}
    for sign in (1, -1):
        path = tmp_path / f"history{sign}.unv"
        path.write_bytes(function(SEAT, step=1.0 / RATE, direction=3 * sign, id1="z"))
        chosen = choose(read_record(path), Choice(channels={"z": "z"}))
        assert ("z: sign inverted, because it was measured along -Z" in chosen.notices) == (sign < 0)
        frf = tmp_path / f"response{sign}.unv"
        frf.write_bytes(
            function(response, kind=5, step=1.0, direction=3 * sign, function=4, axis=18, axis_label="Hz", id1="z")
        )
        measured = read_measured(frf, ["knuckle_fr_acc_z"], Choice(
            channels={"knuckle_fr_acc_z": "1"}, units={"knuckle_fr_acc_z": "(m/s2)/m"}))  # fmt: skip
        assert measured.frf is not None
        found[sign] = chosen.values["z"], measured.frf.response
    validated(
        "File readers", "time history measured along -Z, over +Z", found[-1][0], -found[1][0], abs=0.0,
        source="closed form: a motion along -Z is minus that along +Z",
    )  # fmt: skip
    np.testing.assert_array_equal(found[-1][1], -found[1][1])


def signals(*pairs):
    array = np.zeros((1, len(pairs)), dtype=[("values", "O"), ("label", "O")])
    for n, pair in enumerate(pairs):
        array[0, n] = pair
    return array


@pytest.mark.parametrize(
    ("values", "label", "names"),
    [
        (np.column_stack([SEAT, PLATE]), "Seat z, plate", ["Seat z", "plate"]),
        (np.column_stack([SEAT, PLATE]), "both", ["both(1)", "both(2)"]),
        (np.stack([SEAT, PLATE])[:, None, :], "Seat z,plate", ["Seat z", "plate"]),
        (np.stack([SEAT, PLATE]), "", ["S.signals.values(:,1)", "S.signals.values(:,2)"]),
    ],
)
def test_structures_of_simulink(tmp_path, values, label, names):
    path = tmp_path / "scope.mat"
    savemat(path, {"S": {"time": TIME[:, None], "signals": {"values": values, "dimensions": 2.0, "label": label}}})
    found = read_record(path).channels
    assert [one.name for one in found] == names and all(one.rate == RATE for one in found)
    validated(
        "File readers", f"structure of Simulink, {' x '.join(map(str, values.shape))}, label {label!r}",
        np.array([one.values for one in found]), np.array([SEAT, PLATE]), abs=0.0, source=foreign("scipy", "savemat"),
    )  # fmt: skip


def test_several_signals_of_simulink_and_of_dspace(tmp_path):
    path = tmp_path / "scope.mat"
    savemat(path, {"S": {"time": TIME[:, None], "signals": signals((SEAT[:, None], "seat"), (PLATE[:, None], ""))}})
    assert [one.name for one in read_record(path).channels] == ["seat", "S.signals(2)"]
    fields = [("Name", "O"), ("Data", "O"), ("Unit", "O"), ("XIndex", "O")]
    axes, outputs = np.zeros((1, 2), dtype=fields[:3]), np.zeros((1, 2), dtype=fields)
    axes[0, 0], axes[0, 1] = ("slow", 1e3 * TIME[::10], "ms"), ("fast", TIME, "s")
    outputs[0, 0], outputs[0, 1] = ('"seat_z"', SEAT, "m/s^2", 2.0), ("plate", PLATE[::10], "mm", 1.0)
    savemat(path, {"rec_001": {"X": axes, "Y": outputs, "Capture": {"Length": 15.0}}})
    found = read_record(path).channels
    assert [(one.name, one.unit, one.rate) for one in found] == [("seat_z", "m/s^2", 100.0), ("plate", "mm", 10.0)]
    np.testing.assert_array_equal(found[0].values, SEAT)


def test_matrices_in_a_structure_are_not_lost(tmp_path):
    path = tmp_path / "any.mat"
    savemat(path, {"run": {"acc": np.column_stack([SEAT, PLATE]), "cube": np.zeros((3, 4, 5))}})
    found = read_record(path)
    assert [one.name for one in found.channels] == ["run.acc(:,1)", "run.acc(:,2)"]
    assert any("run.cube (3 x 4 x 5)" in text for text in found.notices)


@pytest.mark.parametrize(("label", "factor"), [("g", 1.0 / 9.80665), ("mm", 1000.0), ("m/s2", 1.0)])
def test_a_testlab_structure_holds_si_values(tmp_path, label, factor):
    path = tmp_path / "testlab.mat"
    quantity = {"label": label, "unit_transformation": {"factor": factor, "offset": 0.0}}
    savemat(path, {"Signal": {
        "x_values": {"start_value": 0.0, "increment": 0.01, "number_of_values": 1500.0, "quantity": {"label": "s"}},
        "y_values": {"values": SEAT[:, None], "quantity": quantity}, "function_record": {"name": "z"},
    }})  # fmt: skip
    (channel,) = read_record(path).channels
    validated(
        "File readers", f"Testlab structure displayed in {label}", channel.si_values, SEAT, abs=0.0,
        source="closed form: the SI values that were stored",
    )  # fmt: skip
    assert (f"displays {label!r}" in channel.remark) == (factor != 1.0)


@pytest.mark.parametrize("unit", ["s", "ms", "us", "ns"])
@pytest.mark.parametrize("kind", ["duration", "time64"])
def test_durations_of_parquet(tmp_path, unit, kind):
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    steps = {"s": 1, "ms": 10, "us": 10_000, "ns": 10_000_000}[unit]
    if kind == "time64" and unit in ("s", "ms"):
        kind = "time32"
    count = np.arange(TIME.size if unit != "s" or kind == "duration" else 1000)
    column = arrow.array(count.astype(np.int32 if kind == "time32" else np.int64) * steps, getattr(arrow, kind)(unit))
    path = tmp_path / "pandas.parquet"
    parquet.write_table(arrow.table({"z [m/s2]": SEAT[: count.size], "__index_level_0__": column}), path)
    (channel,) = read_record(path).channels
    assert channel.rate == (1.0 if unit == "s" else RATE)


def test_a_damaged_page_of_parquet_is_refused(tmp_path):
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    path = tmp_path / "sums.parquet"
    parquet.write_table(
        arrow.table({"z [g]": SEAT}), path, write_page_checksum=True, use_dictionary=False, compression="none"
    )
    data = bytearray(path.read_bytes())
    at = data.index(SEAT[700:702].tobytes())
    data[at] ^= 0xFF
    path.write_bytes(data)
    with pytest.raises(DataError, match=r"cannot be read as Parquet .*(CRC|checksum)"):
        read_record(path)


def sheet(path, formula):
    book = pytest.importorskip("openpyxl").Workbook()
    page = book.active
    page.append(["t [s]", "raw", "Seat z [m/s2]"])
    for n in range(TIME.size):
        page.append([TIME[n], SEAT[n], formula(n)])
    book.save(path)


def test_formulas_without_values(tmp_path, capsys):
    path = tmp_path / "formulas.xlsx"
    sheet(path, lambda n: f"=B{n + 2}*9.81")
    seat = read_record(path)["Seat z"]
    assert not np.isfinite(seat.values).any() and seat.remark.startswith("formulas without saved values")
    with pytest.raises(DataError, match=r"channel 'Seat z' has no values \(formulas without saved values"):
        choose(read_record(path), Choice(channels={"z": "Seat z"}))
    sheet(path, lambda n: 9.81 * SEAT[n])
    assert comfort(["--input", str(path), "--channel", "z=Seat z", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["z"]["weighted_rms"] > 0.0
    sheet(path, lambda n: None)
    assert read_record(path)["Seat z"].remark == ""


@pytest.mark.parametrize("name", ["height", "altitude", "Höhe"])
def test_the_height_of_a_receiver_is_no_road(tmp_path, name):
    path = tmp_path / "ride.csv"
    table = np.column_stack([TIME, 52.0 + 0 * TIME, 10.0 + 0 * TIME, np.full(TIME.size, 80.0), 120.0 + 0.1 * SEAT])
    heads = f"time [s],latitude [deg],longitude [deg],velocity [km/h],{name} [m]"
    np.savetxt(path, table, "%.5f", ",", header=heads, comments="", encoding="utf-8")
    from tests.advice import advised
    from vehicle.signals.excitation.recorded_road import RecordedDrive

    commands, text = advised(path)
    assert not commands and re.search(
        f"no command: a displacement, but the name {name!r} does not say that it is the motion of a plate", text
    )
    if name == "height":
        with pytest.raises(DataError, match="GPS receiver"):
            RecordedDrive(road=path, channel="velocity", wheels=(("fr", 0.0, "right"),)).signal()


def test_the_column_that_rises_is_the_time(tmp_path):
    path = tmp_path / "fragments.csv"
    elapsed = np.concatenate([TIME, TIME])
    stamp = 1770664802.0 + np.concatenate([TIME, 60.0 + TIME])
    table = np.column_stack([stamp, elapsed, np.concatenate([SEAT, SEAT])])
    np.savetxt(path, table, "%.3f,%.3f,%.5f", header="timestamp [unix time],elapsed_time [s],acc [m/s2]", comments="")
    channel = read_record(path)["acc"]
    assert channel.axis is not None
    assert channel.axis[-1] == pytest.approx(74.99) and (np.diff(channel.axis) > 0.0).all()
