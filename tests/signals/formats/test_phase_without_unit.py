"""The unit of a phase column that states none: radians within a turn of 2 pi, otherwise degrees."""

import numpy as np
import pytest

from vehicle.errors import DataError
from vehicle.signals.formats.channel import Channel
from vehicle.signals.formats.spectrum_columns import joined

FREQUENCY = np.linspace(1.0, 50.0, 400)
RESPONSE = 3.0e3 / (1.0 - (FREQUENCY / 12.0) ** 2 + 0.3j * FREQUENCY / 12.0) * np.exp(-2j * np.pi * 0.004 * FREQUENCY)


def read(phase, response=RESPONSE):
    columns = [
        Channel(name=name, values=values, unit=unit, axis=FREQUENCY, kind="frequency", function="spectrum")
        for name, values, unit in (("H magnitude", np.abs(response), "m/s2/m"), ("H phase", phase, ""))
    ]
    (channel,) = joined("a.csv", columns)
    return channel


@pytest.mark.parametrize("turn", ["within pi", "from 0"])
def test_a_phase_within_a_turn_is_in_radians(turn):
    """It was read in degrees: FRAC 0.04 for 0.10, without a word in `compare`."""
    phase = np.angle(RESPONSE)
    channel = read(phase if turn == "within pi" else np.mod(phase, 2.0 * np.pi))
    np.testing.assert_allclose(channel.values, RESPONSE, rtol=1e-9)
    assert "is read in radians, because all values lie within a turn of 2 pi" in channel.remark


@pytest.mark.parametrize("phase", [np.degrees(np.angle(RESPONSE)), np.degrees(np.unwrap(np.angle(RESPONSE)))])
def test_a_phase_beyond_a_turn_is_in_degrees(phase):
    channel = read(phase)
    np.testing.assert_allclose(channel.values, RESPONSE, rtol=1e-9)
    assert "is read in degrees, because its values exceed 45" in channel.remark


@pytest.mark.parametrize("part", [slice(0, 40), slice(0, 12)])
@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_a_narrow_band_in_degrees_is_asked(part, scale):
    """Below the resonance the phase is -0.1 to -6 degrees and the magnitude rises: no radians."""
    response = np.exp(-1j * np.radians(np.linspace(0.1, 3.0 * scale, 400)[part])) * np.linspace(1.0, 4.0, 400)[part]
    phase = np.degrees(np.angle(response))
    columns = [
        Channel(name=name, values=values, unit="", axis=FREQUENCY[part], kind="frequency", function="spectrum")
        for name, values in (("H magnitude", np.abs(response)), ("H phase", phase))
    ]
    with pytest.raises(DataError, match=r"'H phase' has no unit, .*H phase \[deg\]"):
        joined("a.csv", columns)


def test_unwrapped_radians_are_asked():
    with pytest.raises(DataError, match=r"'H phase' has no unit, .* 24\.6"):
        read(-np.linspace(0.1, 24.6, 400))


def test_radians_that_jump_by_a_turn_need_no_resonance():
    delay = np.exp(-2j * np.pi * 0.1 * FREQUENCY)
    np.testing.assert_allclose(read(np.angle(delay), delay).values, delay, rtol=1e-9)
