"""Lower arm, knuckle, steering rod and stabilizer of the right side."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import trimesh
from numpy.typing import ArrayLike

from vehicle.shapes.block import hull
from vehicle.shapes.curve import bezier, rounded
from vehicle.shapes.hardpoint import Points
from vehicle.shapes.lathe import ball, drum, lathe, ring
from vehicle.shapes.patch import ruled_slab
from vehicle.shapes.placement import joined, placed, shifted
from vehicle.shapes.shape import Array
from vehicle.shapes.strut import strut_frame
from vehicle.shapes.tube import rod, tube

FORE_AFT = (1.0, 0.0, 0.0)
UPRIGHT = (0.0, 0.0, 1.0)
STABILIZER_RADIUS = 0.0105  # [m] assumed: 21 mm bar
BUSHINGS = (  # hardpoint, axis of the sleeve, inner radius, outer radius, half length [m]
    ("arm_front", FORE_AFT, 0.019, 0.027, 0.027),
    ("arm_rear", UPRIGHT, 0.027, 0.036, 0.024),
)


def a_arm(points: Points) -> trimesh.Trimesh:
    """L-shaped forged arm: a cross leg to the stiff front bushing, a curved leg to the soft rear one, a web between."""
    ball_joint, front, rear = points["lower_ball"], points["arm_front"], points["arm_rear"]
    normal = np.cross(rear - front, ball_joint - front)
    normal = normal / np.linalg.norm(normal)
    normal = normal if normal[2] > 0 else -normal
    start = ball_joint + 0.16 * (front - ball_joint)
    corner = front + 0.30 * (ball_joint - front) + 0.30 * (rear - front)
    outer = bezier(start, corner, rear, 7)
    cross_leg = tube(np.linspace(ball_joint, front, 3), 0.013, sides=6, width=np.linspace(0.021, 0.030, 3), up=normal)
    rear_leg = tube(outer, 0.013, sides=6, width=np.linspace(0.020, 0.024, 7), up=normal)
    inner = np.linspace(start, front, 7) + np.linspace(0.02, 0.12, 7)[:, None] * (rear - front)
    web = ruled_slab(inner[1:], outer[:-1], 0.006 * normal)
    eyes = [
        placed(ring(inside, outside, -half, half, sections=10), points[name], axis)
        for name, axis, inside, outside, half in BUSHINGS
    ]
    cup = lathe([(0, -0.024), (0.018, -0.024), (0.026, -0.012), (0.024, 0.013), (0, 0.013)], sections=12)
    return joined(cross_leg, rear_leg, web, eyes, placed(cup, ball_joint))


def a_arm_rubber(points: Points) -> trimesh.Trimesh:
    """Rubber of both bushings and the bellows of the ball joint."""
    cores = []
    for name, axis, inside, _, half in BUSHINGS:
        r = inside + 0.001
        profile = [(0, -half - 0.006), (0.55 * r, -half - 0.006), (r, -half + 0.002), (r, half - 0.002)]
        profile += [(0.55 * r, half + 0.006), (0, half + 0.006)]
        cores.append(placed(lathe(profile, sections=10), points[name], axis))
    boot = lathe([(0, 0.011), (0.018, 0.011), (0.021, 0.018), (0.012, 0.030), (0, 0.030)], sections=10)
    return joined(cores, placed(boot, points["lower_ball"]))


def a_arm_bolts(points: Points) -> trimesh.Trimesh:
    """Bolts through the bushings, fixed to the subframe."""
    return joined(
        [
            placed(drum(0.0075, -half - 0.022, half + 0.022, sections=6), points[name], axis)
            for name, axis, _, _, half in BUSHINGS
        ]
    )


def knuckle(points: Points, size: Mapping[str, float]) -> trimesh.Trimesh:
    """Cast upright: hub bearing, leg to the ball joint, clamp around the damper, steering arm."""
    wheel, ball_joint, tie = points["wheel_center"], points["lower_ball"], points["tie_outer"]
    origin, axis, _, _ = strut_frame(points)
    bearing = wheel - (0.0, 0.030, 0.0)
    hub_profile = [(0.012, -0.052), (0.044, -0.052), (0.050, -0.012), (0.066, 0.000)]
    hub = lathe(
        [*hub_profile, (0.066, 0.010), (0.029, 0.012), (0.029, 0.052), (0.012, 0.052)], sections=12, closed=True
    )
    r = size["damper_tube_radius"] + 0.0005
    clamp = lathe(
        [(r, -0.034), (r + 0.014, -0.034), (r + 0.014, 0.054), (r, 0.054)],
        sections=12,
        closed=True,
    )
    inward = np.array([-1.0, 0.0, 0.0])
    lug = origin + 0.010 * axis + (r + 0.016) * inward
    lugs = [
        hull([lug + a * inward * 0.014 + b * axis * 0.032 + (0, c, 0) for a in (-1, 1) for b in (-1, 1) for c in span])
        for span in ((0.004, 0.014), (-0.014, -0.004))
    ]
    pinch = [
        rod(lug + h * axis - (0, 0.022, 0), lug + h * axis + (0, 0.022, 0), 0.006, sides=6) for h in (-0.018, 0.018)
    ]
    lower_leg = tube(
        bezier(shifted(ball_joint, 0, 0, 0.026), shifted(ball_joint, 0, -0.004, 0.05), bearing - (0, 0, 0.03), 5),
        np.linspace(0.016, 0.022, 5),
        width=np.linspace(0.024, 0.042, 5),
        up=(0, 1, 0),
        sides=6,
    )
    upper_leg = hull(
        [
            *(origin + s * (r + 0.006) * np.array([1.0, 0, 0]) + h * axis for s in (-1, 1) for h in (-0.03, 0.048)),
            *(shifted(bearing, s * 0.042, d, h) for s in (-1, 1) for d in (-0.012, 0.014) for h in (-0.026, 0.036)),
        ]
    )
    root = shifted(bearing, 0.035, 0.0, -0.015)
    arm = tube(
        bezier(root, (root[0] + 0.6 * (tie[0] - root[0]), root[1], tie[2]), tie, 5),
        np.linspace(0.017, 0.011, 5),
        width=np.linspace(0.020, 0.015, 5),
        up=UPRIGHT,
        sides=6,
    )
    eye = placed(drum(0.019, -0.012, 0.012, bevel=0.003, sections=10), tie)
    stud = rod(ball_joint, shifted(ball_joint, 0, 0, 0.034), 0.009)
    return joined(
        placed(hub, wheel, (0, 1, 0)), placed(clamp, origin, axis), lugs, pinch, lower_leg, upper_leg, arm, eye, stud
    )


def steering_rod(points: Points) -> trimesh.Trimesh:
    """Tube with a ball at each end, the adjusting nut near the outer one."""
    inner, outer = points["tie_inner"], points["tie_outer"]
    return link(inner, outer, radius=0.0085, ball_radius=0.0165, nut_at=0.74)


def stabilizer_rod(points: Points) -> trimesh.Trimesh:
    """Slim rod with a ball joint at each end."""
    return link(points["stab_end"], points["stab_rod_top"], radius=0.0060, ball_radius=0.0135, nut_at=None)


def link(
    start: ArrayLike, end: ArrayLike, *, radius: float, ball_radius: float, nut_at: float | None
) -> trimesh.Trimesh:
    """A rod [m] with balls at both ends and, at a share of its length, a hexagonal nut."""
    a, b = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    parts = [rod(a, b, radius, sides=6), *(placed(ball(ball_radius, sections=8), end, b - a) for end in (a, b))]
    if nut_at is not None:
        parts.append(placed(drum(1.7 * radius, -0.016, 0.016, sections=6), a + nut_at * (b - a), b - a))
    return joined(parts)


def stabilizer_half(points: Points) -> trimesh.Trimesh:
    """Bent bar from its end, past the bushing on the body, to the middle plane, with an eye at the end."""
    end, bushing = points["stab_end"], points["stab_body"]
    middle = np.array([bushing[0], 0.0, bushing[2]])
    # the arm bends forward just outside the bushing, so the straight part passes through the hardpoint
    bend = bushing + 0.25 * (np.array([bushing[0], end[1], bushing[2]]) - bushing)
    path = rounded(np.array([end, bend, middle]), 0.045, steps=5)
    path = np.vstack([path[:-1], bushing - (0, 0.02, 0), middle])
    bar = tube(path, STABILIZER_RADIUS, sides=6)
    return joined(bar, placed(drum(0.017, -0.007, 0.007, bevel=0.002, sections=10), end, points["stab_rod_top"] - end))


def stabilizer_bushing(points: Points) -> trimesh.Trimesh:
    """Rubber block around the bar, fixed to the subframe."""
    return placed(ring(STABILIZER_RADIUS, 0.024, -0.018, 0.018, sections=10), points["stab_body"], (0, 1, 0))


def stabilizer_clamp(points: Points) -> trimesh.Trimesh:
    """Steel strap over the rubber block."""
    phi = np.linspace(-0.25 * np.pi, 1.25 * np.pi, 6)
    arc = np.column_stack([0.026 * np.cos(phi), np.zeros(6), 0.026 * np.sin(phi)])
    foot: Array = np.array([[0.046, 0, -0.022]])
    path = np.vstack([foot, arc, foot * (-1, 1, 1)])
    return placed(tube(path, 0.014, sides=4, width=0.002, up=(0, 1, 0)), points["stab_body"])
