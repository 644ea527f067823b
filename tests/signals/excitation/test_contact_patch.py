"""The contact patch averages a road over its length."""

from dataclasses import replace

import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import ConfigurationError
from vehicle.signals.excitation.measured_road import MeasuredRoad
from vehicle.signals.excitation.road_drive import CONTACT_PATCH, RoadDrive

PATCH = 0.1


def test_a_measured_wave_is_lower_by_its_sinc() -> None:
    """sin(2 pi n x) over a length a is sinc(n a) of it."""
    distance, wave = np.arange(0.0, 20.0, 0.002), 4.0
    height = np.sin(2.0 * np.pi * wave * distance)
    road = MeasuredRoad(distance=distance, right=height, left=0.0 * height, source="wave", patch=PATCH)
    found = road.contact(5.0, 0.01, 1000, "right", 50.0)[0]
    place = 5.0 + 0.01 * np.arange(1000)
    validated(
        "Roads and excitation", "a contact patch on a measured wave of 0.25 m", found,
        np.sinc(wave * PATCH) * np.sin(2.0 * np.pi * wave * place), abs=1e-7, unit="m", source="closed form: sinc(n a)",
    )  # fmt: skip
    # Ahead of its first place it is a plane, which half a patch reaches into.
    whole = replace(road, left=1.0 + 0.3 * distance)
    starting = whole.contact(-0.1, 0.05, 5, "left", 50.0)[0]
    assert starting == pytest.approx([0.0, 0.0, 0.3 * 0.05**2 / 2.0 / PATCH, 0.3 * 0.05, 0.3 * 0.1], abs=1e-12)


@pytest.mark.parametrize("corners", [False, True])
def test_the_mean_over_the_patch_is_that_of_the_road_itself(corners: bool) -> None:
    """Against a sum over many places in the patch, on samples with jitter and on the corners of a cleat."""
    if corners:
        distance, height = np.array([0.0, 1.0, 1.001, 1.05, 1.051, 3.0]), np.array([0.0, 0.0, 0.02, 0.02, 0.0, 0.0])
    else:
        generator = np.random.default_rng(3)
        distance = np.linspace(0.0, 3.0, 121) + np.append(0.0, 0.004 * generator.random(120))
        height = 0.01 * generator.standard_normal(121)
    road = MeasuredRoad(distance=distance, right=height, left=0.0 * height, source="road", patch=PATCH)
    assert road.sampled != corners
    assert ("straight" in road.words) == corners
    # Middles of equal parts: the error is 1e-5 of an edge of the cleat, where one part of 10 000 may lie on it.
    place, parts = np.linspace(0.0, 2.9, 59), PATCH * ((np.arange(10_000) + 0.5) / 10_000 - 0.5)
    point = replace(road, patch=0.0)
    wanted = np.array([np.mean(point.contact_at(at + parts, "right")[0]) for at in place])
    validated(
        "Roads and excitation",
        f"mean height under a contact patch, {'corners of a cleat' if corners else 'random samples'}",
        road.contact_at(place, "right")[0], wanted, abs=1e-6, unit="m",
        source="second derivation: sum over 10 000 places",
    )  # fmt: skip
    if corners:
        np.testing.assert_allclose(point.contact_at(np.linspace(0.0, 3.0, 501), "right")[0].max(), 0.02)
        # All of the cleat under the patch: its area over the length of the patch.
        assert road.contact_at(np.array([1.0255]), "right")[0] == pytest.approx(0.02 * 0.05 / PATCH)


def test_a_drive_has_a_patch_and_may_do_without() -> None:
    drive = RoadDrive(road="B", speed=80.0, wheels=(("fr", 0.0, "right"),), track=1.5, duration=3.0)
    assert drive.summary(drive.signal())["contact_patch_m"] == CONTACT_PATCH
    point = replace(drive, patch=0.0)
    assert np.std(point.signal().displacement["fr"]) > np.std(drive.signal().displacement["fr"])
    with pytest.raises(ConfigurationError, match="contact patch"):
        replace(drive, patch=2.0).signal()
