"""Recognise time stamps that are not the times of the samples, and estimate the sampling rate of the record.

A logger that reads its samples in batches, alternates between two delays, or writes whole seconds gives stamps whose
steps are not those of the samples. The clock of the samples is then known from their number over the span alone:

    t_k = t_0 + k / f + e_k,    e_k bounded and repeated, or bounded by the unit of the stamps.
"""

from typing import NamedTuple

import numpy as np
import scipy

from vehicle.arrays import Vector

LONGEST_PATTERN = 1000
"""Maximum number of samples of a repeated pattern."""

REPEATS = 4
"""Minimum number of repeats of a pattern in a record."""

SAME = 1e-3
"""Maximum difference of equal steps, over the mean step [-]."""

LOST_SHARE = 0.25
"""Maximum share of steps over a lost sample [-]; with more, stamps are rounded."""

SMALL_STEP = 0.25
"""Maximum step within a batch, over the mean step [-]."""

BATCHED_SHARE = 0.5
"""Minimum share of steps within batches [-]; for repeated stamps a tenth of it: fewer are rows that were written
twice."""

SHORTEST_PAUSE = 0.01
"""Minimum step that can be a pause between batches [s]: half a period of 50 Hz."""

LOST_BATCH = 2.5
"""Minimum step between batches, over the median step between batches, that indicates a lost batch [-]."""


ROUNDED_SHARE = 0.05
"""Minimum share of steps that a coarse unit makes longer or shorter than the most common step [-]."""


class StampClock(NamedTuple):
    """Clock of samples whose stamps are not the times of the samples.

    Attributes:
        rate: sampling rate [Hz], the roundest number within the limits.
        lowest, highest: limits of the rate [Hz].
        reason: description of the stamps.
    """

    rate: float
    lowest: float
    highest: float
    reason: str

    @property
    def option(self) -> str:
        """Value of the option --rate."""
        return f"{self.rate:.9g}"

    @property
    def remedy(self) -> str:
        """Return a description of the stamps, with the option to replace them."""
        limits = "" if self.lowest == self.highest else f" ({self.lowest:.4g} to {self.highest:.4g} Hz fit)"
        return (
            f"time stamps {self.reason}: not the times of the samples; if these are uniform, set --rate {self.option}, "
            f"the mean rate{limits}"
        )


def stamp_clock(time: Vector) -> StampClock | None:
    """Return the clock of the samples if the stamps repeat a pattern, come in batches, or have a coarse unit.

    Args:
        time: stamps that are neither uniform nor those of a finely rounded clock [s], (n,).

    Returns:
        The clock; None if the stamps decrease, or may be the true times of the samples.
    """
    if time.size < 2 * REPEATS or not np.isfinite(time).all():
        return None
    steps = np.diff(time)
    if steps.min() < 0.0 or not time[-1] > time[0]:
        return None
    if _lost_samples(steps):
        return None
    return _pattern(time, steps) or _coarse_unit(time, steps) or _batches(time, steps)


def _pattern(time: Vector, steps: Vector) -> StampClock | None:
    """Return the clock p / D of steps that repeat after p samples: t_(k+p) - t_k = D for all k."""
    tolerance = SAME * float(steps.mean())
    longest = min(LONGEST_PATTERN, steps.size // REPEATS)
    periods = np.arange(2, longest + 1)
    for first in range(min(REPEATS, steps.size - longest)):  # few periods are left after a few steps
        periods = periods[np.abs(steps[first + periods] - steps[first]) <= tolerance]
    for period in periods.tolist():
        if np.max(np.abs(steps[period:] - steps[:-period])) > tolerance:
            continue
        spans = time[period:] - time[:-period]
        length = float(spans.mean())
        if np.ptp(spans) > tolerance:
            return None
        rate = period / length
        rate = float(round(rate)) if abs(rate - round(rate)) < 1e-6 * rate else rate
        reason = f"repeat a pattern of {period} samples, with steps of {steps.min():.4g} to {steps.max():.4g} s"
        return StampClock(rate, rate, rate, reason)
    return None


def _lost_samples(steps: Vector) -> bool:
    """Return True if all steps are the median step or, up to `LOST_SHARE` of them, twice it: true times."""
    median = float(np.median(steps))
    multiples = steps / median if median > 0.0 else np.zeros(1)
    whole = np.abs(multiples - np.rint(multiples)) < 0.05
    return bool(
        whole.all() and multiples.min() > 0.5 and multiples.max() < 2.5 and np.mean(multiples > 1.5) < LOST_SHARE
    )


def _coarse_unit(time: Vector, steps: Vector) -> StampClock | None:
    """Return the clock of stamps in a unit q: all t_k - k / f lie within one q, and all steps are multiples of q."""
    unit = _unit(time)
    if unit is None:
        return None
    multiples, counts = np.unique(np.rint(steps / unit), return_counts=True)
    if multiples[np.argmax(counts)] > 0.0 and counts.max() > (1.0 - ROUNDED_SHARE) * steps.size:
        return None  # few other steps may be lost samples, or rows that were written twice
    count = np.arange(time.size)

    def excess(step: float) -> float:
        return float(np.ptp(time - count * step)) - (1.0 + SAME) * unit

    half = 2.0 * unit / (time.size - 1)
    best = smallest_spread(time, unit)
    if excess(best) > 0.0 or best - 2.0 * half <= 0.0:
        return None
    # The spread is convex in the step, and one unit more than the best at a distance of unit / (n - 1).
    shortest, longest = (float(scipy.optimize.brentq(excess, best, best + sign * 2.0 * half)) for sign in (-1.0, 1.0))
    return _round_clock(1.0 / best, 1.0 / longest, 1.0 / shortest, f"are written in units of {unit:.4g} s")


def smallest_spread(time: Vector, unit: float) -> float:
    """Return the step T [s] of the clock with the smallest spread of t_k - k T, for stamps (n,) written in a unit [s].

    The spread is convex in T, and T is within one unit / (n - 1) of the mean step. The deviation from the mean step is
    the unknown: a search in T itself ends at the rounding error of T.
    """
    last = time.size - 1
    count = np.arange(time.size) / last
    mean = float(time[-1] - time[0]) / last
    residual = (time - time[0] - mean * np.arange(time.size)) / unit
    best = scipy.optimize.minimize_scalar(
        lambda trial: np.ptp(residual - count * trial), bounds=(-2.0, 2.0), options={"xatol": 1e-6}
    )
    return mean + float(best.x) * unit / last


def _unit(time: Vector) -> float | None:
    """Return the largest decimal or multiple of a decimal [s] of which all stamps are multiples; None below 1 us."""
    for decimals in range(7):
        counts = (time - time[0]) * 10.0**decimals
        if np.max(np.abs(counts - np.rint(counts))) < 0.01:  # tolerance for floating-point error
            return float(np.gcd.reduce(np.rint(np.diff(counts)).astype(np.int64))) / 10.0**decimals
    return None


def _batches(time: Vector, steps: Vector) -> StampClock | None:
    """Return the clock of samples in batches: number of samples over span, from the first batch to the last."""
    small = steps < SMALL_STEP * float(steps.mean())
    share = float(np.mean(small))
    if share < BATCHED_SHARE and float(np.mean(steps == 0.0)) < 0.1 * BATCHED_SHARE:
        return None
    starts = np.concatenate([[0], np.flatnonzero(~small) + 1])
    if starts.size < 2 * REPEATS:
        return None
    between = np.diff(time[starts])
    rate = float(starts[-1]) / float(time[starts[-1]] - time[0])
    away = float(np.ptp(time[starts] - starts / rate))
    typical = float(np.median(between))
    longest = max(LOST_BATCH * typical, SHORTEST_PAUSE)
    if between.max() > longest or away > longest:
        return None
    limit = float(between.max()) / float(time[starts[-1]] - time[0])
    reason = f"come in batches of about {round(time.size / starts.size)}" if share >= BATCHED_SHARE else "are repeated"
    return _round_clock(rate, rate * (1.0 - limit), rate * (1.0 + limit), reason)


def _round_clock(rate: float, lowest: float, highest: float, reason: str) -> StampClock:
    """Return the clock with the number of fewest digits within the limits of the rate."""
    digits = next((n for n in range(1, 9) if lowest <= float(f"{rate:.{n}g}") <= highest), 9)
    return StampClock(float(f"{rate:.{digits}g}"), lowest, highest, reason)
