"""Structure under the shell: floor, wheel houses, front rails with strut towers, subframe with steering rack."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import trimesh

from vehicle.shapes.block import box, hull
from vehicle.shapes.body_outline import Outline, station_at
from vehicle.shapes.body_shell import arch_edge
from vehicle.shapes.curve import spline
from vehicle.shapes.hardpoint import Points, right_handed
from vehicle.shapes.lathe import lathe, ring
from vehicle.shapes.patch import grid
from vehicle.shapes.placement import joined, mirrored, placed, shifted
from vehicle.shapes.shape import Array
from vehicle.shapes.strut import SEAT_BELOW_TOP, strut_frame
from vehicle.shapes.suspension import stabilizer_clamp
from vehicle.shapes.tube import rod, tube

FRONT_HOUSE_DEPTH = 0.16  # [m] the front wheel house ends here, so that strut and spring stay visible
REAR_HOUSE_DEPTH = 0.22  # [m]


def wheel_house(body: Outline, axle: int, depth: float) -> trimesh.Trimesh:
    """Sheet from the edge of an arch inward, facing the wheel, both sides of the car."""
    X, H = arch_edge(body, axle)
    edge = body.side(station_at(X), H) - (0, 0.012, 0)
    inner = edge.copy()
    inner[:, 1] = edge[:, 1].mean() - depth
    sheet = grid(np.stack([edge, inner]))
    back = trimesh.Trimesh(np.asarray(sheet.vertices) * 1.0, np.asarray(sheet.faces)[:, ::-1], process=False)
    return joined(sheet, back, mirrored(sheet), mirrored(back))


def floor(body: Outline, points: Points) -> trimesh.Trimesh:
    """Cabin floor with tunnel and cross members, firewall, raised rear floor, inner sides of the rear arches."""
    rear_z = float(points["rear_support_right"][2]) + 0.055
    sill = float(body.place(np.array([0.0, 0.0, 0.185]))[2])
    half = 0.775 * body.widen
    x0, x1, x2, x3 = body.place(np.array([(X, 0.0, 0.0) for X in (1.27, 3.02, 3.12, 4.30)]))[:, 0]
    cowl_z = float(body.place(np.array([0.0, 0.0, 0.90]))[2])
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
    seat_x = float(points["seat_rail"][0])
    parts += [
        box((seat_x + d - 0.04, -half, sill + 0.02), (seat_x + d + 0.04, half, sill + 0.075)) for d in (-0.18, 0.2)
    ]
    return joined(parts)


def front_structure(body: Outline, points: Points, size: Mapping[str, float]) -> trimesh.Trimesh:
    """Longitudinal rails, bumper beam and strut towers that carry the top mounts."""
    p = right_handed(points, "fr")
    front_z = float(points["body_front"][2])
    firewall = float(body.place(np.array([1.26, 0.0, 0.0]))[0])
    beam_x = float(points["body_front"][0]) - 0.26
    y = 0.5 * (p["strut_top"][1] + p["arm_front"][1])
    path = np.array(
        [(beam_x, y, front_z - 0.06), (p["wheel_center"][0], y, front_z - 0.04), (firewall, y, front_z - 0.12)]
    )
    rail = tube(spline(path, 7), 0.042, sides=4, width=0.030, up=(0, 0, 1))
    origin, axis, _, top = strut_frame(p)
    r = size["spring_coil_radius"] + 0.018
    low = top - SEAT_BELOW_TOP + 0.008
    tower = lathe(
        [
            (0.06, low + 0.004),
            (r, low + 0.002),
            (r + 0.006, low - 0.028),
            (r + 0.01, low - 0.028),
            (r + 0.004, low + 0.006),
            (0.06, low + 0.008),
        ],
        sections=14,
        closed=True,
    )
    house = p["strut_top"] + (0, 0, -0.03)
    brace = hull(
        [shifted(house, s * 0.07, -0.085, h) for s in (-1, 1) for h in (-0.05, 0.02)]
        + [np.array([p["strut_top"][0] + s * 0.13, y + d, front_z]) for s in (-1, 1) for d in (-0.03, 0.02)]
    )
    right = joined(rail, placed(tower, origin, axis), brace)
    beam = box((beam_x - 0.03, -y - 0.12, front_z - 0.12), (beam_x + 0.02, y + 0.12, front_z))
    stay = hull([points["body_front"] + (x, w, h) for x in (-0.03, 0.03) for w in (-0.05, 0.05) for h in (-0.025, 0.0)])
    panel = [rod((points["body_front"][0], -y, front_z - 0.04), (points["body_front"][0], y, front_z - 0.04), 0.02)]
    return joined(right, mirrored(right), beam, stay, panel)


def subframe(points: Points) -> trimesh.Trimesh:
    """Cross member with the brackets of arms, stabilizer and torque arm, and the housing of the steering rack."""
    p = right_handed(points, "fr")
    front, rear, stab, tie = p["arm_front"], p["arm_rear"], p["stab_body"], p["tie_inner"]
    z = rear[2] + 0.005
    middle = shifted((front + rear) / 2, 0.0, -0.075, 0.0)
    path = spline([shifted(front, 0.0, -0.075, 0.0), middle, shifted(rear, 0.02, -0.07, 0.0)], 5)
    side = tube(path, 0.022, sides=4, width=0.030, up=(0, 0, 1))
    brackets = []
    for s in (-1, 1):
        ear = shifted(front, s * 0.04, 0.0, 0.0)
        brackets.append(
            hull(
                [
                    shifted(ear, t, dy, dz)
                    for t in (-0.004, 0.004)
                    for dy, dz in ((0.025, -0.02), (0.025, 0.02), (-0.07, -0.022), (-0.07, 0.022))
                ]
            )
        )
        plate = shifted(rear, 0.0, 0.0, s * 0.036)
        brackets.append(
            hull(
                [
                    shifted(plate, dx, dy, t)
                    for t in (-0.004, 0.004)
                    for dx, dy in ((-0.035, 0.03), (0.035, 0.03), (-0.045, -0.08), (0.045, -0.08))
                ]
            )
        )
    pad = hull([shifted(stab, dx, dy, dz) for dx in (-0.052, 0.052) for dy in (-0.03, 0.03) for dz in (-0.030, -0.022)])
    post = hull(
        [
            shifted(stab, dx, dy, dz)
            for dx in (-0.03, 0.03)
            for dy, dz in ((-0.02, -0.024), (0.02, -0.024), (-0.02, -0.06), (0.02, -0.06))
        ]
    )
    right = joined(side, brackets, pad, post, stabilizer_clamp(p))
    x = 0.5 * (rear[0] + stab[0])
    cross = box((x - 0.055, -rear[1] + 0.06, z - 0.045), (x + 0.075, rear[1] - 0.06, z - 0.008), 0.010)
    body_eye = points["bottom_body"]
    fork = [
        hull(
            [
                shifted(body_eye, dx, dy, s * 0.03 + t)
                for t in (-0.004, 0.004)
                for dx, dy in ((-0.03, -0.035), (-0.03, 0.035), (0.06, -0.06), (0.06, 0.06))
            ]
        )
        for s in (-1, 1)
    ]
    bolt = rod(body_eye - (0, 0, 0.045), shifted(body_eye, 0, 0, 0.045), 0.008)
    rack = rod((tie[0], -tie[1] - 0.0, tie[2]), (tie[0], tie[1], tie[2]), 0.019, sides=8)
    pinion = placed(
        ring(0.0, 0.026, -0.03, 0.05, sections=10), (tie[0], 0.0 + 0.55 * points["seat"][1], tie[2]), (0.3, 0, 1)
    )
    return joined(right, mirrored(right), cross, fork, bolt, rack, pinion)


def rack_bellows(points: Points) -> trimesh.Trimesh:
    """Rubber bellows at both ends of the steering rack."""
    tie = right_handed(points, "fr")["tie_inner"]
    profile: list[tuple[float, float]] = [(0.010, -0.085)]
    for k in range(2):
        profile += [(0.028 - 0.0015 * k, -0.065 + 0.06 * k), (0.020 - 0.0012 * k, -0.035 + 0.06 * k)]
    right = placed(lathe([*profile, (0.010, 0.05)], sections=10, closed=True), tie, (0, 1, 0))
    return joined(right, mirrored(right))


def exhaust(points: Points) -> trimesh.Trimesh:
    """Exhaust pipe in the tunnel with a silencer, ahead of the rear supports."""
    start = points["bottom_body"] + (0.12, 0.06, -0.01)
    end_x = float(points["rear_support_right"][0]) + 0.55
    z = start[2]
    path: Array = np.array(
        [
            start,
            shifted(start, 0.5, -0.02, 0.0),
            (end_x - 0.9, 0.06, z),
            (end_x - 0.3, 0.2, z + 0.09),
            (end_x + 0.36, 0.36, z + 0.06),
        ]
    )
    pipe = tube(spline(path, 10), 0.024, sides=6)
    silencer = tube(
        [(end_x - 0.05, 0.27, z + 0.09), (end_x + 0.25, 0.34, z + 0.07)], 0.065, sides=10, width=0.10, up=(0, 0, 1)
    )
    return joined(pipe, silencer)
