"""Delay of an FRF from its phase: closed form, noise, and FRFs of other levels."""

import numpy as np
import pytest

from vehicle.signals.analysis.phase_delay import phase_delay

FREQUENCY = np.arange(1.0, 50.0, 0.25)
FRF = 1.0 / (1.0 - (FREQUENCY / 12.0) ** 2 + 0.1j * FREQUENCY / 12.0)
ONES = np.ones(FREQUENCY.size)


@pytest.mark.parametrize("delay", [0.0, 0.4e-3, 12.3e-3, -30e-3, 99e-3])
def test_a_delay_is_exact_whatever_the_level(delay):
    found = phase_delay(FREQUENCY, FRF, 3.0 * FREQUENCY * FRF * np.exp(-2j * np.pi * FREQUENCY * delay), ONES)
    assert found is not None and found.delay == pytest.approx(delay, abs=1e-9) and found.agreement == pytest.approx(1.0)


def test_the_standard_error_is_that_of_repetitions():
    deviations = []
    for seed in range(60):
        noise = 0.1 * np.random.default_rng(seed).standard_normal(FREQUENCY.size)
        found = phase_delay(FREQUENCY, FRF, FRF * np.exp(1j * (noise - 2.0 * np.pi * FREQUENCY * 5e-3)), ONES)
        assert found is not None
        deviations.append((found.delay - 5e-3) / found.error)
    assert np.std(deviations) == pytest.approx(1.0, abs=0.27)  # three times 1 / sqrt(120)


def test_undefined_lines_do_not_count():
    holes = np.where(FREQUENCY < 45.0, FRF, np.nan)
    assert phase_delay(FREQUENCY, FRF, np.full(FREQUENCY.size, np.nan), ONES) is None
    found = phase_delay(FREQUENCY, holes, FRF * np.exp(-2j * np.pi * FREQUENCY * 1e-3), ONES)
    assert found is not None and found.delay == pytest.approx(1e-3, abs=1e-9)
