"""Cars and roads for which `Car.estimate` is not valid: each is rejected by name, with the remedy."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.digits import beside_limit
from vehicle.engines.linear.displacement_laws import DisplacementLaw
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.errors import ConfigurationError
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.signals.excitation.road_drive import RoadDrive

if TYPE_CHECKING:
    from vehicle.model.parameters.composition import PlacedDamper

SLIP_VELOCITY = 6e-3
"""Velocity above which a damper slips [m/s], for `LEAST_SLIP`."""

LEAST_SLIP = 0.65
"""Minimum share of the time in which a damper with friction slips, for the linear car: erfc(v_s/(s sqrt 2))."""

MOST_OUTSIDE = 0.01
"""Maximum share of the time in which a law over displacement leaves its segment at rest: a tyre its load, a stop its
clearance."""

REMEDY = "run the car instead"


def require_class(source: Any) -> RoadDrive:
    """Return an input that is a drive on a class of ISO 8608; reject any other.

    Raises:
        ConfigurationError: an obstacle, a level road, a measured profile, or a signal.
    """
    if isinstance(source, RoadDrive) and source.road in CLASSES:
        return source
    raise ConfigurationError(
        f"estimate: {getattr(source, 'road', getattr(source, 'name', source))} is no class of ISO 8608, so nothing is known of roads like it; choose a class, "
        f"{', '.join(CLASSES)}, or {REMEDY}"
    )


def require_laws(dampers: Sequence[PlacedDamper], model: PoleModel) -> None:
    """Check that the force of each damper follows from its velocity, and that nothing but the road shakes the car.

    Raises:
        ConfigurationError: the first reason against it.
    """
    for damper in dampers:
        law = damper.law
        reasons = {
            f"is controlled ({law.control.law if law.control else ''})": law.controlled is not None,
            f"has the law {law.function!r} of the user's own": law.function is not None,
            "has presliding friction": law.presliding_stiffness is not None and law.friction_law == "presliding",
            "has friction that grows with its side force": law.side_force_coefficient > 0.0,
        }
        for words, applies in reasons.items():
            if applies:
                raise ConfigurationError(
                    f"estimate: {damper.path} {words}, so its force does not follow from its velocity alone; {REMEDY}"
                )
    for each in model.laws:
        if each.friction:
            raise ConfigurationError(
                f"estimate: {each.name} has rubber friction, whose force depends on its history; {REMEDY}"
            )
    if model.applied.shape[1] or model.matrices.run_out:
        raise ConfigurationError(
            "estimate: forces of the vehicle file shake the car too; leave them out with "
            f"--set apply_forces=false, or {REMEDY}"
        )


def slip_share(speed: float, limit: float = SLIP_VELOCITY) -> float:
    """Return the share of the time in which a Gaussian velocity exceeds a limit, erfc(v_s/(s sqrt 2)).

    Args:
        speed: standard deviation s [m/s].
        limit: v_s [m/s].
    """
    return float(scipy.special.erfc(limit / (speed * np.sqrt(2.0))))


def outside_share(law: DisplacementLaw, displacement: float) -> float:
    """Return the share of the time in which a Gaussian displacement leaves the segment of a law at rest.

    Args:
        law: nonlinear law over displacement.
        displacement: standard deviation [m].
    """
    return float(scipy.special.ndtr(law.low / displacement) + scipy.special.ndtr(-law.high / displacement))


def require_motion(
    dampers: Sequence[PlacedDamper], speeds: Vector, laws: Sequence[DisplacementLaw], displacements: Vector
) -> None:
    """Check that dampers with friction mostly slip, and that laws over displacement stay in their segment at rest.

    Args:
        dampers: the dampers.
        speeds: their RMS velocities [m/s]; (d,).
        laws: laws over displacement.
        displacements: their RMS displacements [m]; (l,).

    Raises:
        ConfigurationError: the first that does not.
    """
    for damper, speed in zip(dampers, speeds.tolist(), strict=True):
        share = slip_share(speed)
        if damper.law.static_friction > 0.0 and share < LEAST_SLIP:
            found, limit = beside_limit(share, LEAST_SLIP)
            raise ConfigurationError(
                f"estimate: {damper.path} slips for only {found} of the time on this road, and the estimate needs "
                f"{limit}; take a rougher road or more speed, or {REMEDY}"
            )
    for law, displacement in zip(laws, displacements.tolist(), strict=True):
        share = outside_share(law, displacement)
        if share > MOST_OUTSIDE:
            found, limit = beside_limit(100.0 * share, 100.0 * MOST_OUTSIDE)
            what = "leaves the road" if law.one_sided else "leaves its straight segment at rest"
            raise ConfigurationError(
                f"estimate: {law.name} {what} for {found} % of the time, at most {limit} % are covered; {REMEDY}"
            )
