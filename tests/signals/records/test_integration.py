"""High-pass and integration in the frequency domain against the filter of scipy and the closed form of a sine."""

import numpy as np
import pytest
from scipy.signal import butter, freqs

from vehicle.signals.records.integration import ORDER, integrate

CORNER, STEP = 2.0, 1e-3
TIME = STEP * np.arange(60_000)
INNER = slice(20_000, 40_000)
"""Samples that the ends of the record do not reach."""


@pytest.mark.parametrize("order", [0, 1, 2])
@pytest.mark.parametrize("frequency", [1.0, 2.0, 5.0])
def test_gain_and_phase_of_a_sine(frequency, order):
    """Forwards and backwards, the gain is |H|^2 of the Butterworth filter; each integration divides by 2 pi i f."""
    found = integrate(np.cos(2.0 * np.pi * frequency * TIME), STEP, order, CORNER)[INNER]
    _, (filter_gain,) = freqs(*butter(ORDER, 2.0 * np.pi * CORNER, "high", analog=True), worN=[2.0 * np.pi * frequency])
    gain = abs(filter_gain) ** 2 / (2j * np.pi * frequency) ** order
    expected = np.real(gain * np.exp(2j * np.pi * frequency * TIME[INNER]))
    # What is left of the ends of the record 20 s away: 7e-7 of the gain at 1 Hz after one integration, else less.
    np.testing.assert_allclose(found, expected, atol=2e-6 * abs(gain))


def test_it_is_the_gain_of_order_four():
    sine = np.cos(2.0 * np.pi * 0.5 * CORNER * TIME)
    assert np.ptp(integrate(sine, STEP, 0, CORNER)[INNER]) / 2.0 == pytest.approx(1.0 / 257.0, rel=1e-6)
