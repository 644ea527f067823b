"""Frequencies of the modes in which the body pitches most and the wheels of an axle hop most.

A mode is chosen by its share of the kinetic energy in that motion: pitch of the body about its centre of gravity, or
the vertical motion of both wheels of an axle in phase. The dampers slide; the frequency is |s| / 2 pi, as
`python -m vehicle modes --damper sliding` prints it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.natural_modes import NaturalModes, natural_modes
from vehicle.engines.linear.part_motions import rigid_rows

Complex = npt.NDArray[np.complex128]


class RideModes:
    """Modes of a car with sliding dampers, chosen by their motion.

    Args:
        matrices: matrices of the assembled car.
    """

    def __init__(self, matrices: CarMatrices) -> None:
        self.modes: NaturalModes = natural_modes(first_order(matrices.system, stuck=False))
        motion = self.modes.motion
        self._rows = {group: rows @ motion.T for group, rows in rigid_rows(matrices).items()}
        self._energy = np.real(np.einsum("mi,ij,mj->m", motion.conj(), matrices.system.mass, motion))

    def pitch_frequency(self) -> float:
        """Return the natural frequency of the mode with the largest share of body pitch [Hz]."""
        return self._largest(self._rows["body"][4])

    def hop_frequency(self, wheels: Sequence[str]) -> float:
        """Return the natural frequency of the mode with the largest share of wheel hop in phase [Hz].

        Args:
            wheels: names of the wheels of an axle.
        """
        heave = sum(self._rows[f"wheel_{wheel}"][2] for wheel in wheels) / np.sqrt(len(wheels))
        return self._largest(np.asarray(heave))

    def _largest(self, motion: Complex) -> float:
        """Return the frequency of the mode with the largest share of a motion, whose energy is its square."""
        return float(self.modes.frequency[int(np.argmax(np.abs(motion) ** 2 / self._energy))])
