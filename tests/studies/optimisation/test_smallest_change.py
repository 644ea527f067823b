"""Smallest change that meets limits: closed forms, brute force, and limits that exclude each other."""

import numpy as np
import pytest

from vehicle.studies.optimisation.smallest_change import MARGIN, smallest_change

LOW, HIGH = np.full(5, np.log(0.5)), np.full(5, np.log(1.8))


def test_a_plane_has_the_foot_of_its_perpendicular():
    """e = b - a.u: the least cost is at u = b a / c^2 / sum (a / c)^2, cost b / |a / c|."""
    slopes, offset, costs = np.array([0.5, 0.2, -0.3]), 0.1, np.array([1.0, 2.0, 0.5])
    found = smallest_change(lambda u: (offset - u @ slopes)[:, None], LOW[:3], HIGH[:3], costs)
    expected = (offset + MARGIN) * (slopes / costs**2) / np.sum((slopes / costs) ** 2)
    assert found.feasible and found.active == (0,) and found.at_bounds == ()
    np.testing.assert_allclose(found.position, expected, rtol=1e-3, atol=1e-5)
    assert found.cost == pytest.approx((offset + MARGIN) / np.sqrt(np.sum((slopes / costs) ** 2)), rel=1e-3)


def test_a_car_that_meets_its_limits_stays():
    found = smallest_change(lambda u: u - 0.1, LOW[:3], HIGH[:3], np.ones(3))
    assert found.feasible and found.cost == 0.0 and found.runs == 1 and not found.position.any()


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("count", [3, 5])
def test_brute_force(count, seed):
    """Four curved excesses against 20 000 random cars: at most 2 % dearer than the cheapest of them that is allowed."""
    generator = np.random.default_rng(seed)
    slopes, curves = generator.normal(size=(4, count)), 0.4 * generator.normal(size=(4, count, count))
    offsets, costs = generator.uniform(0.02, 0.12, size=4), generator.uniform(0.5, 2.0, size=count)

    def excesses(u):
        return offsets + 0.5 * u @ slopes.T + 0.5 * np.einsum("ni,jik,nk->nj", u, curves, u)

    low, high = LOW[:count], HIGH[:count]
    found = smallest_change(excesses, low, high, costs)
    cars = low + (high - low) * generator.random((20_000, count))
    values = excesses(cars)
    allowed = np.all(values <= 0.0, axis=1)
    assert found.feasible == bool(np.any(allowed)) or found.feasible
    assert np.all((found.position >= low) & (found.position <= high))
    if found.feasible:
        assert np.all(excesses(found.position[None]) <= 0.0)
        cheapest = np.min(np.sqrt(np.sum((costs * cars[allowed]) ** 2, axis=1)), initial=np.inf)
        assert found.cost <= 1.02 * cheapest
    else:
        assert found.excess.max() <= 1.02 * np.min(np.max(values, axis=1))


@pytest.mark.parametrize(
    ("excesses", "active", "at_bounds"),
    [
        # One falls where the other rises: at best both are 0.1.
        (lambda u: np.stack([0.1 + u[:, 0], 0.1 - u[:, 0]], axis=1), {0, 1}, set()),
        # Out of reach by itself: it falls to the bound.
        (lambda u: np.stack([1.0 + u[:, 0], u[:, 1] - 2.0], axis=1), {0}, {0}),
        # No parameter has an effect on it.
        (lambda u: np.stack([0.3 + 0.0 * u[:, 0], u[:, 1] - 2.0], axis=1), {0}, set()),
        # Three of which two exclude each other.
        (lambda u: np.stack([0.2 + u[:, 0], 0.1 - u[:, 0], u[:, 1] - 0.1], axis=1), {0, 1}, set()),
        # A valley that never reaches its limit.
        (lambda u: np.stack([0.05 + u[:, 0] ** 2 + u[:, 1] ** 2, u[:, 0] - 3.0], axis=1), {0}, set()),
    ],
)
def test_unreachable_limits_are_named(excesses, active, at_bounds):
    found = smallest_change(excesses, LOW[:2], HIGH[:2], np.ones(2))
    assert not found.feasible and set(found.active) == active and at_bounds <= set(found.at_bounds)


def test_failed_runs_are_avoided():
    """Cars beyond a third of the range fail; the way to the limit leads past them."""

    def excesses(u):
        values = (0.1 - 0.5 * u[:, 0] - 0.4 * u[:, 1])[:, None]
        return np.where(u[:, :1] > 0.4, np.nan, values)

    found = smallest_change(excesses, LOW[:2], HIGH[:2], np.ones(2))
    assert found.feasible and found.cost == pytest.approx((0.1 + MARGIN) / np.hypot(0.5, 0.4), rel=2e-3)
