"""Inertia tensors: sign convention of the products, parallel-axis theorem, nearest physical tensor."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError

_FLOOR = 1e-6
"""Minimum principal second moment of a repaired tensor over their sum, so that round-off keeps the inequality."""


def inertia_tensor(*, ixx: float, iyy: float, izz: float, ixy: float, izx: float, iyz: float) -> Vector:
    """Return the inertia tensor from moments and from products as integrals: off-diagonal terms are -int x y dm.

    Args:
        ixx: int (y^2 + z^2) dm [kg m2], and iyy, izz alike.
        iyy: see ixx.
        izz: see ixx.
        ixy: int x y dm [kg m2], and izx, iyz alike.
        izx: see ixy.
        iyz: see ixy.

    Returns:
        Tensor [kg m2], shape (3, 3), about the reference point of the integrals.

    Source: Bommer 2006, section 3.1.2; published Izx = 1800 is positive, as is m x z = 1773.
    """
    return np.array([[ixx, -ixy, -izx], [-ixy, iyy, -iyz], [-izx, -iyz, izz]])


def about_cog(inertia_about_origin: ArrayLike, mass: float, cog: ArrayLike) -> Vector:
    """Return the tensor about the CoG [kg m2], (3, 3), by the parallel-axis theorem: I_c = I_0 - m (|c|^2 1 - c c^T).

    Args:
        inertia_about_origin: I_0 [kg m2], shape (3, 3).
        mass: mass [kg].
        cog: centre of gravity [m], shape (3,).
    """
    c = np.asarray(cog, dtype=float)
    square = np.sum(c * c)  # not c @ c: BLAS rounds it differently on different processors
    return np.asarray(np.asarray(inertia_about_origin) - mass * (square * np.eye(3) - np.outer(c, c)))


def about_origin(inertia_about_cog: ArrayLike, mass: float, cog: ArrayLike) -> Vector:
    """Return the tensor about the origin [kg m2], (3, 3): I_0 = I_c + m (|c|^2 1 - c c^T); see `about_cog`."""
    return about_cog(inertia_about_cog, -mass, cog)


def components(inertia: ArrayLike) -> dict[str, float]:
    """Return moments, and products as integrals, of a tensor [kg m2], (3, 3); the inverse of `inertia_tensor`."""
    (xx, xy, xz), (_, yy, yz), (*_, zz) = np.asarray(inertia, dtype=float).tolist()
    return {"ixx": xx, "iyy": yy, "izz": zz, "ixy": -xy, "izx": -xz, "iyz": -yz}


def second_moments(inertia: ArrayLike) -> Vector:
    """Return the second moments int r r^T dm = tr(I)/2 1 - I [kg m2], shape (3, 3); positive definite if physical."""
    tensor = np.asarray(inertia, dtype=float)
    return np.asarray(np.trace(tensor) / 2.0 * np.eye(3) - tensor)


def triangle_shortfall(inertia: ArrayLike) -> float:
    """Return how far the two smaller principal moments fall short of the largest [kg m2]; 0 for a physical tensor."""
    low, middle, high = np.linalg.eigvalsh(np.asarray(inertia, dtype=float))
    return max(0.0, float(high - low - middle))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PhysicalInertia:
    """Physical inertia tensor nearest to a given tensor, and the difference."""

    inertia: Vector
    """physical tensor about the CoG [kg m2], shape (3, 3)"""
    change: Vector
    """repaired minus given tensor [kg m2], shape (3, 3); zero if the given tensor is physical"""
    shortfall: float
    """triangle shortfall of the given tensor [kg m2]"""

    @property
    def repaired(self) -> bool:
        """True if the given tensor was not physical."""
        return bool(np.any(self.change))

    def describe(self) -> str:
        """Return a summary of the repair for a report."""
        if not self.repaired:
            return "The inertia tensor is physical and used as given."
        largest = float(np.abs(self.change).max())
        return (
            f"The inertia tensor breaks the triangle inequality of principal moments by {self.shortfall:.3g} kg m2; "
            f"the nearest physical tensor is used (largest change of a component {largest:.3g} kg m2)."
        )


def nearest_physical(inertia: ArrayLike) -> PhysicalInertia:
    """Return the nearest physical tensor: negative principal second moments are raised to a small positive minimum.

    S = tr(I)/2 1 - I must be positive definite, which is the triangle inequality. Clipping its eigenvalues is the
    smallest change of S in the Frobenius norm, and I' = tr(S') 1 - S'.

    Args:
        inertia: tensor about the CoG [kg m2], shape (3, 3), symmetric.

    Raises:
        ConfigurationError: the tensor is not finite and symmetric of shape (3, 3), or has no positive second moment.

    Source: N. J. Higham, Computing a nearest symmetric positive semidefinite matrix, 1988, theorem 2.1.
    """
    tensor = np.asarray(inertia, dtype=float)
    if tensor.shape != (3, 3) or not np.all(np.isfinite(tensor)) or not np.allclose(tensor, tensor.T, rtol=1e-9):
        raise ConfigurationError(
            f"inertia tensor: must be a finite symmetric 3 x 3 matrix [kg m2], not {tensor.tolist()}"
        )
    values, axes = np.linalg.eigh(second_moments(tensor))
    if values[-1] <= 0.0:
        raise ConfigurationError(
            f"inertia tensor {tensor.tolist()}: no real body has these moments, nor nearly these (none of its "
            "principal second moments is positive). Check signs, units [kg m2] and the reference point (centre "
            "of gravity)."
        )
    floor = _FLOOR * float(values[values > 0.0].sum())
    if values[0] >= floor:
        return PhysicalInertia(inertia=tensor.copy(), change=np.zeros((3, 3)), shortfall=triangle_shortfall(tensor))
    # S' = U diag(max(s, floor)) U', and back to moments of inertia.
    moments = (axes * np.maximum(values, floor)) @ axes.T
    physical = np.trace(moments) * np.eye(3) - moments
    return PhysicalInertia(inertia=physical, change=physical - tensor, shortfall=triangle_shortfall(tensor))
