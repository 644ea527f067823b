"""Band of the force of a damper over its velocity, from all laws within the tolerance of the choice.

Each law gives F(v) +- z s(v), with the standard error s from the covariance of its parameters; the band contains these
limits of all laws. It shows what the tests leave open within the family of laws. A force
that no law of the family describes is in the stated errors (`damper_ranges`), not in the band.
"""

from typing import NamedTuple

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.signals.formats.csv_table import table_text
from vehicle.studies.dampers.damper_fit import deviations
from vehicle.studies.dampers.damper_force import steady_force
from vehicle.studies.dampers.damper_ranges import RATIO, SHARE
from vehicle.studies.dampers.fitted_damper import FittedDamper

STORED = 10
"""Number of velocities of each sign in a vehicle file."""

POINTS, BELOW = 60, 10.0
"""Number of velocities of each sign, and ratio of the slowest test to the lowest of them."""


class Band(NamedTuple):
    """Force of curve and sliding friction over velocity."""

    velocity: Vector  # [m/s]; (n,)
    force: Vector  # of the chosen law [N]; (n,)
    lowest: Vector  # lowest, highest: limits of the band [N]; (n,)
    highest: Vector


def band_of(fitted: FittedDamper) -> Band:
    """Return the band of a fitted damper, up to `RATIO` times the highest velocity of its tests."""
    slowest, fastest = fitted.speeds
    size = np.geomspace(slowest / BELOW, RATIO * fastest, POINTS)
    velocity = np.concatenate([-size[::-1], size])
    limits = []
    for fit in (fitted.fit, *fitted.accepted):
        force, slopes = steady_force(fit.law, fit.parameters, velocity)
        spread = scipy.stats.norm.ppf(0.5 + 0.5 * SHARE) * deviations(fit.spreads, slopes)
        limits += [force - spread, force + spread]
    force = steady_force(fitted.fit.law, fitted.fit.parameters, velocity)[0]
    return Band(velocity, force, np.min(limits, axis=0), np.max(limits, axis=0))


def stored_band(fitted: FittedDamper) -> dict[str, tuple[float, ...]]:
    """Return the band for a vehicle file, by the keys of `TestedRange`: velocities, and changes of the force [N].

    In the direction of the velocity the force of an edge is at least zero: a damper takes energy.
    """
    band = band_of(fitted)
    half = np.linspace(0, POINTS - 1, STORED).round().astype(int)
    rows = np.concatenate([POINTS - 1 - half[::-1], POINTS + half])
    sign = np.sign(band.velocity)
    force = sign * band.force
    edges = [np.maximum(sign * each, 0.0) for each in (band.lowest, band.highest)]
    changes = np.minimum(*edges) - force, np.maximum(*edges) - force
    soft, firm = np.minimum(changes[0], 0.0), np.maximum(changes[1], 0.0)
    return {
        name: tuple(values[rows].tolist())
        for name, values in (("band_velocity", band.velocity), ("band_soft", soft), ("band_firm", firm))
    }


def band_text(band: Band) -> str:
    """Return the band as CSV."""
    rows = [["velocity [m/s]", "force [N]", "lowest [N]", "highest [N]"]]
    return table_text([*rows, *([f"{value:.5g}" for value in row] for row in zip(*band, strict=True))])
