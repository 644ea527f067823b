"""The modal superelement in MuJoCo: a free body under a force at a node, and its axes when it is turned."""

import mujoco
import numpy as np
import pytest

from tests.engines.simulation.row_model import TURN, Stepper, add_bushing, add_flexible_body, element_law, empty_spec
from tests.model.flexbody.box_body import box_fields
from tests.validation import validated
from vehicle.model.flexbody.superelement import Superelement

BOX = Superelement(**box_fields())
STEP = 2e-4  # w h = 0.05 at the highest of the four modes
NODE, OTHER = "corner_7", "corner_2"
FREE = element_law([0.0] * 3)  # a bushing without stiffness: only its preload acts


def free_box(force, *, turned=False, law=FREE, ratio=0.02, carrier=False):
    """Return the free box, pulled at a node by the preload of a bushing to the ground; its CoG is the origin."""
    spec = empty_spec(STEP)
    body = add_flexible_body(spec, BOX, turned=turned, ratio=ratio)
    arm = BOX.positions[BOX.node_index(NODE)] - BOX.cog
    ground = TURN @ arm if turned else arm
    if carrier:
        add_bushing(spec, "pull", spec.worldbody, body, law, at=ground, on_carrier=arm)
    else:
        add_bushing(spec, "pull", body, spec.worldbody, law, at=arm, on_carrier=ground)
    spec.add_numeric(name="shape/bushing/pull", data=BOX.shape_at(NODE).ravel())
    return Stepper(spec, np.array(force))


def modal_step_response(load, times, ratio=0.02):
    """q of q'' + 2 zeta w q' + w2 q = load, from rest; (times, modes)."""
    omega = 2.0 * np.pi * BOX.frequencies
    damped = omega * np.sqrt(1.0 - ratio**2)
    phase = np.outer(times, damped)
    swing = np.cos(phase) + ratio / np.sqrt(1.0 - ratio**2) * np.sin(phase)
    return load / omega**2 * (1.0 - np.exp(-ratio * np.outer(times, omega)) * swing)


@pytest.mark.parametrize("turned", [False, True], ids=["upright", "turned by 90 degrees"])
def test_a_force_at_a_node_moves_body_and_modes(turned):
    force = np.array([50.0, -30.0, 80.0])
    run = free_box(force, turned=turned)
    count = 250  # 50 ms: 1.5 periods of the lowest mode and more; the body turns by 0.2 degrees
    samples = run.step(count, run.position)
    # MuJoCo starts with the velocity of half a step before at zero: its clock is half a step late.
    times = STEP * (np.arange(count) + 0.5)
    turn = TURN if turned else np.eye(3)
    load = BOX.shape_at(NODE).T @ (turn.T @ force)
    exact = modal_step_response(load, times)
    size = np.max(np.abs(exact))
    # Second order: (w h)^2 / 8 = 3e-4 from the start of half a step, and the turn of the body.
    place = "turned by 90 degrees" if turned else "upright"
    validated(
        "Integration in MuJoCo", f"modal coordinates of a free body after a step of force, {place}", samples[:, 7:],
        exact, abs=5e-3 * size, source="closed form: step response of q'' + 2 zeta w q' + w^2 q",
    )  # fmt: skip
    start = samples[0, :3]
    assert np.max(np.abs(samples[:, :3] - start - np.outer(0.5 * times**2, force / BOX.mass))) < 1e-3 * np.max(
        np.abs(samples[-1, :3] - start)
    )
    # Rotation: I w' = arm x F.
    arm = turn @ (BOX.positions[BOX.node_index(NODE)] - BOX.cog)
    spin = np.linalg.solve(turn @ BOX.inertia @ turn.T, np.cross(arm, force))
    # qvel holds it in body axes.
    np.testing.assert_allclose(
        run.data.qvel[3:6], turn.T @ spin * STEP * count, rtol=0.01, atol=1e-3 * np.max(abs(spin)) * STEP * count
    )


def test_acceleration_of_another_node_is_rigid_plus_modal():
    # First instant: the whole lumped-mass body answers M x'' = F in the space of its ten shapes, whatever the modes.
    force = np.array([50.0, -30.0, 80.0])
    run = free_box(force, ratio=0.0)
    run.step(1, run.position)
    arm = BOX.positions[BOX.node_index(NODE)] - BOX.cog
    there = BOX.positions[BOX.node_index(OTHER)] - BOX.cog
    body, modal = run.data.qacc[:6], run.data.qacc[6:]
    acceleration = body[:3] + np.cross(body[3:], there) + BOX.shape_at(OTHER) @ modal
    rigid = force / BOX.mass + np.cross(np.linalg.solve(BOX.inertia, np.cross(arm, force)), there)
    exact = rigid + BOX.shape_at(OTHER) @ (BOX.shape_at(NODE).T @ force)
    # The armature of the scheme, w2 h2 / 12, makes the modal part smaller by at most 3e-4.
    validated(
        "Integration in MuJoCo", "acceleration of a node at the first instant of a force at another node",
        acceleration, exact,
        peak=5e-4, unit="m/s2", source="second derivation: lumped-mass body in the space of its ten shapes",
    )  # fmt: skip


@pytest.mark.parametrize("carrier", [False, True], ids=["body moves", "body carries"])
def test_stiff_support_sees_the_flexibility_of_the_node(carrier):
    # A bushing of its own stiffness at the node: residual and rate include Phi q, so the static sum is zero there.
    stiffness = np.array([1e5, 2e5, 3e5])
    run = free_box(np.zeros(3), law=element_law(stiffness), carrier=carrier)
    run.data.qpos[7:] = [1e-2, -2e-2, 5e-3, 1e-2]
    with_modes = BOX.shape_at(NODE) @ run.data.qpos[7:]
    # The residual is moving less carrier: as carrier the body's own deflection counts against it.
    sign = -1.0 if carrier else 1.0
    run.step(1, run.position)
    np.testing.assert_allclose(run.rows.state.residual[0], sign * with_modes, rtol=1e-12)
    np.testing.assert_allclose(run.rows.state.explicit[:3], -stiffness * sign * with_modes, rtol=1e-12)
    side = "body carries" if carrier else "body moves"
    validated(
        "Integration in MuJoCo", f"modal forces of a stiff support at a node, {side}", run.data.qfrc_applied[6:],
        BOX.shape_at(NODE).T @ (-stiffness * with_modes), rel=1e-9, source="closed form: -Phi' K Phi q",
    )  # fmt: skip


def test_momentum_is_conserved_while_the_modes_ring():
    # Free-free modes do not couple with the rigid motion: without a force the centre of gravity stays.
    run = free_box(np.zeros(3))
    run.data.qpos[7:] = 0.05
    samples = run.step(200, run.position)
    validated(
        "Integration in MuJoCo", "motion of the centre of gravity while free modes ring", samples[:, :3], 0.0,
        abs=1e-12, unit="m", source="conservation: momentum",
    )  # fmt: skip
    assert np.ptp(samples[:, 7]) > 0.05
    assert mujoco.get_mjcb_control() is None
