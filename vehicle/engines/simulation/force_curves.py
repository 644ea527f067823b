"""Nonlinear laws over displacement and air springs: operating points, and the stiffness there."""

from collections.abc import Sequence

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.simulation.element_records import AirSprings, Layout, Table, Tables
from vehicle.model.laws.curve import Curve
from vehicle.model.parameters.air_spring import air_stiffness


def tables_through(points: Sequence[tuple[Table, tuple[int, int, int]]]) -> Tables:
    """Return the laws through points, with operating points at zero displacement.

    Args:
        points: displacements and forces (2, n) of each law, and its kind, element and axis as in `Tables`.
    """
    width = max((table.shape[1] - 1 for table, _ in points), default=1)
    indices = np.array([where for _, where in points], dtype=np.int64).reshape(-1, 3)
    kinds, elements, axes = (np.ascontiguousarray(column) for column in indices.T)
    edges, (slopes, offsets) = np.full((len(points), width), np.inf), np.zeros((2, len(points), width))
    for index, (table, _) in enumerate(points):
        curve = Curve.through(*table)
        edges[index, : len(curve.knots)] = curve.knots
        slopes[index, : len(curve.slopes)], offsets[index, : len(curve.slopes)] = curve.slopes, curve.offsets
    return Tables(kinds, elements, axes, np.zeros(len(points)), edges, slopes.copy(), offsets.copy())


def curve_of(tables: Tables, index: int) -> Curve:
    """Return a law over displacement as a `Curve`."""
    knots = tables.edges[index][np.isfinite(tables.edges[index])]
    count = len(knots) + 1
    return Curve(knots=knots, slopes=tables.slopes[index, :count], offsets=tables.offsets[index, :count])


def standing_on(layout: Layout, air: AirSprings, preload: Vector | None) -> Layout:
    """Return the layout with the operating points of the curves, and tangents and air stiffness at these points.

    Args:
        layout: layout of the elements.
        air: air springs among the bushings.
        preload: static forces, see `Weights`; None before the static trim, which starts with the steepest segments.
    """
    t, stiffness, springs = layout.tables, layout.bushings.stiffness.copy(), layout.springs.stiffness.copy()
    at = t.at.copy()
    for index, (law_type, element, axis) in enumerate(zip(t.kinds, t.elements, t.axes, strict=True)):
        if law_type >= 2:
            continue
        row = layout.bushings.rows[element, axis] if law_type == 0 else layout.springs.rows[element]
        curve = curve_of(t, index)
        if preload is not None:
            # F(at) = -p: the law gives -F on the moving part.
            at[index] = curve.position(-preload[row])
        # A force outside the range of the curve is an error after the trim; until then the trim needs a stiffness.
        carried = preload is not None and np.isclose(curve.force(at[index]), -preload[row], rtol=1e-6, atol=1e-6)
        tangent = float(curve.slope(at[index]) if carried else np.max(curve.slopes))
        if law_type == 0:
            stiffness[element, axis] = tangent
        else:
            springs[element] = tangent
    branch = layout.bushings.branch_stiffness.copy()
    for element, bellows, numbers in zip(*air, strict=True):
        # The levelled air carries the static force, upwards on the carrier.
        load = 0.0 if preload is None else -float(preload[layout.bushings.rows[element, 2]])
        gas, branch[element, 2] = air_stiffness(load, *numbers)
        stiffness[element, 2] = bellows + gas
    return layout._replace(
        tables=t._replace(at=at),
        bushings=layout.bushings._replace(stiffness=stiffness, branch_stiffness=branch),
        springs=layout.springs._replace(stiffness=springs),
    )
