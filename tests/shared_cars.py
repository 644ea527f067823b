"""Shipped cars that many tests load: equal ones are one car, built once in a process.

A car with its model, matrices, poles, checks and second-order forms takes 0.1 to 0.5 s; it does not change once it is
built, so that a car of a shipped file with equal changes serves every test that loads it. Cars of other files are built
anew, also those whose changes name a file.
"""

from collections import OrderedDict
from collections.abc import Callable
from pathlib import Path
from typing import Any

from vehicle.model.parameters.paths import assignments
from vehicle.model.parameters.shipped import VEHICLES, vehicle_file
from vehicle.runs.car import Car

SHARED = (
    *(
        "tests/commands/",
        "tests/core/test_own_",
        "tests/documentation/test_executed_pages",
        "tests/physics/",
        "tests/runs/car/",
    ),
    *("tests/runs/comparison/", "tests/signals/", "tests/studies/"),
    *(f"tests/system/test_{name}" for name in ("bad_inputs", "lost_files", "no_traceback", "road_run")),
)
"""Folders and modules of tests that share cars."""

MOST = 24
"""Cars that are kept; the one that has not been loaded for the longest time makes room."""

_kept: OrderedDict[tuple[str, ...], Car] = OrderedDict()


def share_cars(present: Callable[[], str]) -> None:
    """Let `Car.load` return the kept car in this process.

    Args:
        present: function that returns the node of the present test.
    """
    load = Car.load.__func__  # type: ignore[attr-defined]

    def shared(cls: type[Car], path: Path | str | None = None, overrides: Any = ()) -> Car:
        changes = assignments(overrides)
        shipped = path is None or VEHICLES in vehicle_file(path).resolve().parents
        if (
            not present().startswith(SHARED)
            or cls is not Car
            or not shipped
            or any("/" in text or ".csv" in text for text in changes)
        ):
            made: Car = load(cls, path, changes)
            return made
        key = (str(path), *changes)
        car = _kept.pop(key, None) or load(cls, path, changes)
        _kept[key] = car
        if len(_kept) > MOST:
            _kept.popitem(last=False)
        return car

    Car.load = classmethod(shared)  # type: ignore[assignment, method-assign]
