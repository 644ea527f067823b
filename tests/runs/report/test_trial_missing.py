"""Reports without the section "Try it", or without one of its sliders."""

import dataclasses
import json

import pytest

from tests.runs.report.test_trial import shipped
from vehicle.errors import ConfigurationError
from vehicle.handover.page.trial_data import trial_data
from vehicle.handover.page.trial_section import trial
from vehicle.runs.report.finished_run import read_run
from vehicle.runs.report.page import report_page


def test_a_report_without_sliders_says_why(reported):
    run = read_run(reported.folder)
    of_cams = dataclasses.replace(run.summary.input, road={"tyre_contact": "cams"})
    over_obstacles = dataclasses.replace(run, summary=dataclasses.replace(run.summary, input=of_cams))
    assert "with cams" in trial(over_obstacles).content
    assert "This report has no sliders for this car or input" in report_page([over_obstacles], trial=trial)
    silent = {name: history for name, history in run.recording.channels.items() if not name.startswith("plate")}
    recording = dataclasses.replace(run.recording, channels=silent)
    silent_trial = trial(dataclasses.replace(run, recording=recording))
    assert silent_trial.numbers == "" and "no channel &#39;plate_fl_displacement&#39;" in silent_trial.content


def test_a_car_that_the_page_cannot_run_has_no_section():
    car, signal = shipped("low.csv")
    with pytest.raises(ConfigurationError, match=r"8 s, .* at most 30 s, .* at least 35\.4 s"):
        trial_data(car, signal, wheel="fl", skip=30.0)
    slopes = dataclasses.replace(signal, slope_velocity=signal.displacement)
    with pytest.raises(ConfigurationError, match="plate displacements"):
        trial_data(car, slopes, wheel="fl")


def test_a_controlled_damper_has_no_slider_for_its_curve():
    """A factor would act on the softest line alone; the coefficient comes from the controller."""
    control = (
        "front.damper.control={law='skyhook', minimum_damping=500, maximum_damping=4000, skyhook_damping=2500, "
        "groundhook_damping=1500, skyhook_share=0.5, control_period=1e-3}"
    )
    car, signal = shipped("low.csv", (control,))
    names = {slider["id"] for slider in json.loads(trial_data(car, signal, wheel="fl"))["sliders"]}
    assert "front-coulomb_friction" in names and "front-curve_scale" not in names
