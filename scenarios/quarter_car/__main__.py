"""The quarter-car family of the thesis (Bommer 2006): figures of chapter 2 and the appendices, and a table of results.

python -m scenarios.quarter_car [--output DIR] [--parameters FILE.toml] [--figure NAME] [--quick] [--force]
"""

import argparse
import sys
from pathlib import Path

from scenarios.claims import Findings
from scenarios.lumped.quarter_car_parameters import PUBLISHED, load_quarter_car
from scenarios.quarter_car.claims import findings
from scenarios.quarter_car.figures import FIGURES
from scenarios.quarter_car.runs import Runs
from scenarios.study import lumped_study


def study(runs: Runs, folder: Path, options: argparse.Namespace) -> Findings | str:
    """Draw the figures; the table unless one figure alone was asked for."""
    for name in [options.figure] if options.figure else FIGURES:
        FIGURES[name](runs, folder / f"figure_{name.replace('.', '_').lower()}.png")
    return f"1 figure; {runs.seconds:.0f} s of solving" if options.figure else findings(runs)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of this study."""
    names = f"one of {', '.join(FIGURES)}; no table"
    parser.add_argument("--figure", choices=list(FIGURES), metavar="NAME", help=names)


def load(options: argparse.Namespace) -> Runs:
    """Return the runs of the parameters in a file."""
    return Runs(car=load_quarter_car(options.parameters or PUBLISHED), quick=options.quick)


main = lumped_study("quarter_car", load, study, add_options)


if __name__ == "__main__":
    sys.exit(main())
