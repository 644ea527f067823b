"""Unsprung masses of a new car: the parts of each axle, scaled to the stated sum.

The unsprung mass sum m dz_m / dz is linear in the masses of the parts, so one factor is sufficient; moments of
inertia of parts of equal size take the same factor.
"""

from typing import Any

from vehicle.digits import rounded
from vehicle.engines.kinematics.axle_ride import axle_ride
from vehicle.model.parameters.paths import paths, value_at
from vehicle.model.parameters.whole_body import put
from vehicle.studies.design.moved_points import Sources
from vehicle.studies.design.ride_solution import new_car_of
from vehicle.studies.design.stated_numbers import AXLES, StatedNumbers
from vehicle.studies.design.template_car import TemplateCar


def put_unsprung(table: dict[str, Any], template: TemplateCar, stated: StatedNumbers) -> Sources:
    """Scale masses and inertias of the parts of each axle with a stated unsprung mass; return their sources."""
    sources = Sources()
    for word in AXLES:
        mass = stated.of_axle("unsprung_mass", word)
        if mass is None:
            continue
        axle = template.axle(word)
        before = 2.0 * axle_ride(new_car_of(table, template).model, axle, roll=False).unsprung_mass
        for path in paths(table):
            whole = path.removesuffix(path[-2:]) if path[-2:] in (".x", ".y", ".z") else path
            unit = template.vehicle.quantity_of(whole).get("unit") if path.startswith(f"{axle}.") else None
            if unit not in ("kg", "kg m2") or whole in sources:
                continue
            put(table, {whole: times(value_at(table, whole), mass / before)})
            sources[whole] = (
                f"template {template.name} times {mass / before:.4g}, from {stated.stated(f'unsprung_mass_{word}')}"
            )
    return sources


def times(value: Any, factor: float) -> Any:
    """Return a mass, or the moments of a part, times a factor; round-off keeps the moments possible."""
    if not isinstance(value, list | tuple):
        return rounded(factor * value, 9)
    numbers = [rounded(factor * item, 9) for item in value]
    largest = numbers.index(max(numbers[:3]))
    # A disc has I_x + I_y = I_z exactly.
    numbers[largest] = min(numbers[largest], rounded((1.0 - 1e-9) * (sum(numbers[:3]) - numbers[largest]), 12))
    return numbers
