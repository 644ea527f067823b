"""Read universal files (UFF): functions at nodes, geometry and mode shapes, including common format deviations.

Source: Universal File Datasets, University of Cincinnati SDRL, datasets 15, 18, 55, 58, 58b, 82, 151, 164, 2411, 2412
and 2414.
"""

from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.formats.channel import Channel, Measurement
from vehicle.signals.formats.geometry import ModeShape
from vehicle.signals.formats.uff_blocks import BEGIN, END, Block, text_of
from vehicle.signals.formats.uff_function import read_function
from vehicle.signals.formats.uff_geometry import Nodes, Units, read_units
from vehicle.signals.formats.uff_shapes import read_shape


def read(path: Path) -> Measurement:
    """Read functions, mode shapes and geometry; errors: see `read_record`, also for a file without any of them."""
    data = path.read_bytes()
    channels: list[Channel] = []
    results: list[tuple[int, str, list[bytes]]] = []
    others: Counter[str] = Counter()
    units: Units | None = None
    nodes = Nodes()
    program = start = ""
    position = 0
    while (match := BEGIN.search(data, position)) is not None:
        block = Block(int(match[1]), match[2] == b"b", match[3], match.end())
        where = f"dataset {block.number} at byte {match.start()}"
        if block.number == 58:
            channel, date, position = read_function(path, data, block, f"{where} (function {len(channels) + 1})", units)
            channels.append(channel)
            start = start or date
            continue
        end = END.search(data, block.start - 1)
        if end is None:
            raise DataError(f"{path}: {where} has no end; the file is truncated: export it again")
        lines = data[block.start : end.start()].splitlines()
        if block.number == 164:
            units = read_units(path, where, lines)
        elif block.number == 151:
            program = text_of(lines[2])[:40] if len(lines) > 2 else ""
        elif block.number in (55, 2414):
            results.append((block.number, where, lines))  # axis systems may come later in the file
        elif not nodes.read(path, block.number, where, lines):
            others[str(block.number)] += 1
        position = end.end() - 1
    shapes: list[ModeShape] = []
    for number, where, lines in results:
        shape = read_shape(path, number, where, lines, nodes, units or Units())
        if isinstance(shape, ModeShape):
            shapes.append(shape)
        else:
            others[f"{number}, {shape}"] += 1
    summary = ", ".join(f"{dataset} ({count})" for dataset, count in sorted(others.items()))
    if not channels and not shapes and not nodes.at:
        raise DataError(
            f"{path}: contains no time history, FRF, mode shape or node, only the datasets {summary or 'none'}; "
            "export time histories and FRFs as UFF 58, mode shapes as UFF 55"
        )
    geometry = nodes.geometry(units or Units())
    notices = [f"other datasets: {summary}"] if summary else []
    if nodes.at:
        notices.append(f"{len(geometry.points)} nodes, {len(geometry.lines)} lines and elements")
    if units is None and (nodes.at or shapes):
        notices.append("dataset 164 with the units is missing; coordinates are assumed to be in m")
    return Measurement(
        path=path,
        format="uff",
        channels=_named([_turned(channel, nodes) for channel in channels]),
        program=program,
        start=start,
        notices=tuple(notices),
        geometry=geometry,
        shapes=tuple(shapes),
    )


def _turned(channel: Channel, nodes: Nodes) -> Channel:
    """Convert a direction in local axes of the node to a global axis; if it is oblique, remove it and add a remark."""
    if channel.direction[1:] not in ("X", "Y", "Z") or not channel.place.isdecimal():
        return channel
    axes = nodes.directions(int(channel.place))
    if np.array_equal(axes, np.eye(3)):
        return channel
    along = axes[:, "XYZ".index(channel.direction[1])] * (-1.0 if channel.direction[0] == "-" else 1.0)
    largest = int(np.argmax(np.abs(along)))
    note = f"{channel.direction} of the local axes of the node"
    if abs(along[largest]) > 1.0 - 1e-5:
        sign = "+" if along[largest] > 0.0 else "-"
        return replace(channel, direction=f"{sign}{'XYZ'[largest]}", remark=_joined(channel.remark, note))
    shown = ", ".join(f"{value:.3g}" for value in along)
    return replace(channel, direction="", remark=_joined(channel.remark, f"{note}, along ({shown})"))


def _joined(*texts: str) -> str:
    return "; ".join(text for text in texts if text)


def _named(channels: list[Channel]) -> tuple[Channel, ...]:
    """Name channels by their text if it is unique, else by point and direction."""
    texts = Counter(channel.name for channel in channels)
    named = []
    for channel in channels:
        point = channel.place + channel.direction + (f"/{channel.reference}" if channel.reference else "")
        unique = channel.name and texts[channel.name] == 1
        named.append(channel if unique or not point else replace(channel, name=point))
    return tuple(named)
