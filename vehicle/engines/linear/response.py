"""Exact frequency responses of linear systems to their driven displacements, for one system or a stack."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Complex, Vector
from vehicle.engines.linear.first_order import FirstOrder
from vehicle.errors import ConfigurationError

Quantity = Literal["displacement", "velocity", "acceleration"]

BLOCK = 32768
"""Number of partial fractions in a block: they fit in the cache, and the memory is reused for each block."""

DEFECTIVE = 1e-8
"""Minimum reciprocal condition number of the scaled eigenvectors; below it the system is solved at each line."""


def frequency_response(
    form: FirstOrder,
    frequency: npt.ArrayLike,
    outputs: str | Sequence[str],
    quantity: Quantity = "displacement",
    *,
    driven: npt.ArrayLike | None = None,
) -> Complex:
    """Return the exact response per driven displacement; (..., m) for one output, (..., outputs, m) for several.

    H(jw) = (jw)^p (C (jw I - A)^-1 (b0 + jw b1) + g), by the poles of A: C V diag(1/(jw - s)) V^-1 b. Systems whose
    eigenvectors are nearly dependent (critical damping) are solved directly at each line.

    Args:
        form: first-order form; leading axes "..." for a stack of systems.
        frequency: lines [Hz], shape (m,).
        outputs: name of an output, or several.
        quantity: displacement (p = 0) [m/m], velocity (p = 1) [m/s per m] or acceleration (p = 2) [m/s2 per m].
        driven: amplitude of each input relative to the driven displacement, shape (w,); 1 for all by default.

    Raises:
        ConfigurationError: an unknown output, a frequency that is not a finite number of at least zero, or a model
            with sliding pairs.
    """
    lines = np.atleast_1d(np.asarray(frequency, dtype=float))
    if not (np.isfinite(lines) & (lines >= 0.0)).all():
        raise ConfigurationError("frequency: must be finite numbers of at least 0.0 Hz")
    if form.system.slides:
        raise ConfigurationError(
            "frequency_response: a model with sliding pairs has no frequency response; compose it with "
            "damper='slip' or damper='stick'"
        )
    names = [outputs] if isinstance(outputs, str) else list(outputs)
    share = np.ones(len(form.system.inputs)) if driven is None else np.asarray(driven, dtype=float)
    coefficients = [form.output(name) for name in names]
    rows = np.stack([row for row, _ in coefficients], axis=-2)  # (..., o, m)
    direct = np.stack([inputs @ share for _, inputs in coefficients], axis=-1)  # (..., o)
    by_displacement, by_rate = form.input @ share, form.input_rate @ share  # (..., s)
    s = 2j * np.pi * lines  # (m,)
    poles, vectors = np.linalg.eig(form.state)  # (..., s), (..., s, s)
    weights = rows @ vectors[..., : rows.shape[-1], :]  # (..., o, s)
    # Scale each state by its largest value: with metres and newtons mixed, eigenvectors would look nearly dependent.
    unit = np.max(np.abs(vectors), axis=-1, keepdims=True)  # (..., s, 1)
    unit = np.where(unit > 0.0, unit, 1.0)
    scaled = vectors / unit
    usable = 1.0 / np.linalg.cond(scaled) > DEFECTIVE
    safe = np.where(usable[..., None, None], scaled, np.eye(scaled.shape[-1]))
    inputs = np.linalg.solve(safe, np.stack((by_displacement, by_rate), axis=-1) / unit)  # (..., s, 2)
    # (b0 + s b1)/(s - pole) = (b0 + pole b1)/(s - pole) + b1, and C b1 is zero: the rate of an input does not displace
    # a coordinate directly.
    residues = weights * (inputs[..., 0] + poles * inputs[..., 1])[..., None, :]  # (..., o, s)
    response = _partial_fractions(s.imag, poles, residues)
    if not np.all(usable):
        response = np.where(usable[..., None, None], response, _solved(form, s, rows, by_displacement, by_rate))
    response += direct[..., None]
    order = {"displacement": 0, "velocity": 1, "acceleration": 2}[quantity]
    if order:
        response *= s**order
    return response[..., 0, :] if isinstance(outputs, str) else response


def _partial_fractions(omega: Vector, poles: Complex, residues: Complex) -> Complex:
    """Sum residue/(j omega - pole) over the poles (..., s) of residues (..., o, s) at omega (m,); (..., o, m).

    Uses real arithmetic, since a complex division takes several times as long, and blocks of systems.
    """
    size, lines, output_count = poles.shape[-1], omega.size, residues.shape[-2]
    flat_poles, flat_residues = poles.reshape(-1, size), residues.reshape(-1, output_count, size)
    sums = np.empty((len(flat_poles), output_count, lines), dtype=complex)
    count = max(BLOCK // max(size * lines, 1), 1)
    frequency_buffer, scale_buffer = np.empty((count, size, lines)), np.empty((count, size, lines))
    fractions = np.empty((count, size, lines), dtype=complex)
    for start in range(0, len(flat_poles), count):
        block = flat_poles[start : start + count]
        a, q, f = frequency_buffer[: len(block)], scale_buffer[: len(block)], fractions[: len(block)]
        decay_rate = -block.real[..., None]
        # With p = -d + jb: 1/(jw - p) = (d + j (b - w))/(d^2 + (b - w)^2); d, b - w and the denominator are
        # `decay_rate`, a, q.
        np.subtract(block.imag[..., None], omega, out=a)
        np.multiply(a, a, out=q)
        q += decay_rate * decay_rate
        np.divide(1.0, q, out=q)
        np.multiply(decay_rate, q, out=f.real)
        np.multiply(a, q, out=f.imag)
        np.matmul(flat_residues[start : start + count], f, out=sums[start : start + count])
    return sums.reshape(*poles.shape[:-1], output_count, lines)


def _solved(form: FirstOrder, s: Complex, rows: Vector, by_displacement: Vector, by_rate: Vector) -> Complex:
    """Return the frequency response by solving a linear system at each line, shape (..., o, m)."""
    matrices = s[:, None, None] * np.eye(form.state.shape[-1]) - form.state[..., None, :, :]
    right_side = by_displacement[..., None, :] + s[:, None] * by_rate[..., None, :]
    states = np.linalg.solve(matrices, right_side[..., None])[..., 0]  # (..., m, s)
    return np.asarray(np.einsum("...oi,...mi->...om", rows, states[..., : rows.shape[-1]]))
