"""Paths of parameters into vehicles and back."""

import pytest

from vehicle.car import Car
from vehicle.errors import ConfigurationError
from vehicle.parameters.number_paths import value_of
from vehicle.tuning.parameter import Parameter, overrides_of


def test_values_arrive_where_their_paths_say(car):
    values = {
        "damper.viscous": 2100.0,
        "bushings.suspension_mount.stiffness.z": 6.9e5,
        "bushings.suspension_mount.stiffness.x": 2.9e6,
        "body.mass": 800.0,
    }
    texts = overrides_of(car.vehicle, values)
    changed = Car.load(overrides=texts).vehicle
    assert {path: value_of(changed, path) for path in values} == values
    # The third component is not a parameter and stays.
    assert changed.bushings.suspension_mount.stiffness[1] == car.vehicle.bushings.suspension_mount.stiffness[1]
    assert overrides_of(car.vehicle, {}) == ()


@pytest.mark.parametrize(
    "path",
    [
        "bushings.suspension_mount.stifness.z",
        "bushings.suspension_mount.stiffness",
        "bushings.suspension_mount.stiffness.w",
        "damper.friction_law",
        "damper",
        "body.flexible",
        "x",
    ],
)
def test_a_path_that_is_no_number_is_refused_with_the_nearest(car, path):
    for use in (lambda: overrides_of(car.vehicle, {path: 1.0}), lambda: value_of(car.vehicle, path)):
        with pytest.raises(ConfigurationError, match=f"parameter {path}: no number of a vehicle; the nearest is "):
            use()


def test_the_nearest_path_has_its_axis(car):
    with pytest.raises(ConfigurationError, match=r"nearest is bushings\.suspension_mount\.stiffness\.z$"):
        value_of(car.vehicle, "bushings.suspension_mount.stifness.z")


def test_logarithmic_scale():
    parameter = Parameter(path="a", lower=1.0, upper=4.0, start=2.0)
    assert parameter.value(0.0) == 2.0
    assert parameter.value(parameter.half_width) == pytest.approx(4.0)
    assert parameter.value(-parameter.half_width) == pytest.approx(1.0)
