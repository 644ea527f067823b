"""A run as the reference of a comparison with another run."""

import numpy as np
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


def test_a_run_agrees_with_itself(runs):
    base, _ = runs
    result = compare(base, base)
    assert all(row.frac == pytest.approx(1.0) for row in result.responses)
    assert len(result.responses) == len(base.car.vehicle.acceleration_channels)
    moving = [row.rms_ratio for row in result.records if np.isfinite(row.rms_ratio)]
    assert len(moving) > len(result.responses) and moving == pytest.approx([1.0] * len(moving))


def test_two_runs_compare_as_the_file_of_one_with_the_other(runs, tmp_path):
    """The same numbers as through the files of the reference, whose FRFs and time histories are read again."""
    base, softer = runs
    result = compare(softer, base)
    folder = save_run(base, tmp_path / "base")
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


def test_runs_on_a_road_have_no_responses():
    """The rear wheels repeat the road of the front wheels, so no FRF can be separated; time histories remain."""
    car = Car.load("focus_road")
    plates = [f"plate_{wheel}_displacement" for wheel in car.vehicle.wheels]
    for channels, notices in ((["seat_rail_acc_z", *plates], 1), (["seat_rail_acc_z"], 0)):
        run = car.run(road("A", 80, duration=4), engine="reduced", channels=channels)
        result = compare(run, run)
        assert not result.responses and {row.channel for row in result.records} == set(channels)
        assert sum(text.startswith("no FRFs: ") for text in result.notices) == notices


def test_channels_are_chosen_for_a_file_only(runs):
    base, softer = runs
    with pytest.raises(ConfigurationError, match="channels, choice, inverted: work only with a measurement file"):
        compare(softer, base, {COMPARED[0]: COMPARED[0]})
