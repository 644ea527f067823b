"""Evaluate a record of acceleration after ISO 2631-1 or BS 6841: `python -m vehicle.comfort --input FILE.csv`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.input_options import record_options
from vehicle.commands.options import command_parser, message_options, setting_options
from vehicle.commands.parser import Parser
from vehicle.commands.several_files import each_file, expanded, raise_worst, table_of
from vehicle.errors import ConfigurationError
from vehicle.names import AXES
from vehicle.settings import Settings, part, setting
from vehicle.signals.records.record_settings import RecordSettings

if TYPE_CHECKING:
    from vehicle.signals.records.choice import Choice
    from vehicle.signals.records.record_comfort import RecordComfort


@dataclass(frozen=True, kw_only=True, slots=True)
class ComfortSettings(Settings):
    """Settings of the comfort values of acceleration records.

    Attributes:
        record: channels of the axes or the point of a run, units and times.
    """

    inputs: tuple[str, ...] = setting(
        "table with the columns time [s],x [m/s2],y [m/s2],z [m/s2] (or [g]; z alone is sufficient), or any "
        "measurement file. Several files, or a folder, give one table",
        flag="--input",
        required=True,
        nargs="+",
        action="extend",
        metavar="FILE",
    )
    record: RecordSettings = part(RecordSettings)
    rail: str | None = setting(
        "acceleration below the seat: the point of a run, for example seat_rail, or z=NAME in a measurement "
        "file. Adds the SEAT value [-]: weighted z acceleration on the seat divided by that below the seat",
        metavar="PLACE|z=NAME",
    )
    place: str = setting(
        "point of contact, which sets weightings and factors: seat (default; z Wk, x and y Wd), "
        "backrest, feet, seat_rotation, standing, seat_bs6841, backrest_bs6841, feet_bs6841, hand (ISO "
        "5349-1: Wh), steering_wheel (Giacomin 2004: Ws), train_floor (EN 12299: mean comfort of 5 minutes)",
        "seat",
        metavar="NAME",
    )
    offset: str = setting(
        "mean and drift of the signal. refuse (default): stop if they change a weighted value by more than "
        "1 %% or if the mean is gravity. remove: subtract them, a sensor's offset or gravity. keep: leave "
        "them in; the record starts at rest, so its first seconds count for MTVV, crest factor and MSDV too",
        "refuse",
        choices=("refuse", "remove", "keep"),
    )
    mtvv: Literal["linear", "exponential"] = setting(
        "running average for the MTVV (maximum transient vibration value)", "linear", choices=("linear", "exponential")
    )
    skip: float = setting(
        "leave out the first S seconds after weighting [s]; default: 0", 0.0, within="[0, inf)", type=float, metavar="S"
    )
    exposure: float | None = setting(
        "hours a day with this vibration [h]; adds the daily exposure A(8) of a hand, a seat or a standing "
        "person, with action value and limit value (Directive 2002/44/EC)",
        within="(0, 24]",
        type=float,
        metavar="HOURS",
    )


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser(
        "comfort",
        "Compute comfort values of an acceleration record: weighted RMS, MTVV, crest factor, VDV, MSDV, sums.",
    )
    setting_options(parser, ComfortSettings, "inputs")
    channels = parser.add_argument_group("channels of the file")
    channels.add_argument(
        "--channel",
        dest="picks",
        action="append",
        default=[],
        metavar="PLACE|AXIS=NAME",
        help="for the time.csv or time.npz of a run: the point, for example seat_rail. For a measurement file: "
        'the channel of each axis x, y and z, for example x="Seat X" (number, exact name, or pattern with '
        "*). Default: columns x, y, z",
    )
    setting_options(channels, ComfortSettings, "rail")
    record_options(channels, "", channel=False)
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    weighting = parser.add_argument_group("evaluation")
    setting_options(weighting, ComfortSettings, "place", "offset", "skip", "exposure", "mtvv")
    message_options(parser)
    return parser


def _picked(record: RecordSettings, picks: Sequence[str]) -> tuple[str | None, Choice | None]:
    """Return the point of a run, or the choice of channels, that the texts of an option name."""
    points = [text for text in picks if "=" not in text]
    if len(points) > 1 or (points and len(picks) > 1):
        raise ConfigurationError("--channel: give one point of a run, or x=NAME, y=NAME and z=NAME")
    channels = replace(record, picks=tuple(text for text in picks if "=" in text))
    return (points[0] if points else None), channels.choice("", further=AXES)


def evaluated(file: str, settings: ComfortSettings) -> RecordComfort:
    """Evaluate a file."""
    from vehicle.signals.analysis.evaluation import application
    from vehicle.signals.records.record_comfort import evaluate_comfort

    application(settings.place)
    point, choice = _picked(settings.record, settings.record.picks)
    rail: tuple[str | None, Choice | None] = (None, None)
    if settings.rail is not None:
        axis, equals, name = settings.rail.partition("=")
        if equals and axis != "z":
            raise ConfigurationError(
                f"--rail {settings.rail}: the SEAT value needs a z acceleration; give z=NAME, or a point of a run"
            )
        rail = _picked(settings.record, [f"z={name}"] if equals else [settings.rail])
    result = evaluate_comfort(
        file,
        point,
        choice=choice,
        rail=rail[0],
        rail_choice=rail[1],
        contact=settings.place,
        offset=settings.offset,
        average=settings.mtvv,
        skip=settings.skip,
        hours=settings.exposure,
    )
    if settings.rail is None and "seat" not in settings.record.picks:
        return result
    more = _about_the_seat(Path(file))
    return replace(result, remarks=(*result.remarks, *more))


def _about_the_seat(file: Path) -> list[str]:
    """Return the notice of a missing seat, if the summary of the run in the same folder contains it."""
    from vehicle.runs.output.run_comfort import NO_SEAT
    from vehicle.signals.records.run_summary import available_summary

    summary = available_summary(file.parent)
    no_seat = NO_SEAT.partition(",")[0]  # equal in all versions
    return [NO_SEAT] if summary and any(text.startswith(no_seat) for text in summary.notices) else []


def _overview(results: list[dict[str, Any]]) -> str:
    """Return the table of several files: weighted RMS of each axis, vector sum, further values of axis z."""

    def row(result: dict[str, Any]) -> list[tuple[str, ...]]:
        sums, z = result["vector_sum"], result["z"]
        numbers = [
            *(None if result[axis] is None else result[axis]["weighted_rms"] for axis in ("x", "y", "z")),
            None if sums is None else sums["weighted_rms"],
            *(None if z is None else z[key] for key in ("mtvv", "crest_factor", "vdv")),
        ]
        cells = ["-" if number is None else f"{number:.4g}" for number in numbers]
        return [(result["input"], f"{result['duration_s']:.4g}", f"{result['sampling_rate_hz']:.6g}", *cells)]

    heads = ("file", "length [s]", "rate [Hz]", "x", "y", "z", "sum", "MTVV z", "crest z", "VDV z")
    caption = "weighted RMS of each axis, vector sum and MTVV [m/s2], crest factor [-], VDV [m/s^1.75]"
    return f"{caption}\n{table_of(heads, results, row)}"


def _job(settings: ComfortSettings, console: Console) -> None:
    """Evaluate the records of --input and print the results."""

    def one(name: str) -> dict[str, Any]:
        return evaluated(name, settings).to_json()

    names, several = expanded(settings.inputs)
    if several:
        console.require_one_file()
        results, errors = each_file(names, one)
        console.result(results, _overview(results))
        raise_worst(errors, len(results))
        return
    result = evaluated(names[0], settings)
    console.accept(result.notices)
    console.result(result.to_json(), result.text())
    for remark in result.notices:
        console.notice(remark)


main = command(parser, ComfortSettings, _job)
