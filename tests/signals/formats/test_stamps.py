"""Stamps that do not show when each sample was taken: the clock is that of the number of samples over the span."""

import json

import numpy as np
import pytest

from tests.validation import validated
from vehicle.commands.comfort import main as comfort
from vehicle.errors import DataError
from vehicle.signals.formats.channel import Channel
from vehicle.signals.formats.clock import clock_of_stamps, clock_options, time_remarks, typical_rate
from vehicle.signals.formats.reader import read_columns, read_record
from vehicle.signals.records.choice import Choice, choose

K = np.arange(6000)
RNG = np.random.default_rng(3)
SIZES = RNG.integers(15, 26, 300)
ARRIVALS = np.cumsum(SIZES) / 100.0 + 0.005 * RNG.uniform(size=300)
INSIDE = np.concatenate([1e-6 * np.arange(size) for size in SIZES])
CASES = {
    "two delays in turn": (np.repeat(0.02 * np.arange(3000), 2) + np.tile([0.0, 0.016], 3000), 100.0),
    "batches of 20": (0.2 * (K // 20), 100.0),
    "batches of any size": (np.repeat(ARRIVALS, SIZES), 100.0),
    "microseconds inside a batch": (np.repeat(ARRIVALS, SIZES) + INSIDE, 100.0),
    "whole seconds": (np.floor(K / 100.0 + 0.337), 100.0),
    "whole seconds of an odd clock": (np.floor(K / 97.123 + 0.4), 97.12),
    "milliseconds of 512 Hz": (np.floor(1e3 * K / 512.0) / 1e3, 512.0),
    "milliseconds of 390.7 Hz": (np.floor(1e3 * K / 390.7) / 1e3, 390.7),
    "jitter beyond a step, in milliseconds": (np.sort(np.round(K / 500.0 + RNG.normal(0.0, 1e-3, K.size), 3)), 500.0),
}


@pytest.mark.parametrize("name", CASES)
def test_the_rate_is_the_count_over_the_span(name):
    time, rate = CASES[name]
    assert clock_options(time) == ("--rate", f"{rate:g}")
    (remark,) = time_remarks(time)
    assert f"set --rate {rate:g}, the mean rate" in remark
    channel = Channel(name="z", values=np.zeros(time.size), axis=time)
    validated(
        "File readers", f"sampling rate under stamps with {name}", channel.rate, rate, rel=1e-12, unit="Hz",
        source="closed form: the clock of the samples that were stamped",
    )  # fmt: skip


@pytest.mark.parametrize(
    "time",
    [
        K / 200.0 + RNG.uniform(-0.3, 0.3, K.size) / 200.0,
        np.delete(K / 100.0, 3000),
        np.delete(K / 100.0, np.arange(5, 6000, 10)),  # a lost sample is no stamp of the next one
        np.where(K > 3000, K / 100.0 + 5.0, K / 100.0),
        np.concatenate([K / 100.0, K / 100.0]),
        np.concatenate([K[:99] / 100.0, K[98:] / 100.0]),  # a row written twice
        K / 60.0,
        np.round(K / 60.0, 3),
    ],
    ids=["jitter", "lost", "regularly lost", "pause", "restart", "twice", "uniform", "rounded"],
)
def test_other_times_are_those_of_the_samples(time):
    assert clock_of_stamps(time) is None


def test_the_rate_of_jittered_times():
    jittered = K / 200.0 + RNG.uniform(-0.3, 0.3, K.size) / 200.0
    assert typical_rate(jittered) == pytest.approx(200.0, rel=1e-3)
    assert typical_rate(np.delete(K / 100.0, np.arange(5, 6000, 10))) == pytest.approx(100.0)


@pytest.mark.parametrize("name", ["two delays in turn", "batches of 20"])
def test_a_record_with_such_stamps_is_that_of_its_clock(tmp_path, capsys, name):
    time = CASES[name][0]
    values = np.convolve(RNG.standard_normal(K.size), np.ones(4) / 4.0, "same")
    path = tmp_path / "seat.csv"
    results = []
    for stamps, words, file in ((time, ["--rate", "100"], path), (K / 100.0, [], tmp_path / "true.csv")):
        np.savetxt(file, np.column_stack([stamps, values]), "%.6f", ",", header="time [s],z [m/s2]", comments="")
        assert comfort(["--input", str(file), *words, "--offset", "remove", "--json"]) == 0
        results.append(json.loads(capsys.readouterr().out)["z"]["weighted_rms"])
    assert results[0] == pytest.approx(results[1], rel=1e-9)  # times of 100 Hz, once computed and once written
    resampled = Choice(channels={"z": "z"}, resample=63.0)
    for read in (lambda: read_columns(path), lambda: choose(read_record(path), resampled)):
        with pytest.raises(DataError, match="--rate 100"):
            read()
