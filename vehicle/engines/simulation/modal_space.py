"""Bodies with many modes: MuJoCo solves for the motion of the attachments, the callback integrates all modes.

All forces act on the N modes q through the shapes Phi at the attachments, (r_0, N), and depend on q only by Phi q:

    m q'' = -k (q - q_0) - b q' + Phi' f        (diagonal m, k, b)

With an orthonormal basis Q of the range of m^-1/2 Phi', N x r, r <= r_0, and S = m^-1/2 Q, the motion of the
attachments is Phi q = (Phi S) eta, eta = Q' m^1/2 q, and

    eta'' = S' (-k (q - q_0) - b q') + (Phi S)' f,      q'' = (-k (q - q_0) - b q') / m + S (eta'' - S' (...)).

The MuJoCo model has the r coordinates eta with unit masses, the shapes Phi S and the applied force S' (...). From eta''
the N modal coordinates take the same step, v+ = v + h q'', q+ = q + h v+, at the beginning of the next step. Results
equal those of a model with all modes, to round-off. Modes cost r N products a step, in place of nv^2 products for each
row of the dense solver. With no more than r modes, the MuJoCo model contains the modes.
"""

from __future__ import annotations

from vehicle.compiler import jitable
from vehicle.engines.simulation.element_records import Layout, ModalSpace, Vector
from vehicle.engines.simulation.step_records import Fields, State, Weights


@jitable
def modal_acceleration(k: int, modal: Vector, rates: Vector, pull: Vector, space: ModalSpace) -> float:
    """Return q'' of a mode [kg^1/2 m/s2] from modal positions, rates and the force of the attachments, (r,)."""
    row, total = space.spread[k], 0.0
    for j in range(pull.shape[0]):
        total += row[j] * pull[j]
    elastic = space.stiffness[k] * (space.rest[k] - modal[k]) - space.damping[k] * rates[k]
    acceleration: float = elastic / space.mass[k] + total
    return acceleration


@jitable
def advance_modes(time: float, d: Fields, e: Layout, c: Weights, s: State) -> None:
    """Advance the modal coordinates over the completed step; call this before `advance_branches`."""
    space, size, first = e.space, e.modes.size, e.modes.first_velocity
    q, v = s.modal[0], s.modal[1]
    if space.mass.shape[0] == 0:
        for k in range(size):
            q[k], v[k] = d.qpos[e.modes.first_position + k], d.qvel[first + k]
        return
    last, h, force, pull = s.last_time[0], c.timestep, s.modal_force, s.modal_pull
    if time == last:
        return
    for j in range(size):
        pull[j] = (d.qvel[first + j] - s.modal_rate[j]) / h - force[j]
        s.modal_rate[j], force[j] = d.qvel[first + j], 0.0
    for k in range(q.shape[0]):
        if last >= 0.0:
            v[k] += h * modal_acceleration(k, q, v, pull, space)
            q[k] += h * v[k]
        row, elastic = space.spread[k], space.stiffness[k] * (space.rest[k] - q[k]) - space.damping[k] * v[k]
        for j in range(size):
            force[j] += row[j] * elastic


@jitable
def modal_forces(d: Fields, e: Layout, s: State) -> None:
    """Add S' (-k (q - q_0) - b q') to the applied forces; call this after `generalised_forces`."""
    for j in range(s.modal_force.shape[0]):
        d.qfrc_applied[e.modes.first_velocity + j] += s.modal_force[j]
