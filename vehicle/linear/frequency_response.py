"""Frequency responses of the linear car, from its matrices alone."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError
from vehicle.linear.matrices import CarMatrices
from vehicle.linear.modes import free_basis
from vehicle.names import WHEELS

Vector = npt.NDArray[np.float64]


def matrix_response(
    matrices: CarMatrices,
    frequency: npt.ArrayLike,
    channels: Sequence[str],
    *,
    wheel: str = "fr",
    stuck: bool = True,
) -> npt.NDArray[np.complex128]:
    """Acceleration over plate displacement of the linear car.

    (K + j w C - w2 M + sum_b j_b' K2 j w tau / (1 + j w tau) j_b) u = k_p + j w c_p,  H = -w2 (out u)

    Args:
        matrices: of the assembled car.
        frequency: [Hz], shape (m,).
        channels: acceleration channels.
        wheel: plate that is driven.
        stuck: dampers locked, or sliding with their viscous part alone.

    Returns:
        H [m/s2 per m], shape (channels, m).

    Raises:
        ConfigurationError: an unknown channel.
    """
    unknown = [channel for channel in channels if channel not in matrices.outputs]
    if unknown:
        raise ConfigurationError(f"no acceleration channel {unknown[0]!r}; known are {', '.join(matrices.outputs)}")
    basis = free_basis(matrices, stuck=stuck)
    full_damping = matrices.damping.copy()
    if not stuck:
        full_damping[matrices.dampers, matrices.dampers] += matrices.viscous
    full = (matrices.mass, full_damping, matrices.stiffness)
    mass, damping, stiffness = (basis.T @ matrix @ basis for matrix in full)
    branches = matrices.branch_rows @ basis
    plate = WHEELS.index(wheel)
    push = basis.T @ matrices.plate_stiffness[plate]
    drag = basis.T @ matrices.plate_damping[plate]
    outputs = np.array([matrices.outputs[channel] for channel in channels]) @ basis
    omegas = 2.0 * np.pi * np.atleast_1d(np.asarray(frequency, dtype=float))
    response = np.zeros((len(channels), len(omegas)), dtype=complex)
    for index, omega in enumerate(omegas):
        turn = 1j * omega * matrices.branch_time
        dynamic = stiffness + 1j * omega * damping - omega**2 * mass
        dynamic = dynamic + branches.T @ ((matrices.branch_stiffness * turn / (1.0 + turn))[:, None] * branches)
        response[:, index] = -(omega**2) * (outputs @ np.linalg.solve(dynamic, push + 1j * omega * drag))
    return response
