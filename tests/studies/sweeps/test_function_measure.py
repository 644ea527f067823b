"""A function as a measure: its stored rows belong to one call, whatever it reads."""

import functools

import numpy as np

from vehicle import Car, road, sweep

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
