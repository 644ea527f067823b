"""`python -m vehicle body rigid`: mass, centre of gravity and inertia of a hung body from its FRFs."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from vehicle.commands.body.model_file import origin_of
from vehicle.commands.console import Console
from vehicle.commands.options import FORCE_HELP, message_options, setting_options
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, pair, part, setting


def add(tasks: Any) -> None:
    """Add the parser of the task with its options."""
    parser = tasks.add_parser(
        "rigid", help="compute mass, centre of gravity and inertia of a body or an engine from FRFs of a hung test"
    )
    setting_options(parser, RigidSettings)
    parser.add_argument("--output", type=Path, metavar="FILE", help="write the lines of a vehicle file there, .toml")
    group = parser.scoped_group("files", needs="--output FILE", active=lambda options: options.output is not None)
    group.add_argument("--force", action="store_true", help=FORCE_HELP)
    parser.add_argument("--json", action="store_true", help="print JSON")
    message_options(parser, quiet=True)


@dataclass(frozen=True, kw_only=True, slots=True)
class RigidSettings(Settings):
    """Measurement of a hung body; a file is written only to an `output`."""

    file: Path = setting(
        "FRFs of acceleration, velocity or displacement per force: a universal file (dataset 58) with nodes and "
        "directions, or a table with columns such as '4+Z/1-X real [(m/s2)/N]' and '4+Z/1-X imag [(m/s2)/N]'",
        flag="file",
        type=Path,
        metavar="FRF_FILE",
    )
    destination: Destination = part(Destination)
    part: str = setting(
        "part of the car, for the lines of a vehicle file; default: %(default)s", "body", choices=("body", "engine")
    )
    band: tuple[float, float] | None = setting(
        "range in which the body is rigid [Hz]; default: from twice the highest support mode to half of the first "
        "elastic resonance",
        type=pair("--band", "LOW:HIGH in Hz, for example 8:70", above=0.0),
        metavar="A:B",
    )
    points: Path | None = setting(
        "table point,x [m],y [m],z [m] with the positions that FRF_FILE does not contain", type=Path, metavar="FILE"
    )
    unit: str | None = setting("unit of FRFs without one in the file, for example '(m/s2)/N' or g/N")
    axes: str = setting(
        "axes of the test that point to the rear, to the driver's right and up; default: %(default)s",
        "x,y,z",
        metavar="X,Y,Z",
    )
    origin: str = setting(
        "position of the origin of the test in the car [m]; default: %(default)s", "0,0,0", metavar="X,Y,Z"
    )


def run(settings: RigidSettings, console: Console) -> None:
    """Fit the mass properties, print them, and with --output write them as lines of a vehicle file.

    Raises:
        ConfigurationError: an option is invalid.
        DataError: FRFs that determine no rigid body, see `fit_rigid_body`.
    """
    from vehicle.model.flexbody.sources.accelerances import read_accelerances
    from vehicle.model.flexbody.sources.rigid_fit import NAMES, fit_rigid_body
    from vehicle.model.flexbody.sources.rigid_text import UNITS, summary_lines, vehicle_text
    from vehicle.runs.output.folder import write_text

    inputs = tuple(path for path in (settings.file, settings.points) if path is not None)
    destination = settings.destination
    output = None
    if destination.output is not None:
        output = destination.file(destination.output, ending=".toml", protect=inputs)
    origin = origin_of(settings.origin)
    data = read_accelerances(settings.file, settings.points, settings.unit, settings.axes, origin)
    fit = fit_rigid_body(data, settings.band)
    text = vehicle_text(fit, settings.part, settings.file.name)
    if output is not None:
        write_text(output, text)
    rows = zip(NAMES, UNITS, fit.values().tolist(), fit.errors.tolist(), strict=True)
    content = {
        "properties": [
            {"name": name, "unit": unit, "value": value, "standard_error": error} for name, unit, value, error in rows
        ],
        "band_hz": [fit.chosen.low, fit.chosen.high],
        "support_modes_hz": fit.support.tolist(),
        "scatter": fit.scatter,
        "misfit": fit.misfit,
        "elastic_share": fit.elastic,
    }
    lines = summary_lines(fit, data, settings.file.name)
    console.result(content, "\n".join([*lines, f"file: {output}" if output is not None else f"\n{text.rstrip()}"]))


SETTINGS = RigidSettings
