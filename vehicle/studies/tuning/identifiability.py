"""Identifiability of parameters from the singular values of the weighted Jacobian."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.model.parameters.ranges import Range
from vehicle.studies.tuning.response_delays import DelayRange

WIDEST = 0.5 / np.sqrt(3.0)
"""Maximum standard error of an identifiable direction in parameter space, in half widths of the bounds: half the
standard deviation 1/sqrt(3) of a value of which only the bounds are known."""

PARTNER = 0.3
"""Minimum component of a parameter in a direction for the parameter to be named as a partner."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Unidentified:
    """Parameter that the data cannot identify, held at its start value."""

    path: str  # path of the parameter
    held_at: float  # start value of the parameter
    # parameters that are identifiable only in combination with this parameter; empty for a parameter without effect
    partners: tuple[str, ...]
    # standard error of the common direction, in half widths of the bounds [-]; infinite for data without any
    # information on the direction
    spread: float

    def message(self) -> str:
        """Return a message that names the parameter, its partners and the standard error."""
        other = f" separately from {', '.join(self.partners)}" if self.partners else ""
        return (
            f"these data do not determine {self.path}{other}: it stays at {self.held_at:g} (standard error "
            f"{self.spread:.3g} times half the width of the bounds, limit {number(WIDEST, 2)})"
        )


def worst_direction(jacobian: Vector, parameters: Sequence[Range | DelayRange]) -> Unidentified | None:
    """Return the parameter to hold if the data leave a direction in parameter space undetermined.

    With residuals of unit variance and columns d r / d (u / half width), a singular value s is 1 over the standard
    error of its direction in half widths of the bounds. In the direction with the largest error the parameter with the
    largest component is held; parameters with a component of at least `PARTNER` are named as partners.

    Args:
        jacobian: d r / d u, u = ln(value / start), residuals of unit variance; (n, p).

    Returns:
        The parameter, or None if the error of every direction is at most `WIDEST`.

    Source: Belsley, Kuh, Welsch, Regression Diagnostics, 1980, chapter 3, with columns scaled by the bounds instead of
    their length.
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
    """Return the covariance (J' J)^-1 for residuals of unit variance, (p, p), from the triangular factor of J."""
    inverse = np.linalg.inv(np.linalg.qr(jacobian, mode="r"))
    return np.asarray(inverse @ inverse.T)
