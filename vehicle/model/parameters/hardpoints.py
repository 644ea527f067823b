"""Points of the car in its design position, in the vehicle frame: x to the rear, y to the driver's right, z up [m].

And the axes of a bushing that is aligned with a line, as at the end of a rod.
"""

import itertools
import math
from collections.abc import Mapping

from vehicle.errors import ConfigurationError

Point = tuple[float, float, float]

Axes = tuple[Point, Point, Point]
"""Directions of x, y and z of an element in the vehicle frame."""

COINCIDENT_M = 1e-3
"""Minimum distance of two hardpoints of one part [m]; closer points count as coincident."""

LARGEST_M = 20.0
"""Maximum coordinate of a hardpoint [m]; larger values are millimetres."""

SMALLEST_SINE = 0.02
"""Minimum sine of the angle at the first of three points of an arm; smaller: the points are collinear."""


def mirrored(point: Point, sign: float) -> Point:
    """Return a point of the right side (sign 1) or its mirror image on the left side (sign -1)."""
    return (point[0], sign * point[1], point[2])


def cross(a: Point, b: Point) -> Point:
    """Return the vector product."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(vector: Point) -> Point:
    """Return the unit vector of this direction."""
    length = math.hypot(*vector)
    return (vector[0] / length, vector[1] / length, vector[2] / length)


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


def require_point(path: str, point: Point, *, right: bool) -> None:
    """Check the coordinates of a point.

    Args:
        path: path of the parameter.
        point: coordinates [m].
        right: the point must be on the right side.

    Raises:
        ConfigurationError: not three finite numbers, in millimetres, or on the wrong side.
    """
    if len(point) != 3:
        raise ConfigurationError(f"{path}: must be a list of 3 numbers [m], not {point!r}")
    if not all(map(math.isfinite, point)):
        raise ConfigurationError(f"{path}: must be finite numbers [m], not {list(point)}")
    if max(map(abs, point)) > LARGEST_M:
        raise ConfigurationError(
            f"{path}: found {list(point)} m, must be within {LARGEST_M} m; probably mm: give metres"
        )
    if right and point[1] <= 0.0:
        raise ConfigurationError(
            f"{path}: found y = {point[1]} m, must be above 0: give the points of the right side, the left side "
            "is mirrored"
        )


def require_apart(points: Mapping[str, Point]) -> None:
    """Check that the points of a part do not coincide; points [m] by their paths.

    Raises:
        ConfigurationError: two points coincide.
    """
    for (first, a), (second, b) in itertools.combinations(points.items(), 2):
        if (distance := math.dist(a, b)) < COINCIDENT_M:
            raise ConfigurationError(
                f"{first}, {second}: coincide (distance {distance:.3g} m); they must be more than {COINCIDENT_M} m "
                "apart"
            )


def require_triangle(points: Mapping[str, Point]) -> None:
    """Check that the first three points of an arm span a triangle.

    Raises:
        ConfigurationError: the points are collinear.
    """
    corner, first, second = list(points.values())[:3]
    u, v = ((end[0] - corner[0], end[1] - corner[1], end[2] - corner[2]) for end in (first, second))
    if math.hypot(*cross(u, v)) / (math.hypot(*u) * math.hypot(*v)) < SMALLEST_SINE:
        raise ConfigurationError(
            f"{', '.join(points)}: lie on one line; an A-arm needs three points that span a triangle"
        )
