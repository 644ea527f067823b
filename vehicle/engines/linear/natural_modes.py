"""Natural frequencies, damping ratios and shapes of a linear system; what grows by itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.first_order import FirstOrder
from vehicle.errors import ConfigurationError

GROWTH_FLOOR = 1e-4
"""Growth [1/s] below which a pole counts as neutral: e-fold in three hours, far beyond any record."""

ROUND_OFF = 1e-6
"""Growth over |s| below which it is round-off of the matrices, whose differences are good to 1e-8."""


def grows(poles: npt.NDArray[np.complex128]) -> npt.NDArray[np.bool_]:
    """Which poles [rad/s] grow beyond round-off."""
    return np.asarray(poles.real > GROWTH_FLOOR + ROUND_OFF * np.abs(poles))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class NaturalModes:
    """Modes u(t) = Re(motion exp(s t)) sorted by natural frequency: one for each conjugate pair of poles.

    Attributes:
        pole: s [1/s], (m,).
        motion: complex displacements of the coordinates, as the eigenvector of the states has them, (m, n).
    """

    pole: npt.NDArray[np.complex128]
    motion: npt.NDArray[np.complex128]

    @property
    def frequency(self) -> npt.NDArray[np.float64]:
        """Undamped natural frequency |s| / (2 pi) [Hz], (m,)."""
        return np.abs(self.pole) / (2.0 * np.pi)

    @property
    def damped_frequency(self) -> npt.NDArray[np.float64]:
        """Frequency Im(s) / (2 pi) of the free decay [Hz], (m,)."""
        return np.asarray(self.pole.imag / (2.0 * np.pi))

    @property
    def damping_ratio(self) -> npt.NDArray[np.float64]:
        """-Re(s) / |s| [-], (m,)."""
        return np.asarray(-self.pole.real / np.abs(self.pole))

    @property
    def shape(self) -> npt.NDArray[np.complex128]:
        """Motion of the coordinates, largest one equal to 1, (m, n)."""
        return np.array([one / one[np.argmax(np.abs(one))] for one in self.motion])


def natural_modes(form: FirstOrder) -> NaturalModes:
    """Modes of one system from the eigenvalues of A.

    Args:
        form: a single system.

    Returns:
        The oscillating modes, and what grows even on the real axis; other real poles are left out.

    Raises:
        ConfigurationError: a stack of systems, or a system with sliding pairs.
    """
    if form.models or form.system.slides:
        raise ConfigurationError("natural_modes: needed is one linear model (damper='slip' or damper='stick')")
    poles, vectors = np.linalg.eig(form.state)
    kept = (poles.imag > 1e-6) | (grows(poles) & (poles.imag >= 0.0))
    order = [i for i in np.argsort(np.abs(poles), kind="stable") if kept[i]]
    motion = form.shapes(vectors[:, order], poles[order]).T.astype(complex)
    return NaturalModes(pole=poles[order].astype(complex), motion=motion)
