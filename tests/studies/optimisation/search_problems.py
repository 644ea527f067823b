"""Optimisation problems without a car for tests."""

import numpy as np

from vehicle.model.parameters.ranges import Range
from vehicle.studies.optimisation.problem import Criterion, Problem
from vehicle.studies.optimisation.search import TriedCars


def box(*bounds, goals=2, limits=(), base=None):
    """Return a problem with parameters p0, p1, ... between bounds, objectives g0, g1, ... to minimise, and limits."""
    ranges = tuple(Range(path=f"p{i}", low=low, high=high) for i, (low, high) in enumerate(bounds))
    return Problem(
        ranges=ranges,
        paths=tuple((bounds.path,) for bounds in ranges),
        units=("-",) * len(ranges),
        base=tuple(base or (np.nan,) * len(ranges)),
        criteria=(*(Criterion(number=f"g{i}", input_name="road", unit="-") for i in range(goals)), *limits),
        inputs=("road",),
    )


def tried(points, *values, reasons=None):
    """Return cars with the values of all criteria, column by column."""
    return TriedCars(
        points=points,
        values=np.column_stack(values),
        reasons=tuple(reasons) if reasons is not None else ("",) * len(points),
    )
