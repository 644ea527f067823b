"""Processor time and memory of the process of a sweep, without the computation of the cases.

`python -m tests.benchmarks.sweep_master [--cases 200000]`: an executor in the same process returns rows of random
values at once, so the time is that of planning, dispatch, storing and writing of the table. Tasks and rows are pickled
as for worker processes.
"""

import argparse
import json
import pickle
import resource
import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from vehicle.runs.car import Car
from vehicle.signals.analysis.ride_comfort import UNWEIGHTED, WEIGHTED, wave_names
from vehicle.studies.sweeps.case_result import Block, Result
from vehicle.studies.sweeps.measure import ComfortMeasure
from vehicle.studies.sweeps.plan import plan_sweep
from vehicle.studies.sweeps.sweep_settings import SweepSettings

VARIED = ("damper.viscous", "damper.coulomb_friction", "bushings.suspension_mount.stiffness.z")
"""Parameters of the cases: three columns."""

TASK_S = 0.02
"""Computing time that a case of a task states [s]: tasks as large as those of short runs."""


class Instant(Executor):
    """Executor that returns rows of random values when a task is submitted; the time for making them is subtracted.

    Attributes:
        seconds: processor time for making the rows, which workers would do [s].
    """

    _max_workers = 64

    def __init__(self) -> None:
        self.seconds = 0.0
        names = [*ComfortMeasure().units, *wave_names(UNWEIGHTED), *wave_names(WEIGHTED)]
        values = np.random.default_rng(1).random(len(names)).tolist()
        self.result = Result(values=dict(zip(names, values, strict=True)), engine="reduced", seconds=TASK_S)
        self.row = b""

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        """Return finished rows of the cases of a task."""
        sent = pickle.dumps((function, arguments), pickle.HIGHEST_PROTOCOL)
        began = time.process_time()
        _, (cases, keys, *_) = pickle.loads(sent)
        self.row = self.row or self.result.row(cases[0], "KEY").encode()
        rows = b"".join(self.row.replace(b"KEY", key.encode()) for key in keys)
        returned = pickle.dumps(Block(rows=rows, seconds=TASK_S * len(keys)), pickle.HIGHEST_PROTOCOL)
        self.seconds += time.process_time() - began
        future: Future[Block] = Future()
        future.set_result(pickle.loads(returned))
        return future


def measured(cases: int) -> dict[str, float]:
    """Return processor time a case [us] and peak of the memory [MB], of this process."""
    levels = round(cases ** (1.0 / len(VARIED)))
    counts = [levels, levels, -(-cases // levels**2)]
    ranges = [(900.0, 4000.0), (60.0, 250.0), (4e5, 9e5)]
    vary = {
        path: np.linspace(*bounds, count).tolist() for path, bounds, count in zip(VARIED, ranges, counts, strict=True)
    }
    car = Car.load()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    with TemporaryDirectory() as folder:
        executor = Instant()
        began = time.process_time()
        plan = plan_sweep(car, vary, "low.csv", SweepSettings(engine="reduced"))
        table = plan.run(executor=executor, folder=Path(folder))
        seconds = time.process_time() - began - executor.seconds
        size = sum(path.stat().st_size for path in Path(folder).iterdir())
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return {
        "cases": len(table.cases),
        "us_per_case": 1e6 * seconds / len(table.cases),
        "before_mb": before / 1024.0,
        "peak_mb": peak / 1024.0,
        "files_mb": size / 2**20,
    }


def main(arguments: Sequence[str]) -> int:
    """Print the measured values as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=200_000)
    print(json.dumps(measured(parser.parse_args(arguments).cases), indent=2))
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
