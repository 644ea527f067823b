"""FRF of a whole random record without leakage, against analytic oscillators and against known noise."""

from __future__ import annotations

import numpy as np
import pytest

from vehicle.analysis.frf import frequency_response
from vehicle.analysis.local_rational import local_rational_response
from vehicle.errors import DataError

RATE = 500.0
MODES = ((3.1, 0.017), (3.6, 0.03), (28.0, 0.03))
"""Natural frequency [Hz] and damping ratio of three oscillators in parallel; the first two as close as body modes."""


def exact(frequency):
    s = 2j * np.pi * np.asarray(frequency)
    total = np.zeros_like(s)
    for natural, ratio in MODES:
        w = 2.0 * np.pi * natural
        total = total + s**2 / (s**2 + 2.0 * ratio * w * s + w**2)
    return total


def record(seconds, seed=1, transient=20.0):
    """Band-limited noise and the exact response, cut out of a longer periodic record: its ends leak like a real one."""
    rng = np.random.default_rng(seed)
    samples = round((seconds + transient) * RATE)
    frequency = np.fft.rfftfreq(samples, 1.0 / RATE)
    spectrum = rng.normal(size=frequency.size) + 1j * rng.normal(size=frequency.size)
    spectrum[(frequency < 1.0) | (frequency > 60.0)] = 0.0
    keep = round(seconds * RATE)
    drive = np.fft.irfft(spectrum, samples)[-keep:]
    answer = np.fft.irfft(spectrum * exact(frequency), samples)[-keep:]
    return drive, answer


def test_close_lightly_damped_modes_keep_their_frf_and_coherence():
    drive, answer = record(60.0)
    found = local_rational_response(1.0 / RATE, drive, answer, band=(2.0, 45.0))
    truth = exact(found.frequency)
    error = np.abs(found.response[0] - truth) / np.abs(truth)
    # One pole and a line behind it: 0.5 % of the peak where the second mode stands 0.5 Hz beside, 2 % in the valley.
    assert np.max(np.abs(found.response[0] - truth)) < 0.01 * np.max(np.abs(truth))
    assert np.max(error) < 0.03
    assert np.max(error[found.frequency > 5.0]) < 0.01
    assert np.min(found.coherence) > 0.99
    windowed = frequency_response(1.0 / RATE, drive, answer, window_s=4.0, band=(2.0, 45.0))
    assert np.min(windowed.coherence) < 0.9, "the average of windows leaks, or this test shows nothing"


def test_known_noise_gives_the_known_coherence():
    drive, answer = record(240.0)
    noise = np.random.default_rng(5).normal(size=answer.size)
    noise *= 0.5 * np.std(answer) / np.std(noise)
    found = local_rational_response(1.0 / RATE, drive, answer + noise, band=(20.0, 45.0))
    frequency = found.frequency
    signal = np.abs(exact(frequency)) ** 2 * np.var(drive) / 59.0  # flat from 1 to 60 Hz
    truth = signal / (signal + np.var(noise) / (RATE / 2.0))
    # Mean over some 250 estimates of five and more degrees of freedom each.
    assert np.mean(found.coherence[0]) == pytest.approx(np.mean(truth), abs=0.03)


def test_doubled_input_doubles_nothing_in_the_ratio():
    drive, answer = record(20.0)
    once = local_rational_response(1.0 / RATE, drive, answer, band=(2.0, 45.0))
    twice = local_rational_response(1.0 / RATE, 2.0 * drive, 2.0 * answer, band=(2.0, 45.0))
    np.testing.assert_allclose(twice.response, once.response, rtol=1e-9)  # round-off


def test_where_nothing_is_excited_there_is_no_number():
    drive, answer = record(60.0)
    spectrum = np.fft.rfft(drive)
    frequency = np.fft.rfftfreq(drive.size, 1.0 / RATE)
    spectrum[(frequency > 10.0) & (frequency < 20.0)] = 0.0
    found = local_rational_response(1.0 / RATE, np.fft.irfft(spectrum, drive.size), answer, band=(2.0, 45.0))
    silent = (found.frequency > 10.5) & (found.frequency < 19.5)
    assert silent.sum() > 50 and np.isnan(found.response[0, silent]).all()
    assert "nothing is excited at" in found.reasons[0]


def test_refusals_and_warnings():
    drive, answer = record(60.0)
    with pytest.raises(DataError, match="is too short for an FRF up to 50 Hz"):
        local_rational_response(1.0 / RATE, drive[:400], answer[:400])
    with pytest.raises(DataError, match="is zero throughout"):
        local_rational_response(1.0 / RATE, np.zeros_like(drive), answer)
    short = local_rational_response(1.0 / RATE, drive[:5000], answer[:5000])
    assert short.reasons[0].startswith("the FRF resolves 1.3 Hz only, since the record lasts 10 s")
