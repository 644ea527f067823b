"""Many modes of the body: MuJoCo solves for what the attachments can tell apart, the callback has the rest.

Everything that acts on the modes comes through the shapes Phi at the attachments, r_0 x N, and sees q only as Phi q:

    m q'' = -k (q - q_0) - b q' + Phi' f        (diagonal m, k, b)

With an orthonormal basis Q of the range of m^-1/2 Phi', N x r, r <= r_0, and S = m^-1/2 Q, the motion that is seen is
Phi q = (Phi S) eta, eta = Q' m^1/2 q, and

    eta'' = S' (-k (q - q_0) - b q') + (Phi S)' f,      q'' = (-k (q - q_0) - b q') / m + S (eta'' - S' (...)).

MuJoCo holds the r coordinates eta with unit masses, the shapes Phi S and the applied force S' (...); from its eta'' the
N modal coordinates take the same step, v+ = v + h q'', q+ = q + h v+, of which they are advanced where the next step
begins. Nothing is left out: results are those of a model with all modes, to round-off. Modes cost r N products a step
where the dense solver takes nv^2 rows of them. Where modes are no more than r, MuJoCo holds them themselves.
"""

from __future__ import annotations

from vehicle.compiler import jitable
from vehicle.engines.simulation.element_records import Layout, ModalSpace, Vector
from vehicle.engines.simulation.step_records import Fields, State, Weights


@jitable
def modal_acceleration(k: int, modal: Vector, rates: Vector, pull: Vector, own: ModalSpace) -> float:
    """q'' of a mode [kg^1/2 m/s2] at positions and rates of the modes under what the attachments pull, (r,)."""
    row, total = own.spread[k], 0.0
    for j in range(pull.shape[0]):
        total += row[j] * pull[j]
    elastic = own.stiffness[k] * (own.rest[k] - modal[k]) - own.damping[k] * rates[k]
    found: float = elastic / own.mass[k] + total
    return found


@jitable
def advance_modes(time: float, d: Fields, e: Layout, c: Weights, s: State) -> None:
    """Carry the modal coordinates over the step that has just been completed; before the branches are."""
    own, size, first = e.space, e.modes.size, e.modes.first_velocity
    q, v = s.modal[0], s.modal[1]
    if own.mass.shape[0] == 0:
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
            v[k] += h * modal_acceleration(k, q, v, pull, own)
            q[k] += h * v[k]
        row, elastic = own.spread[k], own.stiffness[k] * (own.rest[k] - q[k]) - own.damping[k] * v[k]
        for j in range(size):
            force[j] += row[j] * elastic


@jitable
def modal_forces(d: Fields, e: Layout, s: State) -> None:
    """S' (-k (q - q_0) - b q') on the coordinates that MuJoCo holds; after the forces of the rows."""
    for j in range(s.modal_force.shape[0]):
        d.qfrc_applied[e.modes.first_velocity + j] += s.modal_force[j]
