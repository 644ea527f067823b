import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.peaks import resonance_peaks

LINES = np.arange(1.0, 50.01, 0.25)


def receptance(frequency, natural, damping):
    ratio = frequency / natural
    return 1.0 / np.abs(1 - ratio**2 + 2j * damping * ratio)


def test_a_resonance_between_two_lines_is_found_at_its_closed_form():
    magnitude = receptance(LINES, 28.1, 0.05)
    coherence = np.linspace(0.5, 1.0, LINES.size)
    (peak,) = resonance_peaks(LINES, magnitude, coherence)
    # maximum of 1 / |1 - r^2 + 2 i zeta r| at r = sqrt(1 - 2 zeta^2), height 1 / (2 zeta sqrt(1 - zeta^2)); the line
    # distance is 0.09 of the half-power bandwidth, the parabola is good to (0.09)^3 of it
    validated(
        "FRF estimation and spectra", "frequency of a resonance between two lines", peak.frequency_hz,
        28.1 * np.sqrt(1 - 2 * 0.05**2), abs=0.002, unit="Hz", source="closed form: f sqrt(1 - 2 zeta^2)",
    )  # fmt: skip
    validated(
        "FRF estimation and spectra", "height of a resonance between two lines", peak.magnitude,
        1 / (0.1 * np.sqrt(1 - 0.05**2)), rel=1e-4, source="closed form: 1 / (2 zeta sqrt(1 - zeta^2))",
    )  # fmt: skip
    assert peak.coherence == pytest.approx(np.interp(28.0, LINES, coherence))


def test_a_parabola_in_log_magnitude_is_found_exactly_on_any_lines():
    lines = np.array([1.0, 2.0, 3.5, 4.0, 6.0, 7.0, 9.0])
    (peak,) = resonance_peaks(lines, np.exp(2.0 - 0.3 * (lines - 4.3) ** 2))
    assert peak.frequency_hz == pytest.approx(4.3, rel=1e-12)
    assert peak.magnitude == pytest.approx(np.exp(2.0), rel=1e-12)
    assert peak.coherence is None


def test_peaks_are_sorted_by_frequency_and_ripple_is_left_out():
    magnitude = receptance(LINES, 6.0, 0.1) + 0.5 * receptance(LINES, 28.0, 0.02)
    ripple = 1.0 + 0.04 * np.cos(np.pi * np.arange(LINES.size))  # 0.7 dB from line to line
    assert [round(p.frequency_hz) for p in resonance_peaks(LINES, magnitude)] == [6, 28]
    assert [round(p.frequency_hz) for p in resonance_peaks(LINES, magnitude * ripple)] == [6, 28]
    assert len(resonance_peaks(LINES, magnitude * ripple, prominence_db=0.1)) > 10


def test_prominence_is_the_height_above_the_higher_foot():
    lines = np.arange(5.0)
    magnitude = 10.0 ** (np.array([0.0, 3.0, 1.0, 6.0, -2.0]) / 20.0)
    first, second = resonance_peaks(lines, magnitude, prominence_db=1.5)
    assert first.prominence_db == pytest.approx(2.0)
    assert second.prominence_db == pytest.approx(6.0)
    assert [p.prominence_db for p in resonance_peaks(lines, magnitude, prominence_db=2.5)] == pytest.approx([6.0])


def test_a_peak_rises_above_its_random_error():
    magnitude = receptance(LINES, 28.1, 0.05)
    (peak,) = resonance_peaks(LINES, magnitude, None, 0.05 * magnitude)
    assert peak.random_error == pytest.approx(0.05 * receptance(28.0, 28.1, 0.05))
    # A top of 10 above a foot of 0.5 and less, against 3.5 errors of 9.
    assert resonance_peaks(LINES, magnitude, None, 0.9 * magnitude) == ()


def test_a_maximum_without_coherence_is_no_resonance():
    magnitude = receptance(LINES, 28.1, 0.05)
    assert resonance_peaks(LINES, magnitude, np.full(LINES.size, 0.25)) == ()
    assert len(resonance_peaks(LINES, magnitude, np.full(LINES.size, 0.35))) == 1


def test_undefined_lines_split_the_search():
    magnitude = receptance(LINES, 10.0, 0.05)
    magnitude[LINES > 9.9] = np.nan
    # the maximum next to the gap is an edge, not a peak
    assert resonance_peaks(LINES, magnitude) == ()
    magnitude = receptance(LINES, 10.0, 0.05)
    magnitude[LINES > 20.0] = np.nan
    assert len(resonance_peaks(LINES, magnitude)) == 1
    assert resonance_peaks(LINES, np.full(LINES.size, np.nan)) == ()


def test_a_flat_top_is_one_peak():
    magnitude = np.array([1.0, 2.0, 2.0, 2.0, 1.0])
    (peak,) = resonance_peaks(np.arange(5.0), magnitude)
    assert [peak.frequency_hz, peak.magnitude] == pytest.approx([2.0, 2.0])


@pytest.mark.parametrize(
    ("frequency", "magnitude", "coherence", "prominence", "message"),
    [
        ([1.0, 2.0], [1.0], None, 1.0, r"\(2,\) for frequency"),
        ([1.0, 2.0], [1.0, 1.0], [1.0], 1.0, r"\(1,\)"),
        ([2.0, 1.0], [1.0, 1.0], None, 1.0, "frequency must .* increase"),
        ([1.0, 2.0], [0.0, 1.0], None, 1.0, "magnitude must be above 0"),
        ([1.0, 2.0], [np.inf, 1.0], None, 1.0, "magnitude must be above 0"),
        ([1.0, 2.0], [1.0, 1.0], None, 0, "prominence: found 0 dB"),
    ],
)
def test_bad_arrays_are_refused(frequency, magnitude, coherence, prominence, message):
    with pytest.raises((DataError, ConfigurationError), match=message) as caught:
        resonance_peaks(frequency, magnitude, coherence, prominence_db=prominence)
    assert isinstance(caught.value, ConfigurationError) == (prominence == 0)
