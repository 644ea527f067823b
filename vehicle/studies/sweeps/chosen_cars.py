"""Designs of a sweep whose cars the user names: values in every combination, the rows of a table, another measure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.ranges import parsed_variation
from vehicle.runs.car import Car
from vehicle.studies.sweeps.case_table import Combinations, RowChanges
from vehicle.studies.sweeps.evaluation import Evaluation
from vehicle.studies.sweeps.order_measure import order_measure
from vehicle.studies.sweeps.plan import Design, SweepPlan, plan_sweep
from vehicle.studies.sweeps.sweep_inputs import Inputs
from vehicle.studies.sweeps.sweep_ranking import measure_lines
from vehicle.studies.sweeps.sweep_settings import SweepSettings
from vehicle.studies.sweeps.sweep_table import read_variations


@dataclass(frozen=True, slots=True)
class EveryCombination:
    """Cars with every combination of values, ranked by comfort.

    Attributes:
        values: path to values; or texts "PATH=A,B,C" or "PATH=A:B:N", N equally spaced values. The last path varies
            fastest.
    """

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
    """Cars of the rows of a table, ranked by comfort.

    Attributes:
        file: table whose columns are parameter paths; or the table of another sweep.
    """

    file: Path

    def plan(self, car: Car, inputs: Inputs, settings: SweepSettings) -> SweepPlan:
        """Return the checked sweep; see `Design`, and for the errors of the table `read_variations`."""
        return plan_sweep(car, RowChanges(*read_variations(self.file)), inputs, settings)


@dataclass(frozen=True, slots=True)
class OtherMeasure:
    """Cars of another design, by another measure than comfort.

    Attributes:
        design: the cars.
        measure: measure as text, see `order_measure`.
    """

    design: Design
    measure: str

    def plan(self, car: Car, inputs: Inputs, settings: SweepSettings) -> SweepPlan:
        """Return the checked sweep; see `Design`, and for a wrong measure `order_measure`."""
        plan = self.design.plan(car, inputs, settings)
        measure = order_measure(self.measure, plan.skip)
        return replace(plan, measure=measure, evaluation_of=lambda table, _: Evaluation(measure_lines(table)))
