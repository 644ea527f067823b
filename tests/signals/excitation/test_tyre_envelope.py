"""Two elliptical cams on a road of straight lines."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.signals.excitation.iso_road import IsoRoad
from vehicle.signals.excitation.tyre_envelope import CAM_SETS, CAMS, TyreEnvelope

TYRE = TyreEnvelope.of(CAMS, radius=0.3075, patch=0.1)
A, B, C, S = TYRE.half_length, TYRE.half_height, TYRE.order, TYRE.distance


def edge(offset):
    """Height of the lower edge of a cam above its lowest point [m]; infinite outside the cam."""
    share = np.abs(offset / A)
    return np.where(share <= 1.0, B - B * np.maximum(1.0 - share**C, 0.0) ** (1.0 / C), np.inf)


def test_a_cam_on_a_step_touches_its_upper_edge() -> None:
    x, z, height = np.array([0.0, 10.0, 10.0, 20.0]), np.array([0.0, 0.0, 0.03, 0.03]), 0.03
    at = np.linspace(9.0, 11.0, 2001)
    wanted = np.where(at >= 10.0, height, np.maximum(0.0, height - edge(10.0 - at)))
    validated(
        "Roads and excitation", "cam height on a step of 30 mm", TYRE.cam_heights(x, z, at), wanted, abs=1e-12,
        unit="m", source="closed form: edge of the ellipse",
    )  # fmt: skip
    # Down a step it leaves the edge as it came.
    np.testing.assert_allclose(TYRE.cam_heights(x, z[::-1], 20.0 - at), wanted, atol=1e-12)


def test_a_cam_on_a_ramp_is_parallel_to_it() -> None:
    """On a long ramp of slope m: Z = m X + b (1 + (m a / b)^(c/(c-1)))^((c-1)/c) - b, the support of the ellipse."""
    slope, at = 0.1, np.linspace(3.0, 6.0, 301)
    support = B * (1.0 + (slope * A / B) ** (C / (C - 1.0))) ** ((C - 1.0) / C) - B
    x, z = np.array([0.0, 1.0, 8.0, 9.0]), np.array([0.0, 0.0, 0.7, 0.7])
    validated(
        "Roads and excitation", "cam height on a ramp of 10 %", TYRE.cam_heights(x, z, at),
        slope * (at - 1.0) + support, abs=1e-12, unit="m", source="closed form: support function of the superellipse",
    )  # fmt: skip
    height, tangent = TYRE.height_and_slope(x, z, at)
    np.testing.assert_allclose(tangent, slope, atol=1e-12)
    np.testing.assert_allclose(height, slope * (at - 1.0) + support, atol=1e-12)


def test_a_tyre_on_a_cleat_meets_its_two_edges() -> None:
    x, z = np.array([0.0, 5.0, 5.0, 5.05, 5.05, 10.0]), np.array([0.0, 0.0, 0.02, 0.02, 0.0, 0.0])
    at = np.linspace(4.0, 6.0, 1001)

    def cam(middle):
        over = (middle >= 5.0) & (middle <= 5.05)
        beside = np.minimum(edge(5.0 - middle), edge(5.05 - middle))
        return np.where(over, 0.02, np.maximum(0.0, 0.02 - beside))

    height, slope = TYRE.height_and_slope(x, z, at)
    validated(
        "Roads and excitation", "effective height on a cleat of 20 x 50 mm", height,
        0.5 * (cam(at + 0.5 * S) + cam(at - 0.5 * S)), abs=1e-12, unit="m", source="closed form: edge of the ellipse",
    )  # fmt: skip
    np.testing.assert_allclose(slope, (cam(at + 0.5 * S) - cam(at - 0.5 * S)) / S, atol=1e-11)
    # The tyre is lifted before the cleat is under its middle, and over a longer way than the cleat.
    assert np.ptp(at[height > 1e-3]) > 3.0 * 0.05


@pytest.mark.parametrize("name", CAM_SETS)
def test_heights_equal_a_search_along_every_segment(name) -> None:
    """On each segment, road minus edge of the cam is concave: thirds that hold the maximum, 80 times."""
    tyre = TyreEnvelope.of(CAM_SETS[name], radius=0.3, patch=0.12)
    generator = np.random.default_rng(2)
    x = np.sort(generator.uniform(0.0, 3.0, 90))
    z = 0.02 * generator.standard_normal(90) + 0.1 * np.sin(3.0 * x)
    at = np.linspace(0.7, 2.3, 120)
    low = np.maximum(x[:-1], at[:, None] - tyre.half_length)
    high = np.minimum(x[1:], at[:, None] + tyre.half_length)
    inside = high > low
    low, high = np.where(inside, low, 0.0), np.where(inside, high, 0.0)

    def value(place):
        road = z[:-1] + np.diff(z) * (place - x[:-1]) / np.diff(x)
        share = np.minimum(np.abs(place - at[:, None]) / tyre.half_length, 1.0)
        return road + tyre.half_height * (1.0 - share**tyre.order) ** (1.0 / tyre.order) - tyre.half_height

    ends = np.maximum(value(low), value(high))
    for _ in range(80):
        left, right = low + (high - low) / 3.0, high - (high - low) / 3.0
        rising = value(left) < value(right)
        low, high = np.where(rising, left, low), np.where(rising, high, right)
    wanted = np.max(np.where(inside, np.maximum(ends, value(0.5 * (low + high))), -np.inf), axis=1)
    validated(
        "Roads and excitation", f"cam height on 90 random corners, {name}", tyre.cam_heights(x, z, at), wanted,
        abs=1e-12, unit="m", source="second derivation: search along every segment",
    )  # fmt: skip


@pytest.mark.parametrize(("level", "name"), [(16e-6, "A"), (64e-6, "B")])
def test_on_a_smooth_class_the_tyre_is_a_linear_filter(level, name) -> None:
    """Both cams move with the road: cos(pi n s) of its height, sin(pi n s)/(pi n s) of its slope."""
    step, points = 0.005, 40_000
    road = IsoRoad(level=level, seed=3, track=1.5).height(0.0, step, points, "right", 1e3)
    x, inner = step * np.arange(points, dtype=np.float64), slice(200, -200)
    wavenumber = np.fft.rfftfreq(points, step)
    spectrum = np.fft.rfft(road)
    filtered = np.fft.irfft(spectrum * np.cos(np.pi * wavenumber * S), points)[inner]
    height, slope = TYRE.height_and_slope(x, road, x[inner])
    validated(
        "Roads and excitation", f"RMS of the effective height, class {name}, against the filter cos(pi n s)",
        float(np.std(height - filtered) / np.std(filtered)), 0.0, abs=1e-3, unit="-",
        source="second derivation: linear filter of two cams",
    )  # fmt: skip
    tangent = np.fft.irfft(spectrum * 2j * np.pi * wavenumber * np.sinc(wavenumber * S), points)[inner]
    assert np.std(slope - tangent) < 0.05 * np.std(tangent)


def test_samples_at_5_mm_are_enough_for_class_c() -> None:
    road, points = IsoRoad(level=256e-6, seed=1, track=1.5), 8000
    coarse, fine = (road.height(0.0, 0.005 / k, k * points, "right", 1e3) for k in (1, 8))
    at = np.linspace(1.0, 39.0, 4000)
    found = TYRE.height_and_slope(0.005 * np.arange(points, dtype=np.float64), coarse, at)[0]
    wanted = TYRE.height_and_slope(0.005 / 8 * np.arange(8 * points, dtype=np.float64), fine, at)[0]
    validated(
        "Roads and excitation", "RMS error of the effective height by samples at 5 mm, class C",
        float(np.sqrt(np.mean((found - wanted) ** 2))), 0.0, abs=2e-6, unit="m",
        source="second derivation: samples at 0.6 mm",
    )  # fmt: skip
