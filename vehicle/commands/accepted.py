"""Run a command as far as it reads and checks its files: a command is advised only if its files are accepted."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path

from vehicle.errors import VehicleError
from vehicle.names import CORNERS


def refusal(arguments: Sequence[str]) -> str:
    """Return the error message of a command (comfort, shaker or compare) for its files; empty if they are accepted."""
    checks: dict[str, Callable[[Sequence[str]], None]] = {"comfort": _comfort, "shaker": _shaker, "compare": _compare}
    try:
        checks[arguments[0]](arguments[1:])
    except VehicleError as error:
        return str(error)
    return ""


def _comfort(options_text: Sequence[str]) -> None:
    from vehicle.commands.comfort import evaluated, parser

    options = parser().parse_args(options_text)
    evaluated(argparse.Namespace(**{**vars(options), "input": options.inputs[0]}))


def _shaker(options_text: Sequence[str]) -> None:
    from vehicle.commands.input_options import record_choice
    from vehicle.commands.road import class_or_profile, road_drive
    from vehicle.commands.shaker import parser, plate_signal
    from vehicle.model.parameters.vehicle import load_vehicle
    from vehicle.signals.excitation.evaluation_start import evaluation_start

    options = parser().parse_args(options_text)
    vehicle = load_vehicle(options.vehicle, options.overrides)
    if options.road is not None:
        drive = road_drive(class_or_profile(options.road), options, vehicle)
        evaluation_start({options.road: drive.signal().duration}, None, drive.skip)
        return
    wheel = CORNERS[options.wheel] if options.wheel else vehicle.shaker_wheel
    plate_signal(options, wheel, record_choice(options, wheel))


def _compare(options_text: Sequence[str]) -> None:
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
        return
    channels = load_vehicle(options.vehicle, options.overrides).channels
    read_measured(Path(name), channels, choice, inverted=options.turned, measurement=measurement)
