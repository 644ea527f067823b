"""Outline of an estate car: plan curve, waist, sill and roof rails, fitted to the hardpoints.

The curves of `estate.toml` are in coordinates of a reference car on the road (X from the front bumper, Y to the right,
H above the road) and are mapped piecewise linearly to the vehicle: the wheel arches to the wheels, the roof to its
output point.
"""

import tomllib
from dataclasses import dataclass
from importlib import resources

import numpy as np

from vehicle.arrays import Vector
from vehicle.model.shapes.shape import Points, Sizes
from vehicle.model.shapes.surface import spline

DRAWING = tomllib.loads((resources.files(__package__) / "estate.toml").read_text(encoding="utf-8"))
WHEEL_TO_SIDE = 0.103  # [m] lateral distance from the middle plane of the wheel to the side of the body
ARCH_GAP = 0.036  # [m] gap between free tyre and edge of the arch

PLAN_POINTS, WAIST, SILL, CANT_RAIL = (np.array(DRAWING[name]) for name in ("plan", "waist", "sill", "cant_rail"))
INSETS = [np.array(DRAWING[f"{name}_inset"]) for name in ("front", "rear", "side")]
MIRROR = np.array([1.0, -1.0])
_WHOLE = spline(np.vstack([PLAN_POINTS[1:3][::-1] * MIRROR, PLAN_POINTS, PLAN_POINTS[-3:-1][::-1] * MIRROR]), 1201)
# the curve extends past the middle at both ends, so that the halves join without a crease
PLAN = np.vstack([PLAN_POINTS[:1], _WHOLE[_WHOLE[:, 1] > 1e-3], PLAN_POINTS[-1:]])
NORMAL = np.column_stack([-np.gradient(PLAN[:, 1]), np.gradient(PLAN[:, 0])])
NORMAL[[0, -1], 1] = 0.0  # ends are in the middle plane
NORMAL = NORMAL / np.linalg.norm(NORMAL, axis=1)[:, None]
STATION = np.linspace(0, 1, len(PLAN))  # runs along the plan curve
THIRD = len(PLAN) // 3


@dataclass(frozen=True, slots=True)
class Outline:
    """Mapping of the reference drawing to a vehicle."""

    x_knots: Vector
    """vehicle x of the four reference stations [m]"""
    z_knots: Vector
    """vehicle z of the three reference heights [m]"""
    widen: float
    """vehicle width over reference width"""
    arch_radius: float
    """radius of both wheel arches [m]"""

    def place(self, reference: Vector) -> Vector:
        """Convert reference points (X, Y, H), shape (..., 3), to vehicle points; extrapolate linearly."""
        X, Y, H = np.moveaxis(np.asarray(reference, dtype=float), -1, 0)
        x, z = _linear(X, DRAWING["reference_x"], self.x_knots), _linear(H, DRAWING["reference_h"], self.z_knots)
        return np.stack([x, Y * self.widen, z], axis=-1)

    def height(self, z: float | Vector) -> Vector:
        """Return the reference height H [m] of a vehicle height z."""
        return _linear(np.asarray(z, dtype=float), self.z_knots, DRAWING["reference_h"])

    def along(self, x: float | Vector) -> Vector:
        """Return the reference X [m] of a vehicle x."""
        return _linear(np.asarray(x, dtype=float), self.x_knots, DRAWING["reference_x"])

    def arch_centre(self, axle: int) -> tuple[float, float]:
        """Return vehicle x and z [m] of the centre of the front (0) or rear (1) arch."""
        return float(self.x_knots[1 + axle]), float(self.z_knots[1])

    def side(self, station: Vector, height: Vector, lift: float = 0.0) -> Vector:
        """Return vehicle points of the right lower body surface, shape (..., 3).

        The plan curve is moved inward by inset(H), which blends between side and ends by the direction of the normal,
        and outward by a flare around the wheel arches.

        Args:
            station: parameter of the plan curve, 0 at the front middle, 1 at the rear middle
            height: reference height H [m], same shape
            lift: additional distance outward [m]
        """
        X, Y = (np.interp(station, STATION, PLAN[:, k]) for k in (0, 1))
        nx, ny = (np.interp(station, STATION, NORMAL[:, k]) for k in (0, 1))
        front, rear, side = (np.interp(height, *table.T) for table in INSETS)
        # nx^2 + ny^2 = 1: weights of the inset of the ends and of the sides.
        inset = nx**2 * np.where(X < 2.0, front, rear) + ny**2 * side - lift
        # in a corner the inset must not move a point across the middle plane
        x, y = X - inset * nx, np.maximum(Y - inset * ny, 0.0)
        points = self.place(np.stack([x, y, height], axis=-1))
        for axle in (0, 1):
            cx, cz = self.arch_centre(axle)
            gap = np.hypot(points[..., 0] - cx, points[..., 2] - cz) - self.arch_radius
            # Flare of 10 mm on the side faces, which fades with the distance from the arch.
            points[..., 1] += 0.010 * ny**2 * np.exp(-((np.maximum(gap, 0) / 0.045) ** 2))
        return points

    def waist(self, station: Vector) -> Vector:
        """Return the reference height [m] of the upper edge of the lower body at stations of the plan curve."""
        height: Vector = np.interp(np.interp(station, STATION, PLAN[:, 0]), *WAIST.T)
        return height


def station_at(X: float | Vector) -> Vector:
    """Return the station of the plan curve at a reference X [m]."""
    return np.asarray(np.interp(X, PLAN[:, 0], STATION))


def station_front(Y: float | Vector) -> Vector:
    """Return the station of the plan curve at a reference Y [m] on the front."""
    return np.asarray(np.interp(Y, PLAN[:THIRD, 1], STATION[:THIRD]))


def station_rear(Y: float | Vector) -> Vector:
    """Return the station of the plan curve at a reference Y [m] on the rear."""
    return np.asarray(np.interp(Y, PLAN[: -THIRD - 1 : -1, 1], STATION[: -THIRD - 1 : -1]))


OUTLINE = ("wheel_center", "tyre_patch", "rear_axle", "roof")


def outline(points: Points, size: Sizes) -> Outline:
    """Fit the drawing to a vehicle: x at front, axles, rear; z at plate, wheel centre, roof; width by the track."""
    wheel, patch, rear = points["wheel_center"], points["tyre_patch"], float(points["rear_axle"][0])
    return Outline(
        np.array([0.0, wheel[0], rear, rear + size["rear_overhang"]]),
        np.array([patch[2], wheel[2], points["roof"][2]]),
        float(wheel[1] + WHEEL_TO_SIDE) / float(DRAWING["half_width"]),
        float(wheel[2] - patch[2]) + size["tyre_deflection"] + ARCH_GAP,
    )


def _linear(values: Vector, knots: tuple[float, ...] | Vector, targets: tuple[float, ...] | Vector) -> Vector:
    a, b = np.asarray(knots, dtype=float), np.asarray(targets, dtype=float)
    # Clipped to the outer segments: linear beyond the ends, which np.interp is not.
    i = np.clip(np.searchsorted(a, values) - 1, 0, len(a) - 2)
    result: Vector = b[i] + (values - a[i]) * (b[i + 1] - b[i]) / (a[i + 1] - a[i])
    return result
