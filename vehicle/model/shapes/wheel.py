"""Tyre, rim, brake disc and caliper of the right side."""

import numpy as np
import trimesh

from vehicle.arrays import Vector
from vehicle.model.shapes import palette
from vehicle.model.shapes.shape import Piece, Points, Sizes
from vehicle.model.shapes.solids import box, drum, hull, joined, lathe, placed

OUTWARD = np.array([0.0, 1.0, 0.0])  # spin axis of the right wheel, to the outside
DISC_OFFSET = 0.018  # [m] distance of the middle of the disc outward from the wheel centre
SPOKES = 7
BOLTS = 4


def wheel(points: Points, size: Sizes) -> list[Piece]:
    """Draw tyre, rim and wheel bolts."""
    face = 0.62 * 0.92 * size["tyre_section_width"] / 2  # [m] of the rim, outside the wheel centre
    phi = 2 * np.pi * (np.arange(BOLTS) + 0.5) / BOLTS
    bolt = drum(0.0085, face, face + 0.017, sections=6)
    bolts = joined([placed(bolt, (0.049 * np.cos(angle), 0.049 * np.sin(angle), 0.0)) for angle in phi])
    return [
        Piece("", tyre(points, size), palette.RUBBER),
        Piece("rim", rim(points, size), palette.RIM),
        Piece("wheel_bolts", placed(bolts, points["wheel_center"], OUTWARD), palette.DARK_STEEL),
    ]


def tyre(points: Points, size: Sizes) -> trimesh.Trimesh:
    """Draw the tyre with rounded shoulders, flattened on the plate.

    Vertices below the plate are lifted onto the plate; near the patch the side walls bulge by up to 5 %.
    """
    centre, patch = points["wheel_center"], points["tyre_patch"]
    loaded = float(centre[2] - patch[2])
    free, bead, half = loaded + size["tyre_deflection"], size["rim_diameter"] / 2, size["tyre_section_width"] / 2
    wall = free - bead
    # share of the section height above the bead, share of the half width: drawn after a 195/60 R15 section
    section = [(0.0, 0.78), (0.16, 0.92), (0.42, 1.0), (0.70, 0.975), (0.92, 0.79), (1.0, 0.36)]
    outer = [(bead + h * wall, w * half) for h, w in section]
    profile = [*outer, *((r, -y) for r, y in reversed(outer))]
    mesh = placed(lathe(profile, sections=30, closed=True), centre, OUTWARD)
    vertices = np.array(mesh.vertices)
    angle = np.arctan2(vertices[:, 0] - centre[0], centre[2] - vertices[:, 2])
    bulge = 1 + 0.05 * np.exp(-((angle / 0.4) ** 2))
    vertices[:, 1] = centre[1] + (vertices[:, 1] - centre[1]) * bulge
    vertices[:, 2] = np.maximum(vertices[:, 2], patch[2])
    return trimesh.Trimesh(vertices, mesh.faces, process=False)


def rim(points: Points, size: Sizes) -> trimesh.Trimesh:
    """Draw the well-base rim with tapered spokes that bow outward from the hub, and a hub cap."""
    bead, half = size["rim_diameter"] / 2, 0.92 * size["tyre_section_width"] / 2
    section = [(0.006, 1.0), (-0.026, 0.35), (-0.026, -0.25), (0.006, -0.98), (-0.032, -0.27), (-0.032, 0.33)]
    section.append((-0.003, 1.02))
    barrel = lathe([(bead + dr, w * half) for dr, w in section], sections=24, closed=True)
    face = 0.62 * half  # [m] outside the wheel centre
    spokes = []
    root, tip = 0.045, bead - 0.010
    stations = ((root, 0.021, face + 0.014), (0.6 * tip, 0.017, face + 0.016), (tip, 0.024, face + 0.004))
    for k in range(SPOKES):
        along = np.array([np.cos(2 * np.pi * k / SPOKES + 0.5 * np.pi), np.sin(2 * np.pi * k / SPOKES + 0.5 * np.pi)])
        across = np.array([-along[1], along[0]])
        corners = []
        for r, width, top in stations:
            for w, z in ((width, top - 0.026), (0.6 * width, top)):
                corners += [[*(r * along + s * w * across), z] for s in (-1, 1)]
        spokes.append(hull(corners))
    hub = [(0, face - 0.03), (0.07, face - 0.03), (0.066, face + 0.005), (0.034, face + 0.01), (0.024, face + 0.025)]
    cap = lathe([*hub, (0, face + 0.027)], sections=12)
    return placed(joined(barrel, spokes, cap), points["wheel_center"], OUTWARD)


def brake_disc(points: Points, size: Sizes) -> list[Piece]:
    """Draw the vented disc: two friction rings with the vent gap as a groove at the rim, and the hat."""
    r, y = size["brake_disc_radius"], DISC_OFFSET
    profile = [(0.030, y + 0.030), (0.071, y + 0.030), (0.074, y + 0.011), (r, y + 0.011), (r, y + 0.004)]
    profile += [(r - 0.012, y + 0.003), (r - 0.012, y - 0.003), (r, y - 0.004), (r, y - 0.011), (0.030, y - 0.011)]
    return [Piece("", placed(lathe(profile, sections=24, closed=True), points["wheel_center"], OUTWARD), palette.DISC)]


def caliper(points: Points, size: Sizes) -> list[Piece]:
    """Draw the floating caliper ahead of the axle: inner piston housing, bridge over the disc, outer finger, pins."""
    r = size["brake_disc_radius"]
    inside, outside = DISC_OFFSET - 0.013, DISC_OFFSET + 0.013
    # local axes: x to the disc's rim, y along the rim, z along the spin axis
    blocks = [
        box((r + low, -width, y_low), (r + high, width, y_high), 0.006)
        for low, high, width, y_low, y_high in (
            (0.004, 0.022, 0.052, inside - 0.030, outside + 0.016),  # bridge
            (-0.050, 0.022, 0.048, outside, outside + 0.017),  # finger
            (-0.046, 0.020, 0.050, inside - 0.022, inside),  # housing
        )
    ]
    piston = placed(drum(0.031, inside - 0.056, inside - 0.010, bevel=0.004, sections=10), (r - 0.020, 0, 0))
    bracket = box((r - 0.062, -0.078, inside - 0.016), (r - 0.030, 0.078, inside - 0.002))
    pin = drum(0.008, inside - 0.050, inside + 0.002, sections=6)
    pins = [placed(pin, (r - 0.020, 0.068 * side, 0)) for side in (-1, 1)]
    mesh = joined(blocks, piston, bracket, pins)
    tilt = np.deg2rad(18.0)  # above the horizontal, ahead of the axle
    to_rim = np.array([-np.cos(tilt), 0.0, np.sin(tilt)])
    frame: Vector = np.column_stack([to_rim, np.cross(OUTWARD, to_rim), OUTWARD])
    vertices = np.asarray(mesh.vertices) @ frame.T + points["wheel_center"]
    return [Piece("", trimesh.Trimesh(vertices, mesh.faces, process=False), palette.CALIPER)]
