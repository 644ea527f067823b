"""Settling time and lift-off intervals."""

import numpy as np
import pytest

from scenarios.half_car_rider.runs import settling_time
from scenarios.lumped.bump_response import bump_passage, bump_response
from scenarios.lumped.half_car_rider_model import half_car_rider, lift_off, linear_tyre_load, static_tyre_load
from scenarios.lumped.half_car_rider_parameters import half_car_rider_parameters
from tests.validation import validated
from vehicle.errors import ConfigurationError

TIME = np.linspace(0.0, 10.0, 10001)


def test_exponential_settles_after_ln_of_the_band():
    # one sample
    validated(
        "Quarter and half cars", "settling time of an exponential to 5 %", settling_time(TIME, np.exp(-TIME), 0.05),
        np.log(20.0), abs=1e-3, unit="s", source="closed form: ln 20",
    )  # fmt: skip


def test_last_exit_counts_not_the_first_entry():
    ringing = np.exp(-0.5 * TIME) * np.cos(8.0 * TIME)
    time = settling_time(TIME, ringing, 0.05)
    assert time is not None
    assert np.abs(ringing[time < TIME]).max() <= 0.05 * np.abs(ringing).max()
    assert time > 4.0  # it enters the band for the first time at 0.18 s


def test_unsettled_and_silent_records():
    assert settling_time(TIME, np.ones_like(TIME), 0.05) is None
    assert settling_time(TIME, np.zeros_like(TIME), 0.05) == 0.0


@pytest.mark.parametrize("band", [0.0, 1.0, -0.1])
def test_bad_band_is_refused(band):
    with pytest.raises(ConfigurationError, match=f"settling time: band: found {band!r}, must be between 0 and 1"):
        settling_time(TIME, TIME, band)


def test_lift_off_intervals():
    load = np.array([1.0, -1.0, -2.0, 1.0, 0.0, 2.0, -1.0])
    assert lift_off(np.arange(7.0), load) == [(1.0, 2.0), (4.0, 4.0), (6.0, 6.0)]
    assert lift_off(np.arange(2.0), np.ones(2)) == []


def test_base_case_pulls_on_the_road_behind_the_bump():
    car = half_car_rider_parameters()
    history = bump_response(
        half_car_rider(car), bump_passage(car.bump, 20.0 / 3.6, 2.8, start=0.1), time_step=1e-3, duration=2.0
    )
    loads = linear_tyre_load(car, history)
    np.testing.assert_allclose(loads[:, 0], static_tyre_load(car))
    for load, arrival in zip(loads, (0.1, 0.1 + 2.8 * 3.6 / 20.0), strict=True):
        ((start, end),) = lift_off(history.time, load)
        # down the far side of the bump (contact 90 ms), and back before a quarter of the hop period (27 ms) is over
        assert arrival + 0.045 < start < arrival + 0.09 < end < arrival + 0.117


def test_tyre_loads_carry_all_inertia():
    """Sum of the tyre loads = weight + sum of mass times acceleration: Newton for the whole car."""
    car = half_car_rider_parameters()
    model = half_car_rider(car)
    history = bump_response(model, bump_passage(car.bump, 10.0, 2.8), time_step=1e-3, duration=1.0)
    vertical = np.array([0.0 if name == "pitch" else 1.0 for name in model.coordinates])
    masses = np.diag(model.mass) * vertical
    accelerations = np.array([history.acceleration(name) for name in model.coordinates])
    expected = masses @ accelerations + 9.81 * masses.sum()
    total = linear_tyre_load(car, history).sum(axis=0)
    validated(
        "Quarter and half cars", "sum of the tyre loads of the half car on a bump", total, expected, peak=1e-7,
        unit="N", source="conservation: Newton, weight and sum of m a",
    )  # fmt: skip
