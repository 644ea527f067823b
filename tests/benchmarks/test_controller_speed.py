"""The call of a controller FMU costs little beside a step of the reduced engine."""

from __future__ import annotations

import sys

import pytest


@pytest.mark.skipif(sys.platform != "linux", reason="the library of the tests is for Linux")
@pytest.mark.parametrize("version", ["2", "3"])
def test_a_call_takes_less_than_a_microsecond(tmp_path, version):
    pytest.importorskip("fmpy", reason="FMPy is missing: pip install 'vehicle-on-shaker[fmu]'")
    from tests.benchmarks.controller_speed import time_per_call

    assert time_per_call(tmp_path, version) < 1e-6
