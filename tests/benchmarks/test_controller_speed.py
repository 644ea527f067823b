"""The call of a controller FMU costs little beside a step of the reduced engine."""

from __future__ import annotations

import sys
import time

import pytest

from scenarios.signals.random_road import random_road
from vehicle.runs.car import Car


@pytest.mark.skipif(sys.platform != "linux", reason="the library of the tests is for Linux")
@pytest.mark.parametrize("version", ["2", "3"])
def test_a_call_costs_little_beside_a_step_of_the_reduced_engine(tmp_path, version):
    """A call takes 0.02 us, a millisecond of a run 1 us."""
    pytest.importorskip("fmpy", reason="FMPy is missing: pip install 'vehicle-on-shaker[fmu]'")
    from tests.benchmarks.controller_speed import time_per_call

    car, signal = Car.load("focus"), random_road(rms=1e-4, seed=1, wheel="fl", duration=60.0)
    car.run(signal, engine="reduced")
    began = time.process_time()
    samples = car.run(signal, engine="reduced").time.size
    step = (time.process_time() - began) / samples
    assert 0.0 < time_per_call(tmp_path, version) < 0.25 * step
