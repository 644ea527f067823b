"""Exact frequency responses of a linear lumped model to the road displacement, one model or a thousand."""

from __future__ import annotations

from typing import Literal

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError
from vehicle.lumped.state_space import StateSpace

Quantity = Literal["displacement", "velocity", "acceleration"]

DEFECTIVE = 1e-8
"""Smallest reciprocal condition of the eigenvectors trusted; below it the systems are solved line by line."""


def frequency_response(
    model: StateSpace, frequency: npt.ArrayLike, output: str, quantity: Quantity = "displacement"
) -> npt.NDArray[np.complex128]:
    """Response of an output per road displacement, exact at every line.

    H(jw) = (jw)^p (C (jw I - A)^-1 (b0 + jw b1) + g), by the poles of A: C V diag(1/(jw - lambda)) V^-1 b. Models whose
    eigenvectors are nearly dependent (critical damping) are solved directly at each line.

    Args:
        model: linear model without sliding pairs; leading axes "..." stand for many models.
        frequency: lines [Hz], shape (m,).
        output: name of the place.
        quantity: displacement (p = 0) [m/m], velocity (p = 1) [m/s per m] or acceleration (p = 2) [m/s2 per m].

    Returns:
        Complex response, shape (..., m).

    Raises:
        ConfigurationError: the model has sliding pairs, or a frequency is not a finite number of at least zero.
    """
    lines = np.atleast_1d(np.asarray(frequency, dtype=float))
    if not (np.isfinite(lines) & (lines >= 0.0)).all():
        raise ConfigurationError("frequency: must be finite numbers of at least 0.0 Hz")
    if model.slides:
        raise ConfigurationError(
            "frequency_response: a sliding pair has no frequency response of its own; compose the model with "
            "damper='slip' or damper='stick'"
        )
    s = 2j * np.pi * lines  # (m,)
    row, road = model.row(output)
    poles, vectors = np.linalg.eig(model.state)  # (..., s), (..., s, s)
    weights = np.einsum("...i,...ij->...j", row, vectors[..., : row.shape[-1], :])  # (..., s)
    usable = 1.0 / np.linalg.cond(vectors) > DEFECTIVE
    safe = np.where(usable[..., None, None], vectors, np.eye(vectors.shape[-1]))
    inputs = np.linalg.solve(safe, np.stack((model.road, model.road_rate), axis=-1))  # (..., s, 2)
    residues = weights[..., :, None] * inputs  # (..., s, 2)
    sums = np.swapaxes(residues, -1, -2) @ _partial_fractions(s.imag, poles)  # (..., 2, m)
    response = sums[..., 0, :] + s * sums[..., 1, :] + road[..., None]
    if not usable.all():
        response = np.where(usable[..., None], response, _solved(model, s, row) + road[..., None])
    order = {"displacement": 0, "velocity": 1, "acceleration": 2}[quantity]
    return np.asarray(s**order * response)


def _partial_fractions(omega: npt.NDArray[np.float64], poles: npt.NDArray[np.complex128]) -> npt.NDArray[np.complex128]:
    """1/(j omega - pole), shape (..., s, m), in real arithmetic: a complex division takes several times as long."""
    below = -poles.real[..., None]
    ahead = omega - poles.imag[..., None]
    scale = 1.0 / (below * below + ahead * ahead)
    fractions = np.empty(scale.shape, dtype=complex)
    np.multiply(below, scale, out=fractions.real)
    np.multiply(-ahead, scale, out=fractions.imag)
    return fractions


def _solved(
    model: StateSpace, s: npt.NDArray[np.complex128], row: npt.NDArray[np.float64]
) -> npt.NDArray[np.complex128]:
    """The same without poles: one linear system for each line, shape (..., m)."""
    identity = np.eye(model.state.shape[-1])
    matrices = s[:, None, None] * identity - model.state[..., None, :, :]
    right = model.road[..., None, :] + s[:, None] * model.road_rate[..., None, :]
    states = np.linalg.solve(matrices, right[..., None])[..., 0]  # (..., m, s)
    return np.asarray(np.einsum("...i,...mi->...m", row, states[..., : row.shape[-1]]))
