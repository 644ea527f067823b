"""Jittered clocks: made uniform before anything else, in every command alike; slow records up to 0.4 of their rate."""

import json
import shlex

import numpy as np
import pytest

from tests.validation import validated
from vehicle.commands.comfort import main as comfort
from vehicle.commands.inspect import main as inspect
from vehicle.errors import DataError
from vehicle.names import AXES
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.signals.formats.clock import clock_options, time_remarks
from vehicle.signals.formats.reader import read_record
from vehicle.signals.records.choice import Choice, choose
from vehicle.signals.records.integration import filtered
from vehicle.signals.records.measured import read_measured
from vehicle.signals.records.resampled import resampled
from vehicle.studies.replication.target import read_target

RATE = 200.0
"""Rate of the jittered records [Hz]."""


def jittered(seconds: float = 20.0, jitter: float = 0.007, drop: tuple[int, ...] = ()) -> np.ndarray:
    """Times of a clock with a jitter [share of a step], some samples lost."""
    rng = np.random.default_rng(1)
    time = np.arange(int(seconds * RATE)) / RATE
    time += np.concatenate([[0.0], rng.uniform(-jitter, jitter, time.size - 1)]) / RATE
    return np.delete(time, drop)


def motion(time: np.ndarray) -> np.ndarray:
    """A vertical acceleration with tones up to 60 Hz [m/s2]."""
    tones = ((1.3, 0.4), (8.0, 0.5), (27.0, 0.2), (60.0, 0.1))
    return np.asarray(np.sum([a * np.sin(2 * np.pi * f * time + f) for f, a in tones], axis=0))


def written(path, time, columns):
    heads = ",".join(["time [s]", *(f"{name} [{unit}]" for name, unit, _ in columns)])
    table = np.column_stack([time, *(values for _, _, values in columns)])
    np.savetxt(path, table, fmt="%.10g", delimiter=",", header=heads, comments="")
    return path


@pytest.mark.parametrize(
    # interpolation of a sine of 60 Hz = 0.3 / T: 0.1 % of it; a lost sample doubles T there, beyond its Nyquist limit
    ("drop", "error"),
    [((), 1e-4), (tuple(range(100, 3900, 200)), 0.06)],
)
def test_samples_are_taken_at_their_own_times(drop, error):
    time = jittered(drop=drop)
    found, said = resampled(time, {"z": motion(time)}, RATE, str, False)
    grid = time[0] + np.arange(found["z"].size) / RATE
    inner = slice(50, -50)
    off = np.abs(found["z"] - motion(grid))[inner]
    assert off.max() < error
    # where no sample is lost the record is right
    near = np.abs(grid[inner][:, None] - np.array([(n + 0.0) / RATE for n in drop])[None, :]) < 6.0 / RATE
    assert off[~near.any(axis=1)].max() < 2e-3 if drop else True
    assert not drop or "19 gaps of up to 10 ms" in said
    assert "irregular times" in said and "1.4 %" in said


def test_a_higher_rate_adds_no_images():
    time = np.arange(2000) / 100.0
    found, _ = resampled(time, {"z": np.sin(2 * np.pi * 38.0 * time)}, 1000.0, str, True)
    grid = np.arange(found["z"].size) / 1000.0
    off = np.abs(found["z"] - np.sin(2 * np.pi * 38.0 * grid))[1000:-1000]
    # sinc^8(0.38) over its sum with the image at 62 Hz: 2.6 % low; the image itself would add another 2.6 %
    assert off.max() < 0.028
    spectrum = np.abs(np.fft.rfft(found["z"][:10000] * np.hanning(10000)))
    line = 10000 * 1e-3
    assert spectrum[int(55 * line) :].max() < 2e-4 * spectrum[int(38 * line)]


def test_a_gap_is_refused_and_the_advice_works(tmp_path):
    time = jittered(drop=(1000, 1001, 1002))
    path = written(tmp_path / "gap.csv", time, [("z", "m/s2", motion(time))])
    with pytest.raises(DataError, match=r"gap of 0\.02 s, --resample .* 0\.0125 s; .*--to 4\.9950256"):
        choose(read_record(path), Choice(channels={"z": "z"}, resample=RATE))
    assert clock_options(time)[:1] == ("--from",) and clock_options(time)[-2:] == ("--resample", "200")
    assert f"set {shlex.join(clock_options(time))} " in time_remarks(time)[0]
    assert comfort(["--input", str(path), "--offset", "keep", *clock_options(time)]) == 0


def test_the_advice_of_inspect_runs_in_every_command(tmp_path, capsys):
    time = jittered()
    path = written(tmp_path / "seat.csv", time, [(axis, "m/s2", motion(time + n)) for n, axis in enumerate(AXES)])
    assert inspect([str(path)]) == 0
    assert "--resample 200, or --rate HZ" in capsys.readouterr().out
    bad = Choice(channels={"seat_rail_acc_z": "z"})
    good = Choice(channels={"seat_rail_acc_z": "z"}, resample=RATE, highpass=0.3)
    refusal = r"not uniform: .* 1\.37 %; set --resample"
    with pytest.raises(DataError, match=refusal):
        read_measured(path, ["seat_rail_acc_z"], bad)
    with pytest.raises(DataError, match=refusal):
        read_target(path, {"seat_rail_acc_z": "z"}, bad, (1.0, 50.0), 1000.0)
    read_measured(path, ["seat_rail_acc_z"], good)
    read_target(path, {"seat_rail_acc_z": "z"}, good, (1.0, 50.0), 1000.0)
    assert comfort(["--input", str(path), "--resample", "200", "--highpass", "0.3", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["sampling_rate_hz"] == pytest.approx(RATE) and found["highest_hz"] is None
    even = np.arange(4000) / RATE
    same = written(tmp_path / "even.csv", even, [(axis, "m/s2", motion(even + n)) for n, axis in enumerate(AXES)])
    assert comfort(["--input", str(same), "--highpass", "0.3", "--json"]) == 0
    expected = json.loads(capsys.readouterr().out)
    for axis in AXES:
        # 60 Hz within 0.1 %; the two records end within a step of each other
        assert found[axis]["weighted_rms"] == pytest.approx(expected[axis]["weighted_rms"], rel=5e-4)


def test_the_filter_acts_on_uniform_samples(tmp_path):
    time = jittered(jitter=0.2)
    path = written(tmp_path / "z.csv", time, [("z", "m/s2", motion(time) + 0.5 * time)])
    chosen = choose(read_record(path), Choice(channels={"z": "z"}, resample=RATE, highpass=0.3))
    values, _ = filtered(chosen, 0.3)
    off = values["z"] - motion(chosen.time)
    assert np.sqrt(np.mean(off[400:-400] ** 2)) < 5e-3


def test_a_jittered_acceleration_drives_the_plate(tmp_path):
    time = jittered()
    amplitude, f = 5e-3, 3.0
    acceleration = -amplitude * (2 * np.pi * f) ** 2 * np.sin(2 * np.pi * f * time)
    path = written(tmp_path / "a.csv", time, [("a", "m/s2", acceleration)])
    choice = Choice(channels={"fr": "a"}, resample=RATE, highpass=0.3)
    signal = read_signal(path, choice=choice)
    # full level in the middle of the record; the high-pass of 0.3 Hz leaves 1 - 1e-8 of 3 Hz
    validated(
        "File readers", "RMS of a displacement integrated from a jittered acceleration",
        np.std(signal.displacement["fr"][800:3200]), amplitude / np.sqrt(2.0), rel=2e-3, unit="m",
        source="closed form: amplitude / sqrt(2)",
    )  # fmt: skip
    assert signal.timestep == pytest.approx(1.0 / RATE)


def test_a_plate_below_125_hz_ends_at_its_band(tmp_path):
    time = np.arange(1500) / 100.0
    rise = 0.5 * (1.0 - np.cos(np.pi * np.clip(time, 0.0, 1.0)))
    path = written(tmp_path / "slow.csv", time, [("displacement", "m", 1e-3 * rise * np.sin(2 * np.pi * 7.0 * time))])
    for choice in (None, Choice(resample=1000.0), Choice(channels={"fr": "1"}, resample=1000.0)):
        signal = read_signal(path, wheel="fr", choice=choice)
        assert signal.highest == pytest.approx(40.0) and signal.band((1.0, 50.0))[1] == pytest.approx(40.0)
        assert any("valid up to 40 Hz" in text for text in signal.notices)
        assert signal.timestep == pytest.approx(1e-3)
        middle = slice(2000, 13000)
        expected = 1e-3 * np.sin(2 * np.pi * 7.0 * signal.time)
        np.testing.assert_allclose(signal.displacement["fr"][middle], expected[middle], rtol=0, atol=2e-7)
    assert read_signal(path, wheel="fr", choice=Choice(resample=100.0)).highest == pytest.approx(40.0)


def test_a_vertical_record_alone_has_its_value(tmp_path, capsys):
    time = np.arange(30_000) / 500.0
    z = motion(time)
    alone = written(tmp_path / "z.csv", time, [("z", "m/s2", z)])
    whole = written(tmp_path / "xyz.csv", time, [("x", "m/s2", 0.1 * z), ("y", "m/s2", 0.2 * z), ("z", "m/s2", z)])
    found = []
    for path in (alone, whole):
        assert comfort(["--input", str(path), "--json"]) == 0
        found.append(json.loads(capsys.readouterr().out))
    assert found[0]["z"] == found[1]["z"] and found[0]["x"] is None and found[0]["vector_sum"] is None
    assert "x and y missing: no vector sum" in found[0]["reasons"]
    assert comfort(["--input", str(alone)]) == 0
    text = capsys.readouterr().out
    assert "Wk" in text and "Wd" not in text and "vector sum" not in text


def test_a_slow_comfort_record_says_where_it_ends(tmp_path, capsys):
    time = np.arange(6000) / 100.0
    path = written(tmp_path / "z.csv", time, [("z", "m/s2", np.sin(2 * np.pi * 8.0 * time))])
    assert comfort(["--input", str(path), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["highest_hz"] == pytest.approx(40.0)
    assert any("end at 40 Hz" in text for text in found["reasons"])
    # Wk(8 Hz)
    validated(
        "Comfort, ISO 2631", "weighted RMS of a sine of 8 Hz sampled at 100 Hz", found["z"]["weighted_rms"],
        1.036 / np.sqrt(2.0), rel=5e-3, unit="m/s2", source="standard: ISO 2631-1:1997, table 3",
    )  # fmt: skip
