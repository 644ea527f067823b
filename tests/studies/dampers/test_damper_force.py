"""Force of a damper law under a prescribed motion: closed forms, vehicle file, a stiff solver, derivatives."""

import numpy as np
import pytest
import scipy

from tests.validation import validated
from vehicle.model.laws.curve import Curve
from vehicle.model.laws.jenkins import Jenkins
from vehicle.studies.dampers.damper_force import Motion, force_and_slopes, joined
from vehicle.studies.dampers.damper_law import DamperLaw

NUMBERS = {
    "gas_force": 100.0, "friction": 60.0, "friction_at_rest": 30.0, "stribeck_velocity": 0.01, "gas_stiffness": 2e3,
    "series_stiffness": 2e6, "slider_stroke_1": 3e-4, "slider_stroke_2": 1e-4, "slider_limit_1": 70.0,
    "slider_limit_2": 40.0, "velocity_1": 0.015, "velocity_2": 0.02, "damping_1": 4000.0, "damping_2": 1500.0,
    "damping_3": 600.0,
}  # fmt: skip
SUBJECT = "Sweeps, tuning and optimisation"


def numbers(law):
    """Parameters of a law; rebound has 1.3 times the damping of bump."""
    return np.array([
        NUMBERS[name.removeprefix("rebound_").removeprefix("bump_")] * (1.3 if name.startswith("rebound_d") else 1.0)
        for name in law.parameters
    ])  # fmt: skip


def motion(first_force=0.0, step=1e-3, duration=2.0):
    t = np.arange(0.0, duration, step)
    wave, fast = np.sin(2.0 * np.pi * t), np.sin(26.0 * t)
    x = 0.01 * wave + 0.002 * fast
    return Motion(t, x, 0.02 * np.pi * np.cos(2.0 * np.pi * t) + 0.052 * np.cos(26.0 * t), first_force)


LAWS = [
    DamperLaw(bends=2, own_sides=True),
    DamperLaw(bends=1, friction="coulomb", gas_stiffness=True),
    DamperLaw(bends=1, friction="stribeck"),
    DamperLaw(friction="presliding", elements=2),
    DamperLaw(bends=2, own_sides=True, friction="presliding", elements=2, series=True, gas_stiffness=True),
    DamperLaw(bends=1, friction="coulomb", series=True),
    DamperLaw(bends=1, friction="stribeck", series=True),
]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.title)
def test_the_derivatives_are_those_of_differences(law):
    values, small = numbers(law), 1e-6
    _, slopes = force_and_slopes(law, values, motion(-100.0))
    for at, name in enumerate(law.parameters):
        change = small * values * (np.arange(values.size) == at)
        upper, lower = (force_and_slopes(law, values + sign * change, motion(-100.0))[0] for sign in (1.0, -1.0))
        difference = (upper - lower) / (2.0 * small * values[at])
        close = np.isclose(slopes[:, at], difference, atol=1e-4 * np.max(np.abs(difference)))
        # A sample at which a slider begins to slip within the difference has neither derivative.
        assert np.mean(close) > 0.995, name


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.title)
def test_tests_in_one_pass_have_the_forces_of_each(law):
    """The second test begins at its own force, without the sliders and the deflection of the first."""
    whole = motion(-100.0)
    part = Motion(whole.time[300:900], whole.displacement[300:900], whole.velocity[300:900], 250.0, parts=2)
    both = force_and_slopes(law, numbers(law), joined([whole, part]))
    each = zip(*(force_and_slopes(law, numbers(law), one) for one in (whole, part)), strict=True)
    for found, expected in zip(both, each, strict=True):
        np.testing.assert_allclose(found, np.concatenate(expected), rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("series", [False, True])
@pytest.mark.parametrize("excess", [30.0, -30.0])
def test_stribeck_friction_at_constant_velocity_is_its_formula(series, excess):
    """F = c v +- (F_c + (F_s - F_c) exp(-(v/v_s)^2)) in both directions, also with friction at rest below sliding."""
    law = DamperLaw(friction="stribeck", series=series)
    parameters = np.array([0.0, 1500.0, 60.0, excess, 0.02, *([2e6] if series else [])])
    for speed in (-0.05, -0.015, 0.005, 0.02, 0.1):
        time = np.arange(400.0) * 1e-3
        stroke = np.asarray(speed * time, dtype=np.float64)
        force, _ = force_and_slopes(law, parameters, Motion(time, stroke, np.full(time.size, speed), 0.0))
        friction = 60.0 + excess * np.exp(-((speed / 0.02) ** 2))
        assert force[-1] == pytest.approx(1500.0 * speed + np.sign(speed) * friction, rel=1e-6)


def test_a_linear_damper_behind_a_spring_is_a_maxwell_element():
    # The backward difference has a relative error of (w h)^2/3, 3.3e-4, in the rate of the deflection.
    damping, stiffness, w = 4000.0, 8e5, 2.0 * np.pi * 5.0
    t = np.arange(0.0, 2.0, 1e-3)
    force, _ = force_and_slopes(DamperLaw(series=True), np.array([0.0, damping, stiffness]),
                                Motion(t, 0.01 * np.sin(w * t), 0.01 * w * np.cos(w * t), 0.0))  # fmt: skip
    late = t > 0.9995  # five whole cycles
    gain = 2.0 * np.mean(force[late] * np.exp(-1j * w * t[late])) / (-0.01j)
    expected = 1j * w * damping * stiffness / (stiffness + 1j * w * damping)
    validated(
        SUBJECT, "damper test: linear damper behind a spring, 5 Hz, 200 samples a cycle", gain, expected, rel=5e-4,
        unit="N/m", source="closed form: Maxwell element",
    )  # fmt: skip


def test_curve_and_presliding_are_those_of_the_vehicle_file():
    law = DamperLaw(bends=2, own_sides=True, friction="presliding", elements=2)
    force, _ = force_and_slopes(law, numbers(law), motion())
    rebound, bump = 1.3 * np.array([4000.0, 1500.0, 600.0]), np.array([4000.0, 1500.0, 600.0])
    widths = np.array([0.015, 0.02, 1.0])
    points = np.concatenate([-np.cumsum(widths)[::-1], [0.0], np.cumsum(widths)])
    forces = np.concatenate([-np.cumsum(bump * widths)[::-1], [0.0], np.cumsum(rebound * widths)])
    limit = np.array([70.0, 40.0])
    sliders = Jenkins(stiffness=limit / np.array([3e-4, 1e-4]), limit=limit).path(motion().displacement)
    expected = Curve.through(points.tolist(), forces.tolist()).force(motion().velocity) + sliders - 100.0
    np.testing.assert_allclose(force, expected, atol=1e-9)


def test_a_degressive_damper_behind_a_spring_is_the_solution_of_a_stiff_solver():
    law = DamperLaw(bends=1, series=True)
    values = numbers(law)
    curve = Curve.through([-1.015, -0.015, 0.0, 0.015, 1.015], [-1560.0, -60.0, 0.0, 60.0, 1560.0])
    moved = motion()

    def rate(t, s):
        velocity = 0.02 * np.pi * np.cos(2.0 * np.pi * t) + 0.052 * np.cos(26.0 * t)
        return velocity - curve.position(float(2e6 * s[0] + 100.0))

    solution = scipy.integrate.solve_ivp(
        rate, (0.0, moved.time[-1]), [0.0], "LSODA", moved.time, rtol=1e-8, atol=1e-12, max_step=1e-3
    )
    force, _ = force_and_slopes(law, values, moved)
    validated(
        SUBJECT, "damper test: degressive damper behind a spring, 1 kHz", force[20:],
        2e6 * solution.y[0][20:], peak=2e-3, unit="N", source="foreign code: scipy, LSODA, 1e-8",
    )  # fmt: skip
