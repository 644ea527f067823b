"""A car as the file of its FMU: the record Embedded of the core, with the tables that the reduced engine marches.

Layout: `vehicle/core/source/layout.h`; runtime/car_data.c reads it. The tables belong to a car at rest at
a fixed time step; rows over the states at rest and over laws let the runtime start over plates at any height.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.core.records import dtype, stored
from vehicle.engines.reduced.car_table import CarTable, damper_nodes
from vehicle.engines.reduced.feedback import Feedback, sensor_outputs
from vehicle.engines.reduced.group_run import march_fields, packed_cars
from vehicle.engines.reduced.pole_model import PoleModel, pole_model
from vehicle.engines.reduced.step_factors import CarFactors, car_factors
from vehicle.engines.reduced.table_layout import DOUBLE, TILE, aligned_table
from vehicle.errors import ConfigurationError
from vehicle.handover.fmu.output_rows import Output, OutputRows, Watched, car_outputs, joined_rows, watched_outputs
from vehicle.model.parameters.force_elements import Damper
from vehicle.model.parameters.semi_active_damper import FMU

if TYPE_CHECKING:
    from vehicle.runs.car import Car


MAGIC, TOKEN, NAME, NOTICE = b"VEHFMU05", 40, 64, 160
"""First bytes of the file; sizes of texts. The first two as in runtime/car.h and car_data.c."""

HEADER = len(MAGIC) + TOKEN + 16
"""Bytes before the record: `MAGIC`, token, length, sum."""


class FrictionNumber(NamedTuple):
    """Tunable number of the friction of a damper."""

    unit: str  # unit; empty for a number
    field: str  # its field in the record of the law
    meaning: str  # description in the FMU
    words: str  # words of its slider on a page
    usual: float  # usual end of the slider, which is larger for a car with larger values


FRICTION = {
    "coulomb_friction": FrictionNumber("N", "friction_limit", "Coulomb friction Fd", "Coulomb friction", 300.0),
    "static_friction": FrictionNumber(
        "N", "static_limit", "static friction Fs of the Stribeck law (at least Fd)",
        "static friction (Stribeck)", 400.0,
    ),
    "stribeck_velocity": FrictionNumber(
        "m/s", "stribeck_velocity", "velocity vs of the transition from static to sliding friction (Stribeck law)",
        "Stribeck velocity", 0.2,
    ),
    "stribeck_exponent": FrictionNumber(
        "", "stribeck_exponent", "exponent of the transition from static to sliding friction (Stribeck law)",
        "Stribeck exponent", 4.0,
    ),
}  # fmt: skip
"""Tunable numbers of the friction of a damper; all but the first belong to the Stribeck law."""

PARAMETERS = {name: number.unit for name, number in FRICTION.items()} | {"curve_scale": "", "control": ""}
"""Tunable parameters of a damper, with units, in the order of runtime/car.h."""

COMMANDS = {"force": "N", "coefficient": "N s/m"}
"""Commands of a damper, with units."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarNumbers:
    """Numbers of a car for the runtime."""

    content: bytes  # content of resources/car.bin
    token: str  # text that ties model description and resources together
    step: float  # internal time step [s]
    rolling: bool  # True for rolling tyres
    plates: tuple[str, ...]  # plates, dampers: names of the wheels with plates and of the dampers
    dampers: tuple[str, ...]
    forces: tuple[tuple[str, str], ...]  # name and unit of the applied forces, which are inputs
    outputs: tuple[Output, ...]  # the outputs
    parameters: Vector  # first values of the parameters; (dampers, `PARAMETERS`)
    extents: dict[str, tuple[int, int]]  # offset in the file and size of each array by its path in the record [byte]
    table: CarTable  # the table of the car, whose sections begin at `table.rows`


def car_numbers(car: Car, channels: Sequence[str], step: float) -> CarNumbers:
    """Return the numbers of a car with all its outputs of channels, sensors and notices, and with its forces as inputs.

    Args:
        channels: names of the recorded channels among the outputs; plate displacements, which are inputs, are left
            out.
        step: internal time step [s].

    Raises:
        ConfigurationError: see `numbers_with`.
    """
    forces = input_forces(car)
    model = pole_model(car.matrices.with_unit_forces([*forces.values()])) if forces else car.poles.without_forces()
    return numbers_with(car, step, car_outputs(car, channels, model), watched_outputs(car, model), (model, forces))


def input_forces(car: Car) -> dict[str, int]:
    """Return the forces of tables [force.NAME] that are enabled: indices among the forces of the car by channel."""
    forces = enumerate(car.vehicle.composition.forces)
    return {force.channel: index for index, force in forces if force.path.startswith("force.") and force.law.enabled}


def numbers_with(
    car: Car,
    step: float,
    read: tuple[Sequence[Output], OutputRows],
    watched: Watched,
    pushed: tuple[PoleModel, Mapping[str, int]] | None = None,
) -> CarNumbers:
    """Return the numbers of a car with given outputs.

    Args:
        step: internal time step [s].
        read: the outputs and their rows.
        watched: quantities that must stay within limits.
        pushed: pole model whose inputs are applied forces, and these forces, see `input_forces`; none by default.
    """
    composition = car.vehicle.composition.dampers
    laws = [damper.law for damper in composition]
    if not laws:
        raise ConfigurationError(
            f"{car.vehicle.name}: has no damper; an FMU and the sliders of a report need "
            "a car with dampers at its wheels"
        )
    for damper in composition:
        user_laws = {"function": "viscous law, for example as points of a table", "friction_function": "friction law"}
        for name, other in user_laws.items():
            if (found := getattr(damper.law, name)) is not None:
                raise ConfigurationError(
                    f"{damper.name}.{name}: found the Python function {found!r}, which an FMU or a page cannot "
                    f"contain; set the {other}"
                )
        if damper.law.controlled is not None and damper.law.controlled.law == FMU:
            raise ConfigurationError(
                f"{damper.name}.control.law: found {FMU!r}; an FMU of a car cannot contain another FMU; set law "
                f"= skyhook, and in the other simulator set {damper.name}_control = 0 and connect the controller "
                f"to {damper.name}_coefficient_command"
            )
    model, forces = pushed or (car.poles.without_forces(), {})
    wheels = model.matrices.system.inputs
    columns, rolling = list(range(len(wheels))), model.slope.shape[1] > 0
    loads, m = car.static.tyre_load if rolling else None, len(wheels) + len(forces)
    (factors,) = car_factors([model], step, columns, exact=True, present_load=rolling)
    cars, feedback = packed_cars([model], [factors], [laws], [loads], np.zeros((2, m)), step, DOUBLE, whole=True)
    sensors, outputs, parameters = sensor_outputs(model, laws, columns, loads), read[0], _parameters(laws)
    rows, tables = joined_rows([read[1], watched.rows]), [law for law in model.laws if not law.friction]
    groups, names = model.groups, [*wheels, *(damper.name for damper in composition)]
    beside = ((0, 0), (0, len(forces)))  # a force has no direct part in velocities, nor one of slopes
    record = {
        "march": _march(cars, feedback),
        "step": step,
        "dampers": np.array([damper_nodes(law)[0] for law in laws], dtype=dtype("DamperLaw")),
        "inner": np.array([_inner_nodes(law) for law in laws], dtype=np.int64),
        "parameters": parameters,
        "start": _joined([cars.at_rest(np.stack([np.zeros(m), rate])) for rate in np.eye(m)]),
        "sensor_start": np.hstack([np.pad(sensors.velocity, beside), factors.weights_of(sensors)[:, -m:]]),
        "law_start": np.hstack([np.pad(model.law_outputs.velocity, beside), factors.levels[groups:]])[: len(tables)],
        "law_corners": _padded([np.stack([law.breakpoints, law.changes], axis=1) for law in tables]),
        "rows": _rows(cars, factors, rows),
        "by_force": rows.force,
        "by_slope": np.pad(rows.slope, beside),
        "by_law": rows.law,
        "fixed": rows.fixed,
        "kinds": np.array([(output.kind, output.damper) for output in outputs], dtype=np.int64).reshape(-1, 2),
        "limits": watched.limits,
        "names": _texts(names, NAME),
        "notices": _texts(watched.notices, NOTICE),
        "forces": _texts([*forces], NAME),
    }
    body, extents = stored("Embedded", record, HEADER)
    body += b"\0" * (-len(body) % 8)
    described = "\n".join([body.hex(), *(f"{output.name} {output.unit}" for output in outputs)])
    token = "{" + hashlib.sha256(described.encode()).hexdigest()[:32] + "}"
    length = (HEADER + len(body)).to_bytes(8, "little")
    return CarNumbers(
        content=MAGIC + token.encode().ljust(TOKEN, b"\0") + length + _sum(body).to_bytes(8, "little") + body,
        token=token,
        step=step,
        rolling=rolling,
        plates=tuple(wheels),
        dampers=tuple(damper.name for damper in composition),
        forces=tuple((name, car.vehicle.composition.forces[index].unit) for name, index in forces.items()),
        outputs=tuple(outputs),
        parameters=parameters,
        extents=extents,
        table=cars,
    )


def _march(cars: CarTable, feedback: Feedback) -> dict[str, Any]:
    """Return the record March without outputs, which the runtime reads itself, and memory of a run, which it adds."""
    nothing, blank, none = aligned_table(0, DOUBLE), np.zeros((0, 0)), np.zeros(0, dtype=np.int64)
    fields: dict[str, Any] = dict.fromkeys(("x", "changes", "y", "peaks", "positions", "levels", "rotations"), nothing)
    fields |= dict.fromkeys(("rates", "plate_z", "offset", "weights"), blank)
    fields |= {"tyre_of": np.full(cars.rows["curves"], -1, dtype=np.int64), "wanted": none, "cars": none}
    fields |= {"every": 1, "step": 0, "first": 1, "loads": 0, "watched": 0, "check_every": 1, "always": False}
    return march_fields(cars, feedback, fields | {"out": np.zeros((0, 0, 0))})


def _joined(tables: Sequence[npt.NDArray[Any]]) -> npt.NDArray[Any]:
    """Return aligned tables one after the other, with zeros without sign, which are shorter in a page."""
    table = aligned_table(sum(len(part) for part in tables), DOUBLE)
    return np.asarray(np.add(np.concatenate(tables), 0.0, out=table))


def _rows(cars: CarTable, factors: CarFactors, rows: OutputRows) -> npt.NDArray[Any]:
    """Return the weights of outputs over states, plates and applied forces, output by output."""
    weights, forces = factors.weights_of(rows.outputs), rows.applied.shape[1]
    rates, _ = np.hsplit(weights[:, -2 * (len(factors.columns) + forces) :], 2)
    rates[:, len(factors.columns) :] += rows.applied
    tiles = cars.tiles([weights]).reshape(-1, cars.states, TILE, 4)
    return _joined([*tiles.transpose(0, 2, 1, 3).reshape(-1, cars.states, 4)[: len(rows.fixed)]])


def _padded(tables: Sequence[Vector]) -> npt.NDArray[Any]:
    """Return tables (rows, 2) filled up with zeros to equal lengths; (tables, rows, 2)."""
    result = np.zeros((len(tables), max((len(table) for table in tables), default=0), 2))
    for row, table in zip(result, tables, strict=True):
        row[: len(table)] = table
    return result


def _texts(texts: Sequence[str], size: int) -> npt.NDArray[np.uint8]:
    """Return texts in fields of a given size [byte], cut and ended with zeros; (texts, size)."""
    content = b"".join(text.encode()[: size - 1].ljust(size, b"\0") for text in texts)
    return np.frombuffer(content, dtype=np.uint8).reshape(-1, size)


def _sum(content: bytes) -> int:
    """Return the sum of `sum_of` in runtime/car_data.c."""
    total = 0xCBF29CE484222325
    for word in np.frombuffer(content, dtype="<u8").tolist():
        total = (total ^ word) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
    return total


def _inner_nodes(law: Damper) -> tuple[int, int]:
    """Return first and last node of a damper law without its flat ends."""
    nodes, whole = damper_nodes(law)[2][:, 0].tolist(), damper_nodes(law, whole=True)[2][:, 0].tolist()
    return whole.index(nodes[0]), whole.index(nodes[-1])


def friction_numbers(law: Damper) -> list[str]:
    """Return the names in `FRICTION` of the friction law of a damper."""
    return list(FRICTION)[: len(FRICTION) if law.friction_law == "stribeck" else 1]


def _parameters(laws: Sequence[Damper]) -> Vector:
    """Return the first values of `PARAMETERS`; (dampers, 6)."""
    records: list[Any] = [damper_nodes(law)[0] for law in laws]
    return np.array(
        [
            [*(float(record[number.field]) for number in FRICTION.values()), 1.0, 1.0 if law.controlled else 0.0]
            for record, law in zip(records, laws, strict=True)
        ]
    )
