"""The car once more, from energies: rigid parts with six coordinates each, modal coordinates, joints as constraints.

With every part free, all that counts are functions r(x) of the coordinates that vanish in the design position: the
deformations of elements (stiffness K, static force p), the joints c (reaction lambda), and heights of masses. The
potential V = sum K r^2 / 2 - p r + m g z gives the linear motion about the equilibrium (Lagrange, first kind),

    M x'' + C x' + (sum r' K r'^T - p r'' + m g z'' + lambda c'') x = 0,   c'^T x = 0,

with all derivatives by complex steps and central differences. One thing of the model is no potential: the two forces of
a bushing act at the points of its two parts and not on one line, so that the carrier misses the moment r x p that the
potential has. It is taken off here; everything else is V. Nothing here knows of MuJoCo, constraint rows or their
Jacobians: parameters, element constants and the superelement are all that is shared with the simulation.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg

from vehicle.model.assembly.connections import element_law
from vehicle.model.flexbody.rigid_body import rigid_body
from vehicle.model.parameters.paths import value_of

WHEELS = ("fr", "fl")
COMPLEX_STEP, REAL_STEP = 1e-30, 1e-5
X, Y, Z = np.eye(3)
SLIDING = 1e-5
"""Share of their horizontal stiffness that the ground contacts have while the car is set down, as documented."""
FIXED = {
    "knuckle": ("tyre", "brake_disc", "caliper", "damper_bottom", "main_spring_lower"),
    "damper_top": ("suspension_mount",),
}
"""Parts fixed to others on each side."""


def cross_matrix(v):
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def turned(angle):
    """exp([angle]x) up to fourth order, which is exact for two derivatives at zero; holds for complex angles."""
    square, k = angle @ angle, cross_matrix(angle)
    return np.eye(3) + (1.0 - square / 6.0) * k + (0.5 - square / 24.0) * (k @ k)


@dataclass
class Term:
    """A vector function of some coordinates, with its stiffness; `settling` is the stiffness while the car settles."""

    columns: list[int]
    value: Any
    stiffness: Any = ()
    settling: Any = ()
    law: Any = None
    turns: Any = ()

    def derivative(self, at=0.0):
        """Return r' at a point, (rows, columns)."""
        size = len(self.columns)
        columns = [np.imag(self.value(at + 1j * COMPLEX_STEP * way)) / COMPLEX_STEP for way in np.eye(size)]
        return np.array(columns).T

    def curvature(self, weights):
        """Return the sum of the second derivatives of the rows, (columns, columns)."""
        steps = REAL_STEP * np.eye(len(self.columns))
        return np.array([weights @ (self.derivative(s) - self.derivative(-s)) for s in steps]) / (2.0 * REAL_STEP)


class EnergyCar:
    """Modes of a car with gravity by the equation above."""

    def __init__(self, car):
        self.vehicle, self.body = car.vehicle, car.model.superelement
        self.points = {name: np.array(point) for name, point in self.vehicle.points.items()}
        self.modes = len(self.body.frequencies)
        self.parts: list[Any] = []
        self.centres: dict[str, Any] = {}
        self.root: dict[str, Any] = {}
        self.masses: list[Any] = []
        body = rigid_body(self.vehicle.body)
        self._part("body", body.cog, body.mass, body.inertia)
        for name in ("engine", "torque_arm"):
            self._listed(name)
        for wheel in WHEELS:
            for part in ("a_arm", "knuckle", "damper_top", "steering_rod", "stabilizer_half", "stabilizer_rod"):
                self._listed(f"{part}_{wheel}")
                for fixed in FIXED.get(part, ()):
                    self._listed(f"{fixed}_{wheel}", f"{part}_{wheel}")
            self._listed(f"main_spring_upper_{wheel}", "body")
        self.rigid = 6 * len(self.parts)
        self.size = self.rigid + self.modes
        self.elements = self._elements()
        self.heights = [self._height(part, centre, mass) for part, mass, centre, _ in self.masses]
        self.preload = self._preload()
        weighted = [(term, np.ones(1)) for term in self.heights]
        weighted += [(term, -p) for term, p in zip(self.elements, self.preload, strict=True)]
        self.geometric = sum(self._full(term, term.curvature(weights)) for term, weights in weighted)

    def _listed(self, name, to=None):
        part = next(candidate for candidate in self.vehicle.composition.parts if candidate.name == name)
        self._part(name, np.array(part.cog), part.numbers.mass, np.diag(part.numbers.inertia), to)

    def _part(self, name, centre, mass, inertia, to=None):
        if to is None:
            self.parts.append(name)
            self.centres[name] = centre
        self.root[name] = to or name
        self.masses.append((to or name, mass, centre, inertia))

    def _columns(self, *names):
        """Coordinates of parts; those of the body are followed by the modal ones."""
        coordinates: list[Any] = []
        for part in (self.root[name] for name in names if name in self.root):
            first = 6 * self.parts.index(part)
            coordinates += range(first, first + 6)
            coordinates += range(self.rigid, self.rigid + self.modes) if part == "body" else ()
        return coordinates

    def _pose(self, name, x):
        """Rotation of a part and where it takes a point, from its own coordinates; the ground stays."""
        if name not in self.root:
            return np.eye(3), lambda point: self.points.get(point, point)
        part = self.root[name]
        rotation, centre = turned(x[3:6]), self.centres[part]

        def place(point):
            arm = self.points.get(point, 0.0) - centre if isinstance(point, str) else point - centre
            if part == "body" and isinstance(point, str):
                arm = arm + self.body.shapes[:, self.body.node_index(point), :].T @ x[6 : 6 + self.modes]
            return centre + x[:3] + rotation @ arm

        return rotation, place

    def _pair(self, first, second, value, *constants):
        """Term of two parts; `value` takes the rotation and the places of each."""
        cut = len(self._columns(first))
        both = lambda x: np.array(value(*self._pose(first, x[:cut]), *self._pose(second, x[cut:])))  # noqa: E731
        return Term(self._columns(first, second), both, *constants)

    def _height(self, part, centre, mass):
        return Term(self._columns(part), lambda x: mass * self.vehicle.gravity * self._pose(part, x)[1](centre)[2:])

    def _joints(self, *, stuck):
        """Constraints: balls, universal joints of the rods, slides of the dampers, the bar."""
        joints: list[Any] = []

        def ball(first, second, point):
            joints.append(self._pair(first, second, lambda r, p, s, o: p(point) - o(point)))

        def square(first, second, pairs):
            joints.append(self._pair(first, second, lambda r, p, s, o: [(r @ a) @ (s @ b) for a, b in pairs]))

        def line(first, second, point, across):
            joints.append(self._pair(first, second, lambda r, p, s, o: (s @ across).T @ (p(point) - o(point))))

        for w in WHEELS:
            knuckle, top, strut = f"knuckle_{w}", f"damper_top_{w}", self._strut(w)
            ball(knuckle, f"a_arm_{w}", f"lower_ball_{w}")
            a, b = scipy.linalg.null_space(strut[None]).T
            square(top, knuckle, ((a, b), (a, strut), (b, strut)))
            line(top, knuckle, f"strut_top_{w}", np.array((a, b, strut) if stuck else (a, b)).T)
            rods = (
                (f"steering_rod_{w}", knuckle, f"tie_outer_{w}", f"tie_inner_{w}"),
                (f"stabilizer_rod_{w}", f"stabilizer_half_{w}", f"stab_end_{w}", f"stab_rod_top_{w}"),
            )
            for rod, parent, near, far in rods:
                ball(rod, parent, near)
                axis = self.points[far] - self.points[near]
                first = np.cross(axis, X)
                square(parent, rod, ((first, np.cross(axis, first)),))
            ball(f"stabilizer_rod_{w}", f"damper_bottom_{w}", f"stab_rod_top_{w}")
        square("stabilizer_half_fr", "stabilizer_half_fl", ((Y, X), (Y, Z)))
        line("stabilizer_half_fr", "stabilizer_half_fl", self.points["stab_body_fr"] * (X + Z), np.array((X, Z)).T)
        return joints

    def _slide(self, wheel):
        """First derivative of the extension of a damper, (1, size)."""
        at, axis = f"strut_top_{wheel}", self._strut(wheel)
        extended = lambda r, p, s, o: [(p(at) - o(at)) @ (s @ axis)]  # noqa: E731
        return self._full(self._pair(f"damper_top_{wheel}", f"knuckle_{wheel}", extended))

    def _strut(self, wheel):
        axis = self.points[f"strut_top_{wheel}"] - self.points[f"damper_bottom_{wheel}"]
        return axis / np.linalg.norm(axis)

    def _elements(self):
        """Return the deformations of all elements."""
        terms = []

        def twist(r, p, s, o):
            between = s.T @ r
            return [0.5 * (between[j, i] - between[i, j]) for i, j in ((1, 2), (2, 0), (0, 1))]

        for c in self.vehicle.composition.connections:
            law = element_law(c, self.vehicle.body, self.body)
            if law is None:
                continue
            share = [SLIDING, SLIDING, 1.0] if c.name.startswith(("tyre", "rear_support")) else 1.0
            bent = lambda r, p, s, o, at=c.point: s.T @ (p(at) - o(at))  # noqa: E731
            turns = 6 * self.parts.index(self.root[c.carrier]) + np.arange(3, 6) if c.carrier in self.root else ()
            k = np.asarray(law.stiffness)
            terms.append(self._pair(c.moving, c.carrier, bent, k, k * share, law, turns))
            k = np.full(3, law.rotational_stiffness)
            terms.append(self._pair(c.moving, c.carrier, twist, k, k))
        for w in WHEELS:

            def longer(r, p, s, o, up=f"strut_top_{w}", low=f"spring_lower_{w}"):
                line = p(up) - o(low)
                return [np.sqrt(line @ line) - np.linalg.norm(self.points[up] - self.points[low])]

            k = np.array([value_of(self.vehicle, "main_spring.stiffness")])
            terms.append(self._pair("body", f"main_spring_lower_{w}", longer, k, k))
        k = np.array([value_of(self.vehicle, "stabilizer.torsional_stiffness")])
        torsion = lambda r, p, s, o: [(s.T @ r)[0, 2]]  # noqa: E731
        terms.append(self._pair("stabilizer_half_fr", "stabilizer_half_fl", torsion, k, k))
        k = (2.0 * np.pi * self.body.frequencies * self.vehicle.body.frequency_scale) ** 2
        return [*terms, Term(list(range(self.rigid, self.size)), lambda x: x, k, k)]

    def _full(self, term, matrix=None):
        """First derivatives of a term, or a matrix of its coordinates, in those of the car."""
        if matrix is None:
            derivatives = np.zeros((len(term.value(np.zeros(len(term.columns)))), self.size))
            derivatives[:, term.columns] = term.derivative()
            return derivatives
        extended = np.zeros((self.size, self.size))
        extended[np.ix_(term.columns, term.columns)] = matrix
        return extended

    def _preload(self):
        """Static forces: what each element takes when the stress-free car is set down on sliding ground contacts."""
        fixed = np.vstack([self._full(term) for term in self._joints(stuck=False)])
        rows = [self._full(term) for term in self.elements]
        stiffness = sum(j.T @ (term.settling[:, None] * j) for j, term in zip(rows, self.elements, strict=True))
        load = -sum(self._full(term)[0] for term in self.heights)
        free = scipy.linalg.null_space(fixed)
        settled = free @ np.linalg.solve(free.T @ stiffness @ free, free.T @ load)
        return [-term.settling * (j @ settled) for j, term in zip(rows, self.elements, strict=True)]

    def _mass(self):
        matrix = np.zeros((self.size, self.size))
        for part, mass, centre, inertia in self.masses:
            columns = self._columns(part)[:6]
            way = np.hstack([np.eye(3), -cross_matrix(centre - self.centres[part])])
            matrix[np.ix_(columns, columns)] += mass * way.T @ way + scipy.linalg.block_diag(np.zeros((3, 3)), inertia)
        matrix[self.rigid :, self.rigid :] += np.eye(self.modes)
        return matrix

    def poles(self, *, stuck):
        """Poles with positive imaginary part by their size, and the largest force [N] out of balance at rest."""
        joints = self._joints(stuck=stuck)
        fixed = np.vstack([self._full(term) for term in joints])
        rows = [self._full(term) for term in self.elements]
        gradient = sum(self._full(term)[0] for term in self.heights)
        gradient -= sum(j.T @ p for j, p in zip(rows, self.preload, strict=True))
        reaction = np.linalg.lstsq(fixed.T, -gradient, rcond=None)[0]
        cuts = np.split(reaction, np.cumsum([len(self._full(term)) for term in joints])[:-1])
        weighted = zip(joints, cuts, strict=True)
        stiffness = self.geometric + sum(self._full(term, term.curvature(reaction)) for term, reaction in weighted)
        damping, branches, springs, times = np.zeros_like(stiffness), [], [], []
        for term, j, p in zip(self.elements, rows, self.preload, strict=True):
            stiffness += j.T @ (term.stiffness[:, None] * j)
            if len(term.turns):
                stiffness[term.turns] += cross_matrix(p) @ j
            if term.law is not None:
                damping += j.T @ (np.asarray(term.law.damping)[:, None] * j)
                there = np.asarray(term.law.branch_stiffness) > 0.0
                branches += list(j[there])
                springs += list(np.asarray(term.law.branch_stiffness)[there])
                times += list(np.asarray(term.law.branch_time)[there])
        ratio = 2.0 * self.body.damping_ratio * np.sqrt(self.elements[-1].stiffness)
        damping[self.rigid :, self.rigid :] += np.diag(ratio)
        if not stuck:
            for wheel in WHEELS:
                slide = self._slide(wheel)
                damping += self.vehicle.damper.viscous * slide.T @ slide
        free = scipy.linalg.null_space(fixed)
        mass, damping, stiffness = (free.T @ matrix @ free for matrix in (self._mass(), damping, stiffness))
        branches = np.array(branches) @ free
        n, b = len(mass), len(branches)
        state = np.zeros((2 * n + b, 2 * n + b))
        state[:n, n : 2 * n] = np.eye(n)
        state[n : 2 * n] = -np.linalg.solve(mass, np.hstack([stiffness, damping, branches.T]))
        state[2 * n :, n : 2 * n] = np.array(springs)[:, None] * branches
        state[2 * n :, 2 * n :] = -np.diag(1.0 / np.array(times))
        eigenvalues = np.linalg.eigvals(state)
        eigenvalues = eigenvalues[eigenvalues.imag > 1e-6]
        return eigenvalues[np.argsort(np.abs(eigenvalues))], float(np.max(np.abs(gradient + fixed.T @ reaction)))
