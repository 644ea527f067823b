"""The connections of the car: which two bodies meet at which hardpoint, and with which law."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from vehicle.flexbody.superelement import Superelement
from vehicle.laws.kelvin import Kelvin
from vehicle.laws.maxwell import Maxwell
from vehicle.laws.series import in_series
from vehicle.names import SIDE_OF_WHEEL, WHEELS
from vehicle.parameters.elements import Bushing, Hydromount
from vehicle.parameters.vehicle import Vehicle

Vector = npt.NDArray[np.float64]

STRUCTURAL_LOSS_TIME = 1e-4
"""Damping over stiffness [s] of the local stiffness behind an ideal joint.

Assumed: a loss factor of 2 % at 30 Hz, usual for welded steel structures.
"""


def _zeros() -> Vector:
    return np.zeros(3)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ElementLaw:
    """f = -K r - B r' - f2 along each axis, with f2' = K2 r' - f2 / tau (Maxwell branch); torque = -K_rot angle.

    Attributes:
        stiffness: K [N/m], shape (3,).
        damping: B [N s/m], shape (3,).
        branch_stiffness: K2 [N/m], shape (3,); zero where there is no branch.
        branch_time: tau [s], shape (3,); zero where there is no branch.
        rotational_stiffness: K_rot [N m/rad].
        averaged: True where the stiffness is too high for the explicit step and is averaged over three steps
            (Newmark with beta 1/4); False for the fourth-order average (beta 1/12).
    """

    stiffness: Vector
    damping: Vector
    branch_stiffness: Vector = field(default_factory=_zeros)
    branch_time: Vector = field(default_factory=_zeros)
    rotational_stiffness: float = 0.0
    averaged: bool = False


@dataclass(frozen=True, kw_only=True, slots=True)
class Connection:
    """Two bodies that meet at a hardpoint.

    The residual r is the position of `moving` less that of `carrier`; the law acts in the axes of `carrier`.
    Without a law the connection is an ideal ball joint between rigid bodies.

    Attributes:
        name: unique name, also of its equality constraint in the MJCF file.
        moving: body whose displacement counts positive.
        carrier: the other body ("world" for the ground).
        hardpoint: name of the point of both in the design position.
        node: node of the flexible body, None where neither body is flexible.
        node_sign: +1 where the flexible body is `moving`, -1 where it is `carrier`.
        law: force law, or None.
    """

    name: str
    moving: str
    carrier: str
    hardpoint: str
    node: str | None
    node_sign: int
    law: ElementLaw | None


def connections(vehicle: Vehicle, body: Superelement) -> list[Connection]:
    """All bushings and loop-closing ball joints of the car, in the order of the constraint rows.

    Args:
        vehicle: parameters.
        body: superelement; gives the local stiffness of its attachment nodes.

    Returns:
        The list of connections.

    Source: Bommer 2006, section 3.1.3.
    """
    bushings = vehicle.bushings
    found: list[Connection] = []

    def bushing(name: str, parameters: Bushing | Hydromount, moving: str, carrier: str, hardpoint: str) -> None:
        on_body = "body" in (moving, carrier)
        local = _local_stiffness(vehicle, body, hardpoint) if on_body else None
        found.append(
            Connection(
                name=f"bushing/{name}",
                moving=moving,
                carrier=carrier,
                hardpoint=hardpoint,
                node=hardpoint if on_body else None,
                node_sign=1 if moving == "body" else -1,
                law=_bushing_law(parameters, local),
            )
        )

    def ball(name: str, moving: str, carrier: str, hardpoint: str) -> None:
        on_body = carrier == "body"
        local = _local_stiffness(vehicle, body, hardpoint) if on_body else None
        law = None
        if local is not None:
            law = ElementLaw(stiffness=local, damping=STRUCTURAL_LOSS_TIME * local, averaged=True)
        found.append(
            Connection(
                name=f"ball/{name}",
                moving=moving,
                carrier=carrier,
                hardpoint=hardpoint,
                node=hardpoint if on_body else None,
                node_sign=-1,
                law=law,
            )
        )

    for wheel in WHEELS:
        bushing(f"tyre_{wheel}", bushings.tyre, f"tyre_{wheel}", f"plate_{wheel}", f"tyre_patch_{wheel}")
        top = f"strut_top_{wheel}"
        bushing(f"suspension_mount_{wheel}", bushings.suspension_mount, f"damper_top_{wheel}", "body", top)
        bushing(f"arm_rear_{wheel}", bushings.arm_rear, f"a_arm_{wheel}", "body", f"arm_rear_{wheel}")
        side = SIDE_OF_WHEEL[wheel]
        bushing(f"rear_support_{side}", bushings.rear_support, "body", "world", f"rear_support_{side}")
    bushing("linear_mount", bushings.linear_mount, "engine", "body", "linear_mount")
    bushing("hydromount", bushings.hydromount, "engine", "body", "hydromount")
    bushing("torque_arm_body", bushings.torque_arm_body, "torque_arm", "body", "bottom_body")
    bushing("torque_arm_engine", bushings.torque_arm_engine, "torque_arm", "engine", "bottom_engine")
    for wheel in WHEELS:
        ball(f"arm_front_{wheel}", f"a_arm_{wheel}", "body", f"arm_front_{wheel}")
        ball(f"tie_inner_{wheel}", f"steering_rod_{wheel}", "body", f"tie_inner_{wheel}")
        ball(f"stab_body_{wheel}", f"stabilizer_half_{wheel}", "body", f"stab_body_{wheel}")
        ball(f"stab_rod_top_{wheel}", f"stabilizer_rod_{wheel}", f"damper_bottom_{wheel}", f"stab_rod_top_{wheel}")
    return found


def _local_stiffness(vehicle: Vehicle, body: Superelement, node: str) -> Vector | None:
    """Local stiffness of an attachment node [N/m], None where it is rigid."""
    if not vehicle.body.attachment_flexibility or node not in body.attachment_stiffness:
        return None
    return np.asarray(body.attachment_stiffness[node], dtype=float)


def _bushing_law(parameters: Bushing | Hydromount, local: Vector | None) -> ElementLaw:
    """Law of a bushing, with the local stiffness of its attachment point in series, exactly."""
    stiffness = np.array(parameters.stiffness)
    damping = np.array(parameters.damping)
    branch = np.zeros((2, 3))  # K2 [N/m] and tau [s]
    if isinstance(parameters, Hydromount) and parameters.maxwell_stiffness > 0.0 and parameters.maxwell_damping > 0.0:
        time = parameters.maxwell_damping / parameters.maxwell_stiffness
        branch[:, 2] = parameters.maxwell_stiffness, time
    if local is not None:
        for axis in range(3):
            element: Kelvin | Maxwell
            if branch[0, axis] > 0.0:
                # A dashpot beside the branch (Dz1, zero in the source) stays outside the series.
                element = Maxwell(
                    stiffness=stiffness[axis],
                    branch_stiffness=branch[0, axis],
                    branch_damping=branch[0, axis] * branch[1, axis],
                )
            else:
                element = Kelvin(stiffness=stiffness[axis], damping=damping[axis])
                damping[axis] = 0.0
            joined = in_series(float(local[axis]), element)
            stiffness[axis] = float(joined.stiffness)
            if float(joined.branch_damping) > 0.0:
                branch[:, axis] = float(joined.branch_stiffness), float(joined.relaxation_time)
    return ElementLaw(
        stiffness=stiffness,
        damping=damping,
        branch_stiffness=branch[0],
        branch_time=branch[1],
        rotational_stiffness=parameters.rotational_stiffness,
    )
