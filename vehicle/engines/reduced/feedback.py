"""Inputs of a step that depend on the motion at its beginning: tyre loads on slopes, controlled dampers, own laws.

The poles contain the static load of a rolling tyre on the slope z'/V, and the softest setting of a controlled damper.
What the current load, another slope and another setting add is an input of the step; `vehicle/core/source/march.c` has
the equations. Its sensors, tyre loads and the velocities that controlled dampers measure, are sums over the poles, like
damper velocities.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.engines.reduced.pole_model import Outputs, PoleModel
from vehicle.engines.reduced.validity import tyre_outputs
from vehicle.model.laws.control_laws import NUMBERS, RING, in_steps, pack
from vehicle.model.laws.law_by_address import RECORD, law_by_address
from vehicle.model.parameters.force_elements import Damper


class Feedback(NamedTuple):
    """Rolling tyres on slopes, controlled dampers and dampers by address of a car, which act by its sensors.

    Attributes:
        tyres: number of driven plates whose tyre loads act on the slope.
        plate_inputs: number of plates whose z is an input; m for a car with slow poles, else 0.
        controlled: indices of the k controlled dampers.
        settings: their records of `vehicle.model.laws.control_laws`; (k,).
        memory: states of their laws, with delayed settings; (k, ...).
        own: indices of the dampers with a law by address; (j,).
        own_laws: their records of `vehicle.model.laws.law_by_address`; (j,).
        outside: share of the law [-], and coefficient [N s/m] and half force [N] from outside; (k, 3).
        owners: index of the damper of each group of Jenkins elements; (g,).
        sides: indices of the dampers whose friction limit depends on their side force; (k,).
    """

    tyres: int
    plate_inputs: int
    controlled: npt.NDArray[np.int64]
    settings: npt.NDArray[Any]
    memory: Vector
    own: npt.NDArray[np.int64]
    own_laws: npt.NDArray[Any]
    outside: Vector
    owners: npt.NDArray[np.int64]
    sides: npt.NDArray[np.int64]


def sensor_outputs(
    model: PoleModel, dampers: Sequence[Damper], columns: Sequence[int], tyre_load: Mapping[str, float] | None
) -> Outputs:
    """Return the sensors of a car as outputs.

    Args:
        model: pole model of the car.
        dampers: laws of all dampers.
        columns: indices of the driven plates.
        tyre_load: static tyre loads [N] by wheel; None if no current loads act on the slopes.

    Returns:
        F_z/F_0 - 1 of the driven tyres, velocities of wheel and body at each controlled damper [m/s], side forces
        without their static values [N], then displacements of the dampers by address [m].
    """
    inputs = model.matrices.system.inputs
    rates = np.zeros((0, len(model.poles)), dtype=np.complex128)
    if any(damper.controlled for damper in dampers):
        rates = model.matrices.sensors @ (model.modal * model.poles)
    sides = model.matrices.sides
    if sides.dampers.size:
        # u' of a pole is s u.
        forces = sides.displacement @ model.modal + sides.velocity @ (model.modal * model.poles)
        rates = np.concatenate([rates, forces + sides.branch @ model.branch])
    by_address = [index for index, damper in enumerate(dampers) if damper.function is not None]
    if by_address:
        rates = np.concatenate([rates, model.matrices.system.slide_rows[by_address] @ model.modal])
    no_plates = np.zeros((len(rates), len(inputs)))
    velocities = Outputs(poles=rates, height=no_plates, velocity=no_plates)
    if tyre_load is None:
        return velocities
    tyres, loads = list(columns), tyre_outputs(model)
    static = np.array([tyre_load[inputs[tyre]] for tyre in tyres])[:, None]
    # F_z/F_0 - 1 is the dynamic load over the static one.
    return loads.part(tyres).changed(lambda rows: rows / static) + velocities


def sensor_laws(
    model: PoleModel, dampers: Sequence[Damper], columns: Sequence[int], tyre_load: Mapping[str, float] | None
) -> Vector:
    """Return the contributions of the forces g of the laws over displacement to the sensors of a car; (sensors, laws).

    Args:
        model, dampers, columns, tyre_load: see `sensor_outputs`.
    """
    inputs, matrices = model.matrices.system.inputs, model.matrices
    loads = [] if tyre_load is None else [(tyre, tyre_load[inputs[tyre]]) for tyre in columns]
    # g acts on a load at once, F_z - g, and on velocities and displacements by the poles only.
    tyres = [[-1.0 / load if law.plate == tyre else 0.0 for law in model.laws] for tyre, load in loads]
    others = np.zeros((len(matrices.sensors), len(model.laws)))
    shape = (-1, len(model.laws))
    by_address = np.zeros((sum(damper.function is not None for damper in dampers), len(model.laws)))
    return np.concatenate([np.reshape(tyres, shape), others, matrices.sides.laws.reshape(shape), by_address])


def feedback_at_rest(
    dampers: Sequence[Damper],
    owners: npt.NDArray[np.int64],
    sides: npt.NDArray[np.int64],
    tyres: int,
    plate_inputs: int,
    timestep: float,
) -> Feedback:
    """Return the feedback of a car at rest.

    Args:
        dampers: laws of all dampers.
        owners, sides, tyres, plate_inputs: see `Feedback`.
        timestep: time step [s].
    """
    controlled = [index for index, damper in enumerate(dampers) if damper.controlled]
    numbers = [pack(damper.controlled) for damper in dampers if damper.controlled]
    settings = in_steps(np.reshape(numbers, (-1, NUMBERS)), timestep)
    memory = np.zeros((len(controlled), RING + 1 + int(np.max(settings["lag"], initial=0.0))))
    # At rest a controlled damper is soft, and so are the settings that are still on their way.
    memory[:] = settings["softest"][:, None]
    by_address = [(index, damper.function) for index, damper in enumerate(dampers) if damper.function is not None]
    return Feedback(
        tyres=tyres,
        plate_inputs=plate_inputs,
        controlled=np.array(controlled, dtype=np.int64),
        settings=settings,
        memory=memory,
        own=np.array([index for index, _ in by_address], dtype=np.int64),
        own_laws=np.array([law_by_address(name).record(timestep) for _, name in by_address], dtype=RECORD),
        # The whole law, and neither a coefficient nor a force of another program.
        outside=np.tile([1.0, 0.0, 0.0], (len(controlled), 1)),
        owners=owners,
        sides=sides,
    )
