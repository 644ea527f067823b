"""MacPherson strut of the right side: damper tube and rod, coil spring, top mount."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import trimesh
from numpy.typing import ArrayLike

from vehicle.shapes import palette
from vehicle.shapes.placement import joined, placed
from vehicle.shapes.shape import Array, Piece, Points, Sizes
from vehicle.shapes.solids import drum, lathe, tube
from vehicle.shapes.surface import helix

STRUT = ("damper_bottom", "spring_lower", "strut_top")
SEAT_BELOW_TOP = 0.014  # [m] the upper spring seat lies this far below the strut top
HOUSING_SHARE = 0.34  # the housing ends at this share of the way from the lower seat to the strut top
LOWEST_TURN = 0.60  # radius of the lowest turn over that of the others: the tyre is close there


class StrutAxis(NamedTuple):
    """Axis of the strut with the places along it."""

    origin: Array
    """damper bottom, shape (3,) [m]"""
    axis: Array
    """unit vector to the strut top, shape (3,)"""
    seat: float
    """distance of the lower spring seat [m]"""
    top: float
    """distance of the strut top [m]"""

    def turned(self, profile: ArrayLike, sections: int, *, closed: bool = False) -> trimesh.Trimesh:
        """A profile (r, distance along the axis) [m] turned about the axis."""
        return self.place(lathe(profile, sections=sections, closed=closed))

    def place(self, mesh: trimesh.Trimesh) -> trimesh.Trimesh:
        """A mesh made about z, put onto the axis."""
        return placed(mesh, self.origin, self.axis)


def strut_axis(points: Points) -> StrutAxis:
    """The axis from the damper bottom to the strut top."""
    origin = points["damper_bottom"]
    along = points["strut_top"] - origin
    top = float(np.linalg.norm(along))
    return StrutAxis(origin, along / top, float((points["spring_lower"] - origin) @ (along / top)), top)


def damper_tube(points: Points, size: Sizes) -> list[Piece]:
    """Housing tube closed by a rolled cap, and the dish on it that carries the spring: small, to clear the tyre."""
    strut = strut_axis(points)
    r, end = size["damper_tube_radius"], strut.seat + HOUSING_SHARE * (strut.top - strut.seat)
    profile = [(0, -0.045), (r - 0.004, -0.045), (r, -0.040), (r, end - 0.008)]
    profile += [(r - 0.007, end), (0.014, end + 0.002), (0, end + 0.004)]
    r, s = r - 0.001, strut.seat
    rim = LOWEST_TURN * size["spring_coil_radius"] + size["spring_wire_radius"] + 0.003
    dish = [(r, s - 0.020), (rim - 0.010, s - 0.004), (rim, s + 0.006), (rim - 0.011, s), (r, s)]
    return [
        Piece("", strut.turned(profile, 10), palette.DAMPER),
        Piece("spring_seat_lower", strut.turned(dish, 16, closed=True), palette.DARK_STEEL),
    ]


def damper_rod(points: Points, size: Sizes) -> list[Piece]:
    """Polished rod from inside the housing to the top mount; dish of the spring under the mount; rubber bellows."""
    strut = strut_axis(points)
    top, travel = strut.top, strut.top - strut.seat
    low = strut.seat + 0.5 * HOUSING_SHARE * travel
    profile = [(0, low), (0.010, low), (0.010, top), (0.007, top + 0.002), (0.007, top + 0.040), (0, top + 0.040)]
    rim, seat = size["spring_coil_radius"] + 0.013, top - SEAT_BELOW_TOP
    dish = [(0.009, seat - 0.004), (rim - 0.006, seat), (rim, seat - 0.008), (rim - 0.002, seat + 0.004)]
    dish += [(0.048, seat + 0.005), (0.009, seat + 0.012)]
    high, folds, pitch = seat - 0.004, 3, 0.10 * travel
    bellows = [(0.0105, high), (0.018, high)]
    for k in range(folds):
        bellows += [(0.027 - 0.002 * k, high - (k + 0.4) * pitch), (0.018 - 0.001 * k, high - (k + 1) * pitch)]
    bellows.append((0.0105, high - folds * pitch))
    return [
        Piece("", strut.turned(profile, 10), palette.ROD),
        Piece("spring_seat_upper", strut.turned(dish, 14, closed=True), palette.DARK_STEEL),
        Piece("bump_stop", strut.turned(bellows, 10, closed=True), palette.RUBBER),
    ]


def top_mount(points: Points, size: Sizes) -> list[Piece]:
    """Rubber cone with its middle at the strut top; steel plate over it with three studs and the rod's nut."""
    strut = strut_axis(points)
    t = strut.top
    cone = [(0.0, t), (0.045, t), (0.054, t + 0.010), (0.036, t + 0.027), (0, t + 0.030)]
    sheet = [(0.040, t + 0.012), (0.078, t + 0.012), (0.078, t + 0.016), (0.040, t + 0.026)]
    stud, phi = drum(0.006, t + 0.012, t + 0.036, sections=6), 2 * np.pi * np.arange(3) / 3
    studs = [placed(stud, (0.067 * np.cos(angle), 0.067 * np.sin(angle), 0)) for angle in phi]
    nut = drum(0.013, t + 0.029, t + 0.045, sections=6)
    steel = strut.place(joined(lathe(sheet, sections=12, closed=True), studs, nut))
    return [Piece("", strut.turned(cone, 10), palette.RUBBER), Piece("_steel", steel, palette.STEEL)]


def coil_spring(points: Points, size: Sizes) -> list[Piece]:
    """Wire on a helix between the seats; the radius grows over the lowest quarter of the height like a pig's tail.

    r(s) = r_low + (r - r_low) (3 q^2 - 2 q^3), q = min(s / 0.28, 1), s the share of the height
    """
    strut = strut_axis(points)
    wire, r, low = (size["spring_wire_radius"], size["spring_coil_radius"], LOWEST_TURN * size["spring_coil_radius"])

    def radius(share: Array) -> Array:
        q = np.minimum(share / 0.28, 1.0)
        return np.asarray(low + (r - low) * (3 * q**2 - 2 * q**3))

    high = strut.top - SEAT_BELOW_TOP - wire
    path = helix(radius, strut.seat + wire, high, size["spring_turns"], steps=13)
    return [Piece("", strut.place(tube(path, wire, sides=5)), palette.SPRING)]
