"""A function as a measure: its stored rows belong to one call, whatever it reads."""

import functools
import sys
from concurrent.futures import ThreadPoolExecutor
from types import FunctionType, ModuleType

import numpy as np
import pytest

from vehicle import Car, ConfigurationError, optimise, road, sweep
from vehicle.studies.sweeps.function_measure import NamedFunctions, require_picklable

RIDE = road("C", 80, duration=3)
VARY = {"front.damper.viscous": [1500.0]}


def scaled(factor):
    return lambda run: {"x": factor * float(run["seat rail z"].std())}


def times(factor, run):
    return factor * float(run["seat rail z"].std())


class Scaled:
    def __init__(self, factor):
        self.factor = factor

    def __call__(self, run):
        return times(self.factor, run)


def test_functions_of_one_factory_share_no_rows(tmp_path):
    car = Car.load("focus")
    first, second = (
        sweep(car, VARY, RIDE, measure=scaled(factor), folder=tmp_path, engine="reduced") for factor in (1.0, 2.0)
    )
    assert second.column("x")[0] == 2.0 * first.column("x")[0]


def test_partial_functions_and_objects_have_a_name():
    car = Car.load("focus")
    tables = [
        sweep(car, VARY, RIDE, measure=measure, engine="reduced").column(name)
        for measure, name in ((functools.partial(times, 2.0), "times"), (Scaled(2.0), "Scaled"))
    ]
    assert tables[0][0] > 0.0
    np.testing.assert_array_equal(tables[0], tables[1])


def rail(run):
    return run["seat rail z"].std()


def test_functions_and_figures_by_name():
    car = Car.load("focus")
    table = sweep(car, VARY, RIDE, measure={"my number": rail, "comfort": "weighted"}, engine="reduced")
    run = car.with_({"front.damper.viscous": 1500.0}).run(RIDE, "reduced")
    assert dict(table.units) == {"my number": "?", "comfort": "m/s2"}
    # A variant has its matrices from terms of the car, those of a loaded car to 1e-10.
    for name, value in (("my number", rail(run)), ("comfort", run.comfort().weighted.overall)):
        assert table.column(name)[0] == pytest.approx(value, rel=1e-9)
    with pytest.raises(ConfigurationError, match=r"measure 'x'.*'comfrt'"):
        sweep(car, VARY, RIDE, measure={"x": "comfrt"})
    with pytest.raises(ConfigurationError, match=r"^settling time.* on road_C_80: settling: "):
        sweep(car, VARY, RIDE, measure={"s": "settling:seat rail z", "my number": rail})
    with pytest.raises(ConfigurationError, match=r"measure 'both'.*dictionary"):
        NamedFunctions({"both": lambda run: {"a": 1.0}})(run)


def test_an_executor_of_the_user_pickles_or_shares_the_function_itself():
    pytest.importorskip("pymoo")
    car, threads = Car.load("focus"), lambda: ThreadPoolExecutor(1)
    table = sweep(car, VARY, RIDE, measure=lambda run: 2.5, engine="reduced", jobs=2, executor=threads)
    assert table.column("<lambda>") == [2.5]
    found = optimise(car, {"damper.viscous": (800, 4000)}, RIDE, {"x": lambda run: 2.5}, cars=8, population=8,
                     executor=threads)  # fmt: skip
    assert found.cars


def test_a_function_of_a_notebook_is_refused(monkeypatch):
    """Its `__main__` has no file that a new process could import."""
    main = ModuleType("__main__")
    monkeypatch.setitem(sys.modules, "__main__", main)
    cell = FunctionType(rail.__code__, {"__name__": "__main__"}, "cell")
    vars(main)["cell"] = cell
    cell.__qualname__ = "cell"
    for measure in (cell, {"x": cell}, functools.partial(cell), {"x": functools.partial(cell)}):
        with pytest.raises(ConfigurationError, match=r"measure: .*__main__.*jobs=1"):
            sweep(Car.load("focus"), VARY, RIDE, measure=measure, engine="reduced", jobs=2)
    main.__file__ = "script.py"
    require_picklable(cell)


@pytest.mark.parametrize("more", [{"jobs": 2}, {"time_limit": 60.0}])
def test_a_function_that_other_processes_cannot_load_is_refused(more):
    measures = (lambda run: 1.0, {"x": lambda run: 1.0}, Scaled(lambda: 2.0))
    for measure in measures:
        with pytest.raises(ConfigurationError, match=r"measure: .*jobs=1"):
            sweep(Car.load("focus"), VARY, RIDE, measure=measure, engine="reduced", **more)


def test_a_search_by_a_function():
    pytest.importorskip("pymoo")
    found = optimise(Car.load("focus"), {"damper.viscous": (800, 4000)}, RIDE, {"my number": rail, "travel": "travel"},
                     cars=16, population=8)  # fmt: skip
    best = found.cars["best my number"].run(RIDE, "reduced")
    assert rail(best) <= min(rail(car.run(RIDE, "reduced")) for car in found.cars.values())
    with pytest.raises(ConfigurationError, match=r"measure: .*jobs=1"):
        optimise(Car.load("focus"), {"damper.viscous": (800, 4000)}, RIDE, {"x": lambda run: 1.0}, cars=8, population=8,
                 jobs=2)  # fmt: skip
    with pytest.raises(ConfigurationError, match=r"^settling time.* on road_C_80: settling: "):
        optimise(Car.load("focus"), {"damper.viscous": (800, 4000)}, RIDE, {"x": rail},
                 limits=["settling:seat rail z<=1"])  # fmt: skip
