"""Runs of the complete car that scenarios share: each computed once, independent ones in several processes."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from vehicle.car import Car, Run
from vehicle.excitation.signal import Signal
from vehicle.simulation.recording import Recording
from vehicle.sweeps.executors import process_pool


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Case:
    """A signal on the car with some parameters changed.

    Attributes:
        signal: displacement of the plates.
        overrides: texts like "damper.coulomb_friction=75"; they win over those of the command line.
        engine: another engine than that of the other runs; a film needs "mujoco".
    """

    signal: Signal
    overrides: tuple[str, ...] = ()
    engine: str | None = None


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Task:
    """What a worker process needs to know to carry out one run."""

    vehicle: Path | None
    overrides: tuple[str, ...]
    signal: Signal
    engine: str


class CarRuns:
    """Cars and finished runs behind one or several scenarios.

    Args:
        vehicle: TOML file; the car of source 1 by default.
        overrides: of every car, before those of a case.
        engine: "mujoco", "reduced" or "auto".
        jobs: worker processes.
    """

    def __init__(
        self, *, vehicle: Path | None = None, overrides: Sequence[str] = (), engine: str = "mujoco", jobs: int = 1
    ) -> None:
        self.vehicle, self.overrides, self.engine, self.jobs = vehicle, tuple(overrides), engine, jobs
        self._cars: dict[tuple[str, ...], Car] = {}
        self._done: dict[tuple[object, ...], Run] = {}

    def car(self, overrides: Sequence[str] = ()) -> Car:
        """The car with some parameters changed; built once."""
        changes = (*self.overrides, *overrides)
        if changes not in self._cars:
            self._cars[changes] = Car.load(self.vehicle, changes)
        return self._cars[changes]

    def __call__(self, cases: Sequence[Case]) -> list[Run]:
        """Runs of the cases, in their order; what was computed before is not computed again."""
        keys = [self._key(case) for case in cases]
        missing = {key: case for key, case in zip(keys, cases, strict=True) if key not in self._done}
        tasks = [
            Task(
                vehicle=self.vehicle,
                overrides=(*self.overrides, *case.overrides),
                signal=case.signal,
                engine=case.engine or self.engine,
            )
            for case in missing.values()
        ]
        if self.jobs > 1 and len(tasks) > 1:
            recordings = carry_out(tasks, self.jobs)
            for (key, case), recording in zip(missing.items(), recordings, strict=True):
                self._done[key] = Run(car=self.car(case.overrides), signal=case.signal, recording=recording)
        else:
            for (key, case), task in zip(missing.items(), tasks, strict=True):
                self._done[key] = self.car(case.overrides).run(case.signal, engine=task.engine)
        return [self._done[key] for key in keys]

    def _key(self, case: Case) -> tuple[object, ...]:
        content = hashlib.sha256()
        for wheel, values in case.signal.displacement.items():
            content.update(wheel.encode() + values.tobytes())
        return case.overrides, case.engine or self.engine, case.signal.timestep, content.hexdigest()


def carry_out(tasks: Sequence[Task], jobs: int) -> list[Recording]:
    """Carry out independent runs in worker processes with one thread each; results in the order of the tasks."""
    with process_pool(min(jobs, len(tasks))) as pool:
        return list(pool.map(_carry_out_one, tasks))


def _carry_out_one(task: Task) -> Recording:
    return Car.load(task.vehicle, task.overrides).run(task.signal, engine=task.engine).recording
