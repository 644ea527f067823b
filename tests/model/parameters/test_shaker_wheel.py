"""The wheel that a shaker drives: a key of the vehicle file."""

from pathlib import Path

import numpy as np
import pytest

from vehicle.commands.advice import SHAKER_WHEEL
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car


def test_the_source_s_right_wheel_is_the_driver_s_left():
    vehicle = load_vehicle()
    assert (
        vehicle.shaker_wheel == "fl" == SHAKER_WHEEL
        and vehicle.points["wheel_center_fl"][1] < 0.0 > vehicle.points["seat_rail"][1]
    )
    assert vehicle.wheel_text("fl") == "driver's left front wheel (fl; 'right wheel' in the words of the publication)"
    assert vehicle.wheel_text("fr") == "driver's right front wheel (fr)"


def test_the_key_has_a_default_and_is_checked():
    assert load_vehicle(Path("sedan")).shaker_wheel == "fr"
    assert load_vehicle(Path("sedan")).wheel_text("rr") == "rear right wheel (rr)"
    with pytest.raises(ConfigurationError, match=r"rr \(rear_right\): focus has no such wheel"):
        load_vehicle(None, ["shaker_wheel=rr"])
    with pytest.raises(ConfigurationError, match=r"shaker_wheel: .* not 'left'"):
        load_vehicle(None, ["shaker_wheel=left"])


def test_both_cars_of_the_source_are_shaken_at_the_same_wheel():
    cars = [load_vehicle(Path(name)) for name in ("focus", "focus_road")]
    assert [(car.shaker_wheel, car.shaker_wheel_in_source) for car in cars] == [("fl", "right")] * 2


def test_linear_responses_are_to_the_plate_of_the_key():
    car, lines = Car.load(), [5.0, 25.0]
    assert np.array_equal(
        car.matrix_frf(["seat_rail_acc_z"], lines), car.matrix_frf(["seat_rail_acc_z"], lines, wheel="fl")
    )
    assert not np.allclose(
        car.matrix_frf(["seat_rail_acc_z"], lines), car.matrix_frf(["seat_rail_acc_z"], lines, wheel="fr")
    )
