"""Parameters of one car, some of them replaced by numbers or arrays: one model or a thousand at once."""

from __future__ import annotations

import dataclasses
import difflib
from collections.abc import Mapping
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.laws.law import Numbers, check
from vehicle.parameters.quarter_car import QuarterCar


@dataclasses.dataclass(frozen=True, slots=True)
class Variation:
    """Values of a quarter car by dotted paths, with replacements such as {"mount.stiffness": array}.

    Raises:
        ConfigurationError: an unknown path (with the nearest known one) or a value out of the range of its field.
    """

    car: QuarterCar
    replaced: Mapping[str, Numbers] = dataclasses.field(default_factory=dict)

    def __post_init__(self) -> None:
        fields = _fields(self.car)
        for path, value in self.replaced.items():
            if path not in fields:
                near = difflib.get_close_matches(path, list(fields), n=1, cutoff=0.0)
                raise ConfigurationError(f"{path}: unknown parameter; the nearest known name is {near[0]}")
            check(path, value, fields[path].metadata)

    def __call__(self, path: str) -> Numbers:
        """Value of a parameter, e.g. "mount.stiffness"."""
        if path in self.replaced:
            return self.replaced[path]
        part, _, name = path.partition(".")
        value: float = getattr(getattr(self.car, part), name)
        return value


def _fields(car: QuarterCar) -> dict[str, dataclasses.Field[Any]]:
    """Every number of the car by its dotted path."""
    return {
        f"{part.name}.{entry.name}": entry
        for part in dataclasses.fields(car)
        for entry in dataclasses.fields(getattr(car, part.name))
    }
