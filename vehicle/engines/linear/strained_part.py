"""The part with the largest motion in a mode, and the parameter of the most strained element, for error messages."""

from __future__ import annotations

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.row_layout import numeric
from vehicle.engines.simulation.rows import Rows, joint_springs
from vehicle.engines.simulation.standing import element_parameter
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.paths import value_of
from vehicle.names import AXES

Complex = npt.NDArray[np.complex128]


def moving_part(matrices: CarMatrices, shape: Complex) -> str:
    """Return the name of the rigid part, or "flexible body", with the largest kinetic energy in a shape (n,)."""
    energy = {
        body: float(np.real(np.vdot(rows @ shape, matrices.body_masses[body] @ (rows @ shape))))
        for body, rows in matrices.body_rows.items()
    }
    energy["flexible body"] = float(np.sum(np.abs(shape[matrices.modal]) ** 2))
    return max(energy, key=lambda name: energy[name])


def holding_parameter(car: CarModel, pole: complex, shape: Complex) -> str:
    """Return path and value of the parameter whose element has the largest work K |r|2 or |s| B |r|2 in a mode.

    Args:
        car: compiled and trimmed car.
        pole: pole s of the mode [rad/s].
        shape: displacements of the mode; (n,).

    Returns:
        Path and value, for example "bushings.suspension_mount.stiffness.z (3e+07)".
    """
    rows = Rows(car.model, car.static.preload)
    data = mujoco.MjData(car.model)
    with installed(rows):
        mujoco.mj_forward(car.model, data)
    e, b, dampers = rows.layout, rows.layout.bushings, rows.layout.dampers
    jacobian = data.efc_J.reshape(e.row_count, car.model.nv)
    square = np.abs(jacobian @ shape) ** 2
    speed = abs(pole)
    work: dict[str, float] = {}
    for name, row_indices, k, c, k2 in zip(rows.names, b.rows, b.stiffness, b.damping, b.branch_stiffness, strict=True):
        for axis, r, stiffness, drag in zip(AXES, row_indices, k + k2, speed * c, strict=True):
            parameter = "stiffness" if stiffness >= drag else "damping"
            work[element_parameter(car.vehicle, name, parameter, axis)] = float(max(stiffness, drag) * square[r])
    rotations = rows.rotation_jacobian(data) @ shape
    resisting = [name for name in rows.names if numeric(car.model, f"law/{name}")[12] > 0.0]  # type: ignore[index]
    for name, stiffness, turn in zip(resisting, e.rotations.stiffness, rotations, strict=True):
        work[element_parameter(car.vehicle, name, "rotational_stiffness", "")] = float(
            stiffness * np.sum(np.abs(turn) ** 2)
        )
    strained = e.springs.stiffness * square[e.springs.rows]
    slid = speed * dampers.laws["viscous_damping"] * np.abs(shape[dampers.dofs]) ** 2
    composition = car.vehicle.composition
    listed = [
        (f"{element.path}.stiffness", value) for element, value in zip(composition.springs, strained, strict=True)
    ]
    listed += [(f"{element.path}.viscous", value) for element, value in zip(composition.dampers, slid, strict=True)]
    for path, value in listed:
        work[path] = max(work.get(path, 0.0), float(value))
    inside = joint_springs(car.model) * np.abs(shape) ** 2
    # The stiffness of unscaled modes is that of their file.
    scaled = car.vehicle.body.frequency_scale != 1.0
    modes = "body.frequency_scale" if scaled else f"the modes of body.superelement = {car.vehicle.body.superelement}"
    work[modes] = float(np.sum(inside[e.modes.velocities]))
    for spring in composition.joint_springs:
        work[f"{spring.path}.{spring.parameter}"] = float(inside[car.model.joint(spring.joint).dofadr[0]])
    path = max(work, key=lambda name: work[name])
    try:
        return f"{path} ({value_of(car.vehicle, path):g})"
    except ConfigurationError:
        return path
