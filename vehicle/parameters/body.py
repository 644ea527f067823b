"""The trimmed body: rigid-body properties and the file of its elastic model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from vehicle.errors import ConfigurationError
from vehicle.parameters.hardpoints import Point
from vehicle.parameters.quantity import Validated, quantity, validate

MOST_MODES = 999
"""Modes whose numbers may be given one by one: two of their digits more than any body model of a whole car has used."""


@dataclass(frozen=True, kw_only=True, slots=True)
class BodyMode(Validated):
    """What is changed of one mode of the body model, as [body.modes.3]; its shape stays."""

    frequency_factor: float = quantity(
        "-",
        "factor on the natural frequency of this mode",
        at_least=0.1,
        at_most=10.0,
        why="a mode a hundred times as stiff or soft is no correction of a body model",
        default=1.0,
    )
    damping_ratio: float | None = quantity(
        "-",
        "share of critical damping of this mode; that of the body model by default",
        at_least=0.0,
        at_most=0.3,
        why="trimmed bodies have 0.01 to 0.08",
        default=None,
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class TrimmedBody:
    """Mass properties about the origin of the vehicle frame; products as integrals (Izx > 0 because m x z is)."""

    mass: float = quantity(
        "kg",
        "mass of the trimmed body",
        above=0.0,
        at_least=100.0,
        at_most=5000.0,
        why="without engine and axles the body of a micro car has 200 kg, that of a loaded van 3000 kg",
    )
    cog: Point = quantity("m", "centre of gravity", length=3)
    inertia_variant: str = quantity("-", "which Ixx is used", choices=("published", "improved"), default="improved")
    ixx_published: float | None = quantity("kg m2", "integral of y2 + z2, as published", above=0.0, default=None)
    ixx_improved: float = quantity("kg m2", "integral of y2 + z2, improved", above=0.0)
    iyy: float = quantity("kg m2", "integral of x2 + z2", above=0.0)
    izz: float = quantity("kg m2", "integral of x2 + y2", above=0.0)
    ixy: float = quantity("kg m2", "integral of x y")
    izx: float = quantity("kg m2", "integral of z x")
    iyz: float = quantity("kg m2", "integral of y z")
    superelement: str | None = quantity(
        "-",
        "body design or modal superelement: file beside the vehicle file, or of the package; with --set any path",
        is_file=True,
        default=None,
    )
    flexible: bool = True
    attachment_flexibility: bool = True
    modes_up_to: float | None = quantity(
        "Hz", "modes above act statically, as residual flexibility; all are kept by default", above=0.0, default=None
    )
    frequency_scale: float = quantity(
        "-",
        "factor on all natural frequencies of the flexible modes",
        above=0.0,
        at_most=20.0,
        why="a body 400 times as stiff is rigid: flexible = false",
        default=1.0,
    )
    # The cache of built bodies, which asks for a hash, leaves the changes of modes out.
    modes: Mapping[str, BodyMode] = field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        validate(self)
        for number in self.modes:
            if not (number.isascii() and number.isdigit() and 1 <= int(number) <= MOST_MODES and number[0] != "0"):
                raise ConfigurationError(
                    f"TrimmedBody.modes.{number}: needed is the number of a mode from 1, as body.modes.3"
                )
        if self.inertia_variant == "published" and self.ixx_published is None:
            raise ConfigurationError("TrimmedBody.ixx_published: missing; inertia_variant = published needs it")
        if self.flexible and self.superelement is None:
            raise ConfigurationError(
                "TrimmedBody.superelement: missing; a flexible body needs a body design or a modal superelement, as "
                "body_design.toml of the package; a rigid one (flexible = false) needs none"
            )

        if self.modes_up_to is not None and not (self.flexible and self.attachment_flexibility):
            raise ConfigurationError(
                "TrimmedBody.modes_up_to: found without flexible = true and attachment_flexibility = true, which carry "
                "the flexibility of the modes above"
            )

    @property
    def ixx(self) -> float:
        """Ixx of the chosen variant [kg m2]."""
        given = self.ixx_published if self.inertia_variant == "published" else None
        return self.ixx_improved if given is None else given
