"""`python -m vehicle diagnose RECORD --vehicle car.toml --speed 80`: which damper is worn, the road unknown."""

from dataclasses import dataclass
from pathlib import Path

from vehicle.commands.command_line import command
from vehicle.commands.console import Console, folded
from vehicle.commands.input_options import record_options
from vehicle.commands.measured_options import mapping_options
from vehicle.commands.options import (
    command_parser,
    figures_option,
    message_options,
    output_options,
    setting_options,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, finite_numbers, part, setting
from vehicle.signals.records.measured_settings import MeasuredSettings
from vehicle.signals.records.record_settings import RecordSettings

OUTPUT = Path("runs/diagnose")


@dataclass(frozen=True, kw_only=True, slots=True)
class DiagnoseSettings(Settings):
    """Settings of the command.

    Attributes:
        measured: channels of the record and their directions.
        record: units and times of the record.
        car: car that is not worn.
        destination: folder of the results; by default `OUTPUT`.
        figures: write the picture (PNG).
    """

    file: Path = setting(
        "record of a drive with accelerations, in any format that `inspect` reads", flag="file", type=Path,
        metavar="RECORD",
    )  # fmt: skip
    measured: MeasuredSettings = part(MeasuredSettings)
    record: RecordSettings = part(RecordSettings)
    car: CarChoice = part(CarChoice)
    destination: Destination = part(Destination)
    figures: bool = True
    speed: str = setting(
        "speed of the car [km/h], two speeds between which it lies (LOW:HIGH), channel:NAME of the record, or "
        "position:LATITUDE,LONGITUDE with two channels of a satellite receiver",
        "",
        metavar="KM/H|channel:NAME",
        required=True,
    )
    free: tuple[str, ...] = setting(
        "point with a device in any direction, for example seat_rail for a phone: x, y and z are axes of the device, "
        "and gravity in the record shows the vertical. May be repeated",
        (),
        action="append",
        metavar="POINT",
    )
    forward: str = setting(
        "axis of the devices of --free that points forward, for example y, or --forward=-z; by default from the "
        "changes of a recorded speed",
        "",
        metavar="AXIS",
    )
    parts: str = setting(
        "groups in the table: dampers, tyres, mounts, springs, friction; default: %(default)s",
        "dampers",
        metavar="NAME,...",
    )
    drives: int | None = setting(
        "number of simulated drives; default: 1200, and 1440 for a range of speeds. More narrow the intervals",
        type=int,
        within="[160, 20000]",
        metavar="N",
    )
    seed: int = setting(
        "seed of the simulated drives; default: %(default)s", 1, type=int, within="[0, inf)", metavar="N"
    )


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser(
        "diagnose", "Tell from a record of a drive which damper of a car is worn; the road need not be known."
    )
    setting_options(parser, DiagnoseSettings, "file", "speed", "free", "forward", "parts", "drives", "seed")
    mapping_options(parser)
    record_options(parser, "", channel=False, highpass=False)
    vehicle_options(parser)
    output_options(parser, OUTPUT)
    figures_option(parser)
    parser.add_argument("--json", action="store_true", help="print diagnosis.json instead of the text")
    message_options(parser, quiet=True)
    return parser


def speed_of(text: str) -> float | str | tuple[float, float]:
    """Return the speed of a text: a number, a range, or the text that names channels.

    Raises:
        ConfigurationError: another form.
    """
    if any(text.startswith(prefix) and text != prefix for prefix in ("channel:", "position:")):
        return text
    numbers = finite_numbers(text, ":")
    if len(numbers) == 1:
        return numbers[0]
    if len(numbers) == 2:
        return numbers[0], numbers[1]
    raise ConfigurationError(f"--speed {text}: must be a speed [km/h], LOW:HIGH, channel:NAME or "
                             "position:LATITUDE,LONGITUDE, for example 80")  # fmt: skip


def _job(settings: DiagnoseSettings, console: Console) -> None:
    from vehicle.runs.car import Car
    from vehicle.runs.output.folder import output_folder, write_files
    from vehicle.studies.diagnosis.diagnosis import diagnose_car
    from vehicle.studies.diagnosis.diagnosis_files import contents

    speed, choice = speed_of(settings.speed), settings.measured.choice(settings.record)
    car = Car.load(settings.car.vehicle, settings.car.overrides)
    folder = settings.destination.folder(OUTPUT, protect=(settings.file,))
    progress = console.progress("drives")
    try:
        diagnosis = diagnose_car(
            car,
            settings.file,
            speed,
            choice=choice,
            inverted=settings.measured.turned,
            free=settings.free,
            forward=settings.forward,
            parts=settings.parts.split(","),
            count=settings.drives,
            seed=settings.seed,
            progress=progress,
        )
    finally:
        progress.stop()
    console.accept(diagnosis.notices)
    files = contents(diagnosis, figures=settings.figures)
    with output_folder(folder, force=settings.destination.force, protect=(settings.file,)) as work:
        write_files(work, files)
    console.result(diagnosis.summary(), f"{diagnosis}\nfiles: {folder}: {', '.join(files)}")
    for notice in folded(diagnosis.notices):
        console.notice(notice)


main = command(parser, DiagnoseSettings, _job)
