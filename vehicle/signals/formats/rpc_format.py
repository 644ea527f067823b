"""Read and write RPC III time histories of servo-hydraulic rigs: a header of keywords, then groups of frames.

Header: records of 128 bytes, keyword in 32 and value in 96 bytes, in blocks of 512 bytes. Data: groups with
PTS_PER_GROUP samples of the first channel, then of the second, and so on; the last group is padded.
Integers: value = integer * SCALE.CHAN_n.

Source: MTS, RPC III File Formats; the tests compare with the reader rpc3-file.
"""

import math
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.formats.channel import Channel, Measurement, check_length, clock_step, uniform_axis
from vehicle.signals.formats.text import LARGEST

RECORD, BLOCK = 128, 512

NO_DATE = "01-Jan-1970 00:00:00"
"""Time of writing in each file of this program: equal results are equal bytes."""

ORDERS = {"BINARY": "<", "BINARY_IEEE_LITTLE_END": "<", "BINARY_IEEE_BIG_END": ">"}
WIDTHS = {"SHORT_INTEGER": "i2", "FLOATING_POINT": "f4"}
FRAMES = (2048, 1024, 512, 256, 128)
"""Frame and group sizes of written files [samples]; the size with the least padding is used."""


def read(path: Path) -> Measurement:
    """Read the channels of a time history file; errors: see `read_record`, also for another file type."""
    data = path.read_bytes()
    head = _header(path, data)
    for key, allowed in (("FORMAT", tuple(ORDERS)), ("FILE_TYPE", ("TIME_HISTORY",)), ("DATA_TYPE", tuple(WIDTHS))):
        value = head.get(key, "TIME_HISTORY" if key == "FILE_TYPE" else "SHORT_INTEGER" if key == "DATA_TYPE" else "")
        if value not in allowed:
            raise DataError(f"{path}: {key} is {value!r} but must be one of {', '.join(allowed)}")
    numbers = {key: _number(path, head, key) for key in ("CHANNELS", "FRAMES", "PTS_PER_FRAME", "PTS_PER_GROUP")}
    if any(value < 1 or value != int(value) for value in numbers.values()):
        raise DataError(f"{path}: must be whole numbers of at least 1, not {numbers}")
    channels, frames, frame, group = (int(value) for value in numbers.values())
    step = _number(path, head, "DELTA_T")
    if step <= 0.0 or group % frame:
        raise DataError(
            f"{path}: found DELTA_T {step:g} s, {group} samples per group and {frame} per frame; must be a "
            "positive time step and whole frames per group"
        )
    number_type = WIDTHS[head.get("DATA_TYPE", "SHORT_INTEGER")]
    start = int(_number(path, head, "NUM_HEADER_BLOCKS")) * BLOCK
    total = frames * frame
    groups = math.ceil(total / group)
    check_length(path, groups * group * channels * int(number_type[1]), len(data) - start, f"FRAMES {frames}")
    notices = []
    samples = int(_number(path, head, "SAMPLES")) if "SAMPLES" in head else total
    if not 0 < samples <= total:
        raise DataError(f"{path}: SAMPLES is {samples} but must be 1 to {total}, the samples in all frames")
    order = ORDERS[head["FORMAT"]]
    table = np.frombuffer(data, f"{order}{number_type}", groups * group * channels, start).reshape(
        groups, channels, group
    )
    if "SAMPLES" not in head:
        filled = _filling(table, total, frame)
        samples -= filled
        padding_notice = f"the last {filled} samples are constant in all channels and ignored as padding"
        if not filled:
            padding_notice = f"up to {frame - 1} samples at the end may be padding; cut them off with --to"
        notices.append(f"SAMPLES is missing in the header: {padding_notice}")
    step, remark = clock_step(step)
    axis = uniform_axis(samples, step)
    channel_list, constant = [], _same_limits(head, channels)
    for index in range(channels):
        with np.errstate(invalid="ignore"):
            values = table[:, index, :].reshape(-1)[:samples].astype(np.float64)
        number = index + 1
        if number_type == "i2":
            values *= _number(path, head, f"SCALE.CHAN_{number}")
        notices += _check_values(path, head, number, values, constant)
        channel_list.append(
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
        channels=tuple(channel_list),
        program=head.get("OPERATION", ""),
        start=head.get("DATE", "").removeprefix(NO_DATE),
        notices=tuple(notices),
    )


def _filling(table: np.ndarray, total: int, frame: int) -> int:
    """Count the last samples that are constant, or zero, in all channels of a table (groups, channels, samples)."""
    last = np.moveaxis(table, 1, 0).reshape(table.shape[1], -1)[:, total - frame : total]
    repeated = (np.diff(last, axis=1) == 0).all(axis=0)
    run = int(np.argmin(repeated[::-1])) if not repeated.all() else repeated.size
    if run == 0:
        return 0
    zeros = not last[:, -1].any()
    return run + 1 if zeros and run < repeated.size else run


def _header(path: Path, data: bytes) -> dict[str, str]:
    """Return the keywords and values of the header; the first three contain their number."""
    header: dict[str, str] = {}
    count, index = 3, 0
    while index < count:
        record = data[index * RECORD : (index + 1) * RECORD]
        if len(record) < RECORD:
            raise DataError(f"{path}: the file ends within its header; it is truncated: export it again")
        key, value = (part.split(b"\0")[0].decode("latin-1").strip() for part in (record[:32], record[32:]))
        if key:
            header[key] = value
        index += 1
        if index == 3:
            count = int(_number(path, header, "NUM_PARAMS"))
            check_length(path, count * RECORD, len(data), "NUM_PARAMS")
            blocks = _number(path, header, "NUM_HEADER_BLOCKS")
            check_length(path, blocks * BLOCK, len(data), "NUM_HEADER_BLOCKS")
            if count * RECORD > blocks * BLOCK:
                raise DataError(f"{path}: {blocks:g} header blocks, too few for {count} keywords; export it again")
    return header


def _number(path: Path, head: dict[str, str], key: str) -> float:
    try:
        value = float(head[key])
    except KeyError:
        raise DataError(f"{path}: {key} is missing in the header; export it again") from None
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise DataError(f"{path}: {key} is {head[key]!r} but must be a number")
    return value


def _limits(head: dict[str, str], number: int) -> tuple[float, float] | None:
    """Return the limits of a channel in the header; None if missing."""
    try:
        return float(head[f"LOWER_LIMIT.CHAN_{number}"]), float(head[f"UPPER_LIMIT.CHAN_{number}"])
    except (KeyError, ValueError):
        return None


def _same_limits(head: dict[str, str], channels: int) -> bool:
    """Return True if the limits are a constant of the writer: +-1, or equal for all of several channels."""
    limits = {_limits(head, number) for number in range(1, channels + 1)}
    return limits == {(-1.0, 1.0)} or (channels > 1 and len(limits) == 1)


def _check_values(path: Path, head: dict[str, str], number: int, values: np.ndarray, constant: bool) -> tuple[str, ...]:
    """Reject numbers that are not finite or far beyond the limits in the header (wrong scale).

    Args:
        constant: True if the limits are a constant of the writer; then only a notice is returned.
    """
    if not np.isfinite(values).all() or np.abs(values).max() > LARGEST:
        raise DataError(
            f"{path}: channel {number} contains numbers that are not finite or above 1e30; is the keyword FORMAT "
            "wrong? export it again"
        )
    limits = _limits(head, number)
    if limits is None:
        return ()
    largest = float(np.abs(values).max())
    try:  # nCode writes limits of 1 for any channel, and its largest and smallest value elsewhere
        extremes = [abs(float(word)) for word in head[f"NCODE_STAT1_CHAN_{number}"].split(",")[:2]]
    except (KeyError, ValueError):
        extremes = [0.0]
    limit = max(map(abs, limits))
    if abs(max(extremes) - largest) < 0.01 * largest or not 0.0 < 2.0 * limit < largest:
        return ()
    if constant:
        return (f"channel {number} reaches {largest:g}; the limit {limit:g} in the header is for all channels",)
    raise DataError(
        f"{path}: channel {number} reaches {largest:g}, but its limit in the header is {limit:g}; the "
        "keyword SCALE is damaged or used in another sense; export it in floating point"
    )


def write(path: Path, channels: tuple[Channel, ...], description: str) -> None:
    """Write time histories of equal rate in floating point."""
    first = channels[0]
    rate = first.rate
    for channel in channels:
        if channel.kind != "time" or channel.values.size != first.values.size or channel.rate != rate or rate is None:
            raise DataError(
                f"{path}: {channel.name} has another sampling rate, but RPC III stores only one; resample the channel"
            )
        if not np.isfinite(channel.values).all():
            raise DataError(f"{path}: {channel.name} has a missing value, which RPC III cannot store; leave it out")
    samples, count = first.values.size, len(channels)
    frame = min(FRAMES, key=lambda size: -samples % size)
    frames = math.ceil(samples / frame)
    table = np.zeros((frames, count, frame), dtype="<f4")
    for index, channel in enumerate(channels):
        padded = np.full(frames * frame, channel.values[-1])
        padded[:samples] = channel.values
        table[:, index, :] = padded.reshape(frames, frame)
    head = {
        "DATE": NO_DATE,
        "OPERATION": description[:95],
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
    for number, channel in enumerate(channels, 1):
        head |= {
            f"DESC.CHAN_{number}": channel.name[:95],
            f"UNITS.CHAN_{number}": channel.unit[:95],
            f"SCALE.CHAN_{number}": "1.0",
            f"LOWER_LIMIT.CHAN_{number}": f"{float(channel.values.real.min()):.9e}",
            f"UPPER_LIMIT.CHAN_{number}": f"{float(channel.values.real.max()):.9e}",
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
