"""Criteria of agreement of FRFs: by hand, by their bounds, on a resonance that was moved."""

import numpy as np
import pytest

from vehicle.signals.analysis.frf_agreement import band_errors, csac, csf, frac, scaled_frac

LINES = np.arange(40, 800) / 20.0


def resonance(frequency, damping=0.05, lines=LINES):
    ratio = lines / frequency
    return 1.0 / (1.0 - ratio**2 + 2j * damping * ratio)


def test_a_constant_factor_leaves_the_shape():
    truth = resonance(10.0)
    other = (2.0 - 1.0j) * truth
    assert frac(truth, other) == pytest.approx(1.0)
    np.testing.assert_allclose(csac([truth, 2.0 * truth], [other, 2.0 * other]), 1.0)
    np.testing.assert_allclose(csf([truth], [3.0 * truth]), 2.0 * 3.0 / (1.0 + 9.0))


def test_by_hand_on_two_lines():
    measured, simulated = np.array([1.0 + 1.0j, 2.0]), np.array([1.0, 1.0j])
    # sum H_m H_s* = 1 + j - 2j: |1 - j|^2 = 2; powers 6 and 2.
    assert frac(measured, simulated) == pytest.approx(2.0 / 12.0)
    # Two places at one line: H_m^H H_s = 1 - j + 2j, |1 + j|^2 = 2.
    assert csac(measured[:, None], simulated[:, None])[0] == pytest.approx(2.0 / 12.0)
    assert csf(measured[:, None], simulated[:, None])[0] == pytest.approx(2.0 * np.sqrt(2.0) / 8.0)


def test_undefined_lines_do_not_count():
    truth = resonance(10.0)
    other = truth.copy()
    other[:30] = np.nan
    assert frac(truth, other) == pytest.approx(1.0)
    assert np.isnan(csac([truth], [other])[:30]).all() and np.isnan(csf([truth], [other])[:30]).all()
    assert np.isnan(frac(truth, np.full(LINES.size, np.nan)))


@pytest.mark.parametrize("factor", [0.94, 1.0, 1.037])
def test_a_moved_resonance_is_found_by_its_factor(factor):
    measured, simulated = resonance(15.0 * factor), resonance(15.0)
    best, scale = scaled_frac(LINES, measured, simulated)
    assert scale == pytest.approx(factor, rel=2e-4) and best > 0.9999
    assert best >= frac(measured, simulated) and (factor == 1.0 or frac(measured, simulated) < 0.9)


def test_band_errors_equal_the_imposed_errors():
    truth = resonance(10.0)
    other = truth * np.where(LINES < 10.0, 1.1 * np.exp(0.2j), 0.9)
    low, high = band_errors(LINES, truth, other, np.full(LINES.size, 0.5), [(2.0, 10.0), (10.0, 40.0)])
    assert low.magnitude_db == pytest.approx(20.0 * np.log10(1.1)) and low.phase_deg == pytest.approx(np.degrees(0.2))
    assert low.error == pytest.approx(np.hypot(np.log(1.1), 0.2)) and (low.lines, low.weight) == (160, 0.5)
    assert high.magnitude_db == pytest.approx(20.0 * np.log10(0.9)) and high.phase_deg == pytest.approx(0.0, abs=1e-9)
    assert high.magnitude_rms_db == pytest.approx(-high.magnitude_db)


def test_lines_count_by_their_coherence():
    truth = np.ones(20, dtype=complex)
    other = np.where(np.arange(20) < 10, 2.0, 1.0) + 0j
    weight = np.where(np.arange(20) < 10, 0.25, 0.75)
    (band,) = band_errors(np.arange(20.0), truth, other, weight, [(0.0, 20.0)])
    assert band.error == pytest.approx(np.sqrt(0.25) * np.log(2.0))
    assert band_errors(np.arange(20.0), truth, other, np.where(np.arange(20) < 2, 1.0, 0.0), [(0.0, 20.0)]) == ()
