"""The one-step map equals a step of the compiled model, and its poles converge to those of the matrices."""

import mujoco
import numpy as np
import pytest

from tests.validation import validated
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.step_map import step_map, step_rows
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.rows import Rows, prepare_model
from vehicle.runs.car import Car


def mapped(car, stuck, step=None):
    rows = step_rows(car.model, car.matrices, step or car.vehicle.solver.timestep)
    form = first_order(car.matrices.system, stuck=stuck)
    return step_map(rows, form), form.basis


@pytest.mark.parametrize("stuck", [False, True])
def test_the_map_is_what_the_model_steps(stuck):
    # Without friction the dampers slide; with more friction than any force they stick.
    car = Car.load(None, [f"damper.coulomb_friction={1e4 if stuck else 0}"])
    one_step, basis = mapped(car, stuck)
    size, steps = basis.shape[1], 50
    start = basis.T @ np.where(np.arange(len(basis)) < 6, 1e-6, 0.0)  # the body shifted and turned on its wheels
    state = np.zeros(len(one_step.matrix))
    state[:size] = start
    model = car.model.spec.compile()
    model.qpos_spring[:] = car.model.model.qpos_spring
    prepare_model(model)
    data = mujoco.MjData(model)
    rows = Rows(model, car.model.static.preload)
    mujoco.mj_integratePos(model, data.qpos, basis @ start, 1.0)
    with installed(rows):
        for _ in range(steps):
            mujoco.mj_step(model, data)
            state = one_step.matrix @ state
    moved = np.zeros(model.nv)
    mujoco.mj_differentiatePos(model, moved, 1.0, model.qpos0, data.qpos)
    expected = basis @ state[:size]
    assert np.max(np.abs(expected)) > 1e-7
    # Ideal joints give a little in the model, and not at all in the map.
    validated(
        "Integration in MuJoCo", f"motion of the car over 50 steps, dampers {'stuck' if stuck else 'sliding'}", moved,
        expected, peak=2e-3, source="second derivation: one-step map from M, C, K",
    )  # fmt: skip


def test_its_poles_come_closer_with_the_square_of_the_step(car):
    """Damping is centred, second order; the frequencies of undamped rows would be of fourth."""
    wheel = 2.0 * np.pi * 58.3  # the highest vibration below 100 Hz, with stuck dampers
    exact = np.linalg.eigvals(first_order(car.matrices.system, stuck=True).state)
    pole = exact[np.argmin(np.abs(np.abs(exact) - wheel) + 1e6 * (exact.imag <= 0.0))]
    error = []
    for step in (1e-3, 5e-4, 2.5e-4):
        poles = np.log(np.linalg.eigvals(mapped(car, True, step)[0].matrix).astype(complex)) / step
        error.append(np.min(np.abs(poles - pole)) / abs(pole))
    validated(
        "Integration in MuJoCo", "pole of the wheel mode at 58 Hz, step 1 ms, relative error", error[0], 0.0, abs=3e-3,
        source="second derivation: pole of the linear system",
    )  # fmt: skip
    assert error[0] / error[1] > 3.5 and error[1] / error[2] > 3.5
