"""Fixed frame of a body in the design position, as a reference for its motion: thin rods."""

from __future__ import annotations

import numpy as np

from vehicle.drawing.rendering.body_wireframe import members_of
from vehicle.engines.simulation.car_model import CarModel
from vehicle.model.shapes.shape import Shape
from vehicle.model.shapes.solids import joined, rod

RADIUS = 0.005
"""Radius of the rods of a frame of beams [m]."""

COLOUR = (0.35, 0.38, 0.42, 1.0)


def frame_at_rest(car: CarModel) -> dict[str, Shape]:
    """Return the frame as one shape by name; empty for a body without lines."""
    lines, slim = members_of(car)
    if not len(lines):
        return {}
    ends = np.asarray(car.superelement.positions)[lines]
    mesh = joined([rod(first, second, slim * RADIUS, sides=6) for first, second in ends])
    return {"frame_at_rest": Shape(mesh=mesh, rgba=COLOUR, part="world")}
