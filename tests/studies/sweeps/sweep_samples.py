"""Objects that worker processes import: a cheap measure, inputs that kill a worker, a user-defined executor."""

import csv
import os
import signal
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path

from scenarios.signals.random_road import random_road
from vehicle.studies.sweeps.case_table import table_cases


@dataclass(frozen=True, kw_only=True, slots=True)
class ShortRoad:
    """Road of about a second; `wait` delays its generation, `kill` (a flag file) kills its worker, once or always."""

    name: str = "short"
    seed: int = 1
    duration: float = 1.0
    rms: float = 5e-4
    kill: str = ""
    wait: float = 0.0

    def signal(self):
        if self.kill:
            # The file exists after the first death of a worker.
            flag = Path(self.kill)
            if flag.suffix == ".always" or not flag.exists():
                flag.touch()
                os.kill(os.getpid(), signal.SIGKILL)
        time.sleep(self.wait)
        return random_road(rms=self.rms, seed=self.seed, wheel="fr", duration=self.duration)

    def identity(self):
        return asdict(self)


def rows_of(path):
    """Return the rows of a table by the heads of its columns."""
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def grid(variations, inputs, **options):
    """Return cases for every combination of parameter values on every input."""
    return table_cases(list(variations), product(*variations.values()), inputs, **options)


@dataclass(frozen=True, kw_only=True, slots=True)
class Peak:
    """Measure: maximum vertical acceleration of the seat rail."""

    channels: tuple[str, ...] = ("seat_rail_acc_z",)

    @property
    def units(self):
        return {"peak": "m/s2"}

    def __call__(self, run):
        return {"peak": float(abs(run["seat_rail_acc_z"]).max())}


@dataclass(frozen=True, kw_only=True, slots=True)
class Worker(Peak):
    """Measure: number of the process that runs the case, and the time."""

    @property
    def units(self):
        return {"process": "-", "time": "s"}

    def __call__(self, run):
        return {"process": float(os.getpid()), "time": time.time()}


def threads():
    """Return a user-defined executor."""
    return ThreadPoolExecutor(2)


def no_executor():
    """Return an object that is not an executor."""
    return "threads"
