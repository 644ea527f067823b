import numpy as np
import pytest

from tests.signals.analysis.oscillator import stationary_response, transmissibility
from tests.signals.analysis.single_input import frequency_response
from tests.validation import validated
from vehicle.errors import DataError

STEP = 1e-3


def noise(samples, seed=0):
    return np.random.default_rng(seed).standard_normal(samples)


def test_a_gain_is_found_exactly():
    excitation = noise(30_000)
    found = frequency_response(STEP, excitation, [3.0 * excitation, -0.5 * excitation + 20.0])
    # a constant factor is the same in every segment: only rounding is left; the constant is removed
    validated(
        "FRF estimation and spectra", "H1 of a constant gain", found.response[0], 3.0, rel=1e-12,
        source="closed form: the gain",
    )  # fmt: skip
    assert found.response[1] == pytest.approx(np.full(197, -0.5), rel=1e-10)
    assert found.coherence == pytest.approx(np.ones((2, 197)), abs=1e-10)
    assert (found.frequency[0], found.frequency[-1], found.resolution_hz) == (1.0, 50.0, 0.25)
    assert (found.window, found.estimator, found.segments, found.reasons) == ("hann", "H1", 14, ())


def test_a_delay_turns_the_phase_backwards():
    excitation = noise(60_000)
    found = frequency_response(STEP, excitation, np.roll(excitation, 5))
    expected = np.exp(-2j * np.pi * found.frequency * 5 * STEP)
    # 5 of 4000 samples of each window are new: an error of about sqrt(2 * 5/4000 / 27) = 1 %, three times that allowed
    validated(
        "FRF estimation and spectra", "H1 of a delay of 5 samples", found.response[0], expected, abs=0.04,
        source="closed form: exp(-i w tau)",
    )  # fmt: skip


def test_an_oscillator_shows_its_analytic_response():
    excitation = noise(600_000)
    found = frequency_response(STEP, excitation, stationary_response(excitation, STEP, transmissibility), window_s=16.0)
    expected = transmissibility(found.frequency)
    # time constant 0.2 s, window 16 s: bias 13 * (0.2 / 16)^2 = 0.2 %; random error from what
    # enters and leaves a window: below 1 % at the peak with 70 averages
    validated(
        "FRF estimation and spectra", "H1 of an oscillator in random vibration", found.response[0], expected, rel=0.02,
        source="closed form: transmissibility",
    )  # fmt: skip
    assert found.coherence.min() > 0.99


def leaking_transmissibility(window_s, natural, damping):
    """Expected H1 under white excitation: transform of the impulse response times the window's autocorrelation."""
    lines = np.fft.rfftfreq(65_536, STEP)
    impulse = np.fft.irfft(transmissibility(lines, natural, damping), 65_536)
    length = round(window_s / STEP)
    window = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(length) / length)
    padded = np.abs(np.fft.rfft(window, 2 * length)) ** 2
    correlation = np.fft.irfft(padded)[:length] / (window @ window)
    return np.exp(-2j * np.pi * natural * np.arange(length) * STEP) @ (impulse[:length] * correlation)


def test_leakage_lowers_a_narrow_peak_as_predicted_and_a_longer_window_corrects_it():
    excitation = noise(400_000, 1)
    response = stationary_response(excitation, STEP, lambda f: transmissibility(f, 20.0, 0.01))
    gammas = []
    # the last column is what the docstring of frequency_response says
    for window_s, stated in ((2.0, 0.53), (4.0, 0.75), (16.0, 0.97)):
        found = frequency_response(STEP, excitation, response, window_s=window_s)
        at = int(np.argmin(np.abs(found.frequency - 20.0)))
        gamma = found.coherence[0, at]
        scatter = np.sqrt((1 - gamma) / (2 * found.averages[0, 0] * gamma))  # Bendat and Piersol, chapter 9
        exact = abs(transmissibility(20.0, 20.0, 0.01))
        predicted = abs(leaking_transmissibility(window_s, 20.0, 0.01))
        assert predicted / exact == pytest.approx(stated, abs=0.01)
        validated(
            "FRF estimation and spectra", f"leakage: H1 at a peak of 1 % damping with windows of {window_s:g} s",
            abs(found.response[0, at]), predicted, rel=4 * scatter,
            source="second derivation: window autocorrelation times impulse response",
        )  # fmt: skip
        gammas.append(gamma)
    assert gammas == sorted(gammas)
    assert scatter < 0.05
    broad = leaking_transmissibility(4.0, 28.0, 0.05) / transmissibility(28.0, 28.0, 0.05)
    assert abs(broad) == pytest.approx(0.99, abs=0.002)


@pytest.mark.parametrize("ratio", [0.5, 1.0])
def test_coherence_shows_the_known_share_of_noise(ratio):
    excitation = noise(400_000, 2)
    found = frequency_response(STEP, excitation, excitation + ratio * noise(400_000, 3))
    averages = found.averages[0, 0]
    expected = 1.0 / (1.0 + ratio**2)
    bias = (1.0 - expected) ** 2 / averages  # Bendat and Piersol, chapter 9
    # standard error of one line sqrt(2) (1 - g) sqrt(g / nd), over 190 lines of which every other is independent
    scatter = np.sqrt(2.0) * (1 - expected) * np.sqrt(expected / averages / 95)
    validated(
        "FRF estimation and spectra", f"coherence with noise of {ratio:g} times the signal", found.coherence.mean(),
        expected + bias, abs=4 * scatter, source="closed form: 1 / (1 + r^2) and bias, Bendat and Piersol, chapter 9",
    )  # fmt: skip
    # noise on the response does not bias H1
    assert np.abs(found.response.mean() - 1.0) < 4 * ratio / np.sqrt(2 * averages * 95)


def test_a_still_excitation_is_refused():
    for x, y, message in (
        (np.full(30_000, 0.1), noise(30_000), "excitation: constant at 0.1"),
        (noise(30_000), noise(29_999), "responses: found 29999 samples, .* 30000"),
    ):
        with pytest.raises(DataError, match=message):
            frequency_response(STEP, x, y)


def test_lines_without_excitation_are_nan_with_a_reason():
    time = np.arange(30_000) * STEP
    sine = np.sin(2 * np.pi * 10.0 * time)
    found = frequency_response(STEP, sine, 2.0 * sine)
    known = np.isfinite(found.response[0])
    # a Hann window spreads a sine of whole periods over three lines
    assert found.frequency[known] == pytest.approx([9.75, 10.0, 10.25])
    assert found.response[0, known] == pytest.approx(np.full(3, 2.0), rel=1e-10)
    (reason,) = found.reasons
    assert "194 lines of 1 to 50 Hz" in reason and "no power" in reason


def test_too_few_averages_are_rejected_and_a_single_average_has_no_coherence():
    excitation = noise(4000)
    with pytest.raises(DataError, match=r"4 s give 1 averages .* 4 s and 50 %"):
        frequency_response(STEP, excitation, excitation)
    found = frequency_response(STEP, excitation, excitation, minimum_averages=1.0)
    assert found.response[0] == pytest.approx(np.ones(197))
    assert np.isnan(found.coherence).all()
    (reason,) = found.reasons
    assert "coherence" in reason and "1 averages" in reason
