"""Units, rates and steps of a channel, which every reader of a file relies on."""

import numpy as np
import pytest

from vehicle.errors import DataError
from vehicle.signals.formats.channel import Channel, check_length, clock_step, even_step, exact_rate, uniform_axis

VALUES = np.array([1.0, -2.0, 4.0])


@pytest.mark.parametrize(
    ("unit", "quantity", "si", "factor"),
    [
        ("g", "acceleration", "m/s2", 9.80665),
        ("mm", "displacement", "m", 1e-3),
        ("kN", "force", "N", 1e3),
        ("km/h", "velocity", "m/s", 1.0 / 3.6),
        ("m", "displacement", "m", 1.0),
        ("", "", "", 1.0),
        ("bananas", "", "", 1.0),
    ],
)
def test_values_in_the_unit_of_the_file_and_in_si(unit, quantity, si, factor):
    channel = Channel(name="a", values=VALUES, unit=unit)
    assert (channel.unit, channel.quantity, channel.si_unit) == (unit, quantity, si)
    np.testing.assert_allclose(channel.si_values, factor * VALUES, rtol=1e-12)


def test_a_channel_in_a_line():
    channel = Channel(name="seat", values=VALUES, unit="g", axis=uniform_axis(3, 0.004))
    assert repr(channel) == "Channel('seat' [g], 3 values, 250 Hz)"
    assert repr(Channel(name="seat", values=VALUES)) == "Channel('seat' [], 3 values)"


@pytest.mark.parametrize(
    ("times", "rate"),
    [
        (0.5 + np.arange(20) / 250.0, 250.0),
        (np.concatenate([np.arange(20) / 250.0, 1.0 + np.arange(40) / 100.0]), 100.0),  # of the longest part
        (np.array([0.0, 0.01, 0.01, 0.02, 0.03, 0.04]), 100.0),  # a repeated stamp: by the median step
        (np.array([0.0]), None),
    ],
)
def test_rate(times, rate):
    found = Channel(name="a", values=np.zeros(times.size), axis=times).rate
    assert found == (rate if rate is None else pytest.approx(rate, rel=1e-12))
    assert Channel(name="a", values=np.zeros(times.size), axis=times, kind="frequency").rate is None


def test_a_rate_that_is_whole_but_for_round_off():
    assert exact_rate(99.99999999999) == 100.0 and exact_rate(100.0000002) == 100.0000002
    assert exact_rate(1e-12) == 1e-12


def test_an_axis_is_even_within_a_hundredth_of_its_step():
    axis = uniform_axis(5, 0.2, 3.0)
    np.testing.assert_allclose(axis, [3.0, 3.2, 3.4, 3.6, 3.8])
    assert even_step(axis) == pytest.approx(0.2)
    for away, even in ((0.0015, True), (0.0025, False), (-0.0025, False)):
        moved = axis + away * (np.arange(5) == 2)
        assert (even_step(moved) is not None) == even
    assert even_step(axis[::-1]) == pytest.approx(-0.2)


@pytest.mark.parametrize(
    ("written", "digits", "step", "rate"),
    [
        (1.52588e-05, 6, 1.0 / 65536.0, 65536),
        (3.90625e-05, 6, 3.90625e-05, None),  # exact as it is
        (4.8828e-4, 5, 1.0 / 2048.0, 2048),
        (0.0007, 6, 0.0007, None),  # of no whole rate
        (1.52588e-05, 7, 1.52588e-05, None),  # seven digits would be 1.525879e-05
        (2.0, 6, 2.0, None),
        (0.0, 6, 0.0, None),
    ],
)
def test_a_step_that_was_rounded_to_its_digits(written, digits, step, rate):
    found, remark = clock_step(written, digits)
    assert found == pytest.approx(step, rel=1e-15)
    assert remark == (
        "" if rate is None else f"time step {written:.9g} s is rounded; the sampling rate is assumed to be {rate} Hz"
    )


def test_a_header_that_claims_more_than_the_file_has(tmp_path):
    check_length(tmp_path, 80.0, 80.0, "its header")
    for claimed in (81.0, -1.0):
        with pytest.raises(DataError, match=f"header states {claimed:.0f} bytes of data, but the file has only 80"):
            check_length(tmp_path, claimed, 80.0, "its header")
