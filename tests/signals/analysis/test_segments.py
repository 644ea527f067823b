import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.segments import cut_into_segments, effective_averages


def test_half_overlapping_hann_segments_are_worth_the_textbook_number():
    # for a Hann window shifted by half its length the correlation is exactly 1/6, its square 1/36
    cut = cut_into_segments(60_000, 1e-3, window_s=4.0, overlap=0.5, minimum_averages=8.0)
    assert (cut.length, cut.step, cut.count, cut.overlap) == (4000, 2000, 29, 2000)
    validated(
        "Statistics and intervals", "effective averages of 29 Hann segments with half overlap", cut.averages,
        29 / (1 + 2 * (28 / 29) / 36), rel=1e-6, source="closed form: Welch 1967, correlation 1/6 of neighbours",
    )  # fmt: skip


def test_effective_averages_agree_with_the_scatter_of_simulated_densities():
    # second derivation: the variance of a Welch density of white noise is its square over the averages
    rng = np.random.default_rng(4)
    window = np.hanning(65)[:-1]
    starts = range(0, 64 * 8 - 63, 16)
    runs = 800
    density = np.empty((runs, 24))
    for run in range(runs):
        noise = rng.standard_normal(64 * 8)
        lines = np.abs(np.fft.rfft(np.stack([noise[s : s + 64] * window for s in starts]), axis=1)) ** 2
        density[run] = lines.mean(axis=0)[4:28]
    seen = np.mean(density.mean(axis=0) ** 2 / density.var(axis=0))
    # 800 runs x about 12 independent lines: the variance is known within about 2 %
    assert seen == pytest.approx(effective_averages(window, 16, len(starts)), rel=0.06)


def test_without_overlap_every_segment_counts():
    cut = cut_into_segments(40_000, 1e-3, window_s=4.0, overlap=0.0, minimum_averages=8.0)
    assert cut.averages == pytest.approx(10.0, abs=1e-12)


def test_too_short_a_record_is_refused_with_the_length_needed():
    # the length named is enough, and one step less is not
    assert cut_into_segments(20_000, 1e-3, window_s=4.0, overlap=0.5, minimum_averages=8.0).averages >= 8.0
    for samples, message in ((12_000, "12 s give 4.79 averages .* 4 s and 50 %.* 8; .* 20 s"), (19_999, "20 s")):
        with pytest.raises(DataError, match=message):
            cut_into_segments(samples, 1e-3, window_s=4.0, overlap=0.5, minimum_averages=8.0)


@pytest.mark.parametrize(("window_s", "overlap"), [(0.0, 0.5), (np.nan, 0.5), (-4.0, 0.5), (4.0, 1.0), (4.0, -0.1)])
def test_window_and_overlap_out_of_range_are_refused(window_s, overlap):
    with pytest.raises(ConfigurationError, match=r"window_s: found|overlap: found"):
        cut_into_segments(60_000, 1e-3, window_s=window_s, overlap=overlap, minimum_averages=8.0)
