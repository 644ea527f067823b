"""MacPherson strut of the right side: damper housing and rod, coil spring, top mount."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import trimesh

from vehicle.shapes.curve import helix
from vehicle.shapes.hardpoint import Points
from vehicle.shapes.lathe import drum, lathe
from vehicle.shapes.placement import joined, placed
from vehicle.shapes.shape import Array
from vehicle.shapes.tube import tube

SEAT_BELOW_TOP = 0.014  # [m] the upper spring seat lies this far below the strut top
HOUSING_SHARE = 0.34  # the housing ends at this share of the way from the lower seat to the strut top


def strut_frame(points: Points) -> tuple[Array, Array, float, float]:
    """Origin (damper bottom), unit axis to the strut top, distances [m] of lower spring seat and strut top along it."""
    origin = points["damper_bottom"]
    along = points["strut_top"] - origin
    top = float(np.linalg.norm(along))
    axis: Array = along / top
    return origin, axis, float((points["spring_lower"] - origin) @ axis), top


def damper_housing(points: Points, size: Mapping[str, float]) -> trimesh.Trimesh:
    """Housing tube closed by a rolled cap."""
    origin, axis, seat, top = strut_frame(points)
    r, end = size["damper_tube_radius"], seat + HOUSING_SHARE * (top - seat)
    profile = [(0, -0.045), (r - 0.004, -0.045), (r, -0.040), (r, end - 0.008)]
    profile += [(r - 0.007, end), (0.014, end + 0.002), (0, end + 0.004)]
    return placed(lathe(profile, sections=10), origin, axis)


def lower_seat(points: Points, size: Mapping[str, float]) -> trimesh.Trimesh:
    """Dish on the housing that carries the spring; small enough to clear the tyre."""
    origin, axis, seat, _ = strut_frame(points)
    r = size["damper_tube_radius"] - 0.001
    rim = lower_coil_radius(size) + size["spring_wire_radius"] + 0.003
    profile = [(r, seat - 0.020), (rim - 0.010, seat - 0.004), (rim, seat + 0.006), (rim - 0.011, seat), (r, seat)]
    return placed(lathe(profile, sections=16, closed=True), origin, axis)


def piston_rod(points: Points) -> trimesh.Trimesh:
    """Polished rod from inside the housing to the top mount, with its nut thread."""
    origin, axis, seat, top = strut_frame(points)
    low = seat + 0.5 * HOUSING_SHARE * (top - seat)
    profile = [(0, low), (0.010, low), (0.010, top), (0.007, top + 0.002), (0.007, top + 0.040), (0, top + 0.040)]
    return placed(lathe(profile, sections=10), origin, axis)


def upper_seat(points: Points, size: Mapping[str, float]) -> trimesh.Trimesh:
    """Dish under the top mount that the spring presses against."""
    origin, axis, _, top = strut_frame(points)
    rim, low = size["spring_coil_radius"] + 0.013, top - SEAT_BELOW_TOP
    profile = [(0.009, low - 0.004), (rim - 0.006, low), (rim, low - 0.008), (rim - 0.002, low + 0.004)]
    profile += [(0.048, low + 0.005), (0.009, low + 0.012)]
    return placed(lathe(profile, sections=14, closed=True), origin, axis)


def bump_stop(points: Points) -> trimesh.Trimesh:
    """Rubber bellows around the rod below the upper seat."""
    origin, axis, seat, top = strut_frame(points)
    high = top - SEAT_BELOW_TOP - 0.004
    folds, pitch = 3, 0.10 * (top - seat)
    outer: list[tuple[float, float]] = [(0.018, high)]
    for k in range(folds):
        outer += [(0.027 - 0.002 * k, high - (k + 0.4) * pitch), (0.018 - 0.001 * k, high - (k + 1) * pitch)]
    return placed(
        lathe([(0.0105, high), *outer, (0.0105, high - folds * pitch)], sections=10, closed=True), origin, axis
    )


def top_mount_rubber(points: Points) -> trimesh.Trimesh:
    """Rubber cone of the suspension mount, its middle at the strut top."""
    origin, axis, _, top = strut_frame(points)
    profile = [(0.0, top), (0.045, top), (0.054, top + 0.010), (0.036, top + 0.027), (0, top + 0.030)]
    return placed(lathe(profile, sections=10), origin, axis)


def top_mount_steel(points: Points) -> trimesh.Trimesh:
    """Steel plate of the suspension mount with three studs and the rod's nut."""
    origin, axis, _, top = strut_frame(points)
    plate = lathe(
        [(0.040, top + 0.012), (0.078, top + 0.012), (0.078, top + 0.016), (0.040, top + 0.026)],
        sections=12,
        closed=True,
    )
    studs = [
        placed(drum(0.006, top + 0.012, top + 0.036, sections=6), (0.067 * np.cos(phi), 0.067 * np.sin(phi), 0))
        for phi in 2 * np.pi * np.arange(3) / 3
    ]
    nut = drum(0.013, top + 0.029, top + 0.045, sections=6)
    return placed(joined(plate, studs, nut), origin, axis)


def lower_coil_radius(size: Mapping[str, float]) -> float:
    """Radius [m] of the lowest turn: drawn in like a pig's tail, because the tyre is close there."""
    return 0.60 * size["spring_coil_radius"]


def coil_spring(points: Points, size: Mapping[str, float]) -> trimesh.Trimesh:
    """Wire on a helix between the seats; the radius grows over the lowest quarter of the height.

    r(s) = r_low + (r - r_low) (3 q^2 - 2 q^3), q = min(s / 0.28, 1), s the share of the height
    """
    origin, axis, seat, top = strut_frame(points)
    wire, low_radius = size["spring_wire_radius"], lower_coil_radius(size)

    def radius(share: Array) -> Array:
        q = np.minimum(share / 0.28, 1.0)
        r: Array = low_radius + (size["spring_coil_radius"] - low_radius) * (3 * q**2 - 2 * q**3)
        return r

    path = helix(radius, seat + wire, top - SEAT_BELOW_TOP - wire, size["spring_turns"], steps=13)
    return placed(tube(path, wire, sides=5), origin, axis)
