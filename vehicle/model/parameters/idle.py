"""Notices on overrides without effect, because the law of the parameter is switched off."""

import dataclasses
from collections.abc import Iterable

from vehicle.model.parameters.force_elements import Bushing, Hydromount
from vehicle.model.parameters.paths import meant
from vehicle.model.parameters.semi_active_damper import FMU, SemiActiveDamper
from vehicle.model.parameters.vehicle import Vehicle


def idle_parameters(vehicle: Vehicle, overrides: Iterable[str]) -> tuple[str, ...]:
    """Return a notice for each override of a parameter without effect.

    Args:
        vehicle: the car.
        overrides: texts "path=value" of the car.
    """
    rigid = not vehicle.body.flexible
    off = {f"body.{name}": (rigid, "body.flexible = true") for name in ("frequency_scale", "model_mass")}
    for damper in vehicle.composition.dampers:
        law, path = damper.law, damper.path
        off[f"{path}.stribeck_"] = (law.friction_law in ("coulomb", "presliding"), f"{path}.friction_law = stribeck")
        presliding = law.friction_law == "presliding"
        off[f"{path}.presliding_"] = (not presliding, f"{path}.friction_law = presliding")
        off[f"{path}.smoothing"] = (presliding, f"{path}.friction_law = coulomb or stribeck")
        passive = law.controlled is None
        off[f"{path}.viscous"] = (not passive, f"{path}.control.law = passive")
        if law.function is not None:
            off[f"{path}.viscous"] = (True, f"{path}.viscous_law without {path}.function")
        elif passive and law.viscous_law == "table":
            off[f"{path}.viscous"] = (True, f"{path}.viscous_law = linear or degressive")
        for name in (entry.name for entry in dataclasses.fields(SemiActiveDamper) if entry.name != "law"):
            off[f"{path}.control.{name}"] = (passive, f"{path}.control.law = skyhook or another law")
        with_fmu = law.controlled is not None and law.controlled.law == FMU
        off[f"{path}.control.fmu"] = (not with_fmu, f"{path}.control.law = fmu")
        off[f"{path}.degressive_"] = (law.viscous_law != "degressive", f"{path}.viscous_law = degressive")
    for connection in vehicle.composition.connections:
        if isinstance(connection.law, Bushing | Hydromount):
            frictionless = not any(connection.law.friction_force)
            off[f"{connection.path}.friction_stroke"] = (frictionless, f"{connection.path}.friction_force above zero")
        if isinstance(connection.law, Hydromount):
            off[f"{connection.path}.maxwell_"] = (connection.law.maxwell is None, "both Maxwell values above zero")
    paths = {text: meant(vehicle.table, text.partition("=")[0].strip()) for text in overrides}
    return tuple(
        f"{override.strip()}: has no effect; it acts only with {needed}"
        for override, whole_paths in paths.items()
        for path, (idle, needed) in off.items()
        if idle and any(whole.startswith(path) and not whole.endswith(".viscous_law") for whole in whole_paths)
    )
