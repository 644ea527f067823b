"""Pictures of a comparison on axes of their own."""

import numpy as np
import pytest

from vehicle.runs.comparison.comparison import Comparison
from vehicle.runs.comparison.record_comparison import compare_records
from vehicle.signals.formats.table import Record


def test_three_histories_of_a_point_show_the_whole_record_beside_its_excerpt():
    """Three rows are no FRFs: the columns have times of their own."""
    pyplot = pytest.importorskip("matplotlib.pyplot")
    time = np.arange(0.0, 8.0, 0.01)
    names = [f"seat_rail_acc_{axis}" for axis in "xyz"]
    channels = {name: np.random.default_rng(number).standard_normal(time.size) for number, name in enumerate(names)}
    record = Record(time=time, channels=channels, units=dict.fromkeys(names, "m/s2"))
    records, _ = compare_records(record, record)
    axes = Comparison(measured="a", simulated="b", records=records).plot()
    pyplot.close("all")
    assert axes.shape == (3, 2)
    for whole, excerpt in axes:
        assert np.ptp(whole.get_xlim()) == pytest.approx(7.99)
        assert np.ptp(excerpt.get_xlim()) == pytest.approx(1.0, abs=0.02)
