"""The elastic model of a vehicle's body: computed from a design on its hardpoints, or imported as a superelement."""

from __future__ import annotations

import re
from dataclasses import replace
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
"""The shipped design, and its superelement on the shipped car for those who want it as it was fitted; it is written by
`python -m vehicle body build --output`."""
_DESIGN = re.compile(r"""^format *= *["']body design""", re.MULTILINE)


def body_model(vehicle: Vehicle, folder: Path | None = None) -> Superelement:
    """The superelement of a vehicle's free trimmed body; one without modes where it is rigid.

    Args:
        vehicle: parameters; `body.superelement` names a body design or a modal superelement.
        folder: folder of the vehicle file, searched before the package.

    Returns:
        The body. A design stands on the hardpoints and has the mass properties of the vehicle; of a rigid body
        only the local stiffness of attachments is taken, and without a file its nodes are the bare hardpoints.

    Raises:
        ConfigurationError: no such file and the vehicle needs one; a bad design, or one that does not fit the vehicle.
        DataError: the superelement is bad, or its mass is in another unit.
    """
    body, points = vehicle.body, vehicle.points
    file = None if body.superelement is None else _find(body.superelement, folder)
    if file is None:
        if body.superelement is not None and (body.flexible or body.attachment_flexibility):
            known = ", ".join(sorted(found.name for found in PACKAGE_FOLDER.glob("*.toml")))
            raise ConfigurationError(
                f"body.superelement: no file {body.superelement!r} beside the vehicle file nor in the package, which "
                f"has {known}; a rigid body (body.flexible = false, body.attachment_flexibility = false) needs none"
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
        rigid_body(body)  # says better what is wrong with an inertia
        attachments, loads = vehicle.composition.attachments(), body_loads(vehicle)
        built = design_superelement(source, points, attachments, body, loads)
        return _with_changed_modes(_up_to(built, vehicle), vehicle) if loads else _as_in(vehicle, built)
    except ConfigurationError as error:
        text = str(error)
        raise ConfigurationError(text if text.startswith("body.") else f"{file.name}: {text}") from None


def _as_in(vehicle: Vehicle, model: Superelement) -> Superelement:
    """Return a body with the mass, the loads and the modes that the vehicle gives it.

    `modes_up_to` is a frequency before the mass is scaled, so that the mass does not change the number of modes; of a
    body with loads it is one with the loads, which are in the space of all its modes.
    """
    factor, loads = vehicle.body.model_factor, body_loads(vehicle)
    kept = _up_to(with_loads(model.scaled(factor), loads), vehicle) if loads else _up_to(model, vehicle).scaled(factor)
    return _with_changed_modes(kept, vehicle)


def _up_to(model: Superelement, vehicle: Vehicle) -> Superelement:
    """The body with the modes that the vehicle keeps."""
    limit = vehicle.body.modes_up_to
    if limit is None:
        return model
    kept = model.up_to(limit, set(attached_nodes(model, vehicle.composition.attachments()).values()))
    if not kept.frequencies.size:
        raise ConfigurationError(
            f"body.modes_up_to: found {limit:g} Hz, below the first mode at {model.frequencies[0]:.4g} Hz; a body "
            "without modes is body.flexible = false"
        )
    return kept


def _with_changed_modes(model: Superelement, vehicle: Vehicle) -> Superelement:
    """The body with what the vehicle changes of single modes; they keep their numbers, whatever their order becomes."""
    changes = {int(number): change for number, change in vehicle.body.modes.items()}
    if not changes:
        return model
    count = len(model.frequencies)
    if max(changes) > count:
        above = "" if vehicle.body.modes_up_to is None else f" up to body.modes_up_to = {vehicle.body.modes_up_to:g} Hz"
        raise ConfigurationError(
            f"body.modes.{max(changes)}: {model.name} has modes 1 to {count}{above}; give the number of one"
        )
    frequencies, damping = model.frequencies.copy(), model.damping_ratio.copy()
    for number, change in changes.items():
        frequencies[number - 1] *= change.frequency_factor
        if change.damping_ratio is not None:
            damping[number - 1] = change.damping_ratio
    return replace(model, frequencies=frequencies, damping_ratio=damping, derived=True)


def own_body_file(vehicle: Vehicle, folder: Path | None) -> Path | None:
    """The file of the body where it is none of the package; arguments as of `body_model`."""
    found = None if vehicle.body.superelement is None else _find(vehicle.body.superelement, folder)
    return None if found is None or found.parent == PACKAGE_FOLDER else found


def body_file(vehicle: Vehicle, folder: Path | None = None) -> Path:
    """The body design or superelement that a vehicle names.

    Raises:
        ConfigurationError: it names none, or there is no such file.
    """
    file = None if vehicle.body.superelement is None else _find(vehicle.body.superelement, folder)
    if file is None:
        raise ConfigurationError(f"body.superelement: {vehicle.body.superelement}, no such file; name a body design")
    return file


def _find(name: str, folder: Path | None) -> Path | None:
    """A file by its name, or by the whole path that the user gives as an override; None where there is none."""
    if "/" in name:
        return Path(name) if Path(name).is_file() else None
    for place in (folder, PACKAGE_FOLDER):
        if place is None or not (place / name).is_file():
            continue
        if (place / name).resolve().parent != place.resolve():
            raise ConfigurationError(
                f"body.superelement: {name} is a link that leads out of {place}; put the file itself there"
            )
        return place / name
    return None


# A sweep builds thousands of cars on one body; neither kind can be changed once it is read.
@lru_cache(maxsize=8)
def _read_once(file: Path, modified: int, size: int) -> BodyDesign | Superelement:
    """Read a file again only where it has changed."""
    is_design = file.suffix != ".npz" and _DESIGN.search(file.read_text(encoding="utf-8", errors="replace"))
    return read_design(file) if is_design else read_superelement(file)


def _bare(vehicle: Vehicle) -> Superelement:
    """A rigid body without a file: its nodes are hardpoints, and its mass, which nothing asks for, is spread evenly."""
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
        provenance="Rigid body on the hardpoints of the vehicle, attachments rigid.",
    )
