"""`python -m scenarios.four_post`: what sticks on a smooth input and slides on a rough one, against the matrices."""

import json

import numpy as np
import pytest

from scenarios.four_post import LINES, channels_of, main, matrix_response
from scenarios.signals.four_post import MOTIONS
from vehicle.runs.car import Car


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study") / "four_post"
    assert main(["--output", str(folder), "--quick", "--vehicle", "focus_road"]) == 0
    return folder


def test_the_study_writes_tables_and_figures(results):
    names = {path.name for path in results.iterdir()}
    assert {"results.md", "results.json", "focus_road_responses.png"} <= names
    text = (results / "results.md").read_text(encoding="utf-8")
    car = Car.load("focus_road")
    for state, lowest, highest in (("stuck", 3.0, 4.5), ("sliding", 1.2, 1.6)):
        heave = next(mode for mode in car.modes(state) if mode.description.startswith("body heave"))
        assert lowest < heave.frequency < highest
        assert state == "sliding" or f"| {heave.frequency:.2f} Hz, {heave.description} |" in text


def test_the_car_sticks_on_a_smooth_input_and_slides_on_class_a(results):
    content = json.loads((results / "results.json").read_text(encoding="utf-8"))
    assert {row["name"]: row["within"] for row in content["rows"]} == {
        "focus_road: dampers on 1/32 of class A": True,
        "focus_road: dampers on class A": True,
        "focus_road: which linear car the FRFs are near to": True,
        "focus_road: seat rail over the level, 1/32 of class A against class A": True,
    }
    runs = content["cars"]["focus_road"]["runs"]
    assert len(runs) == 2 * len(MOTIONS)
    for run in runs:
        smooth = run["level"] < 1.0
        assert max(run["slip"].values()) < 0.001 if smooth else min(run["slip"].values()) > 0.3
        near, far = (run[f"to_{state}_db"] for state in (("stuck", "sliding") if smooth else ("sliding", "stuck")))
        assert near < 0.6 * far


def test_the_response_to_a_motion_is_the_sum_over_the_plates():
    car = Car.load("focus_road")
    channels = channels_of(car, "warp")
    assert channels == ("seat_rail_acc_y", "knuckle_fr_acc_z", "knuckle_rr_acc_z")
    response = matrix_response(car, "warp", "sliding")[:, ::100]
    parts = [
        sign * car.matrix_frf(channels, LINES[::100], damper="sliding", wheel=wheel)
        for wheel, sign in (("fr", 1.0), ("fl", -1.0), ("rr", -1.0), ("rl", 1.0))
    ]
    np.testing.assert_allclose(response, sum(parts), rtol=1e-6)


def test_a_car_with_two_plates_is_refused(tmp_path, capsys):
    assert main(["--output", str(tmp_path / "out"), "--quick", "--vehicle", "focus"]) == 2
    assert "wheel rr (rear_right): focus has no such wheel" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
