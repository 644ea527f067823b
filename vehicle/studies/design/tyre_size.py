"""Size of a tyre, for example 205/55R16: its radius without load, and under the static load of a car."""

import dataclasses
import re

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.paths import value_at
from vehicle.studies.design.mass_balance import axle_loads, kerb_model
from vehicle.studies.design.scaled_parts import OF_TYRES
from vehicle.studies.design.stated_numbers import StatedNumbers
from vehicle.studies.design.template_car import TemplateCar

INCH = 25.4e-3
"""Unit of the rim diameter [m]."""

SIZE = re.compile(r"P?(\d+)/(\d+) *Z?R *(\d+(?:\.5)?) *C?(?: *[\d/]+ *[A-Z])?", re.IGNORECASE)
"""Width [mm], height in percent of it, rim [inch] of a radial tyre; C, load index and speed symbol may follow."""

RANGES = {"width": (105, 395, "mm"), "height": (20, 95, "% of the width"), "rim": (10, 24, "inch")}
"""Minimum, maximum and unit of the numbers of a size; assumed: tyres of passenger cars that are sold."""


def unloaded_radius(size: str) -> float:
    """Return the radius of a tyre without load [m]: d/2 + H, H = S a / 100.

    d is the diameter of the rim, S the nominal width, a the height of the section in percent of it.

    Args:
        size: size of a radial tyre, for example "205/55R16" or "205/55 R 16 91V".

    Source: UN Regulation No. 30 (ISO 4000-1): outer diameter D = d + 2 H.
    """
    form = "write width/height R rim, e.g. 205/55R16: 205 mm wide, height 55 % of the width, rim of 16 inch"
    matched = SIZE.fullmatch(size.strip())
    if matched is None:
        raise ConfigurationError(f"--tyre-size {size!r}: not the size of a radial tyre; {form}")
    numbers = dict(zip(RANGES, map(float, matched.groups()), strict=True))
    for name, (low, high, unit) in RANGES.items():
        if not low <= numbers[name] <= high:
            raise ConfigurationError(
                f"--tyre-size {size!r}: {name} {numbers[name]:g} {unit}, must be {low} to {high}; {form}"
            )
    return INCH * numbers["rim"] / 2.0 + 1e-5 * numbers["width"] * numbers["height"]


def with_tyre_size(stated: StatedNumbers, template: TemplateCar, ratio: float) -> StatedNumbers:
    """Return stated numbers with the loaded radius of a tyre of stated size or free radius: free radius less F / k.

    F is the static load of a front wheel, stated or in proportion to the mass, k the stated stiffness of the front
    tyres, or of the template, scaled by `scaled_parts`; a stated wheel hop, which changes k, is left out.

    Args:
        stated: stated numbers.
        ratio: kerb mass of the new car over the template's [-]; 1 if its parts are not scaled.
    """
    if stated.tyre_size is None and stated.tyre_free_radius is None:
        return stated
    if stated.tyre_radius is not None and "tyre_radius" not in stated.of_class:
        raise ConfigurationError("--tyre-size and --tyre-radius: the size gives the radius; leave one of the two out")
    free = stated.tyre_free_radius or unloaded_radius(str(stated.tyre_size))
    loads = axle_loads(kerb_model(template.table, template), template)
    front = stated.front_axle_load
    if front is None and stated.kerb_mass is not None and stated.cog_x is not None:
        front = stated.kerb_mass * (1.0 - stated.cog_x / (stated.wheelbase or template.wheelbase))
    elif front is None:
        front = ratio * loads["front"]
    stiffness = stated.tyre_stiffness_front or (
        value_at(template.table, f"{template.tyre_paths['front']}.stiffness")[2] * ratio ** OF_TYRES["stiffness"]
    )
    radius = free - front * template.vehicle.gravity / 2.0 / stiffness
    others = tuple(name for name in stated.of_class if name != "tyre_radius")
    return dataclasses.replace(stated, tyre_radius=radius, of_class=others, of_load=("tyre_radius",))
