"""The core's transform, weighting, density and spline, which the page of a report uses, against NumPy and SciPy."""

import ctypes

import numpy as np
import pytest
import scipy

from vehicle.core.library import core
from vehicle.signals.analysis.fast_length import fast_length
from vehicle.signals.analysis.spline import CubicSpline
from vehicle.signals.analysis.weighting import WEIGHTINGS, weighted_record, weighting

RANDOM = np.random.default_rng(7)


class Transform(ctypes.Structure):
    """Record of spectra.h."""

    _fields_ = (("n", ctypes.c_int64), ("circle", ctypes.c_void_p), ("work", ctypes.c_void_p))

    def __init__(self, n: int) -> None:
        self.kept = np.zeros(2 * n), np.zeros(4 * n)
        super().__init__(n, *(array.ctypes.data for array in self.kept))
        core().core_circle(ctypes.byref(self))


def address(array: np.ndarray) -> ctypes.c_void_p:
    assert array.dtype == np.float64 and array.flags.c_contiguous
    return ctypes.c_void_p(array.ctypes.data)


# All radices first, alone, repeated and mixed; 40000 is the length of 30 s at 1 kHz.
@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 6, 8, 9, 10, 12, 15, 25, 27, 30, 32, 60, 125, 720, 4096, 40000])
def test_the_transform(n):
    transform, (x, y) = Transform(n), RANDOM.normal(size=(2, n))
    turns = np.exp(2j * np.pi * np.arange(n) / n)
    np.testing.assert_allclose(transform.kept[0], np.concatenate([turns.real, turns.imag]), rtol=0.0, atol=2e-15)
    expected = np.fft.fft(x + 1j * y)
    core().core_transform(ctypes.byref(transform), address(x), address(y))
    np.testing.assert_allclose(x + 1j * y, expected, rtol=0.0, atol=2e-15 * np.max(np.abs(expected)))


@pytest.mark.parametrize("name", WEIGHTINGS)
@pytest.mark.parametrize("samples", [3000, 3**9])
def test_a_weighting(name, samples):
    """Two records at once, as in Python, of an even and an odd length: half the sampling rate is a line of its own."""
    curve, step = weighting(name), 2e-3
    records, sections = RANDOM.normal(size=(2, samples)).cumsum(axis=1), curve.sections
    if samples == 3000:
        expected, n = weighted_record(step, records, name), fast_length(samples + int(np.ceil(curve.decay_s / step)))
    else:
        factors, n = curve.transfer_function(np.fft.rfftfreq(samples, step)), samples
        expected = np.fft.irfft(factors * np.fft.rfft(records), n)
    x, y = np.hstack([records, np.zeros((2, n - samples))])
    transform, pointers = Transform(n), (address(x), address(y), ctypes.c_double(step), address(sections))
    core().core_weigh(ctypes.byref(transform), *pointers, ctypes.c_int64(len(sections)))
    tolerance = 1e-13 * np.max(np.abs(expected))
    np.testing.assert_allclose([x[:samples], y[:samples]], expected, rtol=0.0, atol=tolerance)


@pytest.mark.parametrize("pieces", [1, 2, 5])
def test_a_density_of_a_column(pieces):
    n, columns = 240, RANDOM.normal(size=(120 * (pieces + 1) + 119, 3)) + 4.0
    density, transform = np.zeros(n // 2 + 1), Transform(n)
    sizes = (ctypes.c_int64(len(columns)), ctypes.c_int64(3), ctypes.c_double(1e-3), address(density))
    core().core_density(ctypes.byref(transform), ctypes.c_void_p(columns.ctypes.data + 8), *sizes)
    _, expected = scipy.signal.welch(columns[:, 1], 1000.0, nperseg=n)
    np.testing.assert_allclose(density, expected, rtol=1e-11, atol=1e-13 * np.max(expected))


@pytest.mark.parametrize("n", [4, 5, 200])
def test_the_derivatives_of_a_spline(n):
    z, found, upper = RANDOM.normal(size=n).cumsum(), np.zeros(n), np.zeros(n)
    core().core_spline(ctypes.c_int64(n), address(z), ctypes.c_double(0.25), address(found), address(upper))
    x = 0.25 * np.arange(n)
    np.testing.assert_allclose(found, CubicSpline(x, z)(x, 1), rtol=0.0, atol=1e-12 * np.max(np.abs(found)))
