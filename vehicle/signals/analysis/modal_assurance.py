"""Modal assurance criterion (MAC): correlation of two mode shapes."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def mac(first: npt.ArrayLike, second: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Return the modal assurance criterion |a^H b|^2 / ((a^H a) (b^H b)) of every pair of shapes.

    Args:
        first: m real or complex shapes; (m, n), or (m, nodes, 3).
        second: k shapes at the coordinates of `first`, (k, ...).

    Returns:
        MAC [-], (m, k); 0 for a zero shape.

    Source: R. J. Allemang, The modal assurance criterion - twenty years of use and abuse, Sound and Vibration 37
        (2003), 14-23.
    """
    a, b = (np.asarray(shapes, dtype=complex) for shapes in (first, second))
    a, b = a.reshape(len(a), -1), b.reshape(len(b), -1)
    power = np.outer(np.sum(np.abs(a) ** 2, axis=1), np.sum(np.abs(b) ** 2, axis=1))
    criterion = np.zeros(power.shape)
    np.divide(np.abs(a.conj() @ b.T) ** 2, power, out=criterion, where=power > 0.0)
    return criterion
