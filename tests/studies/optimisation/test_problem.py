"""Wishes, bounds and tolerances as they are written, and what they mean."""

from __future__ import annotations

import math
from concurrent.futures import Executor, Future
from pathlib import Path

import numpy as np
import pytest

from tests.studies.optimisation.wishes import box
from vehicle.errors import ConfigurationError
from vehicle.studies.optimisation.problem import Tolerance, Wish, parsed_range, parsed_tolerance, parsed_wishes
from vehicle.studies.optimisation.trials import Spread, Trials, bands, on_executor, samples_for
from vehicle.studies.sweeps.case import SignalFile
from vehicle.studies.sweeps.case_result import Result
from vehicle.studies.sweeps.measure import ComfortMeasure

ROADS = ("smooth", "rough")
ROAD, MEASURE = SignalFile(path=Path("road.csv"), wheel="fl"), ComfortMeasure()


def test_wishes_over_inputs():
    values = np.array([[1.0, 3.0], [5.0, 2.0]])  # (cars, inputs)
    wanted = {"smooth": [1.0, 5.0], "rough": [3.0, 2.0], "mean": [2.0, 3.5], "worst": [3.0, 5.0]}
    for place, numbers in wanted.items():
        (wish,) = parsed_wishes([f"comfort@{place}"], [], [], ROADS)
        assert wish.of(values, ROADS).tolist() == numbers and wish.label == f"comfort@{place}"
    (large,) = parsed_wishes([], ["lowest_load@worst"], [], ROADS)
    assert large.of(values, ROADS).tolist() == [1.0, 2.0]
    _, least, most = parsed_wishes(["x"], [], ["lowest_load >= 0.5", "travel<=-2"], ["smooth"])
    assert least.excess(np.array([0.4, 0.5, 0.75])) == pytest.approx([0.2, 0.0, -0.5])
    assert most.excess(np.array([-1.0])) == pytest.approx([0.5]) and most.words == "travel<=-2"
    assert Wish(number="a", limit=0.0).excess(np.array([0.3])) == pytest.approx([0.3])
    # Without an input a limit holds on each.
    assert parsed_wishes(["x@mean"], [], ["travel<=1"], ROADS)[1].label == "travel@worst"


@pytest.mark.parametrize(
    ("minimise", "limits", "said"),
    [
        ([], [], "nothing to optimise; give --minimise comfort, or another number, once or more"),
        (
            ["comfort"],
            [],
            "--minimise comfort: there are 2 inputs; say which: comfort@smooth, comfort@rough, comfort@mean, "
            "comfort@worst",
        ),
        (["comfort@wet"], [], "--minimise comfort@wet: no input 'wet'; behind the @ stands smooth, rough, mean, worst"),
        (["comfort@mean", "comfort@mean"], [], "comfort@mean: asked for twice; give it once"),
        (["x@mean"], ["travel<0.1"], "--limit travel<0.1: needed is NUMBER<=VALUE or NUMBER>=VALUE, as travel<=0.06"),
        (["x@mean"], ["travel<=nan"], "--limit travel<=nan: needed is NUMBER<=VALUE or NUMBER>=VALUE, as travel<=0.06"),
    ],
)
def test_bad_wishes(minimise, limits, said):
    with pytest.raises(ConfigurationError) as caught:
        parsed_wishes(minimise, [], limits, ROADS)
    assert str(caught.value) == said


@pytest.mark.parametrize("text", ["damper.viscous", "=1:2", "damper.viscous=1", "damper.viscous=a:2", "d=1:inf"])
def test_bad_bounds(text):
    with pytest.raises(ConfigurationError) as caught:
        parsed_range(text)
    assert str(caught.value) == f"--vary {text}: needed is PATH=LOW:HIGH, as in front.damper.viscous=800:4000"


def test_bounds_and_tolerances():
    assert (parsed_range("a.b=-1e3:2").low, parsed_range("a.b=-1e3:2").path) == (-1000.0, "a.b")
    with pytest.raises(ConfigurationError, match=r"^--vary a=2:2: the lower bound must be below the upper one$"):
        parsed_range("a=2:2")
    assert parsed_tolerance("a=15%").around(200.0, -0.5) == pytest.approx(185.0)
    assert parsed_tolerance("a=15").around(200.0, -0.5) == pytest.approx(192.5)
    with pytest.raises(ConfigurationError, match=r"^--tolerance a=0: needed is PATH=NUMBER in the unit"):
        parsed_tolerance("a=0")


def test_points_are_rounded_within_their_bounds():
    problem = box((0.0, 1.0), (123456.7, 123457.2), (800.0, 4000.0), (0.03, 0.0300007))
    points = problem.point(np.array([[0.123456789, 0.5, 1.0 / 3.0, 0.0], [1.0] * 4]))
    assert points.tolist() == [[0.1235, 123456.95, 1866.7, 0.03], [1.0, 123457.2, 4000.0, 0.0300007]]


def test_bands_are_even():
    places = bands(2, 64, seed=3)
    assert np.array_equal(places, bands(2, 64, seed=3)) and not np.array_equal(places, bands(2, 64, seed=4))
    # Each of eight equal slices of a band holds as many of them: what makes it a low-discrepancy sequence.
    for column in places.T:
        assert np.array_equal(np.histogram(column, bins=8, range=(-1.0, 1.0))[0], [8] * 8)
    with pytest.raises(ConfigurationError, match=r"^--samples 12: must be a power of two"):
        bands(2, 12, seed=1)


@pytest.mark.parametrize(("quantile", "expected"), [(math.nan, 1.0 / 3.0), (1.0, 1.0), (0.5, 0.25)])
def test_a_car_counts_with_its_tolerances(quantile, expected):
    """The number x^2, made anywhere within 1 of 0: mean 1/3, largest 1, median 1/4."""
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
    # A car that keeps the parameter as it is has the tolerance about that value.
    assert trials(np.array([[np.nan]]))[0][0, 0] > 36.0


@pytest.mark.parametrize(("quantile", "samples"), [(0.9, 16), (0.85, 8), (0.95, 32), (0.5, 8)])
def test_new_cars_are_beyond_a_quantile_as_often_as_it_says(quantile, samples):
    """The sum of one or three evenly spread parameters, 300 samples of made cars."""
    rng = np.random.default_rng(2)
    for count in (1, 3):
        reference = np.sort(rng.uniform(-1.0, 1.0, (50_000, count)).sum(axis=1))
        spread = [Spread(tolerances=(), bands=bands(count, samples, seed), quantile=quantile) for seed in range(300)]
        stated = [float(one.worth(one.bands.sum(axis=1)[None])[0]) for one in spread]
        below = np.searchsorted(reference, stated) / reference.size
        # The share of one sample scatters by 0.05 at most, so its mean by 0.003.
        assert np.mean(below) == pytest.approx(quantile, abs=0.012)
        assert samples_for(quantile) <= samples


def test_samples_for_a_quantile():
    assert [samples_for(one) for one in (0.5, 0.75, 0.8, 0.9, 0.95, 0.99)] == [2, 4, 8, 16, 32, 128]


class Here(Executor):
    """Carries out at once what it is given; the results of a task stand in its own order."""

    def submit(self, function, /, *arguments, **_):
        future: Future[object] = Future()
        cases, _, _ = arguments
        future.set_result([Result(values={"g0": float(case.overrides[0].removeprefix("p0="))}) for case in cases])
        return future


def test_an_executor_answers_in_the_order_of_the_cars():
    trials = Trials(
        problem=box((0.0, 1.0), goals=1), inputs=[ROAD], measure=MEASURE, evaluate=on_executor(Here(), MEASURE)
    )
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
