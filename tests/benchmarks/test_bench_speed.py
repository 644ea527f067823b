"""The bench follows a slider; loose limits, since the machine of a test may be busy."""

from __future__ import annotations

import pytest

from tests.benchmarks.bench_speed import frame_ms, numbers_ms


def test_numbers_follow_a_slider():
    # 48 ms on a core of its own.
    assert numbers_ms("focus", on_road=False, repeats=5) < 200.0


@pytest.mark.parametrize(("name", "picture"), [("focus", "run"), ("focus", "mode"), ("focus_road", "obstacle")])
def test_frames_are_sent_to_a_window(name, picture):
    pytest.importorskip("viser", reason="viser is missing: pip install 'vehicle-on-shaker[bench]'")
    rate, cost = frame_ms(name, picture, 2.0)
    assert rate > 5.0 and cost < 60.0
