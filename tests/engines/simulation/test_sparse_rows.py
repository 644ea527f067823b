"""The sparse form of a run: pattern, factor, and the same motion as with dense rows."""

import ctypes

import mujoco
import numpy as np
import pytest

from vehicle.core.library import core
from vehicle.core.records import packed
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.compiled import CompiledRows
from vehicle.engines.simulation.rows import Rows
from vehicle.engines.simulation.run_model import run_model
from vehicle.engines.simulation.sparse_rows import Pattern, solution_of
from vehicle.runs.car import Car

STEPS = 400

AGREEMENT = 1e-8
"""Largest relative difference of the velocities: MuJoCo's tolerance of 1e-12 in each of some hundred steps."""


def driven(car: Car, *, sparse: bool) -> tuple[np.ndarray, np.ndarray, int]:
    """Return velocities, constraint forces and iterations of MuJoCo's solver over some steps of shaking plates."""
    model, space = run_model(car.model)
    data = mujoco.MjData(model)
    rows = Rows(model, car.model.static.preload, space)
    native, step = CompiledRows(rows), model.opt.timestep
    level, velocities, forces, iterations = data.mocap_pos[:, 2].copy(), [], [], 0
    with installed(rows, native):
        native.attach(data, sparse=sparse)
        for index in range(STEPS):
            # 10 mm at 8 Hz, with the wheels out of phase: all dampers slide, stop and turn.
            angle = 50.0 * step * index + np.arange(len(level))
            data.mocap_pos[:, 2] = level + 0.01 * (np.sin(angle) - np.sin(np.arange(len(level))))
            rows.state.plate_velocity[:, 2] = 0.5 * np.cos(angle)
            rows.state.plate_acceleration[:, 2] = -25.0 * np.sin(angle)
            native.step(data)
            velocities.append(data.qvel.copy())
            forces.append(data.efc_force.copy())
            iterations += int(data.solver_niter[0])
    # MuJoCo's own rows are back, without modal columns.
    assert model.opt.jacobian == mujoco.mjtJacobian.mjJAC_DENSE
    assert data.nJ == len(data.efc_J) != 0
    assert not sparse or data.nJ == data.efc_J_rowadr[-1] + data.efc_J_rownnz[-1]
    assert not sparse or data.nJ <= np.count_nonzero(pattern_of(model, rows).nonzero)
    return np.array(velocities), np.array(forces), iterations


def pattern_of(model: mujoco.MjModel, rows: Rows) -> Pattern:
    """Return where the rows may be nonzero; the format of the model stays dense."""
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_SPARSE
    pattern = Pattern.of(model, rows.layout)
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    return pattern


@pytest.mark.parametrize("name", ["focus", "focus_road", "sedan"])
def test_the_motion_is_that_of_dense_rows(name: str) -> None:
    """The predicted acceleration satisfies MuJoCo's tolerance, so that its solver has nothing to do."""
    car = Car.load(name)
    velocities, forces, iterations = driven(car, sparse=False)
    sparse_velocities, sparse_forces, left = driven(car, sparse=True)
    assert np.max(np.abs(velocities)) > 0.1
    assert np.max(np.abs(sparse_velocities - velocities)) < AGREEMENT * np.max(np.abs(velocities))
    assert np.max(np.abs(sparse_forces - forces)) < AGREEMENT * np.max(np.abs(forces))
    assert iterations >= STEPS
    assert left <= STEPS // 100


def test_the_factor_solves_the_equations_of_a_step() -> None:
    """H x = b of random rows on the columns of the car, against a dense solution."""
    car = Car.load("focus")
    model, space = run_model(car.model)
    rows = Rows(model, car.model.static.preload, space)
    pattern = pattern_of(model, rows)
    nonzero, solution = pattern.nonzero, solution_of(model, rows.layout, pattern)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    random = np.random.default_rng(5)
    jacobian = np.zeros((len(nonzero), len(solution["matrix"])))
    jacobian[:, : model.nv][nonzero] = random.normal(size=np.count_nonzero(nonzero))
    weight = random.uniform(0.1, 1e3, len(nonzero))
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    part = jacobian[:, : model.nv]
    right = np.zeros(len(solution["matrix"]))
    right[: model.nv] = random.normal(size=model.nv)
    expected = np.linalg.solve(mass + part.T @ (weight[:, None] * part), right[: model.nv])
    solution["right"][:] = right
    record = packed("Solution", solution)
    addresses = [array.ctypes.data for array in (data.M, jacobian, weight)] + [record.address]
    core().core_solution_d(*map(ctypes.c_void_p, addresses))
    right = solution["right"]
    np.testing.assert_allclose(right[: model.nv], expected, rtol=0.0, atol=1e-9 * np.max(np.abs(expected)))
    assert len(solution["tiles"]) < 0.9 * (len(solution["starts"]) - 1) * len(solution["starts"]) / 2
