"""Dead, copied and exchanged sensors of a damper test, and wrong units, each with one sentence and the option."""

import warnings

import numpy as np
import pytest

from vehicle.errors import DataError
from vehicle.studies.dampers.damper_test import read_test

T = np.arange(2000) / 500.0
X, V = 10.0 * np.sin(8.0 * np.pi * T), 80.0 * np.pi * np.cos(8.0 * np.pi * T)  # [mm], [mm/s]
F = 1.5 * V + 60.0 * np.tanh(V / 0.1) - 150.0  # [N]
NOISE = np.random.default_rng(0).integers(-1, 2, T.size)
HEAD = "time [s],displacement [mm],velocity [mm/s],force [N]"


def read(folder, x=X, v=V, force=F, head=HEAD):
    columns = [T, x, force] if v is None else [T, x, v, force]
    np.savetxt(folder / "a.csv", np.column_stack(columns), delimiter=",", header=head, comments="", fmt="%.7g")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return read_test(folder / "a.csv")


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"x": 0.3 + 0.0 * T}, "the displacement, channel 'displacement', is constant, 0.3 mm: .*displacement=NAME"),
        ({"x": 0.0 * T}, "the displacement, channel 'displacement', is constant, 0 mm"),
        ({"x": 0.0 * T, "v": None, "head": "time [s],displacement [mm],force [N]"}, "the displacement, .* is constant"),
        ({"force": 5.0 + 0.0 * T}, "the force, channel 'force', is constant, 5 N: .* --channel force=NAME"),
        ({"x": 0.3 + 1e-3 * NOISE}, "'displacement' and 'velocity' belong to different motions"),
        ({"force": 5.0 + 0.1 * NOISE}, "the force, channel 'force', does not follow the velocity"),
        ({"force": X}, "the channels 'displacement' and 'force' contain the same values"),
        ({"force": 1e-3 * V}, "the channels 'force' and 'velocity' contain the same values"),
        ({"v": X}, "the channels 'displacement' and 'velocity' contain the same values"),
        ({"force": T}, "the channels 'time' and 'force' contain the same values, so they cannot be time and force"),
        ({"force": 40.0 * X + NOISE}, "the force, channel 'force', does not follow the velocity"),
        ({"force": 1e-3 * F}, "if its values are in kN, set --unit force=kN"),
        ({"force": 1e3 * F}, "the force is 587000 N but must be at most 100000 N"),
        ({"x": 1e3 * X, "v": 1e3 * V}, "the stroke is 20 m but must be at most 1 m"),
        ({"v": 1e-3 * V}, "the measured velocity is 0.001 times the derivative of the displacement; .*velocity=m/s"),
        ({"x": 10.0 * T, "v": 10.0 + 0.0 * T}, "the damper moves in one direction only, at 10 to 10 mm/s"),
    ],
)  # fmt: skip
def test_a_faulty_channel_is_named(tmp_path, changed, said):
    with pytest.raises(DataError, match=said):
        read(tmp_path, **changed)


@pytest.mark.parametrize("value", [0.3, 0.0])
def test_a_dead_velocity_is_replaced(tmp_path, value):
    test = read(tmp_path, v=value + 0.0 * T)
    assert test.notices[0].startswith(f"the velocity, channel 'velocity', is constant, {value:g} mm/s: the sensor is")
    assert np.max(np.abs(test.velocity - 1e-3 * V)[5:-5]) < 1e-4 * 0.251


def test_an_opposite_velocity_is_inverted(tmp_path):
    test = read(tmp_path, v=-V)
    assert test.notices[0].endswith("have opposite directions; the velocity is inverted")
    np.testing.assert_allclose(test.velocity, 1e-3 * V, rtol=1e-5)
