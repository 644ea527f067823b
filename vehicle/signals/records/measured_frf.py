"""Convert measured frequency responses of any file to acceleration over plate displacement."""

import re
from collections.abc import Collection, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.analysis.response_name import ResponseName, parsed_name
from vehicle.signals.analysis.samples import Complex
from vehicle.signals.formats.channel import Channel, Measurement
from vehicle.signals.formats.frf_file import RANDOM_ERROR, FrfData
from vehicle.signals.formats.units import find_ratio
from vehicle.signals.records.choice import Choice, matching, pick

ORDERS = {"displacement": 0, "velocity": 1, "acceleration": 2}
"""Order of the time derivative of the displacement."""

RESPONSES = ("frequency response", "transmissibility")
REFERENCE = re.compile(r"plate_(?P<wheel>\w+)[+-][xyz]")
"""Reference point of a response that names the plate of a wheel, with its direction."""

SAME_LINE = 0.05
"""Maximum distance of lines of two responses that are merged, over the frequency step [-]."""


def is_response(channel: Channel) -> bool:
    """Return True for a channel over frequency other than a coherence or a random error."""
    return channel.kind == "frequency" and channel.function not in ("coherence", "random error")


def measured_frfs(
    measurement: Measurement, channels: Mapping[str, str], choice: Choice, inverted: Collection[str] = ()
) -> tuple[FrfData, list[str]]:
    """Return the selected frequency responses on the union of their lines, in m/s2 per m.

    Powers of j w convert responses of a motion to a motion (m/s2 per m, g per m, m/s per m, m/m, also per acceleration
    of the plate). Responses to a force are rejected: the inputs of the model are plate displacements.

    The input of a response is that of its role, else the plate that the file names: in the name of the channel, as
    "knuckle_fr_acc_z / plate_fr", or as its reference. Without a plate, a role selects the responses of a point to all
    plates that the file names.

    Args:
        channels: model channel name (knuckle_fr_acc_z or knuckle_fr_acc_z/plate_fr) to number, name, pattern or
            point in the file.
        choice: selection with units that override the file.
        inverted: names of channels whose sign is inverted.

    Returns:
        Frequency responses, and one message per channel or fault.
    """
    responses: dict[ResponseName, tuple[Channel, Complex]] = {}
    notices = []
    for role, wanted in channels.items():
        for name, index in _named_channels(measurement, parsed_name(role), wanted):
            channel, output = measurement.channels[index], name.output
            if name in responses:
                raise DataError(f"{measurement.path}: {name}: mapped twice; name the plate: --map {output}/PLATE=NAME")
            unit = choice.units.get(role, choice.units.get(output, choice.units.get("", "")))
            if unit:
                channel = replace(channel, unit=unit)
            where = f"{measurement.path}: channel {index + 1} {channel.name!r}"
            values, conversion = _acceleration_per_displacement(channel, where, output)
            sign, sign_notes = _sign(channel, output, output in inverted)
            responses[name] = (channel, sign * values)
            notices.append(
                f"{name}: channel {index + 1} {channel.name!r}"
                + "".join(f"; {text}" for text in (channel.remark, conversion, *sign_notes) if text)
            )
    frequency = _union([channel.axis for channel, _ in responses.values() if channel.axis is not None])
    shape = (len(responses), frequency.size)
    response = np.full(shape, complex(np.nan, np.nan))
    coherence, random_error = np.full(shape, np.nan), np.full(shape, np.nan)
    for row, (name, (channel, values)) in enumerate(responses.items()):
        assert channel.axis is not None
        columns = _places(frequency, channel.axis)
        response[row, columns] = values
        coherence_channel = coherence_of(measurement, channel)
        if coherence_channel is None:
            notices.append(f"{name}: the file has no coherence, so all lines have equal weight")
        elif coherence_channel.axis is not None:
            inside = (coherence_channel.axis >= frequency[0]) & (coherence_channel.axis <= frequency[-1])
            values_coherence = np.clip(np.asarray(coherence_channel.values, dtype=np.float64)[inside], 0.0, 1.0)
            coherence[row, _places(frequency, coherence_channel.axis[inside])] = values_coherence
        error = next((c for c in measurement.channels if c.name == channel.name + RANDOM_ERROR), None)
        if error is not None and error.values.size == values.size:
            random_error[row, columns] = np.asarray(error.si_values, dtype=np.float64)
    positive = frequency > 0.0
    data = FrfData(
        frequency=frequency[positive],
        names=tuple(responses),
        response=response[:, positive],
        coherence=coherence[:, positive],
        random_error=random_error[:, positive],
    )
    return data, notices


def input_of(channel: Channel) -> ResponseName:
    """Return the name of a measured response as far as the file has it: output, and input if it is a plate."""
    name = parsed_name(channel.name)
    plate = REFERENCE.fullmatch(channel.reference.lower())
    return name if name.motion or plate is None else parsed_name(f"{name.output}/plate_{plate['wheel']}")


def _named_channels(measurement: Measurement, role: ResponseName, wanted: str) -> list[tuple[ResponseName, int]]:
    """Return the channels of a role with their names: one, or one for each plate that the file names."""
    motions = {
        index: input_of(measurement.channels[index]).motion for index in matching(measurement, wanted, is_response)
    }
    if role.motion and len(motions) > 1:
        motions = {index: motion for index, motion in motions.items() if motion == role.motion} or motions
    if role.motion or len(motions) < 2 or not all(motions.values()) or len(set(motions.values())) < len(motions):
        allowed = {id(measurement.channels[index]) for index in motions}
        index = pick(
            measurement,
            wanted,
            option=f"--map {role}=",
            allowed=lambda channel: is_response(channel) and (not allowed or id(channel) in allowed),
        )
        motions = {index: role.motion or input_of(measurement.channels[index]).motion}
    named = [(ResponseName(role.output, motion), index) for index, motion in motions.items()]
    return sorted(named, key=lambda pair: pair[0].input)


def response_fault(channel: Channel) -> str:
    """Return the reason why a channel over frequency is no response of a motion to a motion; empty if it is one."""
    try:
        _acceleration_per_displacement(channel, f"channel {channel.name!r}", "ROLE")
    except DataError as error:
        return str(error)
    return ""


def _acceleration_per_displacement(channel: Channel, where: str, name: str) -> tuple[Complex, str]:
    """Convert a response to m/s2 per m; return the values and a message on the conversion."""
    if channel.axis is None:
        raise DataError(f"{where} has no frequencies; export it with frequencies")
    if channel.function not in RESPONSES and not np.iscomplexobj(channel.values):
        raise DataError(
            f"{where} is a {channel.function} without a phase; give complex values or two columns, real and imag or "
            "magnitude and phase"
        )
    unit = find_ratio(channel.unit)
    quantity = unit.quantity if unit is not None else ""
    upper, _, lower = ("displacement/displacement" if quantity == "strain" else quantity).partition("/")
    if unit is None:
        raise DataError(
            f"{where} has {f'the unknown unit {channel.unit!r}' if channel.unit else channel.remark or 'no unit'}; "
            f"set --unit {name}=UNIT, for example m/s2/m, g/m, m/m or g/g"
        )
    if lower == "force" or "force" in upper:
        raise DataError(
            f"{where} is in {channel.unit}, a response to a force, but the input of the model is the motion of a "
            "plate: use a response to that motion, or time histories of response and plate"
        )
    if upper not in ORDERS or lower not in ORDERS:
        raise DataError(
            f"{where} is in {channel.unit} but must be a motion per motion of the plate, for example m/s2/m, g/m or "
            "m/m; "
            f"if the unit in the file is wrong, set --unit {name}=UNIT"
        )
    values = np.asarray(channel.si_values, dtype=np.complex128)
    power = ORDERS["acceleration"] - ORDERS[upper] + ORDERS[lower]
    conversion = "" if not power and unit.factor == 1.0 else f"{channel.unit} converted to m/s2 per m"
    return values * (2j * np.pi * channel.axis) ** power if power else values, conversion


def _sign(channel: Channel, name: str, invert: bool) -> tuple[float, list[str]]:
    """Return the sign of the measured relative to the modelled direction, and messages on it."""
    sign, notes = (-1.0 if invert else 1.0), ["sign inverted, as requested"] if invert else []
    backwards = channel.direction.startswith("-") != channel.reference[-2:-1].startswith("-")
    if backwards:
        sign = -sign
        notes.append(
            f"sign inverted, because it was measured along {channel.direction or '?'} with the plate along "
            f"{channel.reference or '?'}"
        )
    axis = channel.direction[-1:].lower()
    if re.fullmatch(r"[xyz]", axis) and not name.endswith(f"_{axis}"):
        notes.append(f"measured along {axis} of the sensor axes")
    return sign, notes


def _union(axes: list[Vector]) -> Vector:
    """Return the union of the lines of several frequency axes; merge lines closer than `SAME_LINE` steps."""
    lines = np.sort(np.concatenate(axes))
    step = (
        min(float(np.median(np.diff(axis))) for axis in axes if axis.size > 1) if any(a.size > 1 for a in axes) else 0.0
    )
    return np.asarray(lines[np.concatenate([[True], np.diff(lines) > SAME_LINE * step])])


def _places(frequency: Vector, axis: Vector) -> NDArray[np.int64]:
    """Return the index of the nearest line of the union for each line of an axis."""
    right = np.clip(np.searchsorted(frequency, axis), 1, max(frequency.size - 1, 1))
    left = right - 1
    if frequency.size < 2:
        return np.zeros(axis.size, dtype=np.int64)
    return np.asarray(np.where(axis - frequency[left] < frequency[right] - axis, left, right), dtype=np.int64)


def coherence_of(measurement: Measurement, response: Channel) -> Channel | None:
    """Find the coherence of a response: same point, direction and reference, or same name; None if ambiguous."""
    coherences = [c for c in measurement.channels if c.function == "coherence" and not np.iscomplexobj(c.values)]
    point = (response.place, response.direction, response.reference)
    if any(point[:2]):
        matches = [c for c in coherences if (c.place, c.direction, c.reference) == point]
        if len(matches) == 1:
            return matches[0]
    named = [c for c in coherences if _plain(c.name) == _plain(response.name)]
    return named[0] if len(named) == 1 else None


def _plain(name: str) -> str:
    """Remove the words that distinguish the names of a response and its coherence."""
    return re.sub(r"coherence|coh\b|gamma2|frf\b|[^a-z0-9+-]", "", name.lower())
