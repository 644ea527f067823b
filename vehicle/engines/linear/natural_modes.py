"""Natural frequencies, damping ratios and shapes of a linear system, and the test for unstable poles."""

from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Complex, Mask, Vector
from vehicle.engines.linear.first_order import FirstOrder
from vehicle.errors import ConfigurationError

GROWTH_FLOOR = 1e-4
"""Growth rate [1/s] below which a pole counts as neutral: a factor e in three hours, longer than any record."""

ROUND_OFF = 1e-6
"""Growth rate over |s| below which it is round-off of the matrices, whose differences are accurate to 1e-8."""


def grows(poles: Complex) -> Mask:
    """Return True for each unstable pole [rad/s], whose growth rate is above round-off."""
    return np.asarray(poles.real > GROWTH_FLOOR + ROUND_OFF * np.abs(poles))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class NaturalModes:
    """Modes u(t) = Re(motion exp(s t)) sorted by natural frequency: one for each conjugate pair of poles.

    Attributes:
        pole: s [1/s], (m,).
        motion: complex displacements of the coordinates in the scale of the eigenvector of the states, (m, n).
    """

    pole: Complex
    motion: Complex

    @property
    def frequency(self) -> Vector:
        """Return the undamped natural frequency |s| / (2 pi) [Hz], (m,)."""
        return np.abs(self.pole) / (2.0 * np.pi)

    @property
    def damped_frequency(self) -> Vector:
        """Return the frequency Im(s) / (2 pi) of the free decay [Hz], (m,)."""
        return np.asarray(self.pole.imag / (2.0 * np.pi))

    @property
    def damping_ratio(self) -> Vector:
        """Return the damping ratio -Re(s) / |s| [-], (m,)."""
        return np.asarray(-self.pole.real / np.abs(self.pole))

    @property
    def shape(self) -> Complex:
        """Return the motion of the coordinates scaled to a largest entry of 1, (m, n)."""
        return np.array([motion / motion[np.argmax(np.abs(motion))] for motion in self.motion])


def natural_modes(form: FirstOrder) -> NaturalModes:
    """Return the oscillating modes and all unstable poles of one system, from the eigenvalues of A.

    Raises:
        ConfigurationError: a stack of systems, or a system with sliding pairs.
    """
    if form.models or form.system.slides:
        raise ConfigurationError(
            "natural_modes: the model must be a single linear model; use damper='slip' or damper='stick'"
        )
    poles, vectors = np.linalg.eig(form.state)
    # One pole of each conjugate pair; real poles oscillate in no mode, but may grow.
    selected = (poles.imag > 1e-6) | (grows(poles) & (poles.imag >= 0.0))
    order = [i for i in np.argsort(np.abs(poles), kind="stable") if selected[i]]
    motion = form.shapes(vectors[:, order], poles[order]).T.astype(complex)
    return NaturalModes(pole=poles[order].astype(complex), motion=motion)
