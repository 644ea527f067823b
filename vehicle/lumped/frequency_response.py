"""Exact frequency responses of a linear lumped model to the road displacement, one model or a thousand."""

from __future__ import annotations

from typing import Literal

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError
from vehicle.lumped.state_space import StateSpace

Quantity = Literal["displacement", "velocity", "acceleration"]

BLOCK = 32768
"""Partial fractions held at once: they stay in the cache, and no fresh memory is asked for at each step."""

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
    # (b0 + s b1)/(s - pole) = (b0 + pole b1)/(s - pole) + b1, and C b1 is zero: a road's rate moves no coordinate.
    residues = weights * (inputs[..., 0] + poles * inputs[..., 1])  # (..., s)
    response = _partial_fractions(s.imag, poles, residues)
    response += road[..., None]
    if not usable.all():
        response = np.where(usable[..., None], response, _solved(model, s, row) + road[..., None])
    order = {"displacement": 0, "velocity": 1, "acceleration": 2}[quantity]
    if order:
        response *= s**order
    return response


def _partial_fractions(
    omega: npt.NDArray[np.float64], poles: npt.NDArray[np.complex128], residues: npt.NDArray[np.complex128]
) -> npt.NDArray[np.complex128]:
    """Sum of residue/(j omega - pole) over the poles.

    In real arithmetic, since a complex division takes several times as long; and block by block of the models.

    Args:
        omega: [rad/s], shape (m,).
        poles: [1/s], shape (..., s).
        residues: shape (..., s).

    Returns:
        Shape (..., m).
    """
    size, lines = poles.shape[-1], omega.size
    flat_poles, flat_residues = poles.reshape(-1, size), residues.reshape(-1, 1, size)
    sums = np.empty((len(flat_poles), 1, lines), dtype=complex)
    count = max(BLOCK // max(size * lines, 1), 1)
    ahead, scale = np.empty((count, size, lines)), np.empty((count, size, lines))
    fractions = np.empty((count, size, lines), dtype=complex)
    for start in range(0, len(flat_poles), count):
        block = flat_poles[start : start + count]
        a, q, f = ahead[: len(block)], scale[: len(block)], fractions[: len(block)]
        below = -block.real[..., None]
        np.subtract(block.imag[..., None], omega, out=a)
        np.multiply(a, a, out=q)
        q += below * below
        np.divide(1.0, q, out=q)
        np.multiply(below, q, out=f.real)
        np.multiply(a, q, out=f.imag)
        np.matmul(flat_residues[start : start + count], f, out=sums[start : start + count])
    return sums.reshape(*poles.shape[:-1], lines)


def _solved(
    model: StateSpace, s: npt.NDArray[np.complex128], row: npt.NDArray[np.float64]
) -> npt.NDArray[np.complex128]:
    """The same without poles: one linear system for each line, shape (..., m)."""
    identity = np.eye(model.state.shape[-1])
    matrices = s[:, None, None] * identity - model.state[..., None, :, :]
    right = model.road[..., None, :] + s[:, None] * model.road_rate[..., None, :]
    states = np.linalg.solve(matrices, right[..., None])[..., 0]  # (..., m, s)
    return np.asarray(np.einsum("...i,...mi->...m", row, states[..., : row.shape[-1]]))
