"""Time of a case of a sweep with everything: its car, the run of 30 s, what is measured of it, the row on the disk."""

import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from scenarios.global_sensitivity import RANGES, points_of
from scenarios.road_measure import RoadInput, RoadMeasure
from scenarios.signals.exact_road import LEAD_S, ROAD_EDGE_HZ, ROAD_RMS
from vehicle.studies.sweeps.case import Case
from vehicle.studies.sweeps.case_evaluation import run_of
from vehicle.studies.sweeps.case_table import table_cases
from vehicle.studies.sweeps.indices import LEAST_BASE
from vehicle.studies.sweeps.sweep import sweep

SECONDS = 20.0
"""Evaluated part of a run [s]; with the lead it is 30 s long."""


def cases(count: int) -> list[Case]:
    """Cases of the global sensitivity study: ten parameters vary on the smooth road, the reduced engine."""
    road = RoadInput(
        name="smooth road",
        rms=ROAD_RMS["smooth"],
        seed=0,
        wheel="fl",
        duration=SECONDS,
        lead=LEAD_S,
        lower_band_edge=ROAD_EDGE_HZ,
    )
    base = max(LEAST_BASE, 2 ** int(np.log2(max(24, 2 * count) / (len(RANGES) + 2))))
    points = points_of(base)[:count].tolist()
    return list(table_cases([one.path for one in RANGES], points, [road], engine="reduced"))


def case_ms(count: int) -> float:
    """Processor time of a case among others [ms], in one process; what a process does once was done before."""
    some = cases(2 * count)
    _swept(some[:count])
    started = time.process_time()
    _swept(some[count:])
    return 1e3 * (time.process_time() - started) / count


def case_alone_ms(count: int) -> float:
    """Processor time of a case by itself, its car built whole [ms]: as every case was before there were batches."""
    measure, (first, *rest) = RoadMeasure(lead=LEAD_S, wheel="fl"), cases(count + 1)
    measure(run_of(first, measure.channels))
    started = time.process_time()
    for case in rest:
        measure(run_of(case, measure.channels))
    return 1e3 * (time.process_time() - started) / count


def _swept(some: Sequence[Case]) -> None:
    """Sweep in this process, with a folder."""
    with TemporaryDirectory() as folder:
        table = sweep(
            some, RoadMeasure(lead=LEAD_S, wheel="fl"), executor=partial(ThreadPoolExecutor, 1), folder=Path(folder)
        )
    if table.failed:
        raise RuntimeError(f"{len(table.failed)} cases failed, the first: {table.failed[0][1]}")
