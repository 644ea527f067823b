"""RPC III, the time histories of servo-hydraulic rigs: a header of keywords, then groups of frames of all channels.

Header: records of 128 bytes, a keyword in 32 and its value in 96, in blocks of 512 bytes. Data: groups; in a group
PTS_PER_GROUP samples of the first channel, then those of the second, and so on; the last group is filled up.
Integers: value = integer * SCALE.CHAN_n.

Source: MTS, RPC III File Formats; the reader rpc3-file is the oracle of the tests.
"""

from __future__ import annotations

import math
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.records.channel import Channel, Measurement, check_length, clock_step, uniform_axis
from vehicle.signals.records.reader import digest
from vehicle.signals.records.text import LARGEST

RECORD, BLOCK = 128, 512
ORDERS = {"BINARY": "<", "BINARY_IEEE_LITTLE_END": "<", "BINARY_IEEE_BIG_END": ">"}
WIDTHS = {"SHORT_INTEGER": "i2", "FLOATING_POINT": "f4"}
FRAMES = (2048, 1024, 512, 256, 128)
"""Samples in a frame, and a group, of files that are written: the size with the fewest samples to fill is taken."""


def read(path: Path) -> Measurement:
    """Read a time history.

    Raises:
        DataError: another kind of file, damaged, or cut off.
    """
    data = path.read_bytes()
    head = _header(path, data)
    for key, allowed in (("FORMAT", tuple(ORDERS)), ("FILE_TYPE", ("TIME_HISTORY",)), ("DATA_TYPE", tuple(WIDTHS))):
        value = head.get(key, "TIME_HISTORY" if key == "FILE_TYPE" else "SHORT_INTEGER" if key == "DATA_TYPE" else "")
        if value not in allowed:
            raise DataError(f"{path}: {key} is {value!r}; allowed are {', '.join(allowed)}")
    numbers = {key: _number(path, head, key) for key in ("CHANNELS", "FRAMES", "PTS_PER_FRAME", "PTS_PER_GROUP")}
    if any(value < 1 or value != int(value) for value in numbers.values()):
        raise DataError(f"{path}: {numbers}; all must be whole and at least 1")
    channels, frames, frame, group = (int(value) for value in numbers.values())
    step = _number(path, head, "DELTA_T")
    if step <= 0.0 or group % frame:
        raise DataError(
            f"{path}: DELTA_T {step:g} s, {group} samples a group, {frame} a frame; needed are a positive step and "
            "whole frames in a group"
        )
    kind = WIDTHS[head.get("DATA_TYPE", "SHORT_INTEGER")]
    start = int(_number(path, head, "NUM_HEADER_BLOCKS")) * BLOCK
    total = frames * frame
    groups = math.ceil(total / group)
    check_length(path, groups * group * channels * int(kind[1]), len(data) - start, f"FRAMES {frames}")
    notices = []
    samples = int(_number(path, head, "SAMPLES")) if "SAMPLES" in head else total
    if not 0 < samples <= total:
        raise DataError(f"{path}: SAMPLES {samples}; allowed is 1 to {total}, what the frames hold")
    order = ORDERS[head["FORMAT"]]
    table = np.frombuffer(data, f"{order}{kind}", groups * group * channels, start).reshape(groups, channels, group)
    if "SAMPLES" not in head:
        filled = _filling(table, total, frame)
        samples -= filled
        said = f"the last {filled} samples repeat one value in every channel: left out as filling"
        if not filled:
            said = f"up to {frame - 1} samples at the end may be filling; cut with --to"
        notices.append(f"no SAMPLES in the header: {said}")
    step, remark = clock_step(step)
    axis = uniform_axis(samples, step)
    found = []
    for index in range(channels):
        with np.errstate(invalid="ignore"):
            values = table[:, index, :].reshape(-1)[:samples].astype(np.float64)
        number = index + 1
        if kind == "i2":
            values *= _number(path, head, f"SCALE.CHAN_{number}")
        _check_values(path, head, number, values)
        found.append(
            Channel(
                name=head.get(f"DESC.CHAN_{number}", f"channel {number}"),
                unit=head.get(f"UNITS.CHAN_{number}", ""),
                values=values,
                axis=axis,
                remark=remark,
            )
        )
    return Measurement(
        path=path,
        format="rpc",
        channels=tuple(found),
        sha256=digest(path),
        program=head.get("OPERATION", ""),
        start=head.get("DATE", ""),
        notices=tuple(notices),
    )


def _filling(table: np.ndarray, total: int, frame: int) -> int:
    """Samples at the end of the last frame that repeat the one before them, or zero, in every channel at once.

    Args:
        table: (groups, channels, samples of a group), as stored.
        total: samples of all frames.
        frame: samples of a frame.
    """
    last = np.moveaxis(table, 1, 0).reshape(table.shape[1], -1)[:, total - frame : total]
    same = (np.diff(last, axis=1) == 0).all(axis=0)
    run = int(np.argmin(same[::-1])) if not same.all() else same.size
    if run == 0:
        return 0
    zeros = not last[:, -1].any()
    return run + 1 if zeros and run < same.size else run


def _header(path: Path, data: bytes) -> dict[str, str]:
    """Keywords and values; the first three tell how many there are."""
    found: dict[str, str] = {}
    count, index = 3, 0
    while index < count:
        record = data[index * RECORD : (index + 1) * RECORD]
        if len(record) < RECORD:
            raise DataError(f"{path}: the file ends within its header; it was cut off; export it again")
        key, value = (part.split(b"\0")[0].decode("latin-1").strip() for part in (record[:32], record[32:]))
        if key:
            found[key] = value
        index += 1
        if index == 3:
            count = int(_number(path, found, "NUM_PARAMS"))
            check_length(path, count * RECORD, len(data), "NUM_PARAMS")
            blocks = _number(path, found, "NUM_HEADER_BLOCKS")
            check_length(path, blocks * BLOCK, len(data), "NUM_HEADER_BLOCKS")
            if count * RECORD > blocks * BLOCK:
                raise DataError(f"{path}: {count} keywords do not fit into {blocks:g} blocks of the header")
    return found


def _number(path: Path, head: dict[str, str], key: str) -> float:
    try:
        value = float(head[key])
    except KeyError:
        raise DataError(f"{path}: no {key} in the header; export it again") from None
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise DataError(f"{path}: {key} is {head[key]!r}; needed is a number")
    return value


def _check_values(path: Path, head: dict[str, str], number: int, values: np.ndarray) -> None:
    """Refuse numbers that are not finite, or beyond the limits that the header tells: a scale of another meaning."""
    if not np.isfinite(values).all() or np.abs(values).max() > LARGEST:
        raise DataError(f"{path}: channel {number} holds numbers that are not finite, or beyond 1e30; is FORMAT wrong?")
    limits = []
    for key in ("LOWER_LIMIT", "UPPER_LIMIT"):
        try:
            limits.append(abs(float(head[f"{key}.CHAN_{number}"])))
        except (KeyError, ValueError):
            return
    largest = float(np.abs(values).max())
    if max(limits) > 0.0 and largest > 2.0 * max(limits):
        raise DataError(
            f"{path}: channel {number} reaches {largest:g}, its limits in the header are {max(limits):g}; its SCALE "
            "has "
            "another meaning or is damaged; export it in floating point"
        )


def write(path: Path, channels: tuple[Channel, ...], about: str) -> None:
    """Write time histories of one rate in floating point.

    Args:
        path: the file.
        channels: with equal times.
        about: what the record is.

    Raises:
        DataError: other rates, or a value that is missing: integers and rigs know none.
    """
    first = channels[0]
    rate = first.rate
    for one in channels:
        if one.kind != "time" or one.values.size != first.values.size or one.rate != rate or rate is None:
            raise DataError(f"{path}: RPC III holds time histories of one rate; {one.name} has another")
        if not np.isfinite(one.values).all():
            raise DataError(f"{path}: {one.name} has a missing value; RPC III knows none")
    samples, count = first.values.size, len(channels)
    frame = min(FRAMES, key=lambda size: -samples % size)
    frames = math.ceil(samples / frame)
    table = np.zeros((frames, count, frame), dtype="<f4")
    for index, one in enumerate(channels):
        padded = np.full(frames * frame, one.values[-1])
        padded[:samples] = one.values
        table[:, index, :] = padded.reshape(frames, frame)
    head = {
        "DATE": datetime.now(UTC).strftime("%d-%b-%Y %H:%M:%S"),
        "OPERATION": about[:95],
        "FILE_TYPE": "TIME_HISTORY",
        "TIME_TYPE": "RESPONSE",
        "DATA_TYPE": "FLOATING_POINT",
        "CHANNELS": str(count),
        "DELTA_T": f"{1.0 / float(rate or 1.0):.15e}",
        "PTS_PER_FRAME": str(frame),
        "PTS_PER_GROUP": str(frame),
        "FRAMES": str(frames),
        "SAMPLES": str(samples),
        "BYPASS_FILTER": "0",
        "HALF_FRAMES": "0",
        "REPEATS": "1",
        "INT_FULL_SCALE": "32752",
        "PARTITIONS": "1",
        "PART.CHAN_1": "1",
        "PART.NCHAN_1": str(count),
    }
    for number, one in enumerate(channels, 1):
        head |= {
            f"DESC.CHAN_{number}": one.name[:95],
            f"UNITS.CHAN_{number}": one.unit[:95],
            f"SCALE.CHAN_{number}": "1.0",
            f"LOWER_LIMIT.CHAN_{number}": f"{float(one.values.real.min()):.9e}",
            f"UPPER_LIMIT.CHAN_{number}": f"{float(one.values.real.max()):.9e}",
            f"MAP.CHAN_{number}": str(number),
        }
    blocks = math.ceil((len(head) + 3) * RECORD / BLOCK)
    head = {
        "FORMAT": "BINARY_IEEE_LITTLE_END",
        "NUM_HEADER_BLOCKS": str(blocks),
        "NUM_PARAMS": str(len(head) + 3),
    } | head
    text = b"".join(
        key.encode("latin-1").ljust(32, b"\0") + value.encode("latin-1", "replace").ljust(96, b"\0")
        for key, value in head.items()
    )
    path.write_bytes(text.ljust(blocks * BLOCK, b"\0") + table.tobytes())
