"""Designs of a sweep whose cars the user names: values in every combination, the rows of a table."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.ranges import parsed_variation
from vehicle.runs.car import Car
from vehicle.studies.sweeps.case_table import Combinations, RowChanges
from vehicle.studies.sweeps.plan import SweepPlan, plan_sweep
from vehicle.studies.sweeps.sweep_inputs import Inputs
from vehicle.studies.sweeps.sweep_settings import SweepSettings
from vehicle.studies.sweeps.sweep_table import read_variations


@dataclass(frozen=True, slots=True)
class EveryCombination:
    """Cars with every combination of values, ranked by comfort."""

    vehicle: ClassVar[str] = ""
    # path to values; or texts "PATH=A,B,C" or "PATH=A:B:N", N equally spaced values. The last path varies fastest.
    values: Mapping[str, Sequence[Any]] | Sequence[str]

    def plan(self, car: Car, inputs: Inputs, settings: SweepSettings) -> SweepPlan:
        """Return the checked sweep; see `Design`. A text of another form, or a path twice, is a ConfigurationError."""
        values = self.values if isinstance(self.values, Mapping) else every_combination(self.values)
        return plan_sweep(car, values, inputs, settings)


def every_combination(texts: Sequence[str]) -> Combinations:
    """Return all combinations of the values of texts, see `EveryCombination`."""
    columns: dict[str, list[str]] = {}
    for text in texts:
        variation = parsed_variation("--vary", text)
        if variation.path in columns:
            raise ConfigurationError(f"--vary {variation.path}: given twice; list all its values in one option")
        columns[variation.path] = [f"{variation.path}={value}" for value in variation.listed()]
    return Combinations(list(columns.values()))


@dataclass(frozen=True, slots=True)
class VariationTable:
    """Cars of the rows of a table, ranked by comfort."""

    vehicle: ClassVar[str] = ""
    file: Path  # table whose columns are parameter paths; or the table of another sweep

    def plan(self, car: Car, inputs: Inputs, settings: SweepSettings) -> SweepPlan:
        """Return the checked sweep; see `Design`, and for the errors of the table `read_variations`."""
        return plan_sweep(car, RowChanges(*read_variations(self.file)), inputs, settings)
