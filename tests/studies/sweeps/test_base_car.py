"""A sweep over single variations: the car itself is the base, and what a run does not vary has the value of the car."""

import numpy as np
import pytest

from tests.studies.sweeps.sweep_samples import ShortRoad
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car
from vehicle.studies.sweeps.comfort_ranking import best_sentences
from vehicle.studies.sweeps.plan import changes_of, plan_sweep, sweep
from vehicle.studies.sweeps.sweep_picture import can_be_drawn
from vehicle.studies.sweeps.sweep_ranking import ranked_cars, ranking_lines
from vehicle.studies.sweeps.sweep_settings import SweepSettings

SINGLE = [{"damper.viscous": 1500.0}, {"tyre.stiffness.z": 2e5}]


def test_variations_of_different_parameters_get_the_car_itself_as_base():
    assert changes_of(SINGLE)[0] == () and len(changes_of(SINGLE)) == 3
    assert changes_of([*SINGLE, {}])[0] == tuple(changes_of(SINGLE)[1])
    # Variations of one parameter, or of the same ones, are compared with the first of them.
    assert len(changes_of([{"damper.viscous": 1500.0}, {"damper.viscous": 2000.0}])) == 2
    with pytest.raises(ConfigurationError, match="vary: "):
        changes_of([{}])


@pytest.fixture(scope="module")
def table():
    return sweep(Car.load("focus"), SINGLE, [ShortRoad()], engine="reduced")


def test_the_base_is_the_car_and_shows_its_values(table):
    assert [case.overrides for case in table.cases] == [
        (), ("damper.viscous=1500.0",), ("tyre.stiffness.z=200000.0",)
    ]  # fmt: skip
    cars = ranked_cars(table)
    assert cars is not None and cars.paths == ["damper.viscous", "tyre.stiffness.z"]
    vehicle = Car.load("focus").vehicle
    viscous, tyre = (vehicle.table["front"]["damper"]["viscous"], vehicle.table["front"]["bushings"]["tyre"])
    numbers = cars.numbers()
    assert numbers is not None and can_be_drawn(cars)
    np.testing.assert_allclose(numbers[0], [viscous, tyre["stiffness"][2]], rtol=1e-5)
    np.testing.assert_allclose(numbers[1:], [[1500.0, tyre["stiffness"][2]], [viscous, 2e5]], rtol=1e-5)
    assert [cars.change(0), len(ranking_lines(cars)) > 3] == [0.0, True]
    alone = sweep(Car.load("focus"), {"damper.viscous": [viscous]}, [ShortRoad()], engine="reduced")
    assert table.column("weighted")[0] == pytest.approx(alone.column("weighted")[0], rel=1e-12)


def test_equal_cars_have_no_best_one():
    equal = sweep(Car.load("focus"), {"engine.mass": [150.0, 150.0]}, [ShortRoad()], engine="reduced")
    cars = ranked_cars(equal)
    assert cars is not None and not cars.paths  # nothing differs
    same = sweep(Car.load("focus"), {"gravity": [9.81, 9.81 * (1.0 + 1e-15)]}, [ShortRoad()], engine="reduced")
    cars = ranked_cars(same)
    assert cars is not None and cars.alike
    assert ranking_lines(cars)[-1].startswith("all 2 cars ") and best_sentences(cars)[0].startswith("All 2 cars ")


def test_a_sweep_without_any_effect_is_refused():
    """The front dampers of the sedan are tables, so their constants have no effect."""
    with pytest.raises(ConfigurationError, match=r"vary: .* front\.damper\.viscous=1500\.0"):
        sweep(Car.load("sedan"), {"front.damper.viscous": [1500.0, 2000.0]}, [ShortRoad()], engine="reduced")
    # On all axles they have an effect at the rear.
    plan = plan_sweep(
        Car.load("sedan"), {"*.damper.viscous": [1500.0, 2000.0]}, [ShortRoad()], SweepSettings(engine="reduced")
    )
    assert len(plan.cases) == 2 and "has no effect" in plan.notes[0]
