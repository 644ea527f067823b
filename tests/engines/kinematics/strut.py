"""Kinematics of an ideal MacPherson strut by root finding, without bodies and without Jacobians."""

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt
from scipy.optimize import fsolve
from scipy.spatial.transform import Rotation

Vector = npt.NDArray[np.float64]
POINTS = (
    *("wheel_center", "lower_ball", "arm_front", "arm_rear"),
    *("strut_top", "damper_bottom", "tie_outer", "tie_inner"),
)


def strut_geometry(points: Mapping[str, Sequence[float]], height: float) -> tuple[Vector, Vector]:
    """Displacement [m] and rotation matrix of the right wheel whose centre is lifted by a height [m].

    Six equations for six coordinates: the arm keeps the lower ball on a circle (two lengths), the rod the outer tie
    point on a sphere, the strut top lies on the line through the damper that turns with the knuckle, and the height.
    """
    p = {name: np.array(points[f"{name}_fr"]) for name in POINTS}
    center, line = p["wheel_center"], p["strut_top"] - p["damper_bottom"]
    across = np.linalg.svd(line[None])[2][1:]

    def gaps(x: Vector, lifted: float) -> list[float]:
        turned = Rotation.from_rotvec(x[3:])

        def now(name: str) -> Vector:
            return np.asarray(center + x[:3] + turned.apply(p[name] - center))

        lengths = [
            float(np.linalg.norm(now(moving) - p[fixed]) - np.linalg.norm(p[moving] - p[fixed]))
            for moving, fixed in (("lower_ball", "arm_front"), ("lower_ball", "arm_rear"), ("tie_outer", "tie_inner"))
        ]
        beside = across @ turned.inv().apply(p["strut_top"] - now("damper_bottom"))
        return [*lengths, *beside, x[2] - lifted]

    x = np.zeros(6)
    for share in np.linspace(0.1, 1.0, 10):
        x = fsolve(gaps, x, args=(share * height,), xtol=1e-13)
    return x[:3], np.asarray(Rotation.from_rotvec(x[3:]).as_matrix())


def camber_and_toe(turn: Vector) -> tuple[float, float]:
    """Camber, top outwards, and toe, front inwards [deg], of a right wheel turned by a matrix."""
    outwards = turn[:, 1]
    return float(-np.degrees(np.arcsin(outwards[2]))), float(-np.degrees(np.arctan2(outwards[0], outwards[1])))
