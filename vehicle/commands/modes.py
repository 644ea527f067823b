"""`python -m vehicle.modes`: natural frequencies, damping and description of the modes of the assembled car."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.options import (
    FORCE_HELP,
    acceleration_options,
    command_parser,
    damper_option,
    message_options,
    setting_options,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.drawing.rendering.film_settings import FilmSettings
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, finite_numbers, part, setting

if TYPE_CHECKING:
    from vehicle.runs.car.motion_figures import MotionFigure


@dataclass(frozen=True, kw_only=True, slots=True)
class ModesSettings(Settings):
    """Settings of the modes of a car.

    Attributes:
        damper: state of the dampers, "stuck" or "sliding".
        film: film of the mode nearest to `animate`.
        destination: of the films and files.
    """

    car: CarChoice = part(CarChoice)
    damper: str = "stuck"
    uff: Path | None = setting(
        "write points, lines and complex mode shapes as a universal file (datasets 15, 82 and 55), for "
        "Testlab, ME'scope or `python -m vehicle compare`",
        type=Path,
        metavar="FILE.uff",
    )
    film: FilmSettings = part(FilmSettings)
    decoupling: str | None = setting(
        "show the modes of a part on its mounts, for example engine: shares of kinetic energy in its three "
        "translations and three rotations, and its torque roll axis",
        metavar="PART",
    )
    grounded: bool = setting(
        "compute the modes of the part with the body fixed; default: in the car", False, action="store_true"
    )
    crankshaft: str = setting(
        "direction of the crankshaft, for example 0,1,0; default: across the car", "0,1,0", metavar="X,Y,Z"
    )
    destination: Destination = part(Destination)
    speed: float | None = setting(
        "speed of the car [km/h]: the tyres roll; default: the car stands",
        within="[0, inf)",
        type=float,
        metavar="KM/H",
    )
    animate: float | None = setting(
        "with --video: show the mode nearest to this frequency [Hz]", within="(0, inf)", type=float, metavar="HZ"
    )
    aim: float | None = setting(
        "mark the modes whose largest share is below P percent; default: mark none",
        within="(0, 100]",
        type=float,
        metavar="PERCENT",
    )


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("modes", "Compute the modes of the complete car up to 60 Hz.")
    acceleration_options(vehicle_options(parser))
    damper_option(parser)
    setting_options(parser, ModesSettings, "speed")
    parser.add_argument("--json", action="store_true", help="print JSON")
    setting_options(parser, ModesSettings, "uff", "animate")
    parser.add_argument(
        "--video",
        nargs="?",
        const="",
        metavar="FILE.mp4",
        help="write the mode chosen with --animate as a video of three cycles (4 s) that can run in a loop; default: "
        "runs/mode_<frequency>_hz.mp4",
    )
    setting_options(parser, ModesSettings, "decoupling")
    decoupled = parser.scoped_group(
        "a decoupling", needs="--decoupling", active=lambda options: bool(options.decoupling)
    )
    setting_options(decoupled, ModesSettings, "grounded", "aim", "crankshaft")
    files = parser.scoped_group(
        "files", needs="--uff or --video", active=lambda options: options.uff is not None or options.video is not None
    )
    files.add_argument("--force", action="store_true", help=FORCE_HELP)
    message_options(parser)
    return parser


def _job(settings: ModesSettings, console: Console) -> None:
    _check_film(settings)
    from vehicle.runs.car import Car
    from vehicle.runs.car.axle import mass_and_cog
    from vehicle.runs.car.motion_figures import damper_notes, motion_figures

    if settings.uff is not None and settings.uff.exists():
        written_here = settings.uff.is_file() and b"vehicle-on-shaker" in settings.uff.read_bytes()[:500]
        if not (settings.destination.force and written_here):
            mend = (
                "was not written by this program, so --force does not replace it; choose another name"
                if settings.destination.force
                else "exists; give --force"
            )
            raise ConfigurationError(f"--uff {settings.uff}: {mend}")
    choice = settings.car.rolling(settings.speed)
    car = Car.load(choice.vehicle, choice.overrides)
    if settings.decoupling is not None:
        console.say(_decoupling(settings, settings.decoupling, car, as_json=console.json))
        return
    figures: Sequence[MotionFigure] = ()
    reason = ""
    try:
        figures = motion_figures(car, (settings.damper,))
    except SimulationError as error:
        reason = f"key figures of the suspension cannot be computed: {error}"
    table = modes_table(car, settings.damper, figures)
    table["notices"] += [reason] if reason else []
    table["notices"] += damper_notes(car) if settings.damper == "sliding" else []
    if settings.uff is not None:
        from vehicle.runs.output.folder import write_whole
        from vehicle.runs.output.mode_file import write_modes

        write_whole(settings.uff, lambda path: write_modes(path, car, settings.damper))
    if settings.animate is not None:
        table["film"] = _film(settings, settings.animate, car, console)
    console.result(table, report(table, figures, mass_and_cog(car)[0]))


def _decoupling(settings: ModesSettings, name: str, car: Any, *, as_json: bool) -> str:
    """Return the decoupling of a part as a table or as JSON."""
    from vehicle.engines.linear.decoupling import decoupling
    from vehicle.runs.car.decoupling_text import decoupling_json, decoupling_table

    crankshaft = finite_numbers(settings.crankshaft, ",")
    if len(crankshaft) != 3:
        raise ConfigurationError(f"--crankshaft {settings.crankshaft}: must be three numbers, for example 0,1,0")
    x, y, z = crankshaft
    engine_modes = decoupling(
        car.matrices, name, grounded=settings.grounded, stuck=settings.damper == "stuck", crankshaft=(x, y, z)
    )
    return decoupling_json(engine_modes) if as_json else decoupling_table(engine_modes, settings.aim)


def _check_film(settings: ModesSettings) -> None:
    """Check the film options before the computation, and choose the OpenGL library before MuJoCo is imported."""
    video = settings.film.video
    if settings.animate is None:
        if video is not None:
            raise ConfigurationError("--video: the mode is missing; give its frequency, for example --animate 28")
        return
    if video is None:
        raise ConfigurationError(
            f"--animate {settings.animate:g}: makes a video only with --video; add --video [FILE.mp4]"
        )
    from vehicle.drawing.rendering.backend import require_film

    if video:
        settings.destination.further_file(settings.film.path(""), "--video")
    require_film()


def _film(settings: ModesSettings, frequency: float, car: Any, console: Console) -> dict[str, Any]:
    """Write the film of a mode, and return its description and path."""
    from vehicle.drawing.rendering.mode_film import mode_film
    from vehicle.runs.car.main_mode import nearest
    from vehicle.runs.output.folder import write_whole

    mode = nearest(car.modes(settings.damper), frequency)
    path = settings.film.path(f"runs/mode_{mode.frequency:.2f}_hz.mp4")
    if not settings.film.video:
        path = settings.destination.file(path)
    write_whole(path, lambda file: mode_film(car.model, mode, file, progress=console.progress("video     ")))
    return {"file": str(path), "asked_hz": frequency, "frequency_hz": mode.frequency}


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


def report(table: dict[str, Any], figures: Sequence[MotionFigure], mass: float) -> str:
    """Return the modes of a car of a mass [kg] as the printed table: frequency, damping ratio, motion, energy share."""
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
    lines += [str(figures_table(figures, mass))] if figures else []
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


main = command(parser, ModesSettings, _job)
