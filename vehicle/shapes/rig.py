"""The rig: shaker with its table, pedestal with its plate, stands with rubber blocks, bed plate."""

from __future__ import annotations

import itertools

import numpy as np
import trimesh

from vehicle.shapes.block import box, hull
from vehicle.shapes.hardpoint import Points
from vehicle.shapes.lathe import drum, lathe, ring
from vehicle.shapes.placement import joined, placed, shifted
from vehicle.shapes.shape import Array

BED_TOP = 0.04  # [m] top of the bed plate above the ground
TABLE = 0.030  # [m] thickness of both plates
RUBBER = 0.060  # [m] height of the rear blocks
PLANKS = 9


def foot(point: Array) -> Array:
    """The point on the bed plate below a point."""
    return np.array([point[0], point[1], BED_TOP])


def screws(centre: Array, reach: float, radius: float = 0.009) -> list[trimesh.Trimesh]:
    """Four square screw heads at the corners of a square [m] on a surface."""
    return [
        box(place - (radius, radius, 0.002), shifted(place, radius, radius, 0.008))
        for place in centre + reach * np.array([(-1, -1, 0), (-1, 1, 0), (1, -1, 0), (1, 1, 0)])
    ]


def shaker_table(patch: Array) -> trimesh.Trimesh:
    """Round ribbed table whose top is at the tyre patch, with the armature stem that dips into the shaker."""
    t = float(patch[2])
    low = t - TABLE
    stem = shaker_top(patch) - t - 0.01
    profile = [(0, stem), (0.085, stem), (0.085, low - t - 0.012), (0.17, low - t), (0.205, low - t)]
    profile += [(0.210, low - t + 0.005), (0.210, -0.005), (0.205, 0.0), (0, 0.0)]
    return placed(lathe(profile, sections=24), patch)


def table_inserts(patch: Array) -> trimesh.Trimesh:
    """Threaded inserts of the table, on a circle outside the tyre's footprint."""
    phi = 2 * np.pi * (np.arange(6) + 0.5) / 6
    places = patch + 0.19 * np.column_stack([np.cos(phi), np.sin(phi), 0 * phi])
    return joined([placed(drum(0.0075, -0.004, 0.0012, sections=6), place) for place in places])


def shaker_top(patch: Array) -> float:
    """Height [m] of the shaker body's upper face: 45 mm of free air under the table."""
    return float(patch[2]) - TABLE - 0.045


def shaker_body(patch: Array) -> trimesh.Trimesh:
    """Electrodynamic shaker: ribbed drum with an opening for the armature."""
    low, high = BED_TOP + 0.035, shaker_top(patch)
    step = (high - low) / 10
    outer = [(0.230, low), (0.245, low + 0.012)]
    for k in range(2, 9, 3):  # cooling ribs
        z = low + k * step
        outer += [(0.245, z - 0.5 * step), (0.232, z - 0.4 * step), (0.232, z + 0.4 * step), (0.245, z + 0.5 * step)]
    outer += [(0.245, high - 0.012), (0.235, high)]
    profile = [(0, low), *outer, (0.105, high), (0.105, high - 0.04), (0, high - 0.04)]
    drum_body = lathe([(r, z - low) for r, z in profile], sections=20)
    return placed(drum_body, (patch[0], patch[1], low))


def shaker_frame(patch: Array) -> trimesh.Trimesh:
    """Trunnions, their bearing pedestals and the base frame of the shaker."""
    middle = 0.5 * (BED_TOP + 0.035 + shaker_top(patch))
    base = foot(patch)
    parts = [
        box(shifted(base, -0.38, s * 0.2 - 0.045, 0), shifted(base, 0.38, s * 0.2 + 0.045, 0.035)) for s in (-1, 1)
    ]
    for s in (-1, 1):
        side = shifted(base, s * 0.315, 0, 0)
        axle = np.array([base[0] + s * 0.22, base[1], middle])
        pedestal = [
            shifted(side, x, y, z)
            for x in (-0.030, 0.030)
            for y, z in (
                (-0.22, 0.03),
                (0.22, 0.03),
                (-0.07, middle - BED_TOP + 0.055),
                (0.07, middle - BED_TOP + 0.055),
            )
        ]
        parts += [hull(pedestal), placed(drum(0.048, 0.0, 0.155, bevel=0.006, sections=10), axle, (s, 0, 0))]
        parts += [placed(drum(0.072, 0.0, 0.03, bevel=0.005, sections=10), shifted(axle, s * 0.115, 0, 0), (s, 0, 0))]
    flange = ring(0.108, 0.150, 0.0, 0.008, sections=18)
    parts.append(placed(flange, (patch[0], patch[1], shaker_top(patch) - 0.001)))
    return joined(parts)


def fixed_plate(patch: Array) -> trimesh.Trimesh:
    """Square plate under the standing tyre, its top at the tyre patch."""
    return box(patch - (0.205, 0.205, TABLE), shifted(patch, 0.205, 0.205, 0), 0.005)


def pedestal(patch: Array) -> trimesh.Trimesh:
    """Welded steel pedestal: column, gussets, head and foot plates with screws."""
    base, top = foot(patch), float(patch[2]) - TABLE
    column = box(shifted(base, -0.11, -0.11, 0.02), (patch[0] + 0.11, patch[1] + 0.11, top), 0.008)
    plates = [
        box(base - (0.24, 0.24, 0), shifted(base, 0.24, 0.24, 0.025), 0.005),
        box((patch[0] - 0.18, patch[1] - 0.18, top - 0.022), (patch[0] + 0.18, patch[1] + 0.18, top), 0.004),
    ]
    gussets = []
    for direction in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)):
        along, across = np.array([*direction, 0.0]), np.array([-direction[1], direction[0], 0.0])
        for w in (-0.06, 0.06):
            corners = [base + 0.11 * along + (0, 0, 0.02), base + 0.22 * along + (0, 0, 0.02)]
            corners += [base + 0.11 * along + (0, 0, 0.6 * (top - BED_TOP)), base + 0.22 * along + (0, 0, 0.05)]
            gussets.append(hull([c + (w + s) * across for c in corners for s in (-0.005, 0.005)]))
    return joined(column, plates, gussets, screws(shifted(base, 0, 0, 0.025), 0.205))


def rubber_block(support: Array) -> trimesh.Trimesh:
    """Barrel-shaped rubber block under the rear of the body, its top at the support point."""
    profile = [(0, -RUBBER), (0.066, -RUBBER), (0.076, -0.8 * RUBBER), (0.080, -0.5 * RUBBER), (0.076, -0.2 * RUBBER)]
    return placed(lathe([*profile, (0.066, 0), (0, 0)], sections=18), support)


def support_shoe(support: Array) -> trimesh.Trimesh:
    """Steel shoe of the body on the rubber block, up to the rear floor."""
    shoe = lathe([(0, 0), (0.084, 0), (0.084, 0.012), (0.046, 0.060), (0, 0.060)], sections=12)
    return placed(shoe, support)


def stand(support: Array) -> trimesh.Trimesh:
    """Steel stand under a rubber block: column with four braces, head and foot plates."""
    base, top = foot(support), float(support[2]) - RUBBER
    column = placed(drum(0.058, 0.02, top - BED_TOP - 0.01, sections=14), base)
    plates = [
        box(base - (0.20, 0.20, 0), shifted(base, 0.2, 0.2, 0.025), 0.005),
        box((support[0] - 0.10, support[1] - 0.10, top - 0.020), (support[0] + 0.10, support[1] + 0.10, top), 0.004),
    ]
    braces = []
    for phi in np.pi / 4 + np.pi / 2 * np.arange(4):
        along, across = np.array([np.cos(phi), np.sin(phi), 0]), np.array([-np.sin(phi), np.cos(phi), 0])
        corners = [base + 0.05 * along + (0, 0, 0.02), base + 0.20 * along + (0, 0, 0.02)]
        corners += [base + 0.05 * along + (0, 0, 0.34), base + 0.20 * along + (0, 0, 0.045)]
        braces.append(hull([c + s * across for c in corners for s in (-0.006, 0.006)]))
    return joined(column, plates, braces, screws(shifted(base, 0, 0, 0.025), 0.165))


def bed_plate(points: Points) -> trimesh.Trimesh:
    """Machined bed plate with T-slots along the car: planks with gaps, wide enough for shaker and stands."""
    right, left = points["tyre_patch_fr"], points["tyre_patch_fl"]
    x_low = min(right[0], left[0]) - 0.75
    x_high = max(points["rear_support_right"][0], points["rear_support_left"][0]) + 0.75
    y_low, y_high = left[1] - 0.60, right[1] + 0.60
    edges = np.linspace(y_low, y_high, PLANKS + 1)
    planks = [box((x_low, a + 0.011, 0.004), (x_high, b - 0.011, BED_TOP)) for a, b in itertools.pairwise(edges)]
    return joined(planks, box((x_low + 0.01, y_low + 0.02, 0.0), (x_high - 0.01, y_high - 0.02, BED_TOP - 0.022)))
