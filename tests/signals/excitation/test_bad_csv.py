"""Items 1 to 12, 14, 17 and 19 of the list of bad inputs: one refusal each, with its whole message or decisive part."""

from pathlib import Path

import numpy as np
import pytest

from tests.signals.excitation.csv_samples import HEADER, read_plain, rows, with_row, write
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.excitation.plausibility import band_limited_acceleration
from vehicle.signals.formats import text as csv_text

NEEDED = "'time [s]' and 'displacement [m]' (or 'displacement_fr [m]', 'displacement_fl [m]'); [mm] is accepted"


def refused(path: Path, **options: object) -> str:
    """Message of the refusal without the path in front."""
    with pytest.raises(DataError) as caught:
        read_plain(path, **options)  # type: ignore[arg-type]
    assert caught.value.exit_code == 3
    message = str(caught.value)
    assert message.startswith(str(path))
    return message.removeprefix(str(path))


def refused_lines(folder: Path, lines: list[str]) -> str:
    return refused(write(folder, lines))


def height(row: str) -> str:
    return row.split(",")[1]


EMPTY = ": the file is empty; must have a header line with units and one row per sample"
NO_NUMBER = "must be a number with a decimal point, such as -1.25e-4"
INCREASE = "time must increase from row to row; were two logs concatenated?"
LONG = "the line is longer than 1000000 characters; must be one row per sample; check the line ends"
OR_CHANNEL = (
    "; or name the channel, for example --channel fl=displacement: the shaker then reads every unit that "
    "`python -m vehicle inspect` knows"
)
SEMICOLONS = [row.replace(",", ";") for row in rows()]

REFUSED: dict[str, tuple[bytes | list[str], str]] = {
    "1 empty": (b"", EMPTY),
    "1 blank": (b" \n\n", EMPTY),
    "1 header only": (["# c", HEADER], ":2: the file ends after the header; must have one row per sample below it"),
    "1 comments only": (["# c", "# d"],
        f": contains only comments; must have the columns {NEEDED} in a header line and one row per sample"),
    "1 a few rows": ([HEADER, *rows(31)], ": 31 rows, must be at least 32 rows; use a longer record"),
    **{f"2 missing or infinite, {cell}": (with_row(17, f"0.017000,{cell}"),
        f":19:2: column 'displacement [m]' is {cell!r}, must be a finite number; repair the cell, or set --interpolate")
       for cell in ("nan", "NaN", "inf", "-Inf", "", "#N/A", "1e400")},
    **{f"2 no decimal number, {cell}": (with_row(17, f"0.017000,{cell}"),
        f":19:2: column 'displacement [m]' is {cell!r}...") for cell in ("1_0", "0x10", "1.0D-3", "١")},
    **{f"2 lines end with {end!r}": (end.join(with_row(17, "0.017000,nan")).encode(),
        ":19:2: column 'displacement [m]' is 'nan'...") for end in ("\r\n", "\r")},
    "3 uneven steps": (with_row(100, "0.100002,0.001"),
        ":102: time steps are not uniform: a step of 0.001002 s deviates from the median 0.001 s by the factor 0.002, "
        "must be at most 0.001; write the time with more digits, or set --resample 1000"),
    "4 repeated": (with_row(100, "0.099000,0.001"),
        f":102: time 0.099 s repeats the time 0.099 s of line 101; {INCREASE}"),
    "4 decreasing": ([HEADER, *rows(), "# second log", *rows()],
        f":403: time 0 s is before the time 0.399 s of line 401; {INCREASE}"),
    "5 no header": (rows(),
        f":1:1: the header line is missing: found '0.000000', '0.000000000e+00'; must name the columns {NEEDED}"),
    "5 a column more": (["time [s],displacement [m],force [N]", "0,0,0"],
        f":1: unknown column 'force [N]'; must be {NEEDED}; remove other columns, or assign a column to a wheel: "
        "--channel fr=NAME (python -m vehicle inspect FILE prints the command); found 'time [s]', 'displacement [m]', "
        "'force [N]'"),
    "5 other names": (["zeit [s],weg [m]", "0,0"], ":1: unknown column 'zeit [s]', 'weg [m]'; must be..."),
    "5 no time": (["displacement [m]", "0"], f":1: no time column; found 'displacement [m]'; needed are {NEEDED}"),
    "5 no displacement": (["# x", "time [s]", "0"], ":2: no displacement column; found 'time [s]'..."),
    "6 a column twice": (["time [s],displacement [m],displacement [m]", "0,0,0"],
        ":1:3: column 'displacement [m]' repeats the quantity of column 2 ('displacement [m]'); remove one of them; "
        "found 'time [s]', 'displacement [m]', 'displacement [m]'"),
    "6 a quantity twice": (["time [s],displacement [m],displacement_fr [m]", "0,0,0"],
        ":1:3: column 'displacement_fr [m]' repeats the quantity of column 2..."),
    "6 a decimal comma is never guessed": ([HEADER, *(row.replace(".", ",") for row in rows())],
        ":2:3: the row has 4 cells, but the header 2; with decimal commas, separate the columns by ';', in the header "
        "too, because 1,5 may be one number or two"),
    "6 thousands": ([HEADER.replace(",", ";"), *SEMICOLONS[:50], "0.050000;1,5", *SEMICOLONS[51:]],
        ":52:2: column 'displacement [m]' is '1,5'; line 2 has a decimal point; the comma may be a decimal comma or "
        "separate thousands; write all numbers with a decimal point and without separators"),
    "6 another delimiter": ([HEADER, *SEMICOLONS],
        ":2:1: the row has 1 cells, but the header 2; separate the cells by ',' as in the header"),
    "7 no unit": (["time [s],displacement", *rows()],
        ":1:2: column 'displacement' has no unit; write [m] or [mm] after the name"),
    "7 no unit of time": (["time,displacement [m]", *rows()],
        ":1:1: column 'time' has no unit; write [s] after the name"),
    "7 no such unit": (["time [s],displacement [furlong]", *rows()],
        ":1:2: column 'displacement [furlong]' has the unit [furlong], must be [m] or [mm]"),
    "7 centimetres": (["time [s],displacement [cm]", *rows()],
        f":1:2: column 'displacement [cm]' has the unit [cm], must be [m] or [mm]{OR_CHANNEL}"),
    "7 milliseconds": (["time [ms],displacement [m]", *rows()],
        f":1:1: column 'time [ms]' has the unit [ms], must be [s]{OR_CHANNEL}"),
    "7 millimetres under metres": ([HEADER, *rows(amplitude=0.5)],
        ": plate fr is displaced by 0.5 m at sample 50 (t = 0.05 s); must be at most 0.15 m; are the values in "
        "mm? The header of the column says [m]; write its unit into the header ([m] or [mm]), or remove a "
        "constant offset (--remove-mean)"),
    "9 a level is no velocity": (["time [s],level [m]", *rows()], ":1: unknown column 'level [m]'..."),
    "11 too slow": ([HEADER, *(f"{i / 9},{height(row)}" for i, row in enumerate(rows()))],
        ": sampling rate 9 Hz, must be at least 10 Hz (usable up to 4 Hz); measure or export with a higher rate"),
    "11 milliseconds under seconds": ([HEADER, *(f"{i},{height(row)}" for i, row in enumerate(rows()))],
        ": sampling rate 1 Hz, must be at least 10 Hz (usable up to 4 Hz); are the times in ms?;..."),
    "14 cut off in its last row": ([HEADER, *rows(), "0.4"],
        ":402:1: the last row has 1 cells, but the header 2; the file is truncated; remove the row"),
    "19 Latin-1": (b"time [s],displacement [m]\n0.0,\xe9\n", f":2:2: column 'displacement [m]' is 'é', {NO_NUMBER}"),
    "19 NUL": (b"time [s],displacement [m]\n0.0,0\0\n",
        ":2:6: contains a NUL character, so this is a binary or damaged file; must be UTF-8 text"),
    "19 NUL behind the first megabyte": (f"{HEADER}\n".encode() + b"0.0,0.0\n" * 200_000 + b"\0",
        ":200002:1: contains a NUL character..."),
    "19 UTF-16": ("time [s]".encode("utf-16"), ":1:1: the file is UTF-16, must be UTF-8; save it as UTF-8 text"),
    "19 a long header": (b"time [s]," + b"x" * 1_100_000, f":1: {LONG}"),
    "19 a long row": (b"time [s],displacement [m]\n" + b"1" * 1_100_000 + b"\n", f":2: {LONG}"),
}  # fmt: skip
"""Content of a file and its whole refusal, or the beginning of it before "..."."""


@pytest.mark.parametrize("case", REFUSED)
def test_a_bad_file_is_refused_with_the_place(tmp_path, case):
    content, message = REFUSED[case]
    path = tmp_path / "signal.csv"
    path.write_bytes(content if isinstance(content, bytes) else "\n".join([*content, ""]).encode())
    found = refused(path)
    assert found == message or (message.endswith("...") and found.startswith(message[:-3])), found


def test_2_text_is_not_a_missing_value(tmp_path):
    path = write(tmp_path, with_row(17, "0.017000,1.5x"))
    for interpolate in (False, True):
        assert refused(path, interpolate=interpolate) == (
            ":19:2: column 'displacement [m]' is '1.5x', must be a number with a decimal point, such as -1.25e-4"
        )


@pytest.mark.parametrize("cell", ["nan", "", "#N/A"])
def test_2_missing_time_is_never_interpolated(tmp_path, cell):
    path = write(tmp_path, with_row(17, f"{cell},1e-3"))
    assert refused(path, interpolate=True) == (
        f":19:1: column 'time [s]' is {cell!r}; a time stamp is never interpolated; repair or remove the row"
    )


def test_3_jitter_within_the_tolerance_is_accepted(tmp_path):
    lines = with_row(100, f"0.1000005,{rows()[100].split(',')[1]}")
    assert read_plain(write(tmp_path, lines)).notices == ()


def test_7_acceleration_beyond_a_shaker(tmp_path):
    message = refused_lines(tmp_path, [HEADER, *rows(2000, amplitude=0.05, frequency=10.0)])
    # A/2 (2 pi f)^2 = 98.7 m/s2; at the ends the filter makes a few percent more of it.
    assert message.startswith(": plate fr accelerates by ")
    assert abs(float(message.split()[5])) == pytest.approx(98.7, rel=0.1)
    assert "(below 100 Hz), must be at most 50 m/s2; are the values in mm" in message


def test_91_one_pothole_is_named_and_no_reason_to_refuse(tmp_path):
    time = np.arange(20_000) / 1000.0
    pothole = -0.06 * np.exp(-(((time - 12.0) / 0.012) ** 2))
    z = 1e-3 * np.sin(2 * np.pi * 3.0 * time) * np.clip(time, 0.0, 1.0) + pothole

    def lines(values):
        return [HEADER, *(f"{t:.3f},{value:.8f}" for t, value in zip(time, values, strict=True))]

    said = [text for text in read_plain(write(tmp_path, lines(z))).notices if "a pothole" in text]
    # -2 A / s^2 at its deepest point, below 100 Hz
    assert len(said) == 1 and "at t = 12" in said[0] and "usual 50 m/s2: a pothole" in said[0]
    # in mm under [m] the whole record is beyond, and a spike of a logger is no pothole
    assert "values in mm" in refused_lines(tmp_path, lines(1e3 * z))
    assert "displaced by 3" in refused_lines(tmp_path, lines(np.where(np.arange(time.size) == 9000, 3.0, z)))


def test_7_too_small_to_be_true(tmp_path):
    message = refused_lines(tmp_path, [HEADER, *rows(amplitude=1e-7)])
    assert message.startswith(": RMS of plate fr is 3.5")
    assert "must be at least 1e-07 m; does the column contain metres?" in message
    still = refused_lines(tmp_path, [HEADER, *(f"{i / 1000},0" for i in range(400))])
    assert still.startswith(": no plate moves: all columns are constant")


def test_64_a_column_in_millimetres_is_judged_in_millimetres(tmp_path):
    header = "time [s],displacement [mm]"
    message = refused_lines(tmp_path, [header, *rows(amplitude=500.0)])
    assert message.startswith(": plate fr is displaced by 500 mm at sample 50 (t = 0.05 s); must be at most 150 mm; ")
    assert "values in mm" not in message and "header of the column says [mm]" in message
    message = refused_lines(tmp_path, [header, *rows(amplitude=1e-4)])
    assert "must be at least 0.0001 mm; does the column contain metres, although its header says [mm]?" in message


def test_7_quantisation_of_a_measured_signal_is_no_acceleration(tmp_path):
    rng = np.random.default_rng(1)
    t = np.arange(10000) / 1000.0
    z = np.round((5e-4 * np.sin(2 * np.pi * 5.0 * t) + 3e-6 * rng.standard_normal(t.size)) / 1e-5) * 1e-5
    bare = np.diff(z, 2) * 1e6
    assert np.max(np.abs(bare)) > 20.0
    # 10 um steps spread over 500 Hz: sqrt(q^2/12 / 500 (2 pi)^4 100^5 / 5) = 0.23 m/s2 RMS, 5 sigma; input 0.49 m/s2.
    assert np.max(np.abs(band_limited_acceleration(z, 1e-3))) < 3.0
    # And what is there is found: 0.49 m/s2 from the sine, within the noise.
    smooth = band_limited_acceleration(5e-4 * np.sin(2 * np.pi * 5.0 * t), 1e-3)
    assert np.max(np.abs(smooth[500:-500])) == pytest.approx(5e-4 * (10 * np.pi) ** 2, rel=1e-3)


@pytest.mark.parametrize(
    "header", ["acceleration [m/s2]", "acc_z [g]", "displacement [m/s^2]", "velocity [m/s]", "displacement [g]"]
)
def test_9_acceleration_is_refused(tmp_path, header):
    message = refused_lines(tmp_path, [f"time [s],{header}", *rows()])
    assert message.startswith(
        f":1:2: column {header!r} is an acceleration or a velocity, but the plate needs a displacement. "
    )
    assert message.endswith(f" --highpass 0.5; or use {NEEDED}") and "--channel fr='" in message


@pytest.mark.parametrize("ending", ["", ",1e-3"])
def test_14_columns_of_different_length(tmp_path, ending):
    lines = ["time [s],displacement_fr [m],displacement_fl [m]", *(f"{row},1e-3" for row in rows())]
    for index in range(301, 401):
        lines[index] = f"{(index - 1) / 1000},1e-3," if ending else f"{(index - 1) / 1000},1e-3"
    path = write(tmp_path, lines)
    for interpolate in (False, True):
        assert refused(path, interpolate=interpolate) == (
            ":302:3: column 'displacement_fl [m]' ends before the other columns; all columns must have "
            "the same length; export them over the same time"
        )


def test_17_too_large_is_refused_before_it_is_read(tmp_path):
    path = tmp_path / "huge.csv"
    block = ("\n".join([HEADER, *rows(50000)]) + "\n").encode()  # more than the first megabyte
    with path.open("wb") as file:
        file.write(block)
        file.truncate(10 * 10**9)  # sparse: no disk is used
    message = refused(path)
    assert message.startswith(": about ")
    assert "rows in 10 GB need" in message
    assert "GiB of memory, must be at most 2 GiB; cut the record into parts or lower its sampling rate" in message
    rows_estimated = float(message.split()[2])
    assert rows_estimated == pytest.approx(10e9 / (len(block) / 50001), rel=0.01)  # rows are equally long


def test_missing_file_is_a_wrong_path(tmp_path):
    with pytest.raises(ConfigurationError, match=r"none\.csv: the file does not exist; give the path of a CSV file"):
        read_plain(tmp_path / "none.csv")


def test_unreadable_file(tmp_path, monkeypatch):
    path = write(tmp_path, [HEADER, *rows()])

    def refuse(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(csv_text, "_check_memory", refuse)  # stands for a read error: root may read everything
    assert refused(path) == ": cannot be read (Permission denied); check the file and its permissions"
