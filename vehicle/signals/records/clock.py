"""The time stamps of a table: increasing, uniform, or a uniform clock that was rounded."""

from __future__ import annotations

import numpy as np
import scipy

from vehicle.errors import DataError
from vehicle.signals.records.table import Table, Vector

PAUSE = 0.5
"""A step of the time, or a stretch without motion, from this length on is a pause of the record [s]."""

LONGEST_GAP = 0.010
"""Longest gap [s] that is interpolated over: half a period of 50 Hz."""

UNIFORM_TOLERANCE = 1e-3
"""Largest |dt - median dt| / median dt of a uniform record [-]."""

LARGEST_QUANTUM = 0.25
"""Largest last digit of rounded time stamps that still tells a clock, as a share of its step [-]."""


def check_increasing(table: Table, time: Vector) -> None:
    """Refuse repeated or decreasing time [s], shape (n,), naming the first offending row of the table."""
    steps = np.diff(time)
    if (steps > 0.0).all():
        return
    row = int(np.flatnonzero(steps <= 0.0)[0]) + 1
    what = "repeats" if steps[row - 1] == 0.0 else "goes back behind"
    raise DataError(
        f"{table.place(row)}: time {time[row]:.9g} s {what} the time {time[row - 1]:.9g} s of {table.row(row - 1)}; "
        "time must increase from row to row; were two logs put behind each other?"
    )


def check_uniform(table: Table, time: Vector, remedy: str = "resample it to uniform steps") -> None:
    """Refuse steps that deviate from the median step by more than `UNIFORM_TOLERANCE`, naming the worst row.

    Args:
        table: for messages.
        time: increasing times [s], shape (n,).
        remedy: what else to do about it, for messages.

    Raises:
        DataError: the record pauses, or its time is not uniform.
    """
    worst, row = _worst_step(time)
    step = time[row] - time[row - 1]
    if worst > UNIFORM_TOLERANCE and step >= PAUSE:
        raise DataError(
            f"{table.place(row)}: the record pauses for {step:.6g} s, from {time[row - 1]:.9g} to {time[row]:.9g} s; "
            "nothing is filled in; use the part before or after it"
        )
    if worst > UNIFORM_TOLERANCE:
        raise DataError(
            f"{table.place(row)}: time is not uniform: the step of {step:.9g} s deviates by {worst:.3g} of the median "
            f"step {float(np.median(np.diff(time))):.9g} s; allowed {UNIFORM_TOLERANCE:g}; write the time with more "
            f"digits, or {remedy}"
        )


def without_rounding(time: Vector) -> tuple[Vector, tuple[str, ...]]:
    """Times of the clock behind rounded time stamps, shape (n,), with a notice; else the times as they are.

    Args:
        time: increasing times [s], shape (n,).
    """
    clock = None if is_uniform(time) else clock_of_rounded(time)
    if clock is None:
        return time, ()
    notice = f"time stamps are rounded to {clock[1]} decimals: taken as a clock of {clock[0]:.9g} Hz"
    return time[0] + np.arange(time.size) / clock[0], (notice,)


def clock_of_rounded(time: Vector) -> tuple[float, int] | None:
    """The clock behind time stamps that were rounded, or cut, to a fixed number of decimals.

    t_k = t_0 + k / f + e_k with e_k within one unit q of the last decimal, for all k: 2048 Hz written with six decimals
    has steps of 488 and 489 us. A whole number f that fits is taken, else the clock with the least spread.

    Args:
        time: increasing times [s], shape (n,).

    Returns:
        Rate f [Hz] and number of decimals; None where no clock fits, or q is more than `LARGEST_QUANTUM` steps.
    """
    count = np.arange(time.size)
    step = float(time[-1] - time[0]) / (time.size - 1)
    for decimals in range(2, 10):
        digits = (time - time[0]) * 10.0**decimals
        if np.max(np.abs(digits - np.rint(digits))) < 0.01:  # what binary numbers leave of decimal ones
            break
    else:
        return None
    quantum = 10.0**-decimals
    if quantum > LARGEST_QUANTUM * step:
        return None
    # The spread about a clock is convex in its step; the step that is sought lies within q / T of the mean one.
    reach = quantum / (time.size - 1)
    best = scipy.optimize.minimize_scalar(
        lambda one: np.ptp(time - count * one), bounds=(step - reach, step + reach), options={"xatol": 1e-6 * reach}
    )
    for rate in (float(round(1.0 / step)), 1.0 / float(best.x)):
        if rate > 0.0 and np.ptp(time - count / rate) <= (1.0 + 1e-3) * quantum:
            return rate, decimals
    return None


def is_uniform(time: Vector) -> bool:
    """Tell whether `check_uniform` accepts the time stamps."""
    return _worst_step(time)[0] <= UNIFORM_TOLERANCE


def _worst_step(time: Vector) -> tuple[float, int]:
    steps = np.diff(time)
    median = float(np.median(steps))
    deviation = np.abs(steps - median) / median
    row = int(np.argmax(deviation))
    return float(deviation[row]), row + 1


def time_remarks(time: Vector) -> tuple[str, ...]:
    """Return sentences on irregular times: rounded, not increasing, pauses, gaps, jitter; each with the remedy.

    Args:
        time: times of a channel [s], shape (n,).
    """
    steps = np.diff(time)
    if steps.size < 2:
        return ()
    remedy = " ".join(clock_options(time))
    if not np.isfinite(time).all() or not (steps > 0.0).all():
        at = int(np.flatnonzero(~(steps > 0.0))[0])
        cure = f"set {remedy} for the longest increasing part" if remedy else "split the file there"
        return (f"times do not increase behind {time[at]:.9g} s: {cure}",)
    median = float(np.median(steps))
    gaps = np.flatnonzero(steps > longest_gap(median) * (1.0 + UNIFORM_TOLERANCE))
    shown = ", ".join(f"{time[at]:.9g} to {time[at + 1]:.9g} s" for at in gaps[:4])
    if gaps.size:
        word = "pause" if float(steps.max()) > longest_step(median) else "gap"
        plural = "s" if gaps.size > 1 else ""
        return (f"{gaps.size} {word}{plural}: {shown}; set {remedy} for the longest part without",)
    rounded = without_rounding(time)[1]
    if rounded or is_uniform(time):
        return rounded
    return (
        f"times are not uniform: steps of {steps.min():.6g} to {steps.max():.6g} s; set {remedy}, or --rate HZ if the "
        "samples are uniform and their stamps are not",
    )


def clock_options(time: Vector) -> tuple[str, ...]:
    """Return the options with which every command takes a record of these times; none for uniform times.

    The longest part without a gap is cut out by --from and --to; jittered times are made uniform by --resample at the
    rate of the median step.

    Args:
        time: times of a channel [s], shape (n,).
    """
    steps = np.diff(time)
    if steps.size < 2 or not (steps > 0.0).any():
        return ()
    limit = longest_gap(float(np.median(steps[steps > 0.0]))) * (1.0 + UNIFORM_TOLERANCE)
    ends = np.concatenate([[0], np.flatnonzero(~((steps > 0.0) & (steps <= limit))) + 1, [time.size]])
    part = int(np.argmax(np.diff(ends)))
    kept = time[ends[part] : ends[part + 1]]
    if kept.size < 3:
        return ()
    cut: tuple[str, ...] = ()
    if kept.size < time.size:
        first, last = f"{kept[0]:.9g}", f"{kept[-1]:.9g}"
        inside = np.flatnonzero((time >= float(first)) & (time <= float(last)))
        if np.any(np.diff(inside) != 1) or inside[0] < ends[part] or inside[-1] >= ends[part + 1]:
            return ()  # another part of the file has the same times
        cut = ("--from", first, "--to", last)
    if is_uniform(kept) or clock_of_rounded(kept) is not None:
        return cut
    rate = 1.0 / float(np.median(np.diff(kept)))
    return (*cut, "--resample", f"{round(rate)}" if rate >= 20.0 else f"{rate:.3g}")


def longest_step(median: float) -> float:
    """Step [s] beyond which a record of this median step [s] pauses: two samples are missing, or half a second."""
    return max(2.5 * median, min(PAUSE, 100.0 * median))


def longest_gap(timestep: float) -> float:
    """Return the longest distance of two samples that is interpolated over [s]: `LONGEST_GAP`, or one missing sample.

    One missing sample makes a step of 2 T, two make 3 T; 2.5 T leaves room for jitter.

    Args:
        timestep: median sampling interval [s].
    """
    return max(LONGEST_GAP, 2.5 * timestep)
