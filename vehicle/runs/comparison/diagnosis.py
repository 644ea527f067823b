"""Diagnosis of a record: all findings on it, with the options and arguments that cure them."""

from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.errors import DataError
from vehicle.runs.car import Car
from vehicle.runs.comparison.plate_signal import plate_signal
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.formats.reader import read_record
from vehicle.signals.formats.table import Record
from vehicle.signals.records.channel_words import axis_of, by_point
from vehicle.signals.records.choice import Choice, choose, pairs
from vehicle.signals.records.finding import Finding, FindingError, added, findings_of, parts_of
from vehicle.signals.records.gravity import axis_of_role
from vehicle.signals.records.measured import read_measured
from vehicle.signals.records.run_findings import beside_run
from vehicle.wording import in_words


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Diagnosis:
    """Findings on a record.

    Attributes:
        findings: sentences, each with the options of a command line that cure the fault.
        choice: choice of channels, units and excerpt with the cures.
        inverted: channels measured with the opposite sign.
    """

    findings: tuple[Finding, ...]
    choice: Choice
    inverted: tuple[str, ...]

    @property
    def options(self) -> tuple[str, ...]:
        """Return the words of a command line that apply all cures."""
        return tuple(word for finding in self.findings for word in finding.options)

    @property
    def arguments(self) -> dict[str, Any]:
        """Return the arguments of `compare`, `measured_responses` and `measured_histories` that apply all cures."""
        return {"choice": self.choice, "inverted": self.inverted}

    def __repr__(self) -> str:
        """Return the findings, a line for each."""
        return in_words("\n".join(self.findings)) or "no findings"


def diagnose(
    file: Path | str,
    car: Car | None = None,
    *,
    choice: Choice | None = None,
    inverted: Collection[str] = (),
) -> Diagnosis:
    """Return what is wrong with a record, or may be.

    Without a car: clipped and constant parts, gravity as a check of unit and range, the position of a plate sensor.
    With a car also, from a run of the reduced engine on the plates of the record: plates that are not mapped, exchanged
    channels, inverted ones, levels of another unit, and the delay of each group of channels.

    Args:
        file: measurement file of any format.
        car: the measured car, as far as it is known.
        choice: channels of the model and their channels in the file, units, rate and excerpt; the channels by default
            those of equal names, else those that the names suggest.
        inverted: channels measured with the opposite sign.

    Raises:
        ConfigurationError: the file does not exist, or a channel of the model does not exist.
        DataError: bad data.
    """
    selection, turned, findings = choice or Choice(), tuple(inverted), list[Finding]()
    while True:
        try:
            measurement = read_record(Path(file), selection.databases)
            latest = (
                _of_channels(measurement, selection)
                if car is None
                else _beside_car(measurement, car, selection, turned)
            )
            break
        except FindingError as error:
            new = [finding for finding in error.findings if finding not in findings]
            if not new or not any(finding.options for finding in new):
                raise
            findings += new
            selection, turned = _cured(selection, turned, new)
    findings += [finding for finding in latest if finding not in findings]
    selection, turned = _cured(selection, turned, findings)
    return Diagnosis(findings=tuple(findings), choice=selection, inverted=turned)


def _of_channels(measurement: Measurement, choice: Choice) -> list[Finding]:
    """Return the findings on the channels of a file, those of a point together, under their names or numbers."""
    names = [channel.name for channel in measurement.channels]
    usable = [(n, each) for n, each in enumerate(measurement.channels, 1) if each.kind == "time" and each.quantity]
    findings: list[Finding] = []
    for group in by_point(usable):
        roles: dict[str, str] = {}
        for number, channel in group:
            role, axis = channel.name, axis_of(channel)
            role = role if names.count(role) == 1 and "=" not in role else str(number)
            roles[role if axis_of_role(role) == axis else f"{role} {axis}"] = str(number)
        findings += _of_roles(measurement, choice, roles)
    return findings


def _of_roles(measurement: Measurement, choice: Choice, roles: dict[str, str]) -> list[Finding]:
    """Return the findings on channels (role -> number in the file), or on each if they do not fit together."""
    try:
        return findings_of(choose(measurement, replace(choice, channels=roles)).notices)
    except FindingError as error:
        return list(error.findings)
    except DataError:  # the command that uses this channel reports it
        single = [{role: number} for role, number in roles.items()] if len(roles) > 1 else []
        return [finding for role in single for finding in _of_roles(measurement, choice, role)]


def _beside_car(measurement: Measurement, car: Car, choice: Choice, inverted: Collection[str]) -> list[Finding]:
    """Return the findings on a record against a run of a car on its plates."""
    names = (*car.vehicle.channels, *car.vehicle.load_channels)
    without_delays = replace(choice, delays={})
    measured = read_measured(
        measurement.path, names, without_delays, inverted=inverted, measurement=measurement, histories_only=True
    )
    findings, record = findings_of(measured.notices), measured.record
    others = [name for name in record.channels if not name.startswith("plate_")] if record else []
    if (
        record is None
        or not others
        or not any(np.ptp(record.channels[name]) > 0.0 for name in {*record.channels} - {*others})
    ):
        return findings
    asked = replace(without_delays, channels=measured.mapped)
    signal = plate_signal(None, car, measurement.path, measured, asked, inverted, None)
    run = car.run(signal, engine="reduced", channels=tuple(record.channels), stated_errors=False)
    simulated = Record(time=run.time, channels=run.recording.channels, units=run.recording.units)
    return [*findings, *beside_run(measured, record, simulated, record.time - record.time[0]).findings]


def _cured(choice: Choice, inverted: Collection[str], findings: Iterable[Finding]) -> tuple[Choice, tuple[str, ...]]:
    """Return a choice of channels and the inverted channels with the cures of findings."""
    arguments = [f"--turn={name}" for name in inverted]
    for option, roles in (("--map", choice.channels), ("--unit", choice.units)):
        arguments += [f"{option}={role}={value}" for role, value in roles.items()]
    arguments += [f"--from={choice.first!r}"] if choice.first is not None else []
    arguments += [f"--to={choice.last!r}"] if choice.last is not None else []
    for finding in findings:
        arguments = added(arguments, finding.options)
    values: dict[str, list[str]] = {}
    for option, value in parts_of(arguments):
        values.setdefault(option, []).append(value)
    first, last = ([float(value) for value in values.get(option, ())] for option in ("--from", "--to"))
    return replace(
        choice,
        channels=pairs("--map", values.get("--map", ()), ""),
        units=pairs("--unit", values.get("--unit", ()), ""),
        detrend=choice.detrend or "--detrend" in values,
        first=first[0] if first else None,
        last=last[0] if last else None,
    ), tuple(values.get("--turn", ()))
