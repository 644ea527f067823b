import numpy as np
import pytest

from vehicle.errors import ConfigurationError, DataError
from vehicle.names import slip_words
from vehicle.signals.analysis.slip import first_slip, slip_intervals, slip_share

TIME = np.arange(10) * 0.5
VELOCITY = np.array([0.0, 0.1, -0.2, 0.3, 0.0, 0.0, -0.3, 0.1, 0.0, 0.5])


def test_share_counts_samples_above_the_limit_in_both_directions():
    assert slip_share(VELOCITY, 0.15) == 0.4
    # a sample exactly at the limit does not slip
    assert slip_share(VELOCITY, 0.3) == 0.1
    assert slip_share(VELOCITY, 1.0) == 0.0


def test_share_of_a_sine_is_its_closed_form():
    phase = (np.arange(100_000) + 0.5) * 2 * np.pi / 100_000
    # |sin| > s during 1 - 2/pi asin(s) of a period; the grid resolves 4 crossings of 1e-5 each
    assert slip_share(np.sin(phase), 0.6) == pytest.approx(1 - 2 / np.pi * np.arcsin(0.6), abs=4e-5)


def test_first_slip_is_the_first_sample_above_or_none():
    assert first_slip(TIME, VELOCITY, 0.15) == 1.0
    assert first_slip(TIME, VELOCITY, 0.4) == 4.5
    assert first_slip(TIME, VELOCITY, 0.5) is None


def test_intervals_start_above_and_end_back_below():
    assert slip_intervals(TIME, VELOCITY, 0.15) == pytest.approx(np.array([[1.0, 2.0], [3.0, 3.5], [4.5, 4.5]]))
    assert slip_intervals(TIME, VELOCITY, 1.0).shape == (0, 2)
    assert slip_intervals(TIME, np.ones(10), 0.5) == pytest.approx(np.array([[0.0, 4.5]]))


@pytest.mark.parametrize(
    ("limits", "words"),
    [
        ({"fr": 0.006, "fl": 0.006, "rr": 0.006}, "6"),
        ({"fr": 0.006, "fl": 0.006, "rr": 0.02, "rl": 0.02}, "6 (front) and 20 (rear)"),
        ({"fr": 0.006, "fl": 0.006, "rr": 0.02, "rl": 0.006}, "6 (front, rear left) and 20 (rear right)"),
        ({"fr": 0.006, "fl": 0.02}, "6 (right) and 20 (left)"),
        ({}, ""),
    ],
)
def test_limits_in_words_name_dampers_only_where_they_differ(limits, words):
    assert slip_words(limits, list(limits)) == words


@pytest.mark.parametrize("limit", [-1e-3, np.nan, np.inf])
def test_a_slip_velocity_out_of_range_is_refused(limit):
    with pytest.raises(ConfigurationError, match="slip velocity: found"):
        slip_share(VELOCITY, limit)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: slip_share([0.0, np.nan], 0.1), "damper velocity: found nan at sample 1"),
        (lambda: slip_share(np.ones((2, 5)), 0.1), "damper velocity: found 2 signals"),
        (lambda: first_slip(TIME[:-1], VELOCITY, 0.1), "time: found 9 samples, .* 10"),
        (lambda: first_slip(np.zeros(10), VELOCITY, 0.1), "time: found 0 s at sample 1"),
    ],
)
def test_bad_records_are_refused(call, message):
    with pytest.raises(DataError, match=message):
        call()
