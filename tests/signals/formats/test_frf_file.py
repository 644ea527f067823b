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
        frequency=frequency, response=response, coherence=coherence, random_error=0.1 * np.abs(response),
        averages=np.full(coherence.shape, 8.0), segments=1, window="none", estimator="any", resolution_hz=0.5,
        reasons=(),
    )  # fmt: skip
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
    for channel, highest, message in (
        ("c", 12.0, "no channel c; .* b, a$"),
        ("a", 4.0, "3 .* 2 and 4 Hz .* 1 Hz, .* 8"),
    ):
        with pytest.raises(DataError, match=message):
            data.select((channel,), band=(2.0, highest), spacing=1.0)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ([HEADER, *ROWS[:3]], "3 rows"),
        (["# only a comment"], "only comments.*'frequency"),
        (["f,a_magnitude,a_phase [deg],a_coherence", *ROWS], r"own\.csv:1: column 'frequency \[Hz\]' is missing"),
        (["frequency [Hz],a_magnitude,a_phase [rad],a_coherence", *ROWS], r"unknown column 'a_phase \[rad\]'"),
        (["frequency [Hz],a_magnitude,a_phase [deg],b_coherence", *ROWS], "no column 'a_coherence'"),
        (["frequency [Hz],a_magnitude,a_phase [deg],a_magnitude", *ROWS], "'a_magnitude' appears twice"),
        (["frequency [Hz]", *[row.split(",")[0] for row in ROWS]], "no channel"),
        (["# note", HEADER, *ROWS, "20,1,2"], r"own\.csv:13:3: .* 3 cells, .* 4"),
        ([HEADER, *ROWS, "20,1,2,nan"], r"own\.csv:12:4: column 'a_coherence' is 'nan'"),
        ([HEADER, *ROWS, "20,inf,2,0.5"], r"own\.csv:12:2: column 'a_magnitude' is 'inf'"),
        ([HEADER, *ROWS, "20,1,x,0.5"], r"own\.csv:12:3: column 'a_phase \[deg\]' is 'x'"),
        ([HEADER, *ROWS, ",1,2,0.5"], r"own\.csv:12:1: column 'frequency \[Hz\]' is ''"),
        ([HEADER, *ROWS, "20,1,2,1.5"], r"own\.csv:12: column 'a_coherence' .* 1\.5 but must be 0 to 1"),
        ([HEADER, *ROWS, "20,-1,2,0.5"], r"own\.csv:12: column 'a_magnitude' .* -1 but must be 0 "),
        ([HEADER, *ROWS, "3,1,2,0.5"], r"own\.csv:12: column 'frequency \[Hz\]' .* 3 after 10"),
        ([HEADER, "0,1,2,0.5", *ROWS], r"own\.csv:2: column 'frequency \[Hz\]' .* 0, must be above 0"),
        (b"\xff\xfe\x00\x80", "UTF-16"),
    ],
)
def test_bad_files_are_refused_by_place(tmp_path, lines, message):
    path = written(tmp_path, [] if isinstance(lines, bytes) else lines)
    if isinstance(lines, bytes):
        path.write_bytes(lines)
    with pytest.raises(DataError, match=message):
        read_frf(path)


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(ConfigurationError, match=r"own\.csv: .*does not exist"):
        read_frf(tmp_path / "own.csv")
