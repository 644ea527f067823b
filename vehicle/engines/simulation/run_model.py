"""Model of a run: prepared for its step, with only the modal coordinates that move the attachments."""

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.element_records import ModalSpace
from vehicle.engines.simulation.law_arrays import model_numbers
from vehicle.engines.simulation.row_layout import read_layout
from vehicle.engines.simulation.rows import joint_dampers, joint_springs, prepare_model
from vehicle.model.assembly.spec import assemble_on
from vehicle.model.flexbody.superelement import attached_nodes

SEEN = 1e-10
"""Relative singular value below which a combination of modes does not move the attachments: round-off."""


def run_model(car: CarModel) -> tuple[mujoco.MjModel, ModalSpace | None]:
    """Build the prepared model of a run, and modal parameters if the callbacks integrate the modes, else None."""
    model = prepared(car.spec, car.model.qpos_spring)
    modes = read_layout(model).modes
    if not modes.size:
        return model, None
    numbers = model_numbers(model)
    # Mode shapes of the nodes with a force or a sensor.
    seen = [
        name for name in numbers if name.startswith(("shape/", "rotation/")) and not name.startswith("shape/place/")
    ]
    shapes = [numbers[name].reshape(3, modes.size) for name in seen]
    mass = model.dof_M0[modes.velocities]
    # Phi m^-1/2; its right singular vectors Q' span the motions that move the attachments.
    scaled = np.concatenate([np.zeros((0, modes.size)), *shapes]) / np.sqrt(mass)
    _, values, basis = np.linalg.svd(scaled, full_matrices=False)
    count = int(np.count_nonzero(values > SEEN * np.max(values, initial=0.0)))
    if count >= modes.size:
        return model, None
    # S = m^-1/2 Q, and the shapes Phi S in the body of the model.
    spread = np.ascontiguousarray(basis[:count].T / np.sqrt(mass)[:, None])
    space = ModalSpace(
        mass=mass.copy(),
        stiffness=joint_springs(model)[modes.velocities],
        damping=joint_dampers(model)[modes.velocities],
        rest=car.model.qpos_spring[modes.positions].copy(),
        spread=spread,
    )
    nodes = attached_nodes(car.superelement, car.vehicle.composition.attachments())
    fewer = assemble_on(car.vehicle, car.superelement.combined(spread, dict.fromkeys(nodes.values())))
    if car.moved is not None:
        car.moved.place(fewer.spec)
    before, after = np.split(car.model.qpos_spring, [modes.positions.start, modes.positions.stop])[::2]
    return prepared(fewer.spec, np.concatenate([before, np.zeros(count), after])), space


def prepared(spec: mujoco.MjSpec, unstrained: Vector) -> mujoco.MjModel:
    """Compile a specification and prepare it for its step; `unstrained`: positions of the joint springs."""
    model = spec.compile()
    model.qpos_spring[:] = unstrained
    prepare_model(model)
    # The recorder computes accelerations from positions; the sensors are for use of the model elsewhere.
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_SENSOR)
    return model
