"""Names of modes: shares of the kinetic energy by named motion, against closed forms, M and the animation."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tests.validation import validated
from vehicle.drawing.rendering.mode_motion import ModeMotion
from vehicle.engines.linear.motion_names import NAMED, description, motion_shares
from vehicle.engines.linear.part_motions import group_of, rigid_rows
from vehicle.runs.car import Car

CARS = {"focus": ("stuck", "sliding"), "focus_road": ("stuck",), "focus_road_seated": ("stuck",), "sedan": ("stuck",)}
CORNERS = ("fr", "fl", "rr", "rl")


@pytest.fixture(scope="module")
def cars():
    return {name: Car.load(name) for name in CARS}


@pytest.fixture(scope="module")
def modes(cars):
    return {(name, damper): cars[name].modes(damper) for name, dampers in CARS.items() for damper in dampers}


def named(vertical, frequency=12.0):
    """Name of a motion in which the wheels fr, fl, rr, rl move vertically with these amplitudes."""
    wheels = np.array(vertical) / np.linalg.norm(vertical)
    rigid = {f"wheel_{name}": np.eye(6)[2] * value for name, value in zip(CORNERS, wheels, strict=True)}
    energy = {group: float(np.sum(np.abs(motion) ** 2)) for group, motion in rigid.items()}
    shares = motion_shares(rigid, energy, np.zeros(0, dtype=complex), (), frequency)
    assert sum(shares.values()) == pytest.approx(1.0, abs=1e-12)
    return description(shares)


@pytest.mark.parametrize(("vertical", "name"), [
    ((1, 1, 0, 0), "front wheel hop, sides in phase"),
    ((0, 0, 1, -1), "rear wheel hop, sides opposite"),
    ((1j, -0.9j, 0.3, 0.3), "front wheel hop, sides opposite"),
    ((1, 0.2, 0, 0), "right front wheel hop"),
    ((0, 0, 0.1, -3), "left rear wheel hop"),
    ((1, 1, 1, 1), "front and rear wheel hop, sides in phase, axles in phase"),
    ((1, 1, -1, -1), "front and rear wheel hop, sides in phase, axles opposite"),
    ((1, -1, -1, 1), "front and rear wheel hop, sides opposite, axles opposite"),
    ((1, 1, -1.1, -1), "rear wheel hop, sides in phase"),
    ((1, 1, 1.2, -1.3), "rear wheel hop, sides opposite"),
])  # fmt: skip
def test_wheels_in_phase_opposite_and_alone(vertical, name):
    assert named(vertical) == name


def test_two_names_where_no_motion_holds_half():
    thirds = motion_shares(
        {"body": np.sqrt(np.array([0.0, 0.0, 0.45, 0.0, 0.0, 0.0], dtype=complex))}, {"body": 0.45, "flexible": 0.55},
        np.sqrt(np.array([0.2, 0.35], dtype=complex)), ("torsion", "mode 2"), 20.0,
    )  # fmt: skip
    assert description(thirds) == "body heave (z) (45 %) with flexible body, mode 2 (35 %)"
    assert list(thirds)[2] == "flexible body, mode 1 (torsion)"


@pytest.mark.parametrize(("frequency", "word"), [(7.9, "vertical"), (8.0, "hop"), (35.0, "hop"), (35.1, "vertical")])
def test_a_wheel_hops_between_8_and_35_hz(frequency, word):
    assert named((1, 1, 0, 0), frequency) == f"front wheel {word}, sides in phase"


def test_rigid_rows_of_a_unit_against_its_bodies():
    """Compare with the energy of the rigid motion by hand, and of the relative motion from the body velocities."""
    rng = np.random.default_rng(3)
    bodies, freedom = ("arm_fr", "knuckle_fr", "tyre_fr"), 18
    centres = {body: rng.normal(size=3) for body in bodies}
    masses = {}
    for body in bodies:
        root = rng.normal(size=(3, 3))
        masses[body] = np.diag([*[rng.uniform(1.0, 20.0)] * 3, 0.0, 0.0, 0.0])
        masses[body][3:, 3:] = root @ root.T
    matrices: Any = SimpleNamespace(
        body_rows={body: rng.normal(size=(6, freedom)) for body in bodies}, body_masses=masses, body_centres=centres,
        carried_by={}, system=SimpleNamespace(inputs=("fr", "fl")),
    )  # fmt: skip
    assert list(rigid_rows(matrices)) == ["wheel_fr"]
    velocity = {body: matrices.body_rows[body] @ rng.normal(size=freedom) for body in bodies}
    matrices.body_rows = {body: velocity[body][:, None] for body in bodies}
    coordinates = rigid_rows(matrices)["wheel_fr"][:, 0]
    # The rigid motion nearest to that of the bodies in M, by least squares.
    six = {
        body: np.block([[np.eye(3), np.cross(np.eye(3), centres[body]).T], [np.zeros((3, 3)), np.eye(3)]])
        for body in bodies
    }
    normal = sum(six[body].T @ masses[body] @ six[body] for body in bodies)
    motion = np.linalg.solve(normal, sum(six[body].T @ masses[body] @ velocity[body] for body in bodies))
    rigid = sum(v @ masses[body] @ v for body in bodies for v in [six[body] @ motion])
    total = sum(velocity[body] @ masses[body] @ velocity[body] for body in bodies)
    validated(
        "Linear system", "kinetic energy of the rigid share of a motion of three parts", np.sum(coordinates**2), rigid,
        rel=1e-12, source="second derivation: least squares in M",
    )  # fmt: skip
    assert rigid < 0.9 * total
    # Exactly rigid: nothing is left, and the rotation alone has no translation of the centre.
    centre = sum(masses[body][0, 0] * centres[body] for body in bodies) / sum(masses[body][0, 0] for body in bodies)
    turn = np.array([0.3, -1.0, 0.2])
    matrices.body_rows = {
        body: np.concatenate([np.cross(turn, centres[body] - centre), turn])[:, None] for body in bodies
    }
    coordinates = rigid_rows(matrices)["wheel_fr"][:, 0]
    energy = sum(float(v @ masses[body] @ v) for body, rows in matrices.body_rows.items() for v in [rows[:, 0]])
    assert np.sum(coordinates**2) == pytest.approx(energy, rel=1e-12)
    np.testing.assert_allclose(coordinates[:3], 0.0, atol=1e-12)


@pytest.mark.parametrize("name", CARS)
def test_the_named_motion_holds_half_or_two_are_named(modes, name):
    for damper in CARS[name]:
        for mode in modes[name, damper]:
            shares = list(mode.motions.items())
            assert sum(share for _, share in shares) == pytest.approx(1.0, abs=1e-9)
            assert [share for _, share in shares] == sorted(mode.motions.values(), reverse=True)
            if shares[0][1] >= NAMED:
                assert mode.description == shares[0][0]
            else:
                assert mode.description == " with ".join(f"{word} ({100 * share:.0f} %)" for word, share in shares[:2])
            for group in ("body", "engine"):
                group_share = sum(share for word, share in shares if word.startswith(group))
                assert group_share == pytest.approx(mode.energy[group], abs=1e-9)


def test_shares_add_up_to_m(cars):
    """Compare the energy coordinates and the relative motion of the links with M of MuJoCo."""
    matrices = cars["sedan"].matrices
    rng = np.random.default_rng(1)
    for velocity in rng.normal(size=(3, matrices.system.mass.shape[0])):
        whole = velocity @ matrices.system.mass @ velocity
        rigid = sum(np.sum((rows @ velocity) ** 2) for rows in rigid_rows(matrices).values())
        assert rigid < whole
        body = rigid_rows(matrices)["body"] @ velocity
        welded = [name for name in matrices.body_rows if group_of(matrices, name) == "body"]
        exact = sum(v @ matrices.body_masses[b] @ v for b in welded for v in [matrices.body_rows[b] @ velocity])
        assert np.sum(body**2) == pytest.approx(exact, rel=1e-9)


def test_rear_wheels_of_the_sedan_hop_and_wind_up(modes):
    names = [mode.description for mode in modes["sedan", "stuck"]]
    for word in ("hop", "wind-up"):
        for phase in ("in phase", "opposite"):
            assert names.count(f"rear wheel {word}, sides {phase}") == 1
    focus = [mode for mode in modes["focus", "stuck"] if 26.0 < mode.frequency < 28.5]
    assert sum("wheel hop" in mode.description for mode in focus) == 2


AXIS = {"fore-aft": (0, 0), "lateral": (0, 1), "hop": (0, 2), "camber": (1, 0), "wind-up": (1, 1), "steer": (1, 2)}


@pytest.mark.parametrize("name", ["focus", "focus_road", "sedan"])
def test_names_agree_with_the_animation(cars, modes, name):
    """Motion of the wheels in the film: a translation of their centre, or a rotation, alike or opposite."""
    model, seen = cars[name].model.model, 0
    for mode in modes[name, "stuck"]:
        parts = mode.description.replace(",", "").split()
        if not (parts[1:2] == ["wheel"] and "(" not in mode.description and parts[2] in AXIS):
            continue
        motion = ModeMotion(model, mode.shape)
        quantity, axis = AXIS[parts[2]]
        right, left = (
            motion.amplitude[model.body(f"tyre_{parts[0][0]}{side}").id, quantity, axis] for side in ("r", "l")
        )
        assert np.sign((right * np.conj(left)).real) == (1.0 if "in phase" in mode.description else -1.0)
        both = (
            np.abs(motion.amplitude[[model.body(f"tyre_{parts[0][0]}{side}").id for side in ("r", "l")], quantity]) ** 2
        )
        assert both.sum(axis=0).argmax() == axis
        seen += 1
    assert seen >= {"focus": 2, "focus_road": 6, "sedan": 11}[name]
