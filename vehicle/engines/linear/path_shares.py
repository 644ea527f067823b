"""Shares of the attachments of the body in an acceleration that the plates cause: transfer path analysis.

The body is free of all elements, with the coordinates u_b of its rigid motion and its modes,

    Z u_b = sum_a J_a' F_a + r,    Z = s^2 M_b + s C_b + K_b,

where C_b and K_b are those of its modes alone. F_a are the forces of the attachments in the complete car, and r the
rest: moments, and preloads that rotate with their carriers. An acceleration c of the body is then a sum over the
attachments,

    a = s^2 c Z^-1 (sum_a J_a' F_a + r) = sum_a a_a + a_r,

exact at each line. The share of an attachment is its part in phase with the sum over all lines,

    share_a = sum over lines of Re(a_a conj(a)) / sum over lines of |a|^2;

all shares add up to 1, and a path that opposes the sum has a negative share.

Source: Plunt, Finding and fixing vehicle NVH problems with transfer path analysis, Sound and Vibration 39 (2005);
paths by the matrix method, with forces and transfer functions of the model instead of measured ones.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.body_attachments import RIGID, body_attachments, body_coordinates
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.dynamic_stiffness import steady_motion
from vehicle.engines.linear.load_rows import LoadRows
from vehicle.engines.simulation.car_model import CarModel
from vehicle.errors import ConfigurationError

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]

REST = "moments and rotating preloads"
"""Name of the rest, in addition to the forces of the attachments."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PathShares:
    """Contributions of the attachments of the body to an acceleration.

    Attributes:
        names: attachments, and `REST` last; (a,).
        forces: generalised force of each on the coordinates of the body [N, N m, kg^-1/2 N]; (a, 6 + k, m).
        contributions: contribution of each at the lines [m/s2]; (a, m).
        shares: share of each [-]; (a,).
    """

    names: tuple[str, ...]
    forces: Complex
    contributions: Complex
    shares: Vector


def path_shares(
    car: CarModel,
    matrices: CarMatrices,
    loads: LoadRows,
    channel: str,
    frequency: npt.ArrayLike,
    plates: npt.ArrayLike,
    *,
    stuck: bool,
) -> PathShares:
    """Return the shares of the attachments of the body in an acceleration of the body.

    Args:
        car: compiled and trimmed car.
        matrices: matrices of the car.
        loads: element forces of the car as rows over its motion.
        channel: acceleration channel of a point on the body, as "seat_rail_acc_z".
        frequency: lines [Hz], (m,), above zero.
        plates: complex amplitudes of the plate displacements at the lines [m], (w, m).
        stuck: True for locked dampers, False for their viscous part without friction.

    Raises:
        ConfigurationError: the channel is not an acceleration of the body.
    """
    lines, driven = np.atleast_1d(np.asarray(frequency, dtype=float)), np.asarray(plates, dtype=complex)
    body, row = body_coordinates(car, matrices), matrices.system.output(channel)[0]
    if np.any(np.delete(row, body)):
        raise ConfigurationError(f"channel {channel}: must be an acceleration of a point on the body")
    attachments = body_attachments(car, matrices)
    index = {name: i for i, name in enumerate(loads.names)}
    motion, forces = np.zeros((len(body), lines.size), complex), np.zeros((len(loads.names), lines.size), complex)
    for wheel, amplitude in enumerate(driven):
        if not np.any(amplitude):
            continue
        unit = np.eye(len(driven))[wheel]
        steady = steady_motion(matrices.system, lines, unit, stuck=stuck)
        s, u = steady.s, steady.motion
        force = loads.displacement @ u + loads.velocity @ (s * u) + loads.acceleration @ (s**2 * u)
        force += loads.branch @ steady.branch + loads.friction @ steady.friction
        force += (loads.height @ unit)[:, None] + np.outer(loads.height_rate @ unit, s)
        motion += amplitude * u[body]
        forces += amplitude * force
    s = 2j * np.pi * lines
    # The matrices of the free body: the rigid motion has neither stiffness nor damping.
    mass = matrices.system.mass[np.ix_(body, body)]
    joints = [int(car.model.dof_jntid[dof]) for dof in body[RIGID:]]
    stiffness = np.concatenate([np.zeros(RIGID), np.ravel(car.model.jnt_stiffness[joints])])
    damping = np.concatenate([np.zeros(RIGID), np.ravel(car.model.dof_damping[body[RIGID:]])])
    # Row of the acceleration over generalised forces, s^2 c Z^-1, at each line: (m, 6 + k).
    dynamic = s[:, None, None] ** 2 * mass + (s[:, None] * damping + stiffness)[:, :, None] * np.eye(len(body))
    transfer = s[:, None] ** 2 * np.linalg.solve(dynamic.transpose(0, 2, 1), row[body][None, :, None])[..., 0]
    generalised = [each.rows.T @ forces[[index[name] for name in each.channels]] for each in attachments]
    needed = np.einsum("mij,jm->im", dynamic, motion)
    generalised.append(needed - np.sum(generalised, axis=0))
    contributions = np.array([np.einsum("mi,im->m", transfer, part) for part in generalised])
    total = contributions.sum(axis=0)
    power = float(np.sum(np.abs(total) ** 2)) or 1.0
    return PathShares(
        names=(*(each.name for each in attachments), REST),
        forces=np.array(generalised),
        contributions=contributions,
        shares=np.asarray((contributions * np.conj(total)).real.sum(axis=1) / power),
    )
