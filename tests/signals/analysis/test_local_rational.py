"""FRF of a whole random record without leakage, against analytic oscillators and against known noise."""

import numpy as np
import pytest

from tests.signals.analysis.single_input import frequency_response, local_rational_response
from tests.validation import validated
from vehicle.errors import DataError
from vehicle.signals.analysis.local_rational import local_rational_responses

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
    # One pole and a parabola behind it: 0.5 % of the peak with the second mode 0.5 Hz beside, 5 % in the valley.
    validated(
        "FRF estimation and spectra", "local rational FRF of close lightly damped modes, of the largest",
        found.response[0], truth, peak=0.01, source="closed form: sum of three oscillators",
    )  # fmt: skip
    validated(
        "FRF estimation and spectra", "local rational FRF of close lightly damped modes, at every line",
        found.response[0], truth, rel=0.06, source="closed form: sum of three oscillators",
    )  # fmt: skip
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
    validated(
        "FRF estimation and spectra", "local rational coherence with known noise", np.mean(found.coherence[0]),
        np.mean(truth), abs=0.03, source="closed form: signal over signal and noise",
    )  # fmt: skip


def test_lines_without_excitation_are_undefined():
    drive, answer = record(60.0)
    spectrum = np.fft.rfft(drive)
    frequency = np.fft.rfftfreq(drive.size, 1.0 / RATE)
    spectrum[(frequency > 10.0) & (frequency < 20.0)] = 0.0
    found = local_rational_response(1.0 / RATE, np.fft.irfft(spectrum, drive.size), answer, band=(2.0, 45.0))
    silent = (found.frequency > 10.5) & (found.frequency < 19.5)
    assert silent.sum() > 50 and np.isnan(found.response[0, silent]).all()
    assert np.isnan(found.coherence[0, silent]).all() and np.isnan(found.random_error[0, silent]).all()
    assert any("10.2 to 19.8 Hz" in text and "rounding" in text for text in found.reasons), found.reasons


def test_refusals_and_warnings():
    drive, answer = record(60.0)
    for step, x, y, band, message in (
        (1.0 / RATE, drive[:400], answer[:400], (1.0, 50.0), "0.8 s .* 50 Hz"),
        (1.0, drive, answer, (1.0, 0.4), " 1 Hz .* too slow"),
        (1.0 / RATE, np.zeros_like(drive), answer, (1.0, 50.0), "excitation: constant at 0"),
    ):
        with pytest.raises(DataError, match=message):
            local_rational_response(step, x, y, band=band)
    short = local_rational_response(1.0 / RATE, drive[:5000], answer[:5000])
    assert short.resolution_hz == pytest.approx(0.4)
    assert short.reasons[0].startswith("10 s ") and "0.4 Hz" in short.reasons[0]
    still = local_rational_response(1.0 / RATE, drive, [answer, np.full_like(answer, 0.1)], names=("seat", "roof"))
    assert np.isnan(still.response[1]).all() and np.isfinite(still.response[0]).any()
    assert any(text.startswith("roof: constant") for text in still.reasons)


def test_random_error_and_averages_equal_the_scatter_of_repetitions():
    # One drive, 200 noises: the scatter of |H| is the stated error, and n = (1 - g) / (2 g e^2) averages by H1 give it.
    drive, answer = record(30.0)
    noise = np.random.default_rng(6).normal(size=(200, answer.size)) * 0.3 * np.std(answer)
    found = local_rational_response(1.0 / RATE, drive, answer + noise, band=(8.0, 20.0), resolution=2.0)
    relative = np.mean(found.random_error, axis=0) / np.mean(np.abs(found.response), axis=0)
    scatter = np.std(np.abs(found.response), axis=0) / np.mean(np.abs(found.response), axis=0)
    # 200 samples tell a standard deviation within 5 %; three of them. The pole is unknown, so the estimate is careful.
    assert np.all(scatter / relative < 1.15) and np.median(scatter / relative) > 0.7
    gamma2 = np.mean(found.coherence, axis=0)
    averages = (1.0 - gamma2) / (2.0 * gamma2 * relative**2)
    validated(
        "Statistics and intervals", "averages of a local rational FRF, by line", np.mean(found.averages, axis=0),
        averages, rel=0.2, source="second derivation: scatter of 200 noises, n = (1 - g) / (2 g e^2)",
    )  # fmt: skip


def test_two_inputs_are_separated_related_or_not():
    drive, answer = record(60.0, seed=1)
    other, echo = record(60.0, seed=2)
    for share in (0.0, 0.7):
        second = np.sqrt(share) * drive + np.sqrt(1.0 - share) * other
        behind = np.sqrt(share) * answer + np.sqrt(1.0 - share) * echo
        first, left = local_rational_responses(1.0 / RATE, [drive, second], answer - 2.0 * behind, band=(5.0, 45.0))
        truth = exact(first.frequency)
        # The part of the other input is twice as large; noise-free, only the modes' neighbours are left.
        assert np.linalg.norm(first.response[0] - truth) < 0.01 * np.linalg.norm(truth)
        assert np.linalg.norm(left.response[0] + 2.0 * truth) < 0.02 * np.linalg.norm(truth)
        assert np.min(first.coherence) > 0.99
        alone = local_rational_response(1.0 / RATE, drive, answer - 2.0 * behind, band=(5.0, 45.0))
        assert np.median(alone.coherence) < 0.6
    noise = np.random.default_rng(3).normal(size=answer.size) * np.std(answer) * 0.1
    related = local_rational_responses(1.0 / RATE, [drive, second], answer + noise, band=(5.0, 45.0))[0]
    unrelated = local_rational_responses(1.0 / RATE, [drive, other], answer + noise, band=(5.0, 45.0))[0]
    # The error of a separated response grows by 1 / sqrt(1 - 0.7) with the coherence of the inputs.
    ratio = np.median(related.random_error / unrelated.random_error)
    validated(
        "Statistics and intervals", "error of an FRF by a related second input, over that by an unrelated one", ratio,
        1.0 / np.sqrt(0.3), rel=0.15, source="closed form: 1 / sqrt(1 - coherence of the inputs)",
    )  # fmt: skip


def test_an_frf_does_not_depend_on_the_other_responses_up_to_the_nyquist_frequency():
    # Windows and responses are fitted in batches; towards 50.5 Hz the windows become narrower again.
    rng = np.random.default_rng(7)
    drive = rng.normal(size=3000)
    answers = np.array([np.convolve(drive, rng.normal(size=9), "same") for _ in range(40)])
    answers += 0.1 * rng.normal(size=answers.shape)
    together = local_rational_response(1.0 / 101.0, drive, answers, band=(1.0, 50.0))
    assert np.isfinite(together.response).mean() > 0.95
    for row in (0, 17, 39):
        alone = local_rational_response(1.0 / 101.0, drive, answers[row], band=(1.0, 50.0))
        np.testing.assert_allclose(together.response[row], alone.response[0], rtol=1e-9)
        np.testing.assert_allclose(together.random_error[row], alone.random_error[0], rtol=1e-9)
        np.testing.assert_allclose(together.coherence[row], alone.coherence[0], rtol=1e-9)
