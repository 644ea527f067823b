"""Modal assurance criterion: how alike two mode shapes are."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def mac(first: npt.ArrayLike, second: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Modal assurance criterion |a^H b|^2 / ((a^H a) (b^H b)) of every pair of shapes.

    Args:
        first: shapes, real or complex, one behind the other; (m, n), or (m, nodes, 3).
        second: at the same coordinates, (k, ...).

    Returns:
        (m, k) [-]; 0 for a shape that is zero.

    Source: R. J. Allemang, The modal assurance criterion - twenty years of use and abuse, Sound and Vibration 37
        (2003), 14-23.
    """
    a, b = (np.asarray(shapes, dtype=complex) for shapes in (first, second))
    a, b = a.reshape(len(a), -1), b.reshape(len(b), -1)
    power = np.outer(np.sum(np.abs(a) ** 2, axis=1), np.sum(np.abs(b) ** 2, axis=1))
    found = np.zeros(power.shape)
    np.divide(np.abs(a.conj() @ b.T) ** 2, power, out=found, where=power > 0.0)
    return found
