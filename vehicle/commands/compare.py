"""`python -m vehicle compare RUN_OR_INPUT --measured FILE`: compare a measurement with a run."""

from __future__ import annotations

import argparse
from collections.abc import Container
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.accepted_advice import accept, require_one_file
from vehicle.commands.clock_options import clock_of, delay_option, drift_option
from vehicle.commands.command_line import ProgressLine, command, print_result
from vehicle.commands.destination import output_folder_of
from vehicle.commands.input_options import record_options
from vehicle.commands.options import (
    command_parser,
    damper_option,
    figures_option,
    message_options,
    output_options,
    setting_options,
    vehicle_options,
)
from vehicle.commands.parser import Parser, refuse_idle
from vehicle.commands.several_files import each_file, expanded, raise_worst, table_of
from vehicle.errors import ConfigurationError
from vehicle.studies.sweeps.sweep_settings import SweepSettings

if TYPE_CHECKING:
    from vehicle.runs.car import Car, Run
    from vehicle.runs.comparison.simulated import Simulated
    from vehicle.signals.formats.channel import Measurement
    from vehicle.signals.records.choice import Choice
    from vehicle.signals.records.measured import Measured

OUTPUT = Path("runs/compare")

RECORDS, RESPONSES, SHAPES, CHANNELS = "time histories", "responses", "mode shapes", "channels of the measurement"
CAR, RUN = "the car", "the run"
"""Titles of groups of options."""


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("compare", "Compare a measurement with a run: FRFs, time histories, or mode shapes.")
    parser.advise("to compare two runs, type python -m vehicle report RUN RUN")
    parser.add_argument(
        "run",
        nargs="?",
        metavar="RUN_OR_INPUT",
        help="folder of a run, or a shaker signal that is simulated first, for example low.csv; leave it out for "
        "mode shapes",
    )
    measured_options(parser, required=True, several=True)
    records = parser.scoped_group(RECORDS, needs="measured time histories, and the file contains none", active=None)
    drift_option(records)
    responses = parser.scoped_group(RESPONSES, needs="measured FRFs, and the file contains none", active=None)
    responses.add_argument(
        "--window",
        type=float,
        metavar="S",
        help="length of the Hann windows that the analyser used for the measured FRFs [s]; the simulated FRFs "
        "are estimated with the same windows. Default: the whole record",
    )
    responses.add_argument(
        "--bands",
        default="1,2,4,8,16,32,50",
        metavar="HZ,HZ,...",
        help="edges of the frequency bands of the table [Hz]; default: %(default)s",
    )
    shapes = parser.scoped_group(SHAPES, needs="measured mode shapes, and the file contains none", active=None)
    damper_option(shapes)
    channels = parser.scoped_group(CHANNELS, needs="measured channels, and the file contains mode shapes", active=None)
    record_options(channels, "", channel=False)
    delay_option(channels)
    vehicle_options(
        parser.scoped_group(
            CAR, needs="an input that is simulated first; the folder of a run contains its car", active=None
        )
    )
    setting_options(
        parser.scoped_group(RUN, needs="an input that is simulated first, for example low.csv", active=None),
        SweepSettings,
        "engine",
    )
    output_options(parser, OUTPUT)
    figures_option(parser)
    parser.add_argument("--json", action="store_true", help="print the results as JSON, as in compare.json")
    message_options(parser, quiet=True)
    return parser


def measured_choice(options: argparse.Namespace, input_names: Container[str] = ()) -> Choice:
    """Return the choice of channels and units of the measurement.

    Args:
        input_names: names of --unit that belong to the input.

    Raises:
        ConfigurationError: a channel twice, an unknown unit, a number out of range.
    """
    from vehicle.signals.records.choice import Choice, pairs
    from vehicle.signals.records.delays import parsed_delays, split_delay

    channels = pairs("--map", options.mapping, "")
    if "" in channels:
        raise ConfigurationError(f"--map {channels['']}: must be CHANNEL=NAME, for example knuckle_fr_acc_z=3")
    units = {name: unit for name, unit in pairs("--unit", options.units, "").items() if name not in input_names}
    settings = {name: getattr(options, name) for name in ("rate", "first", "last", "detrend", "highpass", "resample")}
    settings["databases"] = tuple(options.databases)
    if not hasattr(options, "delay"):
        return Choice(channels=channels, units=units)
    return Choice(channels=channels, units=units, delays=split_delay(parsed_delays(options.delay))[1], **settings)


def _job(options: argparse.Namespace) -> None:
    names, several = expanded([str(path) for path in options.measured])
    if several:
        require_one_file(options)
    whole = output_folder_of(options, OUTPUT, protect=tuple(Path(name) for name in names))

    def one(name: str) -> dict[str, Any]:
        file = Path(name)
        unique = sum(Path(other).stem == file.stem for other in names) == 1
        output = whole / (file.stem if unique else file.name) if several else whole
        summary, said = _compared(argparse.Namespace(**{**vars(options), "measured": file}), output)
        return {"summary": summary, "text": f"{said}\nfiles: {output}"}

    if not several:
        result = one(names[0])
        print_result(options, result["summary"], result["text"])
        return
    results, errors = each_file(names, one)
    plain = [{"input": each["input"], **each.get("summary", {"error": each.get("error")})} for each in results]
    print_result(options, plain, _overview(results))
    raise_worst(errors, len(results))


def _overview(results: list[dict[str, Any]]) -> str:
    """Return the table of several files, a line for each channel: FRAC; RMS ratio and correlation."""

    def rows_of(result: dict[str, Any]) -> list[tuple[str, ...]]:
        summary, rows = result["summary"], list[tuple[str, ...]]()
        keys = (("responses", "frac", ""), ("records", "rms_ratio", "correlation"))
        several = len({response.get("plate") for response in summary.get("responses", ())}) > 1
        for section, first, second in keys:
            for channel in summary.get(section, ()):
                values = [channel.get(key) if key else None for key in (first, second)]
                cells = ["-" if value is None else f"{value:.4g}" for value in values]
                plate = f"/{channel['plate']}" if several and channel.get("plate") else ""
                rows.append((result["input"], channel["channel"] + plate, section[:-1], *cells))
        return rows

    return table_of(("file", "channel", "of", "FRAC or RMS ratio", "correlation"), results, rows_of)


def _compared(options: argparse.Namespace, output: Path) -> tuple[dict[str, Any], str]:
    """Compare the measurement `measured` of the options, write the results, and return the summary and its text."""
    from vehicle.runs.comparison.compared_run import compare
    from vehicle.runs.comparison.frf_comparison import edges_of
    from vehicle.runs.output.comparison_files import save_comparison
    from vehicle.signals.formats.reader import read_record

    edges = edges_of(options.bands)
    choice = measured_choice(options)
    delay, drift = clock_of(options)
    measurement = read_record(options.measured, choice.databases)
    if measurement.shapes and not measurement.channels:
        for group in (RECORDS, RESPONSES, CHANNELS, RUN):
            refuse_idle(options, group)
        summary, said = _modes(options, output, measurement, choice)
    else:
        if options.run is None:
            raise ConfigurationError(
                "RUN_OR_INPUT is missing: give the folder of a run, or an input, for example low.csv"
            )
        refuse_idle(options, SHAPES)
        run, channels = _run(options, measurement, choice)
        measured = _measured(options, channels, choice, measurement)
        if measured.frf is None:
            refuse_idle(options, RESPONSES)
        if measured.record is None:
            refuse_idle(options, RECORDS)
        comparison = compare(run, measured, delay=delay, drift=drift, window=options.window, bands=edges)
        accept(options, comparison.notices)
        save_comparison(comparison, output, force=options.force, figures=options.figures, protect=(options.measured,))
        summary, said = comparison.summary(), comparison.text()
    return summary, said


def _measured(
    options: argparse.Namespace, channels: tuple[str, ...], choice: Choice, measurement: Measurement | None = None
) -> Measured:
    from vehicle.signals.records.measured import read_measured

    window = getattr(options, "window", None)
    return read_measured(
        options.measured, channels, choice, inverted=options.turned, window=window, measurement=measurement
    )


def measured_beside(
    options: argparse.Namespace, channels: tuple[str, ...], input_names: Container[str] = ()
) -> Measured | None:
    """Read the measurement of --measured before the run, see `measured_choice`; return None without --measured."""
    if options.measured is None:
        return None
    return _measured(options, channels, measured_choice(options, input_names))


def _run(
    options: argparse.Namespace, measurement: Measurement, choice: Choice
) -> tuple[Run | Simulated, tuple[str, ...]]:
    """Return the run and the names of its channels; an input is simulated first."""
    from vehicle.runs.comparison.simulated import of_folder

    folder = Path(options.run)
    if folder.is_dir():
        for group in (CAR, RUN):
            refuse_idle(options, group)
        simulated = of_folder(folder)
        return simulated, tuple(simulated.record.channels)
    from vehicle.runs.car import Car
    from vehicle.signals.excitation.input_files import find_input
    from vehicle.signals.excitation.signal_file import read_signal

    car = Car.load(options.vehicle, options.overrides)
    channels = (*car.vehicle.channels, *car.vehicle.load_channels)
    signal = read_signal(find_input(options.run), wheel=car.vehicle.shaker_wheel)
    asked = _measured(options, channels, choice, measurement)  # refused before anything is simulated
    loads = {*(asked.record.channels if asked.record else ())} - set(car.vehicle.channels)
    run = car.run(
        signal,
        ProgressLine("simulation", enabled=not options.quiet),
        engine=options.engine,
        channels=(*car.vehicle.channels, *sorted(loads)) if loads else None,
    )
    return run, channels


def _modes(
    options: argparse.Namespace, output: Path, measurement: Measurement, choice: Choice
) -> tuple[dict[str, Any], str]:
    """Compare measured mode shapes with those of the car, write the results, and return summary and text."""
    from vehicle.runs.comparison.mode_comparison import compare_modes
    from vehicle.runs.comparison.pictures import plot_mac
    from vehicle.runs.output.folder import output_folder, write_json, write_whole

    car = _car(options)
    comparison, tyres = (
        compare_modes(car, measurement, dict(choice.channels), options.damper),
        car.vehicle.driving.words,
    )
    name = measurement.path.name
    summary = comparison.summary(name)
    caption = (
        f"{name} at {len(comparison.points)} points of the car, dampers {options.damper}, tyres {tyres}; rows and "
        "columns by frequency"
    )
    rows, columns = ([mode.frequency for mode in those] for those in (comparison.measured, comparison.simulated))
    tables = (
        ("measured (rows), simulated (columns)", comparison.mac, rows, columns),
        ("AutoMAC: similarity among the measured modes", comparison.measured_auto, rows, rows),
        ("AutoMAC: similarity among the simulated modes", comparison.simulated_auto, columns, columns),
    )
    with output_folder(output, force=options.force, protect=(options.measured,)) as folder:
        write_json(folder / "compare.json", summary)
        if options.figures:
            write_whole(folder / "mac.png", lambda path: plot_mac(path, tables, caption))
    return summary, comparison.text(name)


def _car(options: argparse.Namespace) -> Car:
    """Return the car of a run, or that of the options."""
    from vehicle.runs.car import Car

    file = options.vehicle
    if file is None and options.run is not None and Path(options.run).is_dir():
        file = Path(options.run) / "vehicle.toml"
        if not file.is_file():
            raise ConfigurationError(
                f"{options.run}: contains no vehicle.toml; give the folder of a run, or the car with --vehicle"
            )
    return Car.load(file, options.overrides)


main = command(parser, _job)
