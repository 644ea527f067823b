"""Read measured frequency responses and time histories under the channel names of the model."""

import re
import shlex
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from vehicle.errors import ConfigurationError, DataError
from vehicle.names import channel_units
from vehicle.signals.analysis.motion_response import motion_responses
from vehicle.signals.analysis.response_name import ResponseName, parsed_name
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.formats.frf_file import FrfData, frf_data
from vehicle.signals.formats.reader import read_record
from vehicle.signals.formats.table import Record
from vehicle.signals.formats.units import find_unit
from vehicle.signals.records.channel_words import is_plate, main_channels, map_words, suggested_channels
from vehicle.signals.records.choice import Choice, choose, matching, pick
from vehicle.signals.records.delays import channel_delays, responses_without_delays, without_delays
from vehicle.signals.records.finding import Finding, FindingError
from vehicle.signals.records.integration import displacement, filtered
from vehicle.signals.records.measured_frf import input_of, is_response, measured_frfs
from vehicle.signals.records.plate_offset import without_offsets

EXAMPLES = re.compile(r"plate_\w+_displacement|knuckle_\w+_acc_z|seat_rail_acc_z")
"""Names of model channels in a message: those that are measured most often."""

PLATE_CHANNEL = re.compile(r"plate_(?P<wheel>\w+)_displacement")
"""Channel of a plate."""

SMALL_MOTION = 0.05
"""Maximum RMS of a plate over that of the others that changes no response [-]: it counts as noise of 5 %."""

FRF_BAND = (1.0, 50.0)
"""Frequency band of estimated and of simulated responses [Hz]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Measured:
    """Measured channels under the channel names of the model.

    Attributes:
        file: contents of the measurement file.
        frf: frequency responses to the plate; None if there are none.
        record: time histories; None if there are none.
        notices: messages on channels and processing steps.
        estimator: estimator of the frequency responses; empty if the file contains the responses.
        start: first time of the file [s]; `record` may be an excerpt that begins later.
        delays: channel to delay that was taken out [s].
        mapped: channel of the model -> its channel in the file, as for --map.
        by_name: the channels were chosen by their names, not by --map.
    """

    file: Measurement
    frf: FrfData | None
    record: Record | None
    notices: tuple[str, ...]
    estimator: str = ""
    start: float = 0.0
    delays: Mapping[str, float] = field(default_factory=dict)
    mapped: Mapping[str, str] = field(default_factory=dict)
    by_name: bool = False


def read_measured(
    path: Path | str,
    model_channels: Sequence[str],
    choice: Choice | None = None,
    *,
    inverted: Collection[str] = (),
    window: float | None = None,
    measurement: Measurement | None = None,
    histories_only: bool = False,
) -> Measured:
    """Read channels of a measurement file as frequency responses and time histories of the model.

    Channels over frequency are frequency responses, others time histories. If no frequency response is selected, the
    responses are estimated from the time histories of accelerations and a plate, with the estimator used for runs.

    Args:
        path: measurement file of any format.
        model_channels: channel names of the model.
        choice: model channel name to channel of the file, and preprocessing; by default all channels whose names are
            in `model_channels`. A frequency response may name its plate: "knuckle_fr_acc_z/plate_fr".
        inverted: names of channels whose sign is inverted.
        window: length of Hann windows for estimated responses [s]; by default the whole record is evaluated.
        measurement: contents of the file, if already read.
        histories_only: True reads time histories alone, which may be short: no frequency response of the file, and
            none estimated.

    Returns:
        Frequency responses [m/s2 per m] and time histories in SI units, as far as contained in the file.

    Raises:
        ConfigurationError: the file does not exist, or a name is not a model channel.
        DataError: bad data, or no channel of the model.
    """
    selection = Choice() if choice is None else choice
    file = read_record(path, selection.databases) if measurement is None else measurement
    roles = {name: wanted for name, wanted in selection.channels.items() if name != "time"}
    by_name = not roles
    roles = roles or _same_names(file, model_channels, (False,) if histories_only else (True, False))
    output_of = {role: parsed_name(role).output for role in roles}
    unknown = next((name for name in (*output_of.values(), *inverted) if name not in model_channels), None)
    if unknown is not None:
        close = (
            get_close_matches(unknown, model_channels, n=3) or [name for name in model_channels if unknown in name][:3]
        )
        raise ConfigurationError(
            f"--map {unknown}=...: unknown channel of the model; names look like knuckle_fr_acc_z"
            + (f"; did you mean {' or '.join(close)}?" if close else "")
        )
    # In the order of the model, whatever the order of the options and the file.
    roles = {
        role: roles[role] for role in sorted(roles, key=lambda role: (model_channels.index(output_of[role]), role))
    }
    if not roles:
        listed = file.listed() or "none"
        suggested = main_channels(suggested_channels(file.channels, model_channels))
        examples = ", ".join(name for name in model_channels if EXAMPLES.fullmatch(name))
        options = map_words(suggested)
        advice = (
            f"their names suggest {shlex.join(options)}" if options else f"channels of the model look like {examples}"
        )
        text = (
            "no channel has the name of a channel of the model; set --map CHANNEL=NAME, where NAME is a number, a "
            f"name or a pattern with *; the file has {listed}; {advice}"
        )
        raise FindingError(path, [Finding(text, "unmapped", options)])
    other = next((name for name in selection.units if name and name not in {*roles, *output_of.values()}), None)
    if other is not None:
        raise ConfigurationError(f"--unit {other}=...: must be one of the compared channels: {', '.join(roles)}")
    spectra = {
        name: wanted
        for name, wanted in roles.items()
        if not histories_only
        and (
            len(matching(file, wanted, is_response)) > 1
            or is_response(file.channels[pick(file, wanted, option=f"--map {name}=", allowed=_is_data)])
        )
    }
    delays = channel_delays(tuple(dict.fromkeys(output_of.values())), selection.delays)
    frf: FrfData | None = None
    record: Record | None = None
    notices: list[str] = []
    estimator, start = "", 0.0
    if spectra:
        wrong = next((output for name in spectra if channel_units([output := output_of[name]])[output] != "m/s2"), None)
        if wrong is not None:
            raise DataError(
                f"{path}: --map {wrong}=...: the channel is a frequency response, but the model gives these only for "
                "accelerations; "
                "choose another channel"
            )
        frf, notices = measured_frfs(file, spectra, selection, inverted)
        frf = responses_without_delays(frf, delays)
    histories = {name: wanted for name, wanted in roles.items() if name not in spectra}
    named = next((name for name in histories if output_of[name] != name), None)
    if named is not None:
        raise ConfigurationError(
            f"--map {named}={histories[named]}: the channel is a time history, and only FRFs have a plate; set --map "
            f"{output_of[named]}={histories[named]}"
        )
    if histories:
        times = {role: wanted for role, wanted in selection.channels.items() if role == "time"}
        start = _start(file, histories) if selection.rate is None else 0.0
        record = _record(file, replace(selection, channels={**times, **histories}), inverted, delays)
        notices += [*record.notices, *_unmapped_plates(file, histories, record, model_channels, by_name)]
        if frf is None and not histories_only:
            estimated = estimated_frf(record, window)
            if estimated is not None:
                frf, estimator = estimated
                notices.append(f"FRFs estimated from the time histories: {estimator}")
            elif "m/s2" in record.units.values():
                notices.append(
                    "FRFs need the motion of a plate; name its channel with --map plate_fl_displacement=NAME"
                )
    return Measured(
        file=file,
        frf=frf,
        record=record,
        notices=tuple(dict.fromkeys([*file.notices, *notices])),
        start=start,
        estimator=estimator,
        delays=delays,
        mapped=roles,
        by_name=by_name,
    )


def _unmapped_plates(
    file: Measurement, roles: Mapping[str, str], record: Record, model_channels: Sequence[str], by_name: bool
) -> list[Finding]:
    """Return the finding on moving plates of the file that no channel of the model is assigned to; [] without any."""
    used = {pick(file, wanted) for wanted in roles.values()}
    plates = [values for name, values in record.channels.items() if PLATE_CHANNEL.fullmatch(name)]
    smallest = SMALL_MOTION * max(map(np.std, plates), default=0.0)
    moving = [
        channel
        for index, channel in enumerate(file.channels)
        if index not in used
        and channel.name not in model_channels
        and channel.quantity == "displacement"
        and channel.kind == "time"
        and is_plate(channel)
        and float(np.nanstd(channel.si_values)) > smallest
        and np.nanmax(channel.si_values) > np.nanmin(channel.si_values)
    ]
    suggested = suggested_channels(file.channels, model_channels)
    names = {channel.name for channel in moving}
    unmapped = {role: name for role, name in suggested.items() if name in names and role not in roles}
    if not unmapped:
        return []
    options = map_words({**(roles if by_name else {}), **unmapped})
    text = (
        f"moving plates that are not mapped: {', '.join(unmapped.values())}; without them FRFs and fitted values are "
        f"wrong; set {shlex.join(options)}"
    )
    return [Finding(text, "unmapped", options)]


def _start(file: Measurement, histories: Mapping[str, str]) -> float:
    """Return the time of the file at which a run of its plates begins: their last start, else the first of all [s]."""
    begins = {}
    for name, wanted in histories.items():
        axis = file.channels[pick(file, wanted, option=f"--map {name}=", allowed=_is_data)].axis
        if axis is not None:
            begins[name] = float(axis[0])
    plates = [begin for name, begin in begins.items() if name.startswith("plate_")]
    return max(plates) if plates else min(begins.values(), default=0.0)


def _is_data(channel: object) -> bool:
    return getattr(channel, "function", "") not in ("coherence", "random error")


def _same_names(file: Measurement, model_channels: Sequence[str], order: Sequence[bool]) -> dict[str, str]:
    """Map model channel names, and names such as "knuckle_fr_acc_z/plate_fr", to the channels of these names."""
    numbers: dict[str, str] = {}
    for wants_response in order:
        outputs = {parsed_name(role).output for role in numbers}
        for number, channel in enumerate(file.channels, 1):
            name = input_of(channel) if is_response(channel) else ResponseName(channel.name)
            if (
                name.output in model_channels
                and name.output not in outputs
                and str(name) not in numbers
                and _is_data(channel)
                and is_response(channel) is wants_response
            ):
                numbers[str(name)] = str(number)
    return numbers


def _record(file: Measurement, choice: Choice, inverted: Collection[str], delays: Mapping[str, float]) -> Record:
    """Return the selected time histories in SI units at uniform times; take delays out, and invert signs."""
    chosen = choose(file, choice)
    chosen.require_uniform(file.path)
    chosen = without_delays(chosen, {name: delay for name, delay in delays.items() if name in chosen.values})
    units = channel_units(chosen.values)
    plates = {name: values for name, values in chosen.values.items() if units[name] == "m"}
    others = {name: values for name, values in chosen.values.items() if name not in plates}
    for name in others:
        model_unit = find_unit(units[name].replace(" ", ""))
        if model_unit is not None and chosen.quantities[name] != model_unit.quantity:
            raise DataError(
                f"{file.path}: {name} is a {chosen.quantities[name]} but must be a {model_unit.quantity}; choose "
                "another "
                f"channel, or set --unit {name}={units[name]} if the unit in the file is wrong"
            )
    notices = list(chosen.notices)
    if plates:
        processed, messages = displacement(replace(chosen, values=plates), choice, str(file.path))
        moved, offsets = without_offsets({name: z for name, z in processed.items() if PLATE_CHANNEL.fullmatch(name)})
        plates, notices = {**processed, **moved}, [*notices, *messages, *offsets]
    if others and choice.highpass is not None:
        processed, messages = filtered(replace(chosen, values=others), choice.highpass)
        others, notices = dict(processed), [*notices, messages[-1]]
    channels = {name: (plates | others)[name] for name in chosen.values}
    for name in inverted:
        if name in channels:
            channels[name] = -channels[name]
            notices.append(f"{name}: sign inverted, as requested")
    return Record(time=chosen.time, channels=channels, units=units, notices=tuple(notices), highest=chosen.highest)


def estimated_frf(record: Record, window: float | None = None) -> tuple[FrfData, str] | None:
    """Estimate the frequency responses of the accelerations of a record to each independent motion of its plates.

    Args:
        record: time histories under model channel names.
        window: length of Hann windows [s]; None for `whole_record_responses`.

    Returns:
        Frequency responses and name of the estimator; None without a moving plate or without accelerations.
    """
    plates = {name: match["wheel"] for name in record.channels if (match := PLATE_CHANNEL.fullmatch(name))}
    moving = {wheel: record.channels[name] for name, wheel in plates.items() if np.ptp(record.channels[name]) > 0.0}
    names = [name for name, unit in record.units.items() if unit == "m/s2"]
    if not moving or not names:
        return None
    motions = motion_responses(
        record.step,
        moving,
        [record.channels[name] for name in names],
        names=names,
        band=(FRF_BAND[0], min(FRF_BAND[1], record.usable)),
        window=window,
    )
    estimator = motions[0].response.estimator
    return frf_data(motions, names), estimator + (f", Hann windows of {window:g} s" if window is not None else "")
