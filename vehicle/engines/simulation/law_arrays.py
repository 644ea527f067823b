"""Conversion of law parameters, named as in `vehicle.model.assembly.element_numbers`, to records of the elements."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.engines.simulation.element_records import AirSprings, Index, Layout, Tables
from vehicle.engines.simulation.force_curves import tables_through
from vehicle.model.assembly.element_numbers import AVERAGED, DECOUPLER, FLUID, TURNING
from vehicle.model.laws.control_laws import NUMBERS, in_steps
from vehicle.model.laws.damper import unpack
from vehicle.model.laws.friction_by_address import friction_by_address
from vehicle.model.laws.law_by_address import RECORD, law_by_address
from vehicle.names import AXES

Numbers = Mapping[str, Vector]


class LawNames(NamedTuple):
    """Names of the elements of a model in the order of the records; bushings as "type/name".

    `presliding` has the damper of each Jenkins element, element by element.
    """

    bushings: tuple[str, ...]
    springs: tuple[str, ...]
    dampers: tuple[str, ...]
    valves: tuple[str, ...]
    presliding: tuple[str, ...]


def law_names(model: mujoco.MjModel) -> LawNames:
    """Return the names of the elements of a compiled car."""
    kinds, user = mujoco.mjtEq, mujoco.mjtBias.mjBIAS_USER
    named = [(str(model.equality(index).name), model.eq_type[index]) for index in range(model.neq)]
    fields = {str(model.numeric(index).name): int(model.numeric_size[index]) for index in range(model.nnumeric)}
    dampers = tuple(str(model.actuator(i).name) for i in range(model.nu) if model.actuator_biastype[i] == user)
    return LawNames(
        bushings=tuple(
            name for name, equality_type in named if equality_type == kinds.mjEQ_CONNECT and f"law/{name}" in fields
        ),
        springs=tuple(name for name, equality_type in named if equality_type == kinds.mjEQ_TENDON),
        dampers=dampers,
        valves=tuple(str(model.tendon(i).name) for i in friction_tendons(model, presliding=False)),
        presliding=tuple(name for name in dampers for _ in range(fields.get(f"presliding/{name}", 0) // 2)),
    )


def friction_tendons(model: mujoco.MjModel, *, presliding: bool) -> list[int]:
    """Return the ids of the tendons with friction: of Jenkins elements, or of the segments of damper curves."""
    tendons = [int(index) for index in np.flatnonzero(model.tendon_frictionloss > 0.0)]
    return [index for index in tendons if str(model.tendon(index).name).startswith("presliding/") == presliding]


def model_numbers(model: mujoco.MjModel) -> dict[str, Vector]:
    """Return the custom fields of a compiled car and the parameters of its actuators, by name."""
    numbers = {str(model.numeric(index).name): np.array(model.numeric(index).data) for index in range(model.nnumeric)}
    for index in range(model.nu):
        # The parameters of an actuator are ten; a longer record is in a custom field.
        numbers.setdefault(f"actuator/{model.actuator(index).name}", np.array(model.actuator_biasprm[index]))
    return numbers


def laws_of(names: LawNames, numbers: Numbers) -> Vector:
    """Return the numbers of the elements with a law along three axes, padded with zeros; (n, longest law)."""
    laws = [numbers[f"law/{name}"] for name in names.bushings]
    padded = np.zeros((len(laws), max((AVERAGED + 1, *(len(law) for law in laws)))))
    for row, law in zip(padded, laws, strict=True):
        row[: len(law)] = law
    return padded


def with_numbers(layout: Layout, names: LawNames, numbers: Numbers, timestep: float) -> Layout:
    """Return a layout with other law parameters, for the same elements in the same rows; see `law_fields`."""
    records = law_fields(names, numbers, timestep)
    return layout._replace(**{name: getattr(layout, name)._replace(**fields) for name, fields in records.items()})


def law_fields(names: LawNames, numbers: Numbers, timestep: float) -> dict[str, dict[str, Any]]:
    """Return the fields of the records of a layout that follow from laws, with curves at zero displacement, by record.

    Args:
        names: names of the elements.
        numbers: parameters of all laws, by the names of their fields.
        timestep: time step of controlled dampers [s].

    Raises:
        ConfigurationError: a law by address is not registered in this process.
    """

    def fields(group: str, elements: Sequence[str], width: int) -> Vector:
        """Return the fields of a group of those of the elements that have one; (n, width)."""
        present = [numbers[f"{group}/{name}"] for name in elements if f"{group}/{name}" in numbers]
        return np.concatenate([np.zeros(0), *present]).reshape(-1, width)

    laws = laws_of(names, numbers)
    stiffness, rubber, branched = laws[:, 0:3].copy(), _rubber(names, numbers), laws[:, 6:9] > 0.0
    # The tangent at rest: K and all k_i of the axis; `add.at` adds to one entry several times.
    np.add.at(stiffness, (rubber["elements"], rubber["axes"]), rubber["stiffness"])
    rolling = fields("rolling", names.bushings, 5)
    user_laws = [(index, law_by_address(law)) for index, law in _words(names, numbers, "function")]
    presliding = fields("presliding", tuple(dict.fromkeys(names.presliding)), 2)
    shares = [numbers[f"inertia/{name}"][1] for name in fluid_coordinates(names, numbers)]
    return {
        "bushings": {
            "stiffness": stiffness,
            "damping": laws[:, 3:6].copy(),
            "branch_stiffness": laws[:, 6:9].copy(),
            # tau = D_2/K_2.
            "branch_time": np.divide(laws[:, 9:12], laws[:, 6:9], out=np.zeros((len(laws), 3)), where=branched),
            "further": laws[:, AVERAGED + 1 :].copy(),
            "averaged": whole_numbers(laws[:, AVERAGED] > 0.0),
            "one_sided": _true_indices(f"one_sided/{name}" in numbers for name in names.bushings),
            "oblique": _true_indices(f"directions/{name}" in numbers for name in names.bushings),
            "directions": fields("directions", names.bushings, 9),
        },
        "rubber": rubber,
        "rotations": {"stiffness": laws[laws[:, TURNING] > 0.0, TURNING].copy()},
        "springs": {"stiffness": np.array([float(numbers[f"law/{name}"][0]) for name in names.springs])},
        "dampers": {
            "laws": _damper_records(names, numbers),
            "pieces": np.reshape([numbers[f"law/{name}"] for name in names.valves], (-1, 3)).astype(float),
        },
        "presliding": {"stiffness": presliding[:, 0].copy(), "share": presliding[:, 1].copy()},
        "controls": {
            "dampers": _true_indices(f"control/{name}" in numbers for name in names.dampers),
            "laws": in_steps(fields("control", names.dampers, NUMBERS), timestep),
        },
        "own": {
            "dampers": whole_numbers([index for index, _ in user_laws]),
            "laws": np.array([law.record(timestep) for _, law in user_laws], dtype=RECORD),
        },
        "tables": _tables(names, numbers)._asdict(),
        "rolling": {
            "speeds": rolling[:, 0].copy(),
            "trails": rolling[:, 1].copy(),
            "arms": rolling[:, 2:].copy(),
            "hold": np.array(numbers.get("hold/body", np.zeros(0))),
        },
        "round": {"radii": fields("round", names.bushings, 1)[:, 0].copy()},
        # The fluid shortens the chamber by its own motion, and lengthens the rubber by its share of local stiffness.
        "fluids": {"factors": np.array([factor for share in shares for factor in (-1.0, float(share))])},
    }


def air_springs(names: LawNames, numbers: Numbers) -> AirSprings:
    """Return the air springs of a car; arguments: see `law_fields`."""
    elements = _true_indices(f"air/{name}" in numbers for name in names.bushings)
    air = [names.bushings[index] for index in elements]
    return AirSprings(
        elements=elements,
        bellows=np.array([numbers[f"law/{name}"][2] for name in air]),
        numbers=np.reshape([numbers[f"air/{name}"] for name in air], (-1, 3)).astype(float),
    )


def _words(names: LawNames, numbers: Numbers, kind: str) -> list[tuple[int, str]]:
    """Return the dampers with a word of a kind, which is a part of the name of a field, and these words."""
    starts = [(index, f"{kind}/{name}/") for index, name in enumerate(names.dampers)]
    return [
        (index, field.removeprefix(start)) for index, start in starts for field in numbers if field.startswith(start)
    ]


def _damper_records(names: LawNames, numbers: Numbers) -> npt.NDArray[Any]:
    """Return the records of the dampers, with the addresses of friction laws of the user's own."""
    records = unpack([numbers[f"actuator/{name}"] for name in names.dampers])
    for index, law in _words(names, numbers, "limit"):
        records["friction_law"][index] = friction_by_address(law).call.address
    return records


def _rubber(names: LawNames, numbers: Numbers) -> dict[str, Any]:
    """Return the Jenkins elements of all bushings with rubber friction."""
    indices, elements_of_axes = list[tuple[int, int]](), [np.zeros((0, 2))]
    for index, name in enumerate(names.bushings):
        for column, axis in enumerate(AXES):
            field = numbers.get(f"friction/{name}/{axis}")
            if field is not None:
                elements_of_axes.append(field.reshape(-1, 2))
                indices += [(index, column)] * len(elements_of_axes[-1])
    elements, axes = (np.ascontiguousarray(column) for column in whole_numbers(indices, 2).T)
    stiffness, limit = (column.copy() for column in np.concatenate(elements_of_axes).T)
    return {"elements": elements, "axes": axes, "stiffness": stiffness, "limit": limit}


def fluid_coordinates(names: LawNames, numbers: Numbers) -> list[str]:
    """Return the names of the coordinates of the fluids of hydromounts: fluid in the track, and decoupler."""
    fluids = [name for name in names.bushings if name.startswith(FLUID)]
    pairs = [name for fluid in fluids for name in (fluid, fluid.replace(FLUID, DECOUPLER, 1))]
    return [name for name in pairs if f"inertia/{name}" in numbers]


def _tables(names: LawNames, numbers: Numbers) -> Tables:
    """Return the nonlinear laws, with operating points at zero displacement."""
    fields = [(f"{name}/{axis}", (0, index, column)) for index, name in enumerate(names.bushings)
              for column, axis in enumerate(AXES)]  # fmt: skip
    fields += [(name, (1, index, 0)) for index, name in enumerate(names.springs)]
    fields += [(name, (2, index, 0)) for index, name in enumerate(names.dampers)]
    fields += [(name, (3, 2 * index, 0)) for index, name in enumerate(fluid_coordinates(names, numbers))]
    read = [(numbers.get(f"table/{name}"), where) for name, where in fields]
    return tables_through([(points.reshape(2, -1), where) for points, where in read if points is not None])


def whole_numbers(values: Any, columns: int = 0) -> Index:
    """Convert values to 64-bit integers, (n,) or (n, columns)."""
    array = np.array(values, dtype=np.int64, order="C")
    return array.reshape(-1, columns) if columns else array.reshape(-1)


def _true_indices(present: Iterable[bool]) -> Index:
    """Return the indices of the true values."""
    return np.flatnonzero(list(present)).astype(np.int64)
