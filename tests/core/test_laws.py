"""Laws of the core against their classes, which have the equations and are tested by closed forms."""

import dataclasses
import itertools

import numpy as np
import pytest

from scenarios.lumped.half_car_rider_parameters import half_car_rider_parameters
from tests.core import laws
from vehicle.model.laws.control_laws import act, at_rest, demanded, in_steps, pack
from vehicle.model.laws.curve import Curve
from vehicle.model.laws.damper import FRICTION, RECORD
from vehicle.model.parameters.force_elements import NUMBERS
from vehicle.model.parameters.semi_active_damper import LAWS

SPEEDS = (-2.0, -0.3, -1e-9, -1e-300, 0.0, 1e-300, 1e-9, 0.3, 2.0, 1e20)


@pytest.mark.parametrize("word", FRICTION)
@pytest.mark.parametrize("exponent", [0.5, 1.0, 2.0, 20.0])
def test_friction_limits(word, exponent):
    record = np.zeros(1, dtype=RECORD)
    numbers = dict.fromkeys(NUMBERS.get(word, ()), 0.7) | {
        "friction_limit": 65.0, "static_limit": 125.0, "stribeck_velocity": 0.03, "stribeck_exponent": exponent,
    }  # fmt: skip
    for name in numbers.keys() & set(record.dtype.names or ()):
        record[name] = numbers[name]
    record["smoothing"], record["friction_law"] = 1e5, list(FRICTION).index(word)
    law = FRICTION[word](**{entry.name: float(record[entry.name][0]) for entry in dataclasses.fields(FRICTION[word])})
    for speed in (*SPEEDS, 0.03, 0.05):
        assert laws.friction_limit(record, speed) == pytest.approx(float(law.limit(speed)), rel=1e-14)


@pytest.mark.parametrize("law", LAWS)
def test_control_laws(law):
    record = in_steps(pack(dataclasses.replace(half_car_rider_parameters().semi_active, law=law)), 1e-3)
    for body, wheel in itertools.product(SPEEDS[:-1], SPEEDS[:-1]):
        assert laws.demanded(record, body, wheel) == pytest.approx(float(demanded(record, body, wheel)), rel=1e-14)


def test_period_delay_and_rate():
    control = dataclasses.replace(
        half_car_rider_parameters().semi_active, law="skyhook", control_period=3e-3, delay=2e-3, rate=2e5
    )
    record = in_steps(pack(control), 1e-3)
    past, expected = at_rest(record), at_rest(record)
    for step, (body, wheel) in enumerate(np.random.default_rng(7).normal(size=(200, 2)) * 0.3):
        laws.act(record, step, body, wheel, past)
        act(record, step, body, wheel, expected)
        np.testing.assert_allclose(past, expected, rtol=1e-13)
    assert np.ptp(past) > 0.0


def test_curves():
    curve = Curve.through([-1.0, -0.2, 0.0, 0.3, 2.0], [-900.0, -300.0, 0.0, 100.0, 1500.0])
    edges = [*curve.knots, np.inf]
    for x in (-5.0, -1.0, -0.2, -0.1, 0.0, 0.1, 0.3, 0.5, 7.0):
        expected = float(curve.force(x))
        assert laws.curve_force(x, edges, curve.slopes, curve.offsets) == pytest.approx(expected, rel=1e-14, abs=1e-12)
