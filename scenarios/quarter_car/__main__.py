"""The quarter-car family of the thesis (Bommer 2006): figures of chapter 2 and the appendices, and a table of results.

python -m scenarios.quarter_car [--output DIR] [--parameters FILE.toml] [--figure NAME] [--quick] [--force]
"""

import sys
from dataclasses import dataclass
from pathlib import Path

from scenarios.claims import Findings
from scenarios.lumped.quarter_car_parameters import PUBLISHED, load_quarter_car
from scenarios.quarter_car.claims import findings
from scenarios.quarter_car.figures import FIGURES
from scenarios.quarter_car.runs import Runs
from scenarios.study import LumpedSettings, lumped_study
from vehicle.settings import setting as declared


@dataclass(frozen=True, kw_only=True, slots=True)
class QuarterCarSettings(LumpedSettings):
    """Settings of the study of quarter cars."""

    figure: str | None = declared(f"one of {', '.join(FIGURES)}; no table", choices=list(FIGURES), metavar="NAME")


def study(runs: Runs, folder: Path, settings: QuarterCarSettings) -> Findings | str:
    """Draw the figures; the table unless one figure alone was asked for."""
    for name in [settings.figure] if settings.figure else FIGURES:
        FIGURES[name](runs, folder / f"figure_{name.replace('.', '_').lower()}.png")
    return f"1 figure; {runs.seconds:.0f} s of solving" if settings.figure else findings(runs)


def load(settings: QuarterCarSettings) -> Runs:
    """Return the runs of the parameters in a file."""
    return Runs(car=load_quarter_car(settings.parameters or PUBLISHED), quick=settings.quick)


main = lumped_study("quarter_car", load, study, QuarterCarSettings)


if __name__ == "__main__":
    sys.exit(main())
