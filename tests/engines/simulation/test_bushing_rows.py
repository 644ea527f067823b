"""A bushing is its own K and B whatever hangs on it: 0.5 kg, 500 kg, or one on the other."""

import numpy as np
import pytest

from tests.engines.simulation.row_model import (
    QUARTER_TURN,
    Stepper,
    add_bushing,
    add_free_body,
    element_law,
    empty_spec,
    stiffness_and_damping,
)
from tests.validation import validated

K = np.array([1e5, 2e5, 4e5])
B = np.array([100.0, 200.0, 400.0])
LAW = element_law(K, B, rotational=100.0)
WITHIN = 1e-3  # the demand of the project: 0.1 %; the step errors below are at most half of it

# Steps at which the stiffest axis has w h = 0.09 and 0.03: its error of K is then at most 6e-4, that of B 2e-4.
BODIES = [pytest.param(0.5, 1e-4, id="0.5 kg"), pytest.param(500.0, 1e-3, id="500 kg")]


def on_ground(mass, step, law=LAW, *, turn=None):
    """A body on one bushing; with `turn` both sides of the bushing are turned."""
    spec = empty_spec(step)
    body = add_free_body(spec, "mass", mass, [0.4 * mass] * 3, turn=turn)
    ground = spec.worldbody.add_body(name="ground")
    if turn is not None:
        ground.quat = turn
    add_bushing(spec, "x", body, ground, law)
    return Stepper(spec)


@pytest.mark.parametrize(("mass", "step"), BODIES)
def test_static_deflection_is_reached_from_rest(mass, step):
    # Damped so that the slowest axis is gone after 30 time constants; the way there is not the one above.
    damping = 1.4 * np.sqrt(K * mass)
    run = on_ground(mass, step, element_law(K, damping))
    force = np.array([30.0, -50.0, 70.0])
    run.data.xfrc_applied[1, :3] = force
    steps = int(30.0 * np.sqrt(mass / K[0]) / 0.7 / step)
    last = run.step(steps, run.position)[-1, :3]
    validated(
        "Bushings, springs and stops", f"static deflection of a bushing under {mass:g} kg", last, force / K, rel=1e-6,
        unit="m", source="closed form: F / K",
    )  # fmt: skip


@pytest.mark.parametrize(("mass", "step"), BODIES)
@pytest.mark.parametrize("axis", range(3))
def test_stiffness_and_damping_from_the_free_vibration(mass, step, axis):
    run = on_ground(mass, step)
    run.data.qpos[axis] = 1e-4
    stiffness, damping = stiffness_and_damping(run.step(60, run.position)[:, axis], step, mass)
    for name, value, exact, unit in (("stiffness", stiffness, K, "N/m"), ("damping", damping, B, "N s/m")):
        validated(
            "Bushings, springs and stops",
            f"{name} of a bushing from the free vibration of {mass:g} kg, axis {'xyz'[axis]}", value, exact[axis],
            rel=WITHIN, unit=unit, source="closed form: pole of m s^2 + B s + K",
        )  # fmt: skip


def test_between_a_light_and_a_heavy_body():
    light, heavy, step = 0.5, 500.0, 1e-4
    spec = empty_spec(step)
    bodies = [add_free_body(spec, name, mass, [0.4 * mass] * 3) for name, mass in (("a", light), ("b", heavy))]
    add_bushing(spec, "x", bodies[0], bodies[1], LAW)
    run = Stepper(spec)
    run.data.qpos[:3] = [1e-4, 1e-4, 1e-4]
    x = run.step(60, run.position)
    reduced = light * heavy / (light + heavy)
    for axis in range(3):
        stiffness, damping = stiffness_and_damping(x[:, axis] - x[:, 7 + axis], step, reduced)
        assert stiffness == pytest.approx(K[axis], rel=WITHIN)
        assert damping == pytest.approx(B[axis], rel=WITHIN)
    # No force from outside: the common centre of gravity stays where it is.
    centre = (light * x[:, :3] + heavy * x[:, 7:10]) / (light + heavy)
    validated(
        "Bushings, springs and stops", "centre of gravity of two bodies that a bushing connects", centre,
        np.array(np.broadcast_to(centre[0], centre.shape)), abs=1e-15, unit="m", source="conservation: momentum",
    )  # fmt: skip


@pytest.mark.parametrize(("mass", "step"), BODIES)
def test_rotational_stiffness(mass, step):
    # The torque is that of the sine of the angle, 2e-5 less at 0.01 rad.
    run = on_ground(mass, step)
    run.data.qvel[3:6] = [1e-3, 2e-3, 3e-3]
    x = run.step(60, run.position)
    for axis in range(3):
        stiffness, damping = stiffness_and_damping(x[:, 4 + axis], step, 0.4 * mass)
        validated(
            "Bushings, springs and stops", f"rotational stiffness of a bushing under {mass:g} kg, axis {'xyz'[axis]}",
            stiffness, 100.0, rel=WITHIN, unit="N m/rad", source="closed form: pole of J s^2 + K",
        )  # fmt: skip
        assert abs(damping) < 1e-3  # "rotational damping is 0": 1e-3 N m s/rad on 100 N m/rad is nothing
    # Static: 1 N m about x gives 0.01 rad; the quaternion holds half the angle.
    run = on_ground(mass, step)
    run.data.qpos[3:5] = [np.cos(0.005), np.sin(0.005)]
    run.data.xfrc_applied[1, 3] = 1.0
    run.step(1, run.position)
    assert abs(run.data.qacc[3]) * 0.4 * mass < 1e-4  # of 1 N m: sin(0.01) instead of 0.01 leaves 2e-5


@pytest.mark.parametrize("mass", [0.5, 500.0])
def test_the_law_acts_in_the_axes_of_the_carrier(mass):
    # Both sides turned by 90 degrees about z: the law's x is the world's y.
    force = np.array([0.0, 10.0, 0.0])
    run = on_ground(mass, 1e-4, turn=QUARTER_TURN)
    start = run.data.qpos[:3].copy()
    run.data.qpos[:3] = start + force / K[0]
    run.data.xfrc_applied[1, :3] = force
    moved = run.step(20, run.position)[:, :3] - start - force / K[0]
    assert np.max(np.abs(moved)) < 1e-9 * force[1] / K[0]
