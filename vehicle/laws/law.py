"""What every force law offers, and laws side by side."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError

Numbers = float | npt.NDArray[np.float64]


class ForceLaw(Protocol):
    """A force that depends on the relative velocity alone; positive against a positive velocity."""

    def force(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Force [N] at a relative velocity [m/s], of the shape of both broadcast together."""

    def slope(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Derivative d F / d v [N s/m] at a relative velocity [m/s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Parallel:
    """Laws side by side on the same velocity: F(v) = sum of F_i(v)."""

    laws: tuple[ForceLaw, ...]

    def force(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Sum of the forces [N] at a velocity [m/s]."""
        total = np.zeros_like(velocity, dtype=float)
        for law in self.laws:
            total = total + law.force(velocity)
        return total

    def slope(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Sum of the derivatives [N s/m] at a velocity [m/s]."""
        total = np.zeros_like(velocity, dtype=float)
        for law in self.laws:
            total = total + law.slope(velocity)
        return total


def validate(law: Any) -> None:
    """Check every parameter of a law, scalar or array, against the range its field declares.

    Args:
        law: a dataclass object whose fields were made by `quantity`.

    Raises:
        ConfigurationError: naming the class, the field, the first bad value, the unit and what is allowed.
    """
    for entry in dataclasses.fields(law):
        check(f"{type(law).__name__}.{entry.name}", getattr(law, entry.name), entry.metadata)


def check(path: str, value: Any, metadata: Any) -> None:
    """Check one parameter, scalar or array, against the metadata of its field.

    Args:
        path: name shown in the message.
        value: number or array of numbers.
        metadata: as made by `quantity`: unit, meaning, above, at_least, at_most.

    Raises:
        ConfigurationError: naming the path, the first bad value, the unit and what is allowed.
    """
    unit = metadata["unit"]
    values = np.asarray(value)
    if values.dtype.kind not in "iuf":
        raise ConfigurationError(f"{path}: found {value!r}, needed are numbers [{unit}]")
    finite = np.isfinite(values)
    if not finite.all():
        bad = float(values[~finite].flat[0])
        raise ConfigurationError(f"{path}: found {bad!r} {unit}, needed is a finite number ({metadata['meaning']})")
    ranges = (
        (metadata["above"], np.greater, "greater than"),
        (metadata["at_least"], np.greater_equal, "at least"),
        (metadata["at_most"], np.less_equal, "at most"),
    )
    for bound, holds, words in ranges:
        if bound is None:
            continue
        allowed = holds(values, bound)
        if not allowed.all():
            bad = float(values[~allowed].flat[0])
            raise ConfigurationError(f"{path}: found {bad!r} {unit}, must be {words} {bound!r}")
