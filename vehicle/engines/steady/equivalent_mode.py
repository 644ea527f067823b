"""Mode of a car with viscous dampers of equal energy."""

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.engines.reduced.pole_model import PoleModel

STEPS = 12
"""Steps in which the damping constants change from one set to the next; the pole of each starts the next."""

NEWTON = 30
"""Maximum number of Newton steps for a pole."""

ACCURACY = 1e-9
"""Last Newton step over the size of a pole."""


def strongest(model: PoleModel, damping: Vector, row: Complex, shares: Complex, frequency: float) -> complex:
    """Return the pole with the largest part of the response of an output to the inputs near a frequency [rad/s].

    Args:
        model: pole model.
        damping: damping constants c [N s/m]; (d,).
        row: row of the output over the stored poles; (p,).
        shares: amplitude of each plate, or of each applied force of a model with forces; (i,).
        frequency: frequency [Hz].
    """
    matrix, effects, rows = _parts(model)
    values, vectors = np.linalg.eig(matrix - (effects * (damping - model.matrices.viscous)) @ rows)
    s, pairs = 2j * np.pi * frequency, model.pairs
    # The residue of a conjugate pole is the conjugate residue; both poles have the same inputs.
    forced = model.applied.shape[1]
    residue, conjugate = (
        (model.applied if forced else model.height + s * model.velocity) @ shares,
        (model.applied.conj() if forced else model.height.conj() + s * model.velocity.conj())[:pairs] @ shares,
    )
    inputs = np.concatenate([residue, conjugate])
    half = np.concatenate([0.5 * row[:pairs], row[pairs:], 0.5 * row[:pairs].conj()])
    inputs[pairs : len(residue)] = residue[pairs:].real
    part = (half @ vectors) * np.linalg.solve(vectors, inputs) / (s - values)
    oscillating = values.imag > 0.0
    return complex(values[oscillating][np.argmax(np.abs(part[oscillating]))])


def followed(model: PoleModel, pole: complex, first: Vector, last: Vector) -> complex:
    """Return the pole that a pole becomes while the damping constants change; NaN if it is lost.

    A pole s of the car with viscous dampers has det(1 + T (c - D)) = 0 with T = row (s - poles)^-1 effect, a
    determinant of d rows. Newton's method solves it: the derivative of its logarithm is the trace of
    (1 + T (c - D))^-1 T' (c - D).

    Args:
        model: pole model.
        pole: pole with the first damping constants [rad/s].
        first, last: damping constants [N s/m]; (d,) each.
    """
    matrix, effects, rows = _parts(model)
    poles = np.diag(matrix)
    # A damper without friction has its least slope at all levels, within round-off.
    begin, end = (np.maximum(damping - model.matrices.viscous, 0.0) for damping in (first, last))
    for share in np.arange(1, STEPS + 1) / STEPS:
        more = begin ** (1.0 - share) * end**share
        for _ in range(NEWTON):
            factor = 1.0 / (pole - poles)
            table = (rows * factor) @ effects * more
            slope = -(rows * factor**2) @ effects * more
            change = 1.0 / np.trace(np.linalg.solve(np.eye(len(more)) + table, slope))
            pole -= change
            if not abs(change) > ACCURACY * abs(pole):
                break
        else:
            return complex("nan")
    return complex(pole)


def _parts(model: PoleModel) -> tuple[Complex, Complex, Complex]:
    """Return diag(s), effects of forces and rows of damper velocities over the stored poles and their conjugates."""
    pairs, s = model.pairs, model.poles
    matrix = np.diag(np.concatenate([s, s[:pairs].conj()]))
    effects = np.concatenate([model.force, model.force[:pairs].conj()])
    half = model.slip[:, :pairs] * 0.5
    return matrix, effects, np.hstack([half, model.slip[:, pairs:], half.conj()])
