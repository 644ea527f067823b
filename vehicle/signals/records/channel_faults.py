"""Detect faults of measured channels: clipped sensors, stuck sensors, constant ends, copied channels."""

from collections.abc import Container, Mapping, Sequence

import numpy as np

from vehicle.arrays import Mask, Vector
from vehicle.signals.formats.text import LARGEST
from vehicle.signals.records.finding import Finding

EQUAL = 1e-6
"""Maximum difference of equal samples over peak to peak [-]: single precision has seven digits."""

LEAST_CLIPPED = 5
"""Minimum number of samples at an extreme value for a clipped channel: rounding makes two samples of a random record
equal."""

NEIGHBOURHOOD = 0.05
"""Width of the band next to an extreme value, for the comparison of sample counts, in standard deviations."""

OUTWEIGHS = 2.0
"""Minimum ratio of samples at the extreme to samples in that band for a clipped channel [-]. A Gaussian record clipped
at three standard deviations has 6, at one standard deviation 13; a rounded sine without clipping has 1."""

NEXT_VALUES = 3
"""Number of values next to an extreme value whose samples are counted together: a rounded sine has as many at its
extreme as at the next three."""

SWITCHING = 0.6
"""Minimum share of the samples at the largest or smallest value of a channel that switches between both [-]. A Gaussian
record would have to be clipped at half of its standard deviation."""

RESTING = 0.5
"""Minimum share of the samples at the extreme value of a side at which a channel rests [-]: its median is no limit."""

LEAST_OF_TWO = 0.1
"""Minimum share of each of both values in their samples [-]; a record that rests at its smallest value has one side."""

CORNER = 0.25
"""Minimum ratio of the last step before the flat part to the RMS step for a clipped channel [-]: a physical plateau
begins with a small step, a clipped one at the speed of the motion."""

MOTIONS = ("displacement", "velocity", "acceleration", "angle", "angular velocity")
"""Quantities checked for faults."""

STUCK_PERIODS = 5.0
"""Minimum constant duration of a stuck channel, in mean intervals between crossings of the mean: in a Gaussian record
with a band of one octave, 1 of 1e4 intervals is longer."""

CERTAIN_PERIODS = 20.0
"""Constant duration of a stuck channel that is shorter than a pause, in the same intervals: in a record of the last
digits, whose intervals are distributed exponentially, 1 of 5e8 is longer."""

CERTAIN = 0.4
"""Constant duration that suffices for a stuck channel if it has five intervals [s]: a sensor stuck for half a second
repeats its value for a sample less than that."""

OUTLASTS = 5.0
"""Minimum number of samples of a constant part over those of the second longest one of the record [-], above which
`CERTAIN` suffices whatever the intervals. A motion of a few Hz is slow at its extremes, where rounding repeats a value:
the longest of such parts has at most 3.2 times the samples of the second longest in 2000 sound records."""

FIRST_STEPS = 3
"""Number of steps after or before a constant part for the test whether a motion is cut off."""

LEAST_CROSSINGS = 10
"""Minimum number of crossings of the mean of a motion that may be cut off: a bump begins and ends at rest."""

STEADY = 4.5
"""Maximum kurtosis of a steady motion [-]: 3 for a Gaussian one, 1.5 T / tau for a decay with tau in a time T."""

OTHERS_MOVE = 0.2
"""Minimum RMS of another channel in the constant part, over its RMS in the whole record, that counts as motion [-]."""


def faults(
    channels: Mapping[str, Vector], time: Vector, *, moving: Container[str] = (), rests: Container[str] = ()
) -> list[Finding]:
    """Return one finding for each clipped side and each constant part of the channels.

    For motion channels only: a friction force may be constant by nature.

    Args:
        channels: name to unfiltered samples, (n,).
        time: sample times [s], (n,).
        moving: names of channels on the same sensor or body, which stop moving at the same time.
        rests: names of channels that may begin at rest, for example the displacement of a plate.
    """
    findings, grouped = [], {name for name in channels if name in moving}
    # The squares of larger values overflow; their readers refuse them.
    channels = {name: values for name, values in channels.items() if float(np.max(np.abs(values))) <= LARGEST}
    for name, values in channels.items():
        for side, level, share in clipped(values):
            findings.append(
                Finding(
                    f"{name}: clipped? {100.0 * share:.3g} % of the samples are at the {side}, {level:.3g}, so "
                    "peaks, RMS and spectra are wrong; measure with a larger range, or select another part (--from, "
                    "--to)",
                    "clipped",
                )
            )
        others = [other for channel, other in channels.items() if channel != name and {channel, name} <= grouped]
        interval = stuck(values, time, others, from_rest=name in rests)
        if interval is not None:
            begin, end = interval
            first = begin - time[0] >= time[-1] - end
            options = ("--to", f"{begin:.9g}") if first else ("--from", f"{end:.9g}")
            findings.append(
                Finding(
                    f"{name}: constant from {begin:.4g} to {end:.4g} s: a stuck sensor or a pause? It counts in all "
                    f"mean values; {' '.join(options)} selects the part {'before' if first else 'after'} it",
                    "constant",
                    options,
                )
            )
    return findings


def clipped(values: Vector) -> list[tuple[str, float, float]]:
    """Return the clipped sides of samples (n,): "largest value" or "smallest value", that value, share of the samples.

    The time for which a smooth signal is within d of its extreme falls to zero with d; that of a clipped signal does
    not. So a side is clipped if more samples are at its extreme value than in the band next to it, and than at the next
    values together: in a sine of a whole number of samples, or after rounding, all values are repeated. The flat parts
    must begin and end at the speed of the motion. A side that is flat most of the time, or for longer at an end of the
    record than anywhere else, is at rest there, and a channel that switches between two values is no clipped one.
    """
    spread, span = float(np.std(values)), float(np.ptp(values))
    steps = np.diff(values)
    moving = steps[steps != 0.0]
    if not (span > 0.0 and moving.size) or switches(values):
        return []
    pace = float(np.sqrt(np.mean(moving**2)))
    sides = []
    for side, sign in (("largest value", 1.0), ("smallest value", -1.0)):
        level = float(np.max(sign * values))
        below = level - sign * values
        at_extreme = below <= EQUAL * span
        count = int(np.count_nonzero(at_extreme))
        nearby = int(np.count_nonzero(below <= NEIGHBOURHOOD * spread)) - count
        if count < LEAST_CLIPPED or count < OUTWEIGHS * max(nearby, _at_next_values(below, EQUAL * span)):
            continue
        edges = _edges(values, at_extreme)
        if not edges.size or count >= RESTING * values.size or _at_rest(at_extreme):
            continue
        if float(np.median(edges)) >= CORNER * pace:
            sides.append((side, sign * level, count / values.size))
    return sides


def switches(values: Vector) -> bool:
    """Return True for samples (n,) at their largest or smallest value most of the time: a square wave."""
    low, high = float(np.min(values)), float(np.max(values))
    margin = EQUAL * (high - low)
    ends = [float(np.mean(values >= high - margin)), float(np.mean(values <= low + margin))]
    return min(ends) > 0.0 and sum(ends) >= SWITCHING and min(ends) >= LEAST_OF_TWO * sum(ends)


def _at_next_values(below: Vector, margin: float) -> int:
    """Return the number of samples at the next three values of a side."""
    count = 0
    for _ in range(NEXT_VALUES):
        beyond = below[below > margin]
        if not beyond.size:
            break
        nearest = float(np.min(beyond))
        at_value = (beyond >= nearest) & (beyond <= nearest + margin)
        count += int(np.count_nonzero(at_value))
        below = beyond[~at_value]
    return count


def _edges(values: Vector, at_extreme: Mask) -> Vector:
    """Return the size of the second-last step before each flat part and after it; clipping shortens the last one."""
    # Index of the last sample before a flat part, and of the last sample within one.
    entered = np.flatnonzero(at_extreme[2:] & ~at_extreme[1:-1]) + 1
    left = np.flatnonzero(at_extreme[:-2] & ~at_extreme[1:-1])
    return np.concatenate([np.abs(values[entered] - values[entered - 1]), np.abs(values[left + 2] - values[left + 1])])


def _at_rest(at_extreme: Mask) -> bool:
    """Return True if the longest flat part is at the beginning or the end of the record."""
    # Begins and ends of the flat parts alternate.
    changes = np.flatnonzero(np.diff(at_extreme.astype(np.int8), prepend=0, append=0))
    begins, ends = changes[::2], changes[1::2]
    at_ends = (begins == 0) | (ends == at_extreme.size)
    lengths = ends - begins
    return bool(np.max(lengths, where=at_ends, initial=0) >= np.max(lengths, where=~at_ends, initial=0))


def stuck(
    values: Vector, time: Vector, others: Sequence[Vector] = (), *, from_rest: bool = False
) -> tuple[float, float] | None:
    """Return begin and end [s] of the longest implausibly constant part of a channel; None without such a part.

    A constant beginning or end is accepted where the motion begins or ends smoothly, unless another channel moves at
    the end. A channel that switches between two values is not judged.

    Args:
        values: samples, (n,).
        time: sample times [s], (n,).
        others: other channels of the record, (n,) each.
        from_rest: the channel may begin at rest.
    """
    away = values - values.mean()
    # Neighbours of opposite sign.
    crossings = int(np.count_nonzero(away[1:] * away[:-1] < 0.0))
    if crossings < 2 or switches(values):
        return None
    part = constant_part(values)
    moves = np.flatnonzero(np.diff(values) != 0.0)  # not empty, as it crosses its mean
    rested = [(0, int(moves[0])), (int(moves[-1]) + 1, values.size - 1)]
    candidates = [part] if part is not None else []
    motion = values[rested[0][1] : rested[1][0] + 1]
    if not from_rest and _abrupt(motion, crossings):
        candidates.append(rested[0])
    if _abrupt(motion[::-1], crossings) or any(
        float(np.std(other[rested[1][0] :])) > OTHERS_MOVE * float(np.std(other)) > 0.0 for other in others
    ):
        candidates.append(rested[1])
    if not candidates:
        return None
    begin, end = max(candidates, key=lambda part_bounds: float(time[part_bounds[1]] - time[part_bounds[0]]))
    length = float(time[end] - time[begin])
    unmoved = {*rested, (begin, end)}
    moving = float(time[-1] - time[0]) - sum(float(time[last] - time[first]) for first, last in unmoved)
    # Mean time between two crossings while the channel moves.
    interval = max(moving, 0.0) / crossings
    minimum = max(STUCK_PERIODS * interval, min(CERTAIN, CERTAIN_PERIODS * interval))
    ends = np.concatenate([[-1], moves, [values.size - 1]])
    if end + 1 - begin >= OUTLASTS * np.sort(np.diff(ends))[-2]:  # of all constant parts, the ends included
        minimum = min(minimum, CERTAIN)
    return (float(time[begin]), float(time[end])) if length >= minimum else None


def _abrupt(motion: Vector, crossings: int) -> bool:
    """Return True if a motion (n,) with this number of crossings of the mean begins at the speed of the whole motion.

    Its first steps decide, which are small where a machine starts or a bump begins. In a steady motion, which has no
    single event, those of the first period decide as well: a sensor may freeze at an extreme value.
    """
    if crossings < LEAST_CROSSINGS:
        return False
    steps = np.diff(motion)
    pace = float(np.sqrt(np.mean(steps**2)))
    first, period = (
        float(np.sqrt(np.mean(steps[:count] ** 2))) for count in (FIRST_STEPS, 1 + 2 * motion.size // crossings)
    )
    squares = (motion - motion.mean()) ** 2
    steady = float(np.mean(squares**2)) < STEADY * float(np.mean(squares)) ** 2
    return first >= CORNER * pace or (steady and period >= CORNER * pace)


def constant_part(values: Vector) -> tuple[int, int] | None:
    """Return first and last index of the longest constant part of samples (n,) between two motions, or None."""
    moves = np.flatnonzero(np.diff(values) != 0.0)
    if moves.size < 2:
        return None
    longest = int(np.argmax(moves[1:] - moves[:-1]))
    return int(moves[longest]) + 1, int(moves[longest + 1])


def copies(channels: Mapping[str, Vector]) -> list[tuple[str, str]]:
    """Return the pairs of channels (name to samples, (n,)) with identical samples except for sign and offset."""
    moving = {name: values - values.mean() for name, values in channels.items() if np.ptp(values) > 0.0}
    names = list(moving)
    return [
        (first, second)
        for number, second in enumerate(names)
        for first in names[:number]
        if any(
            np.allclose(moving[first], sign * moving[second], rtol=0.0, atol=EQUAL * float(np.ptp(moving[first])))
            for sign in (1.0, -1.0)
        )
    ]
