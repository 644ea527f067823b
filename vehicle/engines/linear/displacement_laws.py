"""Nonlinear laws over displacement about the static equilibrium: tables, bump stops, tyres, rubber friction.

K of the linear car contains the tangent k of each law. A law F(x) of the displacement x = d + tau d' from the static
equilibrium, with d = row u - z over the plate of a tyre, adds the force -g(x) along its row,

    g(x) = F(x) - F(0) - k x = sum over j of a_j max(0, sign(p_j) (x - p_j)),

with the slope changes a_j at the breakpoints p_j. In the segment in which the car is at rest, g is exactly zero. A tyre
that cannot pull has the force max(0, F_0 - K d - D d'): tau = D/K, one breakpoint F_0/K, and the slope change -K. The
operating points of the tables are those of `vehicle.engines.simulation.force_curves`.

Rubber friction (`vehicle.model.laws.amplitude`) has the force t of Jenkins elements with the stiffness k_i and the
stroke x_i = l_i/k_i, and K contains their sum: g = t - (sum of k_i) d. Element i has its slider at q_i, and so the
force k_i (d - q_i): d moves q_i when it is farther than x_i from it,

    q_i = max(d - x_i, min(d + x_i, q_i)),    g = -sum of k_i q_i.

On first loading from rest, q_i = 0, this is a law with the breakpoints +-x_i and the slope changes -+k_i.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.engines.simulation.force_curves import curve_of
from vehicle.engines.simulation.force_differences import DIFFERENCE_STEP
from vehicle.engines.simulation.row_layout import wheels_of
from vehicle.engines.simulation.rows import Rows
from vehicle.names import AXES

BUSHING, SPRING, STOP, DECOUPLER = range(4)
"""Types of elements, see `vehicle.engines.simulation.element_records.Tables`."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class DisplacementLaw:
    """Nonlinear law over a displacement of the car.

    Attributes:
        name: name of the element.
        element: type of the element, index among the elements of this type, and axis.
        row: displacement d of the element over the velocity coordinates; (n,).
        plate: index of the input under a tyre; -1 for other elements.
        breakpoints: p_j [m], the sign of 0.0 and -0.0 is that of its side; (k,).
        changes: a_j [N/m]; (k,).
        rate_time: tau [s].
        one_sided: True for a tyre that cannot pull.
        friction: True for rubber friction; breakpoints and slope changes are those of first loading from rest, first
            -x_i with k_i, then x_i with -k_i, x_i ascending.
    """

    name: str
    element: tuple[int, int, int]
    row: Vector
    plate: int
    breakpoints: Vector
    changes: Vector
    rate_time: float = 0.0
    one_sided: bool = False
    friction: bool = False

    @property
    def elements(self) -> Vector:
        """Return stiffness k_i [N/m] and stroke x_i [m] of the Jenkins elements of rubber friction; (2, e)."""
        return np.stack([self.changes, -self.breakpoints])[:, : len(self.breakpoints) // 2 * self.friction]

    @property
    def low(self) -> float:
        """Lower end of the segment in which the car is at rest [m]."""
        return float(np.max(self.breakpoints[np.signbit(self.breakpoints)], initial=-np.inf))

    @property
    def high(self) -> float:
        """Upper end of the segment in which the car is at rest [m]."""
        return float(np.min(self.breakpoints[~np.signbit(self.breakpoints)], initial=np.inf))

    def force(self, position: npt.ArrayLike) -> Vector:
        """Return g(x) [N]; x in m."""
        # sign(p) (x - p); copysign distinguishes 0.0 and -0.0.
        distance = np.copysign(1.0, self.breakpoints) * (np.asarray(position)[..., None] - self.breakpoints)
        return np.asarray(np.maximum(distance, 0.0) @ self.changes)

    @property
    def slopes(self) -> tuple[float, float]:
        """Smallest and largest slope of g [N/m], at most and at least 0."""
        extremes = [0.0]
        for side in (True, False):
            on_side = np.signbit(self.breakpoints) == side
            outwards = np.argsort(np.abs(self.breakpoints[on_side]), kind="stable")
            # Outwards from rest the slope grows by a_j at each breakpoint; below rest the terms fall with x.
            extremes += np.cumsum((-1.0 if side else 1.0) * self.changes[on_side][outwards]).tolist()
        return min(extremes), max(extremes)

    @property
    def stiffness_increase(self) -> float:
        """Slope of the steepest segment less the slope at rest [N/m], the softer of two at a breakpoint."""
        # At rest on a breakpoint, the car is in two segments; the step uses the tangent between both.
        at_rest = self.changes * (self.breakpoints == 0.0)
        below = np.signbit(self.breakpoints)
        return self.slopes[1] - min(0.0, float(np.sum(at_rest[~below])), -float(np.sum(at_rest[below])))


def displacement_laws(rows: Rows, jacobian: Vector, preload: Vector) -> tuple[DisplacementLaw, ...]:
    """Return the nonlinear laws over displacement of a car: its tables, tyres that cannot pull, then rubber friction.

    Args:
        rows: rows of the car at rest.
        jacobian: Jacobian of the rows; (rows, n).
        preload: static forces of the rows.
    """
    laws, e, tables = [], rows.layout, rows.layout.tables
    for index, (element_type, element, axis, position) in enumerate(
        zip(tables.kinds.tolist(), tables.elements.tolist(), tables.axes.tolist(), tables.at.tolist(), strict=True)
    ):
        if element_type == BUSHING:
            row, name = jacobian[e.bushings.rows[element, axis]], f"{rows.names[element]} along {AXES[axis]}"
        elif element_type == SPRING:
            row, name = jacobian[e.springs.rows[element]], f"spring {element + 1}"
        elif element_type == DECOUPLER:
            dof = int(e.fluids.dofs[element])
            row, name = np.eye(rows.model.nv)[dof], str(rows.model.joint(rows.model.dof_jntid[dof]).name)
            name = name.replace("/", " of ", 1)
        else:
            row, name = np.eye(rows.model.nv)[e.dampers.dofs[element]], f"stop of damper {element + 1}"
            position = float(rows.model.qpos0[e.dampers.places[element]])
        curve = curve_of(tables, index)
        changes = np.diff(curve.slopes)
        # A point on the line through its neighbours is not a breakpoint.
        corners = np.abs(changes) > 1e-9 * np.max(curve.slopes)
        plate = list(e.tyres).index(element) if element_type == BUSHING and axis == 2 and element in e.tyres else -1
        breakpoints, changes = _about_rest(curve.knots[corners] - position, changes[corners])
        laws.append(
            DisplacementLaw(
                name=name,
                element=(element_type, element, axis),
                row=row,
                plate=plate,
                breakpoints=breakpoints,
                changes=changes,
            )
        )
    bushings = e.bushings
    for element in bushings.one_sided.tolist():
        stiffness, row = float(bushings.stiffness[element, 2]), int(bushings.rows[element, 2])
        plate = list(e.tyres).index(element)
        laws.append(
            DisplacementLaw(
                name=f"tyre {wheels_of(rows.model)[plate]}",
                element=(BUSHING, element, 2),
                row=jacobian[row],
                plate=plate,
                breakpoints=np.array([float(preload[row]) / stiffness]),
                changes=np.array([-stiffness]),
                rate_time=float(bushings.damping[element, 2]) / stiffness,
                one_sided=True,
            )
        )
    return (*laws, *_rubber_laws(rows, jacobian))


def _rubber_laws(rows: Rows, jacobian: Vector) -> list[DisplacementLaw]:
    """Return the rubber friction of the bushings, a law for each axis; arguments: see `displacement_laws`."""
    rubber, laws = rows.layout.rubber, []
    for element, axis in dict.fromkeys(zip(rubber.elements.tolist(), rubber.axes.tolist(), strict=True)):
        chosen = (rubber.elements == element) & (rubber.axes == axis)
        stiffness, stroke = rubber.stiffness[chosen], rubber.limit[chosen] / rubber.stiffness[chosen]
        laws.append(
            DisplacementLaw(
                name=f"{rows.names[element]} along {AXES[axis]}",
                element=(BUSHING, element, axis),
                row=jacobian[rows.layout.bushings.rows[element, axis]],
                plate=-1,
                breakpoints=np.concatenate([-stroke, stroke]),
                changes=np.concatenate([stiffness, -stiffness]),
                friction=True,
            )
        )
    return laws


def _about_rest(breakpoints: Vector, changes: Vector) -> tuple[Vector, Vector]:
    """Return breakpoints and slope changes of g; a breakpoint at rest is one on either side."""
    near = np.abs(breakpoints) < DIFFERENCE_STEP
    # For slopes s1, s2 that meet at b, the central difference over +-h is k = (s1 (h + b) + s2 (h - b))/2h. Above rest
    # s2 exceeds it by (s2 - s1) (b + h)/2h, below s1 falls short by (s2 - s1) (h - b)/2h.
    share = 0.5 * (breakpoints[near] / DIFFERENCE_STEP + 1.0)
    return (
        np.concatenate([breakpoints[~near], np.zeros(len(share)), np.full(len(share), -0.0)]),
        np.concatenate([changes[~near], changes[near] * share, changes[near] * (1.0 - share)]),
    )


def law_rows(laws: Sequence[DisplacementLaw], size: int) -> Vector:
    """Return the displacements of laws over the velocity coordinates; (laws, n)."""
    return np.array([law.row for law in laws]).reshape(len(laws), size)


def forces_at_start(laws: Sequence[DisplacementLaw], columns: Sequence[int], plates: Vector) -> Vector:
    """Return the forces g of laws of a car at rest over plates that are displaced and move; (laws,).

    Args:
        laws: the laws.
        columns: indices of the driven plates.
        plates: displacements [m] and velocities [m/s] of the driven plates; (2, m).
    """
    relative = dict(zip(columns, -plates.T, strict=True))
    motions = [relative.get(law.plate, np.zeros(2)) for law in laws]
    return np.array([law.force(d + law.rate_time * rate) for law, (d, rate) in zip(laws, motions, strict=True)])
