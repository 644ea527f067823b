"""Axes of a bushing that is aligned with a line, as at the end of a rod."""

import math

from vehicle.model.parameters.hardpoints import Point, cross, unit

Axes = tuple[Point, Point, Point]
"""Directions of x, y and z of an element in the vehicle frame."""


def axes_along(start: Point, end: Point) -> Axes:
    """Return axes with x from one point to another, y horizontal and z perpendicular; a vertical line keeps y.

    For the mirrored line the axes are mirrored up to the sign of y, on which K and D do not depend; see
    `vehicle.model.parameters.composition.PlacedConnection.table` for a table.

    Args:
        start, end: two different points [m].
    """
    x = unit((end[0] - start[0], end[1] - start[1], end[2] - start[2]))
    level = math.hypot(x[0], x[1])
    y = (0.0, 1.0, 0.0) if level < 1e-6 else (-x[1] / level, x[0] / level, 0.0)
    z = unit(cross(x, y))
    return x, y, z
