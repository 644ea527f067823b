"""Time of a case of a sweep with everything: its car, the run of 30 s, what is measured of it, the row on the disk."""

import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from scenarios.road_measure import RoadInput, RoadMeasure
from scenarios.signals.exact_road import LEAD_S, ROAD_EDGE_HZ, ROAD_RMS
from vehicle.model.parameters.ranges import Range
from vehicle.studies.sweeps.case import Case
from vehicle.studies.sweeps.case_evaluation import run_of
from vehicle.studies.sweeps.case_table import table_cases
from vehicle.studies.sweeps.indices import LEAST_BASE, sobol_sample
from vehicle.studies.sweeps.sweep import sweep

RANGES = tuple(
    Range(path=path, low=low, high=high)
    for path, low, high in (
        ("damper.coulomb_friction", 62.5, 250.0),
        ("damper.viscous", 1125.0, 3375.0),
        ("bushings.suspension_mount.stiffness.z", 3.5e5, 14e5),
        ("bushings.suspension_mount.damping.z", 0.0, 2000.0),
        ("main_spring.stiffness", 2.0e4, 3.0e4),
        ("stabilizer.torsional_stiffness", 2.5e3, 7.5e3),
        ("bushings.tyre.stiffness.z", 2.0e5, 3.0e5),
        ("bushings.tyre.damping.z", 0.0, 800.0),
        ("bushings.hydromount.stiffness.z", 2.0e5, 6.0e5),
        ("body.frequency_scale", 0.8, 1.25),
    )
)
"""Ten parameters, each between its limits; the body modes are 20 % lower to 25 % higher."""

SEED = 2006
"""Seed of the sample."""

SECONDS = 20.0
"""Evaluated part of a run [s]; with the lead it is 30 s long."""


def cases(count: int) -> list[Case]:
    """Cases of Sobol indices: ten parameters vary on the smooth road, the reduced engine."""
    road = RoadInput(
        name="smooth road", rms=ROAD_RMS["smooth"], seed=0, wheel="fl", duration=SECONDS, lead=LEAD_S,
        lower_band_edge=ROAD_EDGE_HZ,
    )  # fmt: skip
    base = max(LEAST_BASE, 2 ** int(np.log2(max(24, 2 * count) / (len(RANGES) + 2))))
    points = sobol_sample(RANGES, base, seed=SEED)[:count].tolist()
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
