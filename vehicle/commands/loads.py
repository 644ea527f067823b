"""`python -m vehicle loads`: what recorded loads do to parts, rainflow counts and spectra of the channels of a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.options import command_parser, message_options, output_options, setting_options
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, part, setting

if TYPE_CHECKING:
    from vehicle.signals.analysis.load_schedule import CountedRun
    from vehicle.signals.analysis.load_spectrum import LoadSpectrum

FILES = ("loads.csv", "load_spectra.csv", "loads.png")
SHOWN = 15
"""Maximum number of printed channels."""


@dataclass(frozen=True, kw_only=True, slots=True)
class LoadSettings(Settings):
    """Settings of counted loads."""

    runs: tuple[Path, ...] = setting(
        "folders of runs, or files of time histories; several form a test schedule, whose damage is written "
        "to schedule.csv",
        flag="runs",
        type=Path,
        nargs="+",
        metavar="RUN",
    )
    repeats: str | None = setting("number of repeats of each run of the schedule; default: 1", metavar="N,...")
    reference_run: Path | None = setting(
        "compare with the damage of this run in schedule.csv, for example on a reference road", type=Path, metavar="RUN"
    )
    channels: str | None = setting("channels to count; default: all forces, torques and travels", metavar="NAME,...")
    destination: Destination = part(Destination)
    slope: float = setting(
        "slope of the S-N (Woehler) curve [-]: damage of n cycles of amplitude A is n A^K; default: "
        "%(default)s, usual for steel parts of a chassis",
        5.0,
        within="[1, 1000)",
        type=float,
        metavar="K",
    )
    classes: int = setting(
        "number of load classes in the spectra; default: %(default)s", 64, within="[1, 10000]", type=int, metavar="N"
    )


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser(
        "loads", "Compute rainflow counts, load spectra and equivalent amplitudes of the loads of a run."
    )
    setting_options(parser, LoadSettings, "runs", "repeats", "reference_run", "channels", "slope", "classes")
    output_options(parser, None, default=f"{', '.join(FILES)} in the folder of the run")
    message_options(parser, quiet=True)
    return parser


def _job(settings: LoadSettings, console: Console) -> None:
    from vehicle.drawing.rendering.load_plot import plot_loads
    from vehicle.runs.output.folder import write_together
    from vehicle.signals.formats.reader import time_file
    from vehicle.signals.records.run_summary import available_summary

    source = time_file(settings.runs[0])
    if len(settings.runs) > 1 or settings.reference_run or settings.repeats:
        _schedule(settings, console)
        return
    paths = settings.destination.files(source.parent, FILES)
    counted = _counted(settings.runs[0], settings)
    loads = list(counted.loads.values())
    summary = available_summary(source.parent)
    tyres = summary.tyre if summary else None
    caption = (
        f"{source.name}, {counted.duration:g} s{f'; tyres {tyres}' if tyres else ''}; rainflow counts of ASTM E1049; "
        f"equivalent amplitude: one cycle a second with it does the same damage, S-N slope {settings.slope:g}"
    )
    texts = _table(loads, caption), _spectra(loads, caption, settings.classes)
    write_together(paths, (*texts, partial(plot_loads, loads=loads, caption=caption)))
    if not console.quiet:
        print(_report(loads, caption))
        print(f"files: {paths[0].parent}: {', '.join(path.name for path in paths)}")


SCHEDULE = "schedule.csv"


def _schedule(settings: LoadSettings, console: Console) -> None:
    """Write the damage of several runs, each repeated, and its ratio to a reference run."""
    from vehicle.digits import number
    from vehicle.runs.output.folder import write_text
    from vehicle.signals.analysis.load_schedule import scheduled_loads
    from vehicle.signals.formats.csv_table import table_text

    texts = settings.repeats.split(",") if settings.repeats else ["1"] * len(settings.runs)
    try:
        repeats = [float(text) for text in texts]
    except ValueError:
        raise ConfigurationError(
            f"--repeats {settings.repeats}: must be numbers, for example --repeats 100,20"
        ) from None
    runs = [_counted(run, settings) for run in settings.runs]
    reference = None if settings.reference_run is None else _counted(settings.reference_run, settings)
    rows = scheduled_loads(runs, repeats, settings.slope, reference)
    (path,) = settings.destination.files(Path(), (SCHEDULE,))
    parts = ", ".join(f"{count:g} x {run.name}" for count, run in zip(repeats, runs, strict=True))
    against = "" if reference is None else f"; damage ratio: divided by the damage of {reference.name}"
    caption = f"schedule {parts}; rainflow counts of ASTM E1049, S-N slope {settings.slope:g}{against}"
    heads = ["channel", "unit", "equivalent_amplitude", *(f"share of {run.name} [-]" for run in runs)]
    heads += [] if reference is None else ["damage_ratio [-]"]
    table = [
        [row.name, row.unit, row.equivalent_amplitude, *row.shares, *([] if reference is None else [row.ratio])]
        for row in rows
    ]
    write_text(path, table_text([heads, *table], [caption]))
    if console.quiet:
        return
    print(caption)
    print(f"{'channel':<34}{'unit':>5}{'equivalent':>12}  {'damage ratio':>12}  shares")
    strongest = sorted(rows, key=lambda row: -(row.ratio or row.equivalent_amplitude))[:SHOWN]
    for row in strongest:
        shares = ", ".join(f"{number(100.0 * share, 3)} %" for share in row.shares)
        print(f"{row.name:<34}{row.unit:>5}{row.equivalent_amplitude:>12.5g}  {number(row.ratio):>12}  {shares}")
    print(
        f"files: {path}" + (f"; {len(rows) - len(strongest)} more channels in this file" if len(rows) > SHOWN else "")
    )


def _counted(run: Path, settings: LoadSettings) -> CountedRun:
    """Return the counted loads of a run."""
    from vehicle.signals.analysis.load_schedule import CountedRun
    from vehicle.signals.analysis.load_spectrum import load_spectrum
    from vehicle.signals.formats.reader import read_columns, time_file

    source = time_file(run)
    record = read_columns(source)
    duration = float(record.time[-1] - record.time[0])
    loads = {
        name: load_spectrum(name, record.units[name], record.channels[name], slope=settings.slope, duration=duration)
        for name in _chosen(settings.channels, record.units, source)
    }
    return CountedRun(name=run.stem, duration=duration, loads=loads)


def _chosen(text: str | None, units: Mapping[str, str], source: Path) -> list[str]:
    """Return the channels to count: --channels, by default all forces, torques and travels."""
    if text is None:
        loads = [name for name, unit in units.items() if unit in ("N", "N m") or name.startswith("suspension_travel_")]
        if not loads:
            raise ConfigurationError(
                f"{source}: contains no force [N], torque [N m] or suspension travel; name channels with "
                "--channels, or record loads: python -m vehicle shaker --channels loads"
            )
        return loads
    names = [name.strip() for name in text.split(",")]
    missing = next((name for name in names if name not in units), None)
    if missing is not None:
        raise ConfigurationError(f"--channels: {source} has no channel {missing!r}; choose from {', '.join(units)}")
    return list(dict.fromkeys(names))


HEADS = ("minimum", "maximum", "mean", "rms", "cycles", "largest_range", "equivalent_amplitude")


def _table(loads: list[LoadSpectrum], caption: str) -> str:
    from vehicle.signals.formats.csv_table import table_text

    rows = [[load.name, load.unit, *(getattr(load, head) for head in HEADS)] for load in loads]
    return table_text([["channel", "unit", *HEADS], *rows], [caption], digits=9)


def _spectra(loads: list[LoadSpectrum], caption: str, classes: int) -> str:
    """Return the range-pair table: cycles in equal classes from zero to the largest range of each channel."""
    from vehicle.signals.formats.csv_table import table_text

    rows: list[list[Any]] = [
        ["channel", "unit", "range_above", "range_up_to", "cycles", "cycles_of_this_range_or_more"]
    ]
    for load in loads:
        edges, counts = load.classes(classes)
        columns = zip(edges[:-1], edges[1:], counts, counts[::-1].cumsum()[::-1], strict=True)
        rows += [[load.name, load.unit, *numbers] for numbers in columns]
    return table_text(rows, [caption], digits=9)


def _report(loads: list[LoadSpectrum], caption: str) -> str:
    strongest = sorted(loads, key=lambda load: -load.equivalent_amplitude * (1.0 if load.unit != "m" else 1e-9))[:SHOWN]
    heads = f"{'channel':<34}{'unit':>5}{'min':>11}{'max':>11}{'mean':>11}{'rms':>11}{'cycles':>10}{'equivalent':>12}"
    rows = [
        f"{load.name:<34}{load.unit:>5}{load.minimum:>11.5g}{load.maximum:>11.5g}{load.mean:>11.5g}{load.rms:>11.5g}"
        f"{load.cycles:>10.6g}{load.equivalent_amplitude:>12.5g}"
        for load in strongest
    ]
    left = len(loads) - len(strongest)
    return "\n".join([caption, heads, *rows, *([f"and {left} more in {FILES[0]}"] if left else [])])


main = command(parser, LoadSettings, _job)
