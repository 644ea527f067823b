"""Proof that a car has only one periodic state with a period.

The differences of two states w = W - G p obey <dp, dw> = -<dp, G dp>. A law that never falls has <dp, dw> >= 0, so
dp = 0 if the Hermitian part of G is positive at every harmonic. A law that falls by at most m has
<dp, dw> >= -m |dw|^2, and dw = 0 if the Hermitian part of G^-1 exceeds m. Jenkins elements over a displacement x obey
the same over the velocity x': the motion is unique, but not the mean force of their sliders.

The proof does not cover stops, tables and one-sided tyres: above its resonance a mass moves against its force. It does
not cover rubber friction either, because the matrices contain a part of its stiffness, nor rolling tyres, because their
force is a product of the load and the motion of the plate.
"""

from collections.abc import Sequence

import numpy as np

from vehicle.arrays import Complex, Mask, Vector
from vehicle.engines.steady.cycle import Cycle
from vehicle.engines.steady.law_ports import Play, Port

ROUND_OFF = 1e-10
"""Smallest eigenvalue that counts as positive, over the largest response of the ports."""


def one_state(ports: Sequence[Port], effects: Complex, speeds: Vector, cycle: Cycle, *, rolling: bool) -> Mask:
    """Return True at the frequencies at which the proof holds, at the harmonics that are computed; (f,).

    Args:
        ports: the laws.
        effects: G; (f, ports, ports, k).
        speeds: angular frequencies of the harmonics [rad/s]; (f, k).
        cycle: samples of the period.
        rolling: True for rolling tyres.
    """
    proven = (port.of_velocity or (isinstance(port, Play) and not port.kept) for port in ports)
    if rolling or not all(proven):
        return np.zeros(len(effects), dtype=bool)
    moving = cycle.harmonics > 0
    of_velocity = np.array([port.of_velocity for port in ports])
    s = 1j * speeds[:, None, None, moving]
    mobility = np.moveaxis(effects[..., moving] * np.where(of_velocity[:, None, None], 1.0, s), -1, 1)
    falls = np.array([port.fall for port in ports])
    if falls.any():
        mobility = np.asarray(np.linalg.inv(mobility), dtype=np.complex128)
    # Scaled by the response of each port, because the ports have different units.
    size = np.sqrt(np.abs(np.einsum("fkii->fki", mobility)))
    hermitian = 0.5 * (mobility + np.conj(np.swapaxes(mobility, -1, -2))) - np.diag(falls)
    smallest = np.linalg.eigvalsh(hermitian / (size[..., :, None] * size[..., None, :]))[..., 0]
    return np.asarray((smallest > ROUND_OFF).all(axis=1))
