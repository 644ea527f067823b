"""Cars and roads for which `Car.estimate` is not valid: each is rejected by name, with the remedy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.digits import beside_limit
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.displacement_laws import DisplacementLaw
from vehicle.errors import ConfigurationError
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.signals.excitation.road_drive import RoadDrive

if TYPE_CHECKING:
    from vehicle.model.parameters.composition import PlacedDamper

LEAST_LOOSE = 0.8
"""Minimum share of the time in which the force in a damper, if all dampers were locked, exceeds its friction. Chosen
with 384 cases of random cars on classes A to D, of which 55 were off by more than 2 %: it rejects 54 of them and 9 % of
the others. Of 384 other cases it rejects all 61 that are off (docs/theory/estimate.md)."""

LOCKED = 1e8
"""Damping constant of a locked damper [N s/m]: far stiffer than the springs of a car up to 60 Hz."""

MOST_LIFTED, MOST_ENGAGED = 0.03, 0.01
"""Maximum share of the time in which a tyre leaves the road, and in which another law over displacement leaves its
segment at rest (a stop: its clearance). Nine cars with lifting tyres below the first limit are -0.5 to +1.0 % off in
weighted comfort, two with stops below the second one -0.4 % (docs/theory/estimate.md)."""

REMEDY = "run the car instead"


def require_class(source: Any) -> RoadDrive:
    """Return an input that is a drive on a class of ISO 8608; reject any other.

    Raises:
        ConfigurationError: an obstacle, a level road, a measured profile, or a signal.
    """
    if isinstance(source, RoadDrive) and source.road in CLASSES:
        return source
    name = getattr(source, "road", getattr(source, "name", source))
    raise ConfigurationError(
        f"estimate: {name} is no class of ISO 8608, whose spectrum the estimate needs; choose a class, "
        f"{', '.join(CLASSES)}, or {REMEDY}"
    )


def require_laws(dampers: Sequence[PlacedDamper], matrices: CarMatrices) -> None:
    """Check that the force of each damper follows from its velocity, and that the road is the only excitation.

    Raises:
        ConfigurationError: the first reason against it.
    """
    for damper in dampers:
        law = damper.law
        reasons = {
            f"is controlled ({law.control.law if law.control else ''})": law.controlled is not None,
            f"has the law {law.function!r} of the user's own": law.function is not None,
            f"has the friction {law.friction_function!r} of the user's own": law.friction_function is not None,
            "has presliding friction": law.presliding_stiffness is not None and law.friction_law == "presliding",
            "has friction that grows with its side force": law.side_force_coefficient > 0.0,
        }
        for reason, applies in reasons.items():
            if applies:
                raise ConfigurationError(
                    f"estimate: {damper.path} {reason}, so its force does not follow from its velocity alone; {REMEDY}"
                )
    for each in matrices.laws:
        if each.friction:
            raise ConfigurationError(
                f"estimate: {each.name} has rubber friction, whose force depends on its history; {REMEDY}"
            )
    if matrices.forced:
        raise ConfigurationError(
            "estimate: forces of the vehicle file shake the car too; leave them out with "
            f"--set apply_forces=false, or {REMEDY}"
        )


def loose_share(friction: float, locked_force: float) -> float:
    """Return the share of the time in which a Gaussian force exceeds the friction limit, erfc(L/(s sqrt 2)).

    Args:
        friction: friction limit L at rest [N].
        locked_force: standard deviation s of the force in the damper if all dampers are locked [N].
    """
    return float(scipy.special.erfc(friction / (locked_force * np.sqrt(2.0))))


def outside_share(law: DisplacementLaw, displacement: float) -> float:
    """Return the share of the time in which a Gaussian displacement leaves the segment of a law at rest.

    Args:
        law: nonlinear law over displacement.
        displacement: standard deviation [m].
    """
    return float(scipy.special.ndtr(law.low / displacement) + scipy.special.ndtr(-law.high / displacement))


def require_motion(
    dampers: Sequence[PlacedDamper], locked_forces: Vector, laws: Sequence[DisplacementLaw], displacements: Vector
) -> None:
    """Check that friction rarely holds a damper, and that laws over displacement stay in their segment at rest.

    Args:
        dampers: the dampers.
        locked_forces: RMS forces in the dampers if all are locked [N]; (d,).
        laws: laws over displacement.
        displacements: their RMS displacements [m]; (l,).

    Raises:
        ConfigurationError: the first that does not.
    """
    for damper, force in zip(dampers, locked_forces.tolist(), strict=True):
        share = loose_share(damper.law.static_friction, force)
        if share < LEAST_LOOSE:
            percent, limit = beside_limit(100.0 * share, 100.0 * LEAST_LOOSE)
            raise ConfigurationError(
                f"estimate: {damper.path} would stick too often on this road (the force in it exceeds its friction of "
                f"{damper.law.static_friction:g} N for {percent} % of the time, {limit} % are needed); choose a "
                f"rougher road or a higher speed, or {REMEDY}"
            )
    for law, displacement in zip(laws, displacements.tolist(), strict=True):
        share, maximum = outside_share(law, displacement), MOST_LIFTED if law.one_sided else MOST_ENGAGED
        if share > maximum:
            percent, limit = beside_limit(100.0 * share, 100.0 * maximum)
            action = "leaves the road" if law.one_sided else "leaves its straight segment at rest"
            raise ConfigurationError(
                f"estimate: {law.name} {action} for {percent} % of the time, at most {limit} % are covered; {REMEDY}"
            )


def require_contact(static_load: Mapping[str, float], tyre_load: Mapping[str, float]) -> None:
    """Check that the tyres rarely leave the road; a linear tyre would pull, of which a run warns.

    Args:
        static_load: static load of each tyre [N].
        tyre_load: RMS of its dynamic load [N].

    Raises:
        ConfigurationError: the first that does not.
    """
    for wheel, load in static_load.items():
        share = float(scipy.special.ndtr(-load / tyre_load[wheel])) if tyre_load[wheel] > 0.0 else 0.0
        if share > MOST_LIFTED:
            percent, limit = beside_limit(100.0 * share, 100.0 * MOST_LIFTED)
            raise ConfigurationError(
                f"estimate: tyre {wheel} leaves the road for {percent} % of the time, at most {limit} % are covered; "
                f"{REMEDY}"
            )
