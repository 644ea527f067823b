"""Parameters that were changed and do nothing, because the law they belong to is off."""

from __future__ import annotations

from collections.abc import Iterable

from vehicle.parameters.vehicle import Vehicle


def idle_parameters(vehicle: Vehicle, overrides: Iterable[str]) -> tuple[str, ...]:
    """A sentence for each override of a parameter without effect.

    Args:
        vehicle: the car.
        overrides: texts "path=value" that it was made with.
    """
    damper, body, branch = vehicle.damper, vehicle.body, vehicle.bushings.hydromount
    off: list[tuple[bool, str, str]] = [
        (damper.friction_law != "stribeck", "damper.stribeck_", "damper.friction_law = stribeck"),
        (damper.viscous_law != "degressive", "damper.degressive_", "damper.viscous_law = degressive"),
        # The frame of a flexible body has this Ixx in both variants.
        (
            body.inertia_variant != "improved" and not body.flexible,
            "body.ixx_improved",
            "body.inertia_variant = improved",
        ),
        (body.inertia_variant != "published", "body.ixx_published", "body.inertia_variant = published"),
        (not body.flexible, "body.frequency_scale", "body.flexible = true"),
        (
            branch.maxwell_stiffness * branch.maxwell_damping == 0.0,
            "bushings.hydromount.maxwell_",
            "both of its values above zero",
        ),
    ]
    return tuple(
        f"{override.strip()}: without effect; it belongs to {needed}"
        for override in overrides
        for idle, path, needed in off
        if idle and override.strip().startswith(path)
    )
