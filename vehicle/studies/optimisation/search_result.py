"""Result of a search for optimal parameters of a car: named cars, checks of these cars, and all files."""

import math
import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from vehicle.arrays import Vector
from vehicle.model.parameters.body_notices import body_rules
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car import Car
from vehicle.studies.optimisation.car_table import columns
from vehicle.studies.optimisation.front_checks import NEW_CARS, Differences, Shares
from vehicle.studies.optimisation.outcome import Outcome
from vehicle.studies.optimisation.screening import Screening
from vehicle.studies.optimisation.search_files import OtherFront, agreement, numbers, write_search
from vehicle.studies.optimisation.trials import Trials
from vehicle.studies.sweeps.case import all_tyre_words
from vehicle.studies.sweeps.case_table import Cases
from vehicle.wording import in_words

STILL = 0.005
"""Maximum relative growth of the hypervolume in the last quarter of a converged search."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class FoundCars:
    """Result of a search: the Pareto front, and the named cars on the front.

    Attributes:
        outcome: Pareto front and all cars tried.
        trials: evaluation of the cars.
        vehicle: parameters of the unmodified car.
        cars: name to car: "best comfort", "knee", ...
        skip: start of the evaluation [s].
        seed: seed of the search.
        nominal: values of the Pareto front without tolerances, (f, objectives and limits); None without tolerances.
        reached: share of new cars within the tolerances with values as good as stated [-]; None without a quantile.
        checked: relative differences between MuJoCo and the engine of the search [-]; None without a check.
        screened: screening by estimates, whose best cars are in `outcome`; None for a search by runs.
        notices: named cars that left the valid range of the reduced engine.
    """

    outcome: Outcome
    trials: Trials
    vehicle: Vehicle
    cars: Mapping[str, Car]
    skip: float
    seed: int
    nominal: Vector | None
    reached: Shares | None
    checked: Differences | None
    screened: Screening | None
    notices: tuple[str, ...]

    def __repr__(self) -> str:
        """Return the numbers of cars and the names of the best in a line."""
        count, front = len(self.outcome.tried.reasons), self.outcome.front_size
        return f"FoundCars({count} cars, {front} on the front: {', '.join(self.cars)})"

    def __str__(self) -> str:
        """Return the table of the named cars."""
        return in_words(self.text())

    def plot(self, ax: Any = None) -> Any:
        """Plot the cars tried and the front over the first two objectives, or the convergence of a single one.

        Args:
            ax: the axes; a new figure by default.

        Returns:
            The axes.
        """
        from vehicle.drawing.rendering.front_plot import draw_first
        from vehicle.drawing.rendering.open_axes import open_axes
        from vehicle.studies.optimisation.search_files import picture_of

        axis = open_axes(ax, (6.4, 5.4)).item()
        draw_first(axis, picture_of(self.outcome, None))
        return axis

    @property
    def values(self) -> dict[str, dict[str, float | None]]:
        """Return name of the car to objective or limit to value, in the units of `text`."""
        outcome = self.outcome
        return {name: numbers(outcome.problem, outcome.tried.values[row]) for name, row in outcome.named.items()}

    @property
    def tyres(self) -> str:
        """Return a description of the state of the tyres on all inputs: standing or rolling at a speed."""
        trials = self.trials
        return all_tyre_words(Cases([()], trials.inputs, vehicle=trials.vehicle, fixed=trials.fixed))

    @property
    def caption(self) -> str:
        """Return the caption of the picture of the search."""
        limits = ", ".join(criterion.expression for criterion in self.trials.problem.limits)
        count = len(self.trials.spread.bands)
        return (
            f"{self.vehicle.name} on {', '.join(self.trials.problem.inputs)}; tyres {self.tyres}; engine "
            f"{self.trials.engine}, {len(self.outcome.tried.reasons)} cars, seed {self.seed}"
            + (f"; limits {limits}" if limits else "")
            + (f"; {self.trials.spread.statistic} within the tolerances" if count > 1 else "")
        )

    def write(self, folder: Path, *, beside: OtherFront | None = None, command: str = "") -> None:
        """Write the Pareto front as table and picture, a vehicle file for each named car, and the summary.

        Args:
            folder: existing folder of the search.
            beside: Pareto front of another search, drawn for comparison.
            command: command line that made the search, for the summary.

        Raises:
            OutputError: a file cannot be written.
        """
        write_search(
            folder,
            self.outcome,
            self.cars,
            caption=f"{self.caption}; evaluated from {self.skip:g} s on",
            nominal=self.nominal,
            beside=beside,
            summary={
                "command": command or None,
                "vehicle": self.vehicle.name,
                "inputs": {source.name: source.identity() for source in self.trials.inputs},
                "engine": self.trials.engine,
                "tyre": self.tyres,
                "evaluated_from_s": self.skip,
                "notices": list(self.notices),
                "mujoco": self.checked,
                **({} if self.screened is None else {"estimate": self.screened.summary}),
                "made_cars": None
                if self.nominal is None
                else {
                    "statistic": self.trials.spread.statistic,
                    "new_cars": NEW_CARS if self.reached else 0,
                    "share_as_good": self.reached,
                },
            },
        )

    def text(self, folder: Path | None = None, beside: OtherFront | None = None) -> str:
        """Return a text for the console: named cars and unmodified car with their values, and the checks.

        Args:
            folder: folder of the files, which the text lists.
            beside: Pareto front of another search for comparison.
        """
        outcome, tried, problem = self.outcome, self.outcome.tried, self.outcome.problem
        spread = self.trials.spread
        varied = [*(each.path for each in problem.ranges), *(tolerance.path for tolerance, _ in spread.tolerances)]
        lines = [f"note        {text}" for text in body_rules(self.vehicle, varied)]
        failed = [reason for reason in tried.reasons if reason]
        lines.append(
            f"{'search' if folder is None else folder}: {len(tried.reasons)} cars, {outcome.front_size} on the front, "
            f"{len(failed)} failed" + ("" if folder is None else "; front.csv, front.png, summary.json, cars.csv")
        )
        if failed:
            lines.append(f"first failure: {failed[0]}")
        if self.screened is not None:
            lines.append(self.screened.sentence)
        lines += self._table()
        lines += [] if self.screened is None else self.screened.lines
        if spread.tolerances:
            lines.append(f"values: {spread.statistic} within the tolerances")
        for name, shares in (self.reached or {}).items():
            each = [f"{100 * share:.0f} % reach its {label}" for label, share in shares.items()]
            error = 100 * _share_error(spread.quantile, NEW_CARS)
            lines.append(f"{name}: of {NEW_CARS} fresh cars {', '.join(each)} (standard error {error:.0f} %)")
        for name, differences in (self.checked or {}).items():
            texts = [f"{label} {100 * share:+.2f} %" for label, share in differences.items() if share is not None]
            lines.append(f"{name} with MuJoCo: {', '.join(texts)}")
        last = max(outcome.reached.values(), default=1.0)
        if last < 1.0 - STILL:
            lines.append(
                f"the front still grew by {100 * (1 - last):.1f} % in the last quarter: use --resume and more --cars"
            )
        for name in outcome.named:
            lines.append(f"{name}: " + " ".join(f"--set {shlex.quote(text)}" for text in self.cars[name].overrides))
        lines.append(f"tyres {self.tyres}; engine {self.trials.engine}; evaluated from {self.skip:g} s on")
        if beside is not None:
            difference = agreement(outcome, beside)
            lines.append(
                f"front of {beside.folder}: hypervolume {100 * difference['hypervolume_change']:+.2f} % relative to "
                f"this front, mean distance {100 * difference['mean_distance']:.2f} % of the range of the objectives"
            )
        if self.notices:
            file = " in summary.json" if folder is not None else ""
            lines.append(
                f"{len(self.notices)} notices{file}: the cars they name are outside the valid range of the reduced "
                "engine; run with --check to see the error"
            )
        return "\n".join(lines)

    def _table(self) -> list[str]:
        """Return the lines of a table: a row for each parameter and value, a column for each car."""
        outcome, tried, problem = self.outcome, self.outcome.tried, self.outcome.problem
        rows = {"base": [*problem.base, *outcome.base.values[0]]}
        rows |= {name: [*tried.points[row], *tried.values[row]] for name, row in outcome.named.items()}
        heads = columns(problem)
        width = max(len(head) for head in heads)
        lines = [" " * width + "".join(f"  {name:>11}" for name in rows)]
        for number, head in enumerate(heads):
            cells = [f"  {values[number]:{max(len(name), 11)}.5g}" for name, values in rows.items()]
            lines.append(f"{head:<{width}}" + "".join(cells))
        return lines


def _share_error(quantile: float, cars: int) -> float:
    """Return the standard error of a share of cars near the quantile, at most 0.9 [-]."""
    share = min(quantile, 0.9)
    return math.sqrt(share * (1.0 - share) / cars)
