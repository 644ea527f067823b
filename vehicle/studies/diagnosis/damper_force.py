"""Dampers of drawn cars: tables of force over velocity that share their smallest slope, so that all use one pole model.

The poles of a car contain the smallest slope D of each damper law (`vehicle.engines.reduced.pole_model`). Every drawn
damper is a table through the nominal force F0 at the velocities v, scaled and bent,

    F(v) = f F0(v) (|v|/v0)^p h(|v|)/h(v0) a^(+-1/2),    a^(+1/2) in rebound, a^(-1/2) in compression,
    h(v) = 1 below the knee vk,    (vk + (v - vk)/k)/v above: there the slope falls to 1/k, as where a valve opens,

which continues beyond `FASTEST` with the same small slope D. The factor f is the ratio of forces at v0, averaged over
both directions on a logarithmic scale.
"""

from dataclasses import replace

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.model.laws.damper import damper_curve
from vehicle.model.parameters.composition import Composition
from vehicle.model.parameters.force_elements import Damper

REFERENCE_VELOCITY = 0.13
"""v0 [m/s]: the usual lowest test velocity of a damper machine that friction does not rule (0.13, 0.26, 0.52 m/s)."""

FASTEST = 3.0
"""End of the tables [m/s]: no damper moves faster on the roads of classes A to E."""

OUTER = 0.02
"""Slope beyond `FASTEST` over the nominal F0(v0)/v0 [-]: smaller than every slope of a drawn damper."""

FALL = 0.01
"""Velocity of the drawn Stribeck friction [m/s], usual for seals."""

POINTS = 9
"""Points of a table on each side of rest, from 0.02 m/s on in equal ratios of 1.9; each costs time in every step."""


def require_passive(composition: Composition) -> None:
    """Reject a car with a damper whose force does not follow from its velocity and its friction, or at no wheel.

    Raises:
        ConfigurationError: no damper, a controlled damper, a law of the user's own, or a damper at no wheel.
    """
    if not composition.dampers:
        raise ConfigurationError("diagnose: the car has no damper; give a car with dampers")
    wheels = {f"damper_{wheel.name}" for wheel in composition.wheels}
    for damper in composition.dampers:
        law = damper.law
        if law.controlled is not None or law.function is not None or damper.name not in wheels:
            raise ConfigurationError(
                f"diagnose: {damper.path} is controlled, has a law of the user's own or acts at no single wheel; give "
                "a car with a passive damper at each wheel"
            )


def drawn_damper(
    nominal: Damper,
    factor: float,
    bend: float,
    rebound: float,
    friction: float,
    knee: tuple[float, float] = (REFERENCE_VELOCITY, 1.0),
) -> Damper:
    """Return a damper with another force over velocity.

    Args:
        nominal: damper of the car that is not worn.
        factor: f, force at v0 over nominal [-].
        bend: exponent p [-]: above 0 progressive, below 0 degressive.
        rebound: a, ratio of rebound and compression [-].
        friction: friction over nominal [-].
        knee: vk [m/s], and k, ratio of the slopes below and above it [-]: above 1 degressive, below 1 progressive.
    """
    curve = damper_curve(nominal)
    preload = float(curve.force(0.0))
    one_side = np.geomspace(0.02, FASTEST, POINTS)
    velocity = np.concatenate([-one_side[::-1], [0.0], one_side])
    force = (curve.force(velocity) - preload) * factor
    force = force * np.where(velocity > 0.0, rebound**0.5, rebound**-0.5)
    force = force * (np.maximum(np.abs(velocity), one_side[0]) / REFERENCE_VELOCITY) ** bend
    force = force * _kneed(np.abs(velocity), *knee) / _kneed(np.array(REFERENCE_VELOCITY), *knee)
    slope = outer_slope(nominal)
    # A bent table may not fall, nor be flatter than the slope of the poles.
    rises = np.maximum(np.diff(force), slope * np.diff(velocity))
    half = velocity.size // 2
    force = np.concatenate([-np.cumsum(rises[:half][::-1])[::-1], [0.0], np.cumsum(rises[half:])])
    velocity = np.concatenate([[-2.0 * FASTEST], velocity, [2.0 * FASTEST]])
    force = np.concatenate([[force[0] - slope * FASTEST], force, [force[-1] + slope * FASTEST]]) + preload
    stribeck = None if nominal.stribeck_friction is None else nominal.stribeck_friction * friction
    return replace(
        nominal,
        viscous_law="table",
        velocity=tuple(velocity.tolist()),
        force=tuple(force.tolist()),
        coulomb_friction=nominal.coulomb_friction * friction,
        stribeck_friction=stribeck,
        tested=None,
    )


def _kneed(speed: Vector, at: float, ratio: float) -> Vector:
    """Return h, the share of the force that a knee leaves, at |v| [m/s]."""
    beyond = np.maximum(speed, at)
    return np.asarray((at + (beyond - at) / ratio) / beyond)


def with_static_friction(damper: Damper, ratio: float) -> Damper:
    """Return a damper with Stribeck friction, whose limit at rest is larger by a ratio and falls within `FALL`."""
    return replace(
        damper,
        friction_law="stribeck",
        stribeck_friction=ratio * damper.coulomb_friction,
        stribeck_velocity=FALL,
        stribeck_exponent=1.0,
    )


def outer_slope(nominal: Damper) -> float:
    """Return D, the smallest slope of all tables of a damper [N s/m].

    Raises:
        ConfigurationError: the damper has no force.
    """
    curve = damper_curve(nominal)
    ends: Vector = curve.force(np.array([-REFERENCE_VELOCITY, REFERENCE_VELOCITY]))
    slope = float(ends[1] - ends[0]) / (2.0 * REFERENCE_VELOCITY)
    if slope <= 0.0:
        raise ConfigurationError(
            "diagnose: a damper of the car has no force over velocity; give the force of the damper that is not worn"
        )
    return OUTER * slope
