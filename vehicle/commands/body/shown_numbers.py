"""Output of `body show --json`: a body model in plain numbers and texts, SI units."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from vehicle.model.flexbody.superelement import Superelement
    from vehicle.model.parameters.vehicle import Vehicle


def numbers(model: Superelement, vehicle: Vehicle, levels: Mapping[str, Any], bare: list[str] | None) -> dict[str, Any]:
    """Return the content of the printed tables, unrounded.

    Args:
        levels: normalised mode shapes at attachments and output points [-]: name to (modes, 3).
        bare: attachments without residual flexibility; None if the model does not fit this car.

    Returns:
        Inertia as the tensor about the CoG, its elements off the diagonal minus the products; participation |shape|
        over its mean in the body, (modes,) for each attachment and place; residual flexibility [m/N], (3, 3).
    """
    import numpy as np

    from vehicle.model.flexbody.body_loads import body_loads
    from vehicle.model.flexbody.mass_difference import mass_difference
    from vehicle.model.flexbody.rigid_body import rigid_body

    def mass_of(body: Any) -> dict[str, Any]:
        tensor = np.asarray(body.inertia).tolist()
        return {"mass_kg": float(body.mass), "cog_m": np.asarray(body.cog).tolist(), "inertia_kgm2": tensor}

    modes = zip(model.frequencies, model.damping_ratio, model.mode_names, strict=True)
    return {
        "name": model.name,
        "provenance": model.provenance,
        "nodes": len(model.nodes),
        **mass_of(model),
        "vehicle": mass_of(rigid_body(vehicle.body)),
        "notices": list(mass_difference(model, vehicle.body, body_loads(vehicle))),
        "modes": [
            {"frequency_hz": float(frequency), "damping_ratio": float(ratio), "name": name}
            for frequency, ratio, name in modes
        ],
        "on_this_car": bare is not None,
        "participation": {name: np.linalg.norm(shape, axis=1).tolist() for name, shape in levels.items()},
        "residual_m_per_n": {name: np.asarray(flexibility).tolist() for name, flexibility in model.residual.items()},
        "without_residual": bare,
    }
