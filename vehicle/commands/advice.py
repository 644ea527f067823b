"""Complete command for a measurement file, from the units and the names of its channels."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.errors import VehicleError
from vehicle.signals.records.channel import NOT_OVER_TIME, ROAD_PROFILE
from vehicle.signals.records.channel_words import axis_of, map_options, suggested_channels, wheel_of, words_of

if TYPE_CHECKING:
    from vehicle.signals.records.channel import Channel, Measurement

SHAKER_WHEEL = "fl"
"""Shaker wheel of the car `focus`, the default of the command `shaker`."""

SHORTEST = 8.0
"""Shortest record for which a comfort value is worth a command [s]."""

LARGEST_CHECKED = 200_000_000
"""Largest file that is read a second time, to see that the command runs [bytes]."""


def command_for(measurement: Measurement, file: str) -> tuple[str, str]:
    """Return the command for a file with its purpose, or the reason for the lack of a command.

    Args:
        measurement: the file.
        file: name of the file as typed.
    """
    if measurement.shapes and not measurement.channels:
        return _line("compare", "--measured", file), "compares the mode shapes with those of a car"
    road = _road(measurement, file)
    if road is not None:
        return road
    histories = [
        (number, channel)
        for number, channel in enumerate(measurement.channels, 1)
        if channel.kind == "time" and channel.axis is not None
    ]
    by = {
        quantity: [(number, channel) for number, channel in histories if channel.quantity == quantity]
        for quantity in ("displacement", "acceleration", "force", "velocity")
    }
    if by["force"] and (by["velocity"] or by["displacement"]) and not by["acceleration"] and len(histories) <= 4:
        return "", (
            "a force with a velocity or a travel: the curve of a damper or a spring; name the file in the vehicle "
            "file, docs/vehicle-file.md"
        )
    if by["displacement"]:
        return _plates(measurement, file, by["displacement"], by["velocity"])
    if by["acceleration"]:
        return _accelerations(measurement, file, by["acceleration"])
    if any(channel.kind == "frequency" for channel in measurement.channels):
        return "", "responses: python -m vehicle compare RUN --measured FILE --map knuckle_fr_acc_z=NAME"
    if histories:
        return "", "no unit is known that tells a displacement or an acceleration: set --unit ROLE=UNIT with --channel"
    if any(channel.function in NOT_OVER_TIME for channel in measurement.channels):
        return "", "the channels are over distance or angle, not over time; export them over time"
    return "", "no channel with times: set --rate HZ, or --channel time=NAME"


def comparison_for(measurement: Measurement, file: str) -> str:
    """Return the command that compares the accelerations of a file with a run of its plate; empty without both.

    Args:
        measurement: the file.
        file: name of the file as typed.
    """
    suggested = suggested_channels(measurement.channels)
    plates = [name for name in suggested if name.startswith("plate_")]
    if not plates or len(plates) == len(suggested):
        return ""
    return f"{_line('compare', 'RUN', '--measured', file)} {map_options(suggested)}"


def _line(*arguments: str) -> str:
    return shlex.join(["python", "-m", "vehicle", *arguments])


def _pick(measurement: Measurement, number: int) -> str:
    """Return the name of a channel if it is unique, else the number of the channel."""
    name = measurement.channels[number - 1].name
    once = sum(channel.name == name for channel in measurement.channels) == 1
    return name if name and once and not name.isdecimal() and not set(name) & set("*?[=") else str(number)


def _road(measurement: Measurement, file: str) -> tuple[str, str] | None:
    """Return the command line that drives over a road profile, and a reason if there is none; None for other files."""
    from vehicle.signals.excitation.measured_road import read_road

    profile = any(channel.function == ROAD_PROFILE for channel in measurement.channels)
    if not profile and not any(channel.name.strip().lower() == "distance" for channel in measurement.channels):
        return None
    try:
        read_road(measurement.path, 1.5)
    except VehicleError as error:
        return ("", f"no road for a car of 1.5 m track: {error}") if profile else None
    return _line(
        "shaker", "--vehicle", "focus_road", "--road", file, "--speed", "80"
    ), "drives over the road at 80 km/h"


def _clock(*channels: Channel) -> tuple[str, ...]:
    """Return the options that make the times of the channels uniform and common."""
    from vehicle.signals.records.clock import clock_options
    from vehicle.signals.records.common_span import blocks_of, cut, resampling_rate

    if any(channel.axis is None for channel in channels):
        return ()
    (block, *others), _ = cut("", blocks_of({str(number): channel for number, channel in enumerate(channels)}))
    options = clock_options(block.time)
    if others and "--resample" not in options:
        options = (*options, "--resample", resampling_rate([block, *others]))
    return options


def _plates(
    measurement: Measurement, file: str, moves: list[tuple[int, Channel]], speeds: list[tuple[int, Channel]]
) -> tuple[str, str]:
    """Return the command for displacements: shaker plates, or a road with a recorded speed."""
    from vehicle.signals.excitation.recorded_road import NAMES
    from vehicle.signals.records.common_span import overlap

    plain = {channel.name.strip().rstrip(".").lower() for _, channel in moves}
    if len(speeds) == 1 and any(plain & set(NAMES[side]) for side in NAMES):
        speed = _pick(measurement, speeds[0][0])
        arguments = ["shaker", "--vehicle", "focus_road", "--road", file, "--speed", f"channel:{speed}"]
        return _line(*arguments, *_clock(moves[0][1])), "drives over the recorded road at the recorded speed"
    wheels: dict[str, int] = {}
    for number, channel in moves:
        wheel = wheel_of(channel.name)
        together = [measurement.channels[other - 1] for other in wheels.values()]
        if wheel and wheel not in wheels and all(overlap(channel, other) for other in together):
            wheels[wheel] = number
    addition = ""
    if not wheels:
        wheels = {SHAKER_WHEEL: moves[0][0]}
        addition = "" if len(moves) == 1 else f"; {len(moves) - 1} more displacements name no wheel"
    car = ["--vehicle", "focus_road"] if set(wheels) - {"fr", "fl"} else []
    names = {measurement.channels[number - 1].name: wheel for wheel, number in wheels.items()}
    roles = {"displacement": SHAKER_WHEEL, **{f"displacement_{wheel}": wheel for wheel in wheels}}
    picks = []
    if any(roles.get(name) != wheel for name, wheel in names.items()) or len(moves) > len(wheels):
        for wheel, number in wheels.items():
            picks += ["--channel", f"{wheel}={_pick(measurement, number)}"]
    arguments = [
        "shaker",
        *car,
        "--input",
        file,
        *picks,
        *_clock(*(measurement.channels[number - 1] for number in wheels.values())),
    ]
    command, why = _tried(measurement.path, arguments, (["--detrend"],))
    purpose = "puts the displacement on the plate of wheel" + ("s " if len(wheels) > 1 else " ") + ", ".join(wheels)
    return (command, purpose + addition) if command else ("", why)


def _tried(path: Path, arguments: list[str], more: Sequence[list[str]]) -> tuple[str, str]:
    """Return the first shaker command whose signal is readable, or the reason why the signals are not."""
    from vehicle.commands.input_options import record_choice
    from vehicle.commands.shaker import parser
    from vehicle.signals.excitation.signal_file import read_signal

    reason = ""
    if path.stat().st_size > LARGEST_CHECKED:
        return _line(*arguments), ""
    for extra in ([], *more):
        options = parser().parse_args([*arguments, *extra][1:])
        try:
            read_signal(path, wheel=SHAKER_WHEEL, choice=record_choice(options, SHAKER_WHEEL))
        except VehicleError as error:
            reason = reason or f"a displacement, but: {error}"
            continue
        return _line(*arguments, *extra), ""
    return "", reason


def _accelerations(measurement: Measurement, file: str, those: list[tuple[int, Channel]]) -> tuple[str, str]:
    """Return the comfort command for the accelerations of one point."""
    import numpy as np

    from vehicle.signals.records.common_span import overlap

    seats = [pair for pair in those if {"seat", "sitz"} & set(words_of(pair[1].name + " " + pair[1].place))]
    axes: dict[str, int] = {}
    for number, channel in seats or those:
        axis = axis_of(channel)
        together = [measurement.channels[other - 1] for other in axes.values()]
        if axis and axis not in axes and all(overlap(channel, other) for other in together):
            axes[axis] = number
    if not axes:
        axes = {"z": (seats or those)[0][0]}
    channel = measurement.channels[next(iter(axes.values())) - 1]
    rate = channel.rate or 0.0
    length = 0.0 if channel.axis is None else float(channel.axis[-1] - channel.axis[0])
    if length < SHORTEST or rate < 25.0:
        return "", f"an acceleration of {length:.3g} s at {rate:.4g} Hz: comfort needs {SHORTEST:g} s at 25 Hz or more"
    picks = [
        word
        for axis in ("x", "y", "z")
        if axis in axes
        for word in ("--channel", f"{axis}={_pick(measurement, axes[axis])}")
    ]
    clock = _clock(*(measurement.channels[number - 1] for number in axes.values()))
    values = [np.real(measurement.channels[number - 1].values) for number in axes.values()]
    still = all(abs(float(np.nanmean(each))) < 1e-3 * float(np.nanstd(each)) for each in values)
    arguments = ["comfort", "--input", file, *picks, *clock, *([] if still else ["--offset", "remove"])]
    which = "the seat" if seats else "the point"
    more = "" if len(those) == len(axes) else f"; {len(those) - len(axes)} more accelerations"
    return _line(*arguments), f"gives the comfort of {which} in {', '.join(sorted(axes))}{more}"
