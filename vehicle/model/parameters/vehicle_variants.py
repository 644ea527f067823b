"""Variants of a vehicle that differ in numbers alone, without a new composition where the change is local."""

import contextlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.body import TrimmedBody
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.optional_keys import optional_paths
from vehicle.model.parameters.paths import meant, parsed_value, value_at
from vehicle.model.parameters.plausible import require_body, require_parts
from vehicle.model.parameters.quantity import type_hints
from vehicle.model.parameters.tested_range import StaleRanges
from vehicle.model.parameters.toml_file import build
from vehicle.model.parameters.vehicle import Solver, Vehicle
from vehicle.model.parameters.whole_body import body_moves, followers, put
from vehicle.names import AXES, SIDE_SIGN

SINGLE_TABLES: dict[str, type] = {"body": TrimmedBody, "solver": Solver}
"""Tables of a vehicle file that are one parameter object each."""


class VehicleVariants:
    """Variants of a vehicle with other values of parameters.

    Args:
        vehicle: vehicle that the variants start from.
        folder: folder of its file.
        compose_anew: function that composes the vehicle with overrides.
    """

    def __init__(self, vehicle: Vehicle, folder: Path, compose_anew: Callable[[Iterable[str]], Vehicle]) -> None:
        self.vehicle, self.folder, self._compose_anew = vehicle, folder, compose_anew
        self._numbers: dict[str, list[tuple[str, str]] | None] = {}

    def variant(self, overrides: Sequence[str]) -> Vehicle:
        """Return the vehicle after one variation.

        Raises:
            ConfigurationError: a name or a value is wrong.
        """
        # The complete composition raises the error with its full message.
        with contextlib.suppress(ConfigurationError):
            if (vehicle := self._local_variant(overrides)) is not None:
                return vehicle
        return self._compose_anew(overrides)

    def _local_variant(self, overrides: Sequence[str]) -> Vehicle | None:
        """Return the vehicle with other values; None if more than single numbers of elements change."""
        if self.vehicle.driving.accelerates:
            # Masses change its drive torques.
            return None
        table, changed = dict(self.vehicle.table), dict[str, None]()
        copies: set[int] = {id(table)}
        ranges = StaleRanges()
        for assignment in overrides:
            name, separator, text = (part.strip() for part in assignment.partition("="))
            if name not in self._numbers:
                self._numbers[name] = self._numbers_of(name) if separator and name else None
            numbers = self._numbers[name]
            if numbers is None:
                return None
            for path, owner in numbers:
                value = parsed_value(assignment, text, value_at(table, path))
                if isinstance(value, bool) or not isinstance(value, int | float):
                    return None
                put(table, {path: value}, copies)
                ranges.note(path, changed=value != value_at(self.vehicle.table, path))
                changed[owner] = None
        ranges.remove_from(table)
        if body_moves(self.vehicle.table, table):
            user_paths = {path for text in overrides for path, _ in self._numbers[text.partition("=")[0].strip()] or ()}
            put(table, followers(self.vehicle.table["body"], table["body"], user_paths), copies)
        return self._with_tables(table, changed)

    def _numbers_of(self, name: str) -> list[tuple[str, str]] | None:
        """Return the paths that a name of an override means, with the table of each; None if one is no number."""
        table = self.vehicle.table
        try:
            paths = meant(table, name, lambda: optional_paths(table, self.folder))
        except ConfigurationError:
            return None
        owners = [self._owner(path) for path in paths]
        return None if None in owners else [(path, str(owner)) for path, owner in zip(paths, owners, strict=True)]

    def _owner(self, path: str) -> str | None:
        """Return the table of the element that contains a number, without its side; None if no element does."""
        kinds = {**SINGLE_TABLES, **self.vehicle.composition.kinds}
        before, keys = value_at(self.vehicle.table, path), [key for key in path.split(".") if key not in SIDE_SIGN]
        for count in range(len(keys) - 1, 0, -1):
            if (owner := ".".join(keys[:count])) in kinds:
                inner = keys[count:]
                # A component of a vector is covered, a point of a curve is not.
                vector = len(inner) == 2 and type_hints(kinds[owner]).get(inner[0]) in (Point, Point | None)
                number = isinstance(before, int | float) and not isinstance(before, bool)
                return owner if number and (vector or inner[-1] not in AXES) else None
        return None

    def _with_tables(self, table: dict[str, Any], changed: Mapping[str, None]) -> Vehicle | None:
        """Return the vehicle of a table in which the numbers of some elements have changed; None if not covered."""
        objects: dict[str, Any] = {
            key: build(SINGLE_TABLES[key], table[key], key) for key in changed if key in SINGLE_TABLES
        }
        elements = {path: None for path in changed if path not in SINGLE_TABLES}
        composition = self.vehicle.composition.with_numbers(table, elements)
        if composition is None:
            return None
        vehicle = replace(self.vehicle, table=table, composition=composition, **objects)
        if composition.parts is not self.vehicle.composition.parts:
            require_parts(vehicle)
        if "body" in objects:
            require_body(vehicle)
        return vehicle
