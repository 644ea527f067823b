"""Wishes, bounds and tolerances as they are written, and what they mean."""

import math
from concurrent.futures import Executor, Future
from pathlib import Path

import numpy as np
import pytest

from tests.studies.optimisation.search_problems import box
from vehicle import Car
from vehicle.errors import ConfigurationError
from vehicle.studies.optimisation.problem import Criterion, Tolerance, parsed_criteria, parsed_tolerance
from vehicle.studies.optimisation.trials import Spread, Trials, bands, on_executor, samples_for
from vehicle.studies.optimisation.variables import toleranced
from vehicle.studies.sweeps.case import SignalFile
from vehicle.studies.sweeps.case_result import Block, Result
from vehicle.studies.sweeps.measure import ComfortMeasure

ROADS = ("smooth", "rough")
ROAD, MEASURE = SignalFile(path=Path("road.csv"), wheel="fl"), ComfortMeasure()


def test_wishes_over_inputs():
    values = np.array([[1.0, 3.0], [5.0, 2.0]])  # (cars, inputs)
    wanted = {"smooth": [1.0, 5.0], "rough": [3.0, 2.0], "mean": [2.0, 3.5], "worst": [3.0, 5.0]}
    for name, numbers in wanted.items():
        (criterion,) = parsed_criteria([f"unweighted@{name}"], [], [], ROADS)
        assert criterion.of(values, ROADS).tolist() == numbers and criterion.label == f"unweighted@{name}"
    (large,) = parsed_criteria([], ["lowest_load@worst"], [], ROADS)
    assert large.of(values, ROADS).tolist() == [1.0, 2.0]
    _, lower, upper = parsed_criteria(["x"], [], ["lowest_load >= 0.5", "travel<=-2"], ["smooth"])
    assert lower.excess(np.array([0.4, 0.5, 0.75])) == pytest.approx([0.2, 0.0, -0.5])
    assert upper.excess(np.array([-1.0])) == pytest.approx([0.5]) and upper.expression == "travel<=-2"
    assert Criterion(number="a", limit=0.0).excess(np.array([0.3])) == pytest.approx([0.3])
    # Without an input a limit applies to all inputs.
    assert parsed_criteria(["x@mean"], [], ["travel<=1"], ROADS)[1].label == "travel@worst"


@pytest.mark.parametrize(
    ("minimise", "limits", "said"),
    [
        ([], [], "--minimise unweighted"),
        (["unweighted"], [], "--minimise unweighted: .*unweighted@smooth, .*@rough, .*@mean, .*@worst"),
        (["unweighted@wet"], [], "--minimise unweighted@wet: .*smooth, rough, mean, worst"),
        (["unweighted@mean", "unweighted@mean"], [], "unweighted@mean: "),
        (["x@mean"], ["travel<0.1"], "--limit travel<0.1: .*NUMBER<=VALUE"),
        (["x@mean"], ["travel<=nan"], "--limit travel<=nan: .*NUMBER<=VALUE"),
    ],
)
def test_bad_wishes(minimise, limits, said):
    with pytest.raises(ConfigurationError, match=said):
        parsed_criteria(minimise, [], limits, ROADS)


def test_tolerances():
    assert parsed_tolerance("a=15%").value_at(200.0, -0.5) == pytest.approx(185.0)
    assert parsed_tolerance("a=15").value_at(200.0, -0.5) == pytest.approx(192.5)
    with pytest.raises(ConfigurationError, match=r"^--tolerance a=0: .*PATH=NUMBER"):
        parsed_tolerance("a=0")
    sedan = Car.load("sedan").vehicle
    ((tolerance, values),) = toleranced(sedan, [parsed_tolerance("strut_top.z=0.002")])
    assert tolerance.value_at(values["front.hardpoints.strut_top.z"], 1.0) == pytest.approx(1.172)
    with pytest.raises(ConfigurationError, match=r"strut_top.z=1%: .* strut_top.z=0.002"):
        toleranced(sedan, [parsed_tolerance("strut_top.z=1%")])


def test_points_are_rounded_within_their_bounds():
    problem = box((0.0, 1.0), (123456.7, 123457.2), (800.0, 4000.0), (0.03, 0.0300007))
    points = problem.point(np.array([[0.123456789, 0.5, 1.0 / 3.0, 0.0], [1.0] * 4]))
    assert points.tolist() == [[0.1235, 123456.95, 1866.7, 0.03], [1.0, 123457.2, 4000.0, 0.0300007]]


def test_bands_are_even():
    positions = bands(2, 64, seed=3)
    assert np.array_equal(positions, bands(2, 64, seed=3)) and not np.array_equal(positions, bands(2, 64, seed=4))
    # A low-discrepancy sequence has equally many positions in each of eight equal slices of a band.
    for column in positions.T:
        assert np.array_equal(np.histogram(column, bins=8, range=(-1.0, 1.0))[0], [8] * 8)
    with pytest.raises(ConfigurationError, match=r"^--samples 12: must be a power of two"):
        bands(2, 12, seed=1)


@pytest.mark.parametrize(("quantile", "expected"), [(math.nan, 1.0 / 3.0), (1.0, 1.0), (0.5, 0.25)])
def test_a_car_counts_with_its_tolerances(quantile, expected):
    """Evaluate x^2 with x uniform within 1 of 0: mean 1/3, maximum 1, median 1/4."""
    tolerance = Tolerance(path="p0", width=1.0, relative=False)
    spread = Spread(tolerances=((tolerance, {"p0": 7.0}),), bands=bands(1, 256, seed=1), quantile=quantile)

    def evaluate(cases, measure):
        assert {case.source for case in cases} == {ROAD}
        values = [float(case.overrides[-1].removeprefix("p0=")) for case in cases]
        return [Result(values={"g0": value**2}) for value in values]

    problem = box((-5.0, 5.0), goals=1)
    trials = Trials(problem=problem, inputs=[ROAD], measure=MEASURE, evaluate=evaluate, spread=spread)
    values, reasons = trials(np.array([[0.0], [2.0]]))
    assert values[0, 0] == pytest.approx(expected, abs=0.01) and reasons == ["", ""]
    # The tolerance of an unmodified parameter is centred at its value, here 7.
    assert trials(np.array([[np.nan]]))[0][0, 0] > 36.0


@pytest.mark.parametrize(("quantile", "samples"), [(0.9, 16), (0.85, 8), (0.95, 32), (0.5, 8)])
def test_share_of_new_cars_beyond_a_quantile(quantile, samples):
    """Use the sum of one or three uniform parameters, and 300 samples of cars within tolerances."""
    rng = np.random.default_rng(2)
    for count in (1, 3):
        reference = np.sort(rng.uniform(-1.0, 1.0, (50_000, count)).sum(axis=1))
        spread = [Spread(tolerances=(), bands=bands(count, samples, seed), quantile=quantile) for seed in range(300)]
        stated = [float(sample.statistic_of(sample.bands.sum(axis=1)[None])[0]) for sample in spread]
        below = np.searchsorted(reference, stated) / reference.size
        # The share of one sample scatters by 0.05 at most, so its mean by 0.003.
        assert np.mean(below) == pytest.approx(quantile, abs=0.012)
        assert samples_for(quantile) <= samples


class ImmediateExecutor(Executor):
    """Executor that runs a task at submission; results are in the order of the cases of the task."""

    def submit(self, function, /, *arguments, **_):
        future: Future[object] = Future()
        cases, keys = arguments[:2]
        results = [Result(values={"g0": float(case.overrides[0].removeprefix("p0="))}) for case in cases]
        future.set_result(Block.of(cases, keys, results))
        return future


def test_results_of_an_executor_are_in_the_order_of_the_cars():
    evaluate = on_executor(ImmediateExecutor(), MEASURE)
    trials = Trials(problem=box((0.0, 1.0), goals=1), inputs=[ROAD], measure=MEASURE, evaluate=evaluate)
    points = np.linspace(1.0, 0.0, 101)[:, None]
    for _ in range(2):
        assert np.array_equal(trials(points)[0], points)


def test_a_failed_run_fails_its_car():
    def evaluate(cases, measure):
        return [Result(reason="unstable") if i == 1 else Result(values={"g0": 1.0}) for i, _ in enumerate(cases)]

    trials = Trials(
        problem=box((0.0, 1.0), goals=1), inputs=[ROAD], measure=MEASURE, evaluate=evaluate, vehicle=Path("car.toml")
    )
    values, reasons = trials(np.array([[0.1], [0.2], [0.3]]))
    assert reasons == ["", "unstable", ""] and np.isnan(values[1, 0]) and values[2, 0] == 1.0
