"""The trimmed body: rigid-body properties and the file of its elastic model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.quantity import Validated, quantity, validate

MAX_MODES = 999
"""Maximum number of a mode that may have parameters; no body model of a whole car has had as many modes."""

MOMENTS = ("ixx", "iyy", "izz", "ixy", "izx", "iyz")
"""Names of the moments and products of inertia."""

DIGITS = 14
"""Significant digits of a rescaled moment: restores the number of the vehicle file exactly, so its frame is cached."""

EARLIER_KEYS = ("inertia_variant", "ixx_published", "ixx_improved", "iyy", "izz", "ixy", "izx", "iyz")
"""Keys of [body] in vehicle files before [body.inertia]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class BodyMode(Validated):
    """Corrections of one mode of the body model, as [body.modes.3]; the mode shape is not changed."""

    frequency_factor: float = quantity(
        "-",
        "factor on the natural frequency of this mode",
        at_least=0.1,
        at_most=10.0,
        why="beyond a factor of 100 in stiffness it is another body",
        default=1.0,
    )
    damping_ratio: float | None = quantity(
        "-",
        "share of critical damping of this mode; default: damping of the body model",
        at_least=0.0,
        at_most=0.3,
        why="trimmed bodies have 0.01 to 0.08",
        default=None,
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class BodyInertia(Validated):
    """Moments and products of inertia of the trimmed body in axes parallel to the vehicle frame; products as integrals.

    About the origin Izx > 0 because m x z > 0; a body that is symmetric about y = 0 has Ixy = Iyz = 0 about its CoG.
    """

    about: str = quantity(
        "-",
        "point that the moments of inertia refer to: cog, or origin of the vehicle axes",
        choices=("cog", "origin"),
        default="cog",
    )
    ixx: float = quantity("kg m2", "integral of y2 + z2", above=0.0)
    iyy: float = quantity("kg m2", "integral of x2 + z2", above=0.0)
    izz: float = quantity("kg m2", "integral of x2 + y2", above=0.0)
    ixy: float = quantity("kg m2", "integral of x y", default=0.0)
    izx: float = quantity("kg m2", "integral of z x", default=0.0)
    iyz: float = quantity("kg m2", "integral of y z", default=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class TrimmedBody:
    """Mass, centre of gravity and inertia of the trimmed body, and its elastic model."""

    mass: float = quantity(
        "kg",
        "mass of the trimmed body (with seats and interior)",
        above=0.0,
        at_least=100.0,
        at_most=5000.0,
        why="without engine and axles: 200 kg in a micro car, 3000 kg in a loaded van",
    )
    cog: Point = quantity("m", "centre of gravity", length=3)
    inertia: BodyInertia
    superelement: str | None = quantity(
        "-",
        "file of the body design or body model, in the same folder as the vehicle file or in the package; with "
        "--set any path",
        is_file=True,
        default=None,
    )
    flexible: bool = True
    attachment_flexibility: bool = True
    modes_up_to: float | None = quantity(
        "Hz",
        "modes above this frequency act statically (residual flexibility); default: all modes are kept",
        above=0.0,
        default=None,
    )
    frequency_scale: float = quantity(
        "-",
        "factor on all natural frequencies of the flexible modes",
        above=0.0,
        at_most=20.0,
        why="for a body more than 400 times stiffer set flexible = false",
        default=1.0,
    )
    model_mass: float | None = quantity(
        "kg",
        "mass of the body that the elastic model describes; its masses are scaled by mass / model_mass; "
        "default: no scaling",
        above=0.0,
        default=None,
    )
    # The hash leaves the changes of modes out, which are a mapping.
    modes: Mapping[str, BodyMode] = field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        validate(self)
        for number in self.modes:
            if not (number.isascii() and number.isdigit() and 1 <= int(number) <= MAX_MODES and number[0] != "0"):
                raise ConfigurationError(
                    f"TrimmedBody.modes.{number}: must be a mode number, at least 1, for example body.modes.3"
                )
        if self.flexible and self.superelement is None:
            raise ConfigurationError(
                "TrimmedBody.superelement: missing; a flexible body needs a body design or a modal superelement, for "
                "example body_design.toml of the package; for a rigid body set flexible = false"
            )

        if self.modes_up_to is not None and not (self.flexible and self.attachment_flexibility):
            raise ConfigurationError(
                "TrimmedBody.modes_up_to: works only with flexible = true and attachment_flexibility = true, which "
                "keep the flexibility of the higher modes; set both, or leave modes_up_to out"
            )

    @property
    def model_factor(self) -> float:
        """Factor on all masses of the elastic model [1]; frequencies and mass-normalised shapes scale by 1/sqrt."""
        return 1.0 if self.model_mass is None else self.mass / self.model_mass

    @property
    def of_model(self) -> TrimmedBody:
        """The body before its mass was varied, to which the elastic model belongs; moments to `DIGITS` digits."""
        if self.model_mass is None:
            return self
        moments: dict[str, Any] = {
            name: float(f"{getattr(self.inertia, name) / self.model_factor:.{DIGITS}g}") for name in MOMENTS
        }
        return replace(self, mass=self.model_mass, inertia=replace(self.inertia, **moments), model_mass=None)


def require_inertia_table(body: Mapping[str, Any]) -> None:
    """Raise an error for the moments of earlier vehicle files, which were keys of [body].

    Raises:
        ConfigurationError: earlier keys are present; the message gives the table to write instead.
    """
    if not (old := [key for key in body if key in EARLIER_KEYS]):
        return
    variant = body.get("inertia_variant", "improved")
    ixx = body.get("ixx_published" if variant == "published" else "ixx_improved")
    moments = {"ixx": ixx, **{key: body.get(key) for key in MOMENTS[1:]}}
    table = ", ".join(
        ['about = "origin"', *(f"{key} = {value}" for key, value in moments.items() if value is not None)]
    )
    raise ConfigurationError(
        f"body: found {', '.join(old)}; moments of inertia have a separate table. Write inertia = {{ {table} }} in "
        "[body], or the moments about the centre of gravity without `about`"
    )
