"""Single obstacles on a level road, as lines between corners: cleat, half round, speed bump, ramp, pothole, cobbles.

An obstacle is named by a text NAME[:SIZES][:SIDE][@PLACE]: sizes in mm separated by x, side left or right (both by
default), and the distance of its beginning from the start of the foremost wheels in m, as "cleat:20x50:right@40".
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Self

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.excitation.measured_road import MeasuredRoad
from vehicle.signals.excitation.tyre_envelope import TyreEnvelope

EDGE = 1e-6
"""Length of a vertical edge [m]: heights over the distance need one value at each point."""

ARC = 32
"""Number of straight lines of an arc; they lie below a half circle of 50 mm by at most 0.06 mm."""

LARGEST = {"height": 500.0, "radius": 500.0, "length": 50_000.0}
"""Maximum sizes [mm]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Shape:
    """Shape of an obstacle.

    Attributes:
        sizes: names of the sizes, in mm, or without unit for a number.
        usual: default sizes.
        outline: function of the sizes [m] and a random generator that returns distances and heights of the corners
            [m], (n,) each, from the beginning of the obstacle on.
        arc: True if the first size is the height of an arc over the second; above half of it the arc would overhang.
    """

    sizes: tuple[str, ...]
    usual: tuple[float, ...]
    outline: Callable[[tuple[float, ...], np.random.Generator], tuple[Vector, Vector]]
    arc: bool = False


def _box(height: float, length: float) -> tuple[Vector, Vector]:
    """Return the corners of a rectangle with vertical edges."""
    return np.array([0.0, EDGE, length - EDGE, length]), np.array([0.0, height, height, 0.0])


def _arc(height: float, length: float) -> tuple[Vector, Vector]:
    """Return corners on a segment of a circle of this height over this length, at equal angles."""
    radius = 0.5 * height + length**2 / (8.0 * height)
    half = 2.0 * np.arctan2(2.0 * height, length)
    angles = np.linspace(-half, half, ARC + 1)
    x, z = 0.5 * length + radius * np.sin(angles), height - radius * (1.0 - np.cos(angles))
    x[0], x[-1], z[0], z[-1] = 0.0, length, 0.0, 0.0
    return x, z


def _cobbles(sizes: tuple[float, ...], generator: np.random.Generator) -> tuple[Vector, Vector]:
    """Return the corners of a row of stones: arcs on levels within half a crown height above and below."""
    height, length, number = sizes
    x, z = _arc(height, length)
    # The edges are inside the stone, so that two stones have different points.
    x = np.clip(x, EDGE, length - EDGE)
    levels = height * (generator.random(round(number)) - 0.5)
    stones = np.arange(levels.size)[:, None] * length + x
    ends = [0.0], [levels.size * length]
    return np.concatenate((ends[0], stones.ravel(), ends[1])), np.concatenate(
        ([0.0], (levels[:, None] + z).ravel(), [0.0])
    )


SHAPES = {
    "cleat": Shape(sizes=("height", "length"), usual=(20.0, 50.0), outline=lambda s, _: _box(s[0], s[1])),
    "half_round": Shape(sizes=("radius",), usual=(50.0,), outline=lambda s, _: _arc(s[0], 2.0 * s[0])),
    "speed_bump": Shape(
        sizes=("height", "length"), usual=(100.0, 3700.0), outline=lambda s, _: _arc(s[0], s[1]), arc=True
    ),
    "ramp": Shape(
        sizes=("height", "length"),
        usual=(50.0, 1000.0),
        outline=lambda s, _: (np.array([0.0, s[1]]), np.array([0.0, s[0]])),
    ),
    "pothole": Shape(sizes=("height", "length"), usual=(50.0, 300.0), outline=lambda s, _: _box(-s[0], s[1])),
    "cobbles": Shape(sizes=("height", "length", "number"), usual=(10.0, 120.0, 100.0), outline=_cobbles, arc=True),
}
"""Shapes by name. The speed bump is the circular hump of Watts (TRRL report 597, 1973), the height of a pothole its
depth; cobbles have the height of a crown, the length of a stone and the number of stones."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Obstacle:
    """Obstacle on a level road.

    Attributes:
        name: name of its shape, one of `SHAPES`.
        sizes: its sizes [mm]; see `Shape`.
        side: "left" or "right"; by default both sides.
        place: distance of its beginning from the start of the foremost wheels [m]; by default the drive sets it.
    """

    name: str
    sizes: tuple[float, ...]
    side: str | None = None
    place: float | None = None

    @classmethod
    def parse(cls, text: str) -> Self:
        """Return the obstacle of a text, as "cleat:20x50", "pothole:50x300:right@40" or "speed_bump"."""
        front, at, distance = text.partition("@")
        name, *parts = front.split(":")
        if name not in SHAPES:
            raise ConfigurationError(f"obstacle {text!r}: {name!r} must be one of {', '.join(SHAPES)}")
        shape, usage = SHAPES[name], f"must be {usage_of(name)}"
        side = parts.pop() if parts and parts[-1] in ("left", "right", "both") else None
        if len(parts) > 1 or (at and not re.fullmatch(NUMBER, distance)):
            raise ConfigurationError(f"obstacle {text!r}: {usage}")
        sizes = shape.usual
        if parts:
            cells = parts[0].split("x")
            if len(cells) != len(shape.sizes) or not all(re.fullmatch(NUMBER, cell) for cell in cells):
                raise ConfigurationError(f"obstacle {text!r}: {usage}")
            sizes = tuple(float(cell) for cell in cells)
        for size_name, size in zip(shape.sizes, sizes, strict=True):
            largest = LARGEST.get(size_name, 10_000.0)
            if not (1.0 <= size <= largest):
                raise ConfigurationError(f"obstacle {text!r}: {size_name} {size:g}, must be 1 to {largest:g}")
            if size_name == "number" and size != round(size):
                raise ConfigurationError(f"obstacle {text!r}: found {size:g} stones, must be a whole number")
        if shape.arc and sizes[0] > 0.5 * sizes[1]:
            raise ConfigurationError(
                f"obstacle {text!r}: height {sizes[0]:g} mm, must be at most half of the length, {0.5 * sizes[1]:g} mm"
            )
        return cls(name=name, sizes=sizes, side=None if side == "both" else side, place=float(distance) if at else None)

    @property
    def begin(self) -> float:
        """Return the distance of the beginning of the obstacle [m], 0 without a place."""
        return self.place or 0.0

    @property
    def length(self) -> float:
        """Return the distance from the beginning to the end of the obstacle [m]."""
        return float(self._outline()[0][-1])

    @property
    def words(self) -> str:
        """Return a description of the obstacle for messages and headers."""
        shape = SHAPES[self.name]
        sizes = ", ".join(
            f"{size_name} {size:g}{'' if size_name == 'number' else ' mm'}"
            for size_name, size in zip(shape.sizes, self.sizes, strict=True)
        )
        return f"{self.name} ({sizes}) {f'{self.side} side' if self.side else 'both sides'}, at {self.begin:g} m"

    def road(self, *, length: float, patch: float, envelope: TyreEnvelope | None) -> MeasuredRoad:
        """Return the road with the obstacle.

        Args:
            length: length of the road [m], at least to the end of the obstacle.
            patch, envelope: contact of the tyre; see `MeasuredRoad`.
        """
        x, tracks = self._outline()
        if self.begin < 1.0 or self.begin + x[-1] >= length:
            raise ConfigurationError(
                f"obstacle from {self.begin:g} to {self.begin + x[-1]:g} m: must be within 1 to {length:.4g} m, the "
                "distance driven; choose another place (@METRES), or a longer --duration"
            )
        distance = np.concatenate(([0.0], self.begin + x, [length]))
        for side, z in tracks.items():
            profile = np.concatenate(([0.0], z, z[-1:]))
            tracks[side] = profile if self.side in (None, side) else np.zeros_like(profile)
        return MeasuredRoad(
            distance=distance,
            right=tracks["right"],
            left=tracks["left"],
            source=self.words,
            patch=patch,
            envelope=envelope,
            corners=True,
        )

    def _outline(self) -> tuple[Vector, dict[str, Vector]]:
        """Return distances from the beginning [m] and heights by side [m]; random levels differ between the sides."""
        shape, generator = SHAPES[self.name], np.random.Generator(np.random.PCG64(1))
        sizes = tuple(
            size if size_name == "number" else 1e-3 * size
            for size_name, size in zip(shape.sizes, self.sizes, strict=True)
        )
        x, right = shape.outline(sizes, generator)
        return x, {"right": right, "left": shape.outline(sizes, generator)[1]}


NUMBER = r"\d+(\.\d+)?"
"""Pattern of a size or a place."""


def is_obstacle(text: str) -> bool:
    """Return True if a text names an obstacle, right or wrong in its sizes."""
    return re.split("[:@]", text)[0] in SHAPES


def usage_of(name: str) -> str:
    """Return the form of the text of an obstacle, as "cleat[:HEIGHTxLENGTH][:left|right][@METRES]"."""
    return f"{name}[:{'x'.join(size.upper() for size in SHAPES[name].sizes)}][:left|right][@METRES], sizes in mm"
