"""Checks of the static equilibrium of a car: loads of all supports, spring sag, first mode of the body."""

import numpy as np

from vehicle.engines.simulation.rows import Rows
from vehicle.engines.simulation.static_trim import StaticTrim, ground_contacts
from vehicle.errors import ConfigurationError
from vehicle.model.assembly.element_numbers import FLUID
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.flexbody.superelement_checks import LOWEST_FIRST_MODE
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import AXES

LARGEST_SAG = 0.5
"""Maximum static deflection [m] of a spring: a soft car spring sags by 0.2 m, an engine by 5 mm."""


def element_parameter(vehicle: Vehicle, name: str, parameter: str, axis: str) -> str:
    """Return the parameter path of an element: for "bushing/tyre_fr" front.bushings.tyre, then parameter and axis.

    Args:
        vehicle: the car.
        name: name of the element in the model.
        parameter: name of the parameter.
        axis: component of the parameter, or "".
    """
    group, _, element = name.partition("/")
    if f"{group}/" == FLUID and parameter == "stiffness":
        parameter, axis = "chamber_stiffness", ""
    elif group != "bushing":
        return f"the attachment stiffness of {element} in body.superelement"
    path = next(connection.path for connection in vehicle.composition.connections if connection.name == element)
    return ".".join(word for word in (path, parameter, axis) if word)


def require_body_modes(vehicle: Vehicle, body: Superelement) -> None:
    """Reject a body with its first elastic mode among the rigid-body modes of the car.

    Raises:
        ConfigurationError: the message contains the mode and the parameters.
    """
    scale, first = vehicle.body.frequency_scale, float(np.min(body.frequencies, initial=np.inf))
    if not vehicle.body.flexible or first * scale >= LOWEST_FIRST_MODE:
        return
    allowed = f"but it must be at least {LOWEST_FIRST_MODE:g} Hz (a convertible has 12 Hz)"
    model = f"body.superelement = {vehicle.body.superelement}"
    if scale == 1.0:
        raise ConfigurationError(
            f"{model}: its first mode is at {first:.3g} Hz, {allowed}; check the units of its stiffness and mass"
        )
    raise ConfigurationError(
        f"body.frequency_scale: found {scale:g}, which puts the first mode of the body ({first:g} Hz in {model}) at "
        f"{first * scale:.3g} Hz, {allowed}"
    )


def require_standing(vehicle: Vehicle, rows: Rows, static: StaticTrim) -> None:
    """Reject a car with a support without load, or with a static deflection above `LARGEST_SAG`.

    Raises:
        ConfigurationError: the message contains the parameters.
    """
    if vehicle.gravity == 0.0:
        return
    loads = {f"tyre {wheel}": load for wheel, load in static.tyre_load.items()}
    # An element between the car and the world that is no contact with the ground may also hold the car down.
    contacts = {link.name for link in vehicle.composition.connections if link.ground}
    loads |= {name.replace("_", " "): load for name, load in static.support_load.items() if name in contacts}
    for name, load in loads.items():
        if load <= 0.0:
            raise ConfigurationError(
                f"body.cog: found {list(vehicle.body.cog)} m. The car would tip over, because {name} would carry "
                f"{load:.0f} N; the centre of gravity must lie between the points where the car stands on the ground "
                "(check body.mass and the masses of the parts too)"
            )
    preload, springs, bushings = static.preload, rows.layout.springs, rows.layout.bushings
    ground = ground_contacts(rows)
    looked = bushings.stiffness > 0.0
    # Ground contacts carry no static horizontal force.
    looked[ground, :2] = False
    with np.errstate(divide="ignore", invalid="ignore"):
        # |p|/K; a row without stiffness divides by zero and does not count.
        sag = np.where(looked, np.abs(preload[bushings.rows]) / bushings.stiffness, 0.0)
        spring_sag = np.abs(preload[springs.rows]) / springs.stiffness
    if not max(np.max(sag, initial=0.0), np.max(spring_sag, initial=0.0)) > LARGEST_SAG:
        return
    placed = vehicle.composition.springs
    sags: dict[str, float] = {}
    for spring, deflection in zip(placed, spring_sag.tolist(), strict=True):
        sags[f"{spring.path}.stiffness"] = max(sags.get(f"{spring.path}.stiffness", 0.0), deflection)
    for index, axis in np.argwhere(looked).tolist():
        sags[element_parameter(vehicle, rows.names[index], "stiffness", AXES[axis])] = float(sag[index, axis])
    worst = max(sags, key=lambda name: sags[name])
    raise ConfigurationError(
        f"{worst}: too soft for the weight it carries (body.mass {vehicle.body.mass:g} kg, gravity "
        f"{vehicle.gravity:g} m/s2): it would sag by {sags[worst]:.3g} m, but at most {LARGEST_SAG:g} m is allowed "
        "(a soft car spring sags by 0.2 m)"
    )
