"""Evaluate a record of acceleration after ISO 2631-1 or BS 6841: `python -m vehicle.comfort --input FILE.csv`."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.command_line import command
from vehicle.commands.input_options import record_choice, record_options
from vehicle.commands.options import command_parser, message_options
from vehicle.commands.parser import Parser
from vehicle.commands.several_files import each_file, expanded, raise_worst, table_of
from vehicle.errors import ConfigurationError, DataError

if TYPE_CHECKING:
    from vehicle.records.table import Record


def parser() -> Parser:
    """The options of the command."""
    found = command_parser(
        "comfort", "Weighted RMS, MTVV, crest factor, VDV, MSDV and vector sums of a record of acceleration."
    )
    found.add_argument(
        "--input",
        dest="inputs",
        required=True,
        nargs="+",
        action="extend",
        metavar="FILE",
        help="columns time [s],x [m/s2],y [m/s2],z [m/s2] (or [g]), or any measurement file; z alone will do; several "
        "files, or a folder, give one table",
    )
    found.add_argument(
        "--channel",
        dest="picks",
        action="append",
        default=[],
        metavar="PLACE|AXIS=NAME",
        help="point of a run, as seat_rail in its time.csv or time.npz; columns x, y, z by default; or the channel of "
        'axis in any measurement file, as x="Seat X" (number, exact name, or pattern with *), for x, y and z',
    )
    found.add_argument(
        "--rail",
        metavar="PLACE|z=NAME",
        help="what is below the seat, as seat_rail, or z=NAME in any measurement file: gives the SEAT value too, the "
        "weighted z acceleration of --channel over that of the rail, both by the weighting of the seat [-]",
    )
    record_options(found, "", channel=False)
    found.add_argument("--json", action="store_true", help="print the result as JSON")
    found.add_argument(
        "--place",
        default="seat",
        metavar="NAME",
        help="point of contact, names weightings and factors: seat (default; z Wk, x and y Wd), backrest, feet, "
        "seat_rotation, standing, seat_bs6841, backrest_bs6841, feet_bs6841",
    )
    found.add_argument(
        "--offset",
        choices=("refuse", "remove", "keep"),
        default="refuse",
        help="mean and drift of an axis: refuse a record where they change a weighted RMS or VDV by more than 1 %% or "
        "the mean is that of gravity (default), remove them (a sensor's offset, gravity), or keep them: the record "
        "starts at rest, so that its first seconds count for MTVV, crest factor and MSDV too",
    )
    found.add_argument(
        "--skip",
        type=float,
        default=0.0,
        metavar="S",
        help="seconds left out at the beginning of the weighted records; 0 by default",
    )
    found.add_argument(
        "--mtvv", choices=("linear", "exponential"), default="linear", help="running average of the MTVV"
    )
    message_options(found)
    return found


def _read(options: argparse.Namespace, picks: Sequence[str], judged: str = "xyz") -> Record:
    """Acceleration of one point; mean and drift of the axes that are judged are refused where they matter.

    Raises:
        ConfigurationError: both a place and channels of axes.
        DataError: as of `read_acceleration`, or an offset.
    """
    import numpy as np

    from vehicle.analysis.evaluation import LARGEST_MEAN, OFFSET_EFFECT, offset_effect, offset_line
    from vehicle.records.acceleration import read_acceleration

    places = [text for text in picks if "=" not in text]
    if len(places) > 1 or (places and len(picks) > 1):
        raise ConfigurationError("--channel: give one PLACE, or x=NAME, y=NAME and z=NAME")
    own = argparse.Namespace(**{**vars(options), "picks": [text for text in picks if "=" in text]})
    record = read_acceleration(options.input, places[0] if places else None, record_choice(own, ""))
    if options.offset == "refuse":
        xyz = np.array(list(record.channels.values()))
        line = offset_line(xyz)
        ends = zip(
            record.channels,
            offset_effect(record.step, xyz, place=options.place, axes=list(record.channels)),
            xyz.mean(axis=1),
            line[:, -1] - line[:, 0],
            strict=True,
        )
        for axis, effect, offset, change in ends:
            if axis in judged and (effect > OFFSET_EFFECT or abs(offset) > LARGEST_MEAN):
                raise DataError(
                    f"{options.input}: the mean of column {axis!r} is {offset:.4g} m/s2, its drift {change:.2g} m/s2; "
                    f"they change its weighted RMS or VDV by {100 * effect:.3g} %, allowed are "
                    f"{100 * OFFSET_EFFECT:g} % and a mean of {LARGEST_MEAN:g} m/s2; give --offset remove if it is a "
                    "sensor's offset or gravity, --offset keep if the record starts at rest and the mean is real"
                )
    return record


def _evaluate(options: argparse.Namespace) -> dict[str, Any]:
    """Read, treat the offset as asked, and evaluate."""
    import numpy as np

    from vehicle.analysis.evaluation import application, evaluate, offset_line, without_offset
    from vehicle.records.channel_faults import copies

    application(options.place)
    if options.rail is not None and options.place not in ("seat", "seat_bs6841"):
        raise ConfigurationError(f"--place {options.place}: --rail asks for the value of a seat; leave one of them out")
    record = _read(options, options.picks)
    axes, xyz = list(record.channels), np.array(list(record.channels.values()))
    twice = [
        f"{one} and {other} hold the same samples, which the vector sum counts twice: was a channel copied, or chosen "
        f"twice? Choose another: --channel {other}=NAME"
        for one, other in copies(record.channels)
    ]
    removed = options.offset == "remove"
    result = evaluate(
        record.step,
        without_offset(xyz) if removed else xyz,
        place=options.place,
        average=options.mtvv,
        skip=options.skip,
        from_rest=options.offset == "keep",
        axes=axes,
        highest=record.usable,
    )
    line = offset_line(xyz)
    offset = {
        "treatment": "removed" if removed else "kept",
        "mean": dict(zip(axes, (float(value) for value in xyz.mean(axis=1)), strict=True)),
        "drift": dict(zip(axes, (float(value) for value in line[:, -1] - line[:, 0]), strict=True)),
    }
    found = {"input": options.input, "offset": offset, **result, "notices": [*record.notices, *twice]}
    if options.rail is not None:
        found["seat_value"] = _seat_value(options, record)
    if options.rail is not None or "seat" in options.picks:
        found["notices"] += _about_the_seat(Path(options.input))
    return found


def _seat_value(options: argparse.Namespace, seat: Record) -> dict[str, Any]:
    """What the seat does to the vibration below it.

    Raises:
        ConfigurationError: `--rail` names another axis than z.
    """
    import numpy as np

    from vehicle.analysis.evaluation import without_offset
    from vehicle.analysis.seat_value import seat_value

    axis, equals, name = options.rail.partition("=")
    if equals and axis != "z":
        raise ConfigurationError(f"--rail {options.rail}: the value of a seat is that of z; give z=NAME, or a place")
    rail = _read(options, [f"z={name}"] if equals else [options.rail], judged="z")
    if "z" not in seat.channels or "z" not in rail.channels:
        raise ConfigurationError("--rail: the value of a seat is that of z, which was not measured at both places")
    both = np.array([seat.channels["z"], rail.channels["z"]])
    both = without_offset(both) if options.offset == "remove" else both
    return asdict(seat_value(seat.step, both[0], both[1], place=options.place, skip=options.skip))


def _about_the_seat(file: Path) -> list[str]:
    """What a run in the same folder says of its seat: that there is none."""
    from vehicle.output.run_comfort import NO_SEAT
    from vehicle.records.run_summary import run_summary

    return [NO_SEAT] if NO_SEAT in run_summary(file.parent).get("notices", ()) else []


def _table(result: dict[str, Any]) -> str:
    """Return the result as text for the screen."""
    rows = (
        ("weighting", "weighting", ""),
        ("weighted RMS", "weighted_rms", "m/s2"),
        ("MTVV", "mtvv", "m/s2"),
        ("crest factor", "crest_factor", ""),
        ("VDV", "vdv", "m/s^1.75"),
        ("estimated VDV", "estimated_vdv", "m/s^1.75"),
        ("MSDV (Wf)", "msdv", "m/s^1.5"),
    )
    axes = [axis for axis in ("x", "y", "z") if result[axis] is not None]
    lines = [
        f"{result['input']}: {result['duration_s']:g} s at {result['sampling_rate_hz']:g} Hz, {result['place']} "
        f"({result['standard']})",
        f"{'':16}" + "".join(f"{axis:>12}" for axis in axes),
    ]
    for title, key, unit in rows:
        cells = [result[axis][key] for axis in axes]
        shown = ["-" if v is None else v if isinstance(v, str) else f"{v:.4g}" for v in cells]
        lines.append(f"{title:16}" + "".join(f"{cell:>12}" for cell in shown) + f"  {unit}".rstrip())
    sums = result["vector_sum"]
    if sums is not None:
        lines.append(f"vector sum of RMS (comfort)  {sums['weighted_rms']:.4g} m/s2")
        if sums["health_weighted_rms"] is not None:
            lines.append(f"vector sum of RMS (health)   {sums['health_weighted_rms']:.4g} m/s2")
        lines.append(f"sum of VDV (fourth power)    {sums['vdv']:.4g} m/s^1.75")
    if "seat_value" in result:
        ratio = result["seat_value"]
        lines.append(f"SEAT value (z, {ratio['weighting']})       {ratio['rms']:.4g}, of VDV {ratio['vdv']:.4g}")
    lines.append("values of this record; no statistical error is given (repeat the ride to see the spread)")
    return "\n".join(lines)


def _overview(results: list[dict[str, Any]]) -> str:
    """Return one line for each file: weighted RMS of each axis, their sum, and the measures of z."""
    rows: list[tuple[str, ...]] = []
    for result in results:
        if "error" in result:
            rows.append((result["input"], result["error"]))
            continue
        sums, z = result["vector_sum"], result["z"]
        numbers = [
            *(None if result[axis] is None else result[axis]["weighted_rms"] for axis in ("x", "y", "z")),
            None if sums is None else sums["weighted_rms"],
            *(None if z is None else z[key] for key in ("mtvv", "crest_factor", "vdv")),
        ]
        cells = ["-" if number is None else f"{number:.4g}" for number in numbers]
        rows.append((result["input"], f"{result['duration_s']:.4g}", f"{result['sampling_rate_hz']:.6g}", *cells))
    heads = ("file", "length [s]", "rate [Hz]", "x", "y", "z", "sum", "MTVV z", "crest z", "VDV z")
    caption = "weighted RMS of each axis, their vector sum and MTVV [m/s2], crest factor, VDV [m/s^1.75]"
    return f"{caption}\n{table_of(heads, rows)}"


def _job(options: argparse.Namespace) -> None:
    """Evaluate and print."""

    def one(name: str) -> dict[str, Any]:
        return _evaluate(argparse.Namespace(**{**vars(options), "input": name}))

    names, several = expanded(options.inputs)
    if several:
        results, errors = each_file(names, one)
        print(json.dumps(results, indent=2, allow_nan=False) if options.json else _overview(results), flush=True)
        raise_worst(errors, len(results))
        return
    result = one(names[0])
    print(json.dumps(result, indent=2, allow_nan=False) if options.json else _table(result), flush=True)
    for remark in (*result["notices"], *result["reasons"]):
        print(f"notice: {remark}", file=sys.stderr)


main = command(parser, _job)
