"""Check that a command accepts its files, and add the options of the findings on them."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from vehicle.commands.options import car_of, read
from vehicle.errors import VehicleError
from vehicle.signals.excitation.input_settings import PlateSettings
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
    from vehicle.commands.comfort import ComfortSettings, evaluated, parser

    settings = read(parser().parse_args(options_text), ComfortSettings)
    return evaluated(settings.inputs[0], settings).notices


def _shaker(options_text: Sequence[str]) -> Iterable[str]:
    from vehicle.commands.input_options import input_of
    from vehicle.commands.shaker import parser
    from vehicle.handover.page.shaken_run import plate_signal
    from vehicle.runs.car.road import road_of
    from vehicle.signals.excitation.evaluation_start import evaluation_start

    options = parser().parse_args(options_text)
    source, car = input_of(options), car_of(options)
    vehicle = car.load()
    if isinstance(source, PlateSettings):
        wheel = source.corner(vehicle.shaker_wheel)
        return plate_signal(source, wheel, source.record.choice(wheel)).notices
    drive = road_of(source).under(vehicle, car.overrides)
    signal = drive.signal()
    evaluation_start({str(source.road): signal.duration}, None, drive.skip)
    return signal.notices


def _compare(options_text: Sequence[str]) -> Iterable[str]:
    from vehicle.commands.compare import parser, settings_of
    from vehicle.signals.formats.reader import read_record

    settings = settings_of(parser().parse_args(options_text))
    (file,) = settings.files
    choice = settings.measured.choice(settings.record)
    measurement = read_record(file, choice.databases)
    if measurement.shapes and not measurement.channels:
        from vehicle.runs.car import Car
        from vehicle.runs.comparison.mode_comparison import compare_modes

        car = Car.load(settings.car.vehicle, settings.car.overrides)
        compare_modes(car, measurement, dict(choice.channels), settings.damper)
        return ()
    channels = settings.car.load().channels
    return replace(settings.measured, measured=file).read(channels, choice, measurement=measurement).notices
