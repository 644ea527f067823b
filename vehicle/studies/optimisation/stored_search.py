"""A search in a folder: generations on the disk as they finish, and taken up again after an interruption."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.runs.output.folder import folder_lock, write_json
from vehicle.studies.optimisation.car_table import CARS, CarTable
from vehicle.studies.optimisation.problem import Vector
from vehicle.studies.optimisation.search import Tried, search
from vehicle.studies.optimisation.trials import Trials
from vehicle.studies.sweeps.case import digest
from vehicle.studies.sweeps.sweep import case_keys

SEARCH = "search.json"
"""Tells one search from every other: car, inputs, program, wishes, seed, but not how many cars."""


def kept_search(
    trials: Trials, folder: Path, *, cars: int, population: int, seed: int, progress: Callable[[float], None]
) -> tuple[Tried, list[Tried]]:
    """Search, and keep every car in `cars.csv`.

    Args:
        trials: how cars are tried.
        folder: an existing one; generations that are there are not tried again.
        cars: to try, rounded up to whole generations.
        population: cars of a generation.
        seed: of the search.
        progress: called with the finished fraction.

    Returns:
        The car as it is; the generations.

    Raises:
        ConfigurationError: the folder holds another search.
        DataError, OutputError, MissingPartError: as of `CarTable` and `search`.
    """
    problem = trials.problem
    as_it_is = np.full((1, len(problem.ranges)), math.nan)
    keys = case_keys(trials.cases(as_it_is), trials.measure)
    spread = [repr(trials.spread.tolerances), trials.spread.bands.tolist(), trials.spread.quantile]
    identity = {"search": digest([keys, repr(problem), spread, population, seed])}
    generations = math.ceil(cars / population)
    with folder_lock(folder.resolve()):
        if (folder / CARS).exists() and _identity(folder / SEARCH) != identity:
            raise ConfigurationError(
                f"--resume: {folder} holds another search, or one of another version of the program; give the same "
                "options, or --force to start anew"
            )
        write_json(folder / SEARCH, identity)
        table = CarTable(folder / CARS, problem)

        def attempt(points: Vector) -> Tried:
            values, reasons = trials(points)
            tried = Tried(points=points, values=values, reasons=tuple(reasons))
            table.add(tried)
            progress(min((len(table.generations) - 1) / generations, 1.0))
            return tried

        known = list(table.generations)
        base = known[0] if known else attempt(as_it_is)
        return base, search(
            problem, attempt, population=population, generations=generations, seed=seed, known=known[1:]
        )


def _identity(path: Path) -> object:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
