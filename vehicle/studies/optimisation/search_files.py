"""Files of a finished search: front as table and picture, vehicle files of the named cars, summary."""

import csv
import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.drawing.rendering.front_plot import FrontPicture, plot_front
from vehicle.errors import DataError
from vehicle.runs.car import Car
from vehicle.runs.output.folder import write_json, write_text, write_whole
from vehicle.runs.output.own_files import parameters_text, write_own_files
from vehicle.signals.formats.csv_table import RowWriter
from vehicle.studies.optimisation.car_table import CARS, cells, columns
from vehicle.studies.optimisation.front import distance, hypervolume
from vehicle.studies.optimisation.outcome import BASE, Outcome
from vehicle.studies.optimisation.problem import Problem

FRONT = "front.csv"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class OtherFront:
    """Pareto front of another search with the same objectives."""

    folder: Path  # folder of the other search
    values: Vector  # objectives of the other front; (f, goals)


def read_other_front(folder: Path, problem: Problem) -> OtherFront:
    """Read the Pareto front of another search."""
    goals = columns(problem)[len(problem.ranges) :][: len(problem.goals)]
    try:
        with (folder / FRONT).open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        values = np.array([[float(row[goal]) for goal in goals] for row in rows]).reshape(len(rows), len(goals))
    except (OSError, KeyError, TypeError, ValueError, UnicodeDecodeError):
        raise DataError(
            f"--beside {folder}: contains no {FRONT} with the columns {', '.join(goals)}; specify the folder of a "
            "finished search with these objectives"
        ) from None
    if not rows:
        raise DataError(f"--beside {folder}: {FRONT} has no rows; specify a finished search")
    return OtherFront(folder=folder, values=values)


def agreement(outcome: Outcome, beside: OtherFront) -> dict[str, float]:
    """Compare the front of another search: relative difference of the hypervolume, and mean distance [-].

    The distance is the mean of the distances in both directions, in extents of both fronts.
    """
    costs, other = outcome.costs, outcome.problem.costs(beside.values)
    both = np.concatenate([costs, other])
    ours, theirs = hypervolume(costs, both), hypervolume(other, both)
    mean = 0.5 * (distance(costs, other) + distance(other, costs))
    return {"hypervolume_change": theirs / ours - 1.0, "mean_distance": mean}


def front_text(outcome: Outcome, nominal: Vector | None) -> str:
    """Return the front as CSV.

    Args:
        outcome: outcome of the search.
        nominal: values of the cars of the front without tolerances, (f, criteria); None for a search without them.
    """
    text = io.StringIO()
    writer = RowWriter(text)
    criteria = [f"{criterion.label} without tolerances [{criterion.unit}]" for criterion in outcome.problem.criteria]
    writer.writerow(["name", *columns(outcome.problem), *([] if nominal is None else criteria)])
    names = {
        row: " and ".join(name for name, named_row in outcome.named.items() if named_row == row)
        for row in outcome.front
    }
    for number, row in enumerate(outcome.front):
        more = [] if nominal is None else cells(nominal[number])
        writer.writerow([names[row], *cells(outcome.tried.points[row]), *cells(outcome.tried.values[row]), *more])
    return text.getvalue()


def picture_of(outcome: Outcome, beside: OtherFront | None) -> FrontPicture:
    """Return the data of the picture of a search."""
    problem, goals = outcome.problem, len(outcome.problem.goals)
    values = outcome.tried.values[:, :goals]
    heads = columns(problem)
    return FrontPicture(
        objectives=heads[len(problem.ranges) :][:goals],
        tried=values[outcome.tried.kept(problem)],
        front=values[outcome.front],
        base=outcome.base.values[0, :goals],
        named={name: values[row] for name, row in outcome.named.items()},
        other=None if beside is None else (f"front of {beside.folder.name}", beside.values),
        parameters=heads[: len(problem.ranges)],
        shares=problem.share(outcome.tried.points[outcome.front]),
        base_shares=problem.share(np.array(problem.base)),
    )


def write_search(
    folder: Path,
    outcome: Outcome,
    cars: Mapping[str, Car],
    *,
    summary: Mapping[str, Any],
    caption: str,
    nominal: Vector | None = None,
    beside: OtherFront | None = None,
) -> None:
    """Write all files of a finished search except the table of the cars tried.

    Args:
        folder: folder of the files.
        outcome: outcome of the search.
        cars: name to named car.
        summary: further entries of the summary.
        caption: caption of the picture.
        nominal: values without tolerances, see `front_text`.
        beside: front of another search for comparison.
    """
    write_text(folder / FRONT, front_text(outcome, nominal))
    write_whole(folder / "front.png", lambda path: plot_front(path, picture_of(outcome, beside), caption))
    files = {"front": FRONT, "picture": "front.png"}
    files |= {"cars": CARS} if (folder / CARS).exists() else {}
    files["summary"] = "summary.json"
    points = {}
    for name, row in outcome.named.items():
        file = re.sub(r"[^A-Za-z0-9_.-]+", "_", name) + ".toml"
        header = f"{name} of a search; made with {' '.join(cars[name].overrides)}"
        write_text(folder / file, parameters_text(cars[name], header))
        files |= {name: file, **write_own_files(folder, cars[name])}
        paths = [bounds.path for bounds in outcome.problem.ranges]
        point = dict(zip(paths, outcome.tried.points[row].tolist(), strict=True))
        points[name] = {"vehicle": file, "overrides": list(cars[name].overrides), "parameters": point}
        points[name]["numbers"] = numbers(outcome.problem, outcome.tried.values[row])
    problem = outcome.problem
    write_json(
        folder / "summary.json",
        {
            **summary,
            "parameters": [
                {
                    "path": bounds.path,
                    "unit": unit,
                    "low": bounds.low,
                    "high": bounds.high,
                    "base": None if base != base else base,
                }
                for bounds, unit, base in zip(problem.ranges, problem.units, problem.base, strict=True)
            ],
            "objectives": [
                {"number": criterion.label, "unit": criterion.unit, "sense": criterion.sense}
                for criterion in problem.goals
            ],
            "limits": [criterion.expression for criterion in problem.limits],
            "cars": {
                "tried": len(outcome.tried.reasons),
                "keep_the_limits": int(np.count_nonzero(outcome.tried.kept(problem))),
                "failed": sum(bool(reason) for reason in outcome.tried.reasons),
                "on_the_front": outcome.front_size,
            },
            "hypervolume_reached": {f"{part:g}": share for part, share in outcome.reached.items()},
            "beside": None if beside is None else {"folder": str(beside.folder), **agreement(outcome, beside)},
            BASE: numbers(problem, outcome.base.values[0]),
            "points": points,
            "files": files,
        },
    )


def numbers(problem: Problem, values: Sequence[float]) -> dict[str, float | None]:
    """Return objective or limit to value, None for NaN."""
    pairs = zip(problem.criteria, values, strict=True)
    return {criterion.expression: None if value != value else float(value) for criterion, value in pairs}
