"""The same physics twice: the quarter car in MuJoCo with the rows of the complete car, against a stiff solver."""

import dataclasses
from functools import cache

import mujoco
import numpy as np
import pytest

from scenarios.lumped.input_signals import Sampled
from scenarios.lumped.quarter_car_network import quarter_car
from scenarios.lumped.quarter_car_parameters import Friction, load_quarter_car
from scenarios.lumped.quarter_car_spec import quarter_car_spec
from scenarios.lumped.stiff_solution import stiff_solution
from scenarios.quarter_car.in_mujoco import DEFAULT_STEP, friction_of_the_rows, in_mujoco
from scenarios.signals.random_road import random_road
from tests.validation import own_function, validated
from vehicle.errors import ConfigurationError
from vehicle.signals.analysis.slip import slip_share

CAR = load_quarter_car()
LOOSE = dataclasses.replace(CAR, friction=Friction(limit=0.0, steepness=1e5))
STEPS = (2e-3, 1e-3, 5e-4)
SLIP = 1e-3
"""A hundred times 1/eps [m/s]: the atan has reached 99.4 % of Fd there, and the clamped law the whole."""


@cache
def road(size, seconds):
    """Return the road of the study, from rest."""
    return random_road(
        rms=size, seed=2006, wheel="fr", duration=seconds, rate=1000.0, lower_band_edge=1.0 / seconds,
        upper_band_edge=100.0,
    )  # fmt: skip


@cache
def stepped(size, step, form="friction"):
    """Simulate with friction, without ("loose") or with the massless damper ("slip"); linear forms for 2 s only."""
    if form == "friction":
        return in_mujoco(CAR, road(size, 5.0), timestep=step)
    return in_mujoco(LOOSE, road(size, 2.0), timestep=step, damper="slip" if form == "slip" else "friction")


@cache
def solved(size, form):
    """Return the stiff solution at the instants of the default step; "rows" is the clamped friction law of the rows."""
    linear = form in ("slip", "loose")
    model = friction_of_the_rows(CAR) if form == "rows" else None
    if model is None:
        model = quarter_car(LOOSE if linear else CAR, damper="slip" if form == "slip" else "friction").first_order()
    signal = road(size, 2.0 if linear else 5.0)
    time = DEFAULT_STEP * np.arange(round(signal.duration / DEFAULT_STEP) + 1)
    return stiff_solution(model, time, road=Sampled(signal.displacement["fr"], 1e-3))


def rms(values):
    return np.sqrt(np.mean(values**2))


def ratios(size, form):
    """Return the RMS acceleration of MuJoCo over that of the stiff solver, less 1, by place."""
    accelerations, exact = stepped(size, DEFAULT_STEP).acceleration, solved(size, form)
    return {output: rms(value) / rms(exact.acceleration(output)) - 1.0 for output, value in accelerations.items()}


def slip_shares(size, form):
    return (
        slip_share(stepped(size, DEFAULT_STEP).sliding_velocity, SLIP),
        slip_share(solved(size, form).sliding_velocity(), SLIP),
    )


def orders(form, quantity, outputs):
    """Return errors by output and step, relative to the RMS of the stiff solution, and the slope over the steps."""
    size, errors = 0.005, {}
    exact = solved(size, form)
    for output in outputs:
        want = getattr(exact, quantity)(output)
        runs = {step: stepped(size, step, "friction" if form == "rows" else form) for step in STEPS}
        gaps = [rms(getattr(run, quantity)[output] - want[:: round(h / DEFAULT_STEP)]) for h, run in runs.items()]
        errors[output] = np.array(gaps) / rms(want)
    return errors, {output: np.polyfit(np.log(STEPS), np.log(gap), 1)[0] for output, gap in errors.items()}


@pytest.mark.parametrize("size", [0.001, 0.005])
def test_body_wheel_and_damper_move_as_in_the_stiff_solution_of_the_same_law(size):
    # Asked for: RMS within 1 %, slip within 0.5 points, at the default step, where the damper slips part of the time.
    stiff = own_function("scipy", "lumped quarter car, Radau")
    for output in ("body", "wheel", "damper"):
        validated(
            "Integration in MuJoCo",
            f"quarter car, RMS acceleration of the {output} over that of a stiff solver, road of {1e3 * size:g} mm",
            1.0 + ratios(size, "rows")[output], 1.0, abs=0.01, source=stiff,
        )  # fmt: skip
    measured, exact = slip_shares(size, "rows")
    assert 0.1 < exact < 0.7
    validated(
        "Integration in MuJoCo", f"quarter car, share of time in which the damper slips, road of {1e3 * size:g} mm",
        measured, exact, abs=0.005, source=stiff,
    )  # fmt: skip


@pytest.mark.parametrize("size", [0.001, 0.005])
def test_the_published_smooth_law_gives_nearly_the_same(size):
    gap = ratios(size, "atan")
    assert abs(gap["body"]) < 0.01 and abs(gap["wheel"]) < 0.01
    measured, exact = slip_shares(size, "atan")
    assert abs(measured - exact) < 0.005
    # The damper's mass of 1 kg feels the last percents of the friction: its deviation is that between the two laws,
    # as the stiff solver has it too, and not one of the step.
    laws = rms(solved(size, "rows").acceleration("damper")) / rms(solved(size, "atan").acceleration("damper")) - 1
    assert laws > 0.005
    assert gap["damper"] == pytest.approx(laws, abs=0.01)


def test_the_linear_models_converge_with_second_order():
    outputs = ("body", "wheel", "damper")
    # The damper's mass on its mount has 133 Hz: (w h)^2/12 is 1.5 % at 0.5 ms for its share of the acceleration.
    for quantity, limit in (("displacement", 5e-5), ("acceleration", 0.015)):
        errors, slope = orders("loose", quantity, outputs)
        for place in outputs:
            validated(
                "Integration in MuJoCo", f"linear quarter car, order of convergence of the {quantity} of the {place}",
                slope[place], 2.0, abs=0.15, source=own_function("scipy", "lumped quarter car, Radau"),
            )  # fmt: skip
        assert max(gap[-1] for gap in errors.values()) < limit
    # The massless damper is a Maxwell branch, exact for a rate on a straight line: its share of the error is of higher
    # order, and that of the undamped springs of the fourth. The sampled acceleration is that of the step: order 2.
    errors, slope = orders("slip", "displacement", outputs[:2])
    assert min(slope.values()) > 2.0
    assert max(gap[-1] for gap in errors.values()) < 5e-6
    errors, slope = orders("slip", "acceleration", outputs[:2])
    assert slope == pytest.approx(dict.fromkeys(outputs[:2], 2.0), abs=0.15)
    assert max(gap[-1] for gap in errors.values()) < 2e-3


def test_the_friction_model_converges_with_second_order():
    errors, slope = orders("rows", "displacement", ("body", "wheel", "damper"))
    # The instants of sticking fall inside the steps and scatter the single halvings: a first-order scheme has 1.0.
    for place, value in slope.items():
        validated(
            "Integration in MuJoCo",
            f"quarter car with friction, order of convergence of the displacement of the {place}", value, 2.0,
            within=(1.7, 2.4), source=own_function("scipy", "lumped quarter car, Radau"),
        )  # fmt: skip
    assert max(gap[-1] for gap in errors.values()) < 2e-4
    errors, slope = orders("rows", "acceleration", ("body", "wheel", "damper"))
    assert 1.7 < slope["body"] < 2.4
    assert errors["body"][-1] < 1e-3
    # The friction acts on the wheel and the damper directly: their accelerations jump, and sampled jumps that come a
    # fraction of a step late cannot converge as fast.
    assert 1.3 < slope["damper"] < slope["wheel"] < 2.0


def test_it_is_made_of_the_elements_of_the_complete_car():
    model = quarter_car_spec(CAR, timestep=5e-4).compile()
    names = [model.equality(index).name for index in range(model.neq)]
    assert names == ["bushing/tyre_fr", "main_spring_fr", "bushing/suspension_mount_fr", "damper_fr"]
    assert [model.joint(index).name for index in range(model.njnt)] == ["body", "wheel", "damper_fr"]
    assert model.jnt_type.tolist() == [mujoco.mjtJoint.mjJNT_SLIDE] * 3
    validated(
        "Published cars", "mass of the quarter car in MuJoCo", float(mujoco.mj_getTotalmass(model)), 226.0, rel=1e-6,
        unit="kg", source="publication: Bommer 2006, tables 2.1 and 2.2: 180 + 45 + 1 kg",
    )  # fmt: skip


def test_refusals():
    with pytest.raises(ConfigurationError, match=r"^damper: found 'none', must be one of slip, stick, friction$"):
        quarter_car_spec(CAR, timestep=1e-3, damper="none")  # type: ignore[arg-type]
    with pytest.raises(ConfigurationError, match=r"^timestep: found nan s, must be finite and greater than 0\.0$"):
        quarter_car_spec(CAR, timestep=float("nan"))
