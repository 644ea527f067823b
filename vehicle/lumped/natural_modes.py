"""Natural frequencies, damping ratios and shapes of a linear lumped model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError
from vehicle.lumped.state_space import StateSpace


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class NaturalModes:
    """Oscillating modes sorted by frequency: one for each conjugate pair of poles."""

    frequency: npt.NDArray[np.float64]
    """Undamped natural frequency |lambda| / (2 pi) [Hz], shape (m,)."""
    damped_frequency: npt.NDArray[np.float64]
    """Frequency Im(lambda) / (2 pi) of the free decay [Hz], shape (m,)."""
    damping_ratio: npt.NDArray[np.float64]
    """-Re(lambda) / |lambda| [-], shape (m,)."""
    shape: npt.NDArray[np.complex128]
    """Motion of the coordinates, largest one equal to 1, shape (m, n)."""


def natural_modes(model: StateSpace) -> NaturalModes:
    """Modes of one linear model from the eigenvalues of A.

    Args:
        model: a single model without sliding pairs.

    Returns:
        The oscillating modes; poles on the real axis are left out.

    Raises:
        ConfigurationError: a stack of models, or a model with sliding pairs.
    """
    if model.models or model.slides:
        raise ConfigurationError("natural_modes: needed is one linear model (damper='slip' or damper='stick')")
    poles, vectors = np.linalg.eig(model.state)
    order = [i for i in np.argsort(np.abs(poles)) if poles[i].imag > 0.0]
    shapes = vectors[: len(model.coordinates), order].T
    largest = shapes[np.arange(len(order)), np.argmax(np.abs(shapes), axis=1)]
    chosen = poles[order]
    return NaturalModes(
        frequency=np.abs(chosen) / (2.0 * np.pi),
        damped_frequency=chosen.imag / (2.0 * np.pi),
        damping_ratio=-chosen.real / np.abs(chosen),
        shape=shapes / largest[:, None],
    )
