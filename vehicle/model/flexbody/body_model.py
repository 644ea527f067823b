"""Elastic model of a vehicle body: computed from a design on the hardpoints, or imported as a superelement."""

import re
from dataclasses import replace
from filecmp import cmp
from functools import lru_cache
from pathlib import Path

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.body_design import BodyDesign, read_design
from vehicle.model.flexbody.body_frame import design_superelement, skeleton
from vehicle.model.flexbody.body_loads import body_loads, with_loads
from vehicle.model.flexbody.mass_difference import require_unit_of_mass
from vehicle.model.flexbody.rigid_body import rigid_body
from vehicle.model.flexbody.superelement import Superelement, attached_nodes
from vehicle.model.flexbody.superelement_file import read_superelement
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.vehicle import Vehicle

PACKAGE_FOLDER = FOCUS_FILE.parent
BODY_DESIGN = PACKAGE_FOLDER / "body_design.toml"
TRIMMED_BODY = PACKAGE_FOLDER / "trimmed_body.toml"
"""Shipped body design, and its superelement on the shipped car, written by `python -m vehicle body build --output`."""
_DESIGN = re.compile(r"""^format *= *["']body design""", re.MULTILINE)


def body_model(vehicle: Vehicle, folder: Path | None = None) -> Superelement:
    """Return the superelement of the free trimmed body of a vehicle; without modes if the body is rigid.

    A design is built on the hardpoints with the mass properties of the vehicle. A rigid body uses only the local
    stiffness of the attachments from its file; without a file, its nodes are the hardpoints.

    Args:
        vehicle: parameters; `body.superelement` names a body design or a modal superelement.
        folder: folder of the vehicle file, searched before the package.

    Raises:
        ConfigurationError: a required file is missing, or the design is invalid or does not fit the vehicle.
        DataError: the superelement is invalid, or its mass is in another unit.
    """
    body, points = vehicle.body, vehicle.points
    file = None if body.superelement is None else _find(body.superelement, folder)
    if file is None:
        if body.superelement is not None and (body.flexible or body.attachment_flexibility):
            package_files = ", ".join(sorted(path.name for path in PACKAGE_FOLDER.glob("*.toml")))
            raise ConfigurationError(
                f"body.superelement: the file {body.superelement!r} is neither in the same folder as the vehicle file "
                f"nor in the package (which has {package_files}). Name an existing file, or set body.flexible = "
                "false and body.attachment_flexibility = false for a rigid body"
            )
        return _bare(vehicle)
    status = file.stat()
    source = _read_once(file, status.st_mtime_ns, status.st_size)
    if isinstance(source, Superelement):
        require_unit_of_mass(source, body)
        return _as_in(vehicle, source) if body.flexible else source.without_modes()
    try:
        if not body.flexible:
            return skeleton(source, points)
        rigid_body(body)  # raises the clearer message for an invalid inertia
        attachments, loads = vehicle.composition.attachments(), body_loads(vehicle)
        built = design_superelement(source, points, attachments, body, loads)
        return _with_changed_modes(_up_to(built, vehicle), vehicle) if loads else _as_in(vehicle, built)
    except ConfigurationError as error:
        text = str(error)
        raise ConfigurationError(text if text.startswith("body.") else f"{file.name}: {text}") from None


def _as_in(vehicle: Vehicle, model: Superelement) -> Superelement:
    """Return a body model with the mass factor, load masses and changed mode parameters of the vehicle.

    Without loads, `modes_up_to` applies before the mass is scaled, and the number of modes is independent of the mass.
    With loads, `modes_up_to` applies to the modes with the loads, which are combinations of all modes of the body.
    """
    factor, loads = vehicle.body.model_factor, body_loads(vehicle)
    reduced = (
        _up_to(with_loads(model.scaled(factor), loads), vehicle) if loads else _up_to(model, vehicle).scaled(factor)
    )
    return _with_changed_modes(reduced, vehicle)


def _up_to(model: Superelement, vehicle: Vehicle) -> Superelement:
    """Return the body with its modes up to `body.modes_up_to`."""
    limit = vehicle.body.modes_up_to
    if limit is None:
        return model
    kept = model.up_to(limit, set(attached_nodes(model, vehicle.composition.attachments()).values()))
    if not kept.frequencies.size:
        raise ConfigurationError(
            f"body.modes_up_to: found {limit:g} Hz, below the first mode at {model.frequencies[0]:.4g} Hz. Choose a "
            "higher frequency, or body.flexible = false for a body without modes"
        )
    return kept


def _with_changed_modes(model: Superelement, vehicle: Vehicle) -> Superelement:
    """Apply the changes of frequency and damping in `body.modes` to single modes, without sorting the modes again."""
    mode_changes = {int(number): change for number, change in vehicle.body.modes.items()}
    if not mode_changes:
        return model
    count = len(model.frequencies)
    if max(mode_changes) > count:
        above = "" if vehicle.body.modes_up_to is None else f" up to body.modes_up_to = {vehicle.body.modes_up_to:g} Hz"
        raise ConfigurationError(
            f"body.modes.{max(mode_changes)}: {model.name} has modes 1 to {count}{above}; use one of these numbers"
        )
    frequencies, damping = model.frequencies.copy(), model.damping_ratio.copy()
    for number, change in mode_changes.items():
        frequencies[number - 1] *= change.frequency_factor
        if change.damping_ratio is not None:
            damping[number - 1] = change.damping_ratio
    return replace(model, frequencies=frequencies, damping_ratio=damping, derived=True)


def own_body_file(vehicle: Vehicle, folder: Path | None) -> Path | None:
    """Return the body file of a vehicle, or None if it belongs to the package; see `body_model` for the arguments."""
    file = None if vehicle.body.superelement is None else _find(vehicle.body.superelement, folder)
    return None if file is None or file.parent == PACKAGE_FOLDER else file


def equal_files(first: Path | None, other: Path | None) -> bool:
    """True if two paths are equal or their files have the same bytes; False if a file was moved."""
    try:
        return first == other or bool(first and other and cmp(first, other, shallow=False))
    except OSError:
        return False


def body_file(vehicle: Vehicle, folder: Path | None = None) -> Path:
    """Return the path of the body design or superelement named by a vehicle.

    Raises:
        ConfigurationError: the vehicle names no file, or the file does not exist.
    """
    file = None if vehicle.body.superelement is None else _find(vehicle.body.superelement, folder)
    if file is None:
        raise ConfigurationError(f"body.superelement: no file {vehicle.body.superelement}; name a body design")
    return file


def _find(name: str, folder: Path | None) -> Path | None:
    """Find a file by name in the folder and then the package, or by its path; None if the file does not exist."""
    if "/" in name:
        return Path(name) if Path(name).is_file() else None
    for directory in (folder, PACKAGE_FOLDER):
        if directory is None or not (directory / name).is_file():
            continue
        if (directory / name).resolve().parent != directory.resolve():
            raise ConfigurationError(
                f"body.superelement: {name} is a link to a file outside {directory}; put the file itself there"
            )
        return directory / name
    return None


# A sweep builds thousands of cars with one body; designs and superelements are immutable.
@lru_cache(maxsize=8)
def _read_once(file: Path, modified: int, size: int) -> BodyDesign | Superelement:
    """Read a body file, cached until its modification time or size changes."""
    is_design = file.suffix != ".npz" and _DESIGN.search(file.read_text(encoding="utf-8", errors="replace"))
    return read_design(file) if is_design else read_superelement(file)


def _bare(vehicle: Vehicle) -> Superelement:
    """Return a rigid body without a file: nodes at the attachments, mass (not used further) spread evenly."""
    points = vehicle.composition.attachments()
    return Superelement(
        name="rigid_body",
        nodes=tuple(points),
        positions=np.array(list(points.values())),
        edges=np.zeros((0, 2)),
        node_mass=np.full(len(points), vehicle.body.mass / len(points)),
        frequencies=np.zeros(0),
        damping_ratio=np.zeros(0),
        shapes=np.zeros((0, len(points), 3)),
        mode_names=(),
        provenance="Rigid body at the hardpoints of the vehicle, with rigid attachments.",
    )
