"""Seats, dashboard and steering wheel, seen through the glass."""

from __future__ import annotations

import numpy as np
import trimesh

from vehicle.shapes.block import box, hull
from vehicle.shapes.hardpoint import Points
from vehicle.shapes.lathe import drum
from vehicle.shapes.placement import joined, placed, shifted
from vehicle.shapes.shape import Array
from vehicle.shapes.tube import rod, tube


def seat(cushion: Array, half_width: float, *, headrests: tuple[float, ...]) -> trimesh.Trimesh:
    """Cushion, leaning back rest and head rests; the cushion's upper side is at the point `cushion` [m].

    Args:
        cushion: middle of the cushion's upper side
        half_width: [m]
        headrests: places of the head rests along y from the middle [m]
    """
    w = half_width
    base = hull(
        [shifted(cushion, x, s * y, z) for s in (-1, 1)
         for x, y, z in ((-0.27, 0.86 * w, -0.01), (-0.29, 0.9 * w, -0.06), (-0.24, 0.9 * w, -0.14), (0.20, w, -0.14),
                         (0.24, w, -0.04), (0.10, w, 0.03), (-0.20, w, 0.02), (0.20, w, -0.03))]
    )  # fmt: skip
    back = hull(
        [shifted(cushion, x, s * y, z) for s in (-1, 1)
         for x, y, z in ((0.16, w, 0.0), (0.27, w, -0.02), (0.34, 0.95 * w, 0.42), (0.25, 0.95 * w, 0.42),
                         (0.30, 0.72 * w, 0.545), (0.36, 0.72 * w, 0.54), (0.19, w, 0.20))]
    )  # fmt: skip
    heads = []
    for y in headrests:
        centre = shifted(cushion, 0.36, y, 0.635)
        heads += [box(centre - (0.042, 0.115, 0.065), shifted(centre, 0.042, 0.115, 0.065), 0.022)]
        heads += [
            rod(shifted(centre, -0.005, s * 0.05, -0.12), shifted(centre, 0.0, s * 0.05, -0.05), 0.007, sides=4)
            for s in (-1, 1)
        ]
    return joined(base, back, heads)


def seats(points: Points) -> trimesh.Trimesh:
    """Both front seats, at the seat hardpoint and its mirror image, and the rear bench."""
    driver = points["seat"]
    passenger = driver * (1.0, -1.0, 1.0)
    bench = np.array([driver[0] + 0.87, 0.0, driver[2] + 0.03])
    return joined(
        seat(driver, 0.26, headrests=(0.0,)),
        seat(passenger, 0.26, headrests=(0.0,)),
        seat(bench, 0.62, headrests=(-0.36, 0.36)),
    )


def seat_rails(points: Points) -> trimesh.Trimesh:
    """Rails of the driver's seat: the measuring point is on them."""
    rail = points["seat_rail"]
    bars = []
    for side in (1.0, -1.0):
        middle = rail * (1.0, side, 1.0)
        bars += [
            box(shifted(middle, -0.22, y - 0.015, -0.016), shifted(middle, 0.3, y + 0.015, 0.012))
            for y in (-0.20, 0.20)
        ]
        bars.append(box(shifted(middle, -0.03, -0.20, -0.008), shifted(middle, 0.03, 0.20, 0.008)))
    return joined(bars)


def dashboard(points: Points) -> trimesh.Trimesh:
    """Dashboard with its cowl, and the steering wheel before the driver."""
    driver = points["seat"]
    x, z = driver[0] - 0.66, driver[2] + 0.36
    half = 0.70
    board = hull(
        [(x + dx, s * half * w, z + dz) for s in (-1, 1)
         for dx, w, dz in ((-0.17, 0.96, 0.02), (-0.02, 1.0, 0.045), (0.07, 1.0, -0.03), (0.05, 1.0, -0.20),
                           (-0.17, 0.96, -0.30))]
    )  # fmt: skip
    centre = np.array([x + 0.20, driver[1], z - 0.035])
    axis = np.array([np.cos(np.deg2rad(24)), 0.0, np.sin(np.deg2rad(24))])
    phi = 2 * np.pi * np.arange(16) / 16
    circle = 0.185 * np.column_stack([np.cos(phi), np.sin(phi), 0 * phi])
    wheel = joined(
        tube(circle, 0.014, sides=5, closed=True),
        drum(0.055, -0.02, 0.012, bevel=0.006, sections=14),
        [rod((0, 0, 0), 0.18 * np.array([np.cos(p), np.sin(p), 0]), 0.013, sides=6) for p in (0.0, 2.0, 4.28)],
    )
    column = rod(centre, centre - 0.22 * axis, 0.03)
    return joined(board, placed(wheel, centre, axis), column)
