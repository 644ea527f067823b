"""Car as points and lines, with the displacement of each point over the velocity coordinates, to show modes."""

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from vehicle.arrays import Indices
from vehicle.drawing.rendering.body_outline import drawn_body
from vehicle.engines.simulation.car_model import CarModel
from vehicle.model.parameters.composition import Composition, PlacedPart, PlacedWheel
from vehicle.signals.analysis.samples import Complex, Vector

GROUPS = ("body", "mass", "link", "spring", "wheel", "ground")
"""Groups of lines."""

SPOKES, TREAD, PLATE = 24, 0.18, 0.22
"""Corners of a drawn wheel; its width and half the side of a plate [m]."""

CORNERS = ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))
"""Corners of a square [half sides]."""

BOX_MASS = 40.0
"""Minimum mass [kg] of a part, other than a wheel, that is also drawn as the box of its mass and inertia."""

COIL_TURNS, COIL_RADIUS, COIL_POINTS = 5, 0.06, 61
"""Turns [-], radius [m] and points [-] of a drawn spring."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarWireframe:
    """Points of a car, lines between them, and their motion.

    Attributes:
        points: points in the design position [m], (n, 3).
        lines: pairs of points, (m, 2).
        groups: group of each line, as an index of `GROUPS`; (m,).
        motion: displacement of the points over the velocity coordinates, (n, 3, coordinates).
    """

    points: Vector
    lines: Indices
    groups: Indices
    motion: Vector

    def displacement(self, shape: Complex) -> Complex:
        """Return the displacement of the points [m], (n, 3), in a shape over the velocity coordinates."""
        return np.asarray(self.motion @ shape)


def unit_factor(displacement: Complex) -> complex:
    """Return the complex factor that makes the largest displacement of a shape 1, with a real largest component.

    Args:
        displacement: displacement of the points, (n, 3), not all zero.
    """
    size = np.linalg.norm(displacement, axis=1)
    farthest = displacement[int(np.argmax(size))]
    largest = farthest[int(np.argmax(np.abs(farthest)))]
    return complex(np.conj(largest) / np.abs(largest) / size.max())


def car_wireframe(car: CarModel) -> CarWireframe:
    """Draw a car: its body (`drawn_body`), links, springs and wheels, boxes for heavy parts, plates and stands.

    Returns:
        Points and lines of the car, and J of u_point = J u, which is zero for plates and stands.
    """
    pen, body, composition = _Pen(car), drawn_body(car), car.vehicle.composition
    for point in body.points:
        pen.point(point, "body")
    pen.join([(int(first), int(second)) for first, second in body.lines], "body")
    wheels = {wheel.part for wheel in composition.wheels}
    for part in composition.parts:
        if part.shape != "none" and part.name not in wheels and part.seat is None:
            _part(pen, composition, part)
    for spring in composition.springs:
        low, high = (np.asarray(at) for at in spring.at)
        pen.polyline(_coil(low, high), "spring", spring.parts)
    for wheel in composition.wheels:
        _wheel(pen, wheel)
    floor = min(wheel.patch[2] for wheel in composition.wheels)
    for connection in composition.connections:
        if {connection.moving, connection.carrier} == {"body", "world"}:
            _stand(pen, np.asarray(connection.at), floor)
    return pen.finished()


class _Pen:
    """Collector of points, their parts, and lines."""

    def __init__(self, car: CarModel) -> None:
        self.model, self.data = car.model, mujoco.MjData(car.model)
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
        self.bodies = {self.model.body(number).name: number for number in range(self.model.nbody)}
        modal = [j for j in range(self.model.njnt) if self.model.joint(j).name.startswith("mode_")]
        self.modal = [int(self.model.jnt_dofadr[joint]) for joint in modal]
        self.nodes = np.asarray(car.superelement.positions)
        self.shapes = np.asarray(car.superelement.shapes)[: len(modal)]  # (modes, nodes, 3)
        self.points: list[Vector] = []
        self.motion: list[Vector] = []
        self.lines: list[tuple[int, int]] = []
        self.groups: list[int] = []

    def point(self, at: Sequence[float] | Vector, part: str) -> int:
        """Add a point [m] on a part and return its index."""
        self.points.append(np.asarray(at, dtype=float))
        self.motion.append(self._motion(self.points[-1], part))
        return len(self.points) - 1

    def _motion(self, at: Vector, part: str) -> Vector:
        """Return the displacement of a point of a part over the velocity coordinates, (3, coordinates)."""
        rows = np.zeros((3, self.model.nv))
        if part not in self.bodies:
            return rows
        mujoco.mj_jac(self.model, self.data, rows, None, at, self.bodies[part])
        if part == "body" and self.modal:
            distance = np.linalg.norm(self.nodes - at, axis=1)
            # Shape of the nearest node; body axes are those of the car in the design position.
            rows[:, self.modal] = self.shapes[:, int(np.argmin(distance))].T
        return rows

    def join(self, pairs: Sequence[tuple[int, int]], group: str) -> None:
        """Add lines between points."""
        self.lines += pairs
        self.groups += [GROUPS.index(group)] * len(pairs)

    def polyline(self, points: Vector, group: str, parts: tuple[str, str]) -> None:
        """Add a line over points (n, 3) whose ends move with two parts."""
        first = len(self.points)
        for share, at in zip(np.linspace(0.0, 1.0, len(points)), points, strict=True):
            low, high = (self._motion(end, part) for end, part in zip((points[0], points[-1]), parts, strict=True))
            self.points.append(at)
            self.motion.append((1.0 - share) * low + share * high)
        self.join([(index, index + 1) for index in range(first, len(self.points) - 1)], group)

    def finished(self) -> CarWireframe:
        """Return the collected wireframe."""
        return CarWireframe(
            points=np.array(self.points),
            lines=np.array(self.lines, dtype=np.intp),
            groups=np.array(self.groups, dtype=np.intp),
            motion=np.array(self.motion),
        )


def _part(pen: _Pen, composition: Composition, part: PlacedPart) -> None:
    """Draw a part: a line between two points, a star about the CoG for more points, a box for a heavy part."""
    group = "mass" if part.numbers.mass >= BOX_MASS else "link"
    points = [part.points[name] for name in part.points]
    points += [
        connection.at for connection in composition.connections if part.name in (connection.moving, connection.carrier)
    ]
    points += [joint.at for child in composition.parts if child.parent == part.name for joint in child.joints[:1]]
    anchors = [pen.point(at, part.name) for at in dict.fromkeys(tuple(float(x) for x in at) for at in points)]
    if len(anchors) == 2:
        pen.join([(anchors[0], anchors[1])], group)
    elif len(anchors) > 2:
        middle = pen.point(part.cog, part.name)
        pen.join([(middle, anchor) for anchor in anchors], group)
    if group == "mass":
        _box(pen, part, group)


def _box(pen: _Pen, part: PlacedPart, group: str) -> None:
    """Draw the box with the mass and moments of inertia of a part: Ixx = m (b^2 + c^2) / 12 and so on."""
    body = pen.bodies[part.name]
    mass, inertia = float(pen.model.body_mass[body]), np.asarray(pen.model.body_inertia[body])
    # From Ixx = m (b^2 + c^2)/12 and so on: a^2 = 6 (Iyy + Izz - Ixx)/m.
    sides = np.sqrt(np.maximum(6.0 / mass * (inertia.sum() - 2.0 * inertia), 0.0))
    frame = pen.data.ximat[body].reshape(3, 3)
    signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    corners = [pen.point(pen.data.xipos[body] + frame @ (0.5 * sign * sides), part.name) for sign in signs]
    # Corners that differ in one sign share an edge.
    edges = [(i, j) for i in range(8) for j in range(i) if np.sum(signs[i] != signs[j]) == 1]
    pen.join([(corners[i], corners[j]) for i, j in edges], group)


def _wheel(pen: _Pen, wheel: PlacedWheel) -> None:
    """Draw a wheel: two circles and their tread about the y axis, four spokes, and the plate below."""
    centre = np.asarray(wheel.center)
    radius = float(centre[2] - wheel.patch[2])
    angle = 2.0 * np.pi * np.arange(SPOKES) / SPOKES
    circle = np.column_stack([np.cos(angle), np.zeros(SPOKES), np.sin(angle)]) * radius
    rings = [
        [pen.point(centre + at + np.array([0.0, side * TREAD / 2, 0.0]), wheel.part) for at in circle]
        for side in (1.0, -1.0)
    ]
    for ring in rings:
        pen.join(list(zip(ring, [*ring[1:], ring[0]], strict=True)), "wheel")
    hub = pen.point(centre, wheel.part)
    pen.join([(rings[0][i], rings[1][i]) for i in range(0, SPOKES, 3)], "wheel")
    outer = rings[0 if wheel.side > 0 else 1]
    pen.join([(hub, outer[i]) for i in range(0, SPOKES, SPOKES // 4)], "wheel")
    plate = [pen.point(np.add(wheel.patch, (PLATE * x, PLATE * y, 0.0)), "world") for x, y in CORNERS]
    pen.join(list(zip(plate, [*plate[1:], plate[0]], strict=True)), "ground")


def _stand(pen: _Pen, top: Vector, floor: float) -> None:
    """Draw the support of a body without wheels: four legs from a point at rest to the floor."""
    feet = [(top[0] + PLATE * x, top[1] + PLATE * y, floor) for x, y in CORNERS]
    base, head = [pen.point(foot, "world") for foot in feet], pen.point(top, "world")
    pen.join(list(zip(base, [*base[1:], base[0]], strict=True)), "ground")
    pen.join([(foot, head) for foot in base], "ground")


def _coil(low: Vector, high: Vector) -> Vector:
    """Return a helix between two points [m], (n, 3), with straight ends."""
    axis = high - low
    lying = abs(axis[0]) > 0.99 * np.linalg.norm(axis)  # along the car, for example a push rod
    across = np.cross(axis, (0.0, 1.0, 0.0) if lying else (1.0, 0.0, 0.0))
    across /= np.linalg.norm(across)
    third = np.cross(axis, across) / np.linalg.norm(axis)
    share = np.linspace(0.0, 1.0, COIL_POINTS)
    turn = 2.0 * np.pi * COIL_TURNS * share
    # Straight ends: the radius falls to zero over the last 8 % of the length.
    radius = COIL_RADIUS * np.clip(np.minimum(share, 1.0 - share) / 0.08, 0.0, 1.0)
    round_ = np.outer(np.cos(turn), across) + np.outer(np.sin(turn), third)
    return np.asarray(low + np.outer(share, axis) + radius[:, None] * round_)
