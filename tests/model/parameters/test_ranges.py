"""Texts of values and bounds, the same in sweep, optimise and tune; ranges of coordinates."""

import pytest

from vehicle import Car
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.ranges import LENGTH_OF_ONE, Range, is_coordinate, parsed_variation


def test_values_and_bounds():
    assert parsed_variation("--vary", "a.b=1,stuck, [1, 2, 3]").listed() == ("1", "stuck", "[1, 2, 3]")
    assert parsed_variation("--vary", "a=0.1:0.4:4").listed() == ("0.1", "0.2", "0.3", "0.4")
    bounds = parsed_variation("--vary", "a.b=-1e3:2").range()
    assert (bounds.path, bounds.low, bounds.high) == ("a.b", -1000.0, 2.0)
    assert parsed_variation("--vary", "law=file.csv").listed() == ("file.csv",)


@pytest.mark.parametrize(("text", "message"), [
    ("damper.viscous", "must be PATH=A,B,C, PATH=A:B:N or PATH=A:B"),
    ("=1:2", "must be PATH=A,B,C"),
    ("a=1,,2", "must be PATH=A,B,C"),
    ("a=x:2", "all are numbers"),
    ("a=1:inf", "all are numbers"),
    ("a=1:2:3:4", "all are numbers"),
    ("a=2:2", "the lower bound must be below the upper one"),
    ("a=1:2:2.5", "found 2.5 values, must be a whole number of at least 2"),
    ("a=1:2:1", "found 1 values"),
])  # fmt: skip
def test_other_texts(text, message):
    with pytest.raises(ConfigurationError) as caught:
        parsed_variation("--vary", text)
    assert str(caught.value).startswith(f"--vary {text}: ") and message in str(caught.value)


def test_values_where_bounds_are_needed_and_the_reverse():
    with pytest.raises(ConfigurationError, match=r"--vary a=1,2: .* two bounds"):
        parsed_variation("--vary", "a=1,2").range()
    with pytest.raises(ConfigurationError, match=r"--vary a=1:2: contains bounds .* a=1:2:5"):
        parsed_variation("--vary", "a=1:2").listed()


def test_a_range_of_a_coordinate_does_not_depend_on_the_origin():
    """Moved origin: the same u, the same half width; a ratio would give 0.05 in one and 0.4 in the other."""
    near, far = (Range(path="a.z", low=at - 0.02, high=at + 0.02, start=at, length=LENGTH_OF_ONE) for at in (0.0, 3.0))
    assert near.half_width == pytest.approx(far.half_width) == pytest.approx(0.4)
    assert far.coordinate(3.01) == pytest.approx(near.coordinate(0.01)) == pytest.approx(0.2)
    assert far.value(-0.2) == pytest.approx(2.99) and far.slope(3.01) == LENGTH_OF_ONE
    with pytest.raises(ConfigurationError, match="must be lower < start < upper"):
        Range(path="a.z", low=0.1, high=0.2, start=0.0, length=LENGTH_OF_ONE)


def test_coordinates_are_points_and_offsets():
    vehicle = Car.load("sedan").vehicle
    for path in ("strut_top.z", "body.cog.x", "front.parts.caliper.offset.y", "engine.parts.torque_arm.offset.z"):
        assert is_coordinate(vehicle, path)
    for path in ("damper.coulomb_friction", "front.bushings.tyre.stiffness.z", "front.bushings.tyre.trail",
                 "front.bushings.arm_rear.friction_stroke.x", "driving.speed"):  # fmt: skip
        assert not is_coordinate(vehicle, path)
