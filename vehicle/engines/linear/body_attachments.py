"""Elements attached to the body of a car, as rows over the coordinates of the free body.

The forces F of an element move the body by the generalised forces g = J' F on its coordinates: the six of its rigid
motion and the amplitudes of its modes. J has a row for each load channel of the element, in the axes of the design
position.
"""

from dataclasses import dataclass

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.row_layout import numeric
from vehicle.names import AXES

BODY = "body"
RIGID = 6
"""Number of coordinates of the rigid motion."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Attachment:
    """Element attached to the body.

    Attributes:
        name: name of the element.
        channels: its load channels; (c,).
        rows: displacement of its end on the body per body coordinate, positive along the force on the body;
            (c, 6 + k).
    """

    name: str
    channels: tuple[str, ...]
    rows: Vector


def body_coordinates(car: CarModel, matrices: CarMatrices) -> list[int]:
    """Return the velocity coordinates of the body: six of its rigid motion, and its k modes."""
    first = int(car.model.joint(BODY).dofadr[0])
    return [*range(first, first + RIGID), *range(matrices.modal.start, matrices.modal.stop)]


def body_attachments(car: CarModel, matrices: CarMatrices) -> list[Attachment]:
    """Return the connections and springs between the body and other parts or the ground."""
    model, data = car.model, mujoco.MjData(car.model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    body, first = model.body(BODY).id, int(model.joint(BODY).dofadr[0])
    modes = matrices.modal.stop - matrices.modal.start

    def rows(element: str, point: Vector) -> Vector:
        # Displacement of the point: by the rigid motion of the body, then by its modes in body axes, which are those
        # of the car.
        rigid = np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, rigid, None, point, body)
        shape = numeric(model, f"shape/{element}")
        modal = np.zeros((3, modes)) if shape is None else shape.reshape(3, -1)
        return np.hstack([rigid[:, first : first + RIGID], modal])

    attachments = []
    for connection in car.vehicle.composition.connections:
        # The load channels are forces on the moving part.
        sign = float(connection.moving == BODY) - float(connection.carrier == BODY)
        if sign:
            element_type = "ball" if connection.law is None else "bushing"
            attachments.append(
                Attachment(
                    name=connection.name,
                    channels=tuple(f"{connection.name}_force_{axis}" for axis in AXES),
                    rows=sign * rows(f"{element_type}/{connection.name}", np.asarray(connection.at)),
                )
            )
    for spring in car.vehicle.composition.springs:
        if BODY in spring.parts:
            low, high = (np.array(point) for point in spring.at)
            along = (high - low) / np.linalg.norm(high - low)
            above = spring.parts[1] == BODY
            end = rows(spring.name, high if above else low)
            attachments.append(
                Attachment(
                    name=spring.name,
                    channels=(f"{spring.name}_force",),
                    # The spring pushes its ends apart.
                    rows=((along if above else -along) @ end)[None, :],
                )
            )
    return attachments
