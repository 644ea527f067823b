"""Variations one after the other: each acts on the car before it, and the texts of all make the same car at once."""

import itertools
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from vehicle.model.flexbody.rigid_body import cog_inertia
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal
from vehicle.studies.sweeps.case import Case
from vehicle.studies.sweeps.case_evaluation import _car_of, run_of
from vehicle.studies.tuning.fit_result import TuningResult
from vehicle.studies.tuning.tuned_car import TunedCar

ORIGIN = ["body.inertia.about=origin", "body.inertia.ixx=1600", "body.inertia.iyy=9900", "body.inertia.izz=9200",
          "body.inertia.izx=2662"]  # fmt: skip
"""Inertia of the body of the sedan, near enough, about the origin."""

STEPS = {
    "cog": ["body.mass=1500", "body.inertia.iyy=2500", "body.cog.z=1.0", "front.damper.coulomb_friction=50"],
    "origin": ["body.mass=1500", "body.inertia.iyy=9000", "body.cog.z=1.0", "front.damper.coulomb_friction=50"],
}


def inertia(body):
    """Tensor about the centre of gravity [kg m2], over mass: radii of gyration squared."""
    return cog_inertia(body) / body.mass


def test_a_moment_that_was_set_before_scales_with_the_mass():
    """Radii of gyration stay: iyy 2500 kg m2 of 1222.1 kg is 2500 * 1500 / 1222.1 of 1500 kg."""
    first = Car.load("sedan").with_(["body.inertia.iyy=2500"])
    body = first.with_(["body.mass=1500"]).vehicle.body
    assert body.inertia.iyy == pytest.approx(2500.0 * 1500.0 / first.vehicle.body.mass, rel=1e-14)
    np.testing.assert_allclose(inertia(body), inertia(first.vehicle.body), rtol=1e-13, atol=1e-13)
    loaded = Car.load("sedan", ["body.inertia.iyy=2500"]).with_(["body.mass=1500"])
    assert loaded.vehicle.body == body
    # Set in the same variation, it is kept.
    assert Car.load("sedan", ["body.inertia.iyy=2500", "body.mass=1500"]).vehicle.body.inertia.iyy == 2500.0


@pytest.mark.parametrize("about", list(STEPS))
@pytest.mark.parametrize("order", list(itertools.permutations(range(4))))
def test_each_step_acts_on_the_car_before_it_whatever_the_order(about, order):
    """A mass keeps radii of gyration, a CoG the inertia about the CoG, whatever was set before; a moment is as set."""
    car, steps = Car.load("sedan", ORIGIN if about == "origin" else []), STEPS[about]
    for number in order:
        before, step = car.vehicle.body, steps[number]
        car = car.with_([step])
        if step == "body.mass=1500":
            np.testing.assert_allclose(inertia(car.vehicle.body), inertia(before), rtol=1e-12, atol=1e-12)
        elif step == "body.cog.z=1.0":
            np.testing.assert_allclose(cog_inertia(car.vehicle.body), cog_inertia(before), rtol=1e-12, atol=1e-9)
        elif step.startswith("body.inertia"):
            assert car.vehicle.body.inertia.iyy == float(step.partition("=")[2])
        else:
            assert car.vehicle.body == before
    assert Car.load("sedan", car.overrides).vehicle == car.vehicle


STORED = ["body.mass=830", "body.superelement=trimmed_body.toml"]


@pytest.mark.parametrize("order", list(itertools.permutations(["body.mass=830", "body.mass=840", *STORED[1:]])))
def test_a_body_model_belongs_to_the_mass_at_which_it_is_set(order):
    """A mass scales the model that the car has; a model that is set is not scaled until the next mass."""
    car, factor = Car.load("focus"), 1.0
    for step in order:
        before = car.vehicle.body.mass
        car = car.with_([step])
        factor = 1.0 if "superelement" in step else factor * car.vehicle.body.mass / before
        assert car.vehicle.body.model_factor == pytest.approx(factor, rel=1e-14)
    assert Car.load("focus", car.overrides).vehicle == car.vehicle


def test_a_file_of_a_law_can_be_set_before_and_after_other_steps(tmp_path):
    for name, force in (("a", 900), ("b", 1200)):
        (tmp_path / f"{name}.csv").write_text(
            f"velocity [m/s],force [N]\n-1,-{force}\n0,0\n1,{force}\n", encoding="utf-8"
        )
    file = tmp_path / "car.toml"
    file.write_text('base = "focus_road"\n[front.damper]\nviscous_law = "table"\ncurve = "a.csv"\n', encoding="utf-8")
    steps = ["front.damper.curve=b.csv", "front.damper.coulomb_friction=50", "body.mass=840"]
    expected = Car.load(file, steps).vehicle
    for order in itertools.permutations(steps):
        car = Car.load(file)
        for step in order:
            car = car.with_([step])
        assert car.vehicle == expected and Car.load(file, car.overrides).vehicle == expected
    # A load can be added after other steps, as before them.
    assert car.with_({"load.trunk.mass": 80, "load.trunk.at": [3.6, 0.0, 0.7]}).vehicle.composition.loads


def test_both_engines_of_a_sweep_run_the_car_of_the_second_step():
    """`--set` of a sweep is the first variation, a case the second."""
    time = np.arange(0.0, 1.0, 1e-3)
    signal = Signal(time=time, displacement={"fr": 1e-3 * np.sin(20.0 * time)})
    changes = ("body.inertia.iyy=2500", "body.mass=1500")
    case = Case(source=signal, overrides=changes, engine="reduced", vehicle=vehicle_file(Path("sedan")), shared=1)
    expected = Car.load("sedan", changes[:1]).with_(changes[1:]).vehicle
    assert expected.body.inertia.iyy > 3000.0
    assert _car_of(case).vehicle == expected and run_of(case).car.vehicle == expected


def test_the_line_that_a_fit_prints_makes_the_fitted_car():
    """A fit varies the car that `--set` has made; its line beside those options is one variation with them."""
    start = Car.load("sedan", ["body.inertia.iyy=2500"])
    result = SimpleNamespace(values={"body.mass": 1500.0}, unknowns=())
    tuned = TunedCar(start=start, result=cast(TuningResult, result), measurements=(), engine="reduced", final=None)
    printed = [*start.overrides, *tuned.settings]
    assert Car.load("sedan", printed).vehicle == tuned.fitted.vehicle
    assert tuned.fitted.vehicle.body.inertia.iyy == pytest.approx(2500.0 * 1500.0 / start.vehicle.body.mass, rel=1e-14)
    # Without a value of the body before, it is the fitted value alone.
    plain = TunedCar(
        start=Car.load("sedan"), result=cast(TuningResult, result), measurements=(), engine="reduced", final=None
    )
    assert plain.settings == ("body.mass=1500",)
