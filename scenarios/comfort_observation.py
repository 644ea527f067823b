"""What is read off one run on a road, and many such runs in several processes."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from scenarios.car_runs import CarRuns
from vehicle.errors import SimulationError
from vehicle.reduced.march import has_compiler
from vehicle.sweeps.case import Case
from vehicle.sweeps.road import RoadInput, RoadMeasure
from vehicle.sweeps.sweep import sweep


@dataclass(frozen=True, kw_only=True, slots=True)
class Observation:
    """Numbers of one run, its lead left out.

    Attributes:
        comfort: sqrt(RMSx^2 + RMSy^2 + RMSz^2) of the seat rail, unfiltered, 2 to 50 Hz [m/s2].
        gaussian_error: its standard error for a Gaussian road, from the spectrum [m/s2].
        slip, slip_left: share of the time above the slip velocity, right and left damper [-].
        saturated: share above 1 mm/s, right damper [-].
        lowest_load: of the tyre on the shaker [N].
        pulling: share of the time with a negative load there [-].
    """

    comfort: float
    gaussian_error: float
    slip: float
    slip_left: float
    saturated: float
    lowest_load: float
    pulling: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Question:
    """A run.

    Attributes:
        car: overrides, after those of all cars.
        source: the road.
        engine: "reduced" or "mujoco".
    """

    car: tuple[str, ...]
    source: RoadInput
    engine: str


def chosen_engine(asked: str) -> str:
    """Engine of the studies: "auto" is the reduced one, on the rough road too, where `Car.run` would take MuJoCo.

    There parts turn by 0.13 rad, beyond what the reduced engine vouches for; its comfort value is still the same within
    a few tenths of a percent, which the full study checks on its corner points.
    """
    if asked != "auto":
        return asked
    return "reduced" if has_compiler() else "mujoco"


def observe(questions: Sequence[Question], runs: CarRuns, folder: Path | None = None) -> list[Observation]:
    """Run cars on roads, in the worker processes of `runs`; answers in the order of the questions.

    Args:
        questions: with the same lead; those about one car side by side.
        runs: vehicle file, overrides and jobs.
        folder: keeps the rows as they finish, so that an interrupted study goes on.

    Raises:
        SimulationError: a run failed.
    """
    if not questions:
        return []
    cases = [
        Case(
            overrides=tuple(_path_and_value(text) for text in (*runs.overrides, *question.car)),
            source=question.source,
            engine=question.engine,
            vehicle=runs.vehicle,
        )
        for question in questions
    ]
    # One job needs no process of its own, which takes seconds to start.
    inside = partial(ThreadPoolExecutor, 1) if runs.jobs == 1 else None
    measure = RoadMeasure(lead=questions[0].source.lead)
    table = sweep(cases, measure, executor=inside, jobs=runs.jobs, folder=folder)
    if table.failed:
        case, reason = table.failed[0]
        raise SimulationError(f"{case.label}: {reason}; {len(table.failed)} of {len(cases)} runs failed")
    return [Observation(**result.values) for result in table.results]


def _path_and_value(text: str) -> tuple[str, str]:
    path, _, value = text.partition("=")
    return path, value
