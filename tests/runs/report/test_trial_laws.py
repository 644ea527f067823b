"""Every law of a car in the section "Try it", in a real browser, against the reduced engine."""

import pytest

from tests.runs.report.test_trial import STRIBECK, Page, changes_of, deviations, random_states, scaled, shipped
from vehicle.runs.car import Car

pytestmark = pytest.mark.usefixtures("one_car")

PRESLIDING = ("front.damper.friction_law=presliding", "front.damper.presliding_stiffness=1e6")

LAWS: dict[str, tuple[str, ...]] = {
    "coulomb": (),
    "stribeck": STRIBECK,
    "presliding": PRESLIDING,
    "rubber friction": (
        "front.bushings.arm_rear.friction_force=[300, 300, 300]",
        "front.bushings.arm_rear.friction_stroke=[2e-4, 2e-4, 2e-4]",
    ),
    "a stop": ("front.damper.stop={displacement=[-0.04, -0.001, 0.001, 0.02], force=[-9e3, 0, 0, 3e3]}",),
    "a table": (
        "front.bushings.suspension_mount.table_z={displacement=[-8e-3, -5e-4, 0, 4e-3], force=[-8e3, -400, 0, 3200]}",
    ),
    "side forces": ("front.damper.side_force_coefficient=0.1",),
}


@pytest.mark.parametrize("law", LAWS)
def test_every_law_equals_the_reduced_engine(browser, law):
    # Both ends of the record are in motion.
    car, signal = shipped("high.csv", LAWS[law], first=3000)
    page = Page(browser, car, signal)
    for state in random_states(page, 2, curve=False):
        # Loaded anew: the matrices of a changed car are updated, with round-off of 3e-10 in its poles.
        changes = tuple(f"{path}={value}" for path, value in changes_of(car, state).items())
        found = deviations(
            page.ask("record", **state), Car.load("focus", LAWS[law] + changes), scaled(signal, state["level"])
        )
        assert found["channel"] < 1e-9 and found["comfort"] < 1e-9 and found["slip"] == 0.0, found


def test_tyres_lift_off_in_the_page(browser):
    car, signal = shipped("bump_7p5mm.csv", ("front.bushings.tyre.one_sided=true",), seconds=6.5)
    signal = scaled(signal, 4.0)
    page = Page(browser, car, signal)
    lifted = car.run(scaled(signal, 4.0), engine="reduced")
    assert min(float(lifted[f"tyre_{wheel}_force_z"].min()) for wheel in ("fr", "fl")) < 1.0
    found = deviations(page.ask("record", level=4.0), car, scaled(signal, 4.0))
    assert found["channel"] < 1e-9 and found["slip"] == 0.0, found
