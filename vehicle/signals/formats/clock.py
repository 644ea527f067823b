"""Check time stamps: increasing, uniform, or rounded from a uniform clock; suggest options for other times."""

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.stamps import StampClock, smallest_spread, stamp_clock
from vehicle.signals.formats.table import Table

PAUSE = 0.5
"""Minimum length [s] of a time step, or of a part without motion, that counts as a pause of the record."""

LONGEST_GAP = 0.010
"""Maximum gap [s] bridged by interpolation: half a period of 50 Hz."""

UNIFORM_TOLERANCE = 1e-3
"""Maximum |dt - median dt| / median dt of a uniform record [-]."""

FLOAT_ERROR, MANY = 0.3, 50
"""Maximum difference from a decimal [last digits] in a record of at least so many stamps: microseconds since 1970 are
stored to 0.24 us, and stamps that are no decimals reach 0.5."""

LARGEST_QUANTUM = 0.25
"""Maximum unit of the last decimal of rounded time stamps over the time step [-]: limit of an identifiable clock."""


def check_increasing(table: Table, time: Vector) -> None:
    """Reject repeated or decreasing times [s], shape (n,); the message names the first faulty row of the table."""
    steps = np.diff(time)
    if (steps > 0.0).all():
        return
    row = int(np.flatnonzero(steps <= 0.0)[0]) + 1
    relation = "repeats" if steps[row - 1] == 0.0 else "is before"
    raise DataError(
        f"{table.place(row)}: time {time[row]:.9g} s {relation} {time[row - 1]:.9g} s of {table.row(row - 1)}; times "
        "must increase from row to row; were two logs concatenated?"
    )


def check_uniform(table: Table, time: Vector, remedy: str = "resample it to uniform steps") -> None:
    """Reject time steps that deviate from the median step by more than `UNIFORM_TOLERANCE`.

    Raises:
        DataError: a pause or times that are not uniform; the message names the row of the largest deviation.
    """
    worst, row = _worst_step(time)
    step = time[row] - time[row - 1]
    if worst > UNIFORM_TOLERANCE and step >= PAUSE:
        raise DataError(
            f"{table.place(row)}: the record has a gap of {step:.3g} s, from {time[row - 1]:.9g} to {time[row]:.9g} s, "
            "which is not filled; use the part before or after it"
        )
    if worst > UNIFORM_TOLERANCE:
        raise DataError(
            f"{table.place(row)}: time steps are not uniform: {step:.6g} s deviates from the median "
            f"{float(np.median(np.diff(time))):.6g} s by the factor {worst:.3g}, which must be at most "
            f"{UNIFORM_TOLERANCE:g}; write the time with more digits, or {remedy}"
        )


def without_rounding(time: Vector) -> tuple[Vector, tuple[str, ...]]:
    """Replace rounded, increasing stamps [s], (n,), by those of their clock, with a notice; others are unchanged."""
    clock = None if is_uniform(time) else clock_of_rounded(time)
    if clock is None:
        return time, ()
    notice = f"time stamps are rounded to {clock[1]} decimals; the sampling rate is assumed to be {clock[0]:.9g} Hz"
    return time[0] + np.arange(time.size) / clock[0], (notice,)


def clock_of_rounded(time: Vector) -> tuple[float, int] | None:
    """Estimate the clock of time stamps that were rounded or truncated to a fixed number of decimals.

    t_k = t_0 + k / f + e_k with e_k within one unit q of the last decimal, for all k: 2048 Hz written with six decimals
    has steps of 488 and 489 us. Return a whole number f if it fits, else the clock with the smallest spread.

    Returns:
        Rate f [Hz] and number of decimals; None if no clock fits or q exceeds `LARGEST_QUANTUM` steps.
    """
    count = np.arange(time.size)
    for decimals in range(2, 10):
        digits = (time - time[0]) * 10.0**decimals
        error = float(np.max(np.abs(digits - np.rint(digits))))
        if error < (FLOAT_ERROR if decimals == 6 and time.size >= MANY else 0.01):
            break
    else:
        return None
    quantum = 10.0**-decimals
    time = np.rint(digits) * quantum
    step = float(time[-1] - time[0]) / (time.size - 1)
    if quantum > LARGEST_QUANTUM * step:
        return None
    for rate in (float(round(1.0 / step)), 1.0 / smallest_spread(time, quantum)):
        if rate > 0.0 and np.ptp(time - count / rate) <= (1.0 + 1e-3 + 4.0 * error) * quantum:
            return rate, decimals
    return None


def clock_of_stamps(time: Vector) -> StampClock | None:
    """Return the clock of samples whose stamps [s], (n,), hide it, see `stamp_clock`; None for usable stamps."""
    steps = np.diff(time)
    if steps.size < 2 or ((steps > 0.0).all() and (is_uniform(time) or clock_of_rounded(time) is not None)):
        return None
    return stamp_clock(time)


def check_stamps(where: object, time: Vector) -> None:
    """Reject stamps that are not the times of the samples; the message contains the rate."""
    clock = clock_of_stamps(time)
    if clock is not None:
        raise DataError(f"{where}: {clock.remedy}")


def typical_rate(time: Vector) -> float:
    """Return the sampling rate [Hz] of jittered, increasing times [s], (n,): number of samples over their span.

    Steps of twice the median are those over a lost sample; they are left out if there are no other long steps.
    """
    steps = np.diff(time)
    multiples = steps / float(np.median(steps))
    long = multiples > 1.5
    lost = bool(np.all(np.abs(multiples[long] - 2.0) < 0.25)) and float(np.mean(long)) < 0.5
    return 1.0 / float(np.mean(steps[~long] if lost else steps))


def is_uniform(time: Vector) -> bool:
    """Return True if `check_uniform` accepts the time stamps."""
    return _worst_step(time)[0] <= UNIFORM_TOLERANCE


def _worst_step(time: Vector) -> tuple[float, int]:
    steps = np.diff(time)
    median = float(np.median(steps))
    deviation = np.abs(steps - median) / median
    row = int(np.argmax(deviation))
    return float(deviation[row]), row + 1


def time_remarks(time: Vector) -> tuple[str, ...]:
    """Return messages on irregular times [s], (n,): rounded, not increasing, pauses, gaps, jitter; with remedies."""
    steps = np.diff(time)
    if steps.size < 2:
        return ()
    stamps = clock_of_stamps(time)
    if stamps is not None:
        return (stamps.remedy,)
    remedy = " ".join(clock_options(time))
    if not np.isfinite(time).all() or not (steps > 0.0).all():
        at = int(np.flatnonzero(~(steps > 0.0))[0])
        repeats = bool((steps >= 0.0).all())
        cure = "set --rate HZ if the samples are uniform" if repeats else "split the file there"
        cure = f"set {remedy} for the longest increasing part" if remedy else cure
        return (f"times do not increase after {time[at]:.9g} s: {cure}",)
    median = float(np.median(steps))
    gaps = np.flatnonzero(steps > longest_gap(median) * (1.0 + UNIFORM_TOLERANCE))
    shown = ", ".join(f"{time[at]:.9g} to {time[at + 1]:.9g} s" for at in gaps[:4])
    if gaps.size:
        word = "pause" if float(steps.max()) > longest_step(median) else "gap"
        plural = "s" if gaps.size > 1 else ""
        return (f"{gaps.size} {word}{plural}: {shown}; set {remedy} for the longest part without gaps",)
    rounded = without_rounding(time)[1]
    if rounded or is_uniform(time):
        return rounded
    return (
        f"times are not uniform: steps of {steps.min():.3g} to {steps.max():.3g} s; set {remedy}, or --rate HZ if only "
        "the time stamps are irregular",
    )


def clock_options(time: Vector) -> tuple[str, ...]:
    """Return the command options that make a record with these times [s], (n,), readable; () for uniform times.

    --from and --to select the longest part without a gap; --resample at the rate of the samples removes jitter; --rate
    replaces stamps that are not the times of the samples.
    """
    steps = np.diff(time)
    if steps.size < 2 or not (steps > 0.0).any():
        return ()
    stamps = clock_of_stamps(time)
    if stamps is not None:
        return ("--rate", stamps.option)
    limit = longest_gap(float(np.median(steps[steps > 0.0]))) * (1.0 + UNIFORM_TOLERANCE)
    ends = np.concatenate([[0], np.flatnonzero(~((steps > 0.0) & (steps <= limit))) + 1, [time.size]])
    part = int(np.argmax(np.diff(ends)))
    longest = time[ends[part] : ends[part + 1]]
    if longest.size < 3:
        return ()
    cut: tuple[str, ...] = ()
    if longest.size < time.size:
        others = np.concatenate([time[: ends[part]], time[ends[part + 1] :]])
        longest = _without(longest, others[np.isfinite(others)])
        if longest.size < 3:
            return ()  # another part of the file has equal times
        cut = ("--from", f"{longest[0]:.9g}", "--to", f"{longest[-1]:.9g}")
    if is_uniform(longest) or clock_of_rounded(longest) is not None:
        return cut
    rate = typical_rate(longest)
    return (*cut, "--resample", f"{round(rate)}" if rate >= 20.0 else f"{rate:.3g}")


def _without(part: Vector, others: Vector) -> Vector:
    """Return the longest piece of increasing times, (n,), without other times of the file between its ends."""
    inside = np.unique(others[(others >= part[0]) & (others <= part[-1])])
    begins = np.concatenate([[0], np.searchsorted(part, inside, "right")])
    ends = np.concatenate([np.searchsorted(part, inside, "left"), [part.size]])
    longest = int(np.argmax(ends - begins))
    return part[begins[longest] : ends[longest]]


def longest_step(median: float) -> float:
    """Return the maximum step [s] without a pause, for a median step [s]: two missing samples, or half a second."""
    return max(2.5 * median, min(PAUSE, 100.0 * median))


def longest_gap(timestep: float) -> float:
    """Return the maximum distance of two samples [s] for interpolation: `LONGEST_GAP`, or one missing sample.

    One missing sample gives a step of 2 T, two give 3 T; 2.5 T allows for jitter.
    """
    return max(LONGEST_GAP, 2.5 * timestep)
