"""Findings of a report against the tables of its run."""

import re
from html import unescape

import numpy as np
import pytest

from vehicle.signals.formats.frf_file import read_frf


def test_the_share_of_incoherent_lines_is_that_of_the_table(reported):
    responses, words = read_frf(reported.folder / "frf.csv"), unescape(re.sub(r"<[^>]+>", "", reported.text))
    for channel, point in (("knuckle_fl_acc_z", "knuckle"), ("seat_rail_acc_z", "seat rail")):
        coherence = responses.coherence[responses.channels.index(channel)]
        finite = coherence[np.isfinite(coherence)]
        low = np.mean(finite < 0.9)
        assert 0.05 < abs(low - 0.5) < 0.5, "both sides would look alike"
        said = re.search(
            rf"At the {point} the median of the coherence is ([0-9.]+); it is below 0.9 on ([0-9.]+) %", words
        )
        assert said is not None
        assert float(said[1]) == pytest.approx(np.median(finite), abs=1e-3)
        assert float(said[2]) == pytest.approx(100.0 * low, rel=0.05)
