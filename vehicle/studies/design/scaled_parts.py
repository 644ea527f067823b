"""Axles and powertrain of a new car: the parts of the template scaled by the mass m of the car, q = (m / m_template)^p.

    p = 1    mass, force, stiffness, damping: frequencies, damping ratios and accelerations remain
    p = 5/3  moments of inertia: lengths of parts are in proportion to m^(1/3)
    p = 2/3  stiffness of tyre and carcass: the deflection m g / k is in proportion to the size of the tyre
    p = 1/3  trail of the tyre: in proportion to its contact length

Sources: geometric similarity (Pacejka, Tire and Vehicle Dynamics, chapter 4: forces in proportion to the load); the
share of the unsprung mass in the car is about the same for all classes (Gillespie, chapter 5). Assumed as a check on
tyres: 165/65 R14 of a car of 1 t, 205/55 R16 of 1.6 t and 255/50 R19 of 2.4 t have about 160, 210 and 300 N/mm, and
(m / 1.6 t)^(2/3) of 210 N/mm gives 154 and 275. Hardpoints are moved (`moved_points`), not scaled.
"""

from collections.abc import Iterator
from typing import Any

from vehicle.digits import rounded
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.paths import paths, value_at
from vehicle.model.parameters.plausible import ENGINE
from vehicle.model.parameters.toml_file import copy_table
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.model.parameters.whole_body import put
from vehicle.studies.design.moved_points import Sources
from vehicle.studies.design.template_car import TemplateCar

EXPONENTS = {
    "kg": 1.0,
    "N": 1.0,
    "N/m": 1.0,
    "N s/m": 1.0,
    "N/rad": 1.0,
    "N m/rad": 1.0,
    "N m s/rad": 1.0,
    "kg m2": 5.0 / 3.0,
}
"""Exponent p by the unit of a parameter; a parameter with another unit remains."""

OF_TYRES = {"stiffness": 2.0 / 3.0, "carcass_longitudinal": 2.0 / 3.0, "carcass_lateral": 2.0 / 3.0, "trail": 1.0 / 3.0}
"""Exponent p of the parameters of a tyre that follow another law than their unit."""


def scaled_parts(
    table: dict[str, Any], template: TemplateCar, ratio: float, *, powertrain: bool = True
) -> tuple[dict[str, Any], Sources]:
    """Return the vehicle table with scaled axles and powertrain, and the sources of the scaled values.

    Args:
        ratio: kerb mass of the new car over the template's.
        powertrain: False for another powertrain than the template's.
    """
    sources, table = Sources(), copy_table(table)
    for path, exponent in _exponents(template, powertrain=powertrain):
        # Four digits are legible in the file; the law is no more exact than that.
        if (factor := rounded(ratio**exponent, 4)) == 1.0:
            continue
        value = value_at(table, path)
        several = isinstance(value, list | tuple)
        numbers = [rounded(factor * number, 12) for number in (value if several else [value])]
        put(table, {path: numbers if several else numbers[0]})  # type: ignore[dict-item]
        sources[path] = f"value from template {template.name} times {factor:g}, in proportion to the kerb mass"
    try:
        vehicle_of(table, template.file.parent)
    except ConfigurationError as error:
        raise ConfigurationError(
            f"--kerb-mass: parts of {template.name}, scaled by {ratio:.3g}, are outside the range of cars: "
            f"{error}; state a mass nearer to the template's, or start from another car"
        ) from None
    return table, sources


def _exponents(template: TemplateCar, *, powertrain: bool) -> Iterator[tuple[str, float]]:
    """Yield path and exponent of each parameter of axles and powertrain that the mass scales."""
    car = template.vehicle.composition
    roots = {template.axle(word) for word in template.wheels}
    if powertrain:
        roots |= {part.path.split(".")[0] for part in car.parts if part.name == ENGINE}
    tyres = tuple(f"{path}." for path in template.tyre_paths.values())
    whole = dict.fromkeys(path.removesuffix(path[-2:]) if path[-2:] in (".x", ".y", ".z") else path
                          for path in paths(template.table) if path.split(".")[0] in roots)  # fmt: skip
    for path in whole:
        if isinstance(value_at(template.table, path), str | bool):
            continue
        key = path.rpartition(".")[2]
        exponent = OF_TYRES.get(key) if path.startswith(tyres) else None
        exponent = exponent or EXPONENTS.get(template.vehicle.quantity_of(path).get("unit", "-"))
        if exponent is not None:
            yield path, exponent
