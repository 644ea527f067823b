"""Semi-active laws: limits, direction of the force, limiting cases; period, delay and rate."""

import dataclasses
import itertools

import numpy as np
import pytest

from scenarios.lumped.half_car_rider_parameters import half_car_rider_parameters
from tests.validation import validated
from vehicle.model.laws.control_laws import PRESENT, act, at_rest, demanded, in_steps, pack
from vehicle.model.parameters.semi_active_damper import LAWS

DAMPER = half_car_rider_parameters().semi_active
SPEEDS = np.array([-2.0, -0.3, -1e-9, -1e-300, 0.0, 1e-300, 1e-9, 0.3, 2.0])
BODY, WHEEL = (np.array(axis) for axis in zip(*itertools.product(SPEEDS, SPEEDS), strict=True))


def setting(law, body, wheel, **changes):
    control = dataclasses.replace(DAMPER, law=law, **changes)
    return demanded(in_steps(pack(control), 1e-3), np.asarray(body, dtype=float), np.asarray(wheel, dtype=float))


@pytest.mark.parametrize("law", LAWS)
def test_setting_stays_within_the_damper(law):
    found = setting(law, BODY, WHEEL)
    assert found.min() >= DAMPER.minimum_damping
    assert found.max() <= DAMPER.maximum_damping
    # c v opposes v with c > 0: no power ever comes out
    assert np.all(found * (BODY - WHEEL) ** 2 >= 0.0)
    one_by_one = [float(setting(law, b, w)) for b, w in zip(BODY, WHEEL, strict=True)]
    np.testing.assert_array_equal(found, one_by_one)


@pytest.mark.parametrize(("law", "wanted"), [
    ("skyhook", lambda b, w: 3000.0 * b),
    ("groundhook", lambda b, w: -3000.0 * w),
    ("hybrid", lambda b, w: 1500.0 * np.where(b * (b - w) > 0, b, 0) - 1500.0 * np.where(w * (b - w) < 0, w, 0)),
])  # fmt: skip
def test_continuous_law_comes_nearest_to_the_force_it_asks_for(law, wanted):
    rng = np.random.default_rng(4)
    body, wheel = rng.normal(size=(2, 300))
    parting = body - wheel
    force = setting(law, body, wheel) * parting
    candidates = np.linspace(DAMPER.minimum_damping, DAMPER.maximum_damping, 2001)[:, None] * parting
    best = np.abs(candidates - wanted(body, wheel)).min(axis=0)
    # the candidates lie 1.35 N s/m apart: their best may miss by half of that
    assert np.all(np.abs(force - wanted(body, wheel)) <= best + 1e-9)


def test_on_off_skyhook_is_firm_only_where_the_damper_can_hold_the_body():
    found = setting("skyhook_on_off", [1.0, 1.0, -1.0, -1.0, 0.0], [0.5, 2.0, -0.5, -2.0, 1.0])
    np.testing.assert_array_equal(found, [3000.0, 300.0, 3000.0, 300.0, 300.0])


def test_on_off_groundhook_is_firm_only_where_the_damper_can_hold_the_wheel():
    found = setting("groundhook_on_off", [0.5, 2.0, -0.5, -2.0], [1.0, 1.0, -1.0, -1.0])
    np.testing.assert_array_equal(found, [3000.0, 300.0, 3000.0, 300.0])


@pytest.mark.parametrize(("share", "same"), [(1.0, "skyhook"), (0.0, "groundhook")])
@pytest.mark.parametrize("kind", ["", "_on_off"])
def test_hybrid_has_both_laws_as_limits(share, same, kind):
    found = setting(f"hybrid{kind}", BODY, WHEEL, skyhook_share=share)
    np.testing.assert_array_equal(found, setting(f"{same}{kind}", BODY, WHEEL))


def test_hybrid_on_off_switches_by_its_shares():
    found = setting("hybrid_on_off", [1.0, 0.5, 1.0, 0.0], [0.5, 1.0, -1.0, 0.0], skyhook_share=0.3)
    validated(
        "Semi-active dampers", "settings of the hybrid on-off law, share 0.3", found,
        np.array([300.0 + 0.3 * 2700.0, 300.0 + 0.7 * 2700.0, 3000.0, 300.0]), rel=1e-14, unit="N s/m",
        source="closed form: table of the law by hand",
    )  # fmt: skip


TIME = 1e-3 * np.arange(2000)
MOTION = np.sin(2.0 * np.pi * 1.3 * TIME), np.sin(2.0 * np.pi * 11.0 * TIME + 0.4)


def coefficients(law="skyhook", parts=1, **changes):
    """Coefficient over the motion, in steps of 1 ms or parts of it."""
    numbers = in_steps(pack(dataclasses.replace(DAMPER, law=law, **changes)), 1e-3 / parts)
    past, found = at_rest(numbers), []
    for step, (body, wheel) in enumerate(np.repeat(np.transpose(MOTION), parts, axis=0)):
        act(numbers, step, body, wheel, past)
        found.append(past[PRESENT])
    return np.array(found)


@pytest.mark.parametrize("law", LAWS)
def test_without_delay_and_limit_of_rate_the_damper_is_as_asked(law):
    np.testing.assert_array_equal(coefficients(law), setting(law, *MOTION))


def test_a_delay_shifts_the_setting_by_itself():
    ideal, late = coefficients(), coefficients(delay=0.017)
    np.testing.assert_array_equal(late[17:], ideal[:-17])
    np.testing.assert_array_equal(late[:17], DAMPER.minimum_damping)


def test_a_period_holds_the_setting():
    np.testing.assert_array_equal(coefficients(control_period=0.01), np.repeat(coefficients()[::10], 10))


def test_the_rate_limits_the_change_and_nothing_else():
    ideal, slow = coefficients("skyhook_on_off"), coefficients("skyhook_on_off", rate=4e5)
    validated(
        "Semi-active dampers", "largest change of a setting in 1 ms at a rate of 4e5 N s/m per s",
        np.max(np.abs(np.diff(slow))), 400.0, rel=1e-12, unit="N s/m", source="closed form: rate times step",
    )  # fmt: skip
    # from soft to firm in 2700/400 steps: seven steps after each switch it is there
    settled = np.array([np.ptp(ideal[max(i - 7, 0) : i + 1]) == 0.0 for i in range(len(ideal))])
    assert np.mean(settled) > 0.5
    np.testing.assert_allclose(slow[settled], ideal[settled], rtol=1e-14)
    # A step is the mean of a ramp over it: the same as that of many short steps.
    fine = coefficients("skyhook_on_off", rate=4e5, parts=64)
    np.testing.assert_allclose(slow, fine.reshape(-1, 64).mean(axis=1), rtol=1e-12)
