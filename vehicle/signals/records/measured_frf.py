"""Measured frequency responses of any file as acceleration over plate displacement."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vehicle.errors import DataError
from vehicle.signals.records.channel import Channel, Measurement
from vehicle.signals.records.choice import Choice, pick
from vehicle.signals.records.frf import RANDOM_ERROR, FrfData
from vehicle.signals.records.table import Vector
from vehicle.signals.records.units import find_ratio

ORDERS = {"displacement": 0, "velocity": 1, "acceleration": 2}
"""Derivatives of a displacement."""

RESPONSES = ("frequency response", "transmissibility")
SAME_LINE = 0.05
"""Lines of two responses that lie nearer than this share of a step are one line."""


def is_response(channel: Channel) -> bool:
    """Whether a channel is one over frequency that is no coherence and no error."""
    return channel.kind == "frequency" and channel.function not in ("coherence", "random error")


def measured_frfs(
    measurement: Measurement, channels: Mapping[str, str], choice: Choice, turned: Collection[str] = ()
) -> tuple[FrfData, list[str]]:
    """The chosen responses over the union of their lines.

    Responses of a motion to a motion become accelerations over displacements by powers of j w: those in m/s2 per m, g
    per m, m/s per m, m/m, also those to an acceleration of the plate. Responses to a force do not: the plates of the
    model are driven by displacements.

    Args:
        measurement: the file.
        channels: name in the model, as knuckle_fr_acc_z, to number, name, pattern or place in the file.
        choice: units, where the file tells none or a wrong one.
        turned: names whose sign is turned.

    Returns:
        The data, and a sentence for each channel.

    Raises:
        DataError: a channel that is none, without a unit, real, or per force.
    """
    found: dict[str, tuple[Channel, NDArray[np.complex128]]] = {}
    notices = []
    for name, wanted in channels.items():
        index = pick(measurement, wanted, option=f"--map {name}=", allowed=is_response)
        one = measurement.channels[index]
        unit = choice.units.get(name, choice.units.get("", ""))
        if unit:
            one = replace(one, unit=unit)
        where = f"{measurement.path}: channel {index + 1} {one.name!r}"
        values, said = _acceleration_per_displacement(one, where, name)
        sign, words = _sign(one, name, name in turned)
        found[name] = (one, sign * values)
        notices.append(
            f"{name}: channel {index + 1} {one.name!r}" + "".join(f"; {text}" for text in (said, *words) if text)
        )
    frequency = _union([one.axis for one, _ in found.values() if one.axis is not None])
    shape = (len(found), frequency.size)
    response = np.full(shape, complex(np.nan, np.nan))
    coherence, random_error = np.full(shape, np.nan), np.full(shape, np.nan)
    for row, (name, (one, values)) in enumerate(found.items()):
        assert one.axis is not None
        place = _places(frequency, one.axis)
        response[row, place] = values
        beside = coherence_of(measurement, one)
        if beside is None:
            notices.append(f"{name}: no coherence beside it; all lines count alike")
        elif beside.axis is not None:
            inside = (beside.axis >= frequency[0]) & (beside.axis <= frequency[-1])
            told = np.clip(np.asarray(beside.values, dtype=np.float64)[inside], 0.0, 1.0)
            coherence[row, _places(frequency, beside.axis[inside])] = told
        error = next((c for c in measurement.channels if c.name == one.name + RANDOM_ERROR), None)
        if error is not None and error.values.size == values.size:
            random_error[row, place] = np.asarray(error.si_values, dtype=np.float64)
    rises = frequency > 0.0
    data = FrfData(
        frequency=frequency[rises],
        channels=tuple(found),
        response=response[:, rises],
        coherence=coherence[:, rises],
        random_error=random_error[:, rises],
    )
    return data, notices


def _acceleration_per_displacement(one: Channel, where: str, name: str) -> tuple[NDArray[np.complex128], str]:
    """A response in m/s2 per m, and what was done to it."""
    if one.axis is None:
        raise DataError(f"{where} has no frequencies; export it with them")
    if one.function not in RESPONSES and not np.iscomplexobj(one.values):
        raise DataError(
            f"{where} is a {one.function} without a phase; needed is a frequency response: complex, or two columns "
            "named real and imag, or magnitude and phase"
        )
    unit = find_ratio(one.unit)
    upper, _, lower = (unit.quantity if unit is not None else "").partition("/")
    if unit is None:
        raise DataError(
            f"{where} has {f'the unit {one.unit!r}, which is not known' if one.unit else one.remark or 'no unit'}; "
            f"give --unit {name}=UNIT, as m/s2/m, g/m, m/m or g/g"
        )
    if lower == "force" or "force" in upper:
        raise DataError(
            f"{where} is in {one.unit}: a response to a force; the plates of the model are driven by displacements, so "
            "the force that goes with one is needed: give the response over the plate's displacement or acceleration, "
            "or the time histories of response and plate"
        )
    if upper not in ORDERS or lower not in ORDERS:
        raise DataError(
            f"{where} is in {one.unit}; needed is a displacement, velocity or acceleration over one of the plate, as "
            f"m/s2/m, g/m or m/m; if the file is wrong, give --unit {name}=UNIT"
        )
    values = np.asarray(one.si_values, dtype=np.complex128)
    power = ORDERS["acceleration"] - ORDERS[upper] + ORDERS[lower]
    said = "" if not power and unit.factor == 1.0 else f"{one.unit} made m/s2 per m"
    return values * (2j * np.pi * one.axis) ** power if power else values, said


def _sign(one: Channel, name: str, turn: bool) -> tuple[float, list[str]]:
    """Sign of the measured against the modelled direction, and what is to be said of it."""
    sign, said = (-1.0 if turn else 1.0), ["sign turned on request"] if turn else []
    backwards = one.direction.startswith("-") != one.reference[-2:-1].startswith("-")
    if backwards:
        sign = -sign
        said.append(f"measured along {one.direction or '?'} to {one.reference or '?'}: sign turned")
    axis = one.direction[-1:].lower()
    if re.fullmatch(r"[xyz]", axis) and not name.endswith(f"_{axis}"):
        said.append(f"measured along {axis} of its own frame")
    return sign, said


def _union(axes: list[Vector]) -> Vector:
    """All lines of several axes, those of one place once."""
    lines = np.sort(np.concatenate(axes))
    step = (
        min(float(np.median(np.diff(axis))) for axis in axes if axis.size > 1) if any(a.size > 1 for a in axes) else 0.0
    )
    return np.asarray(lines[np.concatenate([[True], np.diff(lines) > SAME_LINE * step])])


def _places(frequency: Vector, axis: Vector) -> NDArray[np.int64]:
    """Index of the nearest line of the union for each line of an axis."""
    right = np.clip(np.searchsorted(frequency, axis), 1, max(frequency.size - 1, 1))
    left = right - 1
    if frequency.size < 2:
        return np.zeros(axis.size, dtype=np.int64)
    return np.asarray(np.where(axis - frequency[left] < frequency[right] - axis, left, right), dtype=np.int64)


def coherence_of(measurement: Measurement, one: Channel) -> Channel | None:
    """The coherence that belongs to a response: at the same place to the same reference, or of the same name.

    Args:
        measurement: the file.
        one: the response.
    """
    those = [c for c in measurement.channels if c.function == "coherence" and not np.iscomplexobj(c.values)]
    point = (one.place, one.direction, one.reference)
    if any(point[:2]):
        same = [c for c in those if (c.place, c.direction, c.reference) == point]
        if len(same) == 1:
            return same[0]
    named = [c for c in those if _plain(c.name) == _plain(one.name)]
    return named[0] if len(named) == 1 else None


def _plain(name: str) -> str:
    """A name without the words that tell a response from its coherence."""
    return re.sub(r"coherence|coh\b|gamma2|frf\b|[^a-z0-9+-]", "", name.lower())
