"""Plates that repeat, against the spline of a run; and what does not repeat."""

import numpy as np
import pytest

from vehicle import DataError, Signal
from vehicle.engines.simulation.recorded_acceleration import AHEAD, acceleration, acceleration_gain
from vehicle.engines.steady.plate_lines import plate_lines, require_period

PERIOD = 0.5


def plates(shift=0.0):
    """Two periods of an uneven motion of one plate, with a first sample that is not zero."""
    noise = np.random.default_rng(1).normal(size=100)
    values = np.append(np.tile(0.01 * np.cumsum(noise - noise.mean()), 2), 0.0)
    values[-1] = values[0] + shift
    return Signal(time=np.linspace(0.0, 2.0 * PERIOD, 201), displacement={"fl": 0.003 + values}, source="noise")


def test_the_lines_are_those_of_the_spline_of_a_run():
    signal, count = plates(), 1600
    lines = plate_lines(signal, ("fr", "fl"), PERIOD, count)
    # Times of the second period, far from the ends of the record.
    time = np.linspace(0.5 * PERIOD, 1.5 * PERIOD, 80)
    expected = signal.plate_motion(time, ["fl"])
    # Lines above 16 sampling rates are left out.
    waves = np.exp(2j * np.pi * np.outer(time, np.arange(count)) / PERIOD)
    np.testing.assert_allclose((waves @ lines[1]).real, expected.displacement["fl"] - signal.displacement["fl"][0],
                               atol=2e-8)  # fmt: skip
    speed = 2j * np.pi * np.arange(count) / PERIOD
    np.testing.assert_allclose((waves @ (speed * lines[1])).real, expected.velocity["fl"], atol=3e-4)
    assert not lines[0].any()


@pytest.mark.parametrize(
    ("signal", "message"),
    [
        (plates(2e-3), "plate fl ends 2 mm above its start, so it does not repeat; cut the signal to whole periods"),
        (Signal(time=np.arange(40) / 100, displacement={"fl": np.full(40, 0.1)}), "no plate moves"),
    ],
)
def test_what_does_not_repeat_is_refused(signal, message):
    with pytest.raises(DataError) as raised:
        require_period(signal, 0.0)
    assert message in str(raised.value)


@pytest.mark.parametrize("frequency", [3.0, 90.0, 300.0])
def test_the_gain_is_that_of_a_recorded_acceleration(frequency):
    interval = 1e-3
    time = interval * np.arange(1200 + AHEAD)
    recorded = acceleration(np.cos(2.0 * np.pi * frequency * time), interval)[600:1000]
    gain = acceleration_gain(np.array([2.0 * np.pi * frequency * interval]))[0] / interval**2
    np.testing.assert_allclose(recorded, gain * np.cos(2.0 * np.pi * frequency * time[600:1000]), atol=1e-6 * abs(gain))
