"""Change every number of the shipped cars: either a number of the engines changes, or a notice says "has no effect".

    python -m tests.benchmarks.parameters_without_effect [CAR ...]

Numbers of the engines are those of the linear system, the static loads, the records of all elements and forces, the
rate of the samples and the velocity of slip. A parameter that changes none of them and has no notice is silent.
"""

import sys
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle import Car
from vehicle.errors import VehicleError
from vehicle.model.assembly.element_numbers import element_numbers
from vehicle.model.parameters.idle import idle_parameters
from vehicle.model.parameters.parameter_list import parameter_list
from vehicle.model.parameters.shipped import CARS
from vehicle.names import AXES

STATES: dict[str, list[str]] = {"standing": [], "rolling at 80 km/h": ["driving.speed=22.2"]}
ROUNDING = 1e-12
"""Relative to the largest number of an array: both cars are computed in the same way."""


@dataclass
class Effects:
    """Parameters of a car by their effect: paths that act, have a notice (path to notice), or are silent; refused."""

    acting: list[str] = field(default_factory=list)
    noted: dict[str, str] = field(default_factory=dict)
    silent: list[str] = field(default_factory=list)
    refused: dict[str, str] = field(default_factory=dict)


def numbers_in(data: Any) -> Iterator[npt.NDArray[np.float64]]:
    """Yield all numbers in nested data as arrays."""
    if isinstance(data, bool | str) or data is None:
        return
    if isinstance(data, int | float | complex):
        data = np.array([data])
    if hasattr(data, "toarray"):
        data = data.toarray()
    if isinstance(data, np.ndarray):
        if data.dtype.kind == "c":
            yield from (data.real.ravel(), data.imag.ravel())
        elif data.dtype.kind in "fiu":
            yield data.astype(float).ravel()
    elif isinstance(data, Mapping):
        for value in data.values():
            yield from numbers_in(value)
    elif isinstance(data, list | tuple):
        for value in data:
            yield from numbers_in(value)
    elif is_dataclass(data):
        yield from numbers_in([getattr(data, each.name) for each in fields(data)])


def numbers_of_engines(car: Car) -> list[npt.NDArray[np.float64]]:
    """Return the numbers that both engines get of a car."""
    vehicle, composition = car.vehicle, car.vehicle.composition
    slip = [damper.law.slip_velocity for damper in composition.dampers]
    elements = element_numbers(vehicle, car.model.superelement)
    hold = [[value for name, value in each.items()] for each in elements]
    return list(
        numbers_in([car.matrices.system, car.static, hold, composition.forces, slip, vehicle.solver.record_rate,
                    vehicle.solver.timestep])
    )  # fmt: skip


def equal(one: Sequence[npt.NDArray[np.float64]], other: Sequence[npt.NDArray[np.float64]]) -> bool:
    """Return True if no number differs beyond rounding."""
    return len(one) == len(other) and all(
        a.shape == b.shape and np.max(np.abs(a - b), initial=0.0) <= ROUNDING * np.max(np.abs(a), initial=0.0)
        for a, b in zip(one, other, strict=True)
    )


def numeric_paths(car: Car) -> dict[str, Any]:
    """Return path to value of every number that `show` lists, with the components of vectors."""
    paths: dict[str, Any] = {}
    for each in parameter_list(car.vehicle, None):
        value = each.value
        if isinstance(value, int | float) and not isinstance(value, bool):
            paths[each.path] = float(value)
        elif isinstance(value, list | tuple) and value and all(isinstance(part, int | float) for part in value):
            if len(value) == len(AXES) and each.unit != "-" and not each.path.endswith(("force", "velocity")):
                paths |= {f"{each.path}.{axis}": float(part) for axis, part in zip(AXES, value, strict=True)}
            else:
                paths[each.path] = list(value)
    return paths


def changed_values(value: Any) -> Iterator[Any]:
    """Yield other values of a parameter, of which a car takes the first that is allowed."""
    if isinstance(value, list):
        for index in reversed(range(len(value))):
            for factor in (1.01, 0.99):
                yield [part * (factor if n == index else 1.0) + (0.0 if value[n] or n != index else 0.01)
                       for n, part in enumerate(value)]  # fmt: skip
        return
    if value:
        yield from (value * factor for factor in (1.02, 0.98, 1.2, 0.8))
    yield from (value + step for step in (0.01, -0.01, 1e-3, -1e-3, 1e-4, 1.0, 10.0))


def effects(car: Car, paths: Mapping[str, Any]) -> Effects:
    """Change each parameter alone.

    Args:
        car: the car.
        paths: path to value, see `numeric_paths`.
    """
    result = Effects()
    for path, value in paths.items():
        reason = ""
        for other in changed_values(value):
            text = f"{path}={other!r}"
            try:
                changed = car.with_([text])
                numbers = numbers_of_engines(changed)
            except VehicleError as error:
                reason = str(error)
                continue
            if notices := idle_parameters(changed.vehicle, [text], "mujoco"):
                result.noted[path] = notices[0]
            elif equal(numbers_of_engines(car.with_([f"{path}={value!r}"])), numbers):
                result.silent.append(path)
            else:
                result.acting.append(path)
            break
        else:
            result.refused[path] = reason
    return result


def main() -> None:
    """Print a line for each car and state, then the silent and the refused parameters."""
    for name in sys.argv[1:] or CARS:
        for state, overrides in STATES.items():
            try:
                car = Car.load(name, overrides)
            except VehicleError as error:
                print(f"{name}, {state}: refused: {error}")
                continue
            found = effects(car, numeric_paths(car))
            print(
                f"{name}, {state}: {len(found.acting)} act, {len(found.noted)} without effect, "
                f"{len(found.silent)} silent, {len(found.refused)} refused",
                flush=True,
            )
            for reason, count in Counter(text.partition("only with ")[2] for text in found.noted.values()).items():
                print(f"    {count} without effect but with {reason}")
            for path in found.silent:
                print(f"    silent: {path}")
            for path, reason in found.refused.items():
                print(f"    refused: {path}: {reason}")


if __name__ == "__main__":
    main()
