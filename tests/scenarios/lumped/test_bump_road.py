"""Half-sine bump: shape, delay of the rear wheel, refusals."""

import numpy as np
import pytest

from scenarios.lumped.bump_response import bump_passage
from scenarios.lumped.half_car_rider_parameters import BumpShape
from tests.validation import validated
from vehicle.errors import ConfigurationError

SHAPE = BumpShape(height=0.05, length=0.5)


@pytest.mark.parametrize("speed", [20.0 / 3.6, 60.0 / 3.6, 0.3])
def test_rear_wheel_follows_after_the_wheelbase(speed):
    passage = bump_passage(SHAPE, speed, 2.8, start=0.1)
    assert passage.contact == pytest.approx(0.5 / speed)
    time = np.linspace(0.0, 0.1 + 4.0 / speed, 4001)
    front, _ = passage.heights(time)
    _, rear = passage.heights(time + 2.8 / speed)
    # evaluated at shifted times: rounding of the times, steep for short bumps
    np.testing.assert_allclose(rear, front, atol=1e-11)
    assert front.max() == pytest.approx(0.05, rel=1e-3)  # 4001 samples need not hit the crest
    validated(
        "Roads and excitation", f"height of the half-sine bump at its crest at {3.6 * speed:.3g} km/h",
        passage.heights(0.1 + 0.25 / speed)[0], 0.05, rel=1e-12, unit="m", source="closed form: h0 sin(pi x / length)",
    )  # fmt: skip


def test_height_is_zero_off_the_bump():
    passage = bump_passage(SHAPE, 5.0, 2.8, start=0.1)
    time = np.array([0.0, 0.0999, 0.1 + 0.1001, 5.0])
    assert np.abs(passage.heights(time)[0]).max() == 0.0
    assert np.abs(passage.rates(time)[0]).max() == 0.0


def test_rate_is_the_derivative_of_the_height():
    passage = bump_passage(SHAPE, 5.0, 2.8)
    time = np.linspace(0.002, 0.098, 50)
    step = 1e-6
    slope = (passage.heights(time + step) - passage.heights(time - step)) / (2.0 * step)
    np.testing.assert_allclose(passage.rates(time), slope, atol=1e-6)  # truncation h0 w^3 step^2 / 6 and rounding


@pytest.mark.parametrize(
    ("speed", "wheelbase", "start", "message"),
    [
        (0.0, 2.8, 0.0, "bump passage: speed: found 0.0 m/s, must be greater than 0.0"),
        (float("inf"), 2.8, 0.0, "bump passage: speed: found inf m/s, must be greater than 0.0"),
        (5.0, -1.0, 0.0, "bump passage: wheelbase: found -1.0 m/s, must be greater than 0.0"),
        (5.0, 2.8, -0.1, "bump passage: start: found -0.1 s, must be at least 0.0"),
    ],
)
def test_bad_values_are_refused(speed, wheelbase, start, message):
    with pytest.raises(ConfigurationError) as caught:
        bump_passage(SHAPE, speed, wheelbase, start)
    assert str(caught.value) == message.replace("-1.0 m/s", "-1.0 m")
