"""Lines that the input does not drive: rounding, leakage, sines, transients."""

import numpy as np
import pytest

from tests.benchmarks.frf_accuracy import banded_input
from tests.signals.analysis.single_input import local_rational_response
from tests.validation import validated
from vehicle.signals.analysis.input_floor import CAUSES, cause_messages, rounding_step, tapered_power
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal_file import read_signal

STEP = 1.0 / 2048.0
SECONDS = 30.0
TIME = np.arange(round(SECONDS / STEP)) * STEP
RAMP = np.minimum(1.0, np.minimum(TIME, TIME[-1] - TIME) / 2.0)
SINE = 0.4e-3 * np.sin(2.0 * np.pi * 28.4 * TIME)


def estimate(signal):
    echo = np.convolve(signal, [0.5, 0.3, -0.2], mode="same") + 1e-7 * np.random.default_rng(1).normal(size=signal.size)
    found = local_rational_response(STEP, signal, echo)
    return found, np.isfinite(found.response[0])


@pytest.mark.parametrize("rounded", [0.0, 3e-7, 1e-5])
def test_a_band_limited_record_has_no_frf_outside_its_band(rounded):
    rng = np.random.default_rng(3)
    signal = banded_input(SECONDS, rng, step=rounded or 1e-20)
    found, told = estimate(signal)
    inside = (found.frequency >= 3.0) & (found.frequency <= 30.0)
    assert np.sum(told & ~inside) <= 2
    assert np.mean(told[inside]) > 0.99
    assert np.isnan(found.coherence[0, ~told]).all() and np.isnan(found.random_error[0, ~told]).all()
    assert any("rounding" in text for text in found.reasons)


@pytest.mark.parametrize("signal", [SINE, SINE * RAMP, np.round(SINE / 3e-7) * 3e-7], ids=["sine", "ramped", "rounded"])
def test_a_sine_has_no_frf(signal):
    found, told = estimate(signal)
    assert not told.any()
    assert any("sine" in text for text in found.reasons)


def test_a_bump_at_the_beginning_cannot_be_separated_from_the_transient():
    bump = 0.02 * np.where(TIME < 0.02, 0.5 - 0.5 * np.cos(2.0 * np.pi * TIME / 0.02), 0.0)
    found, told = estimate(bump)
    assert not told.any()
    assert any("bump" in text for text in found.reasons)


def test_the_skirt_of_a_strong_band_is_silent():
    strong = banded_input(SECONDS, np.random.default_rng(4), step=1e-20)
    weak = 3e-6 * np.random.default_rng(5).normal(size=strong.size)
    found, told = estimate(strong + weak)
    # White noise of 3e-6 m stands far above every floor, and 5e-5 below the band an octave down in power at 40 Hz.
    assert not told[(found.frequency > 31.0) & (found.frequency < 45.0)].any()
    assert any("1e-4" in text and "octave" in text for text in found.reasons)


def test_rounding_step():
    rng = np.random.default_rng(1)
    values = rng.normal(size=20_000)
    assert rounding_step(np.round(values / 0.003) * 0.003) == pytest.approx(0.003)
    assert rounding_step(values) == 0.0
    assert rounding_step(np.zeros(10)) == 0.0


def test_tapered_power_of_white_noise_is_that_of_its_transform():
    values = np.random.default_rng(2).normal(size=20_000)
    power, floor = tapered_power(values, 0.1)
    assert np.mean(power[10:-10]) == pytest.approx(values.size, rel=0.05)
    validated(
        "FRF estimation and spectra", "power of the rounding of a record", floor, values.size * 0.1**2 / 12.0, rel=1e-6,
        source="closed form: n q^2 / 12",
    )  # fmt: skip


def test_a_random_record_has_no_holes():
    """A stretch around 6.2 Hz of this one has fewer than five effective lines by chance."""
    plate = read_signal(find_input("low.csv"), wheel="fr").displacement["fr"]
    assert np.isfinite(local_rational_response(1e-3, plate, plate).response).all()


def test_a_few_lines_without_input_are_said_as_few():
    frequency = np.linspace(1.0, 100.0, 100)
    silent = np.zeros(100, dtype=int)
    silent[41] = 5
    (text,) = cause_messages(frequency, silent)
    assert text.startswith("no FRF at 42 Hz (1 of 100 lines): ") and text.endswith("; the other lines are good")
    silent[10:60] = 1
    text, *_ = cause_messages(frequency, silent)
    assert text.startswith("no FRF at 11 to 60 Hz (50 of 100 lines): ") and text.endswith(
        "; give the input more power there"
    )


def test_several_causes_of_weak_lines_are_one_message():
    frequency, silent = np.linspace(1.0, 100.0, 100), np.zeros(100, dtype=int)
    silent[60:], silent[61::20] = 2 + 2 * (np.arange(40) % 3 == 0), 0
    (text,) = cause_messages(frequency, silent)
    assert text.startswith(f"no FRF above 61 Hz (38 of 100 lines): mostly, {CAUSES[1]}; ")
    silent[10:40] = 1
    (text,) = cause_messages(frequency, silent)
    assert text.startswith(f"no FRF at 11 to 40, 61, 63 to 81, 83 to 100 Hz (68 of 100 lines): mostly, {CAUSES[0]}; ")
    silent[5] = 1
    (text,) = cause_messages(frequency, silent)
    assert text.startswith("no FRF between 6 and 100 Hz (69 of 100 lines): ")
