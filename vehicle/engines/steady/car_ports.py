"""Ports of a car: its nonlinear laws, and the laws that the steady engine has no port for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.linear.displacement_laws import DisplacementLaw
from vehicle.engines.reduced.car_table import damper_nodes
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.steady.law_ports import Play, Polygon, Port, Stribeck
from vehicle.errors import ConfigurationError
from vehicle.model.laws.damper import damper_curve
from vehicle.model.laws.presliding import presliding_elements
from vehicle.model.laws.stribeck import Stribeck as StribeckLaw
from vehicle.model.parameters.force_elements import Damper

MOVED = 0.98
"""Share of the falling slope of a one-sided tyre that moves from the matrices into its law, which then hardly falls.
With all of it the car floats, and its response to a constant force is infinite."""

RUBBER_MOVED = 0.7
"""Share of the stiffness at rest of rubber friction that moves from the matrices into its law. At 0.5 and 0.85 more
points do not converge, at 0 and 1 three times as many."""

DAMPER, PLAY, ELASTIC = 1.0, 0.5, 0.3
"""Scaling lambda as a share of 1/|G| of the car at the fundamental frequency; ten times as much or a tenth takes five
times the iterations."""


class CarPorts(NamedTuple):
    """Ports of a car.

    Attributes:
        ports: those whose force is not zero for all motions.
        moved: stiffness of each base row that moves from the matrices into a law [N/m]; (base rows,).
    """

    ports: list[Port]
    moved: Vector


def require_ports(model: PoleModel, dampers: Sequence[Damper]) -> None:
    """Check that the engine has a port for every law of a car.

    Raises:
        ConfigurationError: the first law without one.
    """
    for name, damper in zip(model.matrices.damper_names, dampers, strict=True):
        law = ""
        if damper.controlled is not None:
            law = f"control ({damper.controlled.law}): its force also depends on the motion of wheel and body"
        elif damper.function is not None:
            law = f"law by address ({damper.function}): it is not known whether it always rises"
        elif damper.friction_function is not None:
            law = f"friction by address ({damper.friction_function}): it is not known how it falls"
        elif damper.side_force_coefficient:
            law = "side_force_coefficient above 0: the friction limit changes with the side force"
        if law:
            raise ConfigurationError(f"{name} has a {law}; simulate this car in time, with Car.run or vehicle shaker")
    if model.applied.shape[1] or model.matrices.run_out:
        raise ConfigurationError(
            "the car has applied forces or wheels with run-out, which have other periods than the plates; remove them "
            "with apply_forces=false"
        )


def car_ports(model: PoleModel, dampers: Sequence[Damper]) -> CarPorts:
    """Return the ports of a car; its base rows are the dampers, the groups of Jenkins elements and the laws.

    Args:
        model: pole model.
        dampers: laws of the dampers.
    """
    require_ports(model, dampers)
    ports: list[Port] = []
    for index, damper in enumerate(dampers):
        port = damper_port(index, damper)
        if not isinstance(port, Polygon) or port.slopes.any():
            ports.append(port)
    for group, owner in enumerate(model.matrices.sliders.dampers.tolist(), start=len(dampers)):
        stiffness, share = presliding_elements(dampers[owner]).T
        if dampers[owner].coulomb_friction > 0.0:
            ports.append(_play(group, stiffness, share * dampers[owner].coulomb_friction / stiffness))
    first = len(dampers) + model.groups
    moved = np.zeros(first + len(model.laws))
    for base, law in enumerate(model.laws, start=first):
        if law.friction:
            stiffness, stroke = law.elements
            moved[base] = RUBBER_MOVED * stiffness.sum()
            ports.append(_play(base, stiffness, stroke, stiffness.sum() - float(moved[base])))
        else:
            moved[base] = MOVED * -law.slopes[0] if law.one_sided else 0.0
            ports.append(_elastic(base, law, float(moved[base])))
    return CarPorts(ports, moved)


def damper_port(base: int, damper: Damper) -> Port:
    """Return the port of a damper, without its Jenkins elements: friction and curve beyond D v.

    Args:
        base: row of its velocity.
        damper: its laws.
    """
    curve = damper_curve(damper)
    oil = Polygon(base=base, of_velocity=True, share=DAMPER, knots=curve.knots, slopes=curve.slopes - curve.least_slope)
    full = damper_nodes(damper)[1]
    if not full or not damper.static_friction:
        return oil
    if damper.friction_law != "stribeck":
        return _with_friction(oil, full, damper.coulomb_friction)
    law = StribeckLaw(
        friction_limit=damper.coulomb_friction,
        smoothing=damper.smoothing,
        static_limit=damper.static_friction,
        stribeck_velocity=damper.stribeck_velocity or 0.0,
        stribeck_exponent=damper.stribeck_exponent or 0.0,
    )
    static = _with_friction(oil, full, damper.static_friction)
    sliding = _with_friction(oil, full, damper.coulomb_friction)
    return Stribeck(
        base=base, of_velocity=True, share=DAMPER, curve=oil, full=full, law=law, sliding=sliding, static=static
    )


def _with_friction(oil: Polygon, full: float, limit: float) -> Polygon:
    """Return a curve in parallel with clamp(v/full) times a limit [N]."""
    knots = np.unique(np.concatenate([oil.knots, [-full, full]]))
    middles = np.concatenate([knots[:1] - 1.0, 0.5 * (knots[1:] + knots[:-1]), knots[-1:] + 1.0])
    slopes = oil.slopes[np.searchsorted(oil.knots, middles)] + (np.abs(middles) < full) * limit / full
    return Polygon(base=oil.base, of_velocity=True, share=DAMPER, knots=knots, slopes=slopes)


def _play(base: int, stiffness: Vector, stroke: Vector, kept: float = 0.0) -> Play:
    order = np.argsort(stroke)
    return Play(base=base, of_velocity=False, share=PLAY, stiffness=stiffness[order], stroke=stroke[order], kept=kept)


def _elastic(base: int, law: DisplacementLaw, moved: float) -> Polygon:
    """Return the port of a law over displacement without memory, g + moved x."""
    knots = np.unique(law.breakpoints)
    middles = np.concatenate([knots[:1] - 1.0, 0.5 * (knots[1:] + knots[:-1]), knots[-1:] + 1.0])
    below = np.signbit(law.breakpoints)
    # a max(0, sign(p) (x - p)) has the slope sign(p) a on the outer side of p.
    active = np.where(below, middles[:, None] < law.breakpoints, middles[:, None] > law.breakpoints)
    slopes = active @ np.where(below, -law.changes, law.changes) + moved
    low, high = law.slopes
    return Polygon(
        base=base,
        of_velocity=False,
        share=ELASTIC,
        knots=knots,
        slopes=slopes,
        steep=high - low if law.one_sided else 0.0,
    )
