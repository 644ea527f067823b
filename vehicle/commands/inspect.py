"""`python -m vehicle inspect FILE...`: channels of measurement files, and a complete command for each file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.advice import command_for, comparison_for
from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.input_options import database_option
from vehicle.commands.options import command_parser, message_options, setting_options
from vehicle.commands.parser import Parser
from vehicle.commands.several_files import each_file, expanded, raise_worst, table_of
from vehicle.settings import Settings, setting

if TYPE_CHECKING:
    from vehicle.signals.formats.channel import Channel, Measurement
    from vehicle.signals.records.finding import Finding


SHOWN = 60
"""Largest number of channels in the table."""


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("inspect", "List the channels of a measurement file: names, units, rates, levels.")
    setting_options(parser, InspectSettings, "files")
    database_option(parser)
    parser.add_argument("--json", action="store_true", help="print JSON")
    message_options(parser)
    return parser


@dataclass(frozen=True, kw_only=True, slots=True)
class InspectSettings(Settings):
    """Files to inspect, with their CAN databases."""

    files: tuple[str, ...] = setting(
        "measurement file (format recognised by its content), shipped input, or folder. Several give one table",
        flag="files",
        nargs="+",
        metavar="FILE",
    )
    databases: tuple[Path, ...] = ()


def _job(settings: InspectSettings, console: Console) -> None:
    from vehicle.signals.excitation.input_files import find_input
    from vehicle.signals.formats.reader import read_record

    def one(name: str) -> dict[str, Any]:
        measurement = read_record(find_input(name), settings.databases)
        findings: list[Finding] = []
        advised, reason = command_for(measurement, name, settings.databases, findings)
        comparison, left_out = comparison_for(measurement, name, advised, findings)
        return {
            **contents(measurement),
            "findings": findings,
            "command": advised or None,
            "command_reason": reason,
            "comparison": comparison or None,
            "comparison_left_out": left_out,
        }

    names, several = expanded(settings.files)
    if not several:
        result = one(names[0])
        console.result(result, report(result))
        return
    results, errors = each_file(names, one)
    console.result(results, overview(results))
    # Files that a folder happens to hold may be of any kind; a file that was named must be read.
    raise_worst(errors if len(errors) == len(results) or len(names) == len(settings.files) else (), len(results))


def overview(results: list[dict[str, Any]]) -> str:
    """Return the table of several files and the command for each."""

    def row(result: dict[str, Any]) -> list[tuple[str, ...]]:
        channels = result["channels"]
        rates = list(dict.fromkeys(f"{channel['rate_hz']:.6g}" for channel in channels if channel.get("rate_hz")))
        lengths = [channel["samples"] / channel["rate_hz"] for channel in channels if channel.get("rate_hz")]
        quantities = list(dict.fromkeys(channel["quantity"] or "?" for channel in channels))
        named = ", ".join(quantities[:4]) + (", ..." if len(quantities) > 4 else "")
        length = f"{max(lengths):.4g}" if lengths else "-"
        return [(result["input"], result["format"], str(len(channels)), ", ".join(rates[:3]) or "-", length, named)]

    commands = [result["command"] for result in results if result.get("command")]
    heads = ("file", "format", "channels", "rate [Hz]", "length [s]", "quantities")
    return "\n".join([table_of(heads, results, row), *commands])


def contents(measurement: Measurement) -> dict[str, Any]:
    """Return the content of a file as plain numbers and texts; levels in SI units, or in the file's if unknown."""
    from vehicle.signals.formats.clock import time_remarks
    from vehicle.signals.records.common_span import different_spans

    axes = {
        id(channel.axis): channel.axis
        for channel in measurement.channels
        if channel.kind == "time" and channel.axis is not None
    }
    remarks = [text for axis in axes.values() for text in time_remarks(axis)]
    spans = different_spans(measurement.channels)
    return {
        "file": measurement.path.name,
        "format": measurement.format,
        "program": measurement.program,
        "start": measurement.start,
        "sha256": measurement.sha256,
        "channels": [_channel(number, channel) for number, channel in enumerate(measurement.channels, 1)],
        "modes": [
            {
                "number": shape.number,
                "name": shape.name,
                "frequency_hz": shape.frequency,
                "damping_ratio": shape.damping_ratio,
                "modal_mass": shape.modal_mass or None,
                "complex": shape.is_complex,
                "points": len(shape.points),
            }
            for shape in measurement.shapes
        ],
        "points": {name: list(at) for name, at in measurement.geometry.points.items()},
        "lines": len(measurement.geometry.lines),
        "notices": [*measurement.notices, *dict.fromkeys(remarks), *([spans] if spans else [])],
    }


def _channel(number: int, channel: Channel) -> dict[str, Any]:
    import numpy as np

    values = channel.si_values
    finite = np.abs(values[np.isfinite(values)]) if np.iscomplexobj(values) else values[np.isfinite(values)]
    largest = float(np.abs(finite).max()) if finite.size else 0.0
    level = 0.0 if finite.size else None
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
        "rms": largest * float(np.sqrt(np.mean(np.square(finite / largest)))) if largest else level,
        "min": float(finite.min()) if finite.size else None,
        "max": float(finite.max()) if finite.size else None,
        "place": channel.place,
        "direction": channel.direction,
        "reference": channel.reference,
        "remark": channel.remark,
    }


def report(content: dict[str, Any]) -> str:
    """Return the table of channels as text; levels in the units of the file."""
    from vehicle.signals.formats.units import find_ratio

    lines = [
        f"{content['file']}: {content['format']}, {(count := len(content['channels']))} channel{'s' * (count != 1)}"
    ]
    lines += [content[key] for key in ("program", "start") if content[key]]
    width = max([4, *(len(channel["name"]) for channel in content["channels"])])
    width = min(width, 40)
    lines = ["; ".join(lines), f"sha256 {content['sha256']}"]
    if not content["channels"]:
        lines.append(f"no channels; {len(content['points'])} nodes, {len(content['modes'])} mode shapes")
    else:
        lines.append(
            f"{'no':>4}  {'name':<{width}}  {'unit':<10} {'rate [Hz]':>11} {'samples':>9} {'RMS':>11} {'lowest':>11} "
            f"{'highest':>11}  place"
        )
    for channel in content["channels"][:SHOWN]:
        unit = find_ratio(channel["unit"])
        factor = 1.0 if unit is None else unit.factor
        numbers = ["-" if channel[key] is None else f"{channel[key] / factor:.4g}" for key in ("rms", "min", "max")]
        rate = channel.get("rate_hz")
        axis = f"{rate:.6g}" if rate is not None else "lines" if "lines" in channel else "-"
        point = " ".join(text for text in (channel["place"], channel["direction"], channel["reference"]) if text)
        lines.append(
            f"{channel['number']:>4}  {channel['name'][:width]:<{width}}  {channel['unit'] or '?':<10} {axis:>11} "
            f"{channel['samples']:>9} {numbers[0]:>11} {numbers[1]:>11} {numbers[2]:>11}  {point}"
        )
        if channel["remark"]:
            lines.append(f"{'':>6}{channel['remark']}")
    if len(content["channels"]) > SHOWN:
        lines.append(f"{'':>6}{len(content['channels']) - SHOWN} more channels; --json lists all")
    if content["modes"]:
        lines.append(f"{'mode':>6} {'[Hz]':>10} {'damping':>9} {'modal mass':>12} {'points':>7}")
    for mode in content["modes"]:
        mass = "-" if mode["modal_mass"] is None else f"{mode['modal_mass']:.5g} kg"
        complex_note = " complex" if mode["complex"] else ""
        lines.append(
            f"{mode['number']:>6} {mode['frequency_hz']:>10.4f} {100 * mode['damping_ratio']:>7.2f} % {mass:>12} "
            f"{mode['points']:>7}{complex_note}  {mode['name']}"
        )
    lines += [f"notice: {text}" for text in content["notices"]]
    lines += [f"finding: {text}" for text in content.get("findings", ())]
    if content["command"]:
        lines += [f"{content['command_reason']}:", f"  {content['command']}"]
    else:
        lines.append(f"no command: {content['command_reason']}")
    if content["comparison"]:
        count = len(content["comparison_left_out"])
        others = f"; {count} more channels fit, --json lists them" if count else ""
        lines += ["to compare the measured accelerations with the run of that command (replace RUN by its folder; "
                  f"`tune` accepts the same --map){others}:",
                  f"  {content['comparison']}"]  # fmt: skip
    return "\n".join(lines)


main = command(parser, InspectSettings, _job)
