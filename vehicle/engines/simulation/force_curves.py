"""Laws over displacement that are curves, and where on them a car stands."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vehicle.engines.simulation.element_records import Layout, Table, Tables, Vector
from vehicle.model.laws.curve import Curve


def tables_through(points: Sequence[tuple[Table, tuple[int, int, int]]]) -> Tables:
    """The laws through points, without load.

    Args:
        points: displacements and forces (2, n) of each, and its kind, element and axis.
    """
    width = max((one.shape[1] - 1 for one, _ in points), default=1)
    places = np.array([where for _, where in points], dtype=np.int64).reshape(-1, 3)
    kinds, elements, axes = (np.ascontiguousarray(column) for column in places.T)
    edges, (slopes, offsets) = np.full((len(points), width), np.inf), np.zeros((2, len(points), width))
    for index, (one, _) in enumerate(points):
        curve = Curve.through(*one)
        edges[index, : len(curve.knots)] = curve.knots
        slopes[index, : len(curve.slopes)], offsets[index, : len(curve.slopes)] = curve.slopes, curve.offsets
    return Tables(kinds, elements, axes, np.zeros(len(points)), edges, slopes.copy(), offsets.copy())


def curve_of(tables: Tables, index: int) -> Curve:
    """A law over displacement as a curve."""
    knots = tables.edges[index][np.isfinite(tables.edges[index])]
    count = len(knots) + 1
    return Curve(knots=knots, slopes=tables.slopes[index, :count], offsets=tables.offsets[index, :count])


def standing_on(layout: Layout, preload: Vector | None) -> Layout:
    """The layout with its curves at the points where they carry static forces, and their tangents as stiffness.

    Args:
        layout: as read.
        preload: as of `Weights`; None before the trim, which begins with the steepest pieces.
    """
    t, stiffness, springs = layout.tables, layout.bushings.stiffness.copy(), layout.springs.stiffness.copy()
    at = t.at.copy()
    for index, (kind, element, axis) in enumerate(zip(t.kinds, t.elements, t.axes, strict=True)):
        if kind == 2:
            continue
        row = layout.bushings.rows[element, axis] if kind == 0 else layout.springs.rows[element]
        curve = curve_of(t, index)
        if preload is not None:
            at[index] = curve.position(-preload[row])
        # A force that the curve does not have is refused after the trim, which needs a stiffness until then.
        carried = preload is not None and np.isclose(curve.force(at[index]), -preload[row], rtol=1e-6, atol=1e-6)
        tangent = float(curve.slope(at[index]) if carried else np.max(curve.slopes))
        if kind == 0:
            stiffness[element, axis] = tangent
        else:
            springs[element] = tangent
    return layout._replace(
        tables=t._replace(at=at),
        bushings=layout.bushings._replace(stiffness=stiffness),
        springs=layout.springs._replace(stiffness=springs),
    )
