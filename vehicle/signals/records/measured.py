"""What a file measured, under the names of the model: responses, time histories, mode shapes."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from vehicle.errors import ConfigurationError, DataError
from vehicle.names import channel_units
from vehicle.signals.analysis.frf import frequency_responses
from vehicle.signals.analysis.local_rational import local_rational_responses
from vehicle.signals.records.channel import Measurement
from vehicle.signals.records.choice import Choice, choose, pick
from vehicle.signals.records.frf import FrfData
from vehicle.signals.records.integration import displacement, filtered
from vehicle.signals.records.measured_frf import is_response, measured_frfs
from vehicle.signals.records.reader import read_record
from vehicle.signals.records.table import Record
from vehicle.signals.records.units import find_unit

FRF_BAND = (1.0, 50.0)
"""Frequencies of an estimated response [Hz], those of the simulated one."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Measured:
    """Measured channels under the names of the model.

    Attributes:
        file: what it was read from.
        frf: responses to the plate; None where there are none.
        record: time histories; None where there are none.
        notices: a sentence for each channel, and for everything that was done.
        estimator: of the responses, where they were estimated here; else empty.
        start: time at which the file begins [s], in the times of the record, which may be an excerpt.
    """

    file: Measurement
    frf: FrfData | None
    record: Record | None
    notices: tuple[str, ...]
    estimator: str = ""
    start: float = 0.0


def read_measured(
    path: Path | str,
    known: Sequence[str],
    choice: Choice | None = None,
    *,
    turned: Collection[str] = (),
    window: float | None = None,
    measurement: Measurement | None = None,
) -> Measured:
    """Read the chosen channels of a measurement file.

    A channel over frequency is a response, any other a time history. Where a plate and accelerations were measured as
    time histories and no response is chosen, the responses are estimated from them, as those of a run are.

    Args:
        path: the file, of any format.
        known: names of the channels of the model.
        choice: name in the model to channel in the file, and what is done to it; by default all channels that have a
            name of the model.
        turned: names whose sign is turned.
        window: length of Hann windows for an estimated response [s]; by default the local rational model.
        measurement: the file, where it was read before.

    Returns:
        Responses [m/s2 per m] and time histories in SI units, those that the file has.

    Raises:
        ConfigurationError: no such file, or a name that the model does not have.
        DataError: bad data, or nothing to compare.
    """
    asked = Choice() if choice is None else choice
    file = read_record(path, asked.databases) if measurement is None else measurement
    roles = {name: wanted for name, wanted in asked.channels.items() if name != "time"} or _same_names(file, known)
    unknown = next((name for name in (*roles, *turned) if name not in known), None)
    if unknown is not None:
        close = get_close_matches(unknown, known, n=3)
        raise ConfigurationError(
            f"--map {unknown}=...: the model has no such channel; names are as knuckle_fr_acc_z"
            + (f"; did you mean {' or '.join(close)}?" if close else "")
        )
    if not roles:
        listed = ", ".join(f"{n} {one.name!r} [{one.unit}]" for n, one in enumerate(file.channels[:20], 1)) or "none"
        raise DataError(
            f"{path}: none of its channels has a name of the model; say what is what: --map knuckle_fr_acc_z=NAME, "
            f"with a number, exact name or pattern with *; the file has {listed}"
        )
    foreign = next((name for name in asked.units if name and name not in roles), None)
    if foreign is not None:
        raise ConfigurationError(f"--unit {foreign}=...: not one of the compared channels: {', '.join(roles)}")
    spectra = {
        name: wanted
        for name, wanted in roles.items()
        if is_response(file.channels[pick(file, wanted, option=f"--map {name}=", allowed=_is_data)])
    }
    frf: FrfData | None = None
    record: Record | None = None
    notices: list[str] = []
    estimator, start = "", 0.0
    if spectra:
        wrong = next((name for name in spectra if channel_units([name])[name] != "m/s2"), None)
        if wrong is not None:
            raise DataError(f"{path}: --map {wrong}=...: is a response; the model has those of accelerations alone")
        frf, notices = measured_frfs(file, spectra, asked, turned)
    histories = {name: wanted for name, wanted in roles.items() if name not in spectra}
    if histories:
        times = {role: wanted for role, wanted in asked.channels.items() if role == "time"}
        begins = [file.channels[pick(file, wanted, allowed=_is_data)].axis for wanted in histories.values()]
        start = min((float(axis[0]) for axis in begins if axis is not None and asked.rate is None), default=0.0)
        record = _record(file, replace(asked, channels={**times, **histories}), turned)
        notices += record.notices
        if frf is None:
            found = estimated_frf(record, window)
            if found is not None:
                frf, estimator = found
                notices.append(f"responses estimated from the time histories: {estimator}")
            elif "m/s2" in record.units.values():
                notices.append("no responses: no moving plate is among the channels; --map plate_fr_displacement=NAME")
    return Measured(
        file=file,
        frf=frf,
        record=record,
        notices=tuple(dict.fromkeys([*file.notices, *notices])),
        start=start,
        estimator=estimator,
    )


def _is_data(channel: object) -> bool:
    return getattr(channel, "function", "") not in ("coherence", "random error")


def _same_names(file: Measurement, known: Sequence[str]) -> dict[str, str]:
    """Names of the model that channels of a file have, alone or as "knuckle_fr_acc_z / plate_fr"; responses first."""
    found: dict[str, str] = {}
    for wants_response in (True, False):
        for number, one in enumerate(file.channels, 1):
            name = one.name.split(" / plate_")[0]
            if name in known and name not in found and _is_data(one) and is_response(one) is wants_response:
                found[name] = str(number)
    return found


def _record(file: Measurement, choice: Choice, turned: Collection[str]) -> Record:
    """Time histories in SI at uniform times."""
    chosen = choose(file, choice)
    chosen.require_uniform(file.path)
    units = channel_units(chosen.values)
    moves = {name: values for name, values in chosen.values.items() if units[name] == "m"}
    others = {name: values for name, values in chosen.values.items() if name not in moves}
    for name in others:
        known = find_unit(units[name].replace(" ", ""))
        if known is not None and chosen.quantities[name] != known.quantity:
            raise DataError(
                f"{file.path}: {name} is a {known.quantity} in the model, the channel is a {chosen.quantities[name]}; "
                f"choose another, or give --unit {name}={units[name]} if the file is wrong"
            )
    notices = list(chosen.notices)
    if moves:
        found, said = displacement(replace(chosen, values=moves), choice, str(file.path))
        moves, notices = dict(found), [*notices, *said]
    if others and choice.highpass is not None:
        found, said = filtered(replace(chosen, values=others), choice.highpass)
        others, notices = dict(found), [*notices, said[-1]]
    every = {name: (moves | others)[name] for name in chosen.values}
    for name in turned:
        if name in every:
            every[name] = -every[name]
            notices.append(f"{name}: sign turned on request")
    return Record(time=chosen.time, channels=every, units=units, notices=tuple(notices), highest=chosen.highest)


def estimated_frf(record: Record, window: float | None = None) -> tuple[FrfData, str] | None:
    """Responses of the accelerations of a record to its first plate that moves.

    Args:
        record: time histories under the names of the model.
        window: length of Hann windows [s]; None for the local rational model on the whole record.

    Returns:
        The responses, and the name of the estimator; None where no plate moves or nothing accelerates.

    Raises:
        DataError: the record is too short, or two plates move alike.
    """
    plates = [name for name, unit in record.units.items() if unit == "m" and name.startswith("plate_")]
    plates = [name for name in plates if np.ptp(record.channels[name]) > 0.0]
    names = [name for name, unit in record.units.items() if unit == "m/s2"]
    if not plates or not names:
        return None
    inputs = np.array([record.channels[name] for name in plates])
    outputs = np.array([record.channels[name] for name in names])
    highest = min(FRF_BAND[1], record.usable)
    about = {"band": (FRF_BAND[0], highest), "names": names, "input_names": plates}
    if window is None:
        found = local_rational_responses(record.step, inputs, outputs, **about)[0]  # type: ignore[arg-type]
    else:
        found = frequency_responses(record.step, inputs, outputs, window_s=window, **about)[0]  # type: ignore[arg-type]
    data = FrfData(
        frequency=found.frequency,
        channels=tuple(names),
        response=found.response,
        coherence=found.coherence,
        random_error=found.random_error,
    )
    return data, found.estimator + (f", Hann windows of {window:g} s" if window is not None else "")
