"""Items 1 to 12, 14, 17 and 19 of the list of bad inputs: one refusal each, with the place and the value."""

import re

import numpy as np
import pytest

from tests.signals.excitation.csv_samples import HEADER, read_plain, rows, with_row, write
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.excitation.plausibility import band_limited_acceleration
from vehicle.signals.formats import text as csv_text

SEMICOLONS = [row.replace(",", ";") for row in rows()]
HEIGHTS = [row.split(",")[1] for row in rows()]
TWO = ["time [s],displacement_fr [m],displacement_fl [m]", *(f"{row},1e-3" for row in rows())]

REFUSED: dict[str, tuple[bytes | list[str], str]] = {
    "1 empty": (b"", "^: .*empty"),
    "1 blank": (b" \n\n", "^: .*empty"),
    "1 header only": (["# c", HEADER], "^:2: .*header"),
    "1 comments only": (["# c", "# d"], "^: .*only comments.*'time .s.'.*'displacement .m.'"),
    "1 a few rows": ([HEADER, *rows(31)], "^: has 31 rows.* 32"),
    **{f"2 missing or infinite, {cell}": (with_row(17, f"0.017000,{cell}"),
        f"^:19:2: .*'displacement .m.' is {cell!r}.*--interpolate$")
       for cell in ("nan", "NaN", "inf", "-Inf", "", "#N/A", "1e400")},
    **{f"2 no decimal number, {cell}": (with_row(17, f"0.017000,{cell}"), f"^:19:2: .* is {cell!r}")
       for cell in ("1_0", "0x10", "1.0D-3", "١")},
    **{f"2 lines end with {end!r}": (end.join(with_row(17, "0.017000,nan")).encode(), "^:19:2: .* is 'nan'")
       for end in ("\r\n", "\r")},
    "3 uneven steps": (with_row(100, "0.100002,0.001"),
        r"^:102: .*0\.001002 s .* 0\.001 s .* 0\.002, .* 0\.001; .*--resample 1000$"),
    "4 repeated": (with_row(100, "0.099000,0.001"), r"^:102: .*0\.099 s .* 0\.099 s of line 101"),
    "4 decreasing": ([HEADER, *rows(), "# second log", *rows()], r"^:403: time 0 s .* 0\.399 s of line 401"),
    "5 no header": (rows(), r"^:1:1: .*header.*'0\.000000', '0\.000000000e\+00'"),
    "5 a column more": (["time [s],displacement [m],force [N]", "0,0,0"],
        "^:1: .*'force .N.'.*--channel fr=NAME.*'time .s.', 'displacement .m.', 'force .N.'$"),
    "5 other names": (["zeit [s],weg [m]", "0,0"], "^:1: .*'zeit .s.', 'weg .m.'"),
    "5 no time": (["displacement [m]", "0"], "^:1: no time column; found 'displacement .m.'"),
    "5 no displacement": (["# x", "time [s]", "0"], "^:2: no displacement column; found 'time .s.'"),
    "6 a column twice": (["time [s],displacement [m],displacement [m]", "0,0,0"], "^:1:3: .* column 2 "),
    "6 a quantity twice": (["time [s],displacement [m],displacement_fr [m]", "0,0,0"],
        "^:1:3: .*'displacement_fr .m.' .* column 2 "),
    "6 a decimal comma is never guessed": ([HEADER, *(row.replace(".", ",") for row in rows())],
        "^:2:3: .* 4 cells, .* 2; .*';'.* 1,5 "),
    "6 thousands": ([HEADER.replace(",", ";"), *SEMICOLONS[:50], "0.050000;1,5", *SEMICOLONS[51:]],
        "^:52:2: .*'1,5'; line 2 "),
    "6 another delimiter": ([HEADER, *SEMICOLONS], "^:2:1: .* 1 cells, .* 2; .*','"),
    "7 no unit": (["time [s],displacement", *rows()], r"^:1:2: column 'displacement' .*\[m\] or \[mm\]"),
    "7 no unit of time": (["time,displacement [m]", *rows()], r"^:1:1: column 'time' .*\[s\]"),
    "7 no such unit": (["time [s],displacement [furlong]", *rows()],
        r"^:1:2: .* unit \[furlong\] but must have \[m\] or \[mm\]$"),
    "7 centimetres": (["time [s],displacement [cm]", *rows()], r"^:1:2: .* unit \[cm\] .*--channel fl=displacement"),
    "7 milliseconds": (["time [ms],displacement [m]", *rows()], r"^:1:1: .* unit \[ms\] .* \[s\].*--channel"),
    "7 millimetres under metres": ([HEADER, *rows(amplitude=0.5)],
        r"^: plate fr .* 0\.5 m at 0\.05 s, must be at most 0\.15 m; .* in mm, not \[m\].*--remove-mean"),
    "64 micrometres under millimetres": (["time [s],displacement [mm]", *rows(amplitude=500.0)],
        r"^: plate fr .* 500 mm at 0\.05 s, must be at most 150 mm; .* in um, not \[mm\]"),
    "64 metres under millimetres": (["time [s],displacement [mm]", *rows(amplitude=1e-4)],
        r"must be at least 0\.0001 mm; .* metres, not \[mm\]"),
    "7 too small to be true": ([HEADER, *rows(amplitude=1e-7)],
        r"^: RMS of plate fr is 3\.5\de-08 m but must be at least 1e-07 m; .* metres\?"),
    "7 no motion": ([HEADER, *(f"{i / 1000},0" for i in range(400))], "^: no plate moves"),
    "9 a level is no velocity": (["time [s],level [m]", *rows()], "^:1: unknown column 'level .m.'"),
    **{f"9 {name}": ([f"time [s],{name}", *rows()],
        f"^:1:2: .*{re.escape(repr(name))} is an acceleration or a velocity.*--channel fr='.*--highpass 0.5$")
       for name in ("acceleration [m/s2]", "acc_z [g]", "displacement [m/s^2]", "velocity [m/s]", "displacement [g]")},
    "11 too slow": ([HEADER, *(f"{i / 9},{z}" for i, z in enumerate(HEIGHTS))],
        "^: sampling rate 9 Hz, must be at least 10 Hz .usable up to 4 Hz.; "),
    "11 milliseconds under seconds": ([HEADER, *(f"{i},{z}" for i, z in enumerate(HEIGHTS))],
        "^: sampling rate 1 Hz, .*are the times in ms"),
    "14 cut off in its last row": ([HEADER, *rows(), "0.4"], "^:402:1: .* 1 cells, .* 2; .*truncated"),
    "19 Latin-1": (b"time [s],displacement [m]\n0.0,\xe9\n", "^:2:2: .* is 'é'"),
    "19 NUL": (b"time [s],displacement [m]\n0.0,0\0\n", "^:2:6: .*NUL"),
    "19 NUL behind the first megabyte": (f"{HEADER}\n".encode() + b"0.0,0.0\n" * 200_000 + b"\0", "^:200002:1: .*NUL"),
    "19 UTF-16": ("time [s]".encode("utf-16"), "^:1:1: .*UTF-16"),
    "19 a long header": (b"time [s]," + b"x" * 1_100_000, "^:1: .*1000000 characters"),
    "19 a long row": (b"time [s],displacement [m]\n" + b"1" * 1_100_000 + b"\n", "^:2: .*1000000 characters"),
}  # fmt: skip
"""Content of a file, and place, value, limit and remedy of its refusal."""

ALSO_INTERPOLATED: dict[str, tuple[list[str], str]] = {
    "2 text": (with_row(17, "0.017000,1.5x"), r"^:19:2: .* is '1\.5x'"),
    **{f"2 time {cell!r}": (with_row(17, f"{cell},1e-3"), f"^:19:1: column 'time .s.' is {cell!r}.*never interpolated")
       for cell in ("nan", "", "#N/A")},
    **{f"14 columns of different length {end!r}": (
        [*TWO[:301], *(f"{i / 1000},1e-3{end}" for i in range(300, 400))], "^:302:3: column 'displacement_fl .m.' ends")
       for end in ("", ",")},
}  # fmt: skip
"""Files that are refused with and without interpolation."""


def refused(path, **options: object) -> str:
    """Return the refusal without the path in front."""
    with pytest.raises(DataError) as caught:
        read_plain(path, **options)  # type: ignore[arg-type]
    assert caught.value.exit_code == 3 and str(caught.value).startswith(str(path))
    return str(caught.value).removeprefix(str(path))


@pytest.mark.parametrize("case", [*REFUSED, *ALSO_INTERPOLATED])
def test_a_bad_file_is_refused_with_the_place(tmp_path, case):
    content, pattern = (REFUSED | ALSO_INTERPOLATED)[case]
    path = tmp_path / "signal.csv"
    path.write_bytes(content if isinstance(content, bytes) else "\n".join([*content, ""]).encode())
    for interpolate in (False, True) if case in ALSO_INTERPOLATED else (False,):
        message = refused(path, interpolate=interpolate)
        assert re.search(pattern, message), message


def test_3_jitter_within_the_tolerance_is_accepted(tmp_path):
    assert read_plain(write(tmp_path, with_row(100, f"0.1000005,{HEIGHTS[100]}"))).notices == ()


def test_7_acceleration_beyond_a_shaker(tmp_path):
    message = refused(write(tmp_path, [HEADER, *rows(2000, amplitude=0.05, frequency=10.0)]))
    # A/2 (2 pi f)^2 = 98.7 m/s2; at the ends the filter makes a few percent more of it.
    assert abs(float(message.split()[5])) == pytest.approx(98.7, rel=0.1)
    assert "(below 100 Hz), must be at most 50 m/s2" in message and "in mm" in message


def test_91_one_pothole_is_named_and_no_reason_to_refuse(tmp_path):
    time = np.arange(20_000) / 1000.0
    pothole = -0.06 * np.exp(-(((time - 12.0) / 0.012) ** 2))
    z = 1e-3 * np.sin(2 * np.pi * 3.0 * time) * np.clip(time, 0.0, 1.0) + pothole

    def written(values):
        return write(tmp_path, [HEADER, *(f"{t:.3f},{value:.8f}" for t, value in zip(time, values, strict=True))])

    said = [text for text in read_plain(written(z)).notices if "a pothole" in text]
    # -2 A / s^2 at its deepest point, below 100 Hz
    assert len(said) == 1 and "at 12 s" in said[0] and "50 m/s2" in said[0]
    # in mm under [m] the whole record is beyond, and a spike of a logger is no pothole
    assert "in mm" in refused(written(1e3 * z))
    assert "displaced by 3" in refused(written(np.where(np.arange(time.size) == 9000, 3.0, z)))


def test_7_quantisation_of_a_measured_signal_is_no_acceleration():
    rng = np.random.default_rng(1)
    t = np.arange(10000) / 1000.0
    z = np.round((5e-4 * np.sin(2 * np.pi * 5.0 * t) + 3e-6 * rng.standard_normal(t.size)) / 1e-5) * 1e-5
    assert np.max(np.abs(np.diff(z, 2) * 1e6)) > 20.0
    # 10 um steps spread over 500 Hz: sqrt(q^2/12 / 500 (2 pi)^4 100^5 / 5) = 0.23 m/s2 RMS, 5 sigma; input 0.49 m/s2.
    assert np.max(np.abs(band_limited_acceleration(z, 1e-3))) < 3.0
    # And what is there is found: 0.49 m/s2 from the sine, within the noise.
    smooth = band_limited_acceleration(5e-4 * np.sin(2 * np.pi * 5.0 * t), 1e-3)
    assert np.max(np.abs(smooth[500:-500])) == pytest.approx(5e-4 * (10 * np.pi) ** 2, rel=1e-3)


def test_17_too_large_is_refused_before_it_is_read(tmp_path):
    path = tmp_path / "huge.csv"
    block = ("\n".join([HEADER, *rows(50000)]) + "\n").encode()  # more than the first megabyte
    with path.open("wb") as file:
        file.write(block)
        file.truncate(10 * 10**9)  # sparse: no disk is used
    message = refused(path)
    assert "rows in 10 GB" in message and "at most 2 GiB" in message
    rows_estimated = float(message.split()[2])
    assert rows_estimated == pytest.approx(10e9 / (len(block) / 50001), rel=0.01)  # rows are equally long


def test_missing_and_unreadable_files(tmp_path, monkeypatch):
    with pytest.raises(ConfigurationError, match=r"none\.csv: .*does not exist"):
        read_plain(tmp_path / "none.csv")

    def refuse(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(csv_text, "_check_memory", refuse)  # stands for a read error: root may read everything
    assert "(Permission denied)" in refused(write(tmp_path, [HEADER, *rows()]))
