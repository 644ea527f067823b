"""Every drive gives its value and its true rate."""

import numpy as np
import pytest

from scenarios.lumped.input_signals import Sampled, Sine, ZeroSignal

TIME = np.linspace(0.0, 1.0, 201)


@pytest.mark.parametrize(
    "drive",
    [ZeroSignal(), Sine(amplitude=0.02, frequency=3.0, phase=0.4), Sampled(np.sin(5.0 * TIME), TIME[1])],
    ids=lambda drive: type(drive).__name__,
)
def test_the_rate_is_the_derivative_of_the_value(drive):
    step = 1e-6
    for time in (0.1, 0.237, 0.61, 0.9):
        difference = (drive.at(time + step)[0] - drive.at(time - step)[0]) / (2.0 * step)
        assert drive.at(time)[1] == pytest.approx(difference, abs=1e-8)  # rounding 1e-16/1e-6 and step^2 f'''


def test_samples_are_met_and_the_last_one_is_held():
    drive = Sampled([0.0, 1.0, 0.5], 0.1)
    assert [drive.at(t)[0] for t in (0.0, 0.1)] == pytest.approx([0.0, 1.0], abs=1e-12)
    assert drive.at(5.0) == (0.5, 0.0)


def test_a_sine_has_its_amplitude_and_phase():
    assert Sine(amplitude=2.0, frequency=1.0, phase=0.5 * np.pi).at(0.0)[0] == 2.0
    assert Sine(amplitude=2.0, frequency=4.0).at(1.0 / 16.0)[0] == pytest.approx(2.0, rel=1e-15)
