"""Classes of cars: default numbers and powertrain of a new car; data in `classes.toml`."""

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.toml_file import read_table
from vehicle.studies.design.stated_numbers import StatedNumbers

CLASSES = read_table(Path(__file__).parent / "classes.toml")
"""Tables of the classes by their names."""

POSITION = ("front_axle_load", "rear_axle_load", "cog_x")
"""Numbers that give the position of the centre of gravity along the car."""

POWERTRAIN = "assumed: electric motor with reducer and inverter on rubber mounts that put its modes at 8 to 20 Hz"
"""Source of the parameters of the powertrain of a class."""


def of_class(stated: StatedNumbers) -> StatedNumbers:
    """Return stated numbers completed from the class of the car.

    Args:
        stated: stated numbers, which take precedence; both axle loads together are the kerb mass.

    Raises:
        ConfigurationError: an unknown class.
    """
    if stated.car_class is None:
        return stated
    table = _class(stated.car_class)
    share, wheelbase = table["front_share"], stated.wheelbase or table["wheelbase"]
    numbers = {key: value for key, value in table.items() if getattr(stated, key, 0.0) is None}
    if stated.front_axle_load is not None and stated.rear_axle_load is not None:
        numbers.pop("kerb_mass", None)
    if all(getattr(stated, key) is None for key in POSITION):
        numbers["cog_x"] = (1.0 - share) * wheelbase
    return dataclasses.replace(stated, **numbers, of_class=tuple(numbers))


def powertrain(name: str | None) -> Mapping[str, Any] | None:
    """Return the table of the powertrain of a class; None keeps the powertrain of the template."""
    return None if name is None else _class(name).get("engine")


def _class(name: str) -> Mapping[str, Any]:
    if name not in CLASSES:
        raise ConfigurationError(f"--car-class {name!r}: must be one of {', '.join(CLASSES)}")
    return CLASSES[name]  # type: ignore[no-any-return]
