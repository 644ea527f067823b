"""Modal assurance criterion (MAC): correlation of two mode shapes."""

import numpy as np
import numpy.typing as npt

from vehicle.signals.analysis.samples import Vector


def mac(first: npt.ArrayLike, second: npt.ArrayLike, mass: Vector | None = None) -> Vector:
    """Return the modal assurance criterion |a^H M b|^2 / ((a^H M a) (b^H M b)) of every pair of shapes.

    Without a mass matrix M = I: only for shapes whose coordinates have one unit, as translations of points. With it the
    criterion is the normalised cross-orthogonality, and does not depend on units and choice of the coordinates.

    Args:
        first: m real or complex shapes; (m, n), or (m, nodes, 3).
        second: k shapes at the coordinates of `first`, (k, ...).
        mass: symmetric mass matrix of the coordinates; (n, n).

    Returns:
        MAC [-], (m, k); 0 for a zero shape.

    Source: R. J. Allemang, The modal assurance criterion - twenty years of use and abuse, Sound and Vibration 37
        (2003), 14-23.
    """
    a, b = (np.asarray(shapes, dtype=complex) for shapes in (first, second))
    a, b = a.reshape(len(a), -1), b.reshape(len(b), -1)
    mass_a, mass_b = (shapes if mass is None else shapes @ mass for shapes in (a, b))
    # (a^H M a) (b^H M b) of every pair; (m, k).
    power = np.outer(np.sum(a.conj() * mass_a, axis=1).real, np.sum(b.conj() * mass_b, axis=1).real)
    criterion = np.zeros(power.shape)
    np.divide(np.abs(a.conj() @ mass_b.T) ** 2, power, out=criterion, where=power > 0.0)
    return criterion
