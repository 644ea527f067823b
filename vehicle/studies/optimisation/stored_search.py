"""Search in a folder: store each finished generation, and continue after an interruption."""

import json
import math
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.replacement import synchronise
from vehicle.runs.output.folder import write_json
from vehicle.runs.output.locks import folder_lock
from vehicle.studies.optimisation.car_table import CARS, CarTable
from vehicle.studies.optimisation.search import TriedCars, search
from vehicle.studies.optimisation.search_settings import SearchSettings
from vehicle.studies.optimisation.trials import Trials
from vehicle.studies.sweeps.case import digest
from vehicle.studies.sweeps.case_keys import case_keys

SEARCH = "search.json"
"""File with a digest of car, inputs, program, criteria and seed, which identifies a search; the number of cars may
change."""


def stored_search(trials: Trials, folder: Path, settings: SearchSettings) -> tuple[TriedCars, list[TriedCars]]:
    """Run a search and store every car in `cars.csv`.

    Args:
        trials: evaluation of the cars.
        folder: existing folder; stored generations are not computed again.
        settings: settings of the search; the number of cars is rounded up to whole generations.

    Returns:
        The unmodified car; the generations.

    Raises:
        ConfigurationError: the folder contains another search.
        DataError, OutputError, MissingPartError: see `CarTable` and `search`.
    """
    problem, population, progress = trials.problem, settings.population, settings.progress
    unmodified = np.full((1, len(problem.ranges)), math.nan)
    keys = case_keys(trials.cases(unmodified), trials.measure)
    spread = [repr(trials.spread.tolerances), trials.spread.bands.tolist(), trials.spread.quantile]
    identity = {"search": digest([keys, repr(problem), spread, population, settings.seed])}
    generations = math.ceil(settings.cars / population)
    with folder_lock(folder.resolve()):
        if (folder / CARS).exists() and _identity(folder / SEARCH) != identity:
            raise ConfigurationError(
                f"--resume: {folder} contains another search, or a search by another version of the program; use the "
                "same options, or --force to start again"
            )
        write_json(folder / SEARCH, identity)
        synchronise(folder / SEARCH)  # the rows are of no use without it
        table = CarTable(folder / CARS, problem)

        def attempt(points: Vector) -> TriedCars:
            values, reasons = trials(points)
            tried = TriedCars(points=points, values=values, reasons=tuple(reasons))
            table.add(tried)
            if progress is not None:
                progress(min((len(table.generations) - 1) / generations, 1.0))
            return tried

        stored = list(table.generations)
        base = stored[0] if stored else attempt(unmodified)
        return base, search(
            problem, attempt, population=population, generations=generations, seed=settings.seed, stored=stored[1:]
        )


def _identity(path: Path) -> object:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
