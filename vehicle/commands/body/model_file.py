"""Files of body models: options, checks, reading and writing."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.destination import output_file_of
from vehicle.commands.options import FORCE_HELP
from vehicle.errors import ConfigurationError

if TYPE_CHECKING:
    from vehicle.model.flexbody.superelement import Superelement
    from vehicle.model.parameters.vehicle import Vehicle


def output_options(task: Any) -> None:
    """Add --output and --force, the file of the body model."""
    task.add_argument(
        "--output", type=Path, required=True, metavar="FILE", help="file to write the body model to, .toml or .npz"
    )
    task.add_argument("--force", action="store_true", help=FORCE_HELP)


def require_output(options: argparse.Namespace) -> None:
    """Check the output file before the computation.

    Raises:
        ConfigurationError: another ending, an input file, an existing file without --force or of the user.
        OutputError: its folder cannot be written.
    """
    if options.output.suffix not in (".toml", ".npz"):
        raise ConfigurationError(f"--output {options.output}: must end in .toml or .npz")
    inputs = (getattr(options, name, None) for name in ("file", "design", "vehicle"))
    output_file_of(options, options.output, protect=tuple(path for path in inputs if path is not None))


def write(options: argparse.Namespace, model: Superelement) -> None:
    """Write a body model to the file of --output."""
    from vehicle.model.flexbody.superelement_file import write_superelement
    from vehicle.runs.output.folder import write_whole

    write_whole(options.output, lambda file: write_superelement(file, model))


def model_of(file: Path | None, options: argparse.Namespace, vehicle: Vehicle) -> Superelement:
    """Read a body model from a file; by default return that of the vehicle."""
    from vehicle.model.flexbody.body_model import body_model
    from vehicle.model.flexbody.superelement_file import read_superelement

    if file is None:
        return body_model(vehicle, options.vehicle.parent if options.vehicle else None)
    return read_superelement(file)
