"""Matrices of the assembled car: symmetric, consistent with the elements, constraints eliminated, published modes."""

import mujoco
import numpy as np
import pytest

from tests.validation import validated
from vehicle.engines.linear.car_matrices import car_matrices
from vehicle.engines.linear.first_order import free_basis
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.rows import Rows, joint_springs
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car


def element_stiffness(car):
    """Return J' K J of all elements and joint springs at the design position, without any geometric part."""
    model, static = car.model.model, car.model.static
    data = mujoco.MjData(model)
    rows = Rows(model, static.preload)
    with installed(rows):
        mujoco.mj_forward(model, data)
    e = rows.layout
    jacobian = data.efc_J.reshape(e.row_count, model.nv)
    diagonal = np.zeros(e.row_count)
    diagonal[e.bushings.rows] = e.bushings.stiffness
    diagonal[e.springs.rows] = e.springs.stiffness
    # Velocities of rotation by another way than that of the callback: the Jacobians of the two sites.
    rotational = np.zeros((model.nv, model.nv))
    for stiffness, sites in zip(e.rotations.stiffness, e.rotations.sites, strict=True):
        moving, carrier = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        mujoco.mj_jacSite(model, data, None, moving, sites[0])
        mujoco.mj_jacSite(model, data, None, carrier, sites[1])
        rotational += stiffness * (moving - carrier).T @ (moving - carrier)
    return jacobian.T @ (diagonal[:, None] * jacobian) + rotational + np.diag(joint_springs(model))


def in_free_motions(car, matrix, *, stuck=True):
    basis = free_basis(car.matrices.system, stuck=stuck)
    mass = basis.T @ car.matrices.system.mass @ basis
    scale = np.linalg.inv(np.linalg.cholesky(mass))
    return scale @ basis.T @ matrix @ basis @ scale.T


def test_without_gravity_the_stiffness_is_that_of_the_elements():
    weightless = Car.load(None, ["gravity=0"])
    stiffness = in_free_motions(weightless, weightless.matrices.system.stiffness)
    elements = in_free_motions(weightless, element_stiffness(weightless))
    # Two derivations: central differences of the forces, and J' K J. Differences of 1e-6 leave 1e-8.
    validated(
        "Linear system", "stiffness of the weightless car, mass-normalised", stiffness, elements, peak=1e-6,
        unit="1/s2",
        source="second derivation: J' K J of all elements",
    )  # fmt: skip


def test_matrices_are_symmetric_and_positive(car):
    matrices = car.matrices
    np.testing.assert_allclose(matrices.system.mass, matrices.system.mass.T, atol=1e-10)
    assert np.linalg.eigvalsh(matrices.system.mass)[0] > 0.0
    np.testing.assert_allclose(matrices.system.damping, matrices.system.damping.T, atol=1e-9)
    assert np.linalg.eigvalsh(matrices.system.damping)[0] > -1e-6
    free = in_free_motions(car, matrices.system.stiffness)
    assert np.linalg.eigvalsh((free + free.T) / 2.0)[0] > 0.0
    # Preloads are in equilibrium, so the tangent is that of a potential: symmetric among the free motions.
    validated(
        "Linear system", "stiffness of the free motions is symmetric", free, free.T, peak=1e-4, unit="1/s2",
        source="conservation: gravity and elements have a potential",
    )  # fmt: skip


def test_ideal_joints_are_eliminated(car):
    matrices = car.matrices
    # Only the rods of the stabilizer on the damper housings are ideal: two balls of three rows.
    assert matrices.system.constraints.shape == (6, 63)
    assert np.linalg.matrix_rank(matrices.system.constraints) == 6
    assert free_basis(matrices.system, stuck=False).shape == (63, 57)
    stuck = free_basis(matrices.system, stuck=True)
    assert stuck.shape == (63, 55)
    validated(
        "Linear system", "free motions of the car violate no ideal joint", matrices.system.constraints @ stuck, 0.0,
        abs=1e-12, source="closed form: A B = 0 for a basis B of the null space of A",
    )  # fmt: skip
    np.testing.assert_allclose(stuck[matrices.dampers], 0.0, atol=1e-12)
    rigid = Car.load(None, ["body.attachment_flexibility=false"])
    # Three more balls a side become ideal.
    assert np.linalg.matrix_rank(rigid.matrices.system.constraints) == 24


def test_energies_of_every_mode_sum_to_one(car):
    modes = car.modes("stuck")
    assert len(modes) > 20
    for mode in modes:
        assert sum(mode.energy.values()) == pytest.approx(1.0, rel=1e-12)
        assert all(-1e-12 <= share <= 1.0 for share in mode.energy.values())
        assert 0.0 < mode.damping_ratio < 1.0
    assert [mode.frequency for mode in modes] == sorted(mode.frequency for mode in modes)
    # The kinetic energy of all groups is that of the mass matrix: no part is forgotten.
    matrices = car.matrices
    total = sum(rows.T @ matrices.body_masses[name] @ rows for name, rows in matrices.body_rows.items())
    total[matrices.modal, matrices.modal] += np.eye(9)
    validated(
        "Linear system", "mass matrix of the car", matrices.system.mass, total, peak=1e-8,
        source="second derivation: kinetic energy of every part and mode",
    )  # fmt: skip


def test_published_modes_with_stuck_dampers(car):
    modes = car.modes("stuck")
    rigid = [mode for mode in modes if mode.frequency < 9.0]
    assert len(rigid) == 6
    (roll,) = [mode for mode in modes if mode.description.startswith("body roll")]
    validated(
        "Published cars", "frequency of body roll, dampers stuck", roll.frequency, 6.5, abs=0.3, unit="Hz",
        source="publication: Bommer 2006, section 3.2.1.1",
    )  # fmt: skip
    engine = [mode.frequency for mode in modes if mode.description.startswith("engine")]
    assert len(engine) == 6 and min(engine) >= 9.0 and max(engine) <= 20.0
    # Five modes of the body share the wheels' vertical motion; the longitudinal wheel modes are damped by half.
    light = [mode for mode in modes if 20.0 < mode.frequency < 40.0 and mode.damping_ratio < 0.2]
    wheel = max(light, key=lambda mode: mode.energy["wheel_fr"])
    assert wheel.energy["wheel_fr"] > 0.25
    validated(
        "Published cars", "frequency of the vertical wheel mode, dampers stuck, fitted", wheel.frequency, 28.0, abs=1.0,
        unit="Hz", source="publication: Bommer 2006, section 3.2.1",
    )  # fmt: skip


def test_sliding_dampers_make_another_car(car):
    stuck, sliding = car.modes("stuck"), car.modes("sliding")
    heave = [next(m.frequency for m in modes if "body heave" in m.description) for modes in (stuck, sliding)]
    assert heave[1] < heave[0]
    # The wheels get their damper: no lightly damped vertical wheel mode is left near 28 Hz.
    damped = [m.damping_ratio for m in sliding if "wheel hop" in m.description]
    assert len(damped) == 2 and min(damped) > 0.1
    for modes, lowest_ratio, highest_ratio in ((stuck, 0.2, 1.0), (sliding, 0.0, 0.1)):
        light = [m for m in modes if 20.0 < m.frequency < 40.0 and m.damping_ratio < 0.06]
        assert lowest_ratio < max(m.energy["wheel_fr"] for m in light) < highest_ratio
    with pytest.raises(ConfigurationError, match=r"damper: .*'loose'"):
        car.modes("loose")


def test_the_matrices_leave_the_model_alone(car):
    before = car.model.model.qpos_spring.copy()
    again = car_matrices(car.model.model, car.model.static)
    np.testing.assert_array_equal(again.system.stiffness, car.matrices.system.stiffness)
    # Compiled code adds up in another order; largest forces 1e4 N, rounded, over the difference step.
    compiled = car_matrices(car.model.model, car.model.static)
    np.testing.assert_allclose(compiled.system.stiffness, again.system.stiffness, rtol=1e-12, atol=1e-4)
    np.testing.assert_array_equal(car.model.model.qpos_spring, before)
    assert mujoco.get_mjcb_control() is None
