"""Texts of values and bounds, the same in sweep, optimise and tune."""

import pytest

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.ranges import parsed_variation


def test_values_and_bounds():
    assert parsed_variation("--vary", "a.b=1,stuck, [1, 2, 3]").listed() == ("1", "stuck", "[1, 2, 3]")
    assert parsed_variation("--vary", "a=0.1:0.4:4").listed() == ("0.1", "0.2", "0.3", "0.4")
    bounds = parsed_variation("--vary", "a.b=-1e3:2").range()
    assert (bounds.path, bounds.low, bounds.high) == ("a.b", -1000.0, 2.0)
    assert parsed_variation("--vary", "law=file.csv").listed() == ("file.csv",)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("damper.viscous", "must be PATH=A,B,C, PATH=A:B:N or PATH=A:B"),
        ("=1:2", "must be PATH=A,B,C"),
        ("a=1,,2", "must be PATH=A,B,C"),
        ("a=x:2", "all are numbers"),
        ("a=1:inf", "all are numbers"),
        ("a=1:2:3:4", "all are numbers"),
        ("a=2:2", "the lower bound must be below the upper one"),
        ("a=1:2:2.5", "found 2.5 values, must be a whole number of at least 2"),
        ("a=1:2:1", "found 1 values"),
    ],
)
def test_other_texts(text, message):
    with pytest.raises(ConfigurationError) as caught:
        parsed_variation("--vary", text)
    assert str(caught.value).startswith(f"--vary {text}: ") and message in str(caught.value)


def test_values_where_bounds_are_needed_and_the_reverse():
    with pytest.raises(ConfigurationError, match="--vary a=1,2: contains values, must be two bounds"):
        parsed_variation("--vary", "a=1,2").range()
    with pytest.raises(ConfigurationError, match=r"--vary a=1:2: contains bounds, .* a=1:2:5"):
        parsed_variation("--vary", "a=1:2").listed()
