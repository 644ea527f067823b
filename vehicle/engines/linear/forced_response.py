"""Linear response of a car to its applied forces: with friction that holds, or without friction.

    (s^2 M + s C + K + H' diag(K2/(s + 1/tau)) (s e + g)) u = l + B r - H' diag(K2/(s + 1/tau)) v,    Jc u = 0

at each frequency W of the forces, s = jW, with their complex amplitudes in l; see `vehicle.engines.linear.system`. The
run-outs r of the tyres act by B = Bk + s Bc, Bc without that of slopes, and the velocities of their treads as slips v.
Without friction the dampers have the slope of their curve at rest: the softest segment, which C contains, counts only
at the velocities where it lies; and friction elements of bushings, for example of a rack, have no stiffness. Where
friction holds, both dampers and bushings stick.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vehicle.arrays import Complex, Indices
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.first_order import free_basis
from vehicle.model.laws.damper import damper_curve
from vehicle.model.parameters.force_elements import Damper


def forced_response(
    matrices: CarMatrices, channels: Sequence[str], dampers: Sequence[Damper], *, stuck: bool
) -> Complex:
    """Return the complex amplitudes of acceleration channels by each applied force alone, at all constant frequencies.

    Args:
        matrices: matrices of the car.
        channels: names of acceleration channels.
        dampers: laws of its dampers.
        stuck: all friction holds, with locked dampers; else dampers and bushings move without friction.

    Returns:
        Amplitudes of Re(Z exp(jWt)) [m/s2], (forces, channels, frequencies in the order of `matrices.lines`); their sum
        over the forces is the response of the car.
    """
    system = matrices.system
    if not stuck:
        slopes = np.array([float(damper_curve(law).slope(0.0)) for law in dampers]) - matrices.viscous
        damping = system.damping + system.slide_rows.T @ (slopes[:, None] * system.slide_rows)
        matrices = without_bushing_friction(replace(matrices, system=replace(system, damping=damping)))
    frequencies, amplitudes = matrices.lines.frequencies, force_amplitudes(matrices)
    unit = unit_response(matrices, channels, frequencies, np.arange(len(amplitudes)), stuck=stuck)
    return np.asarray(unit * amplitudes[:, None, :])


def without_bushing_friction(matrices: CarMatrices) -> CarMatrices:
    """Return the matrices of a car whose bushings have no friction: K - sum k r r' over their Jenkins elements."""
    frictions = [law for law in matrices.laws if law.friction]
    stiffness = matrices.system.stiffness - sum(
        (float(law.elements[0].sum()) * np.outer(law.row, law.row) for law in frictions), start=np.zeros(())
    )
    laws = tuple(law for law in matrices.laws if not law.friction)
    return replace(matrices, system=replace(matrices.system, stiffness=stiffness), laws=laws)


def force_amplitudes(matrices: CarMatrices) -> Complex:
    """Return the complex amplitudes Z of Re(Z exp(jWt)) of the applied forces, (forces, constant frequencies)."""
    # a cos(Wt) + b sin(Wt) = Re((a - jb) exp(jWt)).
    constant = matrices.coefficients[:, : 2 * len(matrices.lines.frequencies)]
    return np.asarray(constant[:, ::2] - 1j * constant[:, 1::2])


def unit_response(
    matrices: CarMatrices, channels: Sequence[str], frequencies: Sequence[float], forces: Indices, *, stuck: bool
) -> Complex:
    """Return Z of Re(Z exp(jWt)) of acceleration channels per unit of applied forces; (forces, channels, frequencies).

    Args:
        matrices: matrices of the car; dampers that move have the viscous part that its C contains.
        channels: names of acceleration channels.
        frequencies: angular frequencies W [rad/s].
        forces: indices in the order of `matrices.force_rows`, with amplitudes [m/s2 per N, N m, m or m/s].
        stuck: lock the dampers.
    """
    system = matrices.system
    basis = free_basis(system, stuck=stuck)
    mass, damping, stiffness = (basis.T @ part @ basis for part in (system.mass, system.damping, system.stiffness))
    strains, effects = system.branch_rows @ basis, system.effects @ basis
    drifts = np.zeros_like(strains) if system.branch_drifts is None else system.branch_drifts @ basis
    rows = np.array([system.output(name)[0] for name in channels]).reshape(-1, system.size) @ basis
    rows_of, slips, plate_heights = (part[forces].T for part in (
        matrices.force_rows, matrices.force_slips, matrices.force_heights))  # fmt: skip
    result = np.zeros((len(forces), len(rows), len(frequencies)), dtype=complex)
    for column, frequency in enumerate(frequencies):
        s = 1j * frequency
        # K2/(s + 1/tau) of (s e + g) u + v.
        transfer = (system.branch_stiffness / (s + 1.0 / system.branch_time))[:, None]
        whole = s * s * mass + s * damping + stiffness + effects.T @ (transfer * (s * strains + drifts))
        tyres = system.input_stiffness + s * matrices.level_damping
        # Force of each input along the free motions: l, the run-out over the tyres, and the slip in the branches.
        pushed = basis.T @ (rows_of + tyres @ plate_heights) - effects.T @ (transfer * slips)
        result[:, :, column] = (s * s * (rows @ np.linalg.solve(whole, pushed))).T
    return result
