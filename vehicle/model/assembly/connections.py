"""Force laws of the connections of the car: bushings in series with the local stiffness of the body."""

from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.model.assembly.coupled_attachment import STRUCTURAL_LOSS_TIME, coupled_law, is_coupled
from vehicle.model.flexbody.superelement import Superelement, attached_nodes
from vehicle.model.laws.amplitude import behind_spring, friction_elements
from vehicle.model.laws.elastomer import Kelvin, Maxwell, in_series
from vehicle.model.laws.jenkins import Jenkins
from vehicle.model.parameters.air_spring import AirSpring
from vehicle.model.parameters.body import TrimmedBody
from vehicle.model.parameters.composition import PlacedConnection
from vehicle.model.parameters.force_elements import Bushing, Hydromount, LinearBushing, Tyre
from vehicle.names import AXES


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ElementLaw:
    """f = -K r - B r' - f2 - t along each axis, with f2' = K2 r' - f2 / tau (Maxwell branch); torque = -K_rot angle.

    Attributes:
        stiffness: K [N/m], shape (3,).
        damping: B [N s/m], shape (3,).
        branch_stiffness: K2 [N/m], shape (3,); zero without a branch.
        branch_time: tau [s], shape (3,); zero without a branch.
        rotational_stiffness: K_rot [N m/rad].
        averaged: True if the stiffness is too high for the explicit step and is averaged over three steps
            (Newmark with beta 1/4); False for the fourth-order average (beta 1/12).
        local: stiffness of the attachment [N/m] in series with a table, shape (3,).
        directions: rows are the directions that replace the axes, shape (3, 3); None for the axes of the carrier.
        friction: Jenkins elements over r whose forces add to t [N], of each axis; None for an axis without friction.
    """

    stiffness: Vector
    damping: Vector
    branch_stiffness: Vector = field(default_factory=lambda: np.zeros(3))
    branch_time: Vector = field(default_factory=lambda: np.zeros(3))
    rotational_stiffness: float = 0.0
    averaged: bool = False
    local: Vector = field(default_factory=lambda: np.full(3, np.inf))
    directions: Vector | None = None
    friction: tuple[Jenkins | None, ...] = (None, None, None)


def element_law(connection: PlacedConnection, body: TrimmedBody, superelement: Superelement) -> ElementLaw | None:
    """Return the law of a connection; None for a rigid ball joint.

    Args:
        connection: connection of the composition.
        body: parameters of the trimmed body.
        superelement: model of the body, with the local flexibility of its attachment nodes.

    Raises:
        ConfigurationError: an air spring on a flexible attachment.
        DataError: the body has no node at the connection.

    Source: Bommer 2006, section 3.1.3.
    """
    if connection.rolling is not None and isinstance(connection.law, Tyre):
        return _rolling_law(connection.law, connection.rolling.speed)
    flexibility = _flexibility(connection, body, superelement)
    if flexibility is not None and isinstance(connection.law, AirSpring):
        raise ConfigurationError(
            f"{connection.path}.air_area: the body is flexible at this point, in series with which the stiffness of "
            "air is not known before its load: set body.attachment_flexibility = false"
        )
    if flexibility is not None and (connection.axes is not None or is_coupled(flexibility)):
        return ElementLaw(
            **coupled_law(connection, flexibility),
            rotational_stiffness=0.0 if connection.law is None else connection.law.rotational_stiffness,
            averaged=connection.law is None,
        )
    local = None if flexibility is None else 1.0 / np.diag(flexibility)
    if connection.law is not None:
        law = _bushing_law(connection.law, local)
        return law if connection.axes is None else replace(law, directions=np.array(connection.axes))
    return None if local is None else ElementLaw(stiffness=local, damping=STRUCTURAL_LOSS_TIME * local, averaged=True)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FluidLaw:
    """Fluid of a hydromount: f = -Kb (z - x) along the z axis of the mount, and mt x'' + ct x' = Kb (z - x).

    x is the displacement of the fluid in the track, at the rubber. If the attachment has a spring K0, the force balance
    K0 (z - y) = Z y + Kb (y - x) of its point y, Z being the rubber, eliminates y exactly: a spring K0 Kb / (K0 + Kb)
    on z - x, and the rubber in series with K0 + Kb, times K0^2 / (K0 + Kb)^2, on z + x Kb / K0.

    A decoupler takes a part of the displaced volume: x is the sum of both displacements, which have the same pressure.

    Attributes:
        law: spring on z - x as a law along three axes.
        mass, damping: mt [kg] and ct [N s/m].
        share: Kb / K0; 0 for a rigid attachment.
        decoupler: md [kg], cd [N s/m] and Km [N/m]; None without a decoupler.
        seat: points of its seat, displacement [m] and force [N]; (2, 4).
    """

    law: ElementLaw
    mass: float
    damping: float
    share: float
    decoupler: tuple[float, float, float] | None = None
    seat: Vector = field(default_factory=lambda: np.zeros((2, 0)))


def fluid_law(connection: PlacedConnection, body: TrimmedBody, superelement: Superelement) -> FluidLaw | None:
    """Return the law of the fluid of a connection; None without a track. Arguments: see `element_law`."""
    parameters = connection.law
    if not isinstance(parameters, Hydromount) or not _chamber(parameters):
        return None
    axes = np.eye(3) if connection.axes is None else np.array(connection.axes)
    flexibility = _flexibility(connection, body, superelement)
    share = 0.0 if flexibility is None else _chamber(parameters) * float(flexibility[2, 2])
    stiffness = np.array([0.0, 0.0, _chamber(parameters) / (1.0 + share)])
    law = ElementLaw(stiffness=stiffness, damping=np.zeros(3), directions=None if connection.axes is None else axes)
    fluid = FluidLaw(law=law, mass=parameters.track_mass or 0.0, damping=parameters.track_damping or 0.0, share=share)
    if not parameters.decoupler_gap:
        return fluid
    gap, load = parameters.decoupler_gap, parameters.decoupler_gap * (parameters.decoupler_seat or 0.0)
    return replace(
        fluid,
        decoupler=(
            parameters.decoupler_mass or 0.0,
            parameters.decoupler_damping or 0.0,
            parameters.decoupler_stiffness or 0.0,
        ),
        seat=np.array([[-2.0 * gap, -gap, gap, 2.0 * gap], [-load, 0.0, 0.0, load]]),
    )


def _flexibility(connection: PlacedConnection, body: TrimmedBody, superelement: Superelement) -> Vector | None:
    """Return the residual flexibility of the body at a connection [m/N], (3, 3); None for a rigid attachment."""
    if not body.attachment_flexibility or "body" not in (connection.moving, connection.carrier):
        return None
    node = attached_nodes(superelement, {connection.point: connection.at}).get(connection.at, "")
    return superelement.residual.get(node)


def _rolling_law(tyre: Tyre, speed: float) -> ElementLaw:
    """Return the law of a rolling tyre: slip C/V in series with the carcass along x and y; along z as at rest."""
    slip = np.array([tyre.slip_stiffness, tyre.cornering_stiffness, 0.0], dtype=float)
    carcass = np.array([tyre.carcass_longitudinal, tyre.carcass_lateral, 0.0], dtype=float)
    time = np.divide(slip, speed * carcass, out=np.zeros(3), where=carcass > 0.0)
    vertical = np.array([0.0, 0.0, 1.0])
    return ElementLaw(
        stiffness=vertical * tyre.stiffness, damping=vertical * tyre.damping, branch_stiffness=carcass, branch_time=time
    )


def _bushing_law(parameters: LinearBushing | Hydromount, local: Vector | None) -> ElementLaw:
    """Return the law of a bushing in exact series with the local stiffness of its attachment point."""
    stiffness = np.array(parameters.stiffness)
    damping = np.array(parameters.damping)
    branch = np.zeros((2, 3))  # K2 [N/m] and tau [s]
    friction: list[Jenkins | None] = [None, None, None]
    if isinstance(parameters, Bushing | Hydromount):
        pairs = zip(parameters.friction_force, parameters.friction_stroke, strict=True)
        friction = [friction_elements(force, stroke) if force > 0.0 else None for force, stroke in pairs]
    if isinstance(parameters, Hydromount) and parameters.maxwell is not None:
        spring, dashpot = parameters.maxwell
        branch[:, 2] = spring, dashpot / spring
    if local is not None:
        for axis, name in enumerate(AXES):
            if getattr(parameters, f"table_{name}", None) is not None:
                # The points of a table include the spring of the attachment; the damper stays parallel to both.
                continue
            # A dashpot parallel to the branch (Dz1, zero in the source) stays outside the series.
            elastomer = float(branch[0, axis]), float(branch[0, axis] * branch[1, axis])
            elastic, rubber = float(stiffness[axis]), friction[axis]
            # Branch and damper are in series with the tangent at rest, so that small vibrations are exact.
            tangent = elastic if rubber is None else elastic + float(rubber.stiffness.sum())
            element = (tangent, *(elastomer if elastomer[0] > 0.0 else (float(damping[axis]),)))
            damping[axis] = damping[axis] if elastomer[0] > 0.0 else 0.0
            # A chamber shares the spring of the attachment: see `FluidLaw`.
            chamber = _chamber(parameters) if axis == 2 else 0.0
            share = (local[axis] / (local[axis] + chamber)) ** 2
            stiffness[axis], joined, time = _in_series(float(local[axis]) + chamber, element)
            stiffness[axis], damping[axis] = share * stiffness[axis], share * damping[axis]
            if rubber is not None:
                friction[axis] = behind_spring(rubber, elastic, float(local[axis]))
                stiffness[axis] = elastic * local[axis] / (elastic + local[axis])
            if time > 0.0:
                branch[:, axis] = share * joined, time
    return ElementLaw(
        stiffness=stiffness,
        damping=damping,
        branch_stiffness=branch[0],
        branch_time=branch[1],
        rotational_stiffness=parameters.rotational_stiffness,
        local=np.full(3, np.inf) if local is None else local,
        friction=tuple(friction),
    )


def _chamber(parameters: LinearBushing | Hydromount) -> float:
    """Return the stiffness Kb of the upper chamber of a connection [N/m]; 0 without a fluid."""
    return (parameters.chamber_stiffness or 0.0) if isinstance(parameters, Hydromount) else 0.0


# Both sides of a car, and all cars of a sweep with an unchanged axis, need the same values.
@lru_cache(maxsize=4096)
def _in_series(local: float, constants: tuple[float, ...]) -> tuple[float, float, float]:
    """Return stiffness, branch stiffness and branch time of a bushing K, B or elastomer K1, K2, D2 with a spring."""
    element = (
        Kelvin(stiffness=constants[0], damping=constants[1])
        if len(constants) == 2
        else Maxwell(stiffness=constants[0], branch_stiffness=constants[1], branch_damping=constants[2])
    )
    joined = in_series(local, element)
    time = float(joined.relaxation_time) if float(joined.branch_damping) > 0.0 else 0.0
    return float(joined.stiffness), float(joined.branch_stiffness), time
