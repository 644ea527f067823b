"""Where the points of a measurement are, what is drawn between them, and how they move in a mode."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, kw_only=True, slots=True)
class Geometry:
    """Points, and lines between them.

    Attributes:
        points: name, or number in the file, to coordinates in the global axes [m].
        lines: each a sequence of points that are drawn connected; of an element with three corners or more the first
            stands at the end again.
    """

    points: Mapping[str, Sequence[float]] = field(default_factory=dict)
    lines: Sequence[Sequence[str]] = ()


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ModeShape:
    """A mode as a file holds it: u(t) = Re(shape exp(s t)).

    Attributes:
        number: of the mode, from 1; 0 where the file tells none.
        frequency: |s| / 2 pi [Hz].
        damping_ratio: -Re(s) / |s| [-]; 0 where the file tells none.
        modal_mass: of a normal mode with this shape [kg]; of a complex one 0, as where the file tells none.
        modal_a: Modal A of a complex mode, in the units of the file; 0 where the file tells none.
        points: names of the points, n of them, as of `Geometry`.
        shape: translations along x, y, z [-] and rotations about them [1/m] in the global axes, (n, 6); real for a
            normal mode.
        name: what the file calls it.
        is_complex: whether it is a complex mode.
        quantity: displacement, velocity, acceleration, or empty where that is open.
    """

    number: int
    frequency: float
    points: tuple[str, ...]
    shape: NDArray[np.complex128]
    damping_ratio: float = 0.0
    modal_mass: float = 0.0
    modal_a: complex = 0j
    name: str = ""
    is_complex: bool = False
    quantity: str = "displacement"
