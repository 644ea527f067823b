"""`python -m vehicle road`: write the plate signals of a car on a road."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.input_options import road_options
from vehicle.commands.options import (
    command_parser,
    figures_option,
    message_options,
    output_options,
    read,
    setting_options,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.digits import number
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, part, setting
from vehicle.signals.excitation.input_settings import DriveInput

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vehicle.drawing.rendering.road_plot import RoadTrack
    from vehicle.signals.analysis.samples import Vector
    from vehicle.signals.excitation.road_drive import RoadDrive
    from vehicle.signals.excitation.signal import Signal


FILE = Path("road.csv")
"""Default file."""


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser(
        "road",
        "Write the plate signals of driving on a road: a road class, a measured profile or an obstacle.",
    )
    vehicle_options(parser)
    parser.add_argument("--class", dest="road_class", metavar="C", help="class of ISO 8608, A to H")
    parser.add_argument(
        "--profile", type=Path, metavar="FILE.csv", help="file of a measured road: columns distance, left, right [m]"
    )
    setting_options(parser, RoadCommand, "obstacle")
    road_options(parser, lambda _: True, lambda options: options.road_class is not None)
    setting_options(parser, RoadCommand, "iri")
    parser.former(
        "--road[ =]", "--road: belongs to shaker; use --class B, --profile FILE.csv or --obstacle cleat:20x50"
    )
    output_options(parser, FILE, metavar="FILE.csv")
    figures_option(parser)
    message_options(parser, quiet=True)
    return parser


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadCommand(Settings):
    """Road whose plate signals are written.

    Attributes:
        drive: the road and the speed.
        car: car that drives on it.
        destination: file of the plate signals; by default `FILE`.
        figures: also draw the road.
    """

    drive: DriveInput = part(DriveInput)
    car: CarChoice = part(CarChoice)
    destination: Destination = part(Destination)
    iri: bool = setting(
        "also print the international roughness index (IRI) of each track and its class of ISO 8608; "
        "FILE_iri.csv has the IRI of every 100 m",
        False,
        action="store_true",
    )
    figures: bool = True
    obstacle: str | None = setting(
        "obstacle on a level road, sizes in mm: cleat:20x50, half_round:50, speed_bump, ramp, pothole, cobbles",
        metavar="NAME[:SIZES][:left|right][@METRES]",
    )


def settings_of(options: argparse.Namespace) -> RoadCommand:
    """Return the settings of the parsed options."""
    road_class = options.road_class and options.road_class.upper()
    roads = [road for road in (road_class, options.profile, options.obstacle) if road is not None]
    if len(roads) != 1:
        raise ConfigurationError("road: give exactly one of --class, --profile and --obstacle")
    drive = read(options, DriveInput, road=roads[0])
    return read(options, RoadCommand, drive=drive)


def _job(settings: RoadCommand, console: Console) -> None:
    from vehicle.drawing.rendering.road_plot import plot_road
    from vehicle.runs.car.road import Road
    from vehicle.runs.output.folder import whole_files, write_whole
    from vehicle.signals.excitation.obstacle import Obstacle
    from vehicle.signals.excitation.road_drive import RoadDrive
    from vehicle.signals.excitation.signal_file import write_signal
    from vehicle.signals.formats.csv_table import write_table

    destination, road = settings.destination, settings.drive.road
    inputs = tuple(file for file in (road, settings.car.vehicle) if isinstance(file, Path))
    path = destination.file(FILE, ending=".csv", protect=inputs)
    picture = path.with_suffix(".png")
    if settings.figures:
        destination.further_file(picture, "--output", ending=".png", protect=inputs)
    vehicle = settings.car.load()
    if settings.obstacle is not None:
        Obstacle.parse(settings.obstacle)
    settled = Road(road, settings.drive.require_speed(), **settings.drive.settings.given())
    drive = settled.under(vehicle, settings.car.overrides)
    signal, comments, beside = drive.signal(), [f"wheels of {vehicle.name}"], {}
    if isinstance(drive, RoadDrive):
        slopes = drive.slopes(signal)
        beside = {f"road_{wheel} [m]": signal.profile[wheel] for wheel in signal.wheels}
        beside |= {f"slope_{wheel} [-]": slopes[wheel] for wheel in signal.wheels}
        comments.append("displacement and slope: the road after averaging by the contact patch of the tyre")
    indices = path.with_name(f"{path.stem}_iri.csv")
    roughness = {}
    if settings.iri:
        if not isinstance(drive, RoadDrive):
            raise ConfigurationError(
                "--iri: the IRI needs heights against distance, but this road was recorded over time; remove --iri"
            )
        destination.further_file(indices, "--output", ending=".csv", protect=inputs)
        roughness = drive.roughness()
    with whole_files([path, picture, indices]) as (new_path, new_picture, new_indices):
        comments = [signal.source, *comments]
        write_whole(new_path, lambda file: write_signal(file, signal, comments, beside=beside))
        if settings.figures and isinstance(drive, RoadDrive):
            distance, tracks = _shown_tracks(drive, signal, slopes)
            title = drive.name.replace("_", " ")
            write_whole(new_picture, lambda file: plot_road(file, distance, tracks, title, signal.source))
        if roughness:
            edges = roughness["left"][0].edges
            columns = [edges[:-1], edges[1:], *(index.segments for index, _ in roughness.values())]
            cells = ["from [m]", "to [m]", *(f"iri_{side} [m/km]" for side in roughness)]
            write_whole(new_indices, lambda file: write_table(file, cells, columns, comments[:1], "%.6g"))
    if not console.quiet:
        sizes = ", ".join(f"{wheel} {1e3 * float(z.std()):.3g}" for wheel, z in signal.displacement.items())
        print(f"{path}: {signal.source}; {signal.duration:g} s; RMS [mm] {sizes}")
        for side, (index, level) in roughness.items():
            low, high = number(index.segments.min()), number(index.segments.max())
            short = f" over the {index.edges[-1] - index.edges[0]:.0f} m of the road"
            ranged = f", {low} to {high} over 100 m" if index.segments.size > 1 else short
            rated = "" if level is None else f"; class {level.letter} of ISO 8608"
            print(f"IRI of the {side} track: {number(index.overall)} m/km{ranged}{rated}")


def _shown_tracks(
    drive: RoadDrive, signal: Signal, slopes: Mapping[str, Vector]
) -> tuple[Vector, dict[str, RoadTrack]]:
    """Return distances [m] and the road below the foremost wheel of each track, for the picture.

    Equal tracks are one. A short drive is shown to its end.
    """
    import numpy as np

    from vehicle.drawing.rendering.road_plot import RoadTrack

    distance, (begin, end) = signal.time * drive.speed / 3.6, drive.shown
    shift = max(end - float(distance[-1]), 0.0)
    inside = (distance >= begin - shift) & (distance <= end - shift)
    leaders = {f"{side} track": wheel for wheel, behind, side in reversed(drive.wheels) if behind == 0.0}
    tracks = {
        name: RoadTrack(signal.profile[wheel][inside], signal.displacement[wheel][inside], slopes[wheel][inside])
        for name, wheel in sorted(leaders.items())
    }
    first, *others = tracks.values()
    if others and all(np.array_equal(track.road, first.road) for track in others):
        tracks = {"both tracks": first}
    return distance[inside], tracks


main = command(parser, settings_of, _job)
