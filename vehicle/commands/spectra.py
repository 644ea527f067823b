"""`python -m vehicle spectra`: spectra of the accelerations of runs, and the level of their roads after ISO 8608."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.input_options import record_options
from vehicle.commands.options import command_parser, message_options, output_options, setting_options
from vehicle.commands.parser import Parser
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, pair, part, setting
from vehicle.signals.records.record_settings import RecordSettings

if TYPE_CHECKING:
    from vehicle.signals.records.record_spectra import RecordSpectra


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser(
        "spectra",
        "Compute spectral densities, third octaves and cumulative RMS of accelerations, weighted and unweighted.",
    )
    setting_options(parser, SpectraSettings, "runs", "channels", "range")
    record_options(
        parser.add_argument_group("measurement files"),
        "the name that this channel has in runs, for example seat_rail_acc_z; it determines the weighting",
        highpass=False,
    )
    output_options(parser, None, default="the folder of a single run, runs/spectra for several runs")
    message_options(parser, quiet=True)
    return parser


@dataclass(frozen=True, kw_only=True, slots=True)
class SpectraSettings(Settings):
    """Settings of spectra.

    Attributes:
        record: channels, units and times of measurement files.
    """

    runs: tuple[Path, ...] = setting(
        "folders of runs, or measurement files; all are drawn in the same pictures",
        flag="runs",
        nargs="+",
        type=Path,
        metavar="RUN",
    )
    channels: str | None = setting(
        "acceleration channels; default: seat rail, seat and vertical acceleration of the knuckles, or all "
        "accelerations of a measurement file without these",
        metavar="NAME,...",
    )
    range: tuple[float, float] = setting(
        "lowest and highest frequency [Hz]; default: %(default)s, the range of ISO 2631-1 for comfort",
        (0.5, 80.0),
        type=pair("--range", "LOW:HIGH [Hz], for example 0.5:80", above=0.0),
        metavar="HZ:HZ",
    )
    record: RecordSettings = part(RecordSettings)
    destination: Destination = part(Destination)


def _job(settings: SpectraSettings, console: Console) -> None:
    from vehicle.drawing.rendering.spectra_plot import plot_road_levels, plot_spectra
    from vehicle.runs.output.folder import Content, write_together
    from vehicle.runs.output.spectra_files import picture_columns, spectra_text, third_octaves_text
    from vehicle.signals.formats.reader import time_file
    from vehicle.signals.records.record_spectra import record_spectra

    asked = [name.strip() for name in settings.channels.split(",")] if settings.channels else None
    choice = settings.record.choice("")
    if len(settings.runs) > 1:
        console.require_one_file()
    runs = [record_spectra(path, asked, settings.range, choice) for path in settings.runs]
    console.accept(text for run in runs for text in run.notices)
    names = _unique([run.name for run in runs])
    by_name = dict(zip(names, runs, strict=True))
    pictures = picture_columns(runs)
    levels = {
        f"{name}, {wheel}" if len(run.road_levels) > 1 else name: level
        for name, run in by_name.items()
        for wheel, level in run.road_levels.items()
    }
    folder = time_file(settings.runs[0]).parent if len(runs) == 1 else Path("runs/spectra")
    caption = "; ".join(f"{name}: {run.caption}" if len(runs) > 1 else run.caption for name, run in by_name.items())
    spectra = {name: run.channels for name, run in by_name.items()}
    contents: dict[str, Content] = {
        "spectra.csv": spectra_text(by_name, caption),
        "third_octaves.csv": third_octaves_text(by_name, caption),
    }
    for file, (title, columns) in pictures.items():
        contents[file] = partial(plot_spectra, runs=spectra, channels=columns, title=title, caption=caption)
    if levels:
        title = "Roads compared with the classes of ISO 8608"
        contents["spectra_road.png"] = partial(plot_road_levels, levels=levels, title=title, caption=caption)
    paths = settings.destination.files(folder, list(contents))
    write_together(paths, contents.values())
    for name, run in by_name.items():
        for text in run.notices:
            console.notice(f"{name}: {text}")
    console.say("\n".join(_report(by_name)))
    console.say(f"files: {paths[0].parent}: {', '.join(path.name for path in paths)}")


def _unique(names: Sequence[str]) -> list[str]:
    """Return the names with a number after those that occur twice."""
    return [f"{name} ({index + 1})" if names.count(name) > 1 else name for index, name in enumerate(names)]


def _report(runs: Mapping[str, RecordSpectra]) -> list[str]:
    """Return the printed table: RMS over the range, highest third octave, and half of the mean square."""
    width = max(len(spectrum.label) for run in runs.values() for spectrum in run.channels)
    lines = []
    for name, run in runs.items():
        lines.append(f"{name}: {run.caption}")
        lines.append(f"{'channel':<{width}}{'RMS [m/s2]':>12}  highest third octave   half of the mean square below")
        for spectrum in run.channels:
            band, rms = run.highest_band(spectrum)
            half = run.median_frequency(spectrum)
            lines.append(
                f"{spectrum.label:<{width}}{spectrum.rms:>12.4g}  {f'{band:g} Hz, {rms:.3g} m/s2':<27}{half:>7.2f} Hz"
            )
        lines += [
            f"road under {wheel}: G(0.1 cycles/m) = {1e6 * level.reference_density:.3g}e-6 m3, class "
            f"{level.letter} of ISO 8608 (fit over {level.fitted[0]:.3g} to {level.fitted[1]:.3g} cycles/m)"
            for wheel, level in run.road_levels.items()
        ]
    return lines


main = command(parser, SpectraSettings, _job)
