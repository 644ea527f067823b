"""A vehicle with other numbers in the places of some of its own: what they do not move is not composed again."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.additions import load_numbers
from vehicle.model.parameters.body import TrimmedBody
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.instance import Instance
from vehicle.model.parameters.loads import Load
from vehicle.model.parameters.optional_keys import optional_paths
from vehicle.model.parameters.paths import meant, parsed_value, value_at
from vehicle.model.parameters.plausible import require_body, require_parts
from vehicle.model.parameters.toml_file import build, type_hints
from vehicle.model.parameters.vehicle import Solver, Vehicle
from vehicle.model.parameters.whole_body import body_moves, followers
from vehicle.names import AXES, SIDE_SIGN

WHOLE: dict[str, type] = {"body": TrimmedBody, "solver": Solver}
"""Tables that are one element each."""


class Family:
    """Vehicles that differ from one in the values of parameters.

    Args:
        vehicle: the one.
        folder: where its file lies.
        whole: reads and composes it anew with overrides.
    """

    def __init__(self, vehicle: Vehicle, folder: Path, whole: Callable[[Iterable[str]], Vehicle]) -> None:
        self.vehicle, self.folder, self._whole = vehicle, folder, whole
        self._places: dict[str, list[tuple[str, str]] | None] = {}

    def vehicle_of(self, overrides: Sequence[str], before: Sequence[str] = ()) -> Vehicle:
        """The vehicle with other values.

        Args:
            overrides: texts "path=value".
            before: those that this one was made with, which say what does not follow mass and CoG of the body.

        Raises:
            ConfigurationError: a name or a value is wrong.
        """
        # What is wrong is said where the whole is read.
        with contextlib.suppress(ConfigurationError):
            if (found := self._vehicle_of(overrides, before)) is not None:
                return found
        return self._whole(overrides)

    def _vehicle_of(self, overrides: Sequence[str], before: Sequence[str]) -> Vehicle | None:
        """The vehicle, None where more than single numbers of elements change."""
        table, moved = dict(self.vehicle.table), dict[str, None]()
        fresh: set[int] = {id(table)}
        for assignment in overrides:
            given, separator, text = (part.strip() for part in assignment.partition("="))
            if given not in self._places:
                self._places[given] = self._numbers(given) if separator and given else None
            places = self._places[given]
            if places is None:
                return None
            for path, owner in places:
                value = parsed_value(assignment, text, 0.0)
                if isinstance(value, bool) or not isinstance(value, int | float):
                    return None
                _put(table, path, value, fresh)
                moved[owner] = None
        if body_moves(self.vehicle.table, table):
            optional = partial(optional_paths, table, self.folder)
            known = [meant(table, text.partition("=")[0].strip(), optional) for text in before]
            here = [path for text in overrides for path, _ in self._places[text.partition("=")[0].strip()] or ()]
            for path, value in followers(self.vehicle.table["body"], table["body"], {*chain(*known), *here}).items():
                _put(table, path, value, fresh)
        return self._recomposed(table, moved)

    def _numbers(self, given: str) -> list[tuple[str, str]] | None:
        """Whole paths that a text means, each with the table that it is of; None where one is not a single number."""
        table = self.vehicle.table
        try:
            places = meant(table, given, lambda: optional_paths(table, self.folder))
        except ConfigurationError:
            return None
        owners = [self._owner(path) for path in places]
        return None if None in owners else [(path, str(owner)) for path, owner in zip(places, owners, strict=True)]

    def _owner(self, path: str) -> str | None:
        """The table of an element that a number is in, without its side; None where it is in none."""
        kinds = {**WHOLE, **self.vehicle.composition.kinds}
        old, words = value_at(self.vehicle.table, path), [one for one in path.split(".") if one not in SIDE_SIGN]
        for count in range(len(words) - 1, 0, -1):
            if (owner := ".".join(words[:count])) in kinds:
                inner = words[count:]
                # A component is one of a vector, not of the points of a curve.
                vector = len(inner) == 2 and type_hints(kinds[owner]).get(inner[0]) in (Point, Point | None)
                number = isinstance(old, int | float) and not isinstance(old, bool)
                return owner if number and (vector or inner[-1] not in AXES) else None
        return None

    def _recomposed(self, table: dict[str, Any], moved: Mapping[str, None]) -> Vehicle | None:
        """The vehicle of a table in which the numbers of some elements have changed."""
        found: dict[str, Any] = {key: build(WHOLE[key], table[key], key) for key in moved if key in WHOLE}
        car, instances, left = self.vehicle.composition, dict[str, Instance](), set(moved) - set(WHOLE)
        changed: dict[str, Any] = {}
        for kind, sources in car.sources.items():
            own = list(getattr(car, kind))
            for index, (one, source) in enumerate(zip(own, sources, strict=False)):
                if one.path not in moved:
                    continue
                name = source.instance.name
                if name not in instances:
                    numbers = value_at(table, name)
                    instances[name] = replace(source.instance, numbers=numbers, typed={}, taken=set())
                own[index] = source.make(instances[name], source.entry, source.side)
                left.discard(one.path)
                changed[kind] = tuple(own)
        for index, one in enumerate(car.parts):
            if one.path in left and isinstance(one.numbers, Load):
                loads = changed.setdefault("parts", list(car.parts))
                changed["parts"] = (
                    *loads[:index],
                    replace(one, numbers=load_numbers(one.path, value_at(table, one.path))),
                    *loads[index + 1 :],
                )
                left.discard(one.path)
        if left:
            return None
        vehicle = replace(self.vehicle, table=table, composition=replace(car, **changed), **found)
        if "parts" in changed:
            require_parts(vehicle)
        if "body" in found:
            require_body(vehicle)
        return vehicle


def _put(table: dict[str, Any], path: str, value: float, own: set[int]) -> None:
    """Put a number into its place; what lies above it is copied once. `own`: identities of the copies."""
    *parents, name = path.split(".")
    outer: Any = table
    for parent in parents:
        key: Any = AXES.index(parent) if isinstance(outer, list) else parent
        if id(outer[key]) not in own:
            outer[key] = outer[key].copy()
            own.add(id(outer[key]))
        outer = outer[key]
    outer[AXES.index(name) if isinstance(outer, list) else name] = value
