"""Check that a command accepts its files, and add the options of the findings on them."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from vehicle.errors import VehicleError
from vehicle.names import CORNERS
from vehicle.signals.records.finding import Finding, FindingError, added, findings_of

ROUNDS = 4
"""Maximum number of times that a command is checked with further options."""


def cured_command(arguments: Sequence[str]) -> tuple[list[str], str, list[Finding]]:
    """Return a command with the options of the findings on its record, why it is refused (or ""), and the findings."""
    cured, collected, reason = list(arguments), list[Finding](), ""
    for _ in range(ROUNDS):
        reason, findings = _refusal(cured)
        collected += [each for each in findings if each not in collected]
        previous = list(cured)
        for each in findings:
            cured = added(cured, each.options)
        if cured == previous:
            break
    return cured, reason, collected


def _refusal(arguments: Sequence[str]) -> tuple[str, list[Finding]]:
    """Return the error message of a command (comfort, shaker or compare) for its files, or "", and the findings."""
    checks: dict[str, Callable[[Sequence[str]], Iterable[str]]] = {
        "comfort": _comfort, "shaker": _shaker, "compare": _compare
    }  # fmt: skip
    try:
        return "", findings_of(checks[arguments[0]](arguments[1:]))
    except FindingError as error:
        return str(error), list(error.findings)
    except VehicleError as error:
        return str(error), []


def _comfort(options_text: Sequence[str]) -> Iterable[str]:
    from vehicle.commands.comfort import evaluated, parser

    options = parser().parse_args(options_text)
    return evaluated(argparse.Namespace(**{**vars(options), "input": options.inputs[0]})).notices


def _shaker(options_text: Sequence[str]) -> Iterable[str]:
    from vehicle.commands.input_options import record_choice
    from vehicle.commands.road import class_or_profile, road_drive
    from vehicle.commands.shaker import parser, plate_signal
    from vehicle.model.parameters.vehicle import load_vehicle
    from vehicle.signals.excitation.evaluation_start import evaluation_start

    options = parser().parse_args(options_text)
    vehicle = load_vehicle(options.vehicle, options.overrides)
    if options.road is not None:
        drive = road_drive(class_or_profile(options.road), options, vehicle)
        signal = drive.signal()
        evaluation_start({options.road: signal.duration}, None, drive.skip)
        return signal.notices
    wheel = CORNERS[options.wheel] if options.wheel else vehicle.shaker_wheel
    return plate_signal(options, wheel, record_choice(options, wheel)).notices


def _compare(options_text: Sequence[str]) -> Iterable[str]:
    from vehicle.commands.compare import measured_choice, parser
    from vehicle.model.parameters.vehicle import load_vehicle
    from vehicle.signals.formats.reader import read_record
    from vehicle.signals.records.measured import read_measured

    options = parser().parse_args(options_text)
    (name,) = options.measured
    choice = measured_choice(options)
    measurement = read_record(Path(name), choice.databases)
    if measurement.shapes and not measurement.channels:
        from vehicle.runs.car import Car
        from vehicle.runs.comparison.mode_comparison import compare_modes

        compare_modes(Car.load(options.vehicle, options.overrides), measurement, dict(choice.channels), options.damper)
        return ()
    channels = load_vehicle(options.vehicle, options.overrides).channels
    return read_measured(Path(name), channels, choice, inverted=options.turned, measurement=measurement).notices
