"""Semi-active laws: limits, direction of the force, limiting cases."""

import dataclasses
import itertools

import numpy as np
import pytest

from vehicle.errors import ConfigurationError
from vehicle.lumped.semi_active import LAWS, damping_coefficient
from vehicle.parameters.half_car_rider import half_car_rider_parameters

DAMPER = half_car_rider_parameters().semi_active
SPEEDS = np.array([-2.0, -0.3, -1e-9, -1e-300, 0.0, 1e-300, 1e-9, 0.3, 2.0])
BODY, WHEEL = (np.array(axis) for axis in zip(*itertools.product(SPEEDS, SPEEDS), strict=True))


@pytest.mark.parametrize("law", LAWS)
def test_setting_stays_within_the_damper(law):
    setting = damping_coefficient(law, DAMPER, BODY, WHEEL)
    assert setting.min() >= DAMPER.minimum_damping
    assert setting.max() <= DAMPER.maximum_damping
    # c v opposes v with c > 0: no power ever comes out
    assert np.all(setting * (BODY - WHEEL) ** 2 >= 0.0)


@pytest.mark.parametrize(
    ("law", "wanted"),
    [
        ("skyhook", lambda b, w: 3000.0 * b),
        ("groundhook", lambda b, w: -3000.0 * w),
        ("hybrid", lambda b, w: 1500.0 * b - 1500.0 * w),
    ],
)
def test_continuous_law_comes_nearest_to_the_force_it_asks_for(law, wanted):
    rng = np.random.default_rng(4)
    body, wheel = rng.normal(size=(2, 300))
    parting = body - wheel
    force = damping_coefficient(law, DAMPER, body, wheel) * parting
    candidates = np.linspace(DAMPER.minimum_damping, DAMPER.maximum_damping, 2001)[:, None] * parting
    best = np.abs(candidates - wanted(body, wheel)).min(axis=0)
    # the candidates lie 1.35 N s/m apart: their best may miss by half of that
    assert np.all(np.abs(force - wanted(body, wheel)) <= best + 1e-9)


def test_on_off_skyhook_is_firm_only_where_the_damper_can_hold_the_body():
    setting = damping_coefficient("skyhook_on_off", DAMPER, [1.0, 1.0, -1.0, -1.0, 0.0], [0.5, 2.0, -0.5, -2.0, 1.0])
    np.testing.assert_array_equal(setting, [3000.0, 300.0, 3000.0, 300.0, 300.0])


def test_on_off_groundhook_is_firm_only_where_the_damper_can_hold_the_wheel():
    setting = damping_coefficient("groundhook_on_off", DAMPER, [0.5, 2.0, -0.5, -2.0], [1.0, 1.0, -1.0, -1.0])
    np.testing.assert_array_equal(setting, [3000.0, 300.0, 3000.0, 300.0])


@pytest.mark.parametrize(("share", "same"), [(1.0, "skyhook"), (0.0, "groundhook")])
@pytest.mark.parametrize("kind", ["", "_on_off"])
def test_hybrid_has_both_laws_as_limits(share, same, kind):
    damper = dataclasses.replace(DAMPER, skyhook_share=share)
    np.testing.assert_array_equal(
        damping_coefficient(f"hybrid{kind}", damper, BODY, WHEEL),
        damping_coefficient(f"{same}{kind}", damper, BODY, WHEEL),
    )


def test_unknown_law_is_refused():
    with pytest.raises(ConfigurationError) as caught:
        damping_coefficient("skyhok", DAMPER, 0.0, 0.0)
    assert str(caught.value) == f"semi-active law: found 'skyhok', allowed are {', '.join(LAWS)}"
