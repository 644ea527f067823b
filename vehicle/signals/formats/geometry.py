"""Geometry of a measurement: points, lines between points, and mode shapes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from vehicle.signals.analysis.samples import Complex


@dataclass(frozen=True, kw_only=True, slots=True)
class Geometry:
    """Measurement points and the lines of their wireframe.

    Attributes:
        points: name or number in the file -> coordinates in global axes [m].
        lines: sequences of connected points; elements with at least three corners repeat the first point at the end.
    """

    points: Mapping[str, Sequence[float]] = field(default_factory=dict)
    lines: Sequence[Sequence[str]] = ()


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ModeShape:
    """Mode shape of a file: u(t) = Re(shape exp(s t)).

    Attributes:
        number: number of the mode, from 1; 0 if unknown.
        frequency: |s| / 2 pi [Hz].
        damping_ratio: -Re(s) / |s| [-]; 0 if unknown.
        modal_mass: modal mass of a normal mode with this shape [kg]; 0 for complex modes or if unknown.
        modal_a: Modal A of a complex mode, in the units of the file; 0 if unknown.
        points: names of the n points, see `Geometry`.
        shape: translations along x, y, z [-] and rotations about x, y, z [1/m] in global axes, (n, 6); real for a
            normal mode.
        name: name of the mode in the file.
        is_complex: True for a complex mode.
        quantity: displacement, velocity, acceleration, or empty if unknown.
    """

    number: int
    frequency: float
    points: tuple[str, ...]
    shape: Complex
    damping_ratio: float = 0.0
    modal_mass: float = 0.0
    modal_a: complex = 0j
    name: str = ""
    is_complex: bool = False
    quantity: str = "displacement"
