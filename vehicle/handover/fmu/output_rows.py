"""Outputs of an FMU as rows over the poles of the car: channels, displacements, sensors, and what must stay in limits.

Output = fixed + Re(rows xi) + direct terms of the plates, and of damper forces, slope forces and forces g of laws over
displacement at the same instant.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.engines.linear.load_rows import LoadRows, load_rows, stop_rows
from vehicle.engines.reduced.load_outputs import direct_applied, direct_forces, direct_laws, direct_slopes, load_outputs
from vehicle.engines.reduced.pole_model import Outputs, PoleModel
from vehicle.engines.reduced.validity import LARGEST_ANGLE, rotating_bodies, rotation_outputs, tyre_outputs
from vehicle.errors import ConfigurationError
from vehicle.names import channel_units, point_words

if TYPE_CHECKING:
    from vehicle.runs.car import Car


LINEAR, VELOCITY, FORCE, COEFFICIENT = range(4)
"""Kinds of outputs, as in runtime/car.h."""


TERMS = ("fixed", "force", "slope", "law", "applied")
"""Fields of `OutputRows` beside its outputs."""

LOAD_MEANING = {
    "m": "travel of the wheel centre against the body, upwards",
    "N": "force of the element on its moving part, in the axes of its carrier",
    "N m": "torque of the spring in the joint",
}
"""Descriptions of load channels by unit."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Output:
    """Output of an FMU."""

    name: str  # name, unit, meaning: name, unit and description
    unit: str
    meaning: str
    kind: int = LINEAR  # what it reads
    damper: int = 0  # index of its damper; 0 for a linear output


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class OutputRows:
    """Linear outputs with their direct terms."""

    outputs: Outputs  # rows over the poles and the plates
    fixed: Vector  # static values; (k,)
    # force, slope, law, applied: rows over damper forces, slope forces, forces of laws and applied forces at the same
    # instant; (k, d), (k, m), (k, laws), (k, applied forces)
    force: Vector
    slope: Vector
    law: Vector
    applied: Vector

    def part(self, indices: Sequence[int]) -> OutputRows:
        """Return the rows with these indices, in their order."""
        at = list(indices)
        outputs = Outputs(**{name: getattr(self.outputs, name)[at] for name in ("poles", "height", "velocity")})
        return OutputRows(outputs=outputs, **{name: getattr(self, name)[at] for name in TERMS})


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Watched:
    """Quantities of a car that must stay within limits."""

    rows: OutputRows  # their rows; (k, ...)
    limits: Vector  # lowest and highest value of each; (k, 2)
    notices: Sequence[str]  # what a value beyond its limits means

    def part(self, indices: Sequence[int]) -> Watched:
        """Return the quantities with these indices, in their order."""
        at = list(indices)
        return Watched(rows=self.rows.part(at), limits=self.limits[at], notices=[self.notices[k] for k in at])


def car_outputs(car: Car, channels: Sequence[str], model: PoleModel | None = None) -> tuple[list[Output], OutputRows]:
    """Return the outputs of a car: channels, displacements of the points, sensors of controlled dampers.

    Args:
        channels: names of channels; those that are inputs are left out.
        model: pole model of the car whose inputs are applied forces; without forces by default.
    """
    vehicle, model = car.vehicle, model or car.poles.without_forces()
    system, d = model.matrices.system, len(vehicle.composition.dampers)
    units, dampers = channel_units(channels), [damper.name for damper in vehicle.composition.dampers]
    outputs: list[Output] = []
    parts: list[OutputRows] = []

    def add(output: Output, rows: OutputRows) -> None:
        outputs.append(output)
        parts.append(rows)

    accelerations = [name for name in channels if name in system.outputs]
    displacements = model.outputs(accelerations)
    for name, rows in zip(accelerations, _each(_linear(model, displacements)), strict=True):
        point, _, axis = name.rpartition("_acc_")
        title = f"displacement of {point_words(point)} along {axis} from rest"
        add(Output(name=f"{point}_displacement_{axis}", unit="m", meaning=title), rows)
    for name, rows in zip(accelerations, _each(_second_derivative(model, displacements)), strict=True):
        point, _, axis = name.rpartition("_acc_")
        title = f"acceleration of {point_words(point)} along {axis}, not filtered"
        add(Output(name=name, unit="m/s2", meaning=title), rows)
    tyres = {f"tyre_{wheel}_force_z": wheel for wheel in system.inputs}
    for name in channels:
        if name in tyres:
            rows = _linear(model, model.outputs([name]), np.array([car.static.tyre_load[tyres[name]]]))
            add(
                Output(name=name, unit="N", meaning="vertical force of the tyre on the wheel"),
                replace(rows, law=_excess_of_tyres(model, [system.inputs.index(tyres[name])])),
            )
    stops = stop_rows(model.matrices, [damper.law for damper in vehicle.composition.dampers])
    for index, damper in enumerate(dampers):
        nothing = _linear(model, _no_outputs(model))
        for ending, reading, title in (
            ("velocity", VELOCITY, "velocity of the damper, extension positive"),
            ("force", FORCE, "force of the damper, with friction, gas, stop and force command"),
            ("coefficient", COEFFICIENT, "damping coefficient in the last step"),
        ):
            name = f"{damper}_{ending}"
            if name in channels:
                stop = stops.only([f"{damper}_stop_force"] if reading == FORCE else [])
                rows = _loads(model, stop) if stop.names else nothing
                add(Output(name=name, unit=units[name], meaning=title, kind=reading, damper=index), rows)
    loads = [name for name in channels if name in vehicle.load_channels]
    if loads:
        rows_of_loads = load_rows(car.model, model.matrices).only(loads)
        for name, row in zip(rows_of_loads.names, _each(_loads(model, rows_of_loads)), strict=True):
            add(Output(name=name, unit=units[name], meaning=LOAD_MEANING[units[name]]), row)
    rates = model.matrices.sensors @ (model.modal * model.poles) if model.matrices.sensors.size else model.slip[:0]
    no_plates = np.zeros((len(rates), len(system.inputs)))
    sensors = _each(_linear(model, Outputs(poles=rates, height=no_plates, velocity=no_plates)))
    controlled = [damper for damper in vehicle.composition.dampers if damper.law.controlled]
    names = [f"{damper.name}_{end}_velocity" for damper in controlled for end in ("wheel", "body")]
    for name, rows in zip(names, sensors, strict=True):
        add(Output(name=name, unit="m/s", meaning="sensor along the damper: absolute velocity of this end"), rows)
    if not outputs:
        raise ConfigurationError(
            "--channels: contains only plate displacements, which are inputs of an FMU; name other channels"
        )
    assert all(rows.force.shape[1] == d for rows in parts)
    return outputs, joined_rows(parts)


def _no_outputs(model: PoleModel) -> Outputs:
    """Return an output that is always zero."""
    wheels = len(model.matrices.system.inputs)
    zeros = np.zeros((1, wheels))
    return Outputs(poles=np.zeros((1, len(model.poles)), dtype=complex), height=zeros, velocity=zeros)


def _loads(model: PoleModel, loads: LoadRows) -> OutputRows:
    """Return loads with their direct terms."""
    return OutputRows(
        outputs=load_outputs(model, loads),
        fixed=loads.static,
        force=direct_forces(model, loads),
        slope=_of_plates(model, direct_slopes(model, loads)),
        law=direct_laws(model, loads),
        applied=direct_applied(model, loads),
    )


def _excess_of_tyres(model: PoleModel, plates: Sequence[int]) -> Vector:
    """Return the rows of tyre loads over the forces g of the laws, -1 for the own tyre; (plates, laws)."""
    tyres = np.array([law.plate for law in model.laws], dtype=int)
    return np.where(np.array(plates, dtype=int)[:, None] == tyres, -1.0, 0.0)


def _linear(model: PoleModel, outputs: Outputs, fixed: Vector | None = None) -> OutputRows:
    """Return linear outputs without further direct terms, except for static values."""
    count = len(outputs.poles)
    return OutputRows(
        outputs=outputs,
        fixed=np.zeros(count) if fixed is None else fixed,
        force=np.zeros((count, model.force.shape[1])),
        slope=np.zeros((count, len(model.matrices.system.inputs))),
        law=np.zeros((count, len(model.laws))),
        applied=np.zeros((count, model.applied.shape[1])),
    )


def _of_plates(model: PoleModel, rows: Vector) -> Vector:
    """Return rows over the plates of rolling tyres; zeros if the tyres stand."""
    return rows if model.slope.shape[1] else np.zeros((len(rows), len(model.matrices.system.inputs)))


def _second_derivative(model: PoleModel, displacements: Outputs) -> OutputRows:
    """Return the second derivatives of displacements Re(rows xi).

    xi' = s xi + b_z z + b_c z' + e f, with f = -g for a law over displacement.
    """
    rate = displacements.poles * model.poles
    outputs = Outputs(
        poles=rate * model.poles, height=(rate @ model.height).real, velocity=(rate @ model.velocity).real
    )
    slope = _of_plates(model, (rate @ model.slope).real)
    law = -(rate @ model.scalar_force[:, model.groups :]).real
    force = (rate @ model.force).real
    applied = (rate @ model.applied).real
    return OutputRows(outputs=outputs, fixed=np.zeros(len(rate)), force=force, slope=slope, law=law, applied=applied)


def _each(rows: OutputRows) -> list[OutputRows]:
    """Split output rows into single rows."""
    return [rows.part([k]) for k in range(len(rows.fixed))]


def joined_rows(parts: Sequence[OutputRows]) -> OutputRows:
    """Join several output rows."""

    def joined(items: Sequence[Any], name: str) -> npt.NDArray[Any]:
        return np.concatenate([getattr(item, name) for item in items])

    each = [part.outputs for part in parts]
    outputs = Outputs(**{name: joined(each, name) for name in ("poles", "height", "velocity")})
    return OutputRows(outputs=outputs, **{name: joined(parts, name) for name in TERMS})


def motion_rows(car: Car, rows: Vector) -> OutputRows:
    """Return outputs that are linear in the displacement of the car.

    Args:
        rows: rows over the displacements u of the velocity coordinates; (k, n).
    """
    model = car.poles.without_forces()
    no_plates = np.zeros((len(rows), len(model.matrices.system.inputs)))
    return _linear(model, Outputs(poles=rows @ model.modal, height=no_plates, velocity=no_plates))


def watched_outputs(car: Car, model: PoleModel | None = None, largest_angle: float = LARGEST_ANGLE) -> Watched:
    """Return the watched motions of a car, their limits, and a notice for each: linear tyres, then rotations.

    Args:
        model: see `car_outputs`.
        largest_angle: maximum rotation about each axis [rad].
    """
    model = model or car.poles.without_forces()
    matrices = model.matrices
    wheels, bodies = matrices.system.inputs, rotating_bodies(matrices)
    linear = [index for index, wheel in enumerate(wheels) if wheel not in matrices.one_sided]
    load = np.array([car.static.tyre_load[wheel] for wheel in wheels])
    tyres = replace(_linear(model, tyre_outputs(model), load), law=_excess_of_tyres(model, range(len(wheels))))
    parts = [tyres.part(linear), _linear(model, rotation_outputs(model, bodies))]
    limits = [(0.0, np.inf)] * len(linear) + [(-largest_angle, largest_angle)] * (3 * len(bodies))
    notices = [
        f"tyre {wheels[index]} would lift off; it is linear in this car (one_sided = false), so the result is not valid"
        for index in linear
    ]
    notices += [
        (
            f"{body} rotates by more than {number(np.degrees(largest_angle), 2)} deg about {axis}; the linear geometry "
            "is checked up to that angle"
        )
        for body in bodies
        for axis in "xyz"
    ]
    return Watched(rows=joined_rows(parts), limits=np.array(limits), notices=notices)
