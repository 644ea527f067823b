"""Figures that a car or an input lacks, and channels of another unit, are refused before the first run."""

import numpy as np
import pytest

from vehicle import Car, optimise, road, sweep
from vehicle.errors import ConfigurationError
from vehicle.handover.page.live_figures import figure_data, page_figures
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.figures.chosen_figure import chosen_figure
from vehicle.runs.figures.figure import Values
from vehicle.runs.targets.target import Target
from vehicle.studies.optimisation.target_measure import measures_of
from vehicle.studies.sweeps.measure import SingleMeasure, chosen_measure

Z = "seat_rail_acc_z"


@pytest.fixture(scope="module")
def car():
    return Car.load("sedan")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("comfort", "no figure 'comfort'; choose from unweighted[:AXIS], weighted[:AXIS]"),
        ("seat_weighted", "focus has no figure 'seat_weighted'"),
        ("peak", "peak:CHANNELS[:WEIGHTING]"),
        ("travel:long", "travel[:WHEELS]"),
        ("travel_rl", "wheels: found rl, must be among fr, fl"),
        ("rms:seat rail z:5-25:Wk:Wk", "rms:CHANNELS[:LOW-HIGH]"),
        ("rms:seat rail z:25-5", "rms:CHANNELS"),
        ("peak:seat rail q", "channel 'seat rail q'"),
        (f"order:0:{Z}", "order:N:CHANNELS[:ANGLE]"),
        (f"peak:{Z}+damper_fr_velocity", "seat_rail_acc_z [m/s2], damper_fr_velocity [m/s]; peak needs"),
        (f"ratio:{Z}:{Z}+damper_fr_velocity", "ratio needs channels in one unit"),
        ("vdv:damper_fr_velocity:Wk", "damper_fr_velocity [m/s]; vdv needs channels in m/s2"),
        ("frequency:yaw", "motion 'yaw': must be one of heave, pitch, roll, front wheel hop"),
        ("rms:damper_fr_force:seat", "weighting 'seat': damper_fr_force has no axis x, y or z"),
    ],
)
def test_a_name_is_refused(text, message):
    with pytest.raises(ConfigurationError) as refusal:
        chosen_figure(text, load_vehicle())
    assert str(refusal.value).startswith(f"figure {text!r}: ") and message in str(refusal.value)


def test_an_angle_is_refused(car):
    with pytest.raises(ConfigurationError, match="angle 'foo': must be one of crank, wheel_fr"):
        chosen_figure(f"order:1:{Z}:foo", car.vehicle)


def test_a_dimensionless_figure_takes_several_units(car):
    assert chosen_figure(f"crest_factor:{Z}+damper_fr_velocity", car.vehicle).unit_in() == "-"


@pytest.mark.parametrize(
    ("figure", "message"),
    [
        ({"quantity": "rms", "unit": "m/s2", "channels": (Z, "damper_fr_velocity")}, "rms needs channels in one unit"),
        ({"quantity": "frequency", "unit": "Hz", "motion": "foo"}, "motion 'foo'"),
        ({"quantity": "settling", "unit": "s", "channels": (Z,)}, "the run has no obstacle"),
    ],
)
def test_a_target_is_refused(car, figure, message):
    target = Target(at_most=1.0, road="C", speed=80.0, **figure)
    with pytest.raises(ConfigurationError, match=message):
        measures_of(car, {"a": target}, 3.0)


def test_an_input_without_the_figure_is_refused(car):
    damper, ride = {"rear.damper.viscous": [1500.0, 2000.0]}, road("C", 80, duration=3)
    with pytest.raises(ConfigurationError, match=r"settling time, seat rail acc z on .*: settling: the run has no"):
        sweep(car, damper, ride, measure=f"settling:{Z}")
    with pytest.raises(ConfigurationError, match=r"order amplitude, 1, .* nothing rotates"):
        sweep(car, damper, "low.csv", measure=f"order:1:{Z}")
    with pytest.raises(ConfigurationError, match="the run has no obstacle"):
        optimise(car, {"rear.damper.viscous": (1500.0, 2000.0)}, ride, [f"settling:{Z}"])


def test_two_figures_never_share_a_column(car):
    with pytest.raises(ConfigurationError, match=f"have the same column order_1_{Z}"):
        chosen_measure([f"order:1:{Z}:crank", f"order:1:{Z}:wheel_fr"], car.vehicle, 0.0)
    units = chosen_measure([f"order:1:{Z}", f"order:2:{Z}"], car.vehicle, 0.0).units
    assert [name for name in units if "frequency" in name] == ["order_frequency_1", "order_frequency_2"]
    units = chosen_measure([f"order:1:{Z}", "order:1:seat_rail_acc_x", *[f"peak:{Z}"] * 2], car.vehicle, 0.0).units
    assert [name for name in units if "frequency" in name] == ["order_frequency"] and f"peak_{Z}" in units


def test_a_force_of_a_load_is_a_figure_of_a_sweep(car):
    measure = chosen_measure("peak:tyre_fr_force_x", car.vehicle, 0.0)
    assert isinstance(measure, SingleMeasure)
    damper, ride = {"rear.damper.viscous": [1500.0]}, road("C", 80, duration=2.5)
    table = sweep(car, damper, ride, measure="peak:tyre_fr_force_x", engine="reduced")
    assert not table.failed and table.column("peak_tyre_fr_force_x")[0] > 0.0


def test_a_page_leaves_out_a_figure_of_a_plate(car):
    assert figure_data(page_figures(car, ["peak:plate_fr_displacement"]), {"seat_rail_displacement_z": 0}) == {}


def test_an_undefined_error_is_unknown():
    value, error = np.array([0.1]), np.array([0.2])
    assert Values(value).first() == Values(value, np.array([np.nan])).first() == (0.1, None)
    assert Values(value, error).first() == (0.1, 0.2)
