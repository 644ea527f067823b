"""Fronts against the definition, and against shapes with closed-form knee point, hypervolume and distance."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.studies.optimisation.front import MARGIN, distance, ends, front, hypervolume, knee, thinned


@pytest.mark.parametrize("goals", [1, 2, 3])
def test_a_front_consists_of_the_non_dominated_rows(goals):
    costs = np.random.default_rng(goals).integers(0, 12, size=(300, goals)).astype(float)
    dominated = [any(np.all(other <= row) and np.any(other < row) for other in costs) for row in costs]
    best = {tuple(row) for row, out in zip(costs, dominated, strict=True) if not out}
    rows = front(costs)
    assert {tuple(costs[row]) for row in rows} == best and len(rows) == len(best)  # equal rows appear once
    assert np.all(np.diff(costs[rows, 0]) >= 0.0)


def test_ends_and_knee_of_a_corner():
    costs = np.array([[0.0, 100.0], [1.0, 40.0], [2.0, 10.0], [6.0, 4.0], [10.0, 0.0]])
    assert ends(costs) == [0, 4] and knee(costs) == 2
    # The knee does not depend on the units of the columns.
    assert knee(costs * [1e3, 1e-6]) == 2
    # Ties in one column are resolved by the other column.
    assert ends(np.array([[0.0, 2.0], [0.0, 1.0], [3.0, 0.0]])) == [1, 2]


def test_hypervolume_of_a_straight_front():
    # The square up to the reference point at 1 + m less the triangle below f0 + f1 = 1.
    line = np.linspace(0.0, 1.0, 2001)
    exact = (1.0 + MARGIN) ** 2 - 0.5
    costs = np.column_stack([5.0 + 20.0 * line, -3.0 + 0.1 * (1.0 - line)])
    # half a step of the staircase
    validated(
        "Sweeps, tuning and optimisation", "hypervolume of a straight Pareto front", hypervolume(costs, costs), exact,
        abs=5e-4, source="closed form: square less triangle",
    )  # fmt: skip
    assert hypervolume(costs[[0, -1]], costs) == pytest.approx(2 * MARGIN * (1.0 + MARGIN) - MARGIN**2)


def test_distance_of_a_shifted_front():
    line = np.linspace(0.0, 1.0, 101)
    costs = np.column_stack([line, 1.0 - line])
    assert distance(costs, costs) == 0.0
    # 0.1 along the normal, and the extents of both together are 1 + 0.1 / sqrt(2).
    shift = 0.1 / np.sqrt(2.0)
    # larger at the ends
    validated(
        "Sweeps, tuning and optimisation", "distance of a shifted Pareto front", distance(costs, costs + shift),
        0.1 / (1.0 + shift), rel=0.05, source="closed form: shift along the normal over the extent",
    )  # fmt: skip


def test_a_thinned_front_is_even():
    # Most of the cars crowd at one end; the selected rows do not.
    line = np.sort(np.random.default_rng(1).random(4000)) ** 3
    costs = np.column_stack([1e3 * line, 1.0 - line])
    rows = thinned(costs, [0, 3999], 17)
    gaps = np.diff(costs[rows, 0]) / 1e3
    assert len(rows) == 17 and rows[0] == 0 and rows[-1] == 3999
    # Selecting the farthest row halves the gaps, so the largest gap is about twice the smallest at most.
    assert gaps.max() < 2.1 * gaps.min()
    assert np.array_equal(thinned(costs[:5], [2], 17), np.arange(5))
