"""The benchmark of an FMU runs; its times are read, not judged."""

from __future__ import annotations

import pytest

from vehicle.runs.car import Car


def test_the_benchmark_measures_few_and_all_outputs(tmp_path):
    pytest.importorskip("fmpy", reason="FMPy is missing: pip install 'vehicle-on-shaker[oracles]'")
    from tests.benchmarks.fmu_speed import FEW, realtime_factors

    factors = realtime_factors(Car.load("focus_road").with_(["driving.speed=22"]), tmp_path)
    assert sorted(factors)[0] == len(FEW) and len(factors) == 2
    assert all(factor > 0.0 for factor in factors.values()), factors
