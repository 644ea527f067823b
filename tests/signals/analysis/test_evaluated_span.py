"""The evaluated span of a run has n samples, and its spectrum the lines k/T."""

import numpy as np
import pytest

from vehicle.signals.analysis.evaluated_span import evaluated_span
from vehicle.signals.analysis.ride_comfort import comfort_columns


@pytest.mark.parametrize("seconds", [6, 10, 30])
def test_a_line_at_the_edge_of_the_band_counts_half(seconds):
    """Waves at 2 Hz, the lower edge, and at 5 Hz: with n + 1 samples both would leak into other lines."""
    skip, step = 2.0, 1e-3
    time = np.arange(round((skip + seconds) / step) + 1) * step
    rail = np.zeros((1, 3, time.size))
    rail[0, 2] = 0.7 * np.sin(2.0 * np.pi * 2.0 * time) + np.sin(2.0 * np.pi * 5.0 * time)
    columns = comfort_columns(step, rail, skip=skip, names=["unweighted"])
    assert columns["unweighted"][0] == pytest.approx(np.sqrt((0.5 * 0.49 + 1.0) / 2.0), rel=1e-9)


def test_the_last_sample_closes_the_span_of_a_run_only():
    assert evaluated_span(28_001, 1e-3, 2.3) == slice(2300, 28_000)
    assert evaluated_span(28_001, 1e-3, 2.3, closed=False) == slice(2300, 28_001)
