"""Estimate of the products of rotations and vertical accelerations that the reduced engine leaves out."""

from __future__ import annotations

import numpy as np
import pytest

from vehicle.engines.reduced.finite_rotation import LOSS, lost_share, rotation_notices, rotation_products

HARMONIC = np.sin(2.0 * np.pi * np.arange(1000) / 40.0)


def test_products_of_a_harmonic_motion() -> None:
    # theta(t) a(t) = 0.1 A sin^2, with the mean square 3/8.
    assert rotation_products(0.1, 4.0 * HARMONIC) == pytest.approx(0.1 * 4.0 * np.sqrt(3.0 / 8.0), rel=1e-12)
    assert rotation_products(0.1, np.zeros(5)) == 0.0


def test_products_of_a_short_event_follow_its_share_of_the_record() -> None:
    event = np.concatenate([HARMONIC, np.zeros(3 * HARMONIC.size)])
    assert rotation_products(0.1, event) == pytest.approx(0.5 * rotation_products(0.1, HARMONIC), rel=1e-12)


def test_squares_of_linear_motion_and_products_add() -> None:
    assert lost_share(np.full(7, 3.0), 4.0) == pytest.approx(1.0 - 3.0 / 5.0, rel=1e-12)
    assert lost_share(np.zeros(7), 0.0) == 0.0


def test_a_notice_names_channels_by_their_loss() -> None:
    vertical, angles = 10.0 * HARMONIC, {"arm_fr": 0.1, "body": 0.5, "arm_rr": 0.01}
    products = rotation_products(0.1, vertical)
    rms = float(np.sqrt(np.mean(HARMONIC**2)))
    channels = {
        "knuckle_fr_acc_x": 0.5 * products / rms * HARMONIC,
        "knuckle_fr_acc_y": products / rms * HARMONIC,
        "knuckle_fr_acc_z": vertical,
        "knuckle_rr_acc_y": products / rms * HARMONIC,
        "knuckle_rr_acc_z": vertical,
        "seat_acc_x": 0.01 * HARMONIC,
        "seat_acc_z": vertical,
    }
    (notice,) = rotation_notices(channels, angles, ("fr", "rr"))
    assert "by roughly: knuckle_fr_acc_x by 55 %, knuckle_fr_acc_y by 29 %; parts" in notice
    assert "up to 0.100 rad" in notice
    assert "use the MuJoCo engine" in notice


def test_a_notice_begins_at_the_limit() -> None:
    vertical = 10.0 * HARMONIC
    for factor, count in ((1.01, 0), (0.99, 1)):
        # 1 - 1/sqrt(1 + e^2) = LOSS
        level = factor * rotation_products(0.1, vertical) / np.sqrt((1.0 - LOSS) ** -2 - 1.0)
        channels = {"knuckle_fr_acc_y": np.full(1000, level), "knuckle_fr_acc_z": vertical}
        assert len(rotation_notices(channels, {"arm_fr": 0.1}, ("fr",))) == count


def test_a_long_list_of_channels_is_counted() -> None:
    channels = {f"point{k}_fr_acc_{axis}": HARMONIC for k in range(3) for axis in "xyz"}
    (notice,) = rotation_notices(channels, {"arm_fr": 1.0}, ("fr",))
    assert "and 2 more; parts" in notice
