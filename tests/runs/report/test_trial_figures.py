"""Figures of the catalogue in the page with sliders: they follow the sliders, and are those of a run of this car."""

import json

import pytest

from tests.runs.report.test_trial import Page, car_of, shipped
from vehicle.runs.figures.catalogue import FIGURES
from vehicle.runs.figures.reductions import RMS

LIVE = (
    "tyre_load", "tyre_load_rms_fr", "tyre_load_crest", "lowest_load_fl", "travel", "weighted", "weighted_z",
    "rms:knuckle_fl_acc_z", "peak:seat_rail_acc_z", "peak_to_peak:damper_fl_velocity", "crest_factor:tyre_fl_force_z",
)  # fmt: skip
OTHERS = ("unweighted", "stick_share", "rms:seat_rail_acc_z:Wk", "frequency:heave")


@pytest.mark.usefixtures("one_car")
def test_figures_follow_the_sliders(browser):
    car, signal = shipped("high.csv")
    page = Page(browser, car, signal, measure=[*LIVE, *OTHERS])
    listed = json.loads(page.text)["figures"]
    assert len(listed) == len(LIVE)
    for state in ({}, {"front-coulomb_friction": 60.0}):
        run = car_of(car, state).run(signal, engine="reduced")
        values = page.ask("record", **state)["figures"]
        # The page computes the same march in double precision: 4e-11 at most, from another order of the sums.
        assert values == pytest.approx([run.figure(name) for name in LIVE], rel=1e-9)


def test_a_page_without_figures_has_no_entry():
    car, signal = shipped("low.csv")
    assert "figures" not in json.loads(Page(None, car, signal).text)


def test_every_reduction_of_the_page_is_that_of_a_figure():
    named = {figure.reduces.page for figure in FIGURES.values()} - {"", "comfort"}
    assert {RMS.page, "largest_crest", "peak"} <= named and all(
        figure.reads.page or not figure.reduces.page or figure.reduces.page == "comfort" for figure in FIGURES.values()
    )
