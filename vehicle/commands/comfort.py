"""Evaluate a record of acceleration after ISO 2631-1 or BS 6841: `python -m vehicle.comfort --input FILE.csv`."""

from __future__ import annotations

import argparse
import json
import sys
from typing import Any

from vehicle.commands.command_line import Parser, command
from vehicle.commands.options import command_parser, message_options, record_choice, record_options
from vehicle.errors import ConfigurationError, DataError


def parser() -> Parser:
    """The options of the command."""
    found = command_parser(
        "comfort", "Weighted RMS, MTVV, crest factor, VDV, MSDV and vector sums of a record of acceleration."
    )
    found.add_argument(
        "--input",
        required=True,
        metavar="FILE",
        help="columns time [s],x [m/s2],y [m/s2],z [m/s2] (or [g]), or any measurement file",
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


def _evaluate(options: argparse.Namespace) -> dict[str, Any]:
    """Read, treat the offset as asked, and evaluate."""
    import numpy as np

    from vehicle.analysis.evaluation import (
        AXES,
        LARGEST_MEAN,
        OFFSET_EFFECT,
        application,
        evaluate,
        offset_effect,
        offset_line,
        without_offset,
    )
    from vehicle.records.acceleration import read_acceleration

    application(options.place)
    places = [text for text in options.picks if "=" not in text]
    if len(places) > 1 or (places and len(options.picks) > 1):
        raise ConfigurationError("--channel: give one PLACE, or x=NAME, y=NAME and z=NAME")
    options.picks = [text for text in options.picks if "=" in text]
    record = read_acceleration(options.input, places[0] if places else None, record_choice(options, ""))
    xyz = np.array(list(record.channels.values()))
    mean = xyz.mean(axis=1)
    line = offset_line(xyz)
    drift = line[:, -1] - line[:, 0]
    if options.offset == "refuse":
        effects = offset_effect(record.step, xyz, place=options.place)
        for axis, effect, offset, change in zip(AXES, effects, mean, drift, strict=True):
            if effect > OFFSET_EFFECT or abs(offset) > LARGEST_MEAN:
                raise DataError(
                    f"{options.input}: the mean of column {axis!r} is {offset:.4g} m/s2, its drift {change:.2g} m/s2; "
                    f"they change its weighted RMS or VDV by {100 * effect:.3g} %, allowed are "
                    f"{100 * OFFSET_EFFECT:g} % and a mean of {LARGEST_MEAN:g} m/s2; give --offset remove if it is a "
                    "sensor's offset or gravity, --offset keep if the record starts at rest and the mean is real"
                )
    result = evaluate(
        record.step,
        without_offset(xyz) if options.offset == "remove" else xyz,
        place=options.place,
        average=options.mtvv,
        skip=options.skip,
        from_rest=options.offset == "keep",
    )
    offset = {
        "treatment": "removed" if options.offset == "remove" else "kept",
        "mean": dict(zip(AXES, (float(value) for value in mean), strict=True)),
        "drift": dict(zip(AXES, (float(value) for value in drift), strict=True)),
    }
    return {"input": options.input, "offset": offset, **result, "notices": list(record.notices)}


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
    lines = [
        f"{result['input']}: {result['duration_s']:g} s at {result['sampling_rate_hz']:g} Hz, {result['place']} "
        f"({result['standard']})",
        f"{'':16}{'x':>12}{'y':>12}{'z':>12}",
    ]
    for title, key, unit in rows:
        cells = [result[axis][key] for axis in ("x", "y", "z")]
        shown = ["-" if v is None else v if isinstance(v, str) else f"{v:.4g}" for v in cells]
        lines.append(f"{title:16}" + "".join(f"{cell:>12}" for cell in shown) + f"  {unit}".rstrip())
    sums = result["vector_sum"]
    lines.append(f"vector sum of RMS (comfort)  {sums['weighted_rms']:.4g} m/s2")
    if sums["health_weighted_rms"] is not None:
        lines.append(f"vector sum of RMS (health)   {sums['health_weighted_rms']:.4g} m/s2")
    lines.append(f"sum of VDV (fourth power)    {sums['vdv']:.4g} m/s^1.75")
    return "\n".join(lines)


def _job(options: argparse.Namespace) -> None:
    """Evaluate and print."""
    result = _evaluate(options)
    print(json.dumps(result, indent=2, allow_nan=False) if options.json else _table(result), flush=True)
    for remark in (*result["notices"], *result["reasons"]):
        print(f"notice: {remark}", file=sys.stderr)


main = command(parser, _job)
