"""Mass and centre of gravity of a body model against those of the vehicle file.

Rigid motions take the mass properties of the vehicle file, and the modes are free-free modes of those of the model.
Where both are the same body there is no inertia coupling between them. Where not, M phi' R is left out: of the order of
the relative difference of the masses, and of the distance of the centres over the radius of gyration.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vehicle.errors import DataError
from vehicle.model.flexbody.body_loads import BodyLoad, loaded_properties
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.parameters.body import TrimmedBody

MASS_DIFFERENCE = 0.01
"""Relative difference of two masses of one trimmed body from which they are not the same: a scale is good to 0.1 %, but
fluids, trim and the mass of glue, paint and wiring in a model are known to a percent only."""

COG_DISTANCE = 0.02
"""Distance of two centres of gravity of one trimmed body from which they are not the same [m]. Wheel loads tell the
place along and across it to millimetres; the height, about 1 m, follows from a lifted axle within a few percent
(ISO 10392:2011, scope)."""

_ROUND_OFF = 1e-9
"""Share of the largest component below which one is round-off of a symmetric body: files have seven digits."""


def powers_of_thousand(mass: float, other: float) -> int:
    """Power of 1000 that is nearest to the ratio of two masses: not zero of one body in two units.

    Args:
        mass, other: [kg].
    """
    return round(float(np.log10(mass / other)) / 3.0)


def require_unit_of_mass(model: Superelement, body: TrimmedBody) -> None:
    """Refuse a body model whose mass is in another unit than kg.

    Args:
        model: body model without what is fixed to it.
        body: of the vehicle file.

    Raises:
        DataError: the masses are about a power of 1000 apart.
    """
    if body.flexible and len(model.frequencies) and powers_of_thousand(model.mass, body.mass):
        raise DataError(
            f"superelement {model.name!r}, mass: found {model.mass:.4g} kg, body.mass is {body.mass:.4g} kg: another "
            "unit of mass. Import the model again with --mass-unit (t of matrices in mm, N and s), or give its "
            "vehicle's body.mass."
        )


def mass_difference(model: Superelement, body: TrimmedBody, loads: Sequence[BodyLoad] = ()) -> list[str]:
    """A sentence where model and vehicle file differ by more than weighing and tilting can be wrong; else nothing.

    Args:
        model: body model without what is fixed to it.
        body: of the vehicle file.
        loads: on the body, which are in the model.
    """
    if not (body.flexible and len(model.frequencies)):
        return []
    given = MassProperties(mass=body.mass, cog=np.array(body.cog), inertia=np.eye(3))
    given = loaded_properties(given, loads)
    relative = abs(model.mass / given.mass - 1.0)
    apart = float(np.linalg.norm(model.cog - given.cog))
    if relative <= MASS_DIFFERENCE and apart <= COG_DISTANCE:
        return []
    place = ", ".join(f"{value:z.3f}" for value in model.cog)
    return [
        f"body model {model.name}: {model.mass:.1f} kg with the CoG at [{place}] m; the vehicle file has "
        f"{given.mass:.1f} kg and a CoG {1e3 * apart:.0f} mm away. More than {100 * MASS_DIFFERENCE:g} % or "
        f"{1e3 * COG_DISTANCE:g} mm is not one body: rigid motions take the vehicle file, modes the model, and their "
        "inertia coupling is left out. `python -m vehicle body show` prints the table [body] of the model"
    ]


def vehicle_lines(model: Superelement) -> list[str]:
    """Mass properties of a body model as a vehicle file has them: inertia about the CoG, products as integrals."""
    cog, tensor = (np.asarray(own, dtype=float) for own in (model.cog, model.inertia))
    cog, tensor = (np.where(np.abs(own) < _ROUND_OFF * np.abs(own).max(), 0.0, own) for own in (cog, tensor))
    places = {"ixx": (0, 0), "iyy": (1, 1), "izz": (2, 2), "ixy": (0, 1), "izx": (2, 0), "iyz": (1, 2)}
    moments = [f"{name} = {(1.0 if i == j else -1.0) * tensor[i, j]:z.6g}" for name, (i, j) in places.items()]
    return [
        f"mass = {model.mass:.6g}",
        f"cog = [{', '.join(f'{value:.5g}' for value in cog)}]",
        f"inertia = {{ {', '.join(moments)} }}",
    ]
