"""Structure and interior inside the shell: floor, front rails, strut towers, subframe, exhaust, seats, dashboard."""

import numpy as np
import trimesh

from vehicle.arrays import Vector
from vehicle.model.shapes import palette
from vehicle.model.shapes.body_outline import outline
from vehicle.model.shapes.shape import Piece, Points, Sizes
from vehicle.model.shapes.solids import (
    block,
    both,
    box,
    drum,
    hull,
    joined,
    lathe,
    placed,
    plate,
    ring,
    rod,
    shifted,
    tube,
)
from vehicle.model.shapes.surface import spline
from vehicle.model.shapes.suspension import SEAT_BELOW_TOP, stabilizer_clamp, strut_axis

FORE_AFT, UPRIGHT = 0, 2
SHEET = (-0.004, 0.004)  # [m] faces of an 8 mm sheet


def floor(points: Points, size: Sizes) -> list[Piece]:
    """Draw the cabin floor with tunnel and cross members, firewall, raised rear floor."""
    body = outline(points, size)
    rear_z = float(points["rear_axle"][2]) + 0.055
    half = 0.775 * body.widen
    x0, x1, x2, x3 = body.place(np.array([(X, 0.0, 0.0) for X in (1.27, 3.02, 3.12, 4.30)]))[:, 0]
    sill, cowl_z = body.place(np.array([(0.0, 0.0, H) for H in (0.185, 0.90)]))[:, 2]
    parts = [
        box((x0, -half, sill), (x1, half, sill + 0.022)),
        box((x0, -0.13, sill + 0.015), (x1, 0.13, sill + 0.15), 0.03),
        box((x0 - 0.03, -half + 0.03, sill), (x0, half - 0.03, cowl_z), 0.005),
        hull(
            [(x1 - 0.02, s * half, sill + h) for s in (-1, 1) for h in (0.0, 0.022)]
            + [(x2, s * 0.58, rear_z + h) for s in (-1, 1) for h in (0.0, 0.022)]
        ),
        box((x2, -0.58, rear_z), (x3, 0.58, rear_z + 0.022)),
    ]
    for x in float(points["seat_rail"][0]) + np.array([-0.18, 0.2]):
        parts.append(box((x - 0.04, -half, sill + 0.02), (x + 0.04, half, sill + 0.075)))
    return [Piece("_floor", joined(parts), palette.FLOOR)]


def front_structure(points: Points, size: Sizes) -> list[Piece]:
    """Draw the longitudinal rails, bumper beam and strut towers that carry the top mounts."""
    front, strut_top = points["body_front"], points["strut_top"]
    front_x, front_z = float(front[0]), float(front[2])
    firewall = float(outline(points, size).place(np.array([1.26, 0.0, 0.0]))[0])
    beam_x = front_x - 0.26
    y = 0.5 * (strut_top[1] + points["arm_front"][1])
    path = [(beam_x, y, front_z - 0.06), (points["wheel_center"][0], y, front_z - 0.04), (firewall, y, front_z - 0.12)]
    rail = tube(spline(path, 7), 0.042, sides=4, width=0.030, up=(0, 0, 1))
    strut = strut_axis(points)
    r, low = size["spring_coil_radius"] + 0.018, strut.top - SEAT_BELOW_TOP + 0.008
    tower = [(0.06, low + 0.004), (r, low + 0.002), (r + 0.006, low - 0.028), (r + 0.01, low - 0.028)]
    tower += [(r + 0.004, low + 0.006), (0.06, low + 0.008)]
    house = shifted(strut_top, 0, 0, -0.03)
    brace = hull(
        [shifted(house, s * 0.07, -0.085, h) for s in (-1, 1) for h in (-0.05, 0.02)]
        + [np.array([strut_top[0] + s * 0.13, y + d, front_z]) for s in (-1, 1) for d in (-0.03, 0.02)]
    )
    right = joined(rail, strut.turned(tower, 14, closed=True), brace)
    beam = box((beam_x - 0.03, -y - 0.12, front_z - 0.12), (beam_x + 0.02, y + 0.12, front_z))
    stay = plate(front, FORE_AFT, (-0.03, 0.03), [(w, h) for w in (-0.05, 0.05) for h in (-0.025, 0.0)])
    panel = rod((front_x, -y, front_z - 0.04), (front_x, y, front_z - 0.04), 0.02)
    return [Piece("_front_structure", joined(both(right), beam, stay, panel), palette.STAND)]


def subframe(points: Points, size: Sizes) -> list[Piece]:
    """Draw the cross member with brackets of arms, stabilizer and torque arm, and the steering rack with bellows."""
    front, rear, stab, tie = (points[name] for name in ("arm_front", "arm_rear", "stab_body", "tie_inner"))
    low_front = shifted(front, 0.0, -0.075, 0.0)
    path = [low_front, shifted((front + rear) / 2, 0.0, -0.075, 0.0), shifted(rear, 0.02, -0.07, 0.0)]
    side = tube(spline(path, 5), 0.022, sides=4, width=0.030, up=(0, 0, 1))
    brackets = []
    for s in (-1, 1):
        ear, sheet = shifted(front, s * 0.04, 0.0, 0.0), shifted(rear, 0.0, 0.0, s * 0.036)
        brackets += [
            plate(ear, FORE_AFT, SHEET, ((0.025, -0.02), (0.025, 0.02), (-0.07, -0.022), (-0.07, 0.022))),
            plate(sheet, UPRIGHT, SHEET, ((-0.035, 0.03), (0.035, 0.03), (-0.045, -0.08), (0.045, -0.08))),
        ]
    pad = plate(stab, FORE_AFT, (-0.052, 0.052), [(y, z) for y in (-0.03, 0.03) for z in (-0.030, -0.022)])
    post = plate(stab, FORE_AFT, (-0.03, 0.03), [(y, z) for z in (-0.024, -0.06) for y in (-0.02, 0.02)])
    right = joined(side, brackets, pad, post, stabilizer_clamp(points))
    x, z = 0.5 * (rear[0] + stab[0]), rear[2] + 0.005
    cross = box((x - 0.055, -rear[1] + 0.06, z - 0.045), (x + 0.075, rear[1] - 0.06, z - 0.008), 0.010)
    eye = points["bottom_body"]
    cheek = ((-0.03, -0.035), (-0.03, 0.035), (0.06, -0.06), (0.06, 0.06))
    fork = [plate(eye, UPRIGHT, (s * 0.03 - 0.004, s * 0.03 + 0.004), cheek) for s in (-1, 1)]
    bolt = rod(eye - (0, 0, 0.045), shifted(eye, 0, 0, 0.045), 0.008)
    rack = rod((tie[0], -tie[1], tie[2]), tie, 0.019, sides=8)
    pinion_centre = (tie[0], 0.55 * points["seat"][1], tie[2])
    pinion = placed(ring(0.0, 0.026, -0.03, 0.05, sections=10), pinion_centre, (0.3, 0, 1))
    folds = [(0.010, -0.085)]
    for k in range(2):
        folds += [(0.028 - 0.0015 * k, -0.065 + 0.06 * k), (0.020 - 0.0012 * k, -0.035 + 0.06 * k)]
    bellows = placed(lathe([*folds, (0.010, 0.05)], sections=10, closed=True), tie, (0, 1, 0))
    return [
        Piece("_subframe", joined(both(right), cross, fork, bolt, rack, pinion), palette.DARK_STEEL),
        Piece("_rack_bellows", both(bellows), palette.RUBBER),
    ]


def exhaust(points: Points, size: Sizes) -> list[Piece]:
    """Draw the exhaust pipe in the tunnel and the silencer near the rear axle."""
    start = points["bottom_body"] + (0.12, 0.06, -0.01)
    x, z = float(points["rear_axle"][0]) + 0.55, start[2]
    behind = [(x - 0.9, 0.06, z), (x - 0.3, 0.2, z + 0.09), (x + 0.36, 0.36, z + 0.06)]
    pipe = tube(spline(np.vstack([start, shifted(start, 0.5, -0.02, 0.0), behind]), 10), 0.024, sides=6)
    silencer = tube([(x - 0.05, 0.27, z + 0.09), (x + 0.25, 0.34, z + 0.07)], 0.065, sides=10, width=0.10, up=(0, 0, 1))
    return [Piece("_exhaust", joined(pipe, silencer), palette.CAST)]


def support_shoes(points: Points, size: Sizes) -> list[Piece]:
    """Draw a steel shoe of the body at each point on a rubber block, up to the rear floor."""
    shoe = lathe([(0, 0), (0.084, 0), (0.084, 0.012), (0.046, 0.060), (0, 0.060)], sections=12)
    return [Piece("_support_shoes", joined([placed(shoe, point) for point in points.values()]), palette.STAND)]


def cabin(points: Points, size: Sizes) -> list[Piece]:
    """Draw both front seats, at the seat point and its mirror image, rear bench, seat rails and dashboard."""
    driver = points["seat"]
    bench = np.array([driver[0] + 0.87, 0.0, driver[2] + 0.03])
    seats = [
        seat(driver, 0.26, (0.0,)),
        seat(driver * (1.0, -1.0, 1.0), 0.26, (0.0,)),
        seat(bench, 0.62, (-0.36, 0.36)),
    ]
    rails = []  # position of the measurement point
    for side in (1.0, -1.0):
        middle = points["seat_rail"] * (1.0, side, 1.0)
        rails += [block(middle, (-0.22, y - 0.015, -0.016), (0.3, y + 0.015, 0.012)) for y in (-0.20, 0.20)]
        rails.append(block(middle, (-0.03, -0.20, -0.008), (0.03, 0.20, 0.008)))
    return [
        Piece("_seats", joined(seats), palette.SEAT),
        Piece("_seat_rails", joined(rails), palette.STEEL),
        Piece("_dashboard", dashboard(driver), palette.TRIM),
    ]


def seat(cushion: Vector, half_width: float, headrests: tuple[float, ...]) -> trimesh.Trimesh:
    """Draw a seat: cushion, inclined backrest and headrests.

    Args:
        cushion: middle of the upper side of the cushion [m], shape (3,)
        half_width: half width of the seat [m]
        headrests: y of the headrests relative to the middle [m]
    """
    w = half_width
    base = ((-0.27, 0.86 * w, -0.01), (-0.29, 0.9 * w, -0.06), (-0.24, 0.9 * w, -0.14), (0.20, w, -0.14),
            (0.24, w, -0.04), (0.10, w, 0.03), (-0.20, w, 0.02), (0.20, w, -0.03))  # fmt: skip
    back = ((0.16, w, 0.0), (0.27, w, -0.02), (0.34, 0.95 * w, 0.42), (0.25, 0.95 * w, 0.42),
            (0.30, 0.72 * w, 0.545), (0.36, 0.72 * w, 0.54), (0.19, w, 0.20))  # fmt: skip
    parts = [hull([shifted(cushion, x, s * y, z) for s in (-1, 1) for x, y, z in half]) for half in (base, back)]
    for y in headrests:
        centre = shifted(cushion, 0.36, y, 0.635)
        parts.append(block(centre, (-0.042, -0.115, -0.065), (0.042, 0.115, 0.065), 0.022))
        for s in (-0.05, 0.05):
            parts.append(rod(shifted(centre, -0.005, s, -0.12), shifted(centre, 0.0, s, -0.05), 0.007, sides=4))
    return joined(parts)


def dashboard(driver: Vector) -> trimesh.Trimesh:
    """Draw the dashboard with its cowl, and the steering wheel in front of the driver."""
    x, z = driver[0] - 0.66, driver[2] + 0.36
    half = 0.70
    section = ((-0.17, 0.96, 0.02), (-0.02, 1.0, 0.045), (0.07, 1.0, -0.03), (0.05, 1.0, -0.20), (-0.17, 0.96, -0.30))
    board = hull([(x + dx, s * half * w, z + dz) for s in (-1, 1) for dx, w, dz in section])
    centre = np.array([x + 0.20, driver[1], z - 0.035])
    axis = np.array([np.cos(np.deg2rad(24)), 0.0, np.sin(np.deg2rad(24))])
    phi = 2 * np.pi * np.arange(16) / 16
    circle = 0.185 * np.column_stack([np.cos(phi), np.sin(phi), 0 * phi])
    spokes = [rod((0, 0, 0), 0.18 * np.array([np.cos(p), np.sin(p), 0]), 0.013, sides=6) for p in (0.0, 2.0, 4.28)]
    boss = drum(0.055, -0.02, 0.012, bevel=0.006, sections=14)
    wheel = joined(tube(circle, 0.014, sides=5, closed=True), boss, spokes)
    return joined(board, placed(wheel, centre, axis), rod(centre, centre - 0.22 * axis, 0.03))
