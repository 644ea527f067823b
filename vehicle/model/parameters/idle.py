"""Notices on overrides without effect: the law of the parameter is switched off, or the car is in another state."""

import dataclasses
from collections.abc import Iterable

from vehicle.model.parameters.compose import APPLY_FORCES
from vehicle.model.parameters.force_elements import FRICTION_LAWS, NUMBERS, Bushing, Hydromount, Tyre
from vehicle.model.parameters.paths import meant, value_at
from vehicle.model.parameters.semi_active_damper import FMU, SemiActiveDamper
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.model.parameters.wheel_forces import WHEEL_FORCES
from vehicle.names import AXES, SIDE_SIGN

ROLLING = (
    "slip_stiffness",
    "cornering_stiffness",
    "carcass_longitudinal",
    "carcass_lateral",
    "trail",
    "rolling_radius",
)
"""Parameters of a tyre that act only if it rolls."""


def idle_parameters(vehicle: Vehicle, overrides: Iterable[str], engine: str = "") -> tuple[str, ...]:
    """Return a notice for each override of a parameter without effect.

    Args:
        vehicle: the car.
        overrides: texts "path=value" of the car.
        engine: engine of the run; empty outside a run, where it is not known whether the car will drive on a road.
    """
    rigid = not vehicle.body.flexible
    off = {f"body.{name}": (rigid, "body.flexible = true") for name in ("frequency_scale", "model_mass")}
    for damper in vehicle.composition.dampers:
        law, path = damper.law, damper.path
        for name in dict.fromkeys(name for law_name in FRICTION_LAWS for name in NUMBERS.get(law_name, ())):
            users = [law_name for law_name in FRICTION_LAWS if name in NUMBERS.get(law_name, ())]
            off[f"{path}.{name}"] = (law.friction_law not in users, f"{path}.friction_law = {' or '.join(users)}")
        presliding = law.friction_law == "presliding"
        for name in ("presliding_force", "presliding_slope"):
            off[f"{path}.{name}"] = (not presliding, f"{path}.friction_law = presliding")
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
            for axis, force in zip(AXES, connection.law.friction_force, strict=True):
                idle = not frictionless and not force
                off[f"{connection.path}.friction_stroke.{axis}"] = (
                    idle,
                    f"{connection.path}.friction_force.{axis} above zero",
                )
        if isinstance(connection.law, Hydromount):
            off[f"{connection.path}.maxwell_"] = (connection.law.maxwell is None, "both Maxwell values above zero")
    off |= _by_part(vehicle)
    if engine:
        off |= _by_state(vehicle)
        off["solver.timestep"] = (
            engine == "reduced",
            "--engine mujoco, because the reduced engine chooses its own step",
        )
    paths = {text: meant(vehicle.table, text.partition("=")[0].strip()) for text in overrides}
    return tuple(
        f"{override.strip()}: has no effect; it acts only with {needed}"
        for override, whole_paths in paths.items()
        for path, (idle, needed) in off.items()
        if idle
        and any(whole.startswith(path) and not whole.endswith((".viscous_law", ".enabled")) for whole in whole_paths)
    )


def _by_part(vehicle: Vehicle) -> dict[str, tuple[bool, str]]:
    """Return numbers of rods and of parts with an inertia, and forces that are left out: path to (idle, condition)."""
    off = {}
    for part in vehicle.composition.parts:
        # The inertia of a rod is computed from its radius, so the vehicle file is read.
        has_inertia = value_at(vehicle.table, f"{part.path}.inertia") is not None
        off[f"{part.path}.radius"] = (has_inertia, f"a part without {part.path}.inertia")
        off[f"{part.path}.products"] = (not has_inertia, f"{part.path}.inertia")
    for name, table in vehicle.table.get("force", {}).items():
        if table.get("enabled", True) is False:
            off[f"force.{name}."] = (True, f"force.{name}.enabled = true")
    if vehicle.table.get(APPLY_FORCES, True) is False:
        off |= dict.fromkeys(("force.", "crank."), (True, "apply_forces = true and without --no-forces"))
    return off


def _by_state(vehicle: Vehicle) -> dict[str, tuple[bool, str]]:
    """Return the parameters of rolling and of standing tyres: path to (idle, condition)."""
    rolling, road = vehicle.driving.rolling, "rolling tyres: --road with --speed, or driving.speed"
    off = {"driving.hold_": (not rolling, road)}
    for connection in vehicle.composition.connections:
        if isinstance(connection.law, Tyre):
            for key in ROLLING:
                off[f"{connection.path}.{key}"] = (not rolling, road)
            level = [f"{key}.{axis}" for key in ("stiffness", "damping") for axis in AXES[:2]]
            for key in (*level, "rotational_stiffness"):
                off[f"{connection.path}.{key}"] = (rolling, "standing tyres: --tyre standing")
    for axle in {wheel.axle for wheel in vehicle.composition.wheels}:
        for table in WHEEL_FORCES:
            for side in ("", *(f"{side}." for side in SIDE_SIGN)):
                off[f"{axle}.{side}{table}."] = (not rolling, road)
    return off
