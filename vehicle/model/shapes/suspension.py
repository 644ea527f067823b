"""Suspension of the right side: MacPherson strut with its spring, lower arm, knuckle, links and stabilizer."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import trimesh
from numpy.typing import ArrayLike

from vehicle.arrays import Vector
from vehicle.model.shapes import palette
from vehicle.model.shapes.shape import Piece, Points, Sizes
from vehicle.model.shapes.solids import ball, drum, hull, joined, lathe, placed, ring, rod, shifted, swept, tube
from vehicle.model.shapes.surface import bezier, helix, rounded

STRUT = ("damper_bottom", "spring_lower", "strut_top")
SEATS, EYES = ("lower", "upper"), ("damper_lower", "damper_upper")
SEAT_BELOW_TOP = 0.014  # [m] distance of the upper spring seat below the strut top
HOUSING_SHARE = 0.34  # end of the housing as a share of the distance from the lower seat to the strut top
LOWEST_TURN = 0.60  # radius of the lowest turn over that of the other turns: the tyre is close there
FORE_AFT = (1.0, 0.0, 0.0)
ACROSS = (0.0, 1.0, 0.0)
UPRIGHT = (0.0, 0.0, 1.0)
STABILIZER_RADIUS = 0.0105  # [m] assumed: 21 mm bar
BUSHINGS = (  # point, axis of the sleeve, inner radius, outer radius, half length [m]
    ("arm_front", FORE_AFT, 0.019, 0.027, 0.027),
    ("arm_rear", UPRIGHT, 0.027, 0.036, 0.024),
)


class StrutAxis(NamedTuple):
    """Axis of the strut with positions along the axis."""

    origin: Vector
    """damper bottom, shape (3,) [m]"""
    axis: Vector
    """unit vector to the strut top, shape (3,)"""
    seat: float
    """distance of the lower spring seat [m]"""
    top: float
    """distance of the strut top [m]"""

    def turned(self, profile: ArrayLike, sections: int, *, closed: bool = False) -> trimesh.Trimesh:
        """Build the body of revolution of a profile about the axis of the strut.

        Args:
            profile: radius and distance from the damper bottom along the axis [m]; (n, 2).
            sections: number of divisions of the full turn.
            closed: join the last point to the first, for a ring that does not touch the axis.
        """
        return self.place(lathe(profile, sections=sections, closed=closed))

    def place(self, mesh: trimesh.Trimesh) -> trimesh.Trimesh:
        """Move a mesh built about z to the axis."""
        return placed(mesh, self.origin, self.axis)


def strut_axis(points: Points) -> StrutAxis:
    """Return the axis from the damper bottom to the strut top."""
    origin = points["damper_bottom"]
    along = points["strut_top"] - origin
    top = float(np.linalg.norm(along))
    return StrutAxis(origin, along / top, float((points["spring_lower"] - origin) @ (along / top)), top)


def damper_tube(points: Points, size: Sizes) -> list[Piece]:
    """Draw the housing tube with a rolled cap, and the spring dish on the tube, small enough to clear the tyre."""
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
    """Draw the polished rod from the housing to the top mount, the upper spring dish and the rubber bellows."""
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
    """Draw the rubber cone at the strut top, the steel plate above with three studs, and the nut of the rod."""
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
    """Draw the spring wire as a helix between the seats with a pigtail end: the radius grows over the lowest quarter.

    r(s) = r_low + (r - r_low) (3 q^2 - 2 q^3), q = min(s / 0.28, 1), s the share of the height
    """
    strut = strut_axis(points)
    wire, r, low = (size["spring_wire_radius"], size["spring_coil_radius"], LOWEST_TURN * size["spring_coil_radius"])

    def radius(share: Vector) -> Vector:
        q = np.minimum(share / 0.28, 1.0)
        return np.asarray(low + (r - low) * (3 * q**2 - 2 * q**3))

    high = strut.top - SEAT_BELOW_TOP - wire
    path = helix(radius, strut.seat + wire, high, size["spring_turns"], steps=13)
    return [Piece("", strut.place(tube(path, wire, sides=5)), palette.SPRING)]


def coil(points: Points, size: Sizes) -> list[Piece]:
    """Draw the spring wire as a helix of constant radius between two arbitrary seats."""
    lower, along, length = _between(points, SEATS)
    wire, r = size["spring_wire_radius"], size["spring_coil_radius"]
    path = helix(lambda share: r + 0.0 * share, wire, length - wire, size["spring_turns"], steps=13)
    return [Piece("", placed(tube(path, wire, sides=5), lower, along), palette.SPRING)]


def plain_tube(points: Points, size: Sizes) -> list[Piece]:
    """Draw the housing of a damper between two eyes, 3 cm to 60 % of the length."""
    lower, along, length = _between(points, EYES)
    eye = placed(ball(0.022, sections=8), lower, along)
    housing = placed(drum(size["damper_tube_radius"], 0.03, 0.6 * length, bevel=0.004, sections=14), lower, along)
    return [Piece("", joined(housing, eye), palette.DAMPER)]


def piston(points: Points, size: Sizes) -> list[Piece]:
    """Draw the rod of a damper between two eyes, the upper 60 % of the length."""
    lower, along, length = _between(points, EYES)
    shaft = rod(lower + 0.4 * length * along, lower + length * along, 0.009)
    return [Piece("", joined(shaft, placed(ball(0.018, sections=8), points[EYES[1]], along)), palette.ROD)]


def _between(points: Points, ends: tuple[str, str]) -> tuple[Vector, Vector, float]:
    """Return the lower end [m], the unit vector and the distance [m] to the upper end."""
    lower, upper = (points[end] for end in ends)
    length = float(np.linalg.norm(upper - lower))
    return lower, (upper - lower) / length, length


def lower_arm(points: Points, size: Sizes) -> list[Piece]:
    """Draw the L-shaped forged arm: cross leg to the stiff front bushing, curved leg to the soft rear bushing, and web.

    Rubber of both bushings and bellows of the ball joint; bolts through the bushings, fixed to the subframe.
    """
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
    a, b, half = inner[1:], outer[:-1], 0.006 * normal
    web = swept(np.stack([a + half, b + half, b - half, a - half], axis=1))
    cup = lathe([(0, -0.024), (0.018, -0.024), (0.026, -0.012), (0.024, 0.013), (0, 0.013)], sections=12)
    boot = lathe([(0, 0.011), (0.018, 0.011), (0.021, 0.018), (0.012, 0.030), (0, 0.030)], sections=10)
    eyes, cores, bolts = [], [], []
    for name, axis, inside, outside, h in BUSHINGS:
        r = inside + 0.001
        core = [(0, -h - 0.006), (0.55 * r, -h - 0.006), (r, -h + 0.002), (r, h - 0.002), (0.55 * r, h + 0.006)]
        eyes.append(placed(ring(inside, outside, -h, h, sections=10), points[name], axis))
        cores.append(placed(lathe([*core, (0, h + 0.006)], sections=10), points[name], axis))
        bolts.append(placed(drum(0.0075, -h - 0.022, h + 0.022, sections=6), points[name], axis))
    return [
        Piece("", joined(cross_leg, rear_leg, web, eyes, placed(cup, ball_joint)), palette.CAST),
        Piece("_rubber", joined(cores, placed(boot, ball_joint)), palette.RUBBER),
        Piece("_bolts", joined(bolts), palette.STEEL, held=True),
    ]


def knuckle(points: Points, size: Sizes) -> list[Piece]:
    """Draw the cast knuckle: hub bearing, leg to the ball joint, clamp around the damper, steering arm."""
    wheel, ball_joint, tie = points["wheel_center"], points["lower_ball"], points["tie_outer"]
    strut = strut_axis(points)
    origin, axis = strut.origin, strut.axis
    bearing = wheel - (0.0, 0.030, 0.0)
    hub = [(0.012, -0.052), (0.044, -0.052), (0.050, -0.012), (0.066, 0.000)]
    hub += [(0.066, 0.010), (0.029, 0.012), (0.029, 0.052), (0.012, 0.052)]
    r = size["damper_tube_radius"] + 0.0005
    clamp = strut.turned([(r, -0.034), (r + 0.014, -0.034), (r + 0.014, 0.054), (r, 0.054)], 12, closed=True)
    inward = np.array([-1.0, 0.0, 0.0])
    lug = origin + 0.010 * axis + (r + 0.016) * inward
    lugs = [
        hull([lug + a * inward * 0.014 + b * axis * 0.032 + (0, c, 0) for a in (-1, 1) for b in (-1, 1) for c in span])
        for span in ((0.004, 0.014), (-0.014, -0.004))
    ]
    pinch = [
        rod(lug + h * axis - (0, 0.022, 0), lug + h * axis + (0, 0.022, 0), 0.006, sides=6) for h in (-0.018, 0.018)
    ]
    path = bezier(shifted(ball_joint, 0, 0, 0.026), shifted(ball_joint, 0, -0.004, 0.05), bearing - (0, 0, 0.03), 5)
    lower_leg = tube(path, np.linspace(0.016, 0.022, 5), width=np.linspace(0.024, 0.042, 5), up=ACROSS, sides=6)
    upper_leg = hull(
        [
            *(origin + s * (r + 0.006) * np.array([1.0, 0, 0]) + h * axis for s in (-1, 1) for h in (-0.03, 0.048)),
            *(shifted(bearing, s * 0.042, d, h) for s in (-1, 1) for d in (-0.012, 0.014) for h in (-0.026, 0.036)),
        ]
    )
    root = shifted(bearing, 0.035, 0.0, -0.015)
    path = bezier(root, (root[0] + 0.6 * (tie[0] - root[0]), root[1], tie[2]), tie, 5)
    arm = tube(path, np.linspace(0.017, 0.011, 5), width=np.linspace(0.020, 0.015, 5), up=UPRIGHT, sides=6)
    eye = placed(drum(0.019, -0.012, 0.012, bevel=0.003, sections=10), tie)
    stud = rod(ball_joint, shifted(ball_joint, 0, 0, 0.034), 0.009)
    bearing_hub = placed(lathe(hub, sections=12, closed=True), wheel, ACROSS)
    mesh = joined(bearing_hub, clamp, lugs, pinch, lower_leg, upper_leg, arm, eye, stud)
    return [Piece("", mesh, palette.STEEL)]


def rods(points: Sequence[Vector], radius: float = 0.009, end: float = 0.015, nut: float | None = None) -> list[Piece]:
    """Draw a part as a rod between two points, rods from the mean of more points, or a ball at a single point.

    Args:
        points: points of the part, at least one, each of shape (3,) [m]
        radius: radius of the rods [m]
        end: radius of the balls at the points [m]
        nut: position of a hexagonal nut on a rod between two points, as a share of the length
    """
    middle = [points[0]] if len(points) == 2 else [np.mean(points, axis=0)]
    far = [point for point in points if np.linalg.norm(point - middle[0]) > 1e-6]
    parts = [rod(middle[0], point, radius, sides=6) for point in far]
    along = points[-1] - points[0] if far else np.array(UPRIGHT)
    parts += [placed(ball(end, sections=8), point, along) for point in points]
    if nut is not None:
        a, b = points
        parts.append(placed(drum(1.7 * radius, -0.016, 0.016, sections=6), a + nut * (b - a), b - a))
    return [Piece("", joined(parts), palette.LINK)]


def steering_rod(points: Points, size: Sizes) -> list[Piece]:
    """Draw a tube with a ball at each end and the adjusting nut near the outer end."""
    return rods([points["tie_inner"], points["tie_outer"]], 0.0085, 0.0165, nut=0.74)


def stabilizer_rod(points: Points, size: Sizes) -> list[Piece]:
    """Draw a slim rod with a ball joint at each end."""
    return rods([points["stab_end"], points["stab_rod_top"]], 0.0060, 0.0135)


def stabilizer_half(points: Points, size: Sizes) -> list[Piece]:
    """Draw the bent bar from its end to the middle plane, an eye at the end, and the rubber block on the subframe."""
    end, bushing = points["stab_end"], points["stab_body"]
    middle = np.array([bushing[0], 0.0, bushing[2]])
    # the arm bends forward just outside the bushing, so the straight part passes through the point
    bend = bushing + 0.25 * (np.array([bushing[0], end[1], bushing[2]]) - bushing)
    path = rounded(np.array([end, bend, middle]), 0.045, steps=5)
    path = np.vstack([path[:-1], bushing - (0, 0.02, 0), middle])
    bar = tube(path, STABILIZER_RADIUS, sides=6)
    eye = placed(drum(0.017, -0.007, 0.007, bevel=0.002, sections=10), end, points["stab_rod_top"] - end)
    rubber = placed(ring(STABILIZER_RADIUS, 0.024, -0.018, 0.018, sections=10), bushing, ACROSS)
    return [Piece("", joined(bar, eye), palette.LINK), Piece("stabilizer_bushing", rubber, palette.RUBBER, held=True)]


def stabilizer_clamp(points: Points) -> trimesh.Trimesh:
    """Build the steel strap over the rubber block."""
    phi = np.linspace(-0.25 * np.pi, 1.25 * np.pi, 6)
    arc = np.column_stack([0.026 * np.cos(phi), np.zeros(6), 0.026 * np.sin(phi)])
    foot: Vector = np.array([[0.046, 0, -0.022]])
    path = np.vstack([foot, arc, foot * (-1, 1, 1)])
    return placed(tube(path, 0.014, sides=4, width=0.002, up=ACROSS), points["stab_body"])
