"""A function as a measure: its stored rows belong to it and to all that it reads."""

import functools
import threading

import numpy as np
import pytest

from vehicle import Car, road, sweep
from vehicle.errors import ConfigurationError
from vehicle.studies.sweeps.function_measure import FunctionMeasure

RIDE = road("C", 80, duration=3)
FACTORS = {"crank": np.array([1.0, 2.0])}
LOCK = threading.Lock()


def scaled(factor):
    return lambda run: {"x": factor * float(run["seat rail z"].std())}


def text(function):
    return repr(FunctionMeasure(function=function))


def test_functions_of_one_factory_share_no_rows(tmp_path):
    car = Car.load("focus")
    first, second = (
        sweep(car, {"front.damper.viscous": [1500.0]}, RIDE, measure=scaled(factor), folder=tmp_path, engine="reduced")
        for factor in (1.0, 2.0)
    )
    assert second.column("x")[0] == 2.0 * first.column("x")[0]


def read_globals(run):
    return [FACTORS for _ in (1,)] and helper(run)


def helper(_):
    return FACTORS["crank"][1]


def with_default(_, factor=1.0):
    return factor


class Scaled:
    def __init__(self, factor):
        self.factor = factor

    def __call__(self, run):
        return self.factor * float(run["seat rail z"].std())


def times(factor, run):
    return factor * float(run["seat rail z"].std())


def test_all_that_a_function_reads_is_in_its_text(monkeypatch):
    assert text(scaled(1.0)) == text(scaled(1.0)) != text(scaled(2.0))
    assert text(Scaled(1.0)) == text(Scaled(1.0)) != text(Scaled(2.0))
    assert text(functools.partial(times, 1.0)) == text(functools.partial(times, 1.0))
    assert text(functools.partial(times, 1.0)) != text(functools.partial(times, 2.0))
    assert text(lambda run: np.mean(run.time)) != text(lambda run: np.max(run.time))
    before = text(with_default)
    monkeypatch.setattr(with_default, "__defaults__", (2.0,))
    assert text(with_default) != before
    before = text(read_globals)
    monkeypatch.setitem(FACTORS, "crank", np.array([1.0, 3.0]))
    assert text(read_globals) != before
    assert "0x" not in text(scaled(FACTORS["crank"])) + text(Scaled({1, 2}))


def test_partial_functions_and_objects_have_a_name():
    car = Car.load("focus")
    for measure, name in ((functools.partial(times, 2.0), "times"), (Scaled(2.0), "Scaled")):
        table = sweep(car, {"front.damper.viscous": [1500.0]}, RIDE, measure=measure, engine="reduced")
        assert table.column(name)[0] > 0.0


def locked(_):
    with LOCK:
        return 1.0


def test_a_value_without_content_refuses_a_folder(tmp_path):
    car = Car.load("focus")
    with pytest.raises(ConfigurationError, match="measure locked: reads a value that cannot be compared with that of"):
        sweep(car, {"front.damper.viscous": [1500.0]}, RIDE, measure=locked, folder=tmp_path, engine="reduced")
    assert sweep(car, {"front.damper.viscous": [1500.0]}, RIDE, measure=locked, engine="reduced").column("locked") == 1
