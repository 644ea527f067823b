"""Contributions of the body modes to an acceleration of the body, and of the attachments to the modal forces.

The acceleration of a point on the body is a sum over the rigid motions and the modes of the free body,

    a = s^2 (J r + sum_n Phi_n q_n),

and the modal force is a sum over the attachments a of their forces F_a on the body,

    (s^2 + 2 zeta_n w_n s + w_n^2) q_n = sum_a Phi_na' F_a + m_n,

with the remainder m_n: moments, and preloads that rotate with their carriers. With rigid motions r, modes q and forces
F of the coupled car both sums are exact. The share of a contribution c is its part in phase with the sum a,
Re(c conj(a)) / |a|^2: shares add up to 1, and a contribution that opposes the sum has a negative share.

Source: Ewins, Modal Testing, 2nd ed., section 2.8, for the superposition of modes; the shares are the projection that
transfer path analysis uses for its contributions.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Complex, Vector
from vehicle.engines.linear.body_attachments import body_attachments, body_coordinates
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.dynamic_stiffness import SteadyMotion, steady_motion
from vehicle.engines.linear.load_rows import LoadRows
from vehicle.engines.linear.motion_names import RIGID_WORDS, mode_words
from vehicle.engines.simulation.car_model import CarModel
from vehicle.errors import ConfigurationError
from vehicle.names import AXES

RIGID = tuple(f"body {word}" for word in RIGID_WORDS)
"""Rigid motions of the trimmed body: translations of its centre of gravity and rotations about it."""

REMAINDER = "moments, turning preloads"
"""Name of the remainder of the modal force, in addition to the forces of the attachments."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Participation:
    """Contributions to an acceleration of the body per plate displacement, at m spectral lines.

    Attributes:
        channel: acceleration channel.
        frequency: [Hz]; (m,).
        names: names of the rigid motions followed by the modes; (6 + k).
        mode_frequency: natural frequencies of the body with the parts fixed to it [Hz]; (k,).
        contributions: contribution of each motion [m/s2 per m]; (6 + k, m).
        attachments: names of the elements attached to the body, and `REMAINDER`; (a,).
        modal_forces: force of each attachment on each mode [kg^-1/2 N per m]; (k, a, m).
    """

    channel: str
    frequency: Vector
    names: tuple[str, ...]
    mode_frequency: Vector
    contributions: Complex
    attachments: tuple[str, ...]
    modal_forces: Complex

    @property
    def total(self) -> Complex:
        """Return the FRF of the channel [m/s2 per m]; (m,)."""
        return np.asarray(self.contributions.sum(axis=0))

    @property
    def shares(self) -> Vector:
        """Return the share of each contribution in the total [-], (6 + k, m); the shares add up to 1."""
        return np.asarray(in_phase(self.contributions) / np.abs(self.total))

    @property
    def attachment_shares(self) -> Vector:
        """Return the share of each attachment in each modal force [-], (k, a, m); they add up to 1 over a."""
        sums = np.abs(self.modal_forces.sum(axis=1))
        return np.asarray(np.stack([in_phase(forces) for forces in self.modal_forces]) / sums[:, None])


def in_phase(parts: Complex) -> Vector:
    """Return the part of each contribution c in phase with the sum a of all: Re(c conj(a)) / |a|; (k, m)."""
    total = parts.sum(axis=0)
    return np.asarray((parts * np.conj(total)).real / np.abs(total))


def participation(
    car: CarModel,
    matrices: CarMatrices,
    loads: LoadRows,
    channel: str,
    frequency: npt.ArrayLike,
    *,
    stuck: bool,
    wheel: str,
) -> Participation:
    """Return the contributions to an acceleration channel of the body.

    Args:
        car: compiled and trimmed car.
        matrices: matrices of the car.
        loads: element forces of the car as rows over its motion.
        channel: acceleration channel of a point on the body, for example "seat_rail_acc_z".
        frequency: lines [Hz], (m,), above zero.
        stuck: True for locked dampers, False for their viscous part without friction.
        wheel: wheel whose plate moves.

    Raises:
        ConfigurationError: the channel is not an acceleration of the body, or the body is rigid.
    """
    composition = car.vehicle.composition
    body_channels = [
        f"{output.name}_acc_{axis}" for output in composition.outputs if output.on == "body" for axis in AXES
    ]
    if channel not in body_channels:
        raise ConfigurationError(
            f"channel {channel}: must be an acceleration of the body: {', '.join(body_channels) or 'it has none'}"
        )
    body = car.superelement
    if not (car.vehicle.body.flexible and len(body.frequencies)):
        raise ConfigurationError(
            f"{car.vehicle.name}: the body is rigid, so it has no modes; set body.flexible = true and give a body model"
        )
    lines = np.atleast_1d(np.asarray(frequency, dtype=float))
    driven = [float(name == wheel) for name in car.vehicle.wheels]
    steady = steady_motion(matrices.system, lines, driven, stuck=stuck)
    row, _ = matrices.system.output(channel)
    columns = body_coordinates(car, matrices)
    attachments, forces = _modal_forces(car, matrices, loads, steady, driven)
    return Participation(
        channel=channel,
        frequency=lines,
        names=(*RIGID, *(mode_words(n, body.mode_names) for n in range(1, len(body.mode_names) + 1))),
        mode_frequency=body.frequencies * car.vehicle.body.frequency_scale,
        contributions=row[columns, None] * steady.motion[columns] * steady.s**2,
        attachments=(*attachments, REMAINDER),
        modal_forces=forces,
    )


def _modal_forces(
    car: CarModel, matrices: CarMatrices, loads: LoadRows, steady: SteadyMotion, driven: list[float]
) -> tuple[list[str], Complex]:
    """Return the names of the a attachments, and the modal forces (k, a + 1, m) with the remainder last."""
    s, u, z = steady.s, steady.motion, np.array(driven)
    values = loads.displacement @ u + loads.velocity @ (s * u) + loads.acceleration @ (s**2 * u)
    values += loads.branch @ steady.branch + loads.friction @ steady.friction
    values += (loads.height @ z)[:, None] + np.outer(loads.height_rate @ z, s)
    index_of, attachments = {name: index for index, name in enumerate(loads.names)}, body_attachments(car, matrices)
    forces = [each.rows[:, len(RIGID) :].T @ values[[index_of[name] for name in each.channels]] for each in attachments]
    dofs = np.arange(matrices.modal.start, matrices.modal.stop)
    joints = [int(car.model.dof_jntid[dof]) for dof in dofs]
    stiffness, damping = car.model.jnt_stiffness[joints].ravel(), np.ravel(car.model.dof_damping[dofs])
    # Force that moves the modes as they move: (s^2 + 2 zeta w s + w^2) q.
    needed = (s**2 + np.outer(damping, s) + stiffness[:, None]) * u[dofs]
    stacked = np.stack(forces, axis=1) if forces else np.zeros((len(dofs), 0, len(s)), dtype=complex)
    names = [each.name for each in attachments]
    return names, np.concatenate([stacked, (needed - stacked.sum(axis=1))[:, None]], axis=1)
