"""Forces in the axes of a part, which turn with it: at finite rotations, in the stiffness, and in both engines."""

import mujoco
import numpy as np
import pytest

from tests.physics.test_applied_forces import energies_of, level
from tests.validation import validated
from vehicle import Car
from vehicle.engines.simulation.rows import Rows
from vehicle.errors import ConfigurationError

AT = [0.35, 0.2, 0.9]
FORCE, MOMENT = np.array([300.0, -800.0, 1500.0]), np.array([90.0, 200.0, -60.0])
SHAKE = {"frequency": 14.0, "harmonics": [[1, 15.0, 0.0]]}


def pushed(axes: str, mean: float = 1.0, **more: object) -> Car:
    """Car with a force and a moment on the engine; their means are `FORCE` and `MOMENT` for mean 1."""
    place = {"on": "engine", "at": AT, "axes": axes}
    forces = {"push": ("force", FORCE), "turn": ("moment", MOMENT)}
    table = {
        f"force.{name}.{key}": value
        for name, (kind, vector) in forces.items()
        for key, value in {
            **place, kind: vector.tolist(), "mean": mean * float(np.linalg.norm(vector)), **more
        }.items()
    }  # fmt: skip
    return Car.load("focus", table)


def skew(v: np.ndarray) -> np.ndarray:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def jacobians(model: mujoco.MjModel, data: mujoco.MjData, body: int) -> tuple[np.ndarray, np.ndarray]:
    """Jacobians of a point of the engine, at `AT` in the design position, and of a rotation of a body."""
    engine, start = model.body("engine").id, mujoco.MjData(model)
    mujoco.mj_fwdPosition(model, start)
    local = start.xmat[engine].reshape(3, 3).T @ (np.array(AT) - start.xpos[engine])
    point = data.xpos[engine] + data.xmat[engine].reshape(3, 3) @ local
    linear, angular = np.zeros((2, 3, model.nv))
    mujoco.mj_jac(model, data, linear, angular, point, body)
    return linear, angular


@pytest.mark.parametrize("axes", ["vehicle", "part"])
def test_a_force_turns_with_its_part_or_keeps_its_direction(axes):
    """The engine turned by 0.9 rad about an oblique axis: J' R f and J' f with the Jacobians of MuJoCo."""
    model = (car := pushed(axes)).model.model
    rows, data, engine = Rows(model, car.static.preload), mujoco.MjData(model), model.body("engine").id
    turn = np.zeros(model.nv)
    first = int(model.body_dofadr[engine])
    assert model.body_dofnum[engine] == 6
    turn[first : first + 6] = [0.05, -0.02, 0.1, 0.5, 0.6, -0.4]
    mujoco.mj_integratePos(model, data.qpos, turn, 1.0)
    mujoco.mj_fwdPosition(model, data)
    mujoco.mj_fwdVelocity(model, data)
    generalised = []
    for scale in (1.0, 0.0):
        rows.state.applied[:] = scale * np.array([np.linalg.norm(FORCE), np.linalg.norm(MOMENT)])
        rows(model, data)
        generalised.append(data.qfrc_applied.copy())
    linear, angular = jacobians(model, data, engine)
    rotation = data.xmat[engine].reshape(3, 3) if axes == "part" else np.eye(3)
    validated(
        "Applied forces",
        f"force and moment in the axes of the {axes} on an engine turned by 0.9 rad: generalised forces",
        generalised[0] - generalised[1], linear.T @ rotation @ FORCE + angular.T @ rotation @ MOMENT,
        source="closed form: J' R f with the Jacobians of MuJoCo", peak=1e-9,
    )  # fmt: skip


@pytest.mark.parametrize("against", ["", "knuckle_fr"])
def test_the_mean_of_a_follower_force_is_in_the_stiffness(against):
    """K of a follower less K of a fixed force: (J_p less that of the reaction)' [f]x J_r, and the same of moments."""
    more = {"against": against} if against else {}
    follower, fixed = (pushed(axes, mean=0.2, **more) for axes in ("part", "vehicle"))
    model = fixed.model.model
    data, engine = mujoco.MjData(model), model.body("engine").id
    mujoco.mj_fwdPosition(model, data)
    (linear, angular), reaction = jacobians(model, data, engine), np.zeros((2, 3, model.nv))
    if against:
        reaction[:] = jacobians(model, data, model.body(against).id)
    expected = (linear - reaction[0]).T @ skew(0.2 * FORCE) @ angular
    expected += (angular - reaction[1]).T @ skew(0.2 * MOMENT) @ angular
    validated(
        "Applied forces",
        f"geometric stiffness of a mean follower force and moment on the engine{', against a knuckle' * bool(against)}",
        follower.matrices.system.stiffness - fixed.matrices.system.stiffness,
        expected,
        source="closed form: J_p' [f]x J_r + J_r' [m]x J_r",
        peak=1e-4,  # K are central differences of forces of 1e7 N/m
    )


def test_the_mean_of_a_follower_force_on_the_flexible_body_acts_on_its_modes():
    place = {"on": "body", "at": "seat_rail", "force": FORCE.tolist(), "mean": float(np.linalg.norm(FORCE))}
    table = {f"force.a.{key}": value for key, value in place.items()}
    follower, fixed = (Car.load("focus", {**table, "force.a.axes": axes}) for axes in ("part", "vehicle"))
    model, shapes = fixed.model.model, fixed.model.superelement
    data, point = mujoco.MjData(model), np.array(fixed.vehicle.composition.forces[0].at)
    mujoco.mj_fwdPosition(model, data)
    linear, angular = np.zeros((2, 3, model.nv))
    mujoco.mj_jac(model, data, linear, angular, point, model.body("body").id)
    node = shapes.nodes[int(np.argmin(np.linalg.norm(shapes.positions - point, axis=1)))]
    linear[:, fixed.matrices.modal] += shapes.shape_at(node)
    expected = linear.T @ skew(FORCE) @ angular
    assert np.max(np.abs(expected[fixed.matrices.modal])) > 10.0
    found = follower.matrices.system.stiffness - fixed.matrices.system.stiffness
    assert found == pytest.approx(expected, abs=1e-4 * np.max(np.abs(expected)))


def test_both_engines_agree_on_a_mean_follower_force_that_shakes():
    car = pushed("part", mean=0.2, **SHAKE)
    names = ["seat_rail_acc_z", "engine_acc_z", "engine_acc_x"]
    precise, reduced = (car.run(level(car, 3.0), engine=kind, channels=names) for kind in ("mujoco", "reduced"))
    sizes = [np.std(reduced[name] - precise[name]) / np.std(precise[name]) for name in names]
    validated(
        "Applied forces", "engine with a mean follower force that shakes it, 14 Hz: both engines, difference over RMS",
        sizes, 0.0, source="second derivation: MuJoCo", abs=5e-3,
    )  # fmt: skip
    assert energies_of(precise).residual < 5e-3


def test_axes_that_are_none_are_refused():
    with pytest.raises(ConfigurationError, match=r"force\.push\.axes: .* vehicle, part, not 'body'"):
        pushed("body")
    wheel = {"force.a.on": "tyre_fr", "force.a.force": [0, 0, 1], "force.a.axes": "part", "driving.speed": 20.0}
    with pytest.raises(ConfigurationError, match=r"force\.a\.axes: found 'part' on tyre_fr, which turns with the"):
        Car.load("sedan", wheel)
