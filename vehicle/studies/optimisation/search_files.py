"""Files of a finished search: the front as table and picture, a vehicle file for each named car, the summary."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.drawing.rendering.front_plot import FrontPicture, plot_front
from vehicle.errors import DataError
from vehicle.runs.car import Car
from vehicle.runs.output.folder import write_json, write_text, write_whole
from vehicle.runs.output.own_files import parameters_text, write_own_files
from vehicle.studies.optimisation.car_table import CARS, cells, columns
from vehicle.studies.optimisation.front import distance, hypervolume
from vehicle.studies.optimisation.outcome import BASE, Outcome
from vehicle.studies.optimisation.problem import Problem, Vector

FRONT = "front.csv"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Beside:
    """The front of another search with the same objectives.

    Attributes:
        folder: of it.
        values: its objectives; (f, goals).
    """

    folder: Path
    values: Vector


def read_beside(folder: Path, problem: Problem) -> Beside:
    """The front of another search.

    Raises:
        DataError: there is none, or it has not these objectives.
    """
    goals = columns(problem)[len(problem.ranges) :][: len(problem.goals)]
    try:
        with (folder / FRONT).open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        values = np.array([[float(row[goal]) for goal in goals] for row in rows]).reshape(len(rows), len(goals))
    except (OSError, KeyError, TypeError, ValueError, UnicodeDecodeError):
        raise DataError(
            f"--beside {folder}: holds no {FRONT} with the columns {', '.join(goals)}; give the folder of a finished "
            "search with these objectives"
        ) from None
    if not rows:
        raise DataError(f"--beside {folder}: its {FRONT} has no rows")
    return Beside(folder=folder, values=values)


def agreement(found: Outcome, beside: Beside) -> dict[str, float]:
    """How the front of another search differs: its hypervolume less ours over ours, mean distance of both ways [-]."""
    costs, other = found.costs, found.problem.costs(beside.values)
    both = np.concatenate([costs, other])
    ours, theirs = hypervolume(costs, both), hypervolume(other, both)
    mean = 0.5 * (distance(costs, other) + distance(other, costs))
    return {"hypervolume_change": theirs / ours - 1.0, "mean_distance": mean}


def front_text(found: Outcome, nominal: Vector | None) -> str:
    """The front as CSV.

    Args:
        found: the search.
        nominal: numbers of its cars without tolerances, (f, wishes); None where there are none.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    wishes = [f"{wish.label} without tolerances [{wish.unit}]" for wish in found.problem.wishes]
    writer.writerow(["name", *columns(found.problem), *([] if nominal is None else wishes)])
    names = {row: " and ".join(name for name, one in found.named.items() if one == row) for row in found.front}
    for number, row in enumerate(found.front):
        more = [] if nominal is None else cells(nominal[number])
        writer.writerow([names[row], *cells(found.tried.points[row]), *cells(found.tried.values[row]), *more])
    return text.getvalue()


def picture_of(found: Outcome, beside: Beside | None) -> FrontPicture:
    """The picture of a search."""
    problem, goals = found.problem, len(found.problem.goals)
    values = found.tried.values[:, :goals]
    heads = columns(problem)
    return FrontPicture(
        objectives=heads[len(problem.ranges) :][:goals],
        tried=values[found.tried.kept(problem)],
        front=values[found.front],
        base=found.base.values[0, :goals],
        named={name: values[row] for name, row in found.named.items()},
        other=None if beside is None else (f"front of {beside.folder.name}", beside.values),
        parameters=heads[: len(problem.ranges)],
        shares=problem.share(found.tried.points[found.front]),
        base_shares=problem.share(np.array(problem.base)),
    )


def write_search(
    folder: Path,
    found: Outcome,
    cars: Mapping[str, Car],
    *,
    summary: Mapping[str, Any],
    caption: str,
    nominal: Vector | None = None,
    beside: Beside | None = None,
) -> None:
    """Write all files of a finished search but the cars that were tried.

    Args:
        folder: where to.
        found: the search.
        cars: those with a name.
        summary: what it says beside.
        caption: of the picture.
        nominal: as of `front_text`.
        beside: another search to put beside.
    """
    write_text(folder / FRONT, front_text(found, nominal))
    write_whole(folder / "front.png", lambda path: plot_front(path, picture_of(found, beside), caption))
    files = {"front": FRONT, "picture": "front.png"}
    files |= {"cars": CARS} if (folder / CARS).exists() else {}
    files["summary"] = "summary.json"
    points = {}
    for name, row in found.named.items():
        file = re.sub(r"[^A-Za-z0-9_.-]+", "_", name) + ".toml"
        header = f"{name} of a search; made with {' '.join(cars[name].overrides)}"
        write_text(folder / file, parameters_text(cars[name], header))
        files |= {name: file, **write_own_files(folder, cars[name])}
        point = dict(zip((one.path for one in found.problem.ranges), found.tried.points[row].tolist(), strict=True))
        points[name] = {"vehicle": file, "overrides": list(cars[name].overrides), "parameters": point}
        points[name]["numbers"] = numbers(found.problem, found.tried.values[row])
    problem = found.problem
    write_json(
        folder / "summary.json",
        {
            **summary,
            "parameters": [
                {
                    "path": one.path,
                    "unit": unit,
                    "low": one.low,
                    "high": one.high,
                    "base": None if base != base else base,
                }
                for one, unit, base in zip(problem.ranges, problem.units, problem.base, strict=True)
            ],
            "objectives": [{"number": one.label, "unit": one.unit, "sense": one.sense} for one in problem.goals],
            "limits": [one.words for one in problem.limits],
            "cars": {
                "tried": len(found.tried.reasons),
                "keep_the_limits": int(np.count_nonzero(found.tried.kept(problem))),
                "failed": sum(bool(reason) for reason in found.tried.reasons),
                "on_the_front": found.whole,
            },
            "hypervolume_reached": {f"{part:g}": share for part, share in found.reached.items()},
            "beside": None if beside is None else {"folder": str(beside.folder), **agreement(found, beside)},
            BASE: numbers(problem, found.base.values[0]),
            "points": points,
            "files": files,
        },
    )


def numbers(problem: Problem, values: Sequence[float]) -> dict[str, float | None]:
    """Label to number, None where it does not exist."""
    pairs = zip(problem.wishes, values, strict=True)
    return {wish.words: None if value != value else float(value) for wish, value in pairs}
