"""Datasets 15, 2411 (nodes), 82, 2412 (lines, elements), 18 (axis systems) and 164 (units) of a universal file.

Source: Universal File Datasets, University of Cincinnati SDRL.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehicle.errors import DataError
from vehicle.signals.records.geometry import Geometry
from vehicle.signals.records.table import Vector
from vehicle.signals.records.text import LARGEST
from vehicle.signals.records.uff_blocks import numbers, refuse, wholes

BEAMS = (11, 21, 22, 23, 24)
"""Descriptors of elements that have a line of their cross section before that of their nodes."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Units:
    """Dataset 164: what a number in the file is divided by to get SI."""

    length: float = 1.0
    force: float = 1.0

    @property
    def mass(self) -> float:
        """What a mass is divided by: masses are forces over accelerations."""
        return self.force / self.length


def read_units(path: Path, where: str, lines: list[bytes]) -> Units:
    """Dataset 164.

    Raises:
        DataError: it holds no factors.
    """
    try:
        found = numbers(lines[1:])[:2]
    except ValueError:
        found = []
    if len(found) < 2 or not 0.0 < min(found) <= max(found) < LARGEST:
        raise DataError(f"{path}: {where} tells no factors of length and force; export it again")
    return Units(length=found[0], force=found[1])


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class AxisSystem:
    """A system of dataset 18 in the global axes.

    Attributes:
        axes: columns are its x, y and z, (3, 3).
        origin: in the units of the file, (3,).
        cylindrical: whether its coordinates are radius, angle [deg] and height.
    """

    axes: NDArray[np.float64]
    origin: Vector
    cylindrical: bool = False

    def point(self, at: Vector) -> Vector:
        """Coordinates of a point of this system in the global axes, (3,)."""
        if self.cylindrical:
            angle = np.radians(at[1])
            at = np.array([at[0] * np.cos(angle), at[0] * np.sin(angle), at[2]])
        return self.origin + self.axes @ at

    def directions(self, point: Vector) -> NDArray[np.float64]:
        """Columns are the directions of its three components at a point of the global axes, (3, 3)."""
        if not self.cylindrical:
            return self.axes
        x, y, _ = self.axes.T @ (point - self.origin)
        angle = np.arctan2(y, x)
        turn = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
        return np.asarray(self.axes @ turn)


GLOBAL = AxisSystem(axes=np.eye(3), origin=np.zeros(3))


@dataclass(kw_only=True, slots=True)
class Nodes:
    """What the datasets of geometry hold, in the order in which they stand in the file.

    Attributes:
        at: label to definition system, displacement system, and coordinates in the units of the file.
        systems: number to axis system.
        lines: of labels.
    """

    at: dict[int, tuple[int, int, Vector]] = field(default_factory=dict)
    systems: dict[int, AxisSystem] = field(default_factory=dict)
    lines: list[list[int]] = field(default_factory=list)

    def read(self, path: Path, number: int, where: str, lines: list[bytes]) -> bool:
        """Take in a dataset; False for one of another kind.

        Raises:
            DataError: it is damaged.
        """
        readers = {15: self._short, 2411: self._long, 18: self._systems, 82: self._trace, 2412: self._elements}
        if number not in readers:
            return False
        try:
            readers[number]([line for line in lines if line.strip()])
        except (ValueError, IndexError) as error:
            refuse(path, where, error)
        return True

    def _short(self, lines: list[bytes]) -> None:
        for line in lines:
            parts = line.split()
            blank = len(parts) == 7  # some programs do not keep the columns
            self._add(
                [int(part) for part in parts[:4]] if blank else wholes(line[:40]),
                numbers(parts[4:] if blank else [line[40:]]),
            )

    def _long(self, lines: list[bytes]) -> None:
        for first, second in zip(lines[::2], lines[1::2], strict=True):
            self._add(wholes(first), numbers([second]))

    def _add(self, head: list[int], at: list[float]) -> None:
        if len(head) < 3 or len(at) != 3 or max(map(abs, at)) > LARGEST:
            raise ValueError(f"node {head[:1]} with {len(at)} coordinates")
        self.at[head[0]] = (head[1], head[2], np.array(at))

    def _systems(self, lines: list[bytes]) -> None:
        for start in range(0, len(lines), 4):
            number, kind, reference = wholes(lines[start])[:3]
            origin, ahead, plane = np.array(numbers(lines[start + 2 : start + 4])).reshape(3, 3)
            below = self.systems.get(reference, GLOBAL)
            if kind not in (0, 1):
                raise ValueError(f"axis system {number} of type {kind}; known are 0, Cartesian, and 1, cylindrical")
            along = ahead - origin
            across = np.cross(plane - origin, along)  # z lies in the plane: y = z x x = (plane - origin) x x
            if not np.linalg.norm(along) > 0.0 or not np.linalg.norm(across) > 0.0:
                raise ValueError(f"axis system {number}: its three points lie in a line")
            x, y = along / np.linalg.norm(along), across / np.linalg.norm(across)
            self.systems[number] = AxisSystem(
                axes=below.axes @ np.column_stack([x, y, np.cross(x, y)]),
                origin=below.point(origin),
                cylindrical=kind == 1,
            )

    def _trace(self, lines: list[bytes]) -> None:
        count = wholes(lines[0])[1]
        held = [label for line in lines[2:] for label in wholes(line)]
        if len(held) < count or any(held[count:]):  # a line may be filled up with zeros
            raise ValueError(f"{count} nodes are told, {len(held)} are held")
        self.lines += [stroke for stroke in _strokes(held[:count]) if len(stroke) > 1]

    def _elements(self, lines: list[bytes]) -> None:
        place = 0
        while place < len(lines):
            head = wholes(lines[place])
            descriptor, count = head[1], head[5]
            place += 2 if descriptor in BEAMS else 1
            held: list[int] = []
            while len(held) < count:
                held += wholes(lines[place])
                place += 1
            if count > 1:
                self.lines.append(held if count == 2 or descriptor in BEAMS else [*held, held[0]])

    def global_point(self, label: int) -> Vector:
        """Coordinates of a node in the global axes, in the units of the file, (3,)."""
        system, _, at = self.at[label]
        return self.systems.get(system, GLOBAL).point(at)

    def directions(self, label: int) -> NDArray[np.float64]:
        """Columns are the directions of the components of a motion at a node, (3, 3); the global axes of an unknown."""
        if label not in self.at:
            return np.eye(3)
        system = self.systems.get(self.at[label][1], GLOBAL)
        return system.directions(self.global_point(label))

    def geometry(self, units: Units) -> Geometry:
        """The nodes in SI and global axes, and the lines between nodes that exist."""
        points = {str(label): tuple((self.global_point(label) / units.length).tolist()) for label in self.at}
        lines = [[str(label) for label in line] for line in self.lines if all(label in self.at for label in line)]
        return Geometry(points=points, lines=lines)


def _strokes(labels: list[int]) -> Iterator[list[int]]:
    """A trace line without its jumps: 0 moves the pen without drawing."""
    breaks = [-1, *(n for n, label in enumerate(labels) if label == 0), len(labels)]
    yield from (labels[first + 1 : last] for first, last in pairwise(breaks))
