"""Further tests of a damper: the expected uncertainty against made records, and the tests that are named."""

import dataclasses

import numpy as np
import pytest

from tests.validation import validated
from vehicle.digits import number
from vehicle.runs.car import Car
from vehicle.studies.dampers.damper_fit import DamperFit, deviations, finished
from vehicle.studies.dampers.damper_force import steady_force
from vehicle.studies.dampers.damper_law import SOFT_STEP, DamperLaw
from vehicle.studies.dampers.damper_test import DamperTest
from vehicle.studies.dampers.fitted_damper import FittedDamper
from vehicle.studies.dampers.next_tests import (
    Design,
    Quantity,
    Use,
    even_use,
    next_sentence,
    next_tests,
    result_sentences,
)
from vehicle.studies.dampers.use_in_car import use_in_car
from vehicle.studies.dampers.waveform import waveform_of

LAW, TRUE = DamperLaw(bends=1, friction="coulomb"), np.array([150.0, 5000.0, 1200.0, 0.06, 40.0])
SIZE = np.geomspace(2e-3, 0.12, 12)
INSIDE = Use(np.concatenate([-SIZE[::-1], SIZE]))


def curve(v):
    return 1200.0 * v + 3800.0 * np.clip(v, -0.06, 0.06) + 40.0 * np.clip(v / SOFT_STEP, -1.0, 1.0)


def record(amplitude, frequency, rng):
    """Four cycles of the damper with 400 samples, noise of 5 N."""
    t = np.arange(400) / (100.0 * frequency)
    phase = 2.0 * np.pi * frequency * (t + 1e-3 / frequency)
    x, v = amplitude * np.sin(phase), 2.0 * np.pi * frequency * amplitude * np.cos(phase)
    force = curve(v) - 150.0
    force += 5.0 * rng.standard_normal(t.size)
    return DamperTest(name=f"{amplitude}", time=t, displacement=x, velocity=v, force=force,
                      waveform=waveform_of(t, x, v), conditions={}, notices=())  # fmt: skip


def fitted_to(tests):
    """The law of the damper fitted to tests, alone within the tolerance."""
    quiet = {name: np.zeros((2, len(tests))) for name in ("slower", "faster")}
    fit = DamperFit(law=LAW, parameters=TRUE, left_out=np.full(len(tests), 0.02), ranges=quiet, accepted=True)
    fit = finished(tests, fit)
    return FittedDamper(conditions={}, tests=tests, fit=fit, compared=[fit])


def test_the_expected_uncertainty_is_the_scatter_of_fits_with_the_further_test():
    """The RMS of 30 fits scatters by 9 %; fits weight a test by its force, not by its noise: 16 % more is left."""
    rng, weights = np.random.default_rng(2), INSIDE.weights(curve(INSIDE.velocity))
    errors, stated = [], []
    for _ in range(30):
        tests = [record(0.02, 1.0, rng), record(0.004, 5.0, rng)]
        first, then = fitted_to(tests), fitted_to([*tests, record(0.02, 0.05, rng)])
        forces = [steady_force(LAW, each.fit.parameters, INSIDE.velocity)[0] for each in (first, then)]
        errors.append([weights @ (force - curve(INSIDE.velocity)) ** 2 for force in forces])
        design = Design(first, INSIDE)
        stated.append([design.uncertainty()[0] ** 2, design.uncertainty(0.02, 0.05)[0] ** 2])
    true, expected = np.sqrt(np.mean(errors, axis=0)), np.sqrt(np.mean(stated, axis=0))
    assert true[1] < 0.65 * true[0]
    validated(
        "Statistics and intervals",
        "expected uncertainty of the force of a damper over the scatter of 30 fits, without and with a slow test",
        expected / true, 1.0, abs=0.25, source="second derivation: records made from the law, each fitted again",
    )  # fmt: skip


def test_the_test_that_separates_two_laws_comes_first():
    """Coulomb friction, or a steep curve up to 5 mm/s: fast sines hardly show it; both have 40 N beyond."""
    rng = np.random.default_rng(3)
    fitted = fitted_to([record(0.02, 1.0, rng), record(0.004, 5.0, rng)])
    steep = dataclasses.replace(
        fitted.fit, law=DamperLaw(bends=2), parameters=np.array([150.0, 13000.0, 5000.0, 1200.0, 0.005, 0.055]),
        spreads=np.zeros((2, 6, 6)),
    )  # fmt: skip
    both = dataclasses.replace(fitted, compared=[fitted.fit, steep])
    tests = next_tests([both], even_use()._replace(velocity=INSIDE.velocity))
    assert tests[0].velocity < 0.006 and tests[0].after < 0.5 * tests[0].before
    assert tests[-1].after > 0.9 * tests[-1].before
    assert next_sentence(tests).startswith("a sine of ") and next_sentence(tests[-1:]).startswith("no further sine")
    # Two conditions count alike: the test of one of them leaves the other as it is.
    at = [dataclasses.replace(each, conditions={"current": i}) for i, each in enumerate((both, fitted))]
    two = next_tests(at, Use(INSIDE.velocity))
    rest = Design(fitted, INSIDE).uncertainty()[0]
    assert two[0].condition == "current 0" and " at current 0 would reduce" in next_sentence(two)
    assert two[0].after == pytest.approx(np.sqrt(0.5 * (tests[0].after ** 2 + rest**2)))


def test_a_bend_above_the_tests_needs_a_faster_test():
    rng = np.random.default_rng(3)
    fitted = fitted_to([record(0.02, 1.0, rng), record(0.004, 5.0, rng)])
    fast = next_tests([fitted])[0]
    assert fast.velocity == pytest.approx(1.0, rel=0.03) and fast.after < 0.3 * fast.before


def test_a_result_of_a_car_depends_on_the_force_at_its_velocities():
    """The variance of c'F is c' cov F c; a result of the force at 2 mm/s alone asks for the slow test."""
    rng = np.random.default_rng(3)
    fitted = fitted_to([record(0.02, 1.0, rng), record(0.004, 5.0, rng)])
    slopes = np.where(INSIDE.velocity == SIZE[0], 0.5, 0.0)
    use = INSIDE._replace(quantities=(Quantity("share", "30 %", slopes, "points"),))
    (text,) = result_sentences(next_tests([fitted], use), use)
    spread = deviations(fitted.fit.spreads, steady_force(LAW, fitted.fit.parameters, SIZE[:1])[1])[0]
    assert f"the share, 30 %, has an uncertainty of {number(0.5 * spread, 2)} points; a sine of " in text
    assert "up to 2 mm/s, would reduce it to " in text


def test_use_in_a_car(monkeypatch):
    """Slopes of two runs each: an octave near 0.5 m/s is not reached on class A; more friction sticks more."""
    monkeypatch.setattr("vehicle.studies.dampers.use_in_car.DURATION", 4.0)
    monkeypatch.setattr("vehicle.studies.dampers.use_in_car.PER_OCTAVE", 20)
    use = use_in_car(Car.load("focus_road"), ("A",))
    assert use.shares is not None and "class A at 80 km/h" in use.caption
    assert np.sum(use.shares) == pytest.approx(1.0)
    # Slow on class A: half of the time below 50 mm/s, and as much bump as rebound.
    assert np.sum(use.shares[np.abs(use.velocity) < 0.05]) > 0.5
    assert np.sum(use.shares[use.velocity > 0.0]) == pytest.approx(0.5, abs=0.1)
    stuck, comfort = (each.slopes[use.velocity > 0.0] for each in use.quantities)
    assert stuck[np.argmax(np.abs(stuck))] > 0.0 and np.max(comfort) > 0.0
