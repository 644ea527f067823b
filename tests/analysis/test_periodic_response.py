import numpy as np
import pytest
from scipy.signal import lsim

from tests.analysis.oscillator import state_space, transmissibility
from vehicle.analysis.periodic_response import periodic_response
from vehicle.errors import ConfigurationError, DataError

STEP = 2e-4
PERIOD = 2.0
LENGTH = 10_000


def multisine(periods):
    """Lines from 0.5 to 60 Hz with quadratic phases (Schroeder)."""
    line = np.arange(1, 121)
    time = np.arange(LENGTH) * STEP
    wave = np.cos(2 * np.pi * np.outer(time, line / PERIOD) - np.pi * line**2 / line.size).sum(axis=1)
    return np.tile(wave, periods)


@pytest.fixture(scope="module")
def simulated():
    excitation = multisine(4)
    _, response, _ = lsim(state_space(), excitation, np.arange(excitation.size) * STEP)
    return excitation, response


def test_an_oscillator_integrated_in_time_shows_its_analytic_response(simulated):
    excitation, response = simulated
    found = periodic_response(STEP, excitation, response, period_s=PERIOD, skip_periods=2)
    assert found.frequency == pytest.approx(np.arange(1.0, 50.25, 0.5))
    assert found.periods == 2
    # the plate moves linearly between samples: (pi f dt)^2 / 3 = 3.3e-4 at 50 Hz; the transient has fallen by
    # exp(-0.1 * 2 pi * 8 * 4) = 2e-9
    assert np.abs(found.response[0] / transmissibility(found.frequency) - 1.0).max() < 4e-4
    assert found.repeatability[0] < 1e-6


def test_what_is_left_of_the_transient_shows_in_the_repeatability(simulated):
    excitation, response = simulated
    early = periodic_response(STEP, excitation, response, period_s=PERIOD, skip_periods=0)
    late = periodic_response(STEP, excitation, response, period_s=PERIOD, skip_periods=2)
    assert early.repeatability[0] > 1e-2
    assert late.repeatability[0] < 1e-4 * early.repeatability[0]
    single = periodic_response(STEP, excitation, response, period_s=PERIOD, skip_periods=3)
    assert np.isnan(single.repeatability[0])


def test_only_excited_lines_are_returned():
    time = np.arange(4 * LENGTH) * STEP
    wave = np.sin(2 * np.pi * 5.0 * time) + 0.1 * np.cos(2 * np.pi * 20.0 * time) + 3.0
    found = periodic_response(STEP, wave, [2.0 * wave, 0.0 * wave], period_s=PERIOD, skip_periods=1)
    assert found.frequency == pytest.approx([5.0, 20.0])
    assert found.response == pytest.approx(np.array([[2.0, 2.0], [0.0, 0.0]]), abs=1e-12)
    assert found.repeatability == pytest.approx([0.0, 0.0], abs=1e-10)


def test_a_period_that_is_no_whole_number_of_steps_is_refused():
    with pytest.raises(ConfigurationError, match=r"period_s: found 2.0001 s = 10000.5 time steps"):
        periodic_response(STEP, multisine(2), multisine(2), period_s=2.0001, skip_periods=0)


def test_no_whole_period_is_refused():
    with pytest.raises(DataError, match=r"20000 samples hold 2 whole periods of 10000 samples and 2 are skipped; at "):
        periodic_response(STEP, multisine(2), multisine(2), period_s=PERIOD, skip_periods=2)


def test_no_excited_line_is_refused():
    time = np.arange(2 * LENGTH) * STEP
    sine = np.sin(2 * np.pi * 100.0 * time)
    with pytest.raises(DataError, match="no line of its period is excited in 1 to 50 Hz"):
        periodic_response(STEP, sine, sine, period_s=PERIOD, skip_periods=0)


def test_a_negative_skip_is_refused():
    with pytest.raises(ConfigurationError, match="skip_periods: found -1"):
        periodic_response(STEP, multisine(2), multisine(2), period_s=PERIOD, skip_periods=-1)
