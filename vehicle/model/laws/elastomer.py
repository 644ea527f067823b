"""Linear bushings and elastomers (a spring parallel to a Maxwell branch), and the series of one with a spring."""

from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.errors import ConfigurationError
from vehicle.model.laws.law import Numbers
from vehicle.model.parameters.quantity import Validated, check, quantity


@dataclass(frozen=True, kw_only=True, slots=True)
class Kelvin(Validated):
    """F = K u + B u', the linear bushing: a spring and a viscous damper in parallel."""

    stiffness: Numbers = quantity("N/m", "stiffness K", at_least=0.0)
    damping: Numbers = quantity("N s/m", "damping constant B", at_least=0.0)

    def force(self, extension: Numbers, rate: Numbers) -> Vector:
        """Return the force [N] at an extension [m] and its rate [m/s]."""
        return np.asarray(self.stiffness * np.asarray(extension) + self.damping * np.asarray(rate))

    def complex_stiffness(self, angular_frequency: Numbers) -> Complex:
        """Return K + j w B [N/m] at angular frequencies w [rad/s]."""
        return np.asarray(self.stiffness + 1j * np.asarray(angular_frequency) * self.damping)


@dataclass(frozen=True, kw_only=True, slots=True)
class Maxwell(Validated):
    """F = K1 u + F2 with F2' = K2 u' - (K2/D2) F2, so K(s) = K1 + K2 D2 s / (D2 s + K2).

    A spring parallel to a branch of spring and damper in series, with one internal force. A branch with K2 = 0 or
    D2 = 0 is absent: its force is zero at all times.

    Source: Bommer 2006, section 2.3.3.2, equations 2.8 to 2.13.
    """

    stiffness: Numbers = quantity("N/m", "static stiffness K1", at_least=0.0)
    branch_stiffness: Numbers = quantity("N/m", "spring K2 of the Maxwell branch", at_least=0.0)
    branch_damping: Numbers = quantity("N s/m", "damper D2 of the Maxwell branch", at_least=0.0)

    @property
    def relaxation_time(self) -> Vector:
        """Time constant D2/K2 [s] of the branch; zero if the branch is absent."""
        damping, stiffness = np.broadcast_arrays(self.branch_damping, self.branch_stiffness)
        present = stiffness > 0.0
        return np.where(present, damping / np.where(present, stiffness, 1.0), 0.0)

    def complex_stiffness(self, angular_frequency: Numbers) -> Complex:
        """Return K(j w) [N/m] at angular frequencies w [rad/s]."""
        turn = 1j * np.asarray(angular_frequency) * self.relaxation_time
        return np.asarray(self.stiffness + self.branch_stiffness * turn / (1.0 + turn))

    def loss_angle(self, angular_frequency: Numbers) -> Vector:
        """Return the angle of K(j w) [rad] at angular frequencies w [rad/s]."""
        return np.asarray(np.angle(self.complex_stiffness(angular_frequency)))

    def loss_peak(self) -> tuple[Vector, Vector]:
        """Return the angular frequency [rad/s] and the value [rad] of the maximum loss angle.

        w = (K2/D2) sqrt(K1/(K1 + K2)) and tan(angle) = K2 / (2 sqrt(K1 (K1 + K2))), from d angle / d w = 0.

        Raises:
            ConfigurationError: K1, K2 or D2 is zero, so that the angle has no maximum.
        """
        for name in ("stiffness", "branch_stiffness", "branch_damping"):
            if not (np.asarray(getattr(self, name)) > 0.0).all():
                raise ConfigurationError(
                    f"Maxwell.{name}: found 0.0, must be greater than 0.0 for a peak of the loss angle"
                )
        total = np.asarray(self.stiffness + self.branch_stiffness)
        frequency = np.sqrt(self.stiffness / total) / self.relaxation_time
        return frequency, np.arctan(self.branch_stiffness / (2.0 * np.sqrt(self.stiffness * total)))


def in_series(local_stiffness: Numbers, element: Kelvin | Maxwell) -> Maxwell:
    """Return the elastomer that is equivalent to a local spring in series with an element.

    1/K'(s) = 1/K0 + 1/K(s), with the same extension in total and the same force. For K(s) = K + B s:
    K1' = K0 K/(K0 + K), K2' = K0^2/(K0 + K), D2' = B (K0/(K0 + K))^2. For K(s) = K1 + K2 D2 s/(D2 s + K2):
    K1' = K0 K1/(K0 + K1), K1' + K2' = K0 (K1 + K2)/(K0 + K1 + K2),
    D2' = K2' D2 (K0 + K1 + K2) / ((K0 + K1) K2) = D2 (K0/(K0 + K1))^2.

    Args:
        local_stiffness: spring K0 [N/m] of the attachment point.
        element: bushing (K, B) or elastomer (K1, K2, D2) in series with the spring.

    Raises:
        ConfigurationError: a local stiffness that is not a finite number above zero.
    """
    check(
        "local_stiffness",
        local_stiffness,
        quantity("N/m", "stiffness of the body at the attachment", above=0.0).metadata,
    )
    local = np.asarray(local_stiffness, dtype=float)
    static = np.asarray(element.stiffness)
    share = local / (local + static)
    if isinstance(element, Kelvin):
        # Without damping the branch is absent and the result is a plain spring.
        return Maxwell(
            stiffness=share * static, branch_stiffness=share * local, branch_damping=share**2 * element.damping
        )
    # K2' = K0 (K1 + K2)/(K0 + K1 + K2) - K0 K1/(K0 + K1), in a form without cancellation.
    branch = share * local * element.branch_stiffness / (local + static + element.branch_stiffness)
    return Maxwell(stiffness=share * static, branch_stiffness=branch, branch_damping=share**2 * element.branch_damping)
