"""Mass, damping and stiffness matrices of a lumped model, derived from its energies in this one place.

Every spring-damper is a row e over the coordinates x and a row r over the road heights z; its extension is e.x + r.z:

    T = 1/2 sum m_i x_i'^2,   V = 1/2 sum k (e.x + r.z)^2,   D = 1/2 sum c (e.x' + r.z')^2

Lagrange's equations d/dt(dT/dx') + dD/dx' + dV/dx = 0 then read M x'' + C x' + K x = Bc z' + Bk z with
K = sum k e^T e and Bk = -sum k e^T r, so that symmetry cannot be lost by a wrong sign.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True)
class SpringDamper:
    """Parallel spring and damper along one linear form of coordinates and road heights."""

    extension: Mapping[str, float]
    """Coordinate or road name -> its coefficient in the extension."""
    stiffness: float
    """k [N/m]."""
    damping: float
    """c [N s/m]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LinearModel:
    """M x'' + C x' + K x = Bc z' + Bk z."""

    coordinates: tuple[str, ...]
    roads: tuple[str, ...]
    mass: Array
    """M [kg] or [kg m2], shape (n, n)."""
    damping: Array
    """C, shape (n, n)."""
    stiffness: Array
    """K, shape (n, n)."""
    road_damping: Array
    """Bc, shape (n, w)."""
    road_stiffness: Array
    """Bk, shape (n, w)."""

    def row(self, form: Mapping[str, float]) -> Array:
        """Coefficients of a linear form of the coordinates, shape (n,)."""
        return _row(form, self.coordinates)


def energy_matrices(
    masses: Mapping[str, float], elements: Sequence[SpringDamper], roads: tuple[str, ...]
) -> LinearModel:
    """Matrices of the equations of motion from kinetic, potential and dissipation energy.

    Args:
        masses: coordinate name -> its mass [kg] or moment of inertia [kg m2]; the order fixes the coordinates.
        elements: springs and dampers.
        roads: names of the driven heights.

    Returns:
        The linear model.

    Raises:
        ConfigurationError: an element names an unknown coordinate.
    """
    coordinates = tuple(masses)
    known = (*coordinates, *roads)
    joint_stiffness = np.zeros((len(known), len(known)))
    joint_damping = np.zeros_like(joint_stiffness)
    for element in elements:
        row = _row(element.extension, known)
        joint_stiffness += element.stiffness * np.outer(row, row)  # Hessian of V over (x, z)
        joint_damping += element.damping * np.outer(row, row)
    n = len(coordinates)
    return LinearModel(
        coordinates=coordinates,
        roads=roads,
        mass=np.diag(np.array(list(masses.values()), dtype=float)),
        damping=joint_damping[:n, :n],
        stiffness=joint_stiffness[:n, :n],
        road_damping=-joint_damping[:n, n:],
        road_stiffness=-joint_stiffness[:n, n:],
    )


def _row(form: Mapping[str, float], names: tuple[str, ...]) -> Array:
    row = np.zeros(len(names))
    for name, coefficient in form.items():
        if name not in names:
            raise ConfigurationError(f"linear form: found {name!r}, allowed are {', '.join(names)}")
        row[names.index(name)] = coefficient
    return row
