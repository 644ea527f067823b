"""International roughness index: published step matrices, a wave, random roads, segments and what is refused."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.validation import validated
from vehicle.errors import DataError
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.signals.analysis.roughness_index import COARSEST, roughness_index, step_matrices
from vehicle.signals.excitation.iso_road import IsoRoad

# ASTM E1926 and World Bank Technical Paper 46 print the matrices of two steps in seven digits.
PRINTED = {
    0.1: (
        [
            [0.9994014, 4.442351e-3, 2.188854e-4, 5.72179e-5],
            [-0.2570548, 0.975036, 7.966216e-3, 2.458427e-2],
            [3.960378e-3, 3.814527e-4, 0.9548048, 4.055587e-3],
            [1.687312, 0.1638951, -19.34264, 0.7948701],
        ],
        [3.793992e-4, 0.2490886, 4.123478e-2, 17.65532],
    ),
    0.25: (
        [
            [0.9966071, 1.091514e-2, -2.083274e-3, 3.190145e-4],
            [-0.5563044, 0.9438768, -0.8324718, 5.064701e-2],
            [2.153176e-2, 2.126763e-3, 0.7508714, 8.221888e-3],
            [3.335013, 0.3376467, -39.12762, 0.4347564],
        ],
        [5.476107e-3, 1.388776, 0.2275968, 35.79262],
    ),
}


@pytest.mark.parametrize("step", PRINTED)
def test_step_matrices_are_the_printed_ones(step):
    # They were computed in single precision: of a constant slope, 1 - S_00 - S_02 = p_0, the print misses 3e-7.
    for found, printed in zip(step_matrices(step), PRINTED[step], strict=True):
        np.testing.assert_allclose(found, np.array(printed), rtol=2e-5, atol=4e-7)


def test_index_by_the_printed_algorithm():
    """The loop of ASTM E1926 with its printed matrices, on a road of class C sampled every 250 mm."""
    height = IsoRoad(level=CLASSES["C"], seed=3, track=1.5).height(0.0, 0.25, 1600, "left", 2.0)
    matrix, drive = (np.array(each) for each in PRINTED[0.25])
    mean_slope = (height[44] - height[0]) / 11.0
    state, rates = np.array([mean_slope, 0.0, mean_slope, 0.0]), []
    for slope in np.diff(height) / 0.25:
        state = matrix @ state + drive * slope
        rates.append(abs(state[0] - state[2]))
    found = roughness_index(0.25, height)
    validated(
        "Roads and excitation", "IRI of a road of class C, 400 m", found.overall, 1e3 * np.mean(rates), rel=1e-6,
        unit="m/km", source="standard: ASTM E1926, its loop with its printed matrices",
    )  # fmt: skip
    np.testing.assert_allclose(found.segments[0], 1e3 * np.mean(rates[:400]), rtol=1e-6)
    assert found.edges.tolist() == [0.0, 100.0, 200.0, 300.0, 399.75]


def response(wavenumber, step):
    """|z_s' - z_u'| over the slope of a wave, from the equations of motion; with the average over 250 mm."""
    omega = 2j * np.pi * np.asarray(wavenumber) * 80.0 / 3.6
    body = (6.0 * omega + 63.3) / (omega**2 + 6.0 * omega + 63.3)
    wheel = 653.0 / (0.15 * omega**2 + 653.0 + omega**2 * body)
    samples = round(0.25 / step)
    averaged = np.sinc(np.asarray(wavenumber) * 0.25) / np.sinc(np.asarray(wavenumber) * 0.25 / samples)
    # The slope is a difference over a step, and constant over a step.
    return np.abs((body - 1.0) * wheel) * np.abs(averaged) * np.sinc(np.asarray(wavenumber) * step) ** 2


@pytest.mark.parametrize("wavelength", [1.25, 2.5, 15.0, 25.0])
def test_index_of_a_wave(wavelength):
    """A wave of amplitude a has slopes of 2 pi n a; the mean of |sin| is 2 / pi."""
    step, amplitude = 0.01, 2e-3
    position = np.arange(200_000) * step
    found = roughness_index(step, amplitude * np.sin(2.0 * np.pi * position / wavelength)).segments[5:19].mean()
    slope = 2.0 * np.pi / wavelength * amplitude
    validated(
        "Roads and excitation", f"IRI of a wave of {wavelength:g} m, amplitude 2 mm", found,
        1e3 * 2.0 / np.pi * slope * float(response(1.0 / wavelength, step)), rel=0.002, unit="m/km",
        source="closed form: response of the quarter car",
    )  # fmt: skip


def test_mean_index_of_the_roads_of_a_class():
    """Gaussian roads: E|x| = sqrt(2 / pi) sigma, with sigma from the density of the class; twelve roads of 4 km."""
    step = 0.05
    roads = [IsoRoad(level=CLASSES["B"], seed=seed, track=1.5) for seed in range(12)]
    found = [roughness_index(step, road.height(0.0, step, 80_000, "left", 10.0)).overall for road in roads]
    n = np.linspace(0.011, 10.0, 200_001)
    density = (2.0 * np.pi * n * response(n, step)) ** 2 * CLASSES["B"] * (n / 0.1) ** -2.0
    expected = 1e3 * np.sqrt(2.0 / np.pi * np.trapezoid(density, n))
    # Single roads scatter by 0.2 %; the mean of twelve is within three standard errors.
    assert np.mean(found) == pytest.approx(expected, abs=3.0 * np.std(found, ddof=1) / np.sqrt(12.0))
    validated(
        "Roads and excitation", "mean IRI of twelve roads of class B, 4 km", float(np.mean(found)), expected, rel=0.01,
        unit="m/km", source="closed form: density of the class times the response of the quarter car",
    )  # fmt: skip


def test_index_by_integration_over_a_corner():
    """A ramp, integrated by an adaptive method over the averaged slope of an own table."""
    step = 0.05
    height = np.clip(np.arange(801) * step - 15.0, 0.0, 1.0) * 0.02
    slope = (height[5:] - height[:-5]) / 0.25

    def rates(time, x):
        spring, damping = 63.3 * (x[2] - x[0]) + 6.0 * (x[3] - x[1]), 653.0
        grade = slope[min(int(time * 80.0 / 3.6 / step), slope.size - 1)]
        return [x[1], spring, x[3], (damping * (grade - x[2]) - spring) / 0.15]

    times = np.arange(1, slope.size + 1) * step / (80.0 / 3.6)
    solved = solve_ivp(rates, (0.0, times[-1]), np.zeros(4), t_eval=times, rtol=1e-8, atol=1e-12, max_step=2e-4)
    expected = 1e3 * np.mean(np.abs(solved.y[0] - solved.y[2]))
    assert roughness_index(step, height).overall == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("step", [0.05, 0.28, COARSEST])
def test_a_constant_grade_has_no_index(step):
    """11 m of start are no whole number of the coarse steps."""
    height = 0.05 * step * np.arange(round(100.0 / step))
    assert roughness_index(step, height).overall == pytest.approx(0.0, abs=1e-9)


def test_refused_profiles():
    with pytest.raises(DataError, match=r"the heights are 0.5 m apart but must be at most 0.3 m"):
        roughness_index(0.5, np.zeros(100))
    with pytest.raises(DataError, match=r"the road is 9.9 m long but must be at least 11 m"):
        roughness_index(0.1, np.zeros(100))
    with pytest.raises(DataError):
        roughness_index(0.1, np.array([0.0, np.nan] * 100))
    assert roughness_index(COARSEST, np.zeros(100)).overall == 0.0
