"""Mechanism missing in a law, from the residual force, measured minus fitted.

The rest r over the standard deviation of the force, and its product with the direction sgn v, are compared with their
means in bins of equal numbers of samples. A mechanism explains the share of the variance that its bins take away,
after the bins without it:

    gap           r sgn v over the distance since the last reversal, after bins of the speed
    hysteresis    the part of r in proportion to the acceleration: inertia, or a compliance behind damping
    frequency     r sgn v over the speed, each test apart, after bins of the speed
    asymmetry     r over the speed

The largest share counts, from `LEAST` on. A gap is where the largest change between two bins occurs.
"""

from typing import NamedTuple

import numpy as np

from vehicle.arrays import Indices, Vector
from vehicle.digits import number
from vehicle.studies.dampers.fitted_damper import FittedDamper
from vehicle.studies.dampers.waveform import reversals

BINS = 40
"""Number of bins."""

LEAST = 0.3
"""Smallest share of the variance of the rest that is named."""


class Missing(NamedTuple):
    """Mechanism missing in the law."""

    name: str  # "gap", "hysteresis", "frequency" or "asymmetry"
    share: float  # of the variance of the rest
    distance: float  # of the largest change of the rest from the last reversal [m]


def missing_mechanism(fitted: FittedDamper) -> Missing | None:
    """Return the mechanism that explains most of the rest of the force; None if none explains `LEAST` of it."""
    columns = []
    for at, test in enumerate(fitted.tests):
        turns = reversals(test.displacement, test.velocity)
        stroke = np.clip(np.searchsorted(turns, np.arange(test.time.size), side="right") - 1, 0, turns.size - 2)
        distance = np.abs(test.displacement - test.displacement[turns[stroke]])
        residual = (test.force - fitted.force(test)) / test.scale
        inertia = np.gradient(test.velocity, test.time) / test.scale
        each = [residual, np.sign(test.velocity), np.abs(test.velocity), distance, inertia, np.full(residual.size, at)]
        # The first stroke begins at no reversal.
        columns.append(np.stack(each)[:, test.settled & (stroke > 0)])
    residual, sign, speed, distance, inertia, of_test = np.concatenate(columns, axis=1)
    if residual.size < BINS:
        return None
    residual = residual - np.mean(residual)
    distances, speeds = _bins(distance), _bins(speed)
    whole = float(np.sum(residual**2))
    after = sign * residual - _means(sign * residual, speeds)
    shares = {
        "gap": np.sum(_means(after, distances) ** 2) / whole,
        "hysteresis": (inertia @ residual) ** 2 / (inertia @ inertia) / whole,
        "frequency": np.sum(_means(after, len(fitted.tests) * speeds + of_test.astype(int)) ** 2) / whole,
        "asymmetry": np.sum(_means(residual, speeds) ** 2) / whole,
    }
    name = max(shares, key=lambda each: float(shares[each]))
    if shares[name] < LEAST:
        return None
    profile = np.array([np.mean(after[distances == number_of_bin]) for number_of_bin in range(BINS)])
    last = np.array([np.max(distance[distances == number_of_bin]) for number_of_bin in range(BINS)])
    return Missing(name, float(shares[name]), float(last[np.argmax(np.abs(np.diff(profile)))]))


def missing_text(fitted: FittedDamper) -> str:
    """Return a sentence on the missing mechanism; empty if none explains the rest of the force."""
    missing = missing_mechanism(fitted)
    if missing is None:
        return ""
    sentences = {
        "gap": f"jumps {number(1e3 * missing.distance, 2)} mm after each reversal: the law has no gap (backlash) there",
        "hysteresis": "follows the acceleration: the law has no hysteresis over the velocity, as of a compliance or of "
        "the inertia of the fluid",
        "frequency": "differs between the tests at equal speed: the law does not depend on frequency, amplitude or "
        "temperature",
        "asymmetry": "has the same sign in both directions: the law has no friction or curve that differs between bump "
        "and rebound",
    }
    share = number(100.0 * missing.share, 2)
    return f"what the law leaves of the force {sentences[missing.name]} ({share} % of it)"


def _bins(values: Vector) -> Indices:
    """Return the number of the bin of each value: `BINS` bins of equal numbers of values; (n,)."""
    order = np.argsort(values, kind="stable")
    bins = np.empty(values.size, dtype=np.intp)
    bins[order] = np.arange(values.size) * BINS // values.size
    return bins


def _means(values: Vector, groups: Indices) -> Vector:
    """Return the mean of the group of each value; (n,)."""
    counts = np.maximum(np.bincount(groups), 1)
    return np.asarray((np.bincount(groups, weights=values) / counts)[groups])
