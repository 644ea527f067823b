"""Masses joined by springs, bushings, elastomers and sliding pairs: what every lumped model is made of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from vehicle.laws.kelvin import Kelvin
from vehicle.laws.law import ForceLaw, Numbers
from vehicle.laws.maxwell import Maxwell

ROAD = "road"
"""Name of the driven displacement in a row."""

Row = Mapping[str, Numbers]
"""Linear form: coordinate name (or `ROAD`) -> coefficient [-]; arrays of coefficients stand for many models at once."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Mass:
    """Point mass: T = m/2 sum over its axes of (row . q')^2."""

    mass: Numbers
    axes: tuple[Row, ...]


@dataclass(frozen=True, kw_only=True, slots=True)
class Link:
    """Linear element along one direction; its extension is row . (q, road)."""

    row: Row
    law: Kelvin | Maxwell


@dataclass(frozen=True, kw_only=True, slots=True)
class Slide:
    """Sliding pair along one direction; its velocity is row . (q', road')."""

    row: Row
    friction: ForceLaw
    viscous: ForceLaw | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class Network:
    """Lumped model: coordinates, parts, and the places whose motion is asked for.

    Arrays in the masses, laws and rows must broadcast together; they stand for many models at once.
    """

    coordinates: tuple[str, ...]
    masses: tuple[Mass, ...]
    links: tuple[Link, ...]
    outputs: Mapping[str, Row]
    slides: tuple[Slide, ...] = ()
    force: Row = field(default_factory=dict)
    """Where an applied force acts: its generalised force is row times the force."""
