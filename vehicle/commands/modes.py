"""`python -m vehicle.modes`: natural frequencies, damping and description of the modes of the assembled car."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.command_line import ProgressLine, command, print_result
from vehicle.commands.destination import output_file_of
from vehicle.commands.options import (
    FORCE_HELP,
    command_parser,
    damper_option,
    film_name,
    finite_numbers,
    message_options,
    set_once,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError, SimulationError

if TYPE_CHECKING:
    from vehicle.runs.car.motion_figures import MotionFigure


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("modes", "Compute the modes of the complete car up to 60 Hz.")
    vehicle_options(parser)
    damper_option(parser)
    parser.add_argument(
        "--speed", type=float, metavar="KM/H", help="speed of the car [km/h]: the tyres roll; default: the car stands"
    )
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument(
        "--uff",
        type=Path,
        metavar="FILE.uff",
        help="write points, lines and complex mode shapes as a universal file (datasets 15, 82 and 55), for "
        "Testlab, ME'scope or `python -m vehicle compare`",
    )
    parser.add_argument(
        "--animate", type=float, metavar="HZ", help="with --video: show the mode nearest to this frequency [Hz]"
    )
    parser.add_argument(
        "--video",
        nargs="?",
        const="",
        metavar="FILE.mp4",
        help="write the mode of --animate as a film of three cycles (4 s) that can run in a loop; default: "
        "runs/mode_<frequency>_hz.mp4",
    )
    parser.add_argument(
        "--decoupling",
        metavar="PART",
        help="show the modes of a part on its mounts, for example engine: shares of kinetic energy in its three "
        "translations and three rotations, and its torque roll axis",
    )
    decoupled = parser.scoped_group(
        "a decoupling", needs="--decoupling", active=lambda options: bool(options.decoupling)
    )
    decoupled.add_argument(
        "--grounded", action="store_true", help="compute the modes of the part with the body fixed; default: in the car"
    )
    decoupled.add_argument(
        "--aim",
        type=float,
        metavar="PERCENT",
        help="mark the modes whose largest share is below P percent; default: mark none",
    )
    decoupled.add_argument(
        "--crankshaft",
        default="0,1,0",
        metavar="X,Y,Z",
        help="direction of the crankshaft, for example 0,1,0; default: across the car",
    )
    files = parser.scoped_group(
        "files", needs="--uff or --video", active=lambda options: options.uff is not None or options.video is not None
    )
    files.add_argument("--force", action="store_true", help=FORCE_HELP)
    message_options(parser)
    return parser


def _job(options: argparse.Namespace) -> None:
    _check_film_options(options)
    from vehicle.runs.car import Car
    from vehicle.runs.car.motion_figures import damper_notes, motion_figures

    if options.uff is not None and options.uff.exists():
        written_here = options.uff.is_file() and b"vehicle-on-shaker" in options.uff.read_bytes()[:500]
        if not (options.force and written_here):
            mend = (
                "was not written by this program, so --force does not replace it; set another name"
                if options.force
                else "exists; give --force"
            )
            raise ConfigurationError(f"--uff {options.uff}: {mend}")
    speed = (
        []
        if options.speed is None
        else set_once(options.overrides, "--speed", [f"driving.speed={options.speed / 3.6!r}"])
    )
    car = Car.load(options.vehicle, [*options.overrides, *speed])
    if options.decoupling is not None:
        print(_decoupling(options, car))
        return
    figures: Sequence[MotionFigure] = ()
    reason = ""
    try:
        figures = motion_figures(car, (options.damper,))
    except SimulationError as error:
        reason = f"key figures of the suspension cannot be computed: {error}"
    table = modes_table(car, options.damper, figures)
    table["notices"] += [reason] if reason else []
    table["notices"] += damper_notes(car) if options.damper == "sliding" else []
    if options.uff is not None:
        from vehicle.runs.output.folder import write_whole
        from vehicle.runs.output.mode_file import write_modes

        write_whole(options.uff, lambda path: write_modes(path, car, options.damper))
    if options.animate is not None:
        table["film"] = _film(options, car)
    print_result(options, table, report(table, figures))


def _decoupling(options: argparse.Namespace, car: Any) -> str:
    """Return the decoupling of a part as a table or as JSON."""
    from vehicle.engines.linear.decoupling import decoupling
    from vehicle.runs.car.decoupling_text import decoupling_json, decoupling_table

    if options.aim is not None and not 0.0 < options.aim <= 100.0:
        raise ConfigurationError(f"--aim {options.aim:g}: must be above 0 and at most 100 percent")
    crankshaft = finite_numbers(options.crankshaft, ",")
    if len(crankshaft) != 3:
        raise ConfigurationError(f"--crankshaft {options.crankshaft}: must be three numbers, for example 0,1,0")
    x, y, z = crankshaft
    engine_modes = decoupling(
        car.matrices,
        options.decoupling,
        grounded=options.grounded,
        stuck=options.damper == "stuck",
        crankshaft=(x, y, z),
    )
    return decoupling_json(engine_modes) if options.json else decoupling_table(engine_modes, options.aim)


def _check_film_options(options: argparse.Namespace) -> None:
    """Check the film options before the computation, and choose the OpenGL library before MuJoCo is imported."""
    if options.animate is None:
        if options.video is not None:
            raise ConfigurationError("--video: the mode is missing; give its frequency, for example --animate 28")
        return
    if not 0.0 < options.animate < math.inf:
        raise ConfigurationError(f"--animate {options.animate:g}: must be above 0 Hz, for example --animate 28")
    if options.video is None:
        raise ConfigurationError(
            f"--animate {options.animate:g}: makes a film only with --video; add --video [FILE.mp4]"
        )
    from vehicle.drawing.rendering.backend import require_film
    from vehicle.runs.output.free_names import named_file

    if options.video:
        named_file(options.held, film_name(options.video, ""), "--video", force=options.force)
    require_film()


def _film(options: argparse.Namespace, car: Any) -> dict[str, Any]:
    """Write the film of a mode, and return its description and path."""
    from vehicle.drawing.rendering.mode_film import mode_film
    from vehicle.runs.car.main_mode import nearest
    from vehicle.runs.output.folder import write_whole

    mode = nearest(car.modes(options.damper), options.animate)
    path = film_name(options.video, f"runs/mode_{mode.frequency:.2f}_hz.mp4")
    if not options.video:
        path = output_file_of(argparse.Namespace(**vars(options), output=None), path)
    write_whole(path, lambda file: mode_film(car.model, mode, file, progress=ProgressLine("film      ", enabled=True)))
    return {"file": str(path), "asked_hz": options.animate, "frequency_hz": mode.frequency}


def modes_table(car: Any, damper: str, figures: Sequence[MotionFigure]) -> dict[str, Any]:
    """Return headline figures and modes of the car and the modes of its free body as plain numbers and texts."""
    from vehicle.model.parameters.body_notices import body_notices

    body = car.model.superelement
    trimmed = car.trimmed_body
    modes = car.modes(damper)
    return {
        "damper": damper,
        "tyre": car.vehicle.driving.words,
        "inertia_about": car.vehicle.body.inertia.about,
        "notices": body_notices(car.vehicle, car.overrides),
        "figures": [asdict(figure) for figure in figures],
        "modes": [
            {
                "frequency_hz": mode.frequency,
                "damping_ratio": mode.damping_ratio,
                "description": mode.description,
                "energy": mode.energy,
                "motions": mode.motions,
            }
            for mode in modes
        ],
        "growing": [mode.description.removeprefix("grows: ") for mode in modes if mode.grows],
        "free_body": {
            "frequency_hz": [float(value) for value in trimmed.frequencies * car.vehicle.body.frequency_scale],
            "description": list(trimmed.mode_names),
            "with_spring_seats_hz": [float(value) for value in body.frequencies * car.vehicle.body.frequency_scale],
        },
    }


def report(table: dict[str, Any], figures: Sequence[MotionFigure]) -> str:
    """Return the modes as the printed table: frequency, damping ratio, motion, share of the kinetic energy."""
    from vehicle.runs.car.car_text import figures_table

    width = max((len(mode["description"]) for mode in table["modes"]), default=0)
    lines = [
        f"assembled car, dampers {table['damper']}, tyres {table['tyre']}",
        f"{'Hz':>8} {'damping':>8}  {'description':<{width}} energy",
    ]
    for mode in table["modes"]:
        shares = sorted(mode["energy"].items(), key=lambda item: -item[1])
        text = ", ".join(f"{name} {100 * share:.0f} %" for name, share in shares if share >= 0.05)
        lines.append(
            f"{mode['frequency_hz']:8.3f} {100 * mode['damping_ratio']:6.2f} %  {mode['description']:<{width}} {text}"
        )
    if table["growing"]:
        fault = "does not stand" if table["tyre"] == "standing" else "does not keep its course when driving"
        lines.append(
            f"this car {fault}: {', '.join(table['growing'])} grows by itself (negative damping in the table above)"
        )
    lines += [str(figures_table(figures))] if figures else []
    lines += [f"note     {text}" for text in table["notices"]]
    free = table["free_body"]
    if free["frequency_hz"]:
        lines.append("free trimmed body")
    for frequency, name in zip(free["frequency_hz"], free["description"], strict=True):
        lines.append(f"{frequency:8.3f}           {name}")
    if "film" in table:
        film = table["film"]
        lines.append(f"{film['file']}: mode at {film['frequency_hz']:.3f} Hz, the nearest to {film['asked_hz']:g} Hz")
    return "\n".join(lines)


main = command(parser, _job)
