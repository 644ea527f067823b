"""Search against closed-form fronts: a quarter car, a front with a limit; and reproducibility with a seed."""

import importlib

import numpy as np
import pytest
import scipy

from tests.studies.optimisation.search_problems import box, tried
from tests.validation import validated
from vehicle.errors import DataError, MissingPartError, SimulationError
from vehicle.studies.optimisation.front import distance, hypervolume
from vehicle.studies.optimisation.outcome import outcome
from vehicle.studies.optimisation.problem import Criterion
from vehicle.studies.optimisation.search import joined, search

SPRUNG, UNSPRUNG, SPRING, TYRE = 300.0, 70.0, 34e3, 300e3
"""Quarter car of the damper optimisation study, IOSRJEN 2014 [kg], [N/m]."""


def mean_squares(damping):
    """Return mean squares of body acceleration and tyre force of the quarter car on a road of white vertical velocity.

    They follow from a Lyapunov equation: states x2 - x1, v2, x1 - w, v1; r' P r of A P + P A' + B B' = 0.
    """
    rise, fall = (np.array([-SPRING, -damping, 0.0, damping]) / SPRUNG, np.array([SPRING, damping, -TYRE, -damping]))
    system = np.array([[0.0, 1.0, 0.0, -1.0], rise, [0.0, 0.0, 0.0, 1.0], fall / UNSPRUNG])
    road = np.array([[0.0], [0.0], [-1.0], [0.0]])
    spread = scipy.linalg.solve_continuous_lyapunov(system, -road @ road.T)
    return rise @ spread @ rise, TYRE**2 * spread[2, 2]


def closed_forms(damping):
    """Return (a c + b / c, optimum c) for the mean squares of body acceleration and tyre force with damping c.

    Source: Smith and Wang, Performance benefits in passive vehicle suspensions employing inerters, Vehicle System
    Dynamics 42 (2004), without inerter.
    """
    mass = SPRUNG + UNSPRUNG
    acceleration = (TYRE / (2 * SPRUNG**2), mass * SPRING**2 / (2 * SPRUNG**2))
    stiff = mass**3 * SPRING**2 / SPRUNG**2 - 2 * mass * UNSPRUNG * SPRING * TYRE / SPRUNG + UNSPRUNG * TYRE**2
    force = (TYRE * mass**2 / (2 * SPRUNG**2), 0.5 * stiff)
    return [(a * damping + b / damping, np.sqrt(b / a)) for a, b in (acceleration, force)]


def test_the_front_of_a_quarter_car_lies_between_its_two_best_dampers():
    problem = box((300.0, 9000.0))
    (square, comfortable), (force, holding) = closed_forms(2000.0)
    assert mean_squares(2000.0) == pytest.approx((square, force), rel=1e-10)

    def attempt(points):
        return tried(points, *np.array([mean_squares(c) for c in points[:, 0]]).T)

    result = outcome(
        problem, attempt(np.array([[2000.0]])), search(problem, attempt, population=24, generations=20, seed=3)
    )
    dampers = result.tried.points[result.front, 0]
    assert (comfortable, holding) == pytest.approx((1194.0, 3372.2), abs=0.1)
    # Both curves are flat there: 1 % of damping is 5e-5 of a square, and five digits are kept.
    assert dampers.min() == pytest.approx(comfortable, rel=5e-3) and dampers.max() == pytest.approx(holding, rel=5e-3)
    # Every damper in between is a compromise, and none outside.
    inside = (result.tried.points[:, 0] > comfortable * 1.005) & (result.tried.points[:, 0] < holding * 0.995)
    assert result.front_size >= len(np.unique(result.tried.points[inside]))
    assert result.named["best g0@road"] == result.front[0] and result.named["best g1@road"] == result.front[-1]


def bowl(points):
    """Return g0 = x and g1 = (1 - x)^2 + sum of (y - 0.3)^2 over the other parameters y: the front is a parabola."""
    x, others = points[:, 0], points[:, 1:]
    return tried(points, x, (1.0 - x) ** 2 + np.sum((others - 0.3) ** 2, axis=1), x)


def test_two_seeds_find_the_same_front_beyond_a_limit():
    floor = Criterion(number="x", input_name="road", sense=-1.0, limit=0.25)
    problem = box(*[(0.0, 1.0)] * 4, limits=(floor,), base=(2.0,) * 4)
    exact = np.linspace(0.25, 1.0, 400)
    truth = np.column_stack([exact, (1.0 - exact) ** 2])
    whole = hypervolume(truth, truth)
    fronts = []
    for seed in (1, 2):
        result = outcome(
            problem, bowl(np.zeros((1, 4))), search(problem, bowl, population=40, generations=40, seed=seed)
        )
        fronts.append(result.costs)
        assert result.costs[0, 0] == pytest.approx(0.25, abs=0.01) and np.all(result.costs[:, 0] >= 0.25)
        validated(
            "Sweeps, tuning and optimisation", f"hypervolume that the search reaches, run {len(fronts)}",
            hypervolume(result.costs, truth), whole, rel=0.02, source="closed form: Pareto front of two bowls",
        )  # fmt: skip
        assert result.reached[0.25] < result.reached[0.75] <= 1.0
    assert distance(*fronts) < 0.01


def test_a_seed_determines_the_search_and_stored_generations_are_reused():
    problem, kept = box((-1.0, 1.0), (0.0, 1.0), base=(0.5, 0.5)), []

    def attempt(points):
        kept.append(points)
        return bowl(points)

    def run(generations, stored=(), seed=5):
        kept.clear()
        return joined(search(problem, attempt, population=12, generations=generations, seed=seed, stored=stored)).points

    whole = run(6)
    assert np.array_equal(whole[0], [0.5, 0.5])  # the car as it is
    assert np.array_equal(run(6), whole) and not np.array_equal(run(6, seed=6), whole)
    first = search(problem, attempt, population=12, generations=4, seed=5)
    assert np.array_equal(run(6, first), whole) and len(kept) == 2
    with pytest.raises(DataError, match=r"^generation 1 .*--force"):
        run(6, first, seed=6)


def test_cars_that_fail_are_avoided():
    problem = box((0.0, 1.0), (0.0, 1.0))

    def attempt(points):
        cars = bowl(points)
        return tried(points, *cars.values[:, :2].T, reasons=["unstable" if x < 0.5 else "" for x in points[:, 0]])

    result = outcome(problem, bowl(np.zeros((1, 2))), search(problem, attempt, population=16, generations=10, seed=1))
    late = np.array([bool(reason) for reason in result.tried.reasons]).reshape(10, 16)
    assert late[0].sum() > 4 and late[-3:].mean() < 0.25
    assert result.costs[:, 0].min() == pytest.approx(0.5, abs=0.02)


def test_message_without_a_front():
    limit = Criterion(number="x", input_name="road", limit=-1.0, unit="m")
    problem, points = box((0.0, 1.0), goals=1, limits=(limit,)), np.array([[0.5], [0.2]])
    cars = tried(points, points[:, 0], points[:, 0])
    with pytest.raises(SimulationError, match=r"^none of 2 cars .*x@road<=-1 .*0\.2 m"):
        outcome(problem, cars, [cars])
    with pytest.raises(SimulationError, match=r"all 2 cars .*: broken$"):
        outcome(problem, cars, [tried(points, points[:, 0], points[:, 0], reasons=["broken", "too"])])


def test_a_missing_library_names_its_extra(monkeypatch):
    def missing(name):
        raise ImportError(name)

    monkeypatch.setattr(importlib, "import_module", missing)
    with pytest.raises(MissingPartError, match=r"'optimisation' \(pip install pymoo\)"):
        search(box((0.0, 1.0)), bowl, population=8, generations=1, seed=1)
