"""Local maxima and their prominence against scipy."""

import numpy as np
import pytest
import scipy.signal

from vehicle.signals.analysis.local_maxima import local_maxima


@pytest.mark.parametrize("prominence", [0.0, 1.0])
@pytest.mark.parametrize("levels", [4, 1000])
def test_maxima_agree_with_scipy_with_flat_tops_and_equal_feet(levels, prominence):
    random, found = np.random.default_rng(levels), 0
    for samples in range(1, 200):
        values = random.integers(0, levels, samples).astype(float)
        tops, properties = scipy.signal.find_peaks(values, prominence=prominence)
        feet = zip(properties["left_bases"], properties["right_bases"], strict=True)
        expected = [max(pair, key=lambda foot: values[foot]) for pair in feet]
        maxima = local_maxima(values, prominence)
        found += len(maxima)
        assert [maximum.top for maximum in maxima] == tops.tolist()
        assert [maximum.prominence for maximum in maxima] == properties["prominences"].tolist()
        assert [maximum.foot for maximum in maxima] == expected
    assert found > 1000
