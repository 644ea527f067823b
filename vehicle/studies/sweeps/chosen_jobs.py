"""Number of processes of a sweep, chosen by an estimate of its work."""

from collections.abc import Collection
from contextlib import suppress

from vehicle.digits import number
from vehicle.machine import free_memory
from vehicle.runs.output.run_size import BASE
from vehicle.studies.sweeps.case import Case
from vehicle.studies.sweeps.measure import BatchMeasure, Measure
from vehicle.studies.sweeps.study_size import duration_of
from vehicle.threads import processors

START = 2.4
"""Processor time in which a worker starts [s]: imports, reference car, inputs. Measured with `focus_road`."""

CAR = 0.02
"""Processor time of a car without its run [s]: 0.6 ms with another friction, 15 with another damping, 24 with another
mass of `focus_road`."""

BATCH, SINGLE, MUJOCO = 0.7e-3, 6e-3, 0.1
"""Processor time of a simulated second [s]: batch, single run of the reduced engine, MuJoCo. Measured
with `focus_road`; smaller cars take a half to a third."""


def work(each: Collection[Case], runs: int, measure: Measure) -> float:
    """Return the estimated processor time of the runs of a sweep [s].

    T = runs (`CAR` + mean of rate x duration),    "auto" counts as "reduced".

    Args:
        each: a case of each input, vehicle and engine.
        runs: number of runs.
    """
    reduced, seconds = BATCH if isinstance(measure, BatchMeasure) else SINGLE, [0.0]
    for case in each:
        # The error of an input is a failed row.
        with suppress(Exception):
            seconds.append(duration_of(case.source) * (MUJOCO if case.engine == "mujoco" else reduced))
    return runs * (CAR + sum(seconds) / max(len(each), 1))


def chosen_jobs(each: Collection[Case], runs: int, measure: Measure) -> tuple[int, str]:
    """Return a number of processes, and a message if there are several.

    A worker pays if its share of the work takes longer than its start: n = T/`START`, at most one a processor, and as
    many as fit into the free memory beside their runs.

    Args:
        each, runs, measure: see `work`.
    """
    seconds = work(each, runs, measure)
    count = min(int(seconds / START), processors(), int(free_memory() / (4.0 * BASE)))
    if count < 2:
        return 1, ""
    return count, f"{count} processes for about {number(seconds, 2)} s of work on one; --jobs sets another number"
