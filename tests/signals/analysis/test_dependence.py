"""Copies among inputs are found with delay and factor; what is only related is not taken for one."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.signals.analysis.dependence import (
    DependentInputsError,
    common_motions,
    copy_of,
    motion_words,
    refuse_copies,
)

RATE, SECONDS = 500.0, 30.0
BAND = (1.0, 50.0)
NAMES = ("fr", "fl")


def displacement(seed):
    """Random displacement of constant velocity power from 1 to 60 Hz."""
    rng = np.random.default_rng(seed)
    frequency = np.fft.rfftfreq(round(40 * RATE), 1.0 / RATE)
    shape = np.where((frequency > 1.0) & (frequency < 60.0), 1.0 / np.maximum(frequency, 1.0), 0.0)
    real, imaginary = rng.normal(size=(2, frequency.size))
    return np.fft.irfft(shape * (real + 1j * imaginary))[: round((SECONDS + 4.0) * RATE)]


@pytest.mark.parametrize("delay", [0.04, 1.0, 1.7, 3.0, -2.0])
@pytest.mark.parametrize("factor", [1.0, -1.0, 2.0])
def test_delayed_copies_are_refused_with_delay_and_factor(delay, factor):
    whole, samples, shift = displacement(1), round(SECONDS * RATE), round(abs(delay) * RATE)
    early, late = whole[shift : shift + samples], factor * whole[:samples]
    inputs = np.array([early, late] if delay > 0.0 else [late / factor, factor * early])
    with pytest.raises(DependentInputsError) as refusal:
        refuse_copies(1.0 / RATE, inputs, NAMES, BAND)
    assert refusal.value.delay == pytest.approx(delay, abs=1e-9)
    assert refusal.value.factor == pytest.approx(factor, rel=1e-6)
    way = f"delayed by {delay:g} s" if delay > 0.0 else f"ahead by {-delay:g} s"
    assert f"fl is {factor:g} times fr, {way}" in str(refusal.value)
    with pytest.raises(DependentInputsError, match="times fr, "):
        common_motions(1.0 / RATE, inputs, NAMES, BAND)


def test_copies_without_delay_have_a_common_motion():
    one = displacement(1)
    for other, words in ((one, "alike"), (-one + 0.3, "together, one -1 times the other")):
        assert [motion_words(group) for group in common_motions(1.0 / RATE, np.array([one, other]), NAMES, BAND)] == [
            words
        ]


def test_four_plates_are_grouped_by_motion():
    """Front plates in roll, the rear ones of their own: three inputs; all four in pitch: one."""
    one, other, third = (displacement(seed) for seed in (1, 2, 3))
    names = ("fr", "fl", "rr", "rl")
    groups = common_motions(1.0 / RATE, np.array([one, -one, other, third]), names, BAND)
    assert [list(group) for group in groups] == [[0, 1], [2], [3]] and groups[0][1] == pytest.approx(-1.0)
    (pitch,) = common_motions(1.0 / RATE, np.array([one, one, -one, -one]), names, BAND)
    assert motion_words(pitch) == "together, 1, -1, -1 times the first"
    late = np.roll(other, 40)
    with pytest.raises(DependentInputsError, match=r"rl is 1 times rr, delayed by 0\.08 s"):
        common_motions(1.0 / RATE, np.array([one, -one, other, late]), names, BAND)


def test_a_filtered_copy_is_refused_without_a_factor():
    one = displacement(1)
    with pytest.raises(DependentInputsError, match="fl is a filtered fr"):
        common_motions(1.0 / RATE, np.array([one, np.gradient(one) * RATE]), NAMES, BAND)


@pytest.mark.parametrize("related", [0.0, 0.7, 0.9])
def test_correlated_inputs_are_not_copies(related):
    one, other = displacement(1), displacement(2)
    inputs = np.array([one, np.sqrt(related) * one + np.sqrt(1.0 - related) * other])
    assert len(common_motions(1.0 / RATE, inputs, NAMES, BAND)) == 2
    found = copy_of(1.0 / RATE, inputs[0], inputs[1], BAND)
    # 17 windowed lines are 11 independent ones: the median estimate of 0 is ln 2 / 11, and smaller above.
    validated(
        "FRF estimation and spectra", f"coherence of inputs related by {related:g}", found.coherence, related, abs=0.1,
        source="closed form: share of the common noise",
    )  # fmt: skip
