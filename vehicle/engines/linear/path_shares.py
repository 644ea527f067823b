"""Shares of the attachments of the body in a mode at a point of the body: transfer path analysis of a free motion.

The body is free of all elements, with the coordinates u_b of its rigid motion and its modes. In a mode of the complete
car, u(t) = Re(u exp(s t)) with its pole s and plates at rest,

    Z u_b = sum_a J_a' F_a + r,    Z = s^2 M_b + s C_b + K_b,

where C_b and K_b are those of the body's modes alone. F_a are the forces of the attachments in this mode, and r the
rest: moments, and preloads that rotate with their carriers. The acceleration c of a point of the body in this mode is
then a sum over the attachments,

    a = s^2 c u_b = s^2 c Z^-1 (sum_a J_a' F_a + r) = sum_a a_a + a_r.

The share of an attachment is its part in phase with the sum, Re(a_a conj(a)) / |a|^2; all shares add up to 1, and a
path that opposes the sum has a negative share.

Source: Plunt, Finding and fixing vehicle NVH problems with transfer path analysis, Sound and Vibration 39 (2005);
paths by the matrix method, with forces and transfer functions of the model instead of measured ones.
"""

from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.engines.linear.body_attachments import RIGID, body_attachments, body_coordinates
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.dynamic_stiffness import free_motion
from vehicle.engines.linear.load_rows import LoadRows
from vehicle.engines.simulation.car_model import CarModel
from vehicle.errors import ConfigurationError

REST = "moments and rotating preloads"
"""Name of the rest, in addition to the forces of the attachments."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PathShares:
    """Contributions of the attachments of the body to an acceleration in a mode.

    Attributes:
        pole: s of the mode [rad/s].
        names: attachments, and `REST` last; (a,).
        forces: generalised force of each on the coordinates of the body, in the scale of the mode; (a, 6 + k).
        contributions: contribution of each to the acceleration, in the scale of the mode; (a,).
        shares: share of each [-]; (a,).
    """

    pole: complex
    names: tuple[str, ...]
    forces: Complex
    contributions: Complex
    shares: Vector


def path_shares(
    car: CarModel, matrices: CarMatrices, loads: LoadRows, channel: str, frequency: float, *, stuck: bool
) -> PathShares:
    """Return the shares of the attachments of the body in an acceleration of the body in a mode.

    Args:
        car: compiled and trimmed car.
        matrices: matrices of the car.
        loads: element forces of the car as rows over its motion.
        channel: acceleration channel of a point on the body, for example "seat_rail_acc_z".
        frequency: natural frequency of the mode [Hz]; the mode nearest to it is taken.
        stuck: True for locked dampers, False for their viscous part without friction.

    Raises:
        ConfigurationError: the channel is not an acceleration of the body.
    """
    body, row = body_coordinates(car, matrices), matrices.system.output(channel)[0]
    if np.any(np.delete(row, body)):
        raise ConfigurationError(f"channel {channel}: must be an acceleration of a point on the body")
    attachments = body_attachments(car, matrices)
    index = {name: i for i, name in enumerate(loads.names)}
    free = free_motion(matrices.system, frequency, stuck=stuck)
    s, u = complex(free.s[0]), free.motion[:, 0]
    force = loads.displacement @ u + loads.velocity @ (s * u) + loads.acceleration @ (s**2 * u)
    force = force + loads.branch @ free.branch[:, 0] + loads.friction @ free.friction[:, 0]
    # The matrices of the free body: the rigid motion has neither stiffness nor damping.
    mass = matrices.system.mass[np.ix_(body, body)]
    joints = [int(car.model.dof_jntid[dof]) for dof in body[RIGID:]]
    stiffness = np.concatenate([np.zeros(RIGID), np.ravel(car.model.jnt_stiffness[joints])])
    damping = np.concatenate([np.zeros(RIGID), np.ravel(car.model.dof_damping[body[RIGID:]])])
    dynamic = s**2 * mass + np.diag(s * damping + stiffness)
    # Row of the acceleration over generalised forces, s^2 c Z^-1.
    transfer = s**2 * np.linalg.solve(dynamic.T, row[body].astype(complex))
    generalised = [each.rows.T @ force[[index[name] for name in each.channels]] for each in attachments]
    generalised.append(dynamic @ u[body] - np.sum(generalised, axis=0))
    contributions = np.array([transfer @ part for part in generalised])
    total = contributions.sum()
    return PathShares(
        pole=s,
        names=(*(each.name for each in attachments), REST),
        forces=np.array(generalised),
        contributions=contributions,
        shares=np.asarray((contributions * np.conj(total)).real / (abs(total) ** 2 or 1.0)),
    )
