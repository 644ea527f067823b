"""Comparison of mass and centre of gravity of a body model with the vehicle file.

Rigid motions use the mass properties of the vehicle file; the modes are free-free modes with the masses of the model.
If the masses agree, rigid motions and modes have no inertia coupling. If not, the simulation neglects the coupling
phi' M R, of the order of the relative mass difference and of the CoG distance over the radius of gyration.
"""

from collections.abc import Sequence

import numpy as np

from vehicle.errors import DataError
from vehicle.model.flexbody.body_loads import BodyLoad, loaded_properties
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.parameters.body import TrimmedBody

MASS_DIFFERENCE = 0.01
"""Maximum relative difference of two masses of the same body [1]: scales are accurate to 0.1 %, but fluids, trim, glue,
paint and wiring in a model only to 1 %."""

COG_DISTANCE = 0.02
"""Maximum distance of two centres of gravity of the same body [m]. Wheel loads determine x and y to millimetres; the
height, about 1 m, follows from a lifted axle within a few percent (ISO 10392:2011, scope)."""

_ROUND_OFF = 1e-9
"""Components below this share of the largest are round-off of a symmetric body: files have seven digits."""


def powers_of_thousand(mass: float, other: float) -> int:
    """Return the power of 1000 nearest to the ratio mass / other; nonzero indicates different units.

    Args:
        mass, other: masses of the same body [kg].
    """
    return round(float(np.log10(mass / other)) / 3.0)


def require_unit_of_mass(model: Superelement, body: TrimmedBody) -> None:
    """Check that the mass of a body model is in kg, by comparison with the vehicle file.

    Raises:
        DataError: the masses differ by about a power of 1000.
    """
    if body.flexible and len(model.frequencies) and powers_of_thousand(model.mass, body.mass):
        raise DataError(
            f"superelement {model.name!r}: its mass is {model.mass:.4g} kg, but body.mass is {body.mass:.4g} kg, "
            "so the units of mass differ. Import the model again with --mass-unit (t for matrices in mm, N and "
            "s), or correct body.mass of the vehicle."
        )


def mass_difference(model: Superelement, body: TrimmedBody, loads: Sequence[BodyLoad] = ()) -> list[str]:
    """Return a notice if mass or CoG of body model and vehicle file differ by more than the measurement uncertainty.

    Args:
        model: body model without attached masses.
        body: body of the vehicle file.
        loads: loads on the body that the model includes.
    """
    if not (body.flexible and len(model.frequencies)):
        return []
    vehicle_properties = MassProperties(mass=body.mass, cog=np.array(body.cog), inertia=np.eye(3))
    vehicle_properties = loaded_properties(vehicle_properties, loads)
    relative = abs(model.mass / vehicle_properties.mass - 1.0)
    distance = float(np.linalg.norm(model.cog - vehicle_properties.cog))
    if relative <= MASS_DIFFERENCE and distance <= COG_DISTANCE:
        return []
    cog = ", ".join(f"{value:z.3f}" for value in model.cog)
    return [
        f"body model {model.name}: {model.mass:.1f} kg with the CoG at [{cog}] m; the vehicle file has "
        f"{vehicle_properties.mass:.1f} kg and a CoG {1e3 * distance:.0f} mm away. With more than "
        f"{100 * MASS_DIFFERENCE:g} % or {1e3 * COG_DISTANCE:g} mm these are different bodies: rigid motions "
        "then use the values of the vehicle file, modes those of the model, without the inertia coupling "
        "between them. `python -m vehicle body show` prints a section [body] that fits the model"
    ]


def vehicle_lines(model: Superelement) -> list[str]:
    """Format the mass properties of a body model as TOML lines of a vehicle file, inertia about the CoG."""
    # Round-off of symmetric bodies as zero.
    cog, tensor = (
        np.where(np.abs(array) < _ROUND_OFF * np.abs(array).max(), 0.0, array)
        for array in (np.asarray(model.cog, dtype=float), np.asarray(model.inertia, dtype=float))
    )
    components = {"ixx": (0, 0), "iyy": (1, 1), "izz": (2, 2), "ixy": (0, 1), "izx": (2, 0), "iyz": (1, 2)}
    moments = [f"{name} = {(1.0 if i == j else -1.0) * tensor[i, j]:z.6g}" for name, (i, j) in components.items()]
    return [
        f"mass = {model.mass:.6g}",
        f"cog = [{', '.join(f'{value:.5g}' for value in cog)}]",
        f"inertia = {{ {', '.join(moments)} }}",
    ]
