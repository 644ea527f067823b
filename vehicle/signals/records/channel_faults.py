"""What is wrong with a measured channel by itself: a clipped sensor, one that sticks, one that was copied."""

from __future__ import annotations

from collections.abc import Container, Mapping

import numpy as np

from vehicle.signals.records.clock import PAUSE
from vehicle.signals.records.table import Vector

EQUAL = 1e-6
"""Distance of samples that count as equal, over peak to peak [-]: single precision keeps seven digits."""
LEAST_CLIPPED = 5
"""Samples at an extreme value from which on a channel can be clipped: of a random record without noise two are equal
where values are rounded."""
NEIGHBOURHOOD = 0.05
"""Band beside an extreme value that its samples are compared with, in standard deviations."""
OUTWEIGHS = 2.0
"""Samples at the extreme over those in that band from which on it is clipped [-]. A Gaussian record clipped at three
standard deviations has 6, at one 13; a rounded sine that is not clipped has one."""
CORNER = 0.25
"""Last step before the flat part over the RMS step of the channel [-]: a plateau that is part of the motion is entered
with a small step, a clipped one at the speed of the motion."""
MOTIONS = ("displacement", "velocity", "acceleration", "angle", "angular velocity")
"""Quantities that are judged."""
STUCK_PERIODS = 5.0
"""Mean intervals between crossings of the mean for which a channel stays constant until it counts as stuck: of a
Gaussian record in a band of an octave one in 1e4 intervals is as long."""
OTHERS_MOVE = 0.2
"""RMS of another channel in that part over its RMS in the whole record, from which on it moves [-]."""


def faults(
    channels: Mapping[str, Vector], time: Vector, *, moving: Container[str] = (), remedy: str = "--from S and --to S"
) -> list[str]:
    """Return a sentence for each channel that is clipped, and for each one that sticks.

    For motions alone: a friction force is constant by its nature.

    Args:
        channels: name to samples as the sensor gave them, before any filter, (n,).
        time: of the samples [s], (n,).
        moving: channels of one sensor or one body, which end together; () by default.
        remedy: options that cut a part out of the record.
    """
    said, together = [], {name for name in channels if name in moving}
    for name, values in channels.items():
        for side, level, share in clipped(values):
            said.append(
                f"{name}: clipped? {100.0 * share:.3g} % of the samples are equal to the {side}, {level:.4g}, with "
                "sharp edges: its peaks, RMS and spectra are wrong; measure with a larger range, or take a part "
                f"without ({remedy})"
            )
        others = [other for one, other in channels.items() if one != name and {one, name} <= together]
        found = stuck(values, time, others)
        if found is not None:
            begin, end = found
            said.append(
                f"{name}: constant for {end - begin:.4g} s, from {begin:.6g} to {end:.6g} s: a sensor that sticks, "
                f"or a pause? Every mean counts it; take the part before or after it ({remedy})"
            )
    return said


def clipped(values: Vector) -> list[tuple[str, float, float]]:
    """Return the sides on which a channel is clipped: "largest" or "smallest" value, its size, share of the samples.

    A side is clipped where more samples have its extreme value than lie in the band beside it, and where they are
    entered at the speed of the motion.

    Args:
        values: (n,).
    """
    spread, reach = float(np.std(values)), float(np.ptp(values))
    steps = np.diff(values)
    moving = steps[steps != 0.0]
    if not (reach > 0.0 and moving.size):
        return []
    pace = float(np.sqrt(np.mean(moving**2)))
    found = []
    for side, sign in (("largest value", 1.0), ("smallest value", -1.0)):
        level = float(np.max(sign * values))
        at = sign * values >= level - EQUAL * reach
        count = int(np.count_nonzero(at))
        beside = int(np.count_nonzero(sign * values >= level - NEIGHBOURHOOD * spread)) - count
        together = int(np.count_nonzero(at[1:] & at[:-1]))
        if count < LEAST_CLIPPED or count < OUTWEIGHS * beside or 2 * together < count:
            continue  # a sine with four samples in a period has its extreme in single samples
        # The step before the last one into a flat part: the last one is cut by the clipping itself.
        entered = np.flatnonzero(at[2:] & ~at[1:-1]) + 1
        left = np.flatnonzero(at[:-2] & ~at[1:-1])
        edges = np.concatenate(
            [np.abs(values[entered] - values[entered - 1]), np.abs(values[left + 2] - values[left + 1])]
        )
        if edges.size and float(np.median(edges)) >= CORNER * pace:
            found.append((side, sign * level, count / values.size))
    return found


def stuck(values: Vector, time: Vector, others: list[Vector] | None = None) -> tuple[float, float] | None:
    """Return begin and end [s] of the longest part in which a channel stays constant longer than its motion allows.

    At the beginning of a record a channel may rest, at the end unless another one moves meanwhile.

    Args:
        values: (n,).
        time: (n,) [s].
        others: channels of the same record, (n,) each.
    """
    away = values - values.mean()
    crossings = int(np.count_nonzero(away[1:] * away[:-1] < 0.0))
    if crossings < 2:
        return None
    part = constant_part(values)
    rested = _rested_at_the_ends(values)
    choices = [part] if part is not None else []
    if any(float(np.std(other[rested[1][0] :])) > OTHERS_MOVE * float(np.std(other)) > 0.0 for other in others or []):
        choices.append(rested[1])
    if not choices:
        return None
    begin, end = max(choices, key=lambda one: float(time[one[1]] - time[one[0]]))
    length = float(time[end] - time[begin])
    moving = float(time[-1] - time[0]) - sum(float(time[last] - time[first]) for first, last in [*rested, (begin, end)])
    least = max(PAUSE, STUCK_PERIODS * max(moving, 0.0) / crossings)
    return (float(time[begin]), float(time[end])) if length >= least else None


def constant_part(values: Vector) -> tuple[int, int] | None:
    """Return the first and the last sample of the longest part of equal values between two motions; None without one.

    Args:
        values: (n,).
    """
    moves = np.flatnonzero(np.diff(values) != 0.0)
    if moves.size < 2:
        return None
    longest = int(np.argmax(moves[1:] - moves[:-1]))
    return int(moves[longest]) + 1, int(moves[longest + 1])


def _rested_at_the_ends(values: Vector) -> list[tuple[int, int]]:
    """First and last sample of the constant parts at the beginning and at the end."""
    moves = np.flatnonzero(np.diff(values) != 0.0)
    if not moves.size:
        return [(0, values.size - 1)] * 2
    return [(0, int(moves[0])), (int(moves[-1]) + 1, values.size - 1)]


def copies(channels: Mapping[str, Vector]) -> list[tuple[str, str]]:
    """Return the pairs of channels that hold the same samples, but for sign and offset.

    Args:
        channels: name to samples, (n,).
    """
    moving = {name: values - values.mean() for name, values in channels.items() if np.ptp(values) > 0.0}
    names = list(moving)
    return [
        (one, other)
        for number, other in enumerate(names)
        for one in names[:number]
        if any(
            np.allclose(moving[one], sign * moving[other], rtol=0.0, atol=EQUAL * float(np.ptp(moving[one])))
            for sign in (1.0, -1.0)
        )
    ]
