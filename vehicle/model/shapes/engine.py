"""Transverse engine with gearbox, belt drive, cans of the side mounts and torque arm."""

from collections.abc import Iterable, Sequence

import numpy as np
import trimesh

from vehicle.arrays import Vector
from vehicle.model.shapes import palette
from vehicle.model.shapes.shape import Piece, Points, Sizes
from vehicle.model.shapes.solids import block, box, drum, hull, joined, lathe, placed, ring, rod, shifted, tube
from vehicle.model.shapes.surface import bezier

ACROSS = (0.0, 1.0, 0.0)
UPRIGHT = (0.0, 0.0, 1.0)
MOUNT_SPAN = 0.86  # [m] distance of the side mounts along y in the drawing
CYLINDERS = -0.045 + 0.095 * np.arange(4)  # [m] y of the cylinders
SIDE_MOUNTS = (("hydromount", 0.052), ("linear_mount", 0.046))  # point, radius of the can [m]
PULLEYS = (  # x, z of the axle and radius in drawing coordinates [m]: crank, water pump, alternator, air conditioning
    (0.010, -0.135, 0.074),
    (0.060, 0.065, 0.052),
    (-0.105, 0.060, 0.031),
    (-0.120, -0.105, 0.056),
)


class EngineFrame:
    """Drawing coordinates about the centre of gravity of the engine, scaled along y to the distance of the mounts."""

    def __init__(self, points: Points) -> None:
        self.origin = np.array(points["engine_cog"], dtype=float)
        self.stretch = float(points["hydromount"][1] - points["linear_mount"][1]) / MOUNT_SPAN

    def at(self, x: float, y: float, z: float) -> Vector:
        """Convert drawing coordinates [m] to a point of the vehicle [m], shape (3,)."""
        point: Vector = self.origin + np.array([x, y * self.stretch, z])
        return point

    def box(self, low: Sequence[float], high: Sequence[float], bevel: float = 0.0) -> trimesh.Trimesh:
        """Build a bevelled box between two points in drawing coordinates."""
        return box(self.at(*low), self.at(*high), bevel)

    def hull(self, points: Iterable[Sequence[float]]) -> trimesh.Trimesh:
        """Build the convex hull of points in drawing coordinates."""
        return hull([self.at(*point) for point in points])

    def arm(
        self, start: Sequence[float], corner: Sequence[float], end: Vector, half: float, width: Vector
    ) -> trimesh.Trimesh:
        """Build a bracket from the engine up to the point of a mount."""
        path = bezier(self.at(*start), self.at(*corner), end, 6)
        return tube(path, half, width=width, up=UPRIGHT, sides=4)


def engine(points: Points, size: Sizes) -> list[Piece]:
    """Draw castings, block, covers, auxiliary drive, rubber of the mounts and the bolt of the torque arm."""
    e = EngineFrame(points)
    neck = lathe([(0, -0.024), (0.040, -0.024), (0.022, 0.0), (0, 0.0)], sections=14)
    bolt = points["bottom_engine"]
    return [
        Piece("_castings", castings(e, points), palette.ALUMINIUM),
        Piece("_block", cylinder_block(e), palette.CAST),
        Piece("_covers", covers(e), palette.ENGINE_DARK),
        Piece("_pulleys", pulleys(e), palette.STEEL),
        Piece("_belt", belt(e), palette.RUBBER),
        Piece("_mount_rubber", joined([placed(neck, points[name]) for name, _ in SIDE_MOUNTS]), palette.RUBBER),
        Piece("_bolt", rod(bolt - (0, 0.046, 0), shifted(bolt, 0, 0.046, 0), 0.008), palette.STEEL),
    ]


def castings(e: EngineFrame, points: Points) -> trimesh.Trimesh:
    """Draw cylinder head, gearbox with bell housing and differential, sump and the brackets of the mounts."""
    hydromount, linear, bottom = points["hydromount"], points["linear_mount"], points["bottom_engine"]
    head = e.box((-0.105, -0.10, 0.055), (0.105, 0.285, 0.150), 0.012)
    sump = e.hull(
        [(x, y, -0.185) for x in (-0.115, 0.115) for y in (-0.10, 0.28)]
        + [(x, y, -0.285) for x in (-0.080, 0.065) for y in (-0.07, 0.25)]
    )
    bell = [(0, 0.110), (0.185, 0.110), (0.185, 0.135), (0.168, 0.150), (0.128, 0.235), (0, 0.235)]
    main = [(0, 0.23), (0.122, 0.23), (0.118, 0.325), (0.102, 0.335), (0.095, 0.400), (0, 0.400)]
    differential = [(0, 0.115), (0.110, 0.115), (0.105, 0.215), (0.060, 0.240), (0.038, 0.275), (0, 0.275)]
    gears = [
        placed(lathe([(r, h * e.stretch) for r, h in profile], sections=16), e.at(x, 0, z), (0.0, -1.0, 0.0))
        for profile, x, z in ((bell, 0.0, -0.075), (main, 0.015, -0.085), (differential, 0.150, -0.155))
    ]
    ribs = [e.box((-0.007 + x, -0.325, -0.215), (0.007 + x, -0.235, 0.045)) for x in (-0.045, 0.015, 0.075)]
    arms = [
        e.arm((0.03, 0.20, 0.13), (0.07, 0.26, 0.20), hydromount, 0.017, np.linspace(0.045, 0.026, 6)),
        e.arm((0.03, -0.30, -0.02), (0.05, -0.34, 0.10), linear, 0.016, np.linspace(0.050, 0.028, 6)),
    ]
    root = e.at(0.12, 0.0, -0.20)
    fork = [
        hull(
            [shifted(root, 0, y + w, h) for w in (-0.012, 0.012) for h in (-0.04, 0.04)]
            + [shifted(bottom, x, y + w, h) for w in (-0.005, 0.005) for h in (-0.016, 0.016) for x in (0.0, 0.018)]
        )
        for y in (-0.030, 0.030)
    ]
    return joined(head, sump, gears, ribs, arms, fork)


def cylinder_block(e: EngineFrame) -> trimesh.Trimesh:
    """Draw the cast block with the four bores as ribs, exhaust heat shield, starter and oil filter."""
    shell = e.box((-0.100, -0.11, -0.190), (0.110, 0.285, 0.060), 0.010)
    bores = [placed(drum(0.040, -0.130, 0.05, sections=8), e.at(0.085, y, 0)) for y in CYLINDERS]
    starter = placed(drum(0.036, 0.0, 0.17, bevel=0.006, sections=10), e.at(-0.135, -0.09, -0.12), ACROSS)
    oil_filter = placed(drum(0.038, 0.0, 0.09, bevel=0.008, sections=10), e.at(-0.09, 0.16, -0.11), (-1, 0, 0))
    section = ((0.10, 0.12), (0.16, 0.11), (0.19, 0.04), (0.17, -0.06), (0.11, -0.06))
    shield = e.hull([(x, y, z) for y in (-0.04, 0.22) for x, z in section])
    return joined(shell, bores, starter, oil_filter, shield)


def covers(e: EngineFrame) -> trimesh.Trimesh:
    """Draw parts of dark plastic: camshaft cover with ribs, intake plenum with four runners, timing cover, hoses."""
    cam = e.hull(
        [(x, y, 0.148) for x in (-0.095, 0.095) for y in (-0.095, 0.28)]
        + [(x, y, 0.192) for x in (-0.070, 0.070) for y in (-0.080, 0.265)]
    )
    ribs = [e.box((-0.060, y - 0.006, 0.188), (0.060, y + 0.006, 0.201)) for y in (-0.045, 0.03, 0.105, 0.18)]
    cap = placed(drum(0.024, 0.185, 0.214, bevel=0.004, sections=10), e.at(-0.02, 0.235, 0))
    tank = drum(0.048, -0.14 * e.stretch, 0.17 * e.stretch, bevel=0.014, sections=12)
    plenum = placed(tank, e.at(-0.205, 0.06, 0.075), ACROSS)
    runners = []
    for y in CYLINDERS:
        end = e.at(-0.225, 0.06 + 0.85 * (y - 0.0975), 0.09)
        runners.append(tube(bezier(e.at(-0.10, y, 0.105), e.at(-0.20, y, 0.19), end, 5), 0.021, sides=6))
    timing = e.box((-0.085, 0.285, -0.170), (0.095, 0.315, 0.165), 0.010)
    path = bezier(e.at(-0.205, -0.075, 0.075), e.at(-0.21, -0.27, 0.09), e.at(-0.08, -0.33, 0.14), 5)
    return joined(cam, ribs, cap, plenum, runners, timing, tube(path, 0.030, sides=7))


def pulleys(e: EngineFrame) -> trimesh.Trimesh:
    """Draw the pulleys of the auxiliary drive at the timing end, with the bodies of alternator and compressor."""
    wheels = []
    for x, z, r in PULLEYS:
        profile = [(0, 0.0), (r, 0.0), (r - 0.004, 0.014), (r, 0.028), (r - 0.007, 0.028), (0.6 * r, 0.014), (0, 0.026)]
        wheels.append(placed(lathe(profile, sections=12), e.at(x, 0.318, z), ACROSS))
    auxiliaries = [
        placed(drum(r, 0.0, 0.125, bevel=0.012, sections=10), e.at(x, 0.185, z), ACROSS)
        for (x, z, _), r in zip(PULLEYS[2:], (0.058, 0.056), strict=True)
    ]
    return joined(wheels, auxiliaries)


def belt(e: EngineFrame) -> trimesh.Trimesh:
    """Draw the belt around the pulleys: at every angle, the belt touches the outermost pulley in that direction."""
    phi = np.linspace(0, 2 * np.pi, 30, endpoint=False)
    normal = np.column_stack([np.cos(phi), np.sin(phi)])
    circles = np.array(PULLEYS)
    chosen = circles[np.argmax(normal @ circles[:, :2].T + circles[:, 2], axis=1)]
    flat = chosen[:, :2] + (chosen[:, 2:] - 0.002) * normal
    path = shifted(np.array([e.at(x, 0.318, z) for x, z in flat]), 0, 0.014, 0)
    return tube(path, 0.0085, sides=4, closed=True, width=0.003, up=ACROSS)


def side_mounts(points: Points, size: Sizes) -> list[Piece]:
    """Draw the cans of hydromount and linear mount with their feet, fixed to the body."""
    cans = []
    for name, r in SIDE_MOUNTS:
        profile = [(0, -0.072), (r, -0.072), (r, -0.030), (r - 0.008, -0.022), (0, -0.018)]
        foot = block(points[name] + (0, 0, -0.078), (-0.075, -0.040, -0.006), (0.075, 0.04, 0.008))
        cans += [placed(lathe(profile, sections=14), points[name]), foot]
    return [Piece("_engine_mounts", joined(cans), palette.DARK_STEEL)]


def torque_arm(points: Points, size: Sizes) -> list[Piece]:
    """Draw the dog bone between engine and body: a waisted bar with an eye at each end, and the rubber of both eyes."""
    a, b = points["bottom_engine"], points["bottom_body"]
    along = (b - a) / np.linalg.norm(b - a)
    path = np.linspace(a + 0.026 * along, b - 0.034 * along, 5)
    bar = tube(path, 0.011, sides=4, width=np.array([0.020, 0.013, 0.012, 0.015, 0.026]), up=UPRIGHT)
    eyes, cores = [], []
    for centre, axis, inner, outer, half in ((a, ACROSS, 0.020, 0.030, 0.018), (b, UPRIGHT, 0.028, 0.040, 0.024)):
        eyes.append(placed(ring(inner, outer, -half, half, sections=14), centre, axis))
        cores.append(placed(ring(0.008, inner + 0.0005, -half - 0.002, half + 0.002, sections=10), centre, axis))
    return [Piece("", joined(bar, eyes), palette.LINK), Piece("_rubber", joined(cores), palette.RUBBER)]
