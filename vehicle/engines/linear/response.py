"""Exact frequency responses of a linear system to its driven displacements, one system or a thousand."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.first_order import FirstOrder
from vehicle.errors import ConfigurationError

Quantity = Literal["displacement", "velocity", "acceleration"]

BLOCK = 32768
"""Partial fractions held at once: they stay in the cache, and no fresh memory is asked for at each step."""

DEFECTIVE = 1e-8
"""Smallest reciprocal condition of the eigenvectors trusted, each state in a unit of its own; below it the systems are
solved line by line."""


def frequency_response(
    form: FirstOrder,
    frequency: npt.ArrayLike,
    outputs: str | Sequence[str],
    quantity: Quantity = "displacement",
    *,
    driven: npt.ArrayLike | None = None,
) -> npt.NDArray[np.complex128]:
    """Response of outputs per driven displacement, exact at every line.

    H(jw) = (jw)^p (C (jw I - A)^-1 (b0 + jw b1) + g), by the poles of A: C V diag(1/(jw - s)) V^-1 b. Systems whose
    eigenvectors are nearly dependent (critical damping) are solved directly at each line.

    Args:
        form: linear system; leading axes "..." stand for many.
        frequency: lines [Hz], shape (m,).
        outputs: name of a place, or several.
        quantity: displacement (p = 0) [m/m], velocity (p = 1) [m/s per m] or acceleration (p = 2) [m/s2 per m].
        driven: share of the displacement that each input makes, shape (w,); all alike by default.

    Returns:
        Complex response, shape (..., m) for one place, (..., places, m) for several.

    Raises:
        ConfigurationError: an unknown output, a frequency that is not a finite number of at least zero, or sliding
            pairs with laws of their own.
    """
    lines = np.atleast_1d(np.asarray(frequency, dtype=float))
    if not (np.isfinite(lines) & (lines >= 0.0)).all():
        raise ConfigurationError("frequency: must be finite numbers of at least 0.0 Hz")
    if form.system.slides:
        raise ConfigurationError(
            "frequency_response: a sliding pair has no frequency response of its own; compose the model with "
            "damper='slip' or damper='stick'"
        )
    names = [outputs] if isinstance(outputs, str) else list(outputs)
    share = np.ones(len(form.system.inputs)) if driven is None else np.asarray(driven, dtype=float)
    found = [form.output(name) for name in names]
    rows = np.stack([row for row, _ in found], axis=-2)  # (..., o, m)
    direct = np.stack([inputs @ share for _, inputs in found], axis=-1)  # (..., o)
    push, drag = form.input @ share, form.input_rate @ share  # (..., s)
    s = 2j * np.pi * lines  # (m,)
    poles, vectors = np.linalg.eig(form.state)  # (..., s), (..., s, s)
    weights = rows @ vectors[..., : rows.shape[-1], :]  # (..., o, s)
    # Each state in a unit of its own: with metres beside newtons of Maxwell branches, vectors look nearly dependent.
    unit = np.max(np.abs(vectors), axis=-1, keepdims=True)  # (..., s, 1)
    unit = np.where(unit > 0.0, unit, 1.0)
    scaled = vectors / unit
    usable = 1.0 / np.linalg.cond(scaled) > DEFECTIVE
    safe = np.where(usable[..., None, None], scaled, np.eye(scaled.shape[-1]))
    inputs = np.linalg.solve(safe, np.stack((push, drag), axis=-1) / unit)  # (..., s, 2)
    # (b0 + s b1)/(s - pole) = (b0 + pole b1)/(s - pole) + b1, and C b1 is zero: a rate of an input moves no coordinate.
    residues = weights * (inputs[..., 0] + poles * inputs[..., 1])[..., None, :]  # (..., o, s)
    response = _partial_fractions(s.imag, poles, residues)
    if not np.all(usable):
        response = np.where(usable[..., None, None], response, _solved(form, s, rows, push, drag))
    response += direct[..., None]
    order = {"displacement": 0, "velocity": 1, "acceleration": 2}[quantity]
    if order:
        response *= s**order
    return response[..., 0, :] if isinstance(outputs, str) else response


def _partial_fractions(
    omega: npt.NDArray[np.float64], poles: npt.NDArray[np.complex128], residues: npt.NDArray[np.complex128]
) -> npt.NDArray[np.complex128]:
    """Sum of residue/(j omega - pole) over the poles.

    In real arithmetic, since a complex division takes several times as long; and block by block of the systems.

    Args:
        omega: [rad/s], shape (m,).
        poles: [1/s], shape (..., s).
        residues: shape (..., o, s).

    Returns:
        Shape (..., o, m).
    """
    size, lines, places = poles.shape[-1], omega.size, residues.shape[-2]
    flat_poles, flat_residues = poles.reshape(-1, size), residues.reshape(-1, places, size)
    sums = np.empty((len(flat_poles), places, lines), dtype=complex)
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
    return sums.reshape(*poles.shape[:-1], places, lines)


def _solved(
    form: FirstOrder,
    s: npt.NDArray[np.complex128],
    rows: npt.NDArray[np.float64],
    push: npt.NDArray[np.float64],
    drag: npt.NDArray[np.float64],
) -> npt.NDArray[np.complex128]:
    """The same without poles: one linear system for each line, shape (..., o, m)."""
    matrices = s[:, None, None] * np.eye(form.state.shape[-1]) - form.state[..., None, :, :]
    right = push[..., None, :] + s[:, None] * drag[..., None, :]
    states = np.linalg.solve(matrices, right[..., None])[..., 0]  # (..., m, s)
    return np.asarray(np.einsum("...oi,...mi->...om", rows, states[..., : rows.shape[-1]]))
