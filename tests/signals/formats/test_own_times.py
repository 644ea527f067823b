"""Tables whose channels have their own times, and cells that nobody asked for."""

from pathlib import Path

import numpy as np
import pytest

from tests.signals.formats.channel_times import times
from vehicle.errors import DataError
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.signals.formats.reader import read
from vehicle.signals.records.acceleration import read_acceleration
from vehicle.signals.records.choice import Choice, choose

FAST, SLOW = np.arange(3000) / 200.0, np.arange(1500) / 100.0
SEAT, RAIL = np.sin(2 * np.pi * 3.0 * FAST), np.cos(2 * np.pi * 5.0 * SLOW)


def table(path: Path, heads: str, *columns: np.ndarray, delimiter: str = ",") -> Path:
    """Write columns of different lengths; cells below the end of a column, and NaN, are blank."""
    rows = [heads]
    for row in range(max(map(len, columns))):
        cells = (column[row] if row < len(column) else np.nan for column in columns)
        rows.append(delimiter.join("" if cell != cell else f"{cell:.6f}" for cell in cells))
    path.write_text("\n".join(rows) + "\n")
    return path


@pytest.mark.parametrize(
    "heads",
    [
        "Time [s],Seat Z [m/s2],Time [s],Rail Z [m/s2]",
        "Time [s],Seat Z [m/s2],Time [s].1,Rail Z [m/s2]",
        "t1 [s],Seat Z [m/s2],t2 [s],Rail Z [m/s2]",
        "Time Seat Z [s],Seat Z [m/s2],Time Rail Z [s],Rail Z [m/s2]",
        "Zeit [s],Seat Z [m/s2],Zeit,Rail Z [m/s2]",
        "Time_s,Seat Z [m/s2],Time_s,Rail Z [m/s2]",
    ],
)
@pytest.mark.parametrize(("fast", "slow", "delimiter"), [(3000, 1500, ","), (1500, 1500, ";"), (900, 1500, ";")])
def test_each_pair_has_its_own_time(tmp_path, heads, fast, slow, delimiter):
    heads = heads.replace(",", delimiter)
    columns = [FAST[:fast], SEAT[:fast], 0.004 + SLOW[:slow], RAIL[:slow]]
    found = read(table(tmp_path / "pairs.csv", heads, *columns, delimiter=delimiter))
    seat, rail = found["Seat Z"], found["Rail Z"]
    assert [channel.name for channel in found.channels] == ["Seat Z", "Rail Z"]
    assert seat.rate == pytest.approx(200.0) and rail.rate == pytest.approx(100.0)
    assert np.allclose(times(seat), FAST[:fast]) and np.allclose(times(rail), 0.004 + SLOW[:slow])
    assert np.allclose(seat.values, SEAT[:fast], atol=1e-6) and np.allclose(rail.values, RAIL[:slow], atol=1e-6)


def test_times_that_follow_their_channels_and_units(tmp_path):
    heads = "Seat Z [m/s2],Time [s],Rail Z [m/s2],Time [ms]"
    found = read(table(tmp_path / "pairs.csv", heads, SEAT[:1500], FAST[:1500], RAIL, 1000.0 * SLOW))
    assert np.allclose(times(found["Rail Z"]), SLOW) and np.allclose(times(found["Seat Z"]), FAST[:1500])


def test_counts_since_1970_begin_at_the_first_of_all(tmp_path):
    zero = 1.7e12
    path = tmp_path / "pairs.csv"
    rows = [f"{zero + 5 * n:.0f},{SEAT[n]:.6f},{zero + 4 + 10 * n:.0f},{RAIL[n]:.6f}" for n in range(1500)]
    path.write_text("\n".join(["time [ms],Seat Z [m/s2],time [ms],Rail Z [m/s2]", *rows]))
    found = read(path)
    assert np.allclose(times(found["Rail Z"]), 0.004 + SLOW) and times(found["Seat Z"])[0] == 0.0


def test_the_clock_of_a_satellite_receiver_counts_the_same_rows(tmp_path):
    heads = "Time [s],Seat Z [m/s2],GPS time [s],Speed [km/h]"
    found = read(table(tmp_path / "gps.csv", heads, SLOW, RAIL, 1234.0 + SLOW, 80.0 + SLOW))
    assert found["Speed"].axis is found["Seat Z"].axis and np.allclose(times(found["Speed"]), SLOW)


def test_clocks_of_different_rows_are_no_clocks_of_the_same_rows(tmp_path):
    """200 Hz and 100 Hz, both 15 s long: equal spans, and the words DAQ and ECU."""
    heads = "Time DAQ [s],Seat Z [m/s2],Time ECU [s],Rail Z [m/s2]"
    found = read(table(tmp_path / "pairs.csv", heads, FAST, SEAT, SLOW, RAIL))
    assert np.allclose(times(found["Seat Z"]), FAST) and np.allclose(times(found["Rail Z"]), SLOW)


def test_a_satellite_time_of_every_tenth_row_counts_the_same_rows(tmp_path):
    heads = "Time [s],Seat Z [m/s2],GPS time [s],Speed [km/h]"
    seldom = np.where(np.arange(1500) % 10, np.nan, SLOW)
    found = read(table(tmp_path / "gps.csv", heads, SLOW, RAIL, 1234.0 + seldom, 80.0 + seldom))
    assert np.allclose(times(found["Speed"]), SLOW[::10]) and np.allclose(times(found["Seat Z"]), SLOW)


@pytest.mark.parametrize(
    ("head", "values"),
    [
        ("T Oil", 90.0 + 0.01 * SLOW),
        ("T1", 90.0 + 0.01 * SLOW),
        ("Time of lap [s]", np.mod(SLOW, 7.0)),
        ("Time step [s]", 0.01 + 0.0 * SLOW),
    ],
)
def test_a_column_that_is_no_clock_gives_no_times(tmp_path, head, values):
    heads = f"Time [s],Seat Z [m/s2],{head},Rail Z [m/s2]"
    found = read(table(tmp_path / "oil.csv", heads, SLOW, SEAT[:1500], values, RAIL))
    assert len(found.channels) == 3 and np.allclose(times(found["Rail Z"]), SLOW)


@pytest.mark.parametrize("kind", ["records", "frame"])
def test_pairs_of_times_in_hdf5(tmp_path, kind):
    """Each channel took the times of the first."""
    h5py = pytest.importorskip("h5py")
    late = np.where(np.arange(3000) < 1500, 0.004 + np.arange(3000) / 100.0, np.nan)
    rail = np.where(np.arange(3000) < 1500, np.resize(RAIL, 3000), np.nan)
    columns = {"Time [s]": FAST, "Seat Z [m/s2]": SEAT, "Time [s].1": late, "Rail Z [m/s2]": rail}
    with h5py.File(tmp_path / "a.h5", "w") as file:
        if kind == "records":
            rows = list(zip(*columns.values(), strict=True))
            file["log"] = np.array(rows, dtype=[(name, float) for name in columns])
        else:  # the layout of `DataFrame.to_hdf`, which needs PyTables
            frame = file.create_group("log")
            frame.attrs.update({"pandas_type": "frame", "nblocks": np.array([1])})
            frame["axis0"], frame["axis1"] = [name.encode() for name in columns], np.arange(3000)
            frame["block0_items"], frame["block0_values"] = frame["axis0"][()], np.column_stack([*columns.values()])
    found = read(tmp_path / "a.h5")
    assert np.allclose(times(found["Seat Z"]), FAST) and np.allclose(times(found["Rail Z"]), 0.004 + SLOW)
    assert np.allclose(found["Rail Z"].values, RAIL)


def test_a_duration_of_parquet_that_is_no_time_is_a_channel(tmp_path):
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    lap = arrow.array(np.repeat(np.arange(80, 95), 100).astype("int64"), arrow.duration("s"))
    created = arrow.array(np.full(1500, 1_700_000_000), arrow.timestamp("s"))
    columns = {"LapDuration": lap, "Created": created, "Time [s]": SLOW, "Rail Z [m/s2]": RAIL}
    parquet.write_table(arrow.table(columns), tmp_path / "laps.parquet")
    found = read(tmp_path / "laps.parquet")
    assert np.allclose(times(found["Rail Z"]), SLOW) and found["LapDuration"].unit == "s"


def test_a_value_without_its_time_is_refused(tmp_path):
    late = SLOW.copy()
    late[700] = np.nan
    heads = "Time [s],Seat Z [m/s2],Time [s],Rail Z [m/s2]"
    path = table(tmp_path / "pairs.csv", heads, FAST[:1500], SEAT[:1500], late, RAIL)
    with pytest.raises(DataError, match=r"column 'Rail Z' has a value in row 701 of the numbers, but its time"):
        read(path)


@pytest.mark.parametrize("shift", [0.004, 0.0])
def test_blank_cells_of_two_rasters(tmp_path, shift):
    """Rows of 200 Hz and rows of 100 Hz, 4 ms later or at the same times: each channel has its own samples."""
    stamps = np.unique(np.round(np.concatenate([FAST, SLOW + shift]), 6))
    at = np.searchsorted(stamps, np.round(FAST, 6)), np.searchsorted(stamps, np.round(SLOW + shift, 6))
    seat, rail = np.full((2, stamps.size), np.nan)
    seat[at[0]], rail[at[1]] = SEAT, RAIL
    heads = "Time [s],Seat Z [m/s2],Rail Z [m/s2]"
    found = read(table(tmp_path / "rasters.csv", heads, stamps, seat, rail))
    assert np.allclose(times(found["Seat Z"]), FAST) and np.allclose(times(found["Rail Z"]), SLOW + shift)
    assert np.allclose(found["Rail Z"].values, RAIL, atol=1e-6)


def test_a_lost_sample_is_no_raster(tmp_path):
    rail = RAIL.copy()
    rail[700] = np.nan
    path = table(tmp_path / "lost.csv", "Time [s],Rail Z [m/s2]", SLOW, rail)
    assert read(path)["Rail Z"].values.size == RAIL.size
    with pytest.raises(DataError, match="1 missing values, the first at 7 s"):
        choose(read(path), Choice(channels={"z": "Rail Z"}))


MARKS = {
    "one number first": ["0", *["run"] * 1499],
    "two numbers first": ["0", "0", *["run"] * 1498],
    "three numbers first": ["1", "2", "3", *["run"] * 1497],
    "numbers again": ["0", "run", *["0"] * 60, *["run"] * 1438],
    "texts first": ["start", "start", *["0"] * 1498],
    "a text in the midst": [*["0"] * 900, "bump", *["0"] * 599],
    "numbers that end": [*["0"] * 300, *["bump"] * 1200],
    "beyond the range": [*["0.1"] * 700, "∞", "OVL", *["0.1"] * 798],
}


@pytest.mark.parametrize("marks", MARKS)
@pytest.mark.parametrize("quote", ["", '"'])
def test_a_column_of_texts_and_numbers_leaves_the_others(tmp_path, marks, quote):
    rows = [f"{t:.2f},{z:.6f},{quote}{mark}{quote}" for t, z, mark in zip(SLOW, RAIL, MARKS[marks], strict=True)]
    path = tmp_path / "marks.csv"
    path.write_text("\n".join(["Time [s],Seat Z [m/s2],Marker [mm]", *rows]))
    found = read(path)
    assert found["Seat Z"].unit == "m/s2" and np.allclose(times(found["Seat Z"]), SLOW)
    assert np.allclose(found["Seat Z"].values, RAIL, atol=1e-6)
    if any(channel.name == "Marker" for channel in found.channels):
        assert "is not a number" in found["Marker"].remark
        with pytest.raises(DataError, match=r"missing values .*is not a number"):
            choose(found, Choice(channels={"z": "Marker"}))


def test_a_text_in_a_sheet(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.active.append(["Time [s]", "Seat Z [m/s2]", "Marker"])
    for t, z, mark in zip(SLOW.tolist(), RAIL.tolist(), MARKS["two numbers first"], strict=True):
        book.active.append([t, z, int(mark) if mark.isdigit() else mark])
    book.save(tmp_path / "marks.xlsx")
    assert np.allclose(read(tmp_path / "marks.xlsx")["Seat Z"].values, RAIL)


def test_comfort_of_the_usual_columns_ignores_a_text_in_another(tmp_path):
    rows = [f"{t:.2f},{z:.6f},{mark}" for t, z, mark in zip(SLOW, RAIL, MARKS["a text in the midst"], strict=True)]
    (tmp_path / "ride.csv").write_text("\n".join(["time [s],z [m/s2],Marker", *rows]))
    assert np.allclose(read_acceleration(tmp_path / "ride.csv").channels["z"], RAIL, atol=1e-6)


@pytest.mark.parametrize("title", ["Rig 7", "Rig 7, run 12", "Rig;7\n\nOperator;N. N."])
@pytest.mark.parametrize("name", ["displacement", "displacement_fl"])
def test_a_title_above_the_header_of_a_plate_is_skipped(tmp_path, title, name):
    path = table(tmp_path / "plate.csv", f"time [s],{name} [m]", FAST, 1e-3 * SEAT)
    plain = read_signal(path, wheel="fl")
    path.write_text(f"{title}\n{path.read_text()}")
    assert np.array_equal(read_signal(path, wheel="fl").displacement["fl"], plain.displacement["fl"])


def test_a_text_in_a_further_column_of_a_stiffness_table(tmp_path):
    from vehicle.studies.mounts.measured_stiffness import read_stiffness

    rows = [
        f"{f},{a},{2e5 + f},{5 + f / 10},{'ok' if f < 9 else 'repeated'}" for a in (0.1, 1.0) for f in (1, 2, 5, 10, 20)
    ]
    heads = "frequency [Hz],amplitude [mm],stiffness [N/m],loss angle [deg],remark"
    (tmp_path / "mount.csv").write_text("\n".join([heads, *rows]))
    assert read_stiffness(tmp_path / "mount.csv").frequency.size == 10
