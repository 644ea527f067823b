"""Files of body models: options, checks, reading and writing."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.options import FORCE_HELP
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination
from vehicle.settings import finite_numbers

if TYPE_CHECKING:
    from vehicle.model.flexbody.superelement import Superelement
    from vehicle.model.parameters.hardpoints import Point
    from vehicle.model.parameters.vehicle import Vehicle


def output_options(task: Any) -> None:
    """Add --output and --force, the file of the body model."""
    task.add_argument(
        "--output", type=Path, required=True, metavar="FILE", help="file to write the body model to, .toml or .npz"
    )
    task.add_argument("--force", action="store_true", help=FORCE_HELP)


def require_output(destination: Destination, *inputs: Path | None) -> Path:
    """Check the output file before the computation, and return it.

    Args:
        inputs: input files, which are not replaced.

    Raises:
        ConfigurationError: another ending, an input file, an existing file without --force or of the user.
        OutputError: its folder cannot be written.
    """
    output = destination.output
    assert output is not None  # --output is required
    if output.suffix not in (".toml", ".npz"):
        raise ConfigurationError(f"--output {output}: must end in .toml or .npz")
    return destination.file(output, protect=tuple(path for path in inputs if path is not None))


def write(path: Path, model: Superelement) -> None:
    """Write a body model."""
    from vehicle.model.flexbody.superelement_file import write_superelement
    from vehicle.runs.output.folder import write_whole

    write_whole(path, lambda file: write_superelement(file, model))


def model_of(file: Path | None, car: CarChoice, vehicle: Vehicle) -> Superelement:
    """Read a body model from a file, by default from the vehicle."""
    from vehicle.model.flexbody.body_model import body_model
    from vehicle.model.flexbody.superelement_file import read_superelement

    return body_model(vehicle, car.folder) if file is None else read_superelement(file)


def origin_of(text: str) -> Point:
    """Return the three numbers of --origin [m].

    Raises:
        ConfigurationError: other than three finite numbers.
    """
    axes = finite_numbers(text, ",")
    if len(axes) != 3:
        raise ConfigurationError(f"--origin {text}: must be three numbers [m], for example 1.2,0,0.35")
    return axes[0], axes[1], axes[2]
