"""An FMU is fast enough for any master."""

from __future__ import annotations

import pytest

from vehicle.runs.car import Car


def test_an_fmu_with_five_outputs_runs_twenty_times_faster_than_real_time(tmp_path):
    pytest.importorskip("fmpy", reason="FMPy is missing: pip install 'vehicle-on-shaker[oracles]'")
    from tests.benchmarks.fmu_speed import realtime_factors

    factors = realtime_factors(Car.load("focus_road").with_(["driving.speed=22"]), tmp_path)
    assert factors[5] > 20.0 and min(factors.values()) > 15.0, factors
