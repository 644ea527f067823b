import numpy as np
from scipy.signal import lsim

from tests.periodic import periodic_response
from tests.signals.analysis.oscillator import state_space, transmissibility

STEP = 2e-4
PERIOD = 2.0


def test_an_oscillator_integrated_in_time_shows_its_analytic_response():
    line = np.arange(1, 121)  # 0.5 to 60 Hz with quadratic phases (Schroeder)
    time = np.arange(round(PERIOD / STEP)) * STEP
    wave = np.cos(2 * np.pi * np.outer(time, line / PERIOD) - np.pi * line**2 / line.size).sum(axis=1)
    excitation = np.tile(wave, 4)
    _, response, _ = lsim(state_space(), excitation, np.arange(excitation.size) * STEP)
    frequency, found = periodic_response(STEP, excitation, response, period=PERIOD)
    np.testing.assert_allclose(frequency, np.arange(1.0, 50.25, 0.5))
    # the plate moves linearly between samples: (pi f dt)^2 / 3 = 3.3e-4 at 50 Hz; the transient has fallen by
    # exp(-0.1 * 2 pi * 8 * 6) = 8e-14
    assert np.abs(found / transmissibility(frequency) - 1.0).max() < 4e-4
