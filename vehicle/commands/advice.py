"""Complete command for a measurement file, from the units and the names of its channels; it accepts the file."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.checked_command import cured_command
from vehicle.errors import VehicleError
from vehicle.signals.formats.channel import NOT_OVER_TIME, ROAD_PROFILE
from vehicle.signals.formats.text import LARGEST
from vehicle.signals.records.channel_words import (
    axis_of,
    by_point,
    is_plate,
    main_channels,
    map_words,
    of_receiver,
    of_wheel_or_engine,
    on_seat,
    suggested_channels,
    wheel_of,
)

if TYPE_CHECKING:
    from vehicle.signals.formats.channel import Channel, Measurement
    from vehicle.signals.records.finding import Finding

Numbered = tuple[int, "Channel"]
"""Number of a channel in its file, and the channel."""

SHAKER_WHEEL = "fl"
"""Shaker wheel of the car `focus`, the default of the command `shaker`."""

SHORTEST = 8.0
"""Shortest record for which a comfort value is worth a command [s]."""

LARGEST_CHECKED = 200_000_000
"""Largest file that is read a second time, to see that the command runs [bytes]."""


def command_for(
    measurement: Measurement, file: str, databases: Sequence[Path] = (), collected: list[Finding] | None = None
) -> tuple[str, str]:
    """Return the command for a file with its purpose, or the reason for the lack of a command.

    Args:
        file: name of the file as typed.
        databases: DBC files that decoded the log of a CAN bus.
        collected: list to which the findings on the record are added whose options the command contains.
    """
    collected = [] if collected is None else collected
    if measurement.shapes and not measurement.channels:
        command, why = _first(measurement, [["compare", "--measured", file]], collected)
        return command, "to compare the mode shapes with a car" if command else f"mode shapes, but: {why}"
    road = _road(measurement, file, collected)
    if road is not None:
        return road
    files = [file, *(word for database in databases for word in ("--dbc", str(database)))]
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
            "force against velocity or travel, so probably the curve of a damper or spring; name this file in the "
            "vehicle file (docs/vehicle-file.md shows where)"
        )
    empty = [channel for _, channel in (*by["displacement"], *by["acceleration"]) if not _has_values(channel)]
    displacements, accelerations = (
        [(number, channel) for number, channel in by[quantity] if _has_values(channel)]
        for quantity in ("displacement", "acceleration")
    )
    reasons = []
    if displacements:
        command, why = _plates(measurement, files, displacements, by["velocity"], collected)
        if command:
            return command, why
        reasons.append(why)
    if accelerations:
        command, why = _accelerations(measurement, files, accelerations, collected)
        if command:
            return command, why
        reasons.append(why)
    if reasons:
        return "", reasons[0]
    if empty:
        note = f" ({empty[0].remark})" if empty[0].remark else ""
        return "", f"{', '.join(channel.name for channel in empty[:4])}: no values{note}"
    if any(channel.kind == "frequency" for channel in measurement.channels):
        return "", _responses(measurement)
    if not measurement.channels:
        return "", "the file has only nodes, no channels"
    if histories:
        return "", (
            "the file states no units, so a displacement looks like an acceleration; set --channel ROLE=NAME and "
            "--unit ROLE=UNIT"
        )
    if any(channel.function in NOT_OVER_TIME for channel in measurement.channels):
        return "", "the channels are recorded against distance or angle; export them against time"
    return "", "the file has no time channel; set --rate HZ, or --channel time=NAME"


def _responses(measurement: Measurement) -> str:
    """Return the command for channels over frequency, or the reason for the lack of a command."""
    from vehicle.signals.records.measured_frf import is_response, response_fault

    faults = [response_fault(channel) for channel in measurement.channels if is_response(channel)]
    if "" in faults:
        return "responses: python -m vehicle compare RUN --measured FILE --map knuckle_fr_acc_z=NAME"
    return faults[0] if faults else "coherences without responses; export the responses as well"


def comparison_for(
    measurement: Measurement, file: str, command: str, collected: list[Finding] | None = None
) -> tuple[str, dict[str, str]]:
    """Return the command that compares the accelerations of a file with a run of its plate, and channels left out.

    Without plate or acceleration the command is empty. The channels left out are names of measured channels by channel
    of the model, as for `--map`, beyond the main ones.

    Args:
        command: command from `command_for`; the comparison uses its run.
        collected: see `command_for`.
    """
    from vehicle.model.parameters.vehicle import load_vehicle
    from vehicle.signals.records.choice import pick

    run_command = shlex.split(command)[3:]
    if run_command[:1] != ["shaker"] or "--road" in run_command:
        return "", {}
    car = Path(run_command[run_command.index("--vehicle") + 1]) if "--vehicle" in run_command else None
    suggested = suggested_channels(measurement.channels, load_vehicle(car).channels)
    plates = [name for name in suggested if name.startswith("plate_")]
    if not plates or len(plates) == len(suggested):
        return "", {}
    main = main_channels(suggested)
    mapped_channels = [measurement.channels[pick(measurement, name)] for name in main.values()]
    databases = [word for at, word in enumerate(run_command) if "--dbc" in run_command[max(at - 1, 0) : at + 1]]
    arguments = ["compare", "RUN", "--measured", file, *databases, *_clock(*mapped_channels)]
    arguments += map_words(main)
    if _is_checked(measurement):
        vehicle = ["--vehicle", str(car)] if car else []
        cured, reason, findings = cured_command(["compare", *vehicle, *arguments[1:]])
        if reason:
            return "", {}
        if collected is not None:
            kinds = {each.kind for each in collected}
            collected += [each for each in findings if each.kind not in kinds]
        arguments = ["compare", *cured[1 + len(vehicle) :]]
    return _line(*arguments), {name: text for name, text in suggested.items() if name not in main}


def _line(*arguments: str) -> str:
    return shlex.join(["python", "-m", "vehicle", *arguments])


def _is_checked(measurement: Measurement) -> bool:
    return measurement.path.stat().st_size <= LARGEST_CHECKED


def _first(measurement: Measurement, candidates: Sequence[list[str]], collected: list[Finding]) -> tuple[str, str]:
    """Return the first command that accepts its file and "", or "" and the reason why the first does not.

    The options of the findings on the record are added to the command, and the findings to `collected`.
    """
    if not _is_checked(measurement):
        return _line(*candidates[0]), ""
    reasons = []
    for arguments in candidates:
        cured, reason, findings = cured_command(arguments)
        if not reason:
            collected += findings
            return _line(*cured), ""
        reasons.append(reason)
    return "", reasons[0]


def _pick(measurement: Measurement, number: int) -> str:
    """Return the name of a channel if it is unique, else the number of the channel."""
    name = measurement.channels[number - 1].name
    once = sum(channel.name == name for channel in measurement.channels) == 1
    return name if name and once and not name.isdecimal() and not set(name) & set("*?[=") else str(number)


def _has_values(channel: Channel) -> bool:
    import numpy as np

    return bool(np.isfinite(channel.values).any())


def _road(measurement: Measurement, file: str, collected: list[Finding]) -> tuple[str, str] | None:
    """Return the command line that drives over a road profile, and a reason if there is none; None for other files."""
    from vehicle.signals.excitation.measured_road import read_road

    profile = any(channel.function == ROAD_PROFILE for channel in measurement.channels)
    if not profile and not any(channel.name.strip().lower() == "distance" for channel in measurement.channels):
        return None
    try:
        read_road(measurement.path, 1.5)
    except VehicleError as error:
        return ("", f"not usable as a road for a car of 1.5 m track: {error}") if profile else None
    arguments = ["shaker", "--vehicle", "focus_road", "--road", file, "--speed", "80"]
    command, why = _first(measurement, [arguments], collected)
    return command, "to drive over the road at 80 km/h" if command else f"a road, but: {why}"


def _clock(*channels: Channel) -> tuple[str, ...]:
    """Return the options that make the times of channels usable and common, in the longest part with all values."""
    import numpy as np

    from vehicle.signals.formats.clock import clock_options
    from vehicle.signals.records.common_span import blocks_of, cut, resampling_rate

    if any(channel.axis is None for channel in channels):
        return ()
    try:
        (block, *others), _ = cut("", blocks_of({str(number): channel for number, channel in enumerate(channels)}))
    except VehicleError:
        return ()  # the command reports it
    time = block.time
    valid = np.all([np.isfinite(channel.values) for channel in block.channels.values()], axis=0)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], valid, [False]]).astype(int))).reshape(-1, 2)
    if valid.all() or not edges.size:
        options = clock_options(time)
    else:
        begin, end = edges[int(np.argmax(edges[:, 1] - edges[:, 0]))].tolist()
        options = clock_options(time[begin:end])
        if "--from" not in options:
            options = ("--from", f"{time[begin]:.9g}", "--to", f"{time[end - 1]:.9g}", *options)
    if others and "--resample" not in options:
        options = (*options, "--resample", resampling_rate([block, *others]))
    return options


def _plates(
    measurement: Measurement,
    files: list[str],
    displacements: list[Numbered],
    speeds: list[Numbered],
    collected: list[Finding],
) -> tuple[str, str]:
    """Return the command for displacements: shaker plates, or a road with a recorded speed."""
    from vehicle.signals.excitation.recorded_road import NAMES
    from vehicle.signals.records.common_span import overlap

    of_tracks = {name for names in NAMES.values() for name in names}
    tracks = [channel for _, channel in displacements if channel.name.strip().rstrip(".").lower() in of_tracks]
    if len(speeds) == 1 and tracks and not of_receiver(measurement.channels):
        speed = _pick(measurement, speeds[0][0])
        arguments = ["shaker", "--vehicle", "focus_road", "--road", *files, "--speed", f"channel:{speed}"]
        same = [channel for _, channel in speeds if channel.axis is tracks[0].axis]  # others are interpolated
        command, why = _first(measurement, [[*arguments, *_clock(*tracks, *same)]], collected)
        return command, "to drive over the recorded road at the recorded speed" if command else f"a road, but: {why}"
    moves = [(number, channel) for number, channel in displacements if is_plate(channel)]
    if not moves:
        number, channel = displacements[0]
        shown = ", ".join(repr(each.name) for _, each in displacements[:4])
        option = shlex.join(["--channel", f"{wheel_of(channel.name) or SHAKER_WHEEL}={_pick(measurement, number)}"])
        return "", (
            f"a displacement, but nothing in the name {shown} points to a plate under a wheel (plate, shaker, poster, "
            f"actuator, Stempel ...); if it is the motion of a plate, run shaker with {option}"
        )
    wheels: dict[str, int] = {}
    for number, channel in moves:
        wheel = wheel_of(channel.name)
        plates = [measurement.channels[other - 1] for other in wheels.values()]
        if wheel and wheel not in wheels and all(overlap(channel, other) for other in plates):
            wheels[wheel] = number
    addition = ""
    if not wheels:
        wheels = {SHAKER_WHEEL: moves[0][0]}
        addition = (
            ""
            if len(moves) == 1
            else f"; {len(moves) - 1} more displacements are not used, because their names state no wheel"
        )
    car = ["--vehicle", "focus_road"] if set(wheels) - {"fr", "fl"} else []
    names = {measurement.channels[number - 1].name: wheel for wheel, number in wheels.items()}
    roles = {"displacement": SHAKER_WHEEL, **{f"displacement_{wheel}": wheel for wheel in wheels}}
    picks = []
    if any(roles.get(name) != wheel for name, wheel in names.items()) or len(displacements) > len(wheels):
        for wheel, number in wheels.items():
            picks += ["--channel", f"{wheel}={_pick(measurement, number)}"]
    clock = _clock(*(measurement.channels[number - 1] for number in wheels.values()))
    arguments = ["shaker", *car, "--input", *files, *picks, *clock]
    command, why = _first(measurement, [arguments, [*arguments, "--detrend"]], collected)
    purpose = "to drive the plate of wheel" + ("s " if len(wheels) > 1 else " ") + ", ".join(wheels) + " with it"
    return (command, purpose + addition) if command else ("", f"a displacement, but: {why}")


def _accelerations(
    measurement: Measurement, files: list[str], those: list[Numbered], collected: list[Finding]
) -> tuple[str, str]:
    """Return the comfort command for the accelerations of one point."""
    import numpy as np

    from vehicle.signals.records.common_span import overlap

    seats = [pair for pair in those if on_seat(pair[1])]
    points = by_point(seats or [pair for pair in those if not of_wheel_or_engine(pair[1])])
    if not points:
        return "", "accelerations of wheels or engine only; comfort needs an acceleration of a seat or of the floor"
    # The first of the points with the most axes.
    of_point = max(points, key=lambda pairs: len({axis_of(channel) for _, channel in pairs} - {""}))
    axes: dict[str, int] = {}
    for number, channel in of_point:
        axis = axis_of(channel)
        assigned = [measurement.channels[other - 1] for other in axes.values()]
        if axis and axis not in axes and all(overlap(channel, other) for other in assigned):
            axes[axis] = number
    if not axes:
        number, channel = of_point[0]
        option = shlex.join(["--channel", f"z={_pick(measurement, number)}"])
        return "", (
            f"an acceleration, but the name {channel.name!r} states no direction; if it is vertical, run comfort with "
            f"{option}, otherwise with x= or y="
        )
    chosen = [measurement.channels[number - 1] for number in axes.values()]
    rate = chosen[0].rate or 0.0
    length = chosen[0].values.size / rate if rate else 0.0
    if length < SHORTEST or rate < 25.0:
        return "", (
            f"an acceleration of {length:.3g} s, sampled at {rate:.4g} Hz: comfort needs at least {SHORTEST:g} "
            "s, sampled at 25 Hz or more"
        )
    picks = [
        word
        for axis in ("x", "y", "z")
        if axis in axes
        for word in ("--channel", f"{axis}={_pick(measurement, axes[axis])}")
    ]
    values = [np.real(channel.values) for channel in chosen]
    values = [each[np.abs(each) <= LARGEST] for each in values]  # False for NaN; the squares of larger ones overflow
    still = all(each.size and abs(float(np.mean(each))) < 1e-3 * float(np.std(each)) for each in values)
    arguments = ["comfort", "--input", *files, *picks, *_clock(*chosen)]
    removed = [*arguments, "--offset", "remove"]
    command, why = _first(measurement, [arguments, removed] if still else [removed], collected)
    which, others = "the seat" if seats else "the point", len(those) - len(axes)
    more = f"; {others} other acceleration{'s are' if others > 1 else ' is'} not used" if others else ""
    if not command:
        return "", f"an acceleration, but: {why}"
    return command, f"to compute the comfort of {which} in {', '.join(sorted(axes))}{more}"
