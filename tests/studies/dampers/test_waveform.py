"""Waveforms of tests of a damper: sines, triangles, velocity steps and random motion are named rightly."""

import numpy as np
import pytest

from tests.benchmarks.known_dampers import random_motion, sine, strokes
from vehicle.studies.dampers.waveform import waveform_of

STEPS = [0.01, 0.1, 0.5]
CASES = {
    "sine, 4 Hz": lambda: sine(0.008, 4.0, 2.0),
    "sine, 0.1 Hz": lambda: sine(0.004, 0.1, 20.0),  # three swings between its ends
    "triangle, 4 mm/s": lambda: strokes([0.004], 0.008, 0.04, 3),
    "velocity steps, 10, 100, 500 mm/s": lambda: strokes(STEPS, 0.04, 0.03, 2),
    "random motion": lambda: random_motion(8.0, 0.008, 1),
}


@pytest.mark.parametrize("words", CASES)
def test_a_motion_is_named(words):
    """At 1 kHz, the displacement with noise of 0.05 % of the stroke."""
    time, x, v = (values[::10] for values in CASES[words]())
    noise = 5e-4 * np.ptp(x) * np.random.default_rng(3).standard_normal(x.size)
    found = waveform_of(time, x + noise, v)
    assert found.words == words
    assert found.periodic == words.startswith(("sine, 4", "triangle")) and found.steps == words.startswith("velocity")


def test_sines_of_several_frequencies_in_a_record():
    parts = [np.sin(np.pi * np.arange(6 * n) / n) for n in (500, 250, 100)]
    x = 0.01 * np.concatenate(parts)
    time = np.arange(x.size) / 1000.0
    found = waveform_of(time, x, np.gradient(x, time))
    assert found.words == "sine steps, 1 to 5 Hz" and not found.periodic


def test_run_up_and_run_down_of_equal_swings_are_left_out():
    time, x, v = (values[::10] for values in sine(0.01, 2.0, 6.0))
    envelope = np.clip(np.minimum(time, 6.0 - time) / 1.0, 0.0, 1.0)
    found = waveform_of(time, envelope * x, envelope * v)
    inside = time[found.settled]
    assert found.words == "sine, 2 Hz" and 0.8 < inside[0] < 1.3 and 4.7 < inside[-1] < 5.2
