"""Detect faults of measured channels: clipped sensors, stuck sensors, copied channels."""

from __future__ import annotations

from collections.abc import Container, Mapping

import numpy as np

from vehicle.signals.records.clock import PAUSE
from vehicle.signals.records.table import Vector
from vehicle.signals.records.text import LARGEST

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

CORNER = 0.25
"""Minimum ratio of the last step before the flat part to the RMS step for a clipped channel [-]: a physical plateau
begins with a small step, a clipped one at the speed of the motion."""

MOTIONS = ("displacement", "velocity", "acceleration", "angle", "angular velocity")
"""Quantities checked for faults."""

STUCK_PERIODS = 5.0
"""Minimum constant duration of a stuck channel, in mean intervals between crossings of the mean: in a Gaussian record
with a band of one octave, 1 of 1e4 intervals is longer."""

OTHERS_MOVE = 0.2
"""Minimum RMS of another channel in the constant part, over its RMS in the whole record, that counts as motion [-]."""


def faults(
    channels: Mapping[str, Vector], time: Vector, *, moving: Container[str] = (), remedy: str = "--from S and --to S"
) -> list[str]:
    """Return one message for each clipped side and each constant part of the channels.

    For motion channels only: a friction force may be constant by nature.

    Args:
        channels: name to unfiltered samples, (n,).
        time: sample times [s], (n,).
        moving: names of channels on the same sensor or body, which stop moving at the same time.
        remedy: options that cut a part out of the record, for the messages.
    """
    messages, grouped = [], {name for name in channels if name in moving}
    # The squares of larger values overflow; their readers refuse them.
    channels = {name: values for name, values in channels.items() if float(np.max(np.abs(values))) <= LARGEST}
    for name, values in channels.items():
        for side, level, share in clipped(values):
            messages.append(
                f"{name}: clipped? {100.0 * share:.3g} % of the samples are equal to the {side}, {level:.4g}, with "
                "sharp edges: its peaks, RMS and spectra are wrong; measure with a larger range, or select an "
                f"unclipped part ({remedy})"
            )
        others = [other for channel, other in channels.items() if channel != name and {channel, name} <= grouped]
        interval = stuck(values, time, others)
        if interval is not None:
            begin, end = interval
            messages.append(
                f"{name}: constant for {end - begin:.4g} s, from {begin:.6g} to {end:.6g} s: a stuck sensor "
                f"or a pause? Every mean includes it; select the part before or after it ({remedy})"
            )
    return messages


def clipped(values: Vector) -> list[tuple[str, float, float]]:
    """Return the clipped sides of a channel: "largest value" or "smallest value", that value, share of the samples.

    A side is clipped if more samples are at its extreme value than in the band next to it, and if the flat parts
    begin and end at the speed of the motion.

    Args:
        values: samples, (n,).
    """
    spread, span = float(np.std(values)), float(np.ptp(values))
    steps = np.diff(values)
    moving = steps[steps != 0.0]
    if not (span > 0.0 and moving.size):
        return []
    pace = float(np.sqrt(np.mean(moving**2)))
    sides = []
    for side, sign in (("largest value", 1.0), ("smallest value", -1.0)):
        level = float(np.max(sign * values))
        at_extreme = sign * values >= level - EQUAL * span
        count = int(np.count_nonzero(at_extreme))
        nearby = int(np.count_nonzero(sign * values >= level - NEIGHBOURHOOD * spread)) - count
        adjacent = int(np.count_nonzero(at_extreme[1:] & at_extreme[:-1]))
        if count < LEAST_CLIPPED or count < OUTWEIGHS * nearby or 2 * adjacent < count:
            continue  # a sine with four samples per period reaches its extremes in single samples
        # Use the second-last step before a flat part: clipping shortens the last step.
        entered = np.flatnonzero(at_extreme[2:] & ~at_extreme[1:-1]) + 1
        left = np.flatnonzero(at_extreme[:-2] & ~at_extreme[1:-1])
        edges = np.concatenate(
            [np.abs(values[entered] - values[entered - 1]), np.abs(values[left + 2] - values[left + 1])]
        )
        if edges.size and float(np.median(edges)) >= CORNER * pace:
            sides.append((side, sign * level, count / values.size))
    return sides


def stuck(values: Vector, time: Vector, others: list[Vector] | None = None) -> tuple[float, float] | None:
    """Return begin and end [s] of the longest implausibly constant part of a channel; None without such a part.

    A constant beginning is accepted; so is a constant end, unless another channel moves there.

    Args:
        values: samples, (n,).
        time: sample times [s], (n,).
        others: other channels of the record, (n,) each.
    """
    away = values - values.mean()
    crossings = int(np.count_nonzero(away[1:] * away[:-1] < 0.0))
    if crossings < 2:
        return None
    part = constant_part(values)
    rested = _rested_at_the_ends(values)
    candidates = [part] if part is not None else []
    if any(float(np.std(other[rested[1][0] :])) > OTHERS_MOVE * float(np.std(other)) > 0.0 for other in others or []):
        candidates.append(rested[1])
    if not candidates:
        return None
    begin, end = max(candidates, key=lambda part_bounds: float(time[part_bounds[1]] - time[part_bounds[0]]))
    length = float(time[end] - time[begin])
    moving = float(time[-1] - time[0]) - sum(float(time[last] - time[first]) for first, last in [*rested, (begin, end)])
    minimum = max(PAUSE, STUCK_PERIODS * max(moving, 0.0) / crossings)
    return (float(time[begin]), float(time[end])) if length >= minimum else None


def constant_part(values: Vector) -> tuple[int, int] | None:
    """Return the first and last index of the longest constant part between two motions; None if there is none.

    Args:
        values: samples, (n,).
    """
    moves = np.flatnonzero(np.diff(values) != 0.0)
    if moves.size < 2:
        return None
    longest = int(np.argmax(moves[1:] - moves[:-1]))
    return int(moves[longest]) + 1, int(moves[longest + 1])


def _rested_at_the_ends(values: Vector) -> list[tuple[int, int]]:
    """Return the first and last index of the constant parts at the beginning and at the end."""
    moves = np.flatnonzero(np.diff(values) != 0.0)
    if not moves.size:
        return [(0, values.size - 1)] * 2
    return [(0, int(moves[0])), (int(moves[-1]) + 1, values.size - 1)]


def copies(channels: Mapping[str, Vector]) -> list[tuple[str, str]]:
    """Return the pairs of channels with identical samples except for sign and offset.

    Args:
        channels: name to samples, (n,).
    """
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
