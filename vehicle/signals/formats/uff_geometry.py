"""Read datasets 15, 2411 (nodes), 82, 2412 (lines, elements), 18 (axis systems), 164 (units) of a universal file.

Source: Universal File Datasets, University of Cincinnati SDRL.
"""

from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.geometry import Geometry
from vehicle.signals.formats.text import LARGEST
from vehicle.signals.formats.uff_blocks import numbers, refuse, wholes

BEAMS = (11, 21, 22, 23, 24)
"""Descriptors of elements with a cross-section line before the line of nodes."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Units:
    """Units of dataset 164: SI value = value in the file / factor.

    Attributes:
        length: factor of lengths [file unit per m].
        force: factor of forces [file unit per N].
    """

    length: float = 1.0
    force: float = 1.0

    @property
    def mass(self) -> float:
        """Factor of masses, which are forces over accelerations [file unit per kg]."""
        return self.force / self.length


def read_units(path: Path, where: str, lines: list[bytes]) -> Units:
    """Read the unit factors of dataset 164."""
    try:
        factors = numbers(lines[1:])[:2]
    except ValueError:
        factors = []
    if len(factors) < 2 or not 0.0 < min(factors) <= max(factors) < LARGEST:
        raise DataError(f"{path}: {where} has no valid factors of length and force; export it again")
    return Units(length=factors[0], force=factors[1])


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class AxisSystem:
    """Axis system of dataset 18 in global axes.

    Attributes:
        axes: columns are the x, y and z directions, (3, 3).
        origin: origin in the units of the file, (3,).
        cylindrical: True if coordinates are radius, angle [deg] and height.
    """

    axes: Vector
    origin: Vector
    cylindrical: bool = False

    def point(self, coordinates: Vector) -> Vector:
        """Convert coordinates in this system to global axes, (3,)."""
        if self.cylindrical:
            angle = np.radians(coordinates[1])
            coordinates = np.array([coordinates[0] * np.cos(angle), coordinates[0] * np.sin(angle), coordinates[2]])
        return self.origin + self.axes @ coordinates

    def directions(self, point: Vector) -> Vector:
        """Return the directions of the three components at a point in global axes, as columns (3, 3)."""
        if not self.cylindrical:
            return self.axes
        x, y, _ = self.axes.T @ (point - self.origin)
        angle = np.arctan2(y, x)
        turn = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
        return np.asarray(self.axes @ turn)


GLOBAL = AxisSystem(axes=np.eye(3), origin=np.zeros(3))


@dataclass(kw_only=True, slots=True)
class Nodes:
    """Content of the geometry datasets, in the order of the file.

    Attributes:
        at: node label -> definition system, displacement system, coordinates in the units of the file.
        systems: number -> axis system.
        lines: node labels of each line.
    """

    at: dict[int, tuple[int, int, Vector]] = field(default_factory=dict)
    systems: dict[int, AxisSystem] = field(default_factory=dict)
    lines: list[list[int]] = field(default_factory=list)

    def read(self, path: Path, number: int, where: str, lines: list[bytes]) -> bool:
        """Read a geometry dataset; return False for other datasets."""
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
            blank = len(parts) == 7  # some programs ignore the field widths
            self._add(
                [int(part) for part in parts[:4]] if blank else wholes(line[:40]),
                numbers(parts[4:] if blank else [line[40:]]),
            )

    def _long(self, lines: list[bytes]) -> None:
        for first, second in zip(lines[::2], lines[1::2], strict=True):
            self._add(wholes(first), numbers([second]))

    def _add(self, head: list[int], coordinates: list[float]) -> None:
        if len(head) < 3 or len(coordinates) != 3 or max(map(abs, coordinates)) > LARGEST:
            raise ValueError(f"node {head[:1]} with {len(coordinates)} coordinates")
        self.at[head[0]] = (head[1], head[2], np.array(coordinates))

    def _systems(self, lines: list[bytes]) -> None:
        for start in range(0, len(lines), 4):
            number, system_type, reference = wholes(lines[start])[:3]
            origin, ahead, plane = np.array(numbers(lines[start + 2 : start + 4])).reshape(3, 3)
            below = self.systems.get(reference, GLOBAL)
            if system_type not in (0, 1):
                raise ValueError(
                    f"axis system {number} has type {system_type} but must be 0 (Cartesian) or 1 (cylindrical)"
                )
            x_axis = ahead - origin
            y_axis = np.cross(plane - origin, x_axis)  # z is in the plane: y = z x x = (plane - origin) x x
            if not np.linalg.norm(x_axis) > 0.0 or not np.linalg.norm(y_axis) > 0.0:
                raise ValueError(f"axis system {number}: its three points are on a line")
            x, y = x_axis / np.linalg.norm(x_axis), y_axis / np.linalg.norm(y_axis)
            self.systems[number] = AxisSystem(
                axes=below.axes @ np.column_stack([x, y, np.cross(x, y)]),
                origin=below.point(origin),
                cylindrical=system_type == 1,
            )

    def _trace(self, lines: list[bytes]) -> None:
        count = wholes(lines[0])[1]
        labels = [label for line in lines[2:] for label in wholes(line)]
        if len(labels) < count or any(labels[count:]):  # a line may be padded with zeros
            raise ValueError(f"{count} nodes are stated, but {len(labels)} are present")
        # A zero moves the pen without drawing.
        breaks = [-1, *(n for n, label in enumerate(labels[:count]) if label == 0), count]
        strokes = (labels[first + 1 : last] for first, last in pairwise(breaks))
        self.lines += [stroke for stroke in strokes if len(stroke) > 1]

    def _elements(self, lines: list[bytes]) -> None:
        index = 0
        while index < len(lines):
            head = wholes(lines[index])
            descriptor, count = head[1], head[5]
            index += 2 if descriptor in BEAMS else 1
            labels: list[int] = []
            while len(labels) < count:
                labels += wholes(lines[index])
                index += 1
            if count > 1:
                self.lines.append(labels if count == 2 or descriptor in BEAMS else [*labels, labels[0]])

    def global_point(self, label: int) -> Vector:
        """Return the coordinates of a node in global axes, in the units of the file, (3,)."""
        system, _, coordinates = self.at[label]
        return self.systems.get(system, GLOBAL).point(coordinates)

    def directions(self, label: int) -> Vector:
        """Return the directions of the motion components at a node, as columns (3, 3); global axes if unknown."""
        if label not in self.at:
            return np.eye(3)
        system = self.systems.get(self.at[label][1], GLOBAL)
        return system.directions(self.global_point(label))

    def geometry(self, units: Units) -> Geometry:
        """Return the nodes in SI units and global axes, and the lines between existing nodes."""
        points = {str(label): tuple((self.global_point(label) / units.length).tolist()) for label in self.at}
        lines = [[str(label) for label in line] for line in self.lines if all(label in self.at for label in line)]
        return Geometry(points=points, lines=lines)
