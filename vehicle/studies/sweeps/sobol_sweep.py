"""Sobol indices of the comfort of a car: a sweep at the points of the sample, and the indices with their intervals."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

from vehicle.errors import ConfigurationError, DataError
from vehicle.model.parameters.ranges import Range, parsed_variation
from vehicle.runs.car import Car
from vehicle.settings import with_settings
from vehicle.signals.analysis.ride_comfort import SEAT_PREFIX, UNWEIGHTED, WEIGHTED
from vehicle.signals.formats.csv_table import RowWriter
from vehicle.studies.sweeps.case_table import RowChanges
from vehicle.studies.sweeps.evaluation import Evaluation
from vehicle.studies.sweeps.indices import SobolIndices, sobol_indices, sobol_sample
from vehicle.studies.sweeps.plan import SweepPlan, plan_sweep
from vehicle.studies.sweeps.sweep_inputs import Inputs
from vehicle.studies.sweeps.sweep_ranking import ROUNDING, SweptCases, figure_names, is_comfort
from vehicle.studies.sweeps.sweep_settings import SobolSettings, SweepSettings

SOBOL = "sobol.csv"
"""Name of the file in the folder of a sweep."""

QUANTITIES = (f"{SEAT_PREFIX}{WEIGHTED}", f"{SEAT_PREFIX}{UNWEIGHTED}", WEIGHTED, UNWEIGHTED)
"""Columns of comfort that may have indices; those on the cushion of a seat first."""


@with_settings(SobolSettings)
def sobol(
    car: Car, vary: Mapping[str, tuple[float, float]], inputs: Inputs, settings: SobolSettings
) -> dict[str, SobolIndices]:
    """Return the Sobol indices of comfort for parameters uniform between bounds, the mean over all inputs.

    Each input counts over its own mean over the sample.

    S1: share of the variance due to a parameter alone; ST: with all its interactions. It takes base (p + 2) runs on
    each input, with p parameters. Call this function below `if __name__ == "__main__":`, like `sweep`.

    Args:
        car: car loaded by `Car.load`; its overrides apply to every run.
        vary: path to lower and upper bound, in the unit of the parameter.
        inputs: files, names of shipped files, roads, signals; one or several.

    Returns:
        Name of the comfort value, e.g. "weighted", to its indices (`first`, `total`) and the half-widths of their 95 %
        intervals (`first_error`, `total_error`), each (p,).

    Raises:
        ConfigurationError: bounds that do not ascend, `base` is no power of two or too small, and as in `sweep`.
        DataError: half of the base points have a failed run, or no parameter changes the comfort.

    Source: Saltelli et al., Comput. Phys. Commun. 181 (2010).
    """
    sample = SobolSample(vary, settings.base)
    return comfort_indices(sample.plan(car, inputs, settings).run(), sample.ranges())


@dataclass(frozen=True, slots=True)
class SobolSample:
    """Design of a sweep: the points of a sample of parameters uniform between bounds, for Sobol indices of comfort."""

    vehicle: ClassVar[str] = ""
    bounds: Mapping[str, tuple[float, float]] | Sequence[str]  # path to lower and upper bound; or texts "PATH=LOW:HIGH"
    base: int  # number of base points, a power of two, at least `indices.LEAST_BASE`

    def plan(self, car: Car, inputs: Inputs, settings: SweepSettings) -> SweepPlan:
        """Return the checked sweep; its sample is equal in every call, so that it can be resumed; see `Design`.

        Raises:
            ConfigurationError: a text of another form, a path that occurs twice, or a wrong `base`.
        """
        ranges = self.ranges()
        sample = RowChanges([each.path for each in ranges], sobol_sample(ranges, self.base).tolist())

        def evaluation(table: SweptCases, caption: str) -> Evaluation:
            indices = comfort_indices(table, ranges)
            left_out = ", ".join(name for name in _columns_of(table.units) if name not in indices)
            without = [f"no indices for {left_out}: all values are equal, or most are missing"] if left_out else []
            return Evaluation([*index_lines(indices), *without], {SOBOL: lambda path: write_indices(path, indices)})

        return plan_sweep(car, sample, inputs, settings, evaluation)

    def ranges(self) -> list[Range]:
        """Return the parameters with their bounds."""
        if isinstance(self.bounds, Mapping):
            return [Range(path=path, low=low, high=high) for path, (low, high) in self.bounds.items()]
        ranges = [parsed_variation("--vary", text).range() for text in self.bounds]
        paths = [each.path for each in ranges]
        if twice := next((path for path in paths if paths.count(path) > 1), ""):
            raise ConfigurationError(f"--vary {twice}: given twice; give its bounds once")
        return ranges


def comfort_indices(table: SweptCases, ranges: Sequence[Range]) -> dict[str, SobolIndices]:
    """Return the indices of each figure of a sweep over a `SobolSample`: mean of the inputs, each over its mean.

    A figure that no parameter changes, for example the frequency of an order, has no indices.
    """
    inputs = len({id(case.source) for case in table.cases})
    indices: dict[str, SobolIndices] = {}
    faults: list[DataError] = []
    for name in _columns_of(table.units):
        # The inputs vary slowest.
        values = table.column(name).reshape(inputs, -1)
        # Each input counts over its own mean, so that a loud one does not outweigh the others.
        count = np.maximum(np.count_nonzero(np.isfinite(values), axis=1, keepdims=True), 1)
        scale = np.abs(np.nansum(values, axis=1, keepdims=True) / count)
        mean = np.mean(values / np.where(scale > 0.0, scale, 1.0), axis=0)
        finite = np.isfinite(mean)
        if finite.any() and np.ptp(mean[finite]) <= ROUNDING:
            mean[finite] = 1.0
        try:
            indices[name] = sobol_indices(ranges, mean)
        except DataError as error:
            faults.append(error)
    if not indices:
        raise DataError(f"--sobol: {faults[0]}")
    return indices


def _columns_of(units: Mapping[str, str]) -> Sequence[str]:
    """Return the columns that may have indices: of a table of comfort both values, else all figures."""
    return [name for name in QUANTITIES if name in units] if is_comfort(units) else figure_names(units)


def write_indices(path: Path, indices: Mapping[str, SobolIndices]) -> None:
    """Write a row for each comfort value and parameter, the largest total index first.

    Args:
        path: CSV file.
        indices: see `comfort_indices`.
    """
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = RowWriter(file)
        rows.writerow(["value", "parameter", *(f"{name} [-]" for name in ("S1", "S1_95", "ST", "ST_95"))])
        for name, each in indices.items():
            columns = (each.first, each.first_error, each.total, each.total_error)
            for i in (-each.total).argsort():
                rows.writerow([name, each.paths[i], *(f"{column[i]:.6g}" for column in columns)])


def index_lines(indices: Mapping[str, SobolIndices]) -> list[str]:
    """Return the table of the first comfort value as text, the largest total index first.

    Args:
        indices: see `comfort_indices`.
    """
    name, each = next(iter(indices.items()))
    width = max(len("parameter"), *map(len, each.paths))
    lines = [f"{'parameter':<{width}}  {'S1':>6} {'+-':>6}  {'ST':>6} {'+-':>6}"]
    for i in (-each.total).argsort():
        first, total = (each.first[i], each.first_error[i]), (each.total[i], each.total_error[i])
        lines.append(f"{each.paths[i]:<{width}}  {first[0]:6.3f} {first[1]:6.3f}  {total[0]:6.3f} {total[1]:6.3f}")
    left = f"; {each.left_out} of {each.base} base points excluded (failed runs)" if each.left_out else ""
    warned = [f"warning: {fault}; use at least {2 * each.base} base points" for fault in each.contradictions]
    return [
        *lines,
        *warned,
        f"share of the variance of {name!r}: S1 for the parameter alone, ST with all its interactions; +-: half-width",
        f"of the 95 % interval, from {each.scramblings} independent samples{left}",
    ]
