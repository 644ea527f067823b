"""Numbers of laws by the names of `vehicle.model.assembly.law_numbers` -> the records of the rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import mujoco
import numpy as np

from vehicle.engines.simulation.element_records import Layout, Tables, Vector
from vehicle.engines.simulation.force_curves import tables_through
from vehicle.model.assembly.law_numbers import AVERAGED, TURNING
from vehicle.model.laws.damper import unpack
from vehicle.model.laws.semi_active import in_steps
from vehicle.names import AXES

Numbers = Mapping[str, Vector]


class LawNames(NamedTuple):
    """Names of the elements of a model, in the order of the records: `bushings` with their kind before a stroke."""

    bushings: tuple[str, ...]
    springs: tuple[str, ...]
    dampers: tuple[str, ...]
    valves: tuple[str, ...]


def law_names(model: mujoco.MjModel) -> LawNames:
    """Names of the elements of a compiled car."""
    kinds, user = mujoco.mjtEq, mujoco.mjtBias.mjBIAS_USER
    named = [(str(model.equality(index).name), model.eq_type[index]) for index in range(model.neq)]
    fields = {str(model.numeric(index).name) for index in range(model.nnumeric)}
    return LawNames(
        bushings=tuple(name for name, kind in named if kind == kinds.mjEQ_CONNECT and f"law/{name}" in fields),
        springs=tuple(name for name, kind in named if kind == kinds.mjEQ_TENDON),
        dampers=tuple(str(model.actuator(i).name) for i in range(model.nu) if model.actuator_biastype[i] == user),
        valves=tuple(str(model.tendon(int(i)).name) for i in np.flatnonzero(model.tendon_frictionloss > 0.0)),
    )


def model_numbers(model: mujoco.MjModel) -> dict[str, Vector]:
    """Numbers of the laws of a compiled car, and its other custom fields."""
    found = {}
    for index in range(model.nnumeric):
        start = model.numeric_adr[index]
        found[str(model.numeric(index).name)] = np.array(model.numeric_data[start : start + model.numeric_size[index]])
    for index in range(model.nu):
        # The parameters of an actuator are ten; a longer record is in a custom field.
        found.setdefault(f"actuator/{model.actuator(index).name}", np.array(model.actuator_biasprm[index]))
    return found


def laws_of(names: LawNames, numbers: Numbers) -> Vector:
    """Return the numbers of the elements with a law along three axes, padded with zeros; (n, longest law)."""
    laws = [numbers[f"law/{name}"] for name in names.bushings]
    padded = np.zeros((len(laws), max((AVERAGED + 1, *(len(law) for law in laws)))))
    for row, law in zip(padded, laws, strict=True):
        row[: len(law)] = law
    return padded


def with_numbers(layout: Layout, names: LawNames, numbers: Numbers, timestep: float) -> Layout:
    """A layout with other numbers, of the same elements in the same rows.

    Args:
        layout: where the elements stand.
        names: of the elements.
        numbers: of all laws, by the names of their fields.
        timestep: step of controlled dampers [s].

    Returns:
        The layout; its curves stand without load.
    """
    laws, present = laws_of(names, numbers), laws_of(names, numbers)[:, 6:9] > 0.0
    rolling = [numbers[f"rolling/{name}"] for name in names.bushings if f"rolling/{name}" in numbers]
    own = np.reshape(rolling, (-1, 5)).astype(float)
    controls = [numbers[f"control/{name}"] for name in names.dampers if f"control/{name}" in numbers]
    return layout._replace(
        bushings=layout.bushings._replace(
            stiffness=laws[:, 0:3].copy(),
            damping=laws[:, 3:6].copy(),
            branch_stiffness=laws[:, 6:9].copy(),
            branch_time=np.divide(laws[:, 9:12], laws[:, 6:9], out=np.zeros((len(laws), 3)), where=present),
            further=laws[:, AVERAGED + 1 :].copy(),
            averaged=_places(laws[:, AVERAGED] > 0.0),
            one_sided=_which(f"one_sided/{name}" in numbers for name in names.bushings),
            oblique=_which(f"directions/{name}" in numbers for name in names.bushings),
            directions=np.array(
                [numbers[f"directions/{name}"] for name in names.bushings if f"directions/{name}" in numbers]
            ).reshape(-1, 9),
        ),
        rotations=layout.rotations._replace(stiffness=laws[laws[:, TURNING] > 0.0, TURNING].copy()),
        springs=layout.springs._replace(
            stiffness=np.array([float(numbers[f"law/{name}"][0]) for name in names.springs])
        ),
        dampers=layout.dampers._replace(
            laws=unpack([numbers[f"actuator/{name}"] for name in names.dampers]),
            pieces=np.reshape([numbers[f"law/{name}"] for name in names.valves], (-1, 3)).astype(float),
        ),
        controls=layout.controls._replace(
            dampers=_which(f"control/{name}" in numbers for name in names.dampers),
            laws=in_steps(np.reshape(controls, (-1, 8)), timestep),
        ),
        tables=_tables(names, numbers),
        rolling=layout.rolling._replace(
            speeds=own[:, 0].copy(),
            trails=own[:, 1].copy(),
            arms=own[:, 2:].copy(),
            hold=np.array(numbers.get("hold/body", np.zeros(0))),
        ),
    )


def _tables(names: LawNames, numbers: Numbers) -> Tables:
    """The laws that are curves, without load."""
    places = [(f"{name}/{axis}", (0, index, place)) for index, name in enumerate(names.bushings)
              for place, axis in enumerate(AXES)]  # fmt: skip
    places += [(name, (1, index, 0)) for index, name in enumerate(names.springs)]
    places += [(name, (2, index, 0)) for index, name in enumerate(names.dampers)]
    read = [(numbers.get(f"table/{name}"), where) for name, where in places]
    return tables_through([(points.reshape(2, -1), where) for points, where in read if points is not None])


def _places(values: Sequence[Any] | Any) -> Any:
    return np.array(values, dtype=np.int64)


def _which(present: Any) -> Any:
    """Positions of what is there."""
    return _places([index for index, one in enumerate(present) if one])
