"""Dampers outside the velocities of their tests: shares of time, and the effect on comfort of two continuations."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle import Car, register_friction, road
from vehicle.model.laws.damper import damper_curve
from vehicle.model.laws.law_by_address import CALL
from vehicle.runs.car.outside_tests import continued
from vehicle.studies.sweeps.plan import plan_sweep

LAW = {
    "front.damper.viscous_law": "degressive",
    "front.damper.viscous": 70.0,
    "front.damper.degressive_viscous": 3100.0,
    "front.damper.degressive_velocity": 0.06,
}
TESTED = {"front.damper.tested.velocity": [0.016, 0.079]}
DRIVE = road("B", 80, duration=5, seed=3)


def notices(run):
    return [text for text in run.recording.statistics.notices if "test" in text]


@pytest.fixture(scope="module")
def run():
    return Car.load("focus_road", LAW | TESTED).run(DRIVE, engine="reduced")


TABLE = {
    "front.damper.viscous_law": "table",
    "front.damper.velocity": [-1.06, -0.06, 0.0, 0.06, 0.5, 1.06],
    "front.damper.force": [-256.0, -186.0, 0.0, 186.0, 216.8, 256.0],
}
"""The same curve as a table with further points, as fits of both directions write it."""


@pytest.mark.parametrize("form", [LAW, TABLE], ids=["degressive", "table"])
def test_continuations_of_a_curve(form):
    """D v to 60 mm/s with 3100 N s/m, then 70 N s/m; friction 62.5 N; range 16 to 79 mm/s: in closed form."""
    law = Car.load("focus_road", form | {"front.damper.coulomb_friction": 62.5} | TESTED).vehicle.damper
    v = np.array([-0.5, -0.079, -0.03, -0.004, 0.0, 0.008, 0.016, 0.05, 0.079, 0.3])
    size, sign = np.abs(v), np.sign(v)
    plain = 3100.0 * np.minimum(size, 0.06) + 70.0 * np.maximum(size - 0.06, 0.0)
    end, slow = 186.0 + 70.0 * 0.019, 3100.0 * 0.016
    inside = size <= 0.079
    for constant, above in ((True, np.full(v.size, end)), (False, end * size / 0.079)):
        found = continued(law, above=True, constant=constant)
        np.testing.assert_allclose(damper_curve(found).force(v), sign * np.where(inside, plain, above), atol=1e-9)
        assert found.coulomb_friction == 62.5 and found.tested is None
    friction = continued(law, above=False, constant=True)
    assert friction.coulomb_friction == pytest.approx(slow + 62.5)
    np.testing.assert_allclose(damper_curve(friction).force(v), sign * np.maximum(plain - slow, 0.0), atol=1e-9)
    damping = continued(law, above=False, constant=False)
    assert damping.coulomb_friction == 0.0
    expected = np.where(size > 0.016, plain + 62.5, (slow + 62.5) * size / 0.016)
    np.testing.assert_allclose(damper_curve(damping).force(v), sign * expected, atol=1e-9)


def test_a_run_states_share_of_time_and_change_of_comfort(run):
    (text,) = notices(run)
    share = max(np.mean(np.abs(run[f"damper_{wheel}_velocity"][run.evaluated]) > 0.079) for wheel in ("fr", "fl"))
    assert f"front.damper is faster than its fastest test (0.079 m/s) for {100.0 * share:.0f} % of the time" in text
    stated = [float(part.split(" %")[0]) for part in text.split("changes by ")[1].split("by ")]
    # The same continuations, written as tables by hand and run one at a time in double precision.
    end = 186.0 + 70.0 * 0.019
    for value, far, way in zip(stated, (end, end * 10.0 / 0.079), ("constant", "in proportion"), strict=True):
        table = {
            "front.damper.viscous_law": "table",
            "front.damper.velocity": [-10.0, -0.079, -0.06, 0.0, 0.06, 0.079, 10.0],
            "front.damper.force": [-far, -end, -186.0, 0.0, 186.0, end, far],
        }
        other = Car.load("focus_road", table).run(DRIVE, engine="reduced")
        change = other.comfort().weighted.overall / run.comfort().weighted.overall - 1.0
        validated(
            "Sweeps, tuning and optimisation", f"damper outside its tests: change of comfort, force {way}",
            value, 100.0 * change, abs=0.06, unit="%",
            source="second derivation: tables of the same curves, double precision",
        )  # fmt: skip


def test_both_engines_say_the_same(run):
    (text,) = notices(Car.load("focus_road", LAW | TESTED).run(DRIVE, engine="mujoco"))
    assert text.split(" changes ")[1].split(";")[0] == notices(run)[0].split(" changes ")[1].split(";")[0]


def test_friction_below_the_slowest_test_is_stated():
    """On a smooth road the damper hardly leaves 50 mm/s: what is friction there decides on comfort."""
    tested = {"front.damper.tested.velocity": [0.05, 2.0], "rear.damper.tested.velocity": [0.05, 2.0]}
    (text,) = notices(Car.load("focus_road", tested).run(road("A", 50, duration=5, seed=3), engine="reduced"))
    assert text.startswith("front.damper is slower than its slowest test reaches (0.05 m/s) for ")
    assert "if the force is friction alone and by" in text and text.endswith("add tests with lower velocities")


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"front.damper.tested.velocity": [0.001, 1.5]},
        TESTED | {"front.damper.viscous": 80.0},
        TESTED | {"front.right.damper.viscous": 80.0, "front.left.damper.viscous": 80.0},
    ],
    ids=["no range", "inside", "another law", "another law of each side"],
)  # fmt: skip
def test_nothing_is_said_without_need(changes):
    assert notices(Car.load("focus_road", LAW).with_(changes).run(DRIVE, engine="reduced")) == []


def test_a_controlled_damper_has_its_share_alone():
    control = {"law": "skyhook", "minimum_damping": 500.0, "maximum_damping": 3000.0, "skyhook_damping": 2000.0}
    control |= {"groundhook_damping": 0.0, "skyhook_share": 1.0, "control_period": 0.001}
    changes = TESTED | {f"front.damper.control.{name}": value for name, value in control.items()}
    (text,) = notices(Car.load("focus_road", changes).run(DRIVE, engine="reduced"))
    assert text.endswith("no test shows its force there, and the effect on comfort is not computed")


def test_a_damper_with_a_friction_function_has_its_share_alone():
    function = CALL(lambda memory, friction, v: friction)
    register_friction("of_the_tests", function)
    changes = LAW | {"front.damper.friction_function": "of_the_tests"} | TESTED
    (text,) = notices(Car.load("focus_road", changes).run(DRIVE, engine="reduced"))
    assert text.endswith("no test shows its force there, and the effect on comfort is not computed")


def test_a_sweep_states_it_for_its_first_car(run):
    plan = plan_sweep(Car.load("focus_road", LAW | TESTED), {"rear.damper.viscous": [1400.0, 1600.0]}, [DRIVE])
    (note,) = plan.range_notes()
    assert note.startswith("first car on road_B_80")
    changed = plan_sweep(Car.load("focus_road", LAW | TESTED), {"front.damper.viscous": [80.0, 90.0]}, [DRIVE])
    assert changed.range_notes() == ()
