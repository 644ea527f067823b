"""Reading `frf.csv` back: what was written comes back, and what is wrong is refused by file, line and column."""

import numpy as np
import pytest

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.formats.frf_file import read_frf, write_frf

CHANNELS = ("knuckle_fr_acc_z", "engine_acc_z")
HEADER = "frequency [Hz],a_magnitude,a_phase [deg],a_coherence"
ROWS = [f"{1 + n},2.0,{10 * n},0.9" for n in range(10)]


def written(tmp_path, lines):
    path = tmp_path / "own.csv"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_what_the_shaker_command_writes_comes_back(tmp_path):
    frequency = np.linspace(1.0, 50.0, 99)
    turning = 1e3 * frequency * np.exp(-0.3j * frequency)
    response = np.array([turning, 0.5 * np.conj(turning)])
    response[1, 3] = complex(np.nan, np.nan)
    coherence = np.array([np.linspace(0.3, 1.0, 99), np.full(99, 0.8)])
    coherence[1, 3] = np.nan
    clean = FrequencyResponse(
        frequency=frequency,
        response=response,
        coherence=coherence,
        random_error=0.1 * np.abs(response),
        averages=np.full(coherence.shape, 8.0),
        segments=1,
        window="none",
        estimator="any",
        resolution_hz=0.5,
        reasons=(),
    )
    path = tmp_path / "frf.csv"
    write_frf(path, {"plate_fr": clean}, CHANNELS, "frame")
    data = read_frf(path)
    assert data.channels == CHANNELS
    # Nine digits are written.
    np.testing.assert_allclose(data.frequency, frequency, rtol=1e-8)
    np.testing.assert_allclose(data.response, response, rtol=1e-7)
    np.testing.assert_allclose(data.coherence, coherence, rtol=1e-8)
    np.testing.assert_allclose(data.random_error, 0.1 * np.abs(response), rtol=1e-8)


def test_selection_by_channel_band_and_spacing(tmp_path):
    lines = ["frequency [Hz],b_coherence,b_phase [deg],b_magnitude,a_magnitude,a_phase [deg],a_coherence"]
    lines += [f"{n / 4},0.5,0,{n},{2 * n},90,0.9" for n in range(1, 100)]
    data = read_frf(written(tmp_path, lines))
    assert data.channels == ("b", "a")
    assert np.isnan(data.random_error).all()
    part = data.select(("a",), band=(2.0, 12.0), spacing=1.0)
    np.testing.assert_allclose(part.frequency, np.arange(2.0, 12.5))
    np.testing.assert_allclose(part.response[0], 8.0j * part.frequency, atol=1e-12)
    assert np.all(part.coherence == 0.9)
    assert data.select(("a", "b"), band=(2.0, 12.0)).frequency.size == 41
    with pytest.raises(DataError, match="no channel c; the file has b, a"):
        data.select(("c",), band=(2.0, 12.0))
    with pytest.raises(DataError, match="3 frequencies between 2 and 4 Hz with a spacing of 1 Hz, must be at least 8"):
        data.select(("a",), band=(2.0, 4.0), spacing=1.0)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ([HEADER, *ROWS[:3]], "3 rows of numbers"),
        (["# only a comment"], "only comments; must have the columns 'frequency"),
        (["f,a_magnitude,a_phase [deg],a_coherence", *ROWS], r"own\.csv:1: column 'frequency \[Hz\]' is missing"),
        (["frequency [Hz],a_magnitude,a_phase [rad],a_coherence", *ROWS], r"unknown column 'a_phase \[rad\]'"),
        (["frequency [Hz],a_magnitude,a_phase [deg],b_coherence", *ROWS], r"no column 'a_coherence'"),
        (["frequency [Hz],a_magnitude,a_phase [deg],a_magnitude", *ROWS], r"'a_magnitude' appears twice"),
        (["frequency [Hz]", *[row.split(",")[0] for row in ROWS]], "no channel"),
        (["# note", HEADER, *ROWS, "20,1,2"], r"own\.csv:13:3: the last row has 3 cells, but the header 4; the"),
        (
            [HEADER, *ROWS, "20,1,2,nan"],
            r"own\.csv:12:4: column 'a_coherence' is 'nan', must be a finite number, or empty",
        ),
        ([HEADER, *ROWS, "20,inf,2,0.5"], r"own\.csv:12:2: column 'a_magnitude' is 'inf', must be"),
        ([HEADER, *ROWS, "20,1,x,0.5"], r"own\.csv:12:3: column 'a_phase \[deg\]' is 'x', must be"),
        (
            [HEADER, *ROWS, ",1,2,0.5"],
            r"own\.csv:12:1: column 'frequency \[Hz\]' is ''; a frequency is never interpolated",
        ),
        ([HEADER, *ROWS, "20,1,2,1.5"], r"own\.csv:12: column 'a_coherence' has the value 1\.5, must be 0 to 1"),
        ([HEADER, *ROWS, "20,-1,2,0.5"], r"own\.csv:12: column 'a_magnitude' has the value -1, must be 0 and above"),
        (
            [HEADER, *ROWS, "3,1,2,0.5"],
            r"own\.csv:12: column 'frequency \[Hz\]' has the value 3 after 10; .*must increase",
        ),
        ([HEADER, "0,1,2,0.5", *ROWS], r"own\.csv:2: column 'frequency \[Hz\]' has the value 0, must be above 0"),
    ],
)
def test_bad_files_are_refused_by_place(tmp_path, lines, message):
    with pytest.raises(DataError, match=message):
        read_frf(written(tmp_path, lines))


def test_what_is_no_text_file_is_refused(tmp_path):
    with pytest.raises(ConfigurationError, match=r"own\.csv: the file does not"):
        read_frf(tmp_path / "own.csv")
    path = tmp_path / "own.csv"
    path.write_bytes(b"\xff\xfe\x00\x80")
    with pytest.raises(DataError, match="the file is UTF-16, must be UTF-8"):
        read_frf(path)
