"""A search over shares of a box, for tests that need no car."""

from __future__ import annotations

import numpy as np

from vehicle.model.parameters.ranges import Range
from vehicle.studies.optimisation.problem import Problem, Wish
from vehicle.studies.optimisation.search import Tried


def box(*bounds, goals=2, limits=(), base=None):
    """Parameters p0, p1, ... between bounds; goals g0, g1, ... to minimise; limits as wishes."""
    ranges = tuple(Range(path=f"p{i}", low=low, high=high) for i, (low, high) in enumerate(bounds))
    return Problem(
        ranges=ranges,
        places=tuple((one.path,) for one in ranges),
        units=("-",) * len(ranges),
        base=tuple(base or (np.nan,) * len(ranges)),
        wishes=(*(Wish(number=f"g{i}", place="road", unit="-") for i in range(goals)), *limits),
        inputs=("road",),
    )


def tried(points, *values, reasons=None):
    """Cars with the numbers of all wishes, column by column."""
    return Tried(
        points=points,
        values=np.column_stack(values),
        reasons=tuple(reasons) if reasons is not None else ("",) * len(points),
    )
