"""Calibration of `damper_ranges.HIDDEN`: errors below the tests, over the trace that they left in the residuals.

    python -m tests.benchmarks.hidden_forces [SEED]

Dampers of `unseen_tests` and `drawn_dampers` are fitted without slow tests and predict four of them. Of the squared
error of each, that inside the tests and that between the accepted laws are subtracted; the root of the rest over the
octaves to the slowest test, over the systematic part of the residuals, is the ratio. `HIDDEN` is its quantile of nine
of ten with the ten odd dampers of `unseen_tests` and the seven even ones of the seed 20261129, 68 tests: 4.2. With a
SEED: the ratios of the seven even dampers of that seed, to verify the number on dampers that it was not fitted to.
"""

import sys
from typing import Any

import numpy as np

from tests.benchmarks.drawn_dampers import drawn
from tests.benchmarks.known_dampers import KNOWN, MOTIONS
from tests.benchmarks.unseen_tests import STRANGE, WITHOUT_SLOW, coverage, predictions, printed
from vehicle.studies.dampers.damper_ranges import SHARE

CALIBRATED = 20261129
"""Seed whose dampers are part of the calibration."""


def ratios(fit, rows):
    """Return the ratio of each test slower than all fitted tests."""
    highest = {name: float(np.max(np.abs(MOTIONS[name]()[2]))) for name in (*WITHOUT_SLOW[0], *WITHOUT_SLOW[1])}
    slowest = min(highest[name] for name in WITHOUT_SLOW[0])
    inside = float(np.exp(np.mean(np.log(fit.further)))) ** 2
    values = []
    for name, side, error, _ in rows:
        if side == "slower":
            octaves = float(np.log2(slowest / highest[name]))
            between = float(np.interp(octaves, np.arange(fit.differences.size), fit.differences))
            values.append(np.sqrt(max(error**2 - inside - between, 0.0) / octaves) / fit.systematic)
    return values


def main(seed):
    """Print the errors and ratios of each damper, and the quantile of the ratios."""
    dampers: list[tuple[Any, tuple[int, ...]]] = [
        (known, (seed, number)) for number, known in enumerate(drawn(seed)) if number % 2 == 0
    ]
    if seed == CALIBRATED:
        dampers += [(known, (number,)) for number, known in (KNOWN | STRANGE).items() if number % 2]
    every, values = [], []
    for known, noise in dampers:
        fit, rows = predictions(known, noise, WITHOUT_SLOW)
        print(f"{noise} {fit.law.title}\n{printed(rows)}", flush=True)
        every += rows
        values += ratios(fit, rows)
        print("   ratios", *(f"{value:.2f}" for value in values[-len(rows) :]))
    print(coverage(every))
    print(f"ratio exceeded by one of ten of {len(values)} tests: {np.quantile(values, SHARE):.1f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else CALIBRATED)
