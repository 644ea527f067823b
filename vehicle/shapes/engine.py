"""Transverse engine with gearbox, belt drive and the torque arm."""

from __future__ import annotations

import numpy as np
import trimesh
from numpy.typing import ArrayLike

from vehicle.shapes.block import box, hull
from vehicle.shapes.curve import bezier
from vehicle.shapes.hardpoint import Points
from vehicle.shapes.lathe import drum, lathe, ring
from vehicle.shapes.placement import joined, placed, shifted
from vehicle.shapes.shape import Array
from vehicle.shapes.tube import rod, tube

ACROSS = (0.0, 1.0, 0.0)
MOUNT_SPAN = 0.86  # [m] distance of the side mounts along y for which the drawing was made
CYLINDERS = 4


class EngineFrame:
    """Drawing coordinates about the engine's centre of gravity, stretched along y to the distance of the mounts."""

    def __init__(self, points: Points) -> None:
        self.origin = np.array(points["engine_cog"], dtype=float)
        self.stretch = float(points["hydromount"][1] - points["linear_mount"][1]) / MOUNT_SPAN

    def at(self, x: float, y: float, z: float) -> Array:
        """Drawing coordinates [m] as a point of the vehicle."""
        point: Array = self.origin + np.array([x, y * self.stretch, z])
        return point

    def box(self, low: tuple[float, float, float], high: tuple[float, float, float], bevel: float) -> trimesh.Trimesh:
        """A bevelled box between two points in drawing coordinates."""
        return box(self.at(*low), self.at(*high), bevel)

    def hull(self, points: ArrayLike) -> trimesh.Trimesh:
        """The hull of points in drawing coordinates."""
        return hull([self.at(*point) for point in np.asarray(points, dtype=float)])


def castings(points: Points) -> trimesh.Trimesh:
    """Cylinder head, gearbox with bell housing and differential, sump and the brackets of the mounts."""
    e = EngineFrame(points)
    hydromount, linear, bottom = points["hydromount"], points["linear_mount"], points["bottom_engine"]
    head = e.box((-0.105, -0.10, 0.055), (0.105, 0.285, 0.150), 0.012)
    sump = e.hull(
        [(x, y, -0.185) for x in (-0.115, 0.115) for y in (-0.10, 0.28)]
        + [(x, y, -0.285) for x in (-0.080, 0.065) for y in (-0.07, 0.25)]
    )
    bell = [(0, 0.110), (0.185, 0.110), (0.185, 0.135), (0.168, 0.150), (0.128, 0.235), (0, 0.235)]
    main = [(0, 0.23), (0.122, 0.23), (0.118, 0.325), (0.102, 0.335), (0.095, 0.400), (0, 0.400)]
    differential = [(0, 0.115), (0.110, 0.115), (0.105, 0.215), (0.060, 0.240), (0.038, 0.275), (0, 0.275)]
    toward_gearbox = (0.0, -1.0, 0.0)
    gears = [
        placed(lathe([(r, h * e.stretch) for r, h in profile], sections=16), e.at(x, 0, z), toward_gearbox)
        for profile, x, z in ((bell, 0.0, -0.075), (main, 0.015, -0.085), (differential, 0.150, -0.155))
    ]
    ribs = [e.box((-0.007 + x, -0.325, -0.215), (0.007 + x, -0.235, 0.045), 0.0) for x in (-0.045, 0.015, 0.075)]
    hydro_arm = tube(
        bezier(e.at(0.03, 0.20, 0.13), e.at(0.07, 0.26, 0.20), hydromount, 6),
        0.017,
        width=np.linspace(0.045, 0.026, 6),
        up=(0, 0, 1),
        sides=4,
    )
    linear_arm = tube(
        bezier(e.at(0.03, -0.30, -0.02), e.at(0.05, -0.34, 0.10), linear, 6),
        0.016,
        width=np.linspace(0.050, 0.028, 6),
        up=(0, 0, 1),
        sides=4,
    )
    fork_root = e.at(0.12, 0.0, -0.20)
    fork = [
        hull(
            [shifted(fork_root, 0, y + w, h) for w in (-0.012, 0.012) for h in (-0.04, 0.04)]
            + [shifted(bottom, x, y + w, h) for w in (-0.005, 0.005) for h in (-0.016, 0.016) for x in (0.0, 0.018)]
        )
        for y in (-0.030, 0.030)
    ]
    return joined(head, sump, gears, ribs, hydro_arm, linear_arm, fork)


def cylinder_block(points: Points) -> trimesh.Trimesh:
    """Cast block with the four bores showing as ribs, exhaust heat shield, starter and oil filter."""
    e = EngineFrame(points)
    block = e.box((-0.100, -0.11, -0.190), (0.110, 0.285, 0.060), 0.010)
    bores = [
        placed(drum(0.040, -0.130, 0.05, sections=8), e.at(0.085, y, 0)) for y in -0.045 + 0.095 * np.arange(CYLINDERS)
    ]
    starter = placed(drum(0.036, 0.0, 0.17, bevel=0.006, sections=10), e.at(-0.135, -0.09, -0.12), ACROSS)
    oil_filter = placed(drum(0.038, 0.0, 0.09, bevel=0.008, sections=10), e.at(-0.09, 0.16, -0.11), (-1, 0, 0))
    shield = e.hull(
        [
            (x, y, z)
            for y in (-0.04, 0.22)
            for x, z in ((0.10, 0.12), (0.16, 0.11), (0.19, 0.04), (0.17, -0.06), (0.11, -0.06))
        ]
    )
    return joined(block, bores, starter, oil_filter, shield)


def covers(points: Points) -> trimesh.Trimesh:
    """Dark plastic: camshaft cover with ribs, intake plenum with four runners, timing cover, hoses."""
    e = EngineFrame(points)
    cam = e.hull(
        [(x, y, 0.148) for x in (-0.095, 0.095) for y in (-0.095, 0.28)]
        + [(x, y, 0.192) for x in (-0.070, 0.070) for y in (-0.080, 0.265)]
    )
    ribs = [e.box((-0.060, y - 0.006, 0.188), (0.060, y + 0.006, 0.201), 0.0) for y in (-0.045, 0.03, 0.105, 0.18)]
    cap = placed(drum(0.024, 0.185, 0.214, bevel=0.004, sections=10), e.at(-0.02, 0.235, 0))
    plenum = placed(
        drum(0.048, -0.14 * e.stretch, 0.17 * e.stretch, bevel=0.014, sections=12), e.at(-0.205, 0.06, 0.075), ACROSS
    )
    runners = [
        tube(
            bezier(e.at(-0.10, y, 0.105), e.at(-0.20, y, 0.19), e.at(-0.225, 0.06 + 0.85 * (y - 0.0975), 0.09), 5),
            0.021,
            sides=6,
        )
        for y in -0.045 + 0.095 * np.arange(CYLINDERS)
    ]
    timing = e.box((-0.085, 0.285, -0.170), (0.095, 0.315, 0.165), 0.010)
    hose = tube(
        bezier(e.at(-0.205, -0.075, 0.075), e.at(-0.21, -0.27, 0.09), e.at(-0.08, -0.33, 0.14), 5), 0.030, sides=7
    )
    return joined(cam, ribs, cap, plenum, runners, timing, hose)


PULLEYS = (  # x, z of the axle and radius in drawing coordinates [m]: crank, water pump, alternator, air conditioning
    (0.010, -0.135, 0.074),
    (0.060, 0.065, 0.052),
    (-0.105, 0.060, 0.031),
    (-0.120, -0.105, 0.056),
)


def pulleys(points: Points) -> trimesh.Trimesh:
    """Pulleys of the auxiliary drive at the timing end, with the bodies of alternator and compressor."""
    e = EngineFrame(points)
    wheels = []
    for x, z, r in PULLEYS:
        profile = [(0, 0.0), (r, 0.0), (r - 0.004, 0.014), (r, 0.028), (r - 0.007, 0.028), (0.6 * r, 0.014), (0, 0.026)]
        wheels.append(placed(lathe(profile, sections=12), e.at(x, 0.318, z), ACROSS))
    auxiliaries = [
        placed(drum(r, 0.0, 0.125, bevel=0.012, sections=10), e.at(x, 0.185, z), ACROSS)
        for (x, z, _), r in ((PULLEYS[2], 0.058), (PULLEYS[3], 0.056))
    ]
    return joined(wheels, auxiliaries)


def belt(points: Points) -> trimesh.Trimesh:
    """Belt around the pulleys: at every angle it touches the pulley that reaches farthest in that direction."""
    e = EngineFrame(points)
    phi = np.linspace(0, 2 * np.pi, 30, endpoint=False)
    normal = np.column_stack([np.cos(phi), np.sin(phi)])
    circles = np.array(PULLEYS)
    reach = normal @ circles[:, :2].T + circles[:, 2]
    chosen = circles[np.argmax(reach, axis=1)]
    flat = chosen[:, :2] + (chosen[:, 2:] - 0.002) * normal
    path = shifted(np.array([e.at(x, 0.318, z) for x, z in flat]), 0, 0.014, 0)
    return tube(path, 0.0085, sides=4, closed=True, width=0.003, up=ACROSS)


def side_mounts(points: Points) -> trimesh.Trimesh:
    """Cans of hydromount and linear mount with their feet, fixed to the body."""
    cans = []
    for name, r in (("hydromount", 0.052), ("linear_mount", 0.046)):
        profile = [(0, -0.072), (r, -0.072), (r, -0.030), (r - 0.008, -0.022), (0, -0.018)]
        foot = points[name] + (0, 0, -0.078)
        cans += [
            placed(lathe(profile, sections=14), points[name]),
            box(foot - (0.075, 0.040, 0.006), shifted(foot, 0.075, 0.04, 0.008)),
        ]
    return joined(cans)


def mount_rubber(points: Points) -> trimesh.Trimesh:
    """Rubber necks on top of both cans, up to the engine's brackets."""
    neck = lathe([(0, -0.024), (0.040, -0.024), (0.022, 0.0), (0, 0.0)], sections=14)
    return joined(placed(neck, points["hydromount"]), placed(neck, points["linear_mount"]))


def torque_arm(points: Points) -> trimesh.Trimesh:
    """Dog bone between engine and body: a waisted bar with an eye at each end."""
    a, b = points["bottom_engine"], points["bottom_body"]
    along = (b - a) / np.linalg.norm(b - a)
    path = np.linspace(a + 0.026 * along, b - 0.034 * along, 5)
    bar = tube(path, 0.011, sides=4, width=np.array([0.020, 0.013, 0.012, 0.015, 0.026]), up=(0, 0, 1))
    return joined(
        bar,
        placed(ring(0.020, 0.030, -0.018, 0.018, sections=14), a, ACROSS),
        placed(ring(0.028, 0.040, -0.024, 0.024, sections=14), b, (0, 0, 1)),
    )


def torque_arm_rubber(points: Points) -> trimesh.Trimesh:
    """Rubber of both eyes."""
    return joined(
        placed(ring(0.008, 0.0205, -0.020, 0.020, sections=10), points["bottom_engine"], ACROSS),
        placed(ring(0.008, 0.0285, -0.026, 0.026, sections=10), points["bottom_body"], (0, 0, 1)),
    )


def torque_arm_bolt(points: Points) -> trimesh.Trimesh:
    """The engine-side bolt of the torque arm, through the fork."""
    b = points["bottom_engine"]
    return rod(b - (0, 0.046, 0), shifted(b, 0, 0.046, 0), 0.008)
