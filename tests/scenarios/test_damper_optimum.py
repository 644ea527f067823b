"""Searches for the best dampers on functions whose minima are known, and on the shipped cars."""

import numpy as np
import pytest

from scenarios.damper_choice.optimum import iterate, joint_optimum, optimum
from scenarios.lumped.damper_choice import damper_choice_parameters
from scenarios.lumped.road_holding import half_car_model, printed_load_fluctuation, quarter_car_model
from vehicle.errors import ConfigurationError, SimulationError

P = damper_choice_parameters()
GRID = np.arange(1000.0, 8001.0, 250.0)


def coupled(front, rear):
    """Each end has its own parabola, whose bottom moves with the other damper: fixed point by two linear equations."""
    return np.array(
        [1.0 + ((front - 3000.0 - 0.3 * rear) / 1000.0) ** 2, 2.0 + ((rear - 2000.0 - 0.2 * front) / 1000.0) ** 2]
    )


FIXED_POINT = np.linalg.solve([[1.0, -0.3], [-0.2, 1.0]], [3000.0, 2000.0])


def test_continuous_optimum_of_a_parabola():
    minimum = optimum(lambda c: (c - 3210.0) ** 2)
    assert minimum.damping == pytest.approx(3210.0, abs=1.0)  # xatol


def test_the_lower_of_two_minima_is_found():
    minimum = optimum(lambda c: min((c - 2000.0) ** 2 + 10.0, (c - 9000.0) ** 2))
    assert minimum.damping == pytest.approx(9000.0, abs=1.0)


def test_iteration_reaches_the_fixed_point():
    steps = iterate(coupled, rear=2500.0)
    assert (steps[-1].front, steps[-1].rear) == pytest.approx(FIXED_POINT, abs=5.0)  # "no change" means 5 N s/m
    assert [step.changed for step in steps[:3]] == ["front", "rear", "front"]


def test_iteration_on_a_grid_stops_when_nothing_changes():
    steps = iterate(coupled, rear=2500.0, grid=GRID)
    last, before = steps[-1], steps[-3]
    assert (last.front, last.rear) == (before.front, steps[-2].rear)


def test_iteration_that_runs_in_circles_is_reported():
    def chase(front, rear):
        # the front wants to equal the rear, the rear wants to avoid the front
        return np.array([(front - rear) ** 2, -abs(rear - front)])

    with pytest.raises(SimulationError, match="front/rear iteration: still changing after 6 steps"):
        iterate(chase, rear=2000.0, grid=np.array([2000.0, 3000.0]), limit=6)


def test_start_must_be_positive():
    with pytest.raises(ConfigurationError, match=r"iteration: rear: found -1\.0 N s/m, must be greater than 0\.0"):
        iterate(coupled, rear=-1.0)


def test_joint_optimum_is_the_least_sum():
    front, rear, values = joint_optimum(coupled, start=(3000.0, 3000.0))
    assert (front, rear) == pytest.approx(FIXED_POINT, abs=5.0)  # here both wishes can be met at once
    assert values.sum() == pytest.approx(3.0, abs=1e-4)


def test_shipped_cars_show_the_printed_optima():
    quarter = optimum(
        lambda c: float(printed_load_fluctuation(quarter_car_model(P.quarter_car, c), P.highway, P.bands)[0])
    )
    assert 3500.0 <= quarter.damping <= 4000.0  # printed

    def measure(front, rear):
        return printed_load_fluctuation(half_car_model(P.half_car, front, rear), P.highway, P.bands)

    steps = iterate(measure, rear=3250.0, grid=GRID)
    assert [(step.changed, step.front, step.rear) for step in steps] == [
        ("front", 4250.0, 3250.0),
        ("rear", 4250.0, 3000.0),
        ("front", 4250.0, 3000.0),
    ]  # printed, figures 11 to 13
    rates = np.array([measure(4000.0, 4000.0)[0], steps[0].fluctuation[0], steps[1].fluctuation[0]])
    np.testing.assert_allclose(rates, [2.25, 2.125, 2.1], atol=0.05)  # read from a figure
    assert np.all(np.diff(rates) < 0.0)
