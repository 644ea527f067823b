"""A run in the formats of other programs: its channels with places and directions, its FRFs, its geometry."""

import re
from collections.abc import Callable, Sequence
from itertools import product
from pathlib import Path
from typing import Any

from vehicle.runs.car import Car, Run
from vehicle.signals.analysis.motion_response import MotionResponse
from vehicle.signals.formats.channel import Channel, uniform_axis
from vehicle.signals.formats.formats import BY_NAME, write_record
from vehicle.signals.formats.geometry import Geometry
from vehicle.signals.formats.table import Record

_ACCELERATION = re.compile(r"(?P<place>\w+)_acc_(?P<axis>[xyz])")
_PLATE = re.compile(r"(?P<place>plate_\w+)_displacement")
_FORCE = re.compile(r"tyre_(?P<wheel>\w+)_force_z")


def time_channels(run: Run) -> tuple[Channel, ...]:
    """Return all channels of a run over the recorded times."""
    step = run.recording.timestep
    axis = uniform_axis(run.time.size, step, float(run.time[0]))
    return tuple(
        Channel(name=name, values=values, unit=run.recording.units[name], axis=axis, **_point(name))
        for name, values in run.recording.channels.items()
    )


def response_channels(responses: Sequence[MotionResponse], channels: Sequence[str]) -> tuple[Channel, ...]:
    """Return each frequency response, followed by its coherence."""
    result = []
    for motion, (row, name) in product(responses, enumerate(channels)):
        plate, response = motion.input, motion.response
        attributes = _point(name) | {"reference": f"plate_{motion.first}+Z"}
        result.append(
            Channel(
                name=f"{name} / {plate}",
                values=response.response[row],
                unit="(m/s2)/(m)",
                axis=response.frequency,
                kind="frequency",
                function="frequency response",
                **attributes,
            )
        )
        result.append(
            Channel(
                name=f"{name} / {plate} coherence",
                values=response.coherence[row],
                axis=response.frequency,
                kind="frequency",
                function="coherence",
                **attributes,
            )
        )
    return tuple(result)


def _point(name: str) -> dict[str, Any]:
    """Return output point and direction of a channel from its name; empty for a damper."""
    match = _ACCELERATION.fullmatch(name)
    if match:
        return {"place": match["place"], "direction": f"+{match['axis'].upper()}"}
    match = _PLATE.fullmatch(name)
    if match:
        return {"place": match["place"], "direction": "+Z"}
    match = _FORCE.fullmatch(name)
    return {"place": f"plate_{match['wheel']}", "direction": "+Z"} if match else {}  # a damper acts between two places


def geometry(of: Car) -> Geometry:
    """Return the output points of a car in the design position, and lines from each plate over its wheel."""
    car = of.vehicle.composition
    points = {output.name: tuple(output.at) for output in car.outputs}
    lines = []
    for wheel in car.wheels:
        plate = f"plate_{wheel.name}"
        above_plate = [name for name in points if re.search(rf"_{wheel.name}(_|$)", name)]
        points[plate] = tuple(wheel.patch)
        lines.append([plate, *sorted(above_plate, key=lambda name: points[name][2])])
    return Geometry(points=points, lines=[line for line in lines if len(line) > 1])


def writer(
    form: str, run: Run, responses: Sequence[MotionResponse], channels: Sequence[str], frame: str
) -> Callable[[Path], None]:
    """Return the function that writes a run in a format.

    Args:
        form: name in `vehicle.signals.formats.formats.WRITTEN`.
        responses: FRFs of the run; may be empty.
        frame: axes of the vectors, in words.
    """
    if BY_NAME[form].table:
        record = Record(time=run.time, channels=run.recording.channels, units=run.recording.units)
        return lambda path: write_record(path, form, record, frame)
    histories = time_channels(run)
    title = f"{run.car.vehicle.name}; {frame}"
    write = BY_NAME[form].function("writer", "write")
    if form in ("rpc", "mf4"):
        return lambda path: write(path, histories, title)
    everything = histories + response_channels(responses, channels)
    if form == "uff":
        return lambda path: write(path, everything, title, geometry(run.car))
    return lambda path: write(path, everything, title)
