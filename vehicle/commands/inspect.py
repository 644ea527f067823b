"""`python -m vehicle inspect FILE...`: channels of measurement files, and a complete command for each file."""

from __future__ import annotations

import argparse
import json
from typing import TYPE_CHECKING, Any

from vehicle.commands.advice import command_for
from vehicle.commands.command_line import command
from vehicle.commands.input_options import database_option
from vehicle.commands.options import command_parser, message_options
from vehicle.commands.parser import Parser
from vehicle.commands.several_files import each_file, expanded, raise_worst, table_of

if TYPE_CHECKING:
    from vehicle.signals.records.channel import Channel, Measurement


SHOWN = 60
"""Largest number of channels in the table."""


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("inspect", "List the channels of a measurement file: names, units, rates, levels.")
    parser.add_argument(
        "files",
        nargs="+",
        metavar="FILE",
        help="of any format, recognised by its content; a shipped input; or a folder; several give one table",
    )
    database_option(parser)
    parser.add_argument("--json", action="store_true", help="print JSON")
    message_options(parser)
    return parser


def _job(options: argparse.Namespace) -> None:
    from vehicle.signals.excitation.input_files import find_input
    from vehicle.signals.records.reader import read_record

    def one(name: str) -> dict[str, Any]:
        measurement = read_record(find_input(name), tuple(options.databases))
        command, reason = command_for(measurement, name)
        return {**contents(measurement), "command": command or None, "command_reason": reason}

    names, several = expanded(options.files)
    if not several:
        found = one(names[0])
        print(json.dumps(found, indent=2, allow_nan=False) if options.json else report(found))
        return
    results, errors = each_file(names, one)
    print(json.dumps(results, indent=2, allow_nan=False) if options.json else overview(results), flush=True)
    # Files that a folder happens to hold may be of any kind; a file that was named must be read.
    raise_worst(errors if len(errors) == len(results) or len(names) == len(options.files) else (), len(results))


def overview(results: list[dict[str, Any]]) -> str:
    """Return the table of several files and the command for each.

    Args:
        results: contents of each file, or its error.
    """
    rows: list[tuple[str, ...]] = []
    for result in results:
        if "error" in result:
            rows.append((result["input"], result["error"]))
            continue
        channels = result["channels"]
        rates = list(dict.fromkeys(f"{one['rate_hz']:.6g}" for one in channels if one.get("rate_hz")))
        lengths = [one["samples"] / one["rate_hz"] for one in channels if one.get("rate_hz")]
        quantities = list(dict.fromkeys(one["quantity"] or "?" for one in channels))
        rows.append(
            (
                result["input"],
                result["format"],
                str(len(channels)),
                ", ".join(rates[:3]) or "-",
                f"{max(lengths):.4g}" if lengths else "-",
                ", ".join(quantities[:4]) + (", ..." if len(quantities) > 4 else ""),
            )
        )
    commands = [result["command"] for result in results if result.get("command")]
    heads = ("file", "format", "channels", "rate [Hz]", "length [s]", "quantities")
    return "\n".join([table_of(heads, rows), *commands])


def contents(measurement: Measurement) -> dict[str, Any]:
    """Return the content of a file as plain numbers and texts; levels in SI units, or in the file's if unknown."""
    from vehicle.signals.records.clock import time_remarks

    axes = {id(one.axis): one.axis for one in measurement.channels if one.kind == "time" and one.axis is not None}
    remarks = [text for axis in axes.values() for text in time_remarks(axis)]
    return {
        "file": measurement.path.name,
        "format": measurement.format,
        "program": measurement.program,
        "start": measurement.start,
        "sha256": measurement.sha256,
        "channels": [_channel(number, one) for number, one in enumerate(measurement.channels, 1)],
        "modes": [
            {
                "number": one.number,
                "name": one.name,
                "frequency_hz": one.frequency,
                "damping_ratio": one.damping_ratio,
                "modal_mass": one.modal_mass or None,
                "complex": one.is_complex,
                "points": len(one.points),
            }
            for one in measurement.shapes
        ],
        "points": {name: list(at) for name, at in measurement.geometry.points.items()},
        "lines": len(measurement.geometry.lines),
        "notices": [*measurement.notices, *dict.fromkeys(remarks)],
    }


def _channel(number: int, channel: Channel) -> dict[str, Any]:
    import numpy as np

    values = channel.si_values
    known = np.abs(values[np.isfinite(values)]) if np.iscomplexobj(values) else values[np.isfinite(values)]
    largest = float(np.abs(known).max()) if known.size else 0.0
    level = 0.0 if known.size else None
    axis = {"rate_hz": channel.rate} if channel.kind == "time" else {"lines": channel.values.size}
    start = None if channel.axis is None or not channel.axis.size else float(channel.axis[0])
    return {
        "number": number,
        "name": channel.name,
        "function": channel.function,
        "quantity": channel.quantity,
        "unit": channel.unit,
        "si_unit": channel.si_unit,
        **axis,
        "samples": channel.values.size,
        "start_s" if channel.kind == "time" else "start_hz": start,
        "rms": largest * float(np.sqrt(np.mean(np.square(known / largest)))) if largest else level,
        "min": float(known.min()) if known.size else None,
        "max": float(known.max()) if known.size else None,
        "place": channel.place,
        "direction": channel.direction,
        "reference": channel.reference,
        "remark": channel.remark,
    }


def report(found: dict[str, Any]) -> str:
    """Return the table of channels as text; levels in the units of the file.

    Args:
        found: of `contents`, with the command.
    """
    from vehicle.signals.records.units import find_ratio

    about = [f"{found['file']}: {found['format']}, {(count := len(found['channels']))} channel{'s' * (count != 1)}"]
    about += [found[key] for key in ("program", "start") if found[key]]
    width = max([4, *(len(one["name"]) for one in found["channels"])])
    width = min(width, 40)
    lines = ["; ".join(about), f"sha256 {found['sha256']}"]
    if not found["channels"]:
        lines.append(f"no channels; {len(found['points'])} nodes, {len(found['modes'])} mode shapes")
    else:
        lines.append(
            f"{'no':>4}  {'name':<{width}}  {'unit':<10} {'rate [Hz]':>11} {'samples':>9} {'RMS':>11} {'lowest':>11} "
            f"{'highest':>11}  place"
        )
    for one in found["channels"][:SHOWN]:
        unit = find_ratio(one["unit"])
        factor = 1.0 if unit is None else unit.factor
        numbers = ["-" if one[key] is None else f"{one[key] / factor:.4g}" for key in ("rms", "min", "max")]
        rate = one.get("rate_hz")
        axis = f"{rate:.6g}" if rate is not None else "lines" if "lines" in one else "-"
        place = " ".join(text for text in (one["place"], one["direction"], one["reference"]) if text)
        lines.append(
            f"{one['number']:>4}  {one['name'][:width]:<{width}}  {one['unit'] or '?':<10} {axis:>11} "
            f"{one['samples']:>9} {numbers[0]:>11} {numbers[1]:>11} {numbers[2]:>11}  {place}"
        )
        if one["remark"]:
            lines.append(f"{'':>6}{one['remark']}")
    if len(found["channels"]) > SHOWN:
        lines.append(f"{'':>6}{len(found['channels']) - SHOWN} more; --json lists all")
    if found["modes"]:
        lines.append(f"{'mode':>6} {'[Hz]':>10} {'damping':>9} {'modal mass':>12} {'points':>7}")
    for one in found["modes"]:
        mass = "-" if one["modal_mass"] is None else f"{one['modal_mass']:.5g} kg"
        kind = " complex" if one["complex"] else ""
        lines.append(
            f"{one['number']:>6} {one['frequency_hz']:>10.4f} {100 * one['damping_ratio']:>7.2f} % {mass:>12} "
            f"{one['points']:>7}{kind}  {one['name']}"
        )
    lines += [f"notice: {text}" for text in found["notices"]]
    if found["command"]:
        lines += [f"{found['command_reason']}:", f"  {found['command']}"]
    else:
        lines.append(f"no command: {found['command_reason']}")
    return "\n".join(lines)


main = command(parser, _job)
