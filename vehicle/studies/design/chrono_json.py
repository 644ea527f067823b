"""JSON files of Project Chrono's vehicle models: a file, and the files that it names.

Chrono's frame is x forward, y to the left, z up (ISO 8855), the vehicle frame x to the rear, y to the right, z up: a
turn by 180 degrees about z. A suspension file has the left side, a vehicle file the right one:

    (x, y, z) of the left side in Chrono  ->  (-x, y, z) of the right side here,   I -> M I M,   M = diag(-1, 1, 1)

Format: projectchrono.org, chrono_vehicle, "JSON specification"; files: github.com/projectchrono/chrono, data/vehicle.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, DataError

LARGEST_FILE = 10_000_000
"""Maximum size of a JSON file [byte]; those of Chrono's cars have a few thousand."""

REFLECTION = np.array([-1.0, 1.0, 1.0])
"""From the left side in Chrono's frame to the right side in the vehicle frame."""

_COMMENT = re.compile(r'"(?:[^"\\]|\\.)*"|(//[^\n]*|/\*.*?\*/)', re.DOTALL)


@dataclass(frozen=True, kw_only=True, slots=True)
class ChronoFile:
    """Table of a JSON file of Chrono, or a table inside it; a value that is missing or of another type is a DataError.

    Attributes:
        path: path of the file.
        table: its values by name.
        inside: names of the tables above, for messages and sources.
    """

    path: Path
    table: Mapping[str, Any]
    inside: tuple[str, ...] = ()

    def __contains__(self, name: str) -> bool:
        return name in self.table

    def source(self, *names: str) -> str:
        """Return the place of a value, as "Sedan_Wheel.json, Mass"."""
        return (
            ", ".join((self.path.name, " / ".join((*self.inside, *names)))) if self.inside or names else self.path.name
        )

    def _wrong(self, name: str, text: str) -> DataError:
        """Return the error of a value."""
        return DataError(f"{self.path}: {' / '.join((*self.inside, name))} {text}")

    def _value(self, name: str) -> Any:
        if name not in self.table:
            raise self._wrong(name, "is missing; add it")
        return self.table[name]

    def section(self, name: str) -> ChronoFile:
        """Return an inner table."""
        value = self._value(name)
        if not isinstance(value, Mapping):
            raise self._wrong(name, f"has {value!r}, must be an object in braces")
        return ChronoFile(path=self.path, table=value, inside=(*self.inside, name))

    def sections(self, name: str) -> list[ChronoFile]:
        """Return a list of inner tables; empty if it is missing."""
        values = self.table.get(name, [])
        if not isinstance(values, list) or not all(isinstance(value, Mapping) for value in values):
            raise self._wrong(name, "must be a list of objects in braces")
        inside = (*self.inside, name)
        return [
            ChronoFile(path=self.path, table=value, inside=(*inside[:-1], f"{name}[{index}]"))
            for index, value in enumerate(values)
        ]

    def text(self, name: str) -> str:
        """Return a text."""
        if not isinstance(value := self._value(name), str):
            raise self._wrong(name, f"has {value!r}, must be a text")
        return value

    def number(self, name: str) -> float:
        """Return a number, in the unit of the file: Chrono has SI units."""
        value = self._value(name)
        if isinstance(value, bool) or not isinstance(value, int | float) or not np.isfinite(value):
            raise self._wrong(name, f"has {value!r}, must be a finite number")
        return float(value)

    def array(self, name: str, *shape: int) -> Vector:
        """Return a list of numbers as an array of a shape, with -1 for any length."""
        value = self._value(name)
        try:
            array = np.array(value, dtype=float)
        except (TypeError, ValueError):
            array = np.array(np.nan)
        fits = array.ndim == len(shape) and all(n in (-1, m) for n, m in zip(shape, array.shape, strict=True))
        if not fits or not np.isfinite(array).all():
            size = " x ".join("n" if n < 0 else str(n) for n in shape)
            raise self._wrong(name, f"must be a list of {size} finite numbers")
        return array

    def curve(self, name: str) -> Vector:
        """Return the points of a curve, (n, 2): two or more, whose first numbers rise."""
        points = self.array(name, -1, 2)
        if len(points) < 2 or np.any(np.diff(points[:, 0]) <= 0.0):
            raise self._wrong(name, "must have two points or more, whose first numbers rise")
        return points

    def named_file(self, name: str) -> ChronoFile:
        """Read a file by a name in this file: relative to a parent folder (data/vehicle), or in the same folder.

        Raises:
            ConfigurationError: the file is missing.
        """
        relative = self.text(name)
        candidates = [folder / relative for folder in self.path.absolute().parents]
        candidates.append(self.path.parent / Path(relative).name)
        for candidate in candidates:
            if candidate.is_file():
                return read_chrono_file(candidate)
        raise ConfigurationError(
            f"{self.path}: {' / '.join((*self.inside, name))} names {relative}, which is neither in the folder "
            "of this file nor in a folder above it; copy it there with its folders, as in Chrono's data/vehicle"
        )


def read_chrono_file(path: Path) -> ChronoFile:
    """Read a JSON file of Chrono, which may contain comments.

    Raises:
        ConfigurationError: the file is missing or too large.
        DataError: it is no JSON table.
    """
    if not path.is_file():
        raise ConfigurationError(f"{path}: the file does not exist; give the JSON file of a Chrono vehicle")
    if path.stat().st_size > LARGEST_FILE:
        raise ConfigurationError(f"{path}: is larger than {LARGEST_FILE / 1e6:g} MB, so it is not a Chrono vehicle")
    text = path.read_bytes().decode("utf-8-sig", errors="replace")
    try:
        table = json.loads(_COMMENT.sub(lambda match: " " if match[1] else match[0], text))
    except (json.JSONDecodeError, RecursionError) as error:
        raise DataError(f"{path}: not a JSON file: {error}") from None
    if not isinstance(table, Mapping):
        raise DataError(f"{path}: must be a JSON object in braces")
    return ChronoFile(path=path, table=table)


def tensor(moments: Vector, products: Vector) -> Vector:
    """Return the inertia tensor of Chrono's moments and products, which are its elements xy, xz, yz: -int x y dm."""
    xy, xz, yz = products
    return np.array([[moments[0], xy, xz], [xy, moments[1], yz], [xz, yz, moments[2]]])


def rotation(quaternion: Vector) -> Vector:
    """Return the rotation matrix of a quaternion (w, x, y, z), (3, 3)."""
    w, x, y, z = quaternion / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
