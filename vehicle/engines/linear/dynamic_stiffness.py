"""Motion of all coordinates of a linear system: steady state on driven displacements, and free motion in a mode.

    D(s) u = s^2 M u + s C u + K u + sum_b h_b' K2 tau / (1 + s tau) (s e_b + g_b) u = (s Bc + Bk) z + constraint forces

At each line s = j 2 pi f; in a mode z = 0, s is its pole and u its eigenvector. `vehicle.engines.linear.response` gives
the same for a few outputs by partial fractions; this module returns all coordinates and the forces of locked sliding
pairs.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Complex
from vehicle.engines.linear.first_order import first_order, free_basis
from vehicle.engines.linear.system import LinearSystem


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SteadyMotion:
    """Motion of a system at m lines per unit of the driven displacement, or in a mode (m = 1) in any scale.

    Attributes:
        s: j 2 pi f, or the pole of the mode [rad/s]; (m,).
        motion: displacements u; (n, m).
        branch: forces of the Maxwell branches; (b, m).
        friction: forces of locked sliding pairs, with the sign of the equation of motion; (p, m).
    """

    s: Complex
    motion: Complex
    branch: Complex
    friction: Complex


def steady_motion(
    system: LinearSystem, frequency: npt.ArrayLike, driven: npt.ArrayLike, *, stuck: bool
) -> SteadyMotion:
    """Return the steady-state motion at given frequencies.

    Args:
        system: a single system without inputs in its branches and sliding pairs.
        frequency: lines [Hz], (m,).
        driven: amplitude of each input relative to the driven displacement, (w,).
        stuck: lock the sliding pairs; otherwise they have no friction.
    """
    s = 2j * np.pi * np.atleast_1d(np.asarray(frequency, dtype=float))
    share, basis = np.asarray(driven, dtype=float), free_basis(system, stuck=stuck)
    mass, damping, stiffness = (basis.T @ s_line @ basis for s_line in (system.mass, system.damping, system.stiffness))
    drag, push = system.input_damping @ share, system.input_stiffness @ share
    effects = system.effects @ basis
    # K2 s tau/(1 + s tau), the force of a branch by its strain; (m, b).
    branches = system.branch_stiffness * s[:, None] * system.branch_time / (1.0 + s[:, None] * system.branch_time)
    drifts = np.zeros_like(system.branch_rows) if system.branch_drifts is None else system.branch_drifts
    motion, forces = np.empty((system.size, len(s)), dtype=complex), np.empty((len(drifts), len(s)), dtype=complex)
    for index, (s_line, branch) in enumerate(zip(s, branches, strict=True)):
        # Strain e + g/s: a branch that drifts.
        rows = branch[:, None] * (system.branch_rows + drifts / s_line)
        dynamic = s_line**2 * mass + s_line * damping + stiffness + effects.T @ (rows @ basis)
        motion[:, index] = basis @ np.linalg.solve(dynamic, basis.T @ (s_line * drag + push))
        forces[:, index] = rows @ motion[:, index]
    friction = _friction(system, s, motion, forces, np.outer(drag, s) + push[:, None], stuck=stuck)
    return SteadyMotion(s=s, motion=motion, branch=forces, friction=friction)


def free_motion(system: LinearSystem, frequency: float, *, stuck: bool) -> SteadyMotion:
    """Return the motion in the mode whose natural frequency |s| / 2 pi is nearest to a frequency, in any scale.

    Args:
        system: a single system.
        frequency: natural frequency of the mode [Hz].
        stuck: lock the sliding pairs; otherwise they have no friction.
    """
    form = first_order(system, stuck=stuck)
    poles, vectors = np.linalg.eig(form.state)
    distance = np.where(poles.imag > 0.0, np.abs(np.abs(poles) - 2.0 * np.pi * frequency), np.inf)
    at = [int(np.argmin(distance))]
    motion, branch = form.shapes(vectors[:, at], poles[at]), vectors[form.branches][:, at]
    friction = _friction(system, poles[at], motion, branch, np.zeros_like(motion), stuck=stuck)
    return SteadyMotion(s=poles[at], motion=motion, branch=branch, friction=friction)


def _friction(
    system: LinearSystem, s: Complex, motion: Complex, branch: Complex, driving: Complex, *, stuck: bool
) -> Complex:
    """Return the forces of locked sliding pairs, which the equation of motion lacks; (p, m).

    `driving` are the forces of the driven displacements, (n, m); the other arguments are those of `SteadyMotion`.
    """
    if not (stuck and len(system.slide_rows)):
        return np.zeros((len(system.slide_rows), len(s)), dtype=complex)
    # M u'' + C u' + K u + H' f_b - forces is what joints and locked pairs give.
    inertia = system.mass @ (s**2 * motion) + system.damping @ (s * motion) + system.stiffness @ motion
    locked_rows = np.vstack([system.constraints, system.slide_rows]).T
    missing = inertia + system.effects.T @ branch - driving
    return np.asarray(np.linalg.lstsq(locked_rows, missing, rcond=None)[0][len(system.constraints) :])
