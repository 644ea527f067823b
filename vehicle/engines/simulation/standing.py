"""Whether a car can stand as its parameters say: on all its supports, on springs of sensible sag, on a body."""

from __future__ import annotations

import numpy as np

from vehicle.engines.simulation.rows import Rows
from vehicle.engines.simulation.static_trim import StaticTrim, ground_contacts
from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.flexbody.superelement_checks import LOWEST_FIRST_MODE
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import AXES

LARGEST_SAG = 0.5
"""Static deflection [m] that no spring of a road vehicle has: a soft car spring sags by 0.2 m, an engine by 5 mm."""


def element_parameter(vehicle: Vehicle, name: str, kind: str, axis: str) -> str:
    """Parameter path of an element of the model: of "bushing/tyre_fr" front.bushings.tyre and what follows.

    Args:
        vehicle: the car.
        name: of the element.
        kind: its parameter.
        axis: its component, or nothing.
    """
    group, _, place = name.partition("/")
    if group != "bushing":
        return f"the attachment stiffness of {place} in body.superelement"
    path = next(one.path for one in vehicle.composition.connections if one.name == place)
    return ".".join(word for word in (path, kind, axis) if word)


def require_body_modes(vehicle: Vehicle, body: Superelement) -> None:
    """Refuse a body whose first elastic mode is among the rigid-body modes of the car.

    Raises:
        ConfigurationError: naming the mode and the parameters.
    """
    scale, first = vehicle.body.frequency_scale, float(np.min(body.frequencies, initial=np.inf))
    if not vehicle.body.flexible or first * scale >= LOWEST_FIRST_MODE:
        return
    allowed = f"allowed are {LOWEST_FIRST_MODE:g} Hz and more (a convertible has 12 Hz)"
    model = f"body.superelement = {vehicle.body.superelement}"
    if scale == 1.0:
        raise ConfigurationError(
            f"{model}: its first mode is at {first:.3g} Hz, {allowed}; check the units of its stiffness and mass"
        )
    raise ConfigurationError(
        f"body.frequency_scale: found {scale:g} -, which puts the first mode of the body ({first:g} Hz in {model}) at "
        f"{first * scale:.3g} Hz, {allowed}"
    )


def require_standing(vehicle: Vehicle, rows: Rows, static: StaticTrim) -> None:
    """Refuse a car that would tip off one of its supports, or sag beyond any spring.

    Args:
        vehicle: parameters.
        rows: of its elements.
        static: its static loads.

    Raises:
        ConfigurationError: naming the parameters.
    """
    if vehicle.gravity == 0.0:
        return
    loads = {f"tyre {wheel}": load for wheel, load in static.tyre_load.items()}
    loads |= {name.replace("_", " "): load for name, load in static.support_load.items()}
    for name, load in loads.items():
        if load <= 0.0:
            raise ConfigurationError(
                f"body.cog: found {list(vehicle.body.cog)} m, with which {name} would carry {load:.0f} N and the car "
                "would tip off it; it must lie between the points where the car stands on the ground (check body.mass "
                "and the masses of the parts too)"
            )
    preload, springs, bushings = static.preload, rows.layout.springs, rows.layout.bushings
    ground = ground_contacts(rows)
    looked = bushings.stiffness > 0.0
    # On the ground the car is set down without horizontal force.
    looked[ground, :2] = False
    with np.errstate(divide="ignore", invalid="ignore"):
        sag = np.where(looked, np.abs(preload[bushings.rows]) / bushings.stiffness, 0.0)
        spring_sag = np.abs(preload[springs.rows]) / springs.stiffness
    if not max(np.max(sag, initial=0.0), np.max(spring_sag, initial=0.0)) > LARGEST_SAG:
        return
    placed = vehicle.composition.springs
    sags: dict[str, float] = {}
    for spring, own in zip(placed, spring_sag.tolist(), strict=True):
        sags[f"{spring.path}.stiffness"] = max(sags.get(f"{spring.path}.stiffness", 0.0), own)
    for index, axis in np.argwhere(looked).tolist():
        sags[element_parameter(vehicle, rows.names[index], "stiffness", AXES[axis])] = float(sag[index, axis])
    worst = max(sags, key=lambda name: sags[name])
    raise ConfigurationError(
        f"{worst}: too soft for the weight it carries (body.mass {vehicle.body.mass:g} kg, gravity "
        f"{vehicle.gravity:g} m/s2): it would sag by {sags[worst]:.3g} m, allowed are {LARGEST_SAG:g} m (a soft "
        "car spring sags by 0.2 m)"
    )
