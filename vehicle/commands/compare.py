"""`python -m vehicle compare RUN_OR_INPUT --measured FILE`: compare a measurement with a run."""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.clock_options import delay_option, drift_option
from vehicle.commands.command_line import command
from vehicle.commands.console import Console, folded
from vehicle.commands.input_options import record_options
from vehicle.commands.measured_options import measured_options
from vehicle.commands.options import (
    command_parser,
    damper_option,
    figures_option,
    message_options,
    output_options,
    read,
    setting_options,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.commands.several_files import each_file, expanded, raise_worst, table_of
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, engine_setting, part, setting, stated_errors_setting
from vehicle.signals.records.measured_settings import MeasuredSettings
from vehicle.signals.records.record_settings import RecordSettings

if TYPE_CHECKING:
    from vehicle.runs.car import Car, Run
    from vehicle.runs.comparison.simulated import Simulated
    from vehicle.signals.formats.channel import Measurement
    from vehicle.signals.records.choice import Choice

OUTPUT = Path("runs/compare")

RECORDS, RESPONSES, SHAPES, CHANNELS = "time histories", "responses", "mode shapes", "channels of the measurement"
CAR, RUN = "the car", "the run"
"""Titles of groups of options."""


@dataclass(frozen=True, kw_only=True, slots=True)
class CompareSettings(Settings):
    """Settings of a comparison.

    Attributes:
        files: measurement files, or a folder.
        measured: channels and clock of the measurement.
        record: units, times and filters of the measurement.
        car: car of an input, or of mode shapes.
        damper: state of the dampers for mode shapes, "stuck" or "sliding".
        destination: folder of the results; by default `OUTPUT`.
        figures: write pictures (PNG).
    """

    run: str | None = setting(
        "folder of a run, or a shaker signal that is simulated first, for example low.csv; leave it out for "
        "mode shapes",
        flag="run",
        nargs="?",
        metavar="RUN_OR_INPUT",
    )
    files: tuple[Path, ...]
    measured: MeasuredSettings = part(MeasuredSettings)
    record: RecordSettings = part(RecordSettings)
    car: CarChoice = part(CarChoice)
    damper: str = "stuck"
    destination: Destination = part(Destination)
    figures: bool = True
    window: float | None = setting(
        "length of the Hann windows that the analyser used for the measured FRFs [s]; the simulated FRFs "
        "are estimated with the same windows. Default: the whole record",
        within="(0, inf)",
        type=float,
        metavar="S",
    )
    bands: str = setting(
        "edges of the frequency bands of the table [Hz]; default: %(default)s", "1,2,4,8,16,32,50", metavar="HZ,HZ,..."
    )
    engine: str = engine_setting("auto")
    stated_errors: bool = stated_errors_setting()


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("compare", "Compare a measurement with a run: FRFs, time histories, or mode shapes.")
    parser.advise("to compare two runs, type python -m vehicle report RUN RUN")
    setting_options(parser, CompareSettings, "run")
    measured_options(parser, required=True, several=True)
    records = parser.scoped_group(RECORDS, needs="measured time histories, but the file contains none", active=None)
    drift_option(records)
    responses = parser.scoped_group(RESPONSES, needs="measured FRFs, but the file contains none", active=None)
    setting_options(responses, CompareSettings, "window", "bands")
    shapes = parser.scoped_group(SHAPES, needs="measured mode shapes, but the file contains none", active=None)
    damper_option(shapes)
    channels = parser.scoped_group(CHANNELS, needs="measured channels, but the file contains mode shapes", active=None)
    record_options(channels, "", channel=False)
    delay_option(channels)
    vehicle_options(
        parser.scoped_group(
            CAR, needs="an input that is simulated first; the folder of a run contains its car", active=None
        )
    )
    setting_options(
        parser.scoped_group(RUN, needs="an input that is simulated first, for example low.csv", active=None),
        CompareSettings,
        "engine",
        "stated_errors",
    )
    output_options(parser, OUTPUT)
    figures_option(parser)
    parser.add_argument("--json", action="store_true", help="print compare.json instead of the text")
    message_options(parser, quiet=True)
    return parser


def settings_of(options: argparse.Namespace) -> CompareSettings:
    """Return the settings of the parsed options."""
    return read(
        options,
        CompareSettings,
        files=tuple(options.measured),
        measured=read(options, MeasuredSettings, measured=None),
    )


def _job(settings: CompareSettings, console: Console) -> None:
    names, several = expanded([str(path) for path in settings.files])
    if several:
        console.require_one_file()
    whole = settings.destination.folder(OUTPUT, protect=tuple(Path(name) for name in names))

    def one(name: str) -> dict[str, Any]:
        file = Path(name)
        unique = sum(Path(other).stem == file.stem for other in names) == 1
        output = whole / (file.stem if unique else file.name) if several else whole
        summary, said = _compared(
            replace(settings, measured=replace(settings.measured, measured=file)), output, console
        )
        return {"summary": summary, "text": f"{said}\nfiles: {output}"}

    if not several:
        result = one(names[0])
        console.result(result["summary"], result["text"])
        return
    results, errors = each_file(names, one)
    plain = [{"input": each["input"], **each.get("summary", {"error": each.get("error")})} for each in results]
    console.result(plain, _overview(results))
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


def _compared(settings: CompareSettings, output: Path, console: Console) -> tuple[dict[str, Any], str]:
    """Compare a measurement, write the results, and return the summary and its text."""
    from vehicle.runs.comparison.compared_run import compare
    from vehicle.runs.comparison.frf_comparison import edges_of
    from vehicle.runs.output.comparison_files import save_comparison
    from vehicle.signals.formats.reader import read_record

    file = settings.measured.measured
    assert file is not None
    edges = edges_of(settings.bands)
    choice = settings.measured.choice(settings.record)
    delay, drift = settings.measured.clock()
    measurement = read_record(file, choice.databases)
    if measurement.shapes and not measurement.channels:
        for group in (RECORDS, RESPONSES, CHANNELS, RUN):
            console.refuse_idle(group)
        summary, said = _modes(settings, output, measurement, choice)
    else:
        if settings.run is None:
            raise ConfigurationError(
                "RUN_OR_INPUT is missing: give the folder of a run, or an input, for example low.csv"
            )
        console.refuse_idle(SHAPES)
        run, channels = _run(settings, settings.run, measurement, choice, console)
        measured = settings.measured.read(channels, choice, window=settings.window, measurement=measurement)
        if measured.frf is None:
            console.refuse_idle(RESPONSES)
        if measured.record is None:
            console.refuse_idle(RECORDS)
        comparison = compare(run, measured, delay=delay, drift=drift, window=settings.window, bands=edges)
        console.accept(comparison.notices)
        force, figures = settings.destination.force, settings.figures
        save_comparison(comparison, output, force=force, figures=figures, protect=(file,))
        summary, said = comparison.summary(), "\n".join(folded(comparison.text().split("\n")))
    return summary, said


def _run(
    settings: CompareSettings, source: str, measurement: Measurement, choice: Choice, console: Console
) -> tuple[Run | Simulated, tuple[str, ...]]:
    """Return the run and the names of its channels; an input is simulated first."""
    from vehicle.runs.comparison.simulated import of_folder

    folder = Path(source)
    if folder.is_dir():
        for group in (CAR, RUN):
            console.refuse_idle(group)
        simulated = of_folder(folder)
        return simulated, tuple(simulated.record.channels)
    from vehicle.runs.car import Car
    from vehicle.signals.excitation.input_files import find_input
    from vehicle.signals.excitation.signal_file import read_signal

    car = Car.load(settings.car.vehicle, settings.car.overrides)
    channels = (*car.vehicle.channels, *car.vehicle.load_channels)
    signal = read_signal(find_input(source), wheel=car.vehicle.shaker_wheel)
    # Refused before anything is simulated.
    asked = settings.measured.read(channels, choice, window=settings.window, measurement=measurement)
    loads = {*(asked.record.channels if asked.record else ())} - set(car.vehicle.channels)
    run = car.run(
        signal,
        engine=settings.engine,
        progress=console.progress("simulation"),
        channels=(*car.vehicle.channels, *sorted(loads)) if loads else None,
        stated_errors=settings.stated_errors,
    )
    return run, channels


def _modes(
    settings: CompareSettings, output: Path, measurement: Measurement, choice: Choice
) -> tuple[dict[str, Any], str]:
    """Compare measured and simulated mode shapes, write the results, and return summary and text."""
    from vehicle.runs.comparison.mode_comparison import compare_modes
    from vehicle.runs.comparison.pictures import plot_mac
    from vehicle.runs.output.folder import output_folder, write_json, write_whole

    car = _car(settings)
    comparison, tyres = (
        compare_modes(car, measurement, dict(choice.channels), settings.damper),
        car.vehicle.driving.words,
    )
    name = measurement.path.name
    summary = comparison.summary(name)
    caption = (
        f"{name} at {len(comparison.points)} points of the car, dampers {settings.damper}, tyres {tyres}; rows and "
        "columns by frequency"
    )
    rows, columns = ([mode.frequency for mode in those] for those in (comparison.measured, comparison.simulated))
    tables = (
        ("measured (rows), simulated (columns)", comparison.mac, rows, columns),
        ("AutoMAC: similarity among the measured modes", comparison.measured_auto, rows, rows),
        ("AutoMAC: similarity among the simulated modes", comparison.simulated_auto, columns, columns),
    )
    with output_folder(output, force=settings.destination.force, protect=(measurement.path,)) as folder:
        write_json(folder / "compare.json", summary)
        if settings.figures:
            write_whole(folder / "mac.png", lambda path: plot_mac(path, tables, caption))
    return summary, comparison.text(name)


def _car(settings: CompareSettings) -> Car:
    """Return the car of the run, or of the options."""
    from vehicle.runs.car import Car

    file = settings.car.vehicle
    if file is None and settings.run is not None and Path(settings.run).is_dir():
        file = Path(settings.run) / "vehicle.toml"
        if not file.is_file():
            raise ConfigurationError(
                f"{settings.run}: contains no vehicle.toml; give the folder of a run, or the car with --vehicle"
            )
    return Car.load(file, settings.car.overrides)


main = command(parser, settings_of, _job)
