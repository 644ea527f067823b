"""The benchmark of the process of a sweep runs; a case takes little memory there."""

import tracemalloc

import numpy as np

from tests.benchmarks.sweep_master import measured
from tests.studies.sweeps.sweep_samples import ShortRoad
from vehicle.studies.sweeps.case_table import Cases, Combinations
from vehicle.studies.sweeps.dispatcher import in_groups
from vehicle.studies.sweeps.store import StoredRows


def test_the_benchmark_prints_time_and_memory():
    found = measured(1000)
    assert found["cases"] == 1000
    assert found["us_per_case"] > 0.0 and found["peak_mb"] >= found["before_mb"] > 0.0


def test_a_case_takes_at_most_100_byte():
    """A list of the cases takes 300 byte each; positions of the rows (13) and arrays of the sort (about 50) remain."""
    tracemalloc.start()
    columns = [[f"{name}={value}" for value in range(100)] for name in ("a", "b")]
    cases = Cases(Combinations([*columns, ["c=1", "c=2"]]), [ShortRoad()])
    rows, order = StoredRows(None, len(cases)), in_groups(cases, np.arange(len(cases)))
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert len(order) == len(rows) == 20_000
    assert peak / len(cases) < 100.0
