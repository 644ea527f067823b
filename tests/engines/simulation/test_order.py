"""Order of convergence of the row scheme in the step, and stability of what may be stiff."""

import numpy as np
import pytest

from tests.engines.simulation.row_model import (
    Stepper,
    add_bushing,
    add_free_body,
    add_mode,
    element_law,
    empty_spec,
    poles,
)
from tests.validation import validated

OMEGA = 100.0
STEPS = np.array([4e-3, 2e-3, 1e-3])  # w h from 0.4 to 0.1


def bushing_poles(step, damping=0.0, *, averaged=False):
    spec = empty_spec(step)
    body = add_free_body(spec, "mass", 2.0, [1.0] * 3)
    add_bushing(spec, "x", body, spec.worldbody, element_law([2.0 * OMEGA**2] * 3, [damping] * 3, averaged=averaged))
    run = Stepper(spec)
    run.data.qpos[0] = 1e-3
    return poles(run.step(80, run.position)[:, 0], step)


def mode_poles(step, ratio=0.0):
    spec = empty_spec(step)
    add_mode(spec, 1, OMEGA, ratio)
    run = Stepper(spec)
    run.data.qpos[0] = 1e-3
    return poles(run.step(80, run.position)[:, 0], step)


def slope(errors):
    return np.polyfit(np.log(STEPS), np.log(np.abs(errors)), 1)[0]


@pytest.mark.parametrize("found", [bushing_poles, mode_poles], ids=["row", "modal joint"])
def test_undamped_frequencies_are_of_fourth_order(found):
    pairs = [found(step) for step in STEPS]
    errors = [abs(pair[0].imag) / OMEGA - 1.0 for pair in pairs]
    # Expected (w h)^4 / 480; the next term adds 0.02 to the slope over this range.
    kind = "bushing" if found is bushing_poles else "body mode"
    validated(
        "Integration in MuJoCo", f"order of convergence of the undamped frequency of a {kind}", slope(errors), 4.0,
        abs=0.05, source="closed form: (w h)^4 / 480",
    )  # fmt: skip
    validated(
        "Integration in MuJoCo", f"relative error of the undamped frequency of a {kind}, w h = 0.1", errors[-1],
        (OMEGA * STEPS[-1]) ** 4 / 480.0, rel=0.05, source="closed form: (w h)^4 / 480",
    )  # fmt: skip
    # No numerical damping at all: a plain implicit spring would have w h / 2 = 5 to 20 %.
    assert max(abs(pair[0].real) for pair in pairs) < 1e-6 * OMEGA


@pytest.mark.parametrize("ratio", [0.02, 0.2])
def test_damped_poles_are_of_second_order(ratio):
    exact = OMEGA * complex(-ratio, np.sqrt(1.0 - ratio**2))
    errors = np.array([np.min(np.abs(bushing_poles(step, 4.0 * ratio * OMEGA) - exact)) for step in STEPS]) / OMEGA
    # 2 for the damping, drawn upwards where the fourth-order part still counts (light damping).
    validated(
        "Integration in MuJoCo", f"order of convergence of the pole of a bushing, damping ratio {ratio:g}",
        slope(errors), 2.0, within=(1.9, 2.4), source="closed form: pole of s^2 + 2 zeta w s + w^2",
    )  # fmt: skip
    assert errors[-1] < ratio * (OMEGA * STEPS[-1]) ** 2  # 1 % of the damping at w h = 0.1


@pytest.mark.parametrize("ratio", [0.02, 0.2])
def test_the_damping_of_a_mode_is_right_at_its_resonance(ratio):
    exact = OMEGA * complex(-ratio, np.sqrt(1.0 - ratio**2))
    errors = [np.min(np.abs(mode_poles(step, ratio) - exact)) / OMEGA for step in STEPS]
    # Second order by as much as a damped pole is off the undamped resonance.
    assert slope(errors) > 1.9
    assert errors[-1] < ratio * max(0.2 * ratio, 0.005) * (OMEGA * STEPS[-1]) ** 2


def swing(phase):
    """sin2 of half the angle per step of an averaged element: (w h)2/4 / (1 + beta (w h)2)."""
    beta = max(1.0 / 12.0, 1.0 / 4.0 - 0.5 / phase**2)
    return 0.25 * phase**2 / (1.0 + beta * phase**2)


def test_an_averaged_element_is_of_fourth_order_where_it_is_not_stiff():
    errors = [abs(bushing_poles(step, averaged=True)[0].imag) / OMEGA - 1.0 for step in STEPS]
    validated(
        "Integration in MuJoCo", "order of convergence of the frequency of an averaged element", slope(errors), 4.0,
        abs=0.05, source="closed form: (w h)^4 / 480",
    )  # fmt: skip
    # Where it is stiff, with w h from 2.5 to 10, it is slower, as much as its average says.
    for step in (0.025, 0.05, 0.1):
        found = abs(bushing_poles(step, averaged=True)[0].imag) * step
        validated(
            "Integration in MuJoCo", f"angle per step of a stiff averaged element, w h = {OMEGA * step:g}", found,
            2.0 * np.arcsin(np.sqrt(swing(OMEGA * step))), rel=1e-6, unit="rad",
            source="closed form: 2 asin sqrt((w h)^2 / 4 / (1 + beta (w h)^2))",
        )  # fmt: skip


@pytest.mark.parametrize("phase", [1.0, 10.0, 100.0, 1000.0])
@pytest.mark.parametrize("loss_time", [0.0, 1e-4])
def test_an_averaged_element_is_stable_at_any_step(phase, loss_time):
    step, mass = 1e-3, 0.1
    stiffness = mass * (phase / step) ** 2
    spec = empty_spec(step)
    body = add_free_body(spec, "mass", mass, [1.0] * 3)
    law = element_law([stiffness] * 3, [loss_time * stiffness] * 3, averaged=True)
    add_bushing(spec, "x", body, spec.worldbody, law)
    run = Stepper(spec)
    run.data.qpos[0] = 1e-3
    x = run.step(2000, run.position)[:, 0]
    # A start with x[-1] = x[0] lies half a step before the peak.
    peak = 1e-3 / np.sqrt(1.0 - swing(phase))
    assert np.max(np.abs(x)) <= peak * (1.0 + 1e-6)  # rounding
    if loss_time > 0.0:
        assert np.max(np.abs(x[-200:])) < 0.1 * peak


def test_the_fourth_order_element_is_stable_up_to_the_square_root_of_six():
    def largest(phase):
        spec = empty_spec(1e-3)
        body = add_free_body(spec, "mass", 1.0, [1.0] * 3)
        add_bushing(spec, "x", body, spec.worldbody, element_law([(phase / 1e-3) ** 2] * 3))
        run = Stepper(spec)
        run.data.qpos[0] = 1e-6
        return np.max(np.abs(run.step(400, run.position)[:, 0]))

    assert largest(2.4) < 1e-5
    assert largest(2.5) > 1.0  # it grows by 1.5 a step: the reason for the check of the step
