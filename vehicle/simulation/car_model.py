"""A car ready to be stepped: assembled, compiled, trimmed and checked against its time step."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.assembly.spec import assemble
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.flexbody.superelement import Superelement
from vehicle.parameters.vehicle import Vehicle
from vehicle.simulation.callbacks import installed
from vehicle.simulation.element_rows import ElementRows
from vehicle.simulation.static_trim import StaticTrim, joint_spring_stiffness, trim
from vehicle.simulation.step_weights import explicit_share

Vector = npt.NDArray[np.float64]

LARGEST_PHASE = 2.2
"""Largest w h of the stiffest motion; the step of the element rows is stable up to sqrt(6) = 2.45."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarModel:
    """Compiled model of a car with its preloads; the model is as generated, `prepare_model` comes with a run.

    Attributes:
        vehicle: parameters.
        superelement: flexible body with the masses that are fixed to it.
        spec: specification the model was compiled from.
        origins: where each body frame sits in the design position [m], by body name.
        model: compiled and trimmed model.
        static: its preloads and loads.
    """

    vehicle: Vehicle
    superelement: Superelement
    spec: mujoco.MjSpec
    origins: Mapping[str, Vector]
    model: mujoco.MjModel
    static: StaticTrim


def build_model(vehicle: Vehicle, trimmed_body: Superelement) -> CarModel:
    """Assemble, compile and trim a car.

    Args:
        vehicle: parameters.
        trimmed_body: superelement of its body.

    Returns:
        The car model.

    Raises:
        ConfigurationError: the time step is too long for the stiffest part; the message says how long it may be.
        SimulationError: MuJoCo refuses the model, or the car is not held.
    """
    assembly = assemble(vehicle, trimmed_body)
    try:
        model = assembly.spec.compile()
    except ValueError as error:
        raise SimulationError(f"MuJoCo refuses the generated car: {' '.join(str(error).split())}") from None
    rows = ElementRows(model)
    static = trim(rows)
    _check_step(rows.anew(static.preload))
    return CarModel(
        vehicle=vehicle,
        superelement=assembly.superelement,
        spec=assembly.spec,
        origins=assembly.origins,
        model=model,
        static=static,
    )


def _check_step(rows: ElementRows) -> None:
    """Refuse a step at which the explicit stiffness of the stiffest part would be unstable."""
    model = rows.model
    data = mujoco.MjData(model)
    with installed(rows):
        mujoco.mj_forward(model, data)
    e = rows.elements
    step = model.opt.timestep
    jacobian = data.efc_J.reshape(e.row_count, model.nv)
    explicit = np.zeros(e.row_count)
    # M - h2 sum (1/4 - beta) J' K J must stay positive; a stiffness with beta 1/4 is stable whatever it is.
    static_part, branch = (explicit_share(average) for average in (rows.average, rows.branch_average))
    explicit[e.rows] = static_part * e.stiffness + branch * e.branch_stiffness * rows.decay
    explicit[e.springs] = e.spring_stiffness
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    stiffness = jacobian.T @ (explicit[:, None] * jacobian)
    turned = rows.rotation_jacobian(data)
    rotational = explicit_share(0.0) * e.rotation_stiffness[:, 0]
    stiffness += np.einsum("n,nij,nik->jk", rotational, turned, turned)
    stiffness[np.diag_indices(model.nv)] += joint_spring_stiffness(model)
    factor = np.linalg.cholesky(mass)
    reduced = np.linalg.solve(factor, np.linalg.solve(factor, stiffness).T)
    fastest = float(np.sqrt(max(np.linalg.eigvalsh((reduced + reduced.T) / 2.0)[-1], 0.0)))
    if fastest * step > LARGEST_PHASE:
        raise ConfigurationError(
            f"solver.timestep: found {step:g} s, but the stiffest part of this car vibrates at "
            f"{fastest / (2.0 * np.pi):.0f} Hz; give at most {LARGEST_PHASE / fastest:.2g} s, "
            "or a lower stiffness where it is a mistake"
        )
