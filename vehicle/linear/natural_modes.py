"""Natural frequencies, damping ratios and shapes of a linear system."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError
from vehicle.linear.first_order import FirstOrder


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class NaturalModes:
    """Oscillating modes sorted by frequency: one for each conjugate pair of poles.

    Attributes:
        frequency: undamped natural frequency |s| / (2 pi) [Hz], (m,).
        damped_frequency: frequency Im(s) / (2 pi) of the free decay [Hz], (m,).
        damping_ratio: -Re(s) / |s| [-], (m,).
        shape: motion of the coordinates, largest one equal to 1, (m, n).
    """

    frequency: npt.NDArray[np.float64]
    damped_frequency: npt.NDArray[np.float64]
    damping_ratio: npt.NDArray[np.float64]
    shape: npt.NDArray[np.complex128]


def natural_modes(form: FirstOrder) -> NaturalModes:
    """Modes of one system from the eigenvalues of A.

    Args:
        form: a single system.

    Returns:
        The oscillating modes; poles on the real axis are left out.

    Raises:
        ConfigurationError: a stack of systems, or a system with sliding pairs.
    """
    if form.models or form.system.slides:
        raise ConfigurationError("natural_modes: needed is one linear model (damper='slip' or damper='stick')")
    poles, vectors = np.linalg.eig(form.state)
    order = [i for i in np.argsort(np.abs(poles)) if poles[i].imag > 1e-6]
    shapes = form.shape(vectors[:, order]).T
    largest = shapes[np.arange(len(order)), np.argmax(np.abs(shapes), axis=1)]
    chosen = poles[order]
    return NaturalModes(
        frequency=np.abs(chosen) / (2.0 * np.pi),
        damped_frequency=chosen.imag / (2.0 * np.pi),
        damping_ratio=-chosen.real / np.abs(chosen),
        shape=shapes / largest[:, None],
    )
