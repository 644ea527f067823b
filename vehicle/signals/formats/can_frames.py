"""Data frames of CAN buses, grouped by bus, direction and identifier, for every container of frames."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vehicle.arrays import Vector

FD_LENGTHS = (0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64)
"""Payload length of a CAN FD frame [byte] by data length code (ISO 11898-1)."""

IDENTIFIER_BITS = 0x1FFFFFFF
"""The 29 bits of an extended identifier."""


class Source(NamedTuple):
    """Key of frames of one message: frames of different keys are different signals.

    Attributes:
        bus: name of the bus, for example CAN1 or can0; empty if unknown.
        direction: Rx or Tx; empty if unknown.
        identifier: arbitration ID.
        extended: True for an identifier of 29 bits.
    """

    bus: str
    direction: str
    identifier: int
    extended: bool


@dataclass(frozen=True, slots=True, eq=False)
class Frames:
    """Data frames of a source.

    Attributes:
        time: times of reception [s], (n,).
        payload: bytes, padded with zeros to the longest payload, (n, width).
        length: length of each payload [byte], (n,).
    """

    time: Vector
    payload: NDArray[np.uint8]
    length: NDArray[np.int64]


BusLog = Mapping[Source, Frames]
"""Data frames of a log by source, in the order of the first frame."""


def frames_of(rows: Sequence[tuple[float, bytes]]) -> Frames:
    """Return frames from pairs of time [s] and payload."""
    width = max(len(data) for _, data in rows)
    joined = b"".join(data.ljust(width, b"\0") for _, data in rows)
    return Frames(
        np.array([time for time, _ in rows]),
        np.frombuffer(joined, np.uint8).reshape(len(rows), width),
        np.array([len(data) for _, data in rows]),
    )


def grouped(
    time: Vector,
    payload: NDArray[np.uint8],
    length: NDArray[np.int64],
    keys: tuple[Sequence[str], Sequence[str], Sequence[int], Sequence[bool]],
) -> dict[Source, Frames]:
    """Split the frames of an array by source.

    Args:
        time: times [s], (n,).
        payload: bytes, (n, width).
        length: length of each payload [byte], (n,).
        keys: bus, direction, identifier and extended flag of each frame, (n,) each.
    """
    rows: dict[Source, list[int]] = {}
    for row, key in enumerate(zip(*keys, strict=True)):
        rows.setdefault(Source(*key), []).append(row)
    return {source: Frames(time[at], payload[at], length[at]) for source, at in rows.items()}


def merged(logs: Sequence[BusLog]) -> dict[Source, Frames]:
    """Merge logs; frames of a source in several logs are ordered by time."""
    parts: dict[Source, list[Frames]] = {}
    for log in logs:
        for source, frames in log.items():
            parts.setdefault(source, []).append(frames)
    return {source: _joined(of_source) for source, of_source in parts.items()}


def _joined(parts: Sequence[Frames]) -> Frames:
    if len(parts) == 1:
        return parts[0]
    width = max(part.payload.shape[1] for part in parts)
    payload = np.concatenate([np.pad(part.payload, ((0, 0), (0, width - part.payload.shape[1]))) for part in parts])
    time, length = np.concatenate([part.time for part in parts]), np.concatenate([part.length for part in parts])
    order = np.argsort(time, kind="stable")
    return Frames(time[order], payload[order], length[order])
