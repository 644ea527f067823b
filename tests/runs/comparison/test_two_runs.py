"""A run as the reference of a comparison with another run."""

from dataclasses import replace

import pytest

from scenarios.signals.random_road import random_road
from vehicle import Car, compare, road, save_run
from vehicle.errors import ConfigurationError

FRICTION = "damper.coulomb_friction=62.5"
COMPARED = ("seat_rail_acc_z", "plate_fl_displacement")


@pytest.fixture(scope="module")
def runs():
    """Runs of two cars on the same signal: as shipped, and with half the friction."""
    signal = random_road(rms=5.25e-4, seed=5, wheel="fl", duration=20.0)
    return [Car.load("focus", changes).run(signal, engine="reduced") for changes in ([], [FRICTION])]


def part(run, channels):
    histories = {name: run.recording.channels[name] for name in channels}
    return replace(run, recording=replace(run.recording, channels=histories))


def test_a_run_agrees_with_itself(runs):
    names = [*COMPARED, "knuckle_fl_acc_z", "damper_fl_velocity"]
    base = part(runs[0], names)
    result = compare(base, base)
    assert {row.channel: row.frac for row in result.responses} == pytest.approx(dict.fromkeys(names[::2], 1.0))
    assert {row.channel: row.rms_ratio for row in result.records} == pytest.approx(dict.fromkeys(names, 1.0))


def test_two_runs_compare_as_the_file_of_one_with_the_other(runs, tmp_path):
    """The same numbers as through the files of the reference, whose FRFs and time histories are read again."""
    base, softer = runs
    folder = save_run(base, tmp_path / "base", figures=False)
    base, softer = (part(run, [*COMPARED, "engine_acc_z"]) for run in runs)
    result = compare(softer, base)
    histories = compare(softer, folder / "time.npz", {name: name for name in COMPARED})
    for row in histories.records:
        same = next(each for each in result.records if each.channel == row.channel)
        assert same.rms_ratio == pytest.approx(row.rms_ratio, rel=1e-6)
        assert same.correlation == pytest.approx(row.correlation, rel=1e-6)
    responses = compare(softer, folder / "frf.csv", {COMPARED[0]: COMPARED[0]})
    response = next(each for each in result.responses if each.channel == COMPARED[0])
    # The frequencies in the file are rounded, so that lines beside those without excitation fall out: 3e-5.
    assert response.frac == pytest.approx(responses.responses[0].frac, rel=1e-4) and response.frac < 0.99
    assert result.measured.startswith("focus on ") and FRICTION not in result.measured
    assert result.simulated == f"{result.measured}, {FRICTION}"
    with pytest.raises(ConfigurationError, match="channels, choice, inverted"):
        compare(softer, base, {COMPARED[0]: COMPARED[0]})


def test_runs_on_a_road_have_no_responses():
    """The rear wheels repeat the road of the front wheels, so no FRF can be separated; time histories remain."""
    car = Car.load("focus_road")
    plates = [f"plate_{wheel}_displacement" for wheel in car.vehicle.wheels]
    whole = car.run(road("A", 80, duration=4), engine="reduced", channels=["seat_rail_acc_z", *plates])
    for channels, notices in ((["seat_rail_acc_z", *plates], 1), (["seat_rail_acc_z"], 0)):
        run = part(whole, channels)
        result = compare(run, run)
        assert not result.responses and {row.channel for row in result.records} == set(channels)
        assert sum(text.startswith("no FRFs: ") for text in result.notices) == notices
