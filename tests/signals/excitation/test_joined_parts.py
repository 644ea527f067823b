"""Parts of a signal, one after the other: the same motion as in the whole, without jumps."""

import numpy as np
import pytest

from vehicle.signals.excitation.joined_parts import BLEND_S, LEAD_S, joined_parts
from vehicle.signals.excitation.signal import Signal

RATE = 500.0


@pytest.fixture(scope="module")
def whole() -> Signal:
    """Waves on a hill of 5 % with a cross slope, at different delays."""
    time = np.arange(round(40.0 * RATE) + 1) / RATE
    rows = {
        wheel: 0.01 * np.sin(2.0 * np.pi * 1.3 * (time - late)) + 1.1 * time + side * 0.02 * time
        for wheel, late, side in (("fr", 0.0, 1.0), ("fl", 0.0, -1.0), ("rr", 0.12, 1.0), ("rl", 0.12, -1.0))
    }
    return Signal(time=time, displacement={wheel: row - row[0] for wheel, row in rows.items()})


def test_each_part_is_the_whole_up_to_one_height(whole: Signal):
    parts = [(2.0, 6.0), (6.0, 9.0), (10.0, 12.0), (25.0, 29.0), (37.0, 40.0)]
    signal, places = joined_parts(whole, parts)
    # The second part goes on; the third begins 1 s later, less than its lead-in.
    assert signal.duration == pytest.approx(LEAD_S + 10.0 + LEAD_S + 4.0 + LEAD_S + 3.0 - 1.0 / RATE)
    assert places == pytest.approx([2.0, 6.0, 10.0, 14.0, 20.0])
    for (begin, end), place in zip(parts, places, strict=True):
        first, count = round((begin - LEAD_S + BLEND_S) * RATE), round((end - begin + LEAD_S - BLEND_S) * RATE)
        at = round((place - LEAD_S + BLEND_S) * RATE)
        differences = [signal.displacement[wheel][at : at + count] - whole.displacement[wheel][first : first + count]
                       for wheel in whole.wheels]  # fmt: skip
        assert np.ptp(differences) < 1e-12


def test_the_start_of_a_signal_rises_once(whole: Signal):
    signal, places = joined_parts(whole, [(LEAD_S, 6.0)])
    assert places == [LEAD_S]
    for wheel, row in signal.displacement.items():
        start = whole.displacement[wheel][: row.size]
        # One height for all plates, which begin at 0.
        assert row == pytest.approx(start, abs=1e-12)


def test_parts_are_joined_without_jumps_and_begin_at_rest(whole: Signal):
    signal, _ = joined_parts(whole, [(5.0, 9.0), (20.0, 24.0), (33.0, 37.0)])
    fastest = max(np.max(np.abs(np.diff(row))) for row in whole.displacement.values())
    for row in signal.displacement.values():
        # The rise adds w' z, at most pi/2 times the slope of the hill.
        assert row[0] == pytest.approx(0.0, abs=1e-12) and np.max(np.abs(np.diff(row))) < 2.0 * fastest
