"""Which parameters data can tell: the singular values of the weighted Jacobian."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.model.parameters.ranges import Range

Vector = npt.NDArray[np.float64]

WIDEST = 0.5 / np.sqrt(3.0)
"""Largest standard error of a direction in parameter space, in half widths of the bounds: half the standard deviation
1/sqrt(3) of a value of which only the bounds are known. Data that do not even halve it do not tell the direction."""

PARTNER = 0.3
"""Least component of a direction that makes a parameter a part of it."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Unidentified:
    """A parameter that the data cannot tell, and that is held.

    Attributes:
        path: of the parameter.
        held_at: its start value.
        partners: parameters that can only be told together with it; none where it acts on nothing.
        spread: standard error of their common direction, in half widths of the bounds [-]; infinite where the data say
            nothing at all.
    """

    path: str
    held_at: float
    partners: tuple[str, ...]
    spread: float

    def sentence(self) -> str:
        """The finding in words."""
        other = f" apart from {', '.join(self.partners)}" if self.partners else ""
        return (
            f"{self.path}: the data cannot tell it{other} (standard error of that direction {self.spread:.3g} half "
            f"widths of the bounds, allowed {WIDEST:.2g}); held at {self.held_at:g}"
        )


def worst_direction(jacobian: Vector, parameters: Sequence[Range]) -> Unidentified | None:
    """The parameter to hold, where the data leave a direction open.

    With residuals of unit variance and columns d r / d (u / half width), a singular value s is one over the standard
    error of its direction in half widths of the bounds. In the worst direction the parameter with the largest component
    is held; the others with a component of at least 0.3 are its partners.

    Args:
        jacobian: d r / d u, u = ln(value / start), residuals of unit variance; (n, p).
        parameters: of its columns.

    Returns:
        The parameter, or None where every direction is known within `WIDEST`.

    Source: Belsley, Kuh, Welsch, Regression Diagnostics, 1980, chapter 3, with columns scaled by what is known before
    in place of their length.
    """
    widths = np.array([parameter.half_width for parameter in parameters])
    _, singular, directions = np.linalg.svd(jacobian * widths, full_matrices=False)
    smallest = float(singular[-1])
    exact = smallest <= 1e-12 * max(float(singular[0]), 1e-300)
    spread = np.inf if exact else 1.0 / smallest
    if spread <= WIDEST:
        return None
    parts = np.abs(directions[-1])
    chosen = int(np.argmax(parts))
    partners = [index for index in np.flatnonzero(parts >= PARTNER).tolist() if index != chosen]
    return Unidentified(
        path=parameters[chosen].path,
        held_at=parameters[chosen].start,
        partners=tuple(parameters[index].path for index in partners),
        spread=float(spread),
    )


def covariance(jacobian: Vector) -> Vector:
    """(J' J)^-1 of residuals of unit variance, (p, p), from the triangular factor of J."""
    inverse = np.linalg.inv(np.linalg.qr(jacobian, mode="r"))
    return np.asarray(inverse @ inverse.T)
