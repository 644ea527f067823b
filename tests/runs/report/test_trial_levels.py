"""Levels in the section "Try it", computed in a real browser, against `Car.levels`."""

import time

import numpy as np
import pytest

from tests.runs.report.test_trial import STRIBECK, Page, car_of, shipped
from vehicle.handover.page.level_numbers import FREQUENCY, LEVEL, level_numbers
from vehicle.runs.car import Car


@pytest.mark.usefixtures("one_car")
def test_levels_of_the_page_are_those_of_the_program(browser, record_property):
    car, signal = shipped("low.csv")
    page = Page(browser, car, signal)
    states: list[dict[str, float]] = [
        {},
        {"front-coulomb_friction": 30.0, "front-curve_scale": 1.7},
        {"front-coulomb_friction": 0.0},
    ]
    for state in states:
        began = time.perf_counter()
        result = page.ask("levels", **state)
        record_property("seconds", round(time.perf_counter() - began, 2))
        size = np.reshape(result["size"], (FREQUENCY[2], LEVEL[2]))
        if state.get("front-coulomb_friction") == 0.0:
            # Without friction and with a straight curve the car is linear.
            assert np.ptp(size, axis=1) == pytest.approx(0.0, abs=1e-9 * np.max(size)) and not np.any(result["first"])
            continue
        taken = slice(3, None, 11)
        wanted = car_of(car, state).levels(frequency=np.geomspace(*FREQUENCY)[taken], level=np.geomspace(*LEVEL))
        # Rounding decides at which iteration a point ends, within 1e-7 of the largest force. Another damper curve is a
        # force beside the poles here, and other poles there: another iteration.
        deviation = np.abs(size[taken] / np.abs(wanted.frf[0]) - 1.0)
        assert np.max(deviation) < 1e-6
        assert "front-curve_scale" in state or np.quantile(deviation, 0.95) < 1e-9
        assert np.array(result["first"])[:, taken] == pytest.approx(wanted.first, rel=1e-9)


def test_levels_of_another_stiffness_are_left_out(browser):
    car, signal = shipped("low.csv")
    assert Page(browser, car, signal).ask("levels", **{"main-springs": 0.8}) is None


@pytest.mark.parametrize(
    "overrides",
    [
        STRIBECK,
        ("front.bushings.tyre.one_sided=true",),
        ("front.damper.friction_law=presliding", "front.damper.presliding_stiffness=1e6"),
    ],
    ids=["stribeck", "a tyre that lifts", "presliding"],
)
def test_a_car_with_other_laws_has_none(overrides):
    car, signal = shipped("low.csv", overrides)
    assert level_numbers(car, signal) is None


def test_a_rolling_car_has_none():
    car = Car.load("sedan", ("driving.speed=22.0",))
    assert level_numbers(car, shipped("low.csv")[1]) is None
