"""Instant centres of a wheel from its hardpoints: lines without power, and their graphical construction.

A rigid link to the body, or a slide through a fixed point, cannot exchange power with the knuckle along its line: for a
unit vector d through a point p, d . (v + w x p) = 0. Five lines leave one motion. Nothing of the simulator is used.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.optimize import fsolve
from scipy.spatial.transform import Rotation

Vector = npt.NDArray[np.float64]
Line = tuple[Vector, Vector]


class Centres(NamedTuple):
    """Roll centre height [m], front-view and side-view swing arms [m], support angles [deg]."""

    roll_centre: float
    front_arm: float
    side_arm: float
    brake: float
    drive: float


def rod(points: Mapping[str, npt.ArrayLike], first: str, second: str) -> Line:
    """Line of a rod of the right side."""
    p, q = (np.array(points[f"{name}"], dtype=float) for name in (first, second))
    return p, (q - p) / np.linalg.norm(q - p)


def across(point: Vector, axis: Vector) -> list[Line]:
    """Two lines through a point at right angles to an axis: a slide along it."""
    return [(point, direction) for direction in np.linalg.svd(axis[None])[2][1:]]


def motion(lines: Sequence[Line], centre: Vector) -> tuple[Vector, Vector]:
    """Velocity of the wheel centre and angular velocity, for a rising velocity of 1."""
    rows = np.array([np.concatenate([d, np.cross(p, d)]) for p, d in lines])
    assert rows.shape == (5, 6)
    screw = np.linalg.svd(rows)[2][-1]
    velocity = screw[:3] + np.cross(screw[3:], centre)
    return velocity / velocity[2], screw[3:] / velocity[2]


def centres(
    bounce: tuple[Vector, Vector], roll: tuple[Vector, Vector], centre: Vector, contact: Vector, towards: float
) -> Centres:
    """Construct the centres of a right wheel: normals of the velocities of two points meet.

    The swing centres lie in planes through the wheel centre; the lines of roll centre and brake forces begin at the
    contact point, which a cambered and steered wheel has beside these planes.
    """
    side, front = (meeting(*move, centre, contact, plane) for move, plane in ((bounce, (0, 2)), (roll, (1, 2))))
    below = np.array([centre[0], centre[1], contact[2]])
    (side_x, side_z), (front_y, _) = (
        meeting(*move, centre, below, plane) for move, plane in ((bounce, (0, 2)), (roll, (1, 2)))
    )
    share = contact[1] / (contact[1] - front[0])
    return Centres(
        roll_centre=float(share * (front[1] - contact[2])),
        front_arm=float(centre[1] - front_y),
        side_arm=float(towards * (side_x - centre[0])),
        brake=float(np.degrees(np.arctan(towards * (side[1] - contact[2]) / (side[0] - contact[0])))),
        drive=float(np.degrees(np.arctan(towards * (side_z - centre[2]) / (side_x - centre[0])))),
    )


def meeting(velocity: Vector, rotation: Vector, first: Vector, second: Vector, plane: tuple[int, int]) -> Vector:
    """Point of a plane where the normals to the velocities of two points meet."""
    rows, sides = [], []
    for point in (first, second):
        # Motion in the plane alone: both points keep their distance from it.
        moved = (velocity + np.cross(rotation, point - first))[list(plane)]
        rows.append(moved)
        sides.append(moved @ point[list(plane)])
    return np.linalg.solve(np.array(rows), np.array(sides))


def rod_axle(
    points: Mapping[str, npt.ArrayLike], rods: Sequence[tuple[str, str]], height: float
) -> Callable[[str], Vector]:
    """Position of the points of a knuckle on five rods whose wheel centre is lifted by a height [m]."""
    p = {name: np.array(value, dtype=float) for name, value in points.items()}
    centre = p["wheel_center"]

    def placed(x: Vector, name: str) -> Vector:
        return np.asarray(centre + x[:3] + Rotation.from_rotvec(x[3:]).apply(p[name] - centre))

    def gaps(x: Vector, lifted: float) -> list[float]:
        lengths = [
            float(np.linalg.norm(placed(x, outer) - p[inner]) - np.linalg.norm(p[outer] - p[inner]))
            for outer, inner in rods
        ]
        return [*lengths, float(x[2] - lifted)]

    x = np.zeros(6)
    for part in np.linspace(0.1, 1.0, 10):
        x = fsolve(gaps, x, args=(part * height,), xtol=1e-13)
    return lambda name: placed(x, name)
