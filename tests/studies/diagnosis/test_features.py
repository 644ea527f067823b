"""Features: densities of known noise, coherencies of related channels."""

import numpy as np
import pytest

from vehicle.errors import DataError
from vehicle.studies.diagnosis.features import NARROW, WIDE, Bands, related_pairs, rows_of_points


def test_white_noise_has_its_density_in_all_bands_and_equal_channels_the_coherency_one():
    rate, rng = 250.0, np.random.default_rng(3)
    noise = 0.2 * rng.standard_normal((2, int(400 * rate)))
    bands = Bands.of(rate, 40.0)
    features = bands.features([np.vstack([noise, noise[:1]])], [(0, 1), (0, 2)])
    # One-sided: the variance over half of the rate. 200 windows: bands of one line scatter by 7 %.
    density = np.exp(features[: 3 * NARROW])
    assert density == pytest.approx(0.04 / 125.0, rel=0.25)
    assert density.mean() == pytest.approx(0.04 / 125.0, rel=0.02)
    real, imaginary = features[3 * NARROW :].reshape(2, 2, WIDE)
    assert np.abs(real[0]).max() < 0.3
    assert real[1] == pytest.approx(1.0)
    assert imaginary[1] == pytest.approx(0.0, abs=1e-12)


def test_two_parts_count_as_their_windows():
    rate, rng = 250.0, np.random.default_rng(4)
    noise = rng.standard_normal((1, int(40 * rate)))
    bands = Bands.of(rate, 40.0)
    # The same part twice: the same mean.
    assert bands.features([noise, noise], []) == pytest.approx(bands.features([noise], []))


def test_pairs_are_those_of_a_point_or_a_wheel():
    channels = ["seat_rail_acc_x", "seat_rail_acc_z", "knuckle_fl_acc_z", "damper_top_fl_acc_z", "knuckle_fr_acc_z"]
    assert related_pairs(channels) == [(0, 1), (2, 3)]


def test_a_channel_at_rest_is_refused():
    with pytest.raises(DataError, match="at rest"):
        Bands.of(250.0, 40.0).features([np.zeros((1, 5000))], [])


def test_a_free_point_has_the_same_features_at_any_angle():
    rate, rng = 250.0, np.random.default_rng(6)
    samples = np.array([[1.0], [0.4], [2.0]]) * rng.standard_normal((3, int(40 * rate)))
    samples[0] += 0.3 * samples[2]
    bands, axes = Bands.of(rate, 40.0), [(0, 1, 2)]
    plain = bands.features([samples], [(0, 1), (0, 2), (1, 2)], axes)
    # The larger motion is the first axis.
    assert plain[:NARROW].mean() > plain[NARROW : 2 * NARROW].mean() + 1.0
    for angle in (0.4, 2.0, np.pi):
        turn = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
        turned = bands.features([turn @ samples], [(0, 1), (0, 2), (1, 2)], axes)
        assert turned == pytest.approx(plain, abs=1e-9)
    assert bands.features([samples[[1, 0, 2]]], [(0, 1)]) != pytest.approx(bands.features([samples], [(0, 1)]))
    assert rows_of_points(["a_acc_z", "a_acc_x", "a_acc_y", "b_acc_z"], ["a", "b"]) == [(1, 2, 0)]
