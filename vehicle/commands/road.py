"""`python -m vehicle road`: write the plate signals of a car on a road."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.command_line import command
from vehicle.commands.destination import output_file_of
from vehicle.commands.input_options import record_choice, road_options
from vehicle.commands.options import command_parser, figures_option, message_options, output_options, vehicle_options
from vehicle.commands.parser import Parser
from vehicle.digits import number
from vehicle.errors import ConfigurationError
from vehicle.signals.excitation.road_settings import SETTINGS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vehicle.drawing.rendering.road_plot import RoadTrack
    from vehicle.model.parameters.vehicle import Vehicle
    from vehicle.runs.car.road import Drive, Road
    from vehicle.signals.analysis.samples import Vector
    from vehicle.signals.excitation.road_drive import RoadDrive
    from vehicle.signals.excitation.signal import Signal


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser(
        "road", "Write the plate signals of a car on a road: a class, a measured profile or an obstacle."
    )
    vehicle_options(parser)
    parser.add_argument("--class", dest="road_class", metavar="C", help="class of ISO 8608, A to H")
    parser.add_argument(
        "--profile",
        type=Path,
        metavar="FILE.csv",
        help="or the file of a measured road: columns distance, left, right [m]",
    )
    parser.add_argument(
        "--obstacle",
        metavar="NAME[:SIZES][:left|right][@METRES]",
        help="or an obstacle on a level road, sizes in mm: cleat:20x50, half_round:50, speed_bump, ramp, pothole, "
        "cobbles",
    )
    road_options(parser, lambda _: True, lambda options: options.road_class is not None)
    parser.add_argument(
        "--iri",
        action="store_true",
        help="also print the international roughness index (IRI) of each track and its class of ISO 8608; "
        "FILE_iri.csv has the IRI of every 100 m",
    )
    parser.former(
        "--road[ =]",
        "--road is an option of shaker; set --class B, --profile FILE.csv or --obstacle cleat:20x50 here",
    )
    output_options(parser, Path("road.csv"), metavar="FILE.csv")
    figures_option(parser)
    message_options(parser, quiet=True)
    return parser


def _job(options: argparse.Namespace) -> None:
    from vehicle.drawing.rendering.road_plot import plot_road
    from vehicle.model.parameters.vehicle import load_vehicle
    from vehicle.runs.output.folder import whole_files, write_whole
    from vehicle.runs.output.free_names import named_file
    from vehicle.signals.excitation.obstacle import Obstacle
    from vehicle.signals.excitation.road_drive import RoadDrive
    from vehicle.signals.excitation.signal_file import write_signal
    from vehicle.signals.formats.csv_table import write_table

    roads = [road for road in (options.road_class, options.profile, options.obstacle) if road is not None]
    if len(roads) != 1:
        raise ConfigurationError("road: give exactly one of --class, --profile and --obstacle")
    inputs = tuple(file for file in (options.profile, options.vehicle) if file is not None)
    path = output_file_of(options, options.output, ending=".csv", protect=inputs)
    picture = path.with_suffix(".png")
    if options.figures:
        named_file(options.held, picture, ending=".png", force=options.force, protect=inputs)
    vehicle = load_vehicle(options.vehicle, options.overrides)
    if options.obstacle is not None:
        Obstacle.parse(options.obstacle)
    drive = road_drive(roads[0] if options.road_class is None else roads[0].upper(), options, vehicle)
    signal, comments, beside = drive.signal(), [f"wheels of {vehicle.name}"], {}
    if isinstance(drive, RoadDrive):
        slopes = drive.slopes(signal)
        beside = {f"road_{wheel} [m]": signal.profile[wheel] for wheel in signal.wheels}
        beside |= {f"slope_{wheel} [-]": slopes[wheel] for wheel in signal.wheels}
        comments.append("displacement and slope: the road after its averaging by the contact patch of the tyre")
    indices = path.with_name(f"{path.stem}_iri.csv")
    roughness = {}
    if options.iri:
        if not isinstance(drive, RoadDrive):
            raise ConfigurationError(
                "--iri: the road was recorded over time, but the IRI needs heights over distance; leave --iri out"
            )
        named_file(options.held, indices, ending=".csv", force=options.force, protect=inputs)
        roughness = drive.roughness()
    with whole_files([path, picture, indices]) as (new_path, new_picture, new_indices):
        comments = [signal.source, *comments]
        write_whole(new_path, lambda file: write_signal(file, signal, comments, beside=beside))
        if options.figures and isinstance(drive, RoadDrive):
            distance, tracks = _shown_tracks(drive, signal, slopes)
            title = drive.name.replace("_", " ")
            write_whole(new_picture, lambda file: plot_road(file, distance, tracks, title, signal.source))
        if roughness:
            edges = roughness["left"][0].edges
            columns = [edges[:-1], edges[1:], *(index.segments for index, _ in roughness.values())]
            cells = ["from [m]", "to [m]", *(f"iri_{side} [m/km]" for side in roughness)]
            write_whole(new_indices, lambda file: write_table(file, cells, columns, comments[:1], "%.6g"))
    if not options.quiet:
        sizes = ", ".join(f"{wheel} {1e3 * float(z.std()):.3g}" for wheel, z in signal.displacement.items())
        print(f"{path}: {signal.source}; {signal.duration:g} s; RMS [mm] {sizes}")
        for side, (index, level) in roughness.items():
            low, high = number(index.segments.min()), number(index.segments.max())
            short = f" over the {index.edges[-1] - index.edges[0]:.0f} m of the drive"
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


def class_or_profile(text: str) -> str | Path:
    """Return the class of ISO 8608, the text of an obstacle, or the file of a profile, of the value of --road.

    Raises:
        ConfigurationError: the value has another form.
    """
    from vehicle.signals.excitation.obstacle import SHAPES, is_obstacle
    from vehicle.signals.excitation.road_drive import LEVEL

    if len(text) > 1 and not Path(text).is_file():
        if is_obstacle(text) or text == LEVEL:
            return text
        raise ConfigurationError(
            f"--road {text}: unknown; give a class of ISO 8608 (A to H), the file of a measured profile, an "
            f"obstacle ({', '.join(SHAPES)}) or {LEVEL}"
        )
    return text.upper() if len(text) == 1 else Path(text)


def road_drive(road: str | Path, options: argparse.Namespace, vehicle: Vehicle) -> Drive:
    """Return the drive of a car over a road, a class of ISO 8608 or the file of a profile, with its options.

    Raises:
        ConfigurationError: no speed, a car that cannot roll, or a value out of range.
    """
    return road_of(road, options).under(vehicle, getattr(options, "overrides", None) or ())


def road_of(road: str | Path, options: argparse.Namespace) -> Road:
    """Return the `Road` of the options; the arguments are those of `road_drive`.

    Raises:
        ConfigurationError: no speed.
    """
    from vehicle.runs.car.road import Road
    from vehicle.signals.records.choice import Choice

    if options.speed is None:
        raise ConfigurationError("the speed on the road is missing; set it in km/h, for example --speed 80")
    choice = Choice()
    if isinstance(options.speed, str) and hasattr(options, "picks"):
        # --rate is that of the run; the times are those of the file.
        settings = {**vars(options), "rate": None}
        choice = record_choice(argparse.Namespace(**settings), "height", known=("speed",)) or Choice()
    return Road(road, options.speed, choice=choice, **{name: getattr(options, name, None) for name in SETTINGS})


main = command(parser, _job)
