"""Compare the FRF time of two checkouts: `python -m tests.benchmarks.frf_time FOLDER [--repeats N]`.

FOLDER is the root of the other checkout. Each checkout has its own process, with one thread; their runs alternate, and
the minimum processor time counts. The largest difference of the FRFs shows that both compute the same values.
"""

from __future__ import annotations

import argparse
import itertools
import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

CASES = ((1, 60), (33, 60), (1, 10), (33, 10))
"""Number of channels and length of the record [s], sampled at 1 kHz."""

WORKER = """
import json, sys, time
import numpy as np
from vehicle.signals.analysis.local_rational import local_rational_responses
for line in sys.stdin:
    channels, seconds, whole = json.loads(line)
    rng = np.random.default_rng(0)
    signal = rng.normal(size=1000 * seconds)
    noisy = [np.convolve(signal, rng.normal(size=20), "same") + rng.normal(size=signal.size) for _ in range(channels)]
    begin = time.process_time()
    estimate = local_rational_responses(1e-3, signal[None], noisy)[0]
    spent = time.process_time() - begin
    values = np.nan_to_num(np.stack([estimate.response, estimate.random_error, estimate.coherence])).ravel()
    print(json.dumps([spent, *(part.tolist() for part in (values.real, values.imag) if whole)]), flush=True)
"""
"""Program of a process: reads a case a line, writes its processor time [s] and, if asked for, the estimates."""


def compare(folders: Sequence[Path], repeats: int) -> list[tuple[int, int, float, float, float]]:
    """Return channels, seconds, processor times [s] of both checkouts, and the largest difference of the estimates."""
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    rows = []
    workers = [
        subprocess.Popen(
            [sys.executable, "-c", WORKER], cwd=folder, env={**environment, "PYTHONPATH": str(folder)}, text=True,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        )
        for folder in folders
    ]  # fmt: skip
    times = {case: [float("inf")] * 2 for case in CASES}
    for repeat in range(repeats + 1):  # the first run loads modules
        for case, number in itertools.product(CASES, range(2)):
            spent = _answer(workers[number], *case, False)[0]
            times[case][number] = min(times[case][number], spent if repeat else float("inf"))
    for case in CASES:  # last, because the transfer changes the memory of a process and so its time
        values = [_answer(worker, *case, True)[1:] for worker in workers]
        difference = max(abs(a - b) for one, two in zip(*values, strict=True) for a, b in zip(one, two, strict=True))
        rows.append((*case, times[case][0], times[case][1], difference))
    for worker in workers:
        worker.communicate()
    return rows


def _answer(worker: subprocess.Popen[str], channels: int, seconds: int, whole: bool) -> list[Any]:
    """Run a case in a process, and return the processor time [s], followed by the estimates if `whole`."""
    assert worker.stdin is not None and worker.stdout is not None
    print(json.dumps([channels, seconds, whole]), file=worker.stdin, flush=True)
    values: list[Any] = json.loads(worker.stdout.readline())
    return values


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a line for each case."""
    parser = argparse.ArgumentParser(prog="tests.benchmarks.frf_time", description=(__doc__ or "").split(":")[0])
    parser.add_argument("folder", type=Path, help="root of the other checkout")
    parser.add_argument("--repeats", type=int, default=5)
    options = parser.parse_args(arguments)
    here = Path(__file__).parents[2]
    for channels, seconds, other, this, difference in compare((options.folder.resolve(), here), options.repeats):
        print(
            f"{channels:2d} channels of {seconds} s: {1e3 * other:.1f} -> {1e3 * this:.1f} ms, ratio "
            f"{this / other:.2f}, largest difference {difference:.1e}"
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
