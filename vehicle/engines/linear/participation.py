"""Which modes of the body make a place of it loud, and which attachments drive them.

In the car the acceleration of a place on the body is a sum over the rigid motions and the modes of the free body,

    a = s^2 (J r + sum_n Phi_n q_n),

and what drives a mode is the sum over the attachments a of their forces F_a on the body,

    (s^2 + 2 zeta_n w_n s + w_n^2) q_n = sum_a Phi_na' F_a + m_n,

m_n being what else reaches a mode: moments, and preloads that turn with what they hang on. With rigid r, modes q and
forces F of the coupled car both sums are exact. A share is the part of a contribution that is in phase with the sum,
Re(c conj(a)) / |a|^2, so that shares add up to one; one that works against it is negative.

Source: Ewins, Modal Testing, 2nd ed., section 2.8, for the superposition of modes; the shares are the projection that
transfer path analysis uses for its contributions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.dynamic_stiffness import SteadyMotion, steady_motion
from vehicle.engines.linear.load_rows import LoadRows
from vehicle.engines.linear.matrices import CarMatrices
from vehicle.engines.linear.motion_names import RIGID_WORDS, mode_words
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.row_layout import numeric
from vehicle.errors import ConfigurationError
from vehicle.names import AXES

Complex = npt.NDArray[np.complex128]
Vector = npt.NDArray[np.float64]

RIGID = tuple(f"body {word}" for word in RIGID_WORDS)
"""The rigid motions of the trimmed body: of its centre of gravity, and about it."""

REST = "moments, turning preloads"
"""What drives a mode beside the forces of the attachments."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Participation:
    """Contributions to the acceleration of a place on the body, per plate displacement, at m lines.

    Attributes:
        place: acceleration channel.
        frequency: [Hz]; (m,).
        names: of the rigid motions and behind them of the modes; (6 + k).
        mode_frequency: of the body with what is fixed to it [Hz]; (k,).
        contributions: [m/s2 per m]; (6 + k, m).
        attachments: what holds the body or stands on it, and `REST`; (a,).
        modal_forces: of each on each mode [kg^-1/2 N per m]; (k, a, m).
    """

    place: str
    frequency: Vector
    names: tuple[str, ...]
    mode_frequency: Vector
    contributions: Complex
    attachments: tuple[str, ...]
    modal_forces: Complex

    @property
    def total(self) -> Complex:
        """The FRF of the place [m/s2 per m]; (m,)."""
        return np.asarray(self.contributions.sum(axis=0))

    @property
    def shares(self) -> Vector:
        """Share of each contribution in the total [-], (6 + k, m); the sum over them is 1."""
        return np.asarray(in_phase(self.contributions) / np.abs(self.total))

    @property
    def attachment_shares(self) -> Vector:
        """Share of each attachment in the force on each mode [-], (k, a, m); the sum over the attachments is 1."""
        sums = np.abs(self.modal_forces.sum(axis=1))
        return np.asarray(np.stack([in_phase(one) for one in self.modal_forces]) / sums[:, None])


def in_phase(parts: Complex) -> Vector:
    """The part of each contribution in phase with their sum, (k, m): Re(c conj(a)) / |a|; they add up to |a|."""
    total = parts.sum(axis=0)
    return np.asarray((parts * np.conj(total)).real / np.abs(total))


def participation(
    car: CarModel,
    matrices: CarMatrices,
    loads: LoadRows,
    place: str,
    frequency: npt.ArrayLike,
    *,
    stuck: bool,
    wheel: str,
) -> Participation:
    """Contributions to a channel of the body.

    Args:
        car: the car.
        matrices: its linear form.
        loads: forces of its elements as rows over it.
        place: acceleration channel of a place on the body, as "seat_rail_acc_z".
        frequency: lines [Hz], (m,), above zero.
        stuck: dampers locked, else with their viscous part alone.
        wheel: whose plate moves.

    Returns:
        The contributions.

    Raises:
        ConfigurationError: the place is none of the body, or the body is rigid.
    """
    own = car.vehicle.composition
    known = [f"{one.name}_acc_{axis}" for one in own.outputs if one.on == "body" for axis in AXES]
    if place not in known:
        raise ConfigurationError(f"place {place}: no acceleration on the body; there are {', '.join(known) or 'none'}")
    body = car.superelement
    if not (car.vehicle.body.flexible and len(body.frequencies)):
        raise ConfigurationError(
            f"{car.vehicle.name}: its body is rigid; modes that take part need body.flexible = true and a body model"
        )
    lines = np.atleast_1d(np.asarray(frequency, dtype=float))
    driven = [float(name == wheel) for name in car.vehicle.wheels]
    steady = steady_motion(matrices.system, lines, driven, stuck=stuck)
    row, _ = matrices.system.output(place)
    first = int(car.model.joint("body").dofadr[0])
    columns = [*range(first, first + 6), *range(matrices.modal.start, matrices.modal.stop)]
    attachments, forces = _modal_forces(car, matrices, loads, steady, driven)
    return Participation(
        place=place,
        frequency=lines,
        names=(*RIGID, *(mode_words(n, body.mode_names) for n in range(1, len(body.mode_names) + 1))),
        mode_frequency=body.frequencies * car.vehicle.body.frequency_scale,
        contributions=row[columns, None] * steady.motion[columns] * steady.s**2,
        attachments=(*attachments, REST),
        modal_forces=forces,
    )


def _modal_forces(
    car: CarModel, matrices: CarMatrices, loads: LoadRows, steady: SteadyMotion, driven: list[float]
) -> tuple[list[str], Complex]:
    """Names of what acts on the body, and its forces on the modes: (k, a + 1, m), the rest last."""
    s, u, z = steady.s, steady.motion, np.array(driven)
    values = loads.displacement @ u + loads.velocity @ (s * u) + loads.acceleration @ (s**2 * u)
    values += loads.branch @ steady.branch + loads.friction @ steady.friction
    values += (loads.height @ z)[:, None] + np.outer(loads.height_rate @ z, s)
    at, names, forces = {name: index for index, name in enumerate(loads.names)}, list[str](), list[Complex]()
    for one in car.vehicle.composition.connections:
        sign = float(one.moving == "body") - float(one.carrier == "body")
        kind = "ball" if one.law is None else "bushing"
        shape = _shape(car, f"{kind}/{one.name}")
        if sign and shape is not None:
            # In the design position the axes of every carrier are those of the car.
            names.append(one.name)
            forces.append(sign * shape.T @ values[[at[f"{one.name}_force_{axis}"] for axis in AXES]])
    for spring in car.vehicle.composition.springs:
        shape = _shape(car, spring.name)
        if shape is not None:
            low, high = (np.array(point) for point in spring.at)
            way = (high - low) / np.linalg.norm(high - low) * (1.0 if spring.parts[1] == "body" else -1.0)
            names.append(spring.name)
            forces.append(np.outer(shape.T @ way, values[at[f"{spring.name}_force"]]))
    dofs = np.arange(matrices.modal.start, matrices.modal.stop)
    joints = [int(car.model.dof_jntid[dof]) for dof in dofs]
    stiffness, damping = car.model.jnt_stiffness[joints].ravel(), np.ravel(car.model.dof_damping[dofs])
    needed = (s**2 + np.outer(damping, s) + stiffness[:, None]) * u[dofs]
    stacked = np.stack(forces, axis=1) if forces else np.zeros((len(dofs), 0, len(s)), dtype=complex)
    return names, np.concatenate([stacked, (needed - stacked.sum(axis=1))[:, None]], axis=1)


def _shape(car: CarModel, name: str) -> Vector | None:
    """Modal displacement of the body's node of an element [kg^-1/2], (3, k); None where it is not on the body."""
    shape = numeric(car.model, f"shape/{name}")
    return None if shape is None else shape.reshape(3, -1)
