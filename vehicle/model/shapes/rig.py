"""Parts of the rig: shaker with its table, pedestal with its plate, stands with rubber blocks, bed plate."""

import itertools
from collections.abc import Sequence

import numpy as np
import trimesh

from vehicle.arrays import Vector
from vehicle.model.shapes import palette
from vehicle.model.shapes.shape import Piece, Points, Sizes
from vehicle.model.shapes.solids import block, box, drum, hull, joined, lathe, placed, plate, ring, shifted

BED_TOP = 0.04  # [m] top of the bed plate above the ground
TABLE = 0.030  # [m] thickness of both plates
AIR = 0.045  # [m] gap between the upper face of the shaker and the table
RUBBER = 0.060  # [m] height of the rear blocks
PLANKS = 9


def foot(point: Vector) -> Vector:
    """Return the point on the bed plate below a point."""
    return np.array([point[0], point[1], BED_TOP])


def screws(centre: Vector, half: float, radius: float = 0.009) -> list[trimesh.Trimesh]:
    """Build four square screw heads at the corners (+-half, +-half) [m] of a square on a surface."""
    centres = centre + half * np.array([(-1, -1, 0), (-1, 1, 0), (1, -1, 0), (1, 1, 0)])
    return [block(corner, (-radius, -radius, -0.002), (radius, radius, 0.008)) for corner in centres]


def square(centre: Vector, half: float, low: float, high: float, bevel: float = 0.0) -> trimesh.Trimesh:
    """Build a square plate or column [m] about a vertical axis through a point."""
    return block(centre, (-half, -half, low), (half, half, high), bevel)


def _ribs(
    base: Vector, turns: Vector, corners: Sequence[tuple[float, float]], half: float, beside: Sequence[float]
) -> list[trimesh.Trimesh]:
    """Build vertical sheets around a column.

    Args:
        base: foot of the column [m], shape (3,)
        turns: outward directions of the sheets, shape (n, 3)
        corners: radius and height of the corners of a sheet [m]
        half: half thickness of a sheet [m]
        beside: sideways offsets of the sheets of each direction [m]
    """
    sheets = []
    for along in turns:
        across = np.array([-along[1], along[0], 0.0])
        edge = [base + r * along + (0, 0, h) for r, h in corners]
        sheets += [hull([c + (w + s) * across for c in edge for s in (-half, half)]) for w in beside]
    return sheets


def shaker_table(points: Points, size: Sizes) -> list[Piece]:
    """Draw the round ribbed table with its top at the tyre patch, and the armature stem down into the shaker.

    Threaded inserts are on a circle outside the contact patch of the tyre.
    """
    patch = points["tyre_patch"]
    stem, low = shaker_top(patch) - float(patch[2]) - 0.01, float(patch[2]) - TABLE - float(patch[2])
    profile = [(0, stem), (0.085, stem), (0.085, low - 0.012), (0.17, low), (0.205, low)]
    profile += [(0.210, low + 0.005), (0.210, -0.005), (0.205, 0.0), (0, 0.0)]
    phi = 2 * np.pi * (np.arange(6) + 0.5) / 6
    circle = patch + 0.19 * np.column_stack([np.cos(phi), np.sin(phi), 0 * phi])
    inserts = [placed(drum(0.0075, -0.004, 0.0012, sections=6), centre) for centre in circle]
    return [
        Piece("", placed(lathe(profile, sections=24), patch), palette.PLATE),
        Piece("_inserts", joined(inserts), palette.DARK_STEEL),
    ]


def shaker_top(patch: Vector) -> float:
    """Return the height z of the upper face of the shaker [m], below a contact patch at (x, y, z) [m]."""
    return float(patch[2]) - TABLE - AIR


def shaker(points: Points, size: Sizes) -> list[Piece]:
    """Draw the electrodynamic shaker: ribbed drum with an opening for the armature, in its frame."""
    patch = points["tyre_patch"]
    low, high = BED_TOP + 0.035, shaker_top(patch)
    step = (high - low) / 10
    outer = [(0.230, low), (0.245, low + 0.012)]
    for k in range(2, 9, 3):  # cooling ribs
        z = low + k * step
        outer += [(0.245, z - 0.5 * step), (0.232, z - 0.4 * step), (0.232, z + 0.4 * step), (0.245, z + 0.5 * step)]
    outer += [(0.245, high - 0.012), (0.235, high)]
    profile = [(0, low), *outer, (0.105, high), (0.105, high - 0.04), (0, high - 0.04)]
    body = placed(lathe([(r, z - low) for r, z in profile], sections=20), (patch[0], patch[1], low))
    frame = shaker_frame(patch, high)
    return [Piece("", body, palette.SHAKER, held=True), Piece("_frame", frame, palette.STAND, held=True)]


def shaker_frame(patch: Vector, top: float) -> trimesh.Trimesh:
    """Build trunnions, bearing pedestals and base frame of a shaker with its upper face at a height `top` [m]."""
    middle = 0.5 * (BED_TOP + 0.035 + top)
    base = foot(patch)
    parts = [block(base, (-0.38, s * 0.2 - 0.045, 0), (0.38, s * 0.2 + 0.045, 0.035)) for s in (-1, 1)]
    head = middle - BED_TOP + 0.055
    for s in (-1, 1):
        side, axle = shifted(base, s * 0.315, 0, 0), np.array([base[0] + s * 0.22, base[1], middle])
        parts.append(plate(side, 0, (-0.030, 0.030), ((-0.22, 0.03), (0.22, 0.03), (-0.07, head), (0.07, head))))
        parts.append(placed(drum(0.048, 0.0, 0.155, bevel=0.006, sections=10), axle, (s, 0, 0)))
        disc = drum(0.072, 0.0, 0.03, bevel=0.005, sections=10)
        parts.append(placed(disc, shifted(axle, s * 0.115, 0, 0), (s, 0, 0)))
    parts.append(placed(ring(0.108, 0.150, 0.0, 0.008, sections=18), (patch[0], patch[1], top - 0.001)))
    return joined(parts)


def fixed_plate(points: Points, size: Sizes) -> list[Piece]:
    """Draw the square plate under a tyre at rest, its top at the tyre patch."""
    return [Piece("", square(points["tyre_patch"], 0.205, -TABLE, 0, 0.005), palette.PLATE)]


def pedestal(points: Points, size: Sizes) -> list[Piece]:
    """Draw the welded steel pedestal under a plate: column, gussets, head and foot plates with screws."""
    base, height = foot(points["tyre_patch"]), float(points["tyre_patch"][2]) - TABLE - BED_TOP
    turns = np.array([(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0)])
    corners = [(0.11, 0.02), (0.22, 0.02), (0.11, 0.6 * height), (0.22, 0.05)]
    gussets = _ribs(base, turns, corners, 0.005, (-0.06, 0.06))
    steel = _stand(base, height, square(base, 0.11, 0.02, height, 0.008), (0.24, 0.18, 0.022, 0.205), gussets)
    return [Piece("", steel, palette.STAND, held=True)]


def rear_block(points: Points, size: Sizes) -> list[Piece]:
    """Draw the barrel-shaped rubber block with its top at the support point, on a steel stand with four braces."""
    support = points["support"]
    half = [(0.076, -0.8 * RUBBER), (0.080, -0.5 * RUBBER), (0.076, -0.2 * RUBBER)]
    rubber = lathe([(0, -RUBBER), (0.066, -RUBBER), *half, (0.066, 0), (0, 0)], sections=18)
    base, height = foot(support), float(support[2]) - RUBBER - BED_TOP
    phi = np.pi / 4 + np.pi / 2 * np.arange(4)
    turns = np.column_stack([np.cos(phi), np.sin(phi), 0 * phi])
    braces = _ribs(base, turns, [(0.05, 0.02), (0.20, 0.02), (0.05, 0.34), (0.20, 0.045)], 0.006, (0.0,))
    column = placed(drum(0.058, 0.02, height - 0.01, sections=14), base)
    return [
        Piece("", placed(rubber, support), palette.RUBBER, held=True),
        Piece("stand", _stand(base, height, column, (0.20, 0.10, 0.020, 0.165), braces), palette.STAND, held=True),
    ]


def _stand(
    base: Vector, height: float, column: trimesh.Trimesh, plates: Sequence[float], sheets: Sequence[trimesh.Trimesh]
) -> trimesh.Trimesh:
    """Build column and sheets on a screwed foot plate.

    Args:
        base: foot of the column [m], shape (3,)
        height: height of the stand [m]
        column: mesh of the column
        plates: half widths of foot and head plate, thickness of the head plate, half distance of the screws [m]
        sheets: meshes of the sheets around the column
    """
    wide, head, thick, screw_half = plates
    feet = [square(base, wide, 0, 0.025, 0.005), square(base, head, height - thick, height, 0.004)]
    return joined(column, feet, sheets, screws(shifted(base, 0, 0, 0.025), screw_half))


def bed_plate(points: Points, size: Sizes) -> list[Piece]:
    """Draw the machined bed plate with T-slots along the car, as planks with gaps, around all points of the rig."""
    low, high = (pick(list(points.values()), axis=0) for pick in (np.min, np.max))
    x_low, x_high, y_low, y_high = low[0] - 0.75, high[0] + 0.75, low[1] - 0.60, high[1] + 0.60
    edges = np.linspace(y_low, y_high, PLANKS + 1)
    planks = [box((x_low, a + 0.011, 0.004), (x_high, b - 0.011, BED_TOP)) for a, b in itertools.pairwise(edges)]
    bed = box((x_low + 0.01, y_low + 0.02, 0.0), (x_high - 0.01, y_high - 0.02, BED_TOP - 0.022))
    return [Piece("", joined(planks, bed), palette.BED, held=True)]
