"""A friction device with a gap, and the sentence on the mechanism that a law misses."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.studies.dampers.damper_choice import choose_law
from vehicle.studies.dampers.damper_fit import DamperFit, fit_law
from vehicle.studies.dampers.damper_force import force_and_slopes
from vehicle.studies.dampers.damper_law import DamperLaw
from vehicle.studies.dampers.damper_test import DamperTest
from vehicle.studies.dampers.fitted_damper import FittedDamper
from vehicle.studies.dampers.residual_diagnosis import missing_mechanism, missing_text
from vehicle.studies.dampers.waveform import waveform_of

SUBJECT = "Sweeps, tuning and optimisation"
GAP, LIMIT, STIFFNESS, FINE = 6.8e-3, 800.0, 4e6, 10
MOTIONS = ((0.02, 0.5, 8.0), (0.01, 1.0, 4.0), (0.025, 0.2, 15.0))
SIMPLE = {"gas_force": 0.0, "damping_1": 100.0, "slider_limit_1": 500.0, "slider_stroke_1": 5e-3} | {
    "slider_limit_2": 300.0, "slider_stroke_2": 1e-4, "velocity_1": 0.05, "friction": 40.0, "damping_2": 1000.0,
}  # fmt: skip


def device(outer=0.0, seed=0):
    """Three sines of a slider behind a stiffness and a gap, with 2 % noise."""
    tests, rng, end = [], np.random.default_rng(seed), 0.5 * GAP + LIMIT / STIFFNESS
    for amplitude, frequency, duration in MOTIONS:
        count = round(duration * 200.0)
        time = np.arange(count * FINE) / (200.0 * FINE)
        w = 2.0 * np.pi * frequency
        x, v = amplitude * np.sin(w * time), amplitude * w * np.cos(w * time)
        deflections, slider = [], -end
        for each in x.tolist():
            slider = min(max(slider, each - end), each + end)
            deflections.append(each - slider)
        s = np.array(deflections)
        force = (STIFFNESS * (s - np.clip(s, -0.5 * GAP, 0.5 * GAP)) + outer * np.sign(v))[::FINE]
        force = force + 0.02 * np.std(force) * rng.standard_normal(count)
        tests.append(made(time[::FINE], x[::FINE], v[::FINE], force))
    return tests


def made(time, x, v, force):
    """A test with these samples."""
    return DamperTest(name="sine", time=time, displacement=x, velocity=v, force=force,
                      waveform=waveform_of(time, x, v), conditions={}, notices=())  # fmt: skip


def fitted(tests, law):
    """The law fitted to tests, without a choice."""
    start = SIMPLE | ({"damping_1": 4000.0} if law.bends else {})
    parameters = fit_law(tests, law, [np.array([start[name] for name in law.parameters])])
    fit = DamperFit(law=law, parameters=parameters)
    return FittedDamper(conditions={}, tests=tests, fit=fit, compared=[fit])


def test_the_gap_of_a_friction_device_is_found():
    tests = device()
    fit, _ = choose_law(tests)
    assert fit.law.gap and np.max(fit.left_out) < 0.03, (fit.law.title, fit.left_out)
    gap = dict(zip(fit.law.parameters, fit.values, strict=True))["gap"]
    validated(SUBJECT, "friction device: gap from three sines with 2 % noise", gap, GAP, abs=2e-4, unit="m",
              source="second derivation: slider behind a gap as a recursion of its limits")  # fmt: skip


def test_the_slopes_of_a_gap_are_those_of_differences():
    law = DamperLaw(friction="coulomb", series=True, gap=True, bends=1, gas_stiffness=True)
    values = SIMPLE | {
        "gas_force": 5.0,
        "gas_stiffness": 800.0,
        "series_stiffness": 2e6,
        "gap": 3e-3,
        "outer_friction": 50.0,
    }
    parameters = np.array([values[name] for name in law.parameters])
    motion = device()[1].motion
    slopes = force_and_slopes(law, parameters, motion)[1]
    # Before the first contact the force depends on the start: friction beside the gap is left out.
    for at in range(parameters.size - 1):
        step = np.zeros(parameters.size)
        step[at] = 1e-6 * parameters[at]
        ends = [force_and_slopes(law, parameters + sign * step, motion)[0] for sign in (1.0, -1.0)]
        difference = (ends[0] - ends[1]) / (2.0 * step[at])
        assert np.linalg.norm(difference - slopes[:, at]) < 1e-3 * np.linalg.norm(difference), at


def test_without_the_gap_in_the_law_the_fit_names_it():
    without = fitted(device(), DamperLaw(friction="presliding", elements=2))
    missing = missing_mechanism(without)
    assert missing is not None and missing.name == "gap" and missing.distance == pytest.approx(GAP, abs=2e-4)
    assert "jumps 6.8 mm after each reversal: the law has no gap" in missing_text(without)


def curve(v):
    """Force of the known damper without gas [N]."""
    return 3000.0 * np.clip(v, -0.06, 0.06) + 1000.0 * v + 40.0 * np.sign(v)


BASE = {
    "": lambda v, a, f: 0.0 * v,
    "hysteresis": lambda v, a, f: 20.0 * a,
    "frequency": lambda v, a, f: -0.1 * np.log(f) * curve(v),
    "asymmetry": lambda v, a, f: 30.0 * (v > 0.0) + 800.0 * np.maximum(v, 0.0),
}


@pytest.mark.parametrize("name", BASE)
def test_the_missing_mechanism_is_named(name):
    rng, tests = np.random.default_rng(3), []
    for amplitude, frequency in ((0.03, 0.5), (0.008, 2.0), (0.0026, 6.0)):
        time, w = np.arange(1200) / 1200.0 * 6.0 / frequency, 2.0 * np.pi * frequency
        x, v = amplitude * np.sin(w * time), amplitude * w * np.cos(w * time)
        force = curve(v) - 100.0 + BASE[name](v, -(w**2) * x, frequency)
        tests.append(made(time, x, v, force + 0.02 * np.std(force) * rng.standard_normal(x.size)))
    missing = missing_mechanism(fitted(tests, DamperLaw(friction="coulomb", bends=1)))
    assert (missing.name if missing is not None else "") == name
