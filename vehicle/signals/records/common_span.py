"""Bring channels with different starts or rates to their common span of time.

Channel i has the times t_i0 + k T_i. The common span begins at max t_i0 and ends at the earliest last time. Channels
of one rate whose samples coincide there are cut; others need resampling, since a shift by a part of a step is an
interpolation.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.channel import Channel

COINCIDENT = 1e-3
"""Maximum difference of coincident sample times, in steps [-]."""

CLOCK_RESOLUTION = 2e-6
"""Maximum difference of coincident sample times in addition [s]: start times of TDMS and LVM are in whole microseconds;
2 us are a phase error of 0.04 degrees at 50 Hz."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Block:
    """Channels over the same times.

    Attributes:
        time: sample times [s], (n,).
        channels: role to channel, of n values each.
    """

    time: Vector
    channels: Mapping[str, Channel]


def blocks_of(channels: Mapping[str, Channel]) -> list[Block]:
    """Combine channels (by role, with times) with the same times, in the order of the first channel of each group."""
    blocks: list[tuple[Vector, dict[str, Channel]]] = []
    for role, channel in channels.items():
        assert channel.axis is not None
        same = next((block for time, block in blocks if time is channel.axis or _coincide(time, channel.axis)), None)
        if same is None:
            blocks.append((channel.axis, {role: channel}))
        else:
            same[role] = channel
    return [Block(time=time, channels=block) for time, block in blocks]


def cut(where: object, blocks: list[Block]) -> tuple[list[Block], str]:
    """Return the common span of blocks whose samples coincide; other blocks are unchanged.

    Returns:
        One block and a notice, or the unchanged blocks and "".
    """
    if len(blocks) == 1:
        return blocks, ""
    first, last = span(where, blocks)
    parts = []
    for block in blocks:
        half = 0.5 * _step(block.time)
        inside = (block.time >= first - half) & (block.time <= last + half)
        parts.append(Block(time=block.time[inside], channels={
            role: replace(channel, values=channel.values[inside], axis=block.time[inside])
            for role, channel in block.channels.items()
        }))  # fmt: skip
    if not all(_coincide(parts[0].time, part.time) for part in parts):
        return blocks, ""
    whole = Block(
        time=parts[0].time, channels={role: channel for part in parts for role, channel in part.channels.items()}
    )
    cut = f"cut to their common time, {first:.6g} to {last:.6g} s"
    return [whole], f"the channels cover different times ({_spans(blocks)}): {cut}"


def span(where: object, blocks: list[Block]) -> tuple[float, float]:
    """Return begin and end of the common span of blocks [s]."""
    first, last = max(float(block.time[0]) for block in blocks), min(float(block.time[-1]) for block in blocks)
    if last - first < 2.0 * max(_step(block.time) for block in blocks):
        raise DataError(f"{where}: channels without common time ({_spans(blocks)}); choose channels recorded together")
    return first, last


def overlap(channel: Channel, other: Channel) -> bool:
    """Return True if two channels have a common span of time; also for a channel without times."""
    if channel.axis is None or other.axis is None:
        return True
    step = 2.0 * max(_step(channel.axis), _step(other.axis))
    return bool(min(channel.axis[-1], other.axis[-1]) - max(channel.axis[0], other.axis[0]) >= step)


def different_spans(channels: Sequence[Channel]) -> str:
    """Return a message on time histories of a file that begin or end at different times; empty if they do not."""
    axes = [
        channel.axis
        for channel in channels
        if channel.kind == "time" and channel.axis is not None and channel.axis.size > 1
    ]
    ends = np.array([(axis[0], axis[-1], _step(axis)) for axis in axes]).reshape(-1, 3)
    ends = ends[np.isfinite(ends).all(axis=1)]
    if len(ends) < 2 or (np.ptp(ends[:, :2], axis=0) < ends[:, 2].max()).all():
        return ""
    (first, first_end, _), (last, last_end, _) = ends.min(axis=0), ends.max(axis=0)
    return (
        f"channels begin at {first:.6g} to {last:.6g} s and end at {first_end:.6g} to {last_end:.6g} s: several "
        "together are cut to their common time"
    )


def need_resampling(where: object, blocks: list[Block]) -> DataError:
    """Return the error for channels whose samples do not coincide, with the option that brings them together."""
    rates = ", ".join(
        f"{_names(block)} {1.0 / _step(block.time):.6g} Hz from {block.time[0]:.6g} s" for block in blocks
    )
    remedy = f"set --resample {resampling_rate(blocks)}"
    return DataError(f"{where}: the samples of the channels are at different times ({rates}); {remedy}")


def resampling_rate(blocks: list[Block]) -> str:
    """Return the value of --resample for blocks: the lowest of their rates [Hz]."""
    rate = 1.0 / max(_step(block.time) for block in blocks)
    return f"{round(rate)}" if rate >= 20.0 else f"{rate:.3g}"


def _coincide(time: Vector, other: Vector) -> bool:
    """Return True for equal sample times within `COINCIDENT` steps and `CLOCK_RESOLUTION`."""
    if time.size != other.size:
        return False
    tolerance = COINCIDENT * _step(time) + CLOCK_RESOLUTION
    if time.size and abs(time[0] - other[0]) > tolerance:
        return False  # spares the comparison of long axes
    return bool(np.allclose(time, other, rtol=0.0, atol=tolerance, equal_nan=True))


def _step(time: Vector) -> float:
    return float(np.median(np.diff(time))) if time.size > 1 else 0.0


def _names(block: Block) -> str:
    return " and ".join(block.channels)


def _spans(blocks: list[Block]) -> str:
    return ", ".join(f"{_names(block)} {block.time[0]:.6g} to {block.time[-1]:.6g} s" for block in blocks)
