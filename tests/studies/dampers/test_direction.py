"""Direction of damper tests: gas pushes the rod out, and rebound is damped more than bump."""

import numpy as np
import pytest

from vehicle.errors import DataError
from vehicle.studies.dampers.damper_test import read_test
from vehicle.studies.dampers.direction import direction_of, require_direction

HEAD = "time [s],displacement [mm],velocity [mm/s],force [N]"


def write(path, *, gas=220.0, bump=0.6, signs=(1, 1, 1), amplitude=0.01, frequency=4.0):
    """Ten cycles of a degressive damper with friction, 2 % noise on the force; rebound slope 5000 N s/m."""
    t = np.arange(1000) / (100.0 * frequency)
    phase = 2.0 * np.pi * frequency * t
    x, v = amplitude * np.sin(phase), amplitude * 2.0 * np.pi * frequency * np.cos(phase)
    force = np.where(v > 0.0, 1.0, bump) * (5000.0 * np.clip(v, -0.06, 0.06) + 1200.0 * (v - np.clip(v, -0.06, 0.06)))
    force += 60.0 * np.tanh(v / 1e-4) - gas
    force += 0.02 * np.std(force) * np.random.default_rng(1).standard_normal(t.size)
    columns = [t, *(sign * values for sign, values in zip(signs, (1e3 * x, 1e3 * v, force), strict=True))]
    np.savetxt(path, np.column_stack(columns), delimiter=",", header=HEAD, comments="")
    return path


def test_gas_and_damping_of_a_test(tmp_path):
    found = direction_of(read_test(write(tmp_path / "a.csv")))
    # The segments of the regression approximate the curve: the gas force has an error beyond that of the noise.
    assert found.gas[0] == pytest.approx(220.0, rel=0.1) and found.by_gas == found.by_damping == 1
    speed = found.velocity
    curve = 300.0 + 1200.0 * (speed - 0.06)
    assert (found.rebound, found.bump) == pytest.approx((curve + 60.0, 0.6 * curve + 60.0), rel=0.05)


@pytest.mark.parametrize("signs", [(-1, -1, -1), (-1, -1, 1), (-1, 1, 1), (-1, 1, -1)])
def test_files_of_the_other_direction_are_refused(tmp_path, signs):
    """The displacement is positive in compression; force and velocity have either sign, and their signs are found."""
    path = write(tmp_path / "a.csv", signs=signs)
    said = r"a: positive in compression, .* gas force is -2\d\d\.\d \+- .* in bump .*; set --positive compression"
    for compression in (None, False):
        with pytest.raises(DataError, match=said):
            require_direction([read_test(path)], compression)
    require_direction([turned := read_test(path, compression=True)], True)
    np.testing.assert_allclose(turned.force, read_test(write(tmp_path / "b.csv")).force)


def test_a_wrong_option_is_refused(tmp_path):
    with pytest.raises(DataError, match=r"a: positive in extension, .*; set --positive extension"):
        require_direction([read_test(write(tmp_path / "a.csv"), compression=True)], True)


def test_files_of_both_directions_are_named(tmp_path):
    tests = [read_test(write(tmp_path / "a.csv")), read_test(write(tmp_path / "b.csv", signs=(-1, -1, -1)))]
    with pytest.raises(DataError, match=r"b: has the opposite direction to a, whose gas force is .* in b$"):
        require_direction(tests, None)


def test_damping_alone_decides_unless_the_direction_is_specified(tmp_path):
    test = read_test(write(tmp_path / "a.csv", gas=0.0, signs=(-1, -1, -1)))
    with pytest.raises(
        DataError, match="set --positive compression, or --positive extension if this damper damps bump"
    ):
        require_direction([test], None)
    require_direction([test], False)


@pytest.mark.parametrize(
    ("gas", "bump"), [(0.0, 1.0), (20.0, 1.0), (-20.0, 1.0), (-200.0, 0.6)], ids=["none", "weight", "tare", "offset"]
)
def test_what_decides_nothing_is_accepted(tmp_path, gas, bump):
    """No gas in a damper alike in both directions; the weight of a part; an offset against what the damping shows."""
    require_direction([read_test(write(tmp_path / "a.csv", gas=gas, bump=bump))], None)
