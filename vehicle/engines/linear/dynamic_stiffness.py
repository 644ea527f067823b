"""The steady motion of a linear system on driven displacements, from its dynamic stiffness line by line.

    D(s) u = s^2 M u + s C u + K u + sum_b h_b' K2 tau / (1 + s tau) (s e_b + g_b) u = (s Bc + Bk) z + what is held

`vehicle.engines.linear.response` gives the same for a few outputs, by the poles; here are all coordinates and the
forces of joints and of locked sliding pairs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.first_order import free_basis
from vehicle.engines.linear.system import LinearSystem

Complex = npt.NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SteadyMotion:
    """What a system does per unit of the driven displacement, at m lines.

    Attributes:
        s: j 2 pi f [rad/s]; (m,).
        motion: u; (n, m).
        branch: forces of the Maxwell branches; (b, m).
        friction: forces of locked sliding pairs, positive as they enter the equation of motion; (p, m).
    """

    s: Complex
    motion: Complex
    branch: Complex
    friction: Complex


def steady_motion(
    system: LinearSystem, frequency: npt.ArrayLike, driven: npt.ArrayLike, *, stuck: bool
) -> SteadyMotion:
    """Steady motion at given frequencies.

    Args:
        system: the matrices of one system without inputs in its branches and sliding pairs.
        frequency: lines [Hz], (m,).
        driven: share of the displacement that each input makes, (w,).
        stuck: lock the sliding pairs; else they have no friction.

    Returns:
        The motion.
    """
    s = 2j * np.pi * np.atleast_1d(np.asarray(frequency, dtype=float))
    share, basis = np.asarray(driven, dtype=float), free_basis(system, stuck=stuck)
    mass, damping, stiffness = (basis.T @ one @ basis for one in (system.mass, system.damping, system.stiffness))
    drag, push = system.input_damping @ share, system.input_stiffness @ share
    effects = system.effects @ basis
    branches = system.branch_stiffness * s[:, None] * system.branch_time / (1.0 + s[:, None] * system.branch_time)
    drifts = np.zeros_like(system.branch_rows) if system.branch_drifts is None else system.branch_drifts
    motion, forces = np.empty((system.size, len(s)), dtype=complex), np.empty((len(drifts), len(s)), dtype=complex)
    for index, (one, branch) in enumerate(zip(s, branches, strict=True)):
        rows = branch[:, None] * (system.branch_rows + drifts / one)
        dynamic = one**2 * mass + one * damping + stiffness + effects.T @ (rows @ basis)
        motion[:, index] = basis @ np.linalg.solve(dynamic, basis.T @ (one * drag + push))
        forces[:, index] = rows @ motion[:, index]
    friction = np.zeros((len(system.slide_rows), len(s)), dtype=complex)
    if stuck and len(friction):
        inertia = system.mass @ (s**2 * motion) + system.damping @ (s * motion) + system.stiffness @ motion
        carried = inertia + system.effects.T @ forces - np.outer(drag, s) - push[:, None]
        held = np.vstack([system.constraints, system.slide_rows]).T
        friction = np.linalg.lstsq(held, carried, rcond=None)[0][len(system.constraints) :]
    return SteadyMotion(s=s, motion=motion, branch=forces, friction=friction)
