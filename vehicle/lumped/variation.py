"""Parameters of one car, some of them replaced by numbers or arrays: one model or a thousand at once."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

from vehicle.laws.law import Numbers, check
from vehicle.parameters.paths import full_path, quantity_of
from vehicle.parameters.quarter_car import QuarterCar
from vehicle.parameters.toml_file import as_table


@dataclasses.dataclass(frozen=True, slots=True)
class Variation:
    """Values of a quarter car by their paths, with replacements such as {"mount.stiffness": array}.

    Raises:
        ConfigurationError: an unknown path (with the nearest known one) or a value out of the range of its field.
    """

    car: QuarterCar
    replaced: Mapping[str, Numbers] = dataclasses.field(default_factory=dict)

    def __post_init__(self) -> None:
        table = as_table(self.car)
        whole = {full_path(table, path): value for path, value in self.replaced.items()}
        for path, value in whole.items():
            check(path, value, quantity_of(QuarterCar, path))
        object.__setattr__(self, "replaced", whole)

    def __call__(self, path: str) -> Numbers:
        """Value of a parameter, e.g. "mount.stiffness"."""
        if path in self.replaced:
            return self.replaced[path]
        part, _, name = path.partition(".")
        value: float = getattr(getattr(self.car, part), name)
        return value
