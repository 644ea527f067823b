"""Own forms of a few functions of SciPy whose import takes longer than they: the same numbers."""

import numpy as np
import pytest
import scipy.fft
import scipy.interpolate
import scipy.signal

from vehicle.signals.analysis.fast_length import fast_length
from vehicle.signals.analysis.input_floor import BANDWIDTH, TAPER_SAMPLES, TAPERS, slepian_tapers
from vehicle.signals.analysis.spline import CubicSpline
from vehicle.signals.analysis.tops import prominent_tops
from vehicle.signals.excitation.plausibility import band_limited_acceleration

RANDOM = np.random.default_rng(1)


@pytest.mark.parametrize("begin", [0.0, 3600.0])
def test_a_cubic_spline(begin):
    """At 3600 s the steps of the time stamps differ by 1e-9 of a step."""
    x, y = begin + 1e-3 * np.arange(500), RANDOM.normal(size=500).cumsum()
    at = np.concatenate([x, np.sort(RANDOM.uniform(x[0] - 1e-3, x[-1] + 1e-3, 5000))])
    ours, theirs = CubicSpline(x, y), scipy.interpolate.CubicSpline(x, y)
    for order in range(3):
        expected = theirs(at, order)
        np.testing.assert_allclose(ours(at, order), expected, rtol=0.0, atol=1e-13 * np.max(np.abs(expected)))


def test_four_points_are_one_cubic():
    x = np.array([0.0, 0.5, 2.0, 3.0])
    assert CubicSpline(x, x**3 - x)(1.3) == pytest.approx(1.3**3 - 1.3, rel=1e-14)


def test_prominent_tops():
    """Rounded records have plateaus and equal bases."""
    for trial in range(500):
        values = np.round(RANDOM.normal(size=RANDOM.integers(1, 60)), trial % 4)
        prominence = (0.0, 0.5, 1.0)[trial % 3]
        expected, found = scipy.signal.find_peaks(values, prominence=prominence)
        tops = prominent_tops(values, prominence)
        assert [at for at, _, _ in tops] == expected.tolist()
        assert [rise for _, rise, _ in tops] == found["prominences"].tolist()
        assert [list(bases) for *_, bases in tops] == np.column_stack(
            [found["left_bases"], found["right_bases"]]
        ).tolist()


def test_slepian_tapers():
    theirs, ours = scipy.signal.windows.dpss(TAPER_SAMPLES, BANDWIDTH, TAPERS), slepian_tapers()
    assert ours.shape == theirs.shape == (TAPERS, TAPER_SAMPLES)
    np.testing.assert_allclose(np.abs(ours), np.abs(theirs), rtol=0.0, atol=1e-13)


def test_fast_lengths():
    assert [fast_length(n) for n in range(1, 3000)] == [scipy.fft.next_fast_len(n, real=True) for n in range(1, 3000)]


def test_the_low_pass_is_a_butterworth_filter_in_both_directions():
    """Beyond the ringing at the ends, where the record continues in another way, it agrees to rounding."""
    z = 1e-3 * RANDOM.normal(size=5000).cumsum() + 0.7
    sections = scipy.signal.butter(4, 0.2, output="sos")
    expected = np.diff(scipy.signal.sosfiltfilt(sections, z), 2) / 1e-6
    found = band_limited_acceleration(z, 1e-3)[1:-1]
    scale = np.max(np.abs(expected))
    np.testing.assert_allclose(found[300:-300], expected[300:-300], rtol=0.0, atol=1e-10 * scale)
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=0.1 * scale)
