"""Constraint rows of the dampers of a compiled car: equality rows, friction rows of joints and of tendons.

Friction rows follow the equality rows: those of joints in their order, then those of tendons.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import mujoco
import numpy as np

from vehicle.engines.simulation.element_records import Dampers, Index, Presliding, SideForces
from vehicle.engines.simulation.law_arrays import LawNames, Numbers, friction_tendons, whole_numbers
from vehicle.errors import ConfigurationError
from vehicle.model.laws.damper import unpack


def damper_rows(
    model: mujoco.MjModel, rows_of: Callable[[Sequence[str]], Index], first: int, laws: Mapping[str, Any]
) -> Dampers:
    """Return the record of the dampers: user actuators on joints, with equality rows of the same names."""
    actuators = _damper_actuators(model)
    joints = [int(model.actuator_trnid[index, 0]) for index in actuators]
    dofs = whole_numbers([model.jnt_dofadr[joint] for joint in joints])
    rows = _tendon_rows(model, first + len(actuators))
    valves = [
        # A tendon of a segment follows the slide of its damper alone.
        (rows[tendon], joints.index(int(model.wrap_objid[model.tendon_adr[tendon]])))
        for tendon in friction_tendons(model, presliding=False)
    ]
    return Dampers(
        rows=rows_of([str(model.actuator(index).name) for index in actuators]),
        # MuJoCo orders friction rows by coordinate: the argsort of an argsort is the rank of each damper in that
        # order.
        frictions=first + np.argsort(np.argsort(dofs)),
        dofs=dofs,
        places=whole_numbers([model.jnt_qposadr[joint] for joint in joints]),
        valves=whole_numbers(valves, 2),
        **laws,
    )


def _tendon_rows(model: mujoco.MjModel, first: int) -> dict[int, int]:
    """Return the friction rows of tendons, which follow the equality rows and the friction rows of joints."""
    return {int(tendon): first + n for n, tendon in enumerate(np.flatnonzero(model.tendon_frictionloss > 0.0))}


def presliding_rows(
    model: mujoco.MjModel, law: LawNames, dampers: Dampers, first: int, numbers: Mapping[str, Any]
) -> Presliding:
    """Return the record of the Jenkins elements.

    The first element of a damper has the friction row of its joint, the others have those of tendons.
    """
    rows, indices = _tendon_rows(model, first + len(law.dampers)), list[tuple[int, int]]()
    tendons = {str(model.tendon(index).name): rows[index] for index in friction_tendons(model, presliding=True)}
    for name in law.presliding:
        index = law.dampers.index(name)
        number = sum(damper == index for _, damper in indices)
        row = tendons[f"presliding/{name}/{number}"] if number else int(dampers.frictions[index])
        indices.append((row, index))
    return Presliding(
        rows=whole_numbers([row for row, _ in indices]),
        dampers=whole_numbers([index for _, index in indices]),
        **numbers,
    )


def side_forces(
    model: mujoco.MjModel, law: LawNames, numbers: Numbers, ends: Mapping[str, tuple[int, int]]
) -> SideForces:
    """Return the bushings at the rods of the dampers.

    Args:
        model, law, numbers: model, names of its elements and numbers of their laws.
        ends: sites on the moving part and on the carrier of each bushing.

    Raises:
        ConfigurationError: a damper with a side force coefficient has no bushing at its rod.
    """
    oblique = [name for name in law.bushings if f"directions/{name}" in numbers]
    sides: list[tuple[int, int, float, int]] = []
    for damper, actuator in enumerate(_damper_actuators(model)):
        rod, before = model.body_weldid[model.jnt_bodyid[model.actuator_trnid[actuator, 0]]], len(sides)
        for index, name in enumerate(law.bushings):
            for site, sign in zip(ends[name], (1.0, -1.0), strict=True):
                if model.body_weldid[model.site_bodyid[site]] == rod:
                    sides.append((damper, index, sign, oblique.index(name) if name in oblique else -1))
        record = unpack(numbers[f"actuator/{law.dampers[damper]}"])[0]
        if record["side_force"] > 0.0 and len(sides) == before:
            raise ConfigurationError(
                f"{law.dampers[damper]}: side_force_coefficient is {record['side_force']:g}, but its side force "
                "is unknown, because no bushing holds the rod; set the coefficient to 0, or give the mount of "
                "the rod a stiffness"
            )
    return SideForces(
        dampers=whole_numbers([side[0] for side in sides]),
        elements=whole_numbers([side[1] for side in sides]),
        signs=np.array([side[2] for side in sides]),
        oblique=whole_numbers([side[3] for side in sides]),
    )


def _damper_actuators(model: mujoco.MjModel) -> list[int]:
    """Return the ids of the actuators of dampers."""
    return [index for index in range(model.nu) if model.actuator_biastype[index] == mujoco.mjtBias.mjBIAS_USER]
