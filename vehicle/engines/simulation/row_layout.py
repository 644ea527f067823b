"""Layout of a compiled car: constraint rows and coordinates of its elements, and the constants of their laws."""

import itertools
from collections.abc import Callable, Sequence
from typing import Any

import mujoco
import numpy as np

from vehicle.arrays import Mask, Vector
from vehicle.engines.simulation.applied_forces import applied_record
from vehicle.engines.simulation.damper_rows import damper_rows, presliding_rows, side_forces
from vehicle.engines.simulation.element_records import (
    Bushings,
    Controls,
    Fluids,
    Index,
    Indices,
    Layout,
    ModalSpace,
    Modes,
    OwnDampers,
    Rolling,
    Rotations,
    RoundTyres,
    RubberFriction,
    Springs,
    Table,
    Tables,
)
from vehicle.engines.simulation.law_arrays import (
    fluid_coordinates,
    law_fields,
    law_names,
    laws_of,
    model_numbers,
    whole_numbers,
)
from vehicle.model.assembly.element_numbers import FLUID, TURNING


def numeric(model: mujoco.MjModel, name: str) -> Vector | None:
    """Return a custom numeric field of the model, or None for a missing field."""
    index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_NUMERIC, name)
    if index < 0:
        return None
    start = model.numeric_adr[index]
    return np.array(model.numeric_data[start : start + model.numeric_size[index]])


def equality_rows(model: mujoco.MjModel) -> dict[str, range]:
    """Return the constraint rows of each equality of a model, by name."""
    rows, row = {}, 0
    for index in range(model.neq):
        count = 3 if model.eq_type[index] == mujoco.mjtEq.mjEQ_CONNECT else 1
        rows[str(model.equality(index).name)] = range(row, row + count)
        row += count
    return rows


def read_layout(model: mujoco.MjModel) -> Layout:
    """Read the elements of a compiled car from its custom fields, in the order of the constraint rows.

    Args:
        model: model from `vehicle.model.assembly`, or from its MJCF file.
    """
    law, numbers, rows_by_name = law_names(model), model_numbers(model), equality_rows(model)
    names, springs, laws = law.bushings, law.springs, laws_of(law, numbers)
    equalities = {str(model.equality(index).name): index for index in range(model.neq)}
    joints = _modal_joints(model)
    modes = len(joints)
    modal = range(int(model.jnt_dofadr[joints[0]]), int(model.jnt_dofadr[joints[0]]) + modes) if joints else range(0)
    ends: dict[str, tuple[int, int]] = {}  # sites of a connection or a spring
    for name, index in equalities.items():
        if model.eq_type[index] == mujoco.mjtEq.mjEQ_CONNECT:
            ends[name] = int(model.eq_obj1id[index]), int(model.eq_obj2id[index])
        elif model.eq_type[index] == mujoco.mjtEq.mjEQ_TENDON:
            ends[name] = model.site(f"{name}/lower").id, model.site(f"{name}/upper").id
    rolling = [name for name in names if f"rolling/{name}" in numbers]
    hubs = {name: str(model.body(model.site_bodyid[ends[name][1]]).name).removeprefix("plate_") for name in rolling}
    spins = {name: (int(model.joint(f"spin_{wheel}").dofadr[0]),) for name, wheel in hubs.items()}

    coordinates = [(name, name.partition("/")[2]) for name in fluid_coordinates(law, numbers)]
    moved = [(row, name) for name, mount in coordinates for row in (f"{FLUID}{mount}", f"bushing/{mount}")]
    further = dict(spins)
    for row, name in moved:
        further[row] = (*further.get(row, ()), int(model.joint(name).dofadr[0]))

    def modal_at(name: str) -> range:
        return modal if f"shape/{name}" in numbers else range(0)

    nonzero = []
    for name, sites in ends.items():
        # First row, number of rows, first column and end of the nonzero columns of a connection.
        moving = [column for site in sites for column in _above(model, model.site_bodyid[site])]
        columns = np.unique([*moving, *modal_at(name), *further.get(name, ())])
        # Neighbouring columns form a run, which compiled code handles as one loop.
        runs, rows = np.split(columns, np.flatnonzero(np.diff(columns) > 1) + 1), rows_by_name[name]
        nonzero += [(rows.start, len(rows), run[0], run[-1] + 1) for run in runs if len(run)]

    def rows_of(chosen: Sequence[str]) -> Index:
        return whole_numbers([rows_by_name[name].start for name in chosen])

    balls = [name for name in ends if name not in springs]
    carriers = whole_numbers([model.site_bodyid[ends[name][1]] for name in names])
    rotational = [name for name, law_numbers in zip(names, laws, strict=True) if law_numbers[TURNING] > 0.0]
    plates = {index: model.body_mocapid[carrier] for index, carrier in enumerate(carriers)}
    of, none = law_fields(law, numbers, float(model.opt.timestep)), np.zeros(0)
    first_friction = sum(map(len, rows_by_name.values()))
    dampers = damper_rows(model, rows_of, first_friction, of["dampers"])
    controlled = [name for name in law.dampers if f"control/{name}" in numbers]
    rolling_tyres = [(names.index(name), ends[name], spins[name][0]) for name in rolling]
    round_tyres = [(names.index(name), ends[name]) for name in names if f"round/{name}" in numbers]
    return Layout(
        bushings=Bushings(rows=_triples(rows_of(names)), carriers=carriers, **of["bushings"]),
        rubber=RubberFriction(**of["rubber"]),
        rotations=Rotations(
            sites=whole_numbers([ends[name] for name in rotational], 2),
            turning=_turning(model, [ends[name] for name in rotational]),
            **_node_rotations(model, rotational, ends, modes),
            **of["rotations"],
        ),
        springs=Springs(
            rows=rows_of(springs),
            lengths=np.array([model.tendon_length0[model.eq_obj1id[equalities[name]]] for name in springs]),
            sites=whole_numbers([ends[name] for name in springs], 2),
            shapes=_shapes(model, springs, modes),
            dofs=_spring_dofs(model, [ends[name] for name in springs]),
            **of["springs"],
        ),
        dampers=dampers,
        presliding=presliding_rows(model, law, dampers, first_friction, of["presliding"]),
        sides=side_forces(model, law, numbers, ends),
        controls=Controls(**_sensors(model, controlled, modes), **of["controls"]),
        own=OwnDampers(**of["own"]),
        tables=Tables(**of["tables"]),
        modes=_modes(model, [name for name in balls if f"shape/{name}" in numbers], ends, rows_of, modal),
        space=ModalSpace(none, none, none, none, spread=np.zeros((0, 0))),
        rolling=Rolling(**_rolling(model, rolling, rolling_tyres, plates), **of["rolling"]),
        round=RoundTyres(**_round_tyres(model, round_tyres), **of["round"]),
        fluids=Fluids(
            elements=whole_numbers([names.index(row) for row, _ in moved]),
            dofs=whole_numbers([model.joint(name).dofadr[0] for _, name in moved]),
            places=whole_numbers([model.joint(name).qposadr[0] for _, name in moved]),
            **of["fluids"],
        ),
        applied=applied_record(model, [_above(model, body) for body in range(model.nbody)], modes),
        joints=_triples(rows_of([name for name in balls if name not in names])),
        tyres=whole_numbers(sorted((index for index in plates if plates[index] >= 0), key=lambda index: plates[index])),
        reach=whole_numbers(nonzero, 4),
        row_count=first_friction + len(law.dampers) + int(np.count_nonzero(model.tendon_frictionloss > 0.0)),
        velocity_count=int(model.nv),
    )


def wheels_of(model: mujoco.MjModel) -> tuple[str, ...]:
    """Return the names of the wheels of a car, in the order of their plates."""
    plates = sorted((int(plate), index) for index, plate in enumerate(model.body_mocapid) if plate >= 0)
    return tuple(str(model.body(index).name).removeprefix("plate_") for _, index in plates)


def places_of(model: mujoco.MjModel) -> tuple[str, ...]:
    """Return the names of the output points of a car, in the order of their sensors."""
    points = np.flatnonzero(model.sensor_type == mujoco.mjtSensor.mjSENS_FRAMELINACC)
    return tuple(str(model.sensor(index).name).removesuffix("_acc") for index in points)


def _triples(first: Index) -> Indices:
    """Return three consecutive rows from each first row; (n, 3)."""
    return np.ascontiguousarray(first[:, None] + np.arange(3))


def _modal_joints(model: mujoco.MjModel) -> list[int]:
    """Return the ids of the joints of the modal coordinates."""
    names = (f"mode_{number}" for number in itertools.count(1))
    ids = (mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name) for name in names)
    return list(itertools.takewhile(lambda index: index >= 0, ids))


def _shapes(model: mujoco.MjModel, names: Sequence[str], modes: int) -> Table:
    """Return the modal shapes of elements, zero for rigid attachments; (names, 3 modes)."""
    shapes = [numeric(model, f"shape/{name}") for name in names]
    return np.array([np.zeros(3 * modes) if shape is None else shape for shape in shapes]).reshape(
        len(names), 3 * modes
    )


def _modes(
    model: mujoco.MjModel,
    names: Sequence[str],
    ends: dict[str, tuple[int, int]],
    rows_of: Callable[[Sequence[str]], Index],
    modal: range,
) -> Modes:
    """Return the record of the flexible body, with the rows of the connections at its nodes."""
    joints, body = _modal_joints(model), max(int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "body")), 0)
    # The residual is moving part less carrier: the sign of a shape depends on the role of the body.
    signs = [1.0 if model.site_bodyid[ends[name][0]] == body else -1.0 for name in names]
    shapes = np.reshape(signs, (-1, 1)) * _shapes(model, names, len(modal))
    # (nodes, axes, modes)
    by_node = shapes.reshape(len(names), 3, len(modal))
    dofs = np.array(_above(model, body), dtype=np.int64)
    return Modes(
        body=body,
        size=len(modal),
        first_velocity=modal.start,
        first_position=int(model.jnt_qposadr[joints[0]]) if joints else 0,
        turns=dofs[_turns(model)[dofs]],
        rows=np.ascontiguousarray(_triples(rows_of(names)).T),
        node_shapes=np.ascontiguousarray(by_node.transpose(1, 0, 2).reshape(3, len(names) * len(modal))),
        mode_shapes=np.ascontiguousarray(by_node.transpose(2, 1, 0).reshape(len(modal), 3 * len(names))),
    )


def _sensors(model: mujoco.MjModel, chosen: Sequence[str], modes: int) -> dict[str, Any]:
    """Return the sites, shapes and coordinates of the sensors of controlled dampers."""
    site_names = [(f"sensor/{name}/lower", f"sensor/{name}/upper") for name in chosen]
    sites = [(int(model.site(lower).id), int(model.site(upper).id)) for lower, upper in site_names]
    shapes = _shapes(model, [site for both in site_names for site in both], modes)
    return {"sites": whole_numbers(sites, 2), "shapes": shapes, "dofs": _spring_dofs(model, sites)}


def _turning(model: mujoco.MjModel, sites: Sequence[tuple[int, int]]) -> Indices:
    """Return element, coordinate and sign: +1 if it rotates the moving part, -1 the carrier; both cancel."""
    signs = np.zeros((len(sites), model.nv), dtype=np.int64)
    for row, ends in zip(signs, sites, strict=True):
        for site, sign in zip(ends, (1, -1), strict=True):
            # A coordinate that rotates both ends does not rotate them relative to each other: 1 - 1 = 0.
            row[_above(model, model.site_bodyid[site])] += sign
    signs[:, ~_turns(model)] = 0
    pairs = np.argwhere(signs)
    return whole_numbers(np.column_stack([pairs, signs[tuple(pairs.T)]]), 3)


def _node_rotations(
    model: mujoco.MjModel, names: Sequence[str], ends: dict[str, tuple[int, int]], modes: int
) -> dict[str, Any]:
    """Return the elements with rotational mode shapes at a node of the body, the side of the node, and the shapes."""
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "body")
    read = [numeric(model, f"rotation/{name}") for name in names]
    with_shapes = [(n, psi) for n, psi in enumerate(read) if psi is not None]
    sides = [int(model.site_bodyid[ends[names[n]][0]] != body) for n, _ in with_shapes]
    return {
        "nodes": whole_numbers([(n, side) for (n, _), side in zip(with_shapes, sides, strict=True)], 2),
        "shapes": np.reshape([psi for _, psi in with_shapes], (len(with_shapes), 3 * modes)).astype(float),
    }


def _turns(model: mujoco.MjModel) -> Mask:
    """Return a mask of the rotational velocity coordinates: no slides, no translations of free bodies; (nv,)."""
    rotational = np.ones(model.nv, dtype=np.bool_)
    kinds = mujoco.mjtJoint
    for joint in range(model.njnt):
        shifts = {int(kinds.mjJNT_SLIDE): 1, int(kinds.mjJNT_FREE): 3}.get(int(model.jnt_type[joint]), 0)
        rotational[model.jnt_dofadr[joint] : model.jnt_dofadr[joint] + shifts] = False
    return rotational


def _spring_dofs(model: mujoco.MjModel, sites: Sequence[tuple[int, int]]) -> Indices:
    """Return rows of spring, end, velocity coordinate that moves the end, and its tree."""
    entries = [
        (spring, end, dof, int(model.body_rootid[model.dof_bodyid[dof]]))
        for spring, ends in enumerate(sites)
        for end, site in enumerate(ends)
        for dof in _above(model, model.site_bodyid[site])
    ]
    return whole_numbers(entries, 4)


def _above(model: mujoco.MjModel, number: Any) -> list[int]:
    """Return the velocity coordinates that move a body, given by its number, from the body down to the world."""
    columns, body = list[int](), int(number)
    while body > 0:
        first = int(model.body_dofadr[body])
        columns += range(first, first + int(model.body_dofnum[body]))
        body = int(model.body_parentid[body])
    return columns


def _rolling(
    model: mujoco.MjModel,
    names: Sequence[str],
    wheels: Sequence[tuple[int, tuple[int, int], int]],
    plates: dict[int, Any],
) -> dict[str, Any]:
    """Return the fields of the record of the rolling tyres that do not follow from their laws.

    `names` has the tyres, `wheels` index among the bushings, sites and spin coordinate of each tyre,
    `plates` the index of each plate.
    """
    order = sorted(int(position) for position in plates.values() if position >= 0)
    hubs = [int(model.site_bodyid[sites[0]]) for _, sites, _ in wheels]
    inertias = []
    for _, _, spin in wheels:
        rotating = np.flatnonzero(model.body_weldid == model.dof_bodyid[spin])
        frames = np.zeros((len(rotating), 9))
        for frame, body in zip(frames, rotating, strict=True):
            mujoco.mju_quat2Mat(frame, model.body_iquat[body])
        # I_yy = sum of R_yk^2 I_k over the principal axes k of each body that turns with the wheel; frames: (bodies,
        # 3, 3).
        inertias.append(float(np.sum(frames.reshape(-1, 3, 3)[:, 1] ** 2 * model.body_inertia[rotating])))
    course, start = np.zeros(0), np.zeros(0)
    if wheels:
        joint = model.joint("body")
        first, position = int(joint.dofadr[0]), int(joint.qposadr[0])
        # Velocities along x, y and in yaw, positions along x and y of the free joint of the body.
        course = np.array([first, first + 1, first + 5, position, position + 1])
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        # Positions along x and y of the body, and the heading of each axle, which is y of its hub.
        axles = data.xmat[hubs].reshape(-1, 3, 3)[:, :, 1]
        headings = np.arctan2(-axles[:, 0], axles[:, 1])
        steady = [numeric(model, f"steady/{name}") for name in names]
        forces = [np.zeros(2) if force is None else force for force in steady]
        start = np.concatenate([model.qpos0[position : position + 2], headings, *forces])
    dofs = [(n, dof, int(model.body_rootid[hub])) for n, hub in enumerate(hubs) for dof in _above(model, hub)]
    return {
        "tyres": whole_numbers([index for index, _, _ in wheels]),
        "plates": whole_numbers([order.index(int(plates[index])) for index, _, _ in wheels]),
        "sites": whole_numbers([sites[0] for _, sites, _ in wheels]),
        "hubs": whole_numbers(hubs),
        "spins": whole_numbers([spin for _, _, spin in wheels]),
        "inertias": np.array(inertias),
        "dofs": whole_numbers(dofs, 3),
        "course": whole_numbers(course),
        "rest": start,
    }


def _round_tyres(model: mujoco.MjModel, tyres: Sequence[tuple[int, tuple[int, int]]]) -> dict[str, Any]:
    """Return the same of the round tyres at rest, from index among the bushings and sites."""
    hubs = [int(model.site_bodyid[sites[0]]) for _, sites in tyres]
    dofs = [(n, dof) for n, hub in enumerate(hubs) for dof in _above(model, hub)]
    return {
        "tyres": whole_numbers([index for index, _ in tyres]),
        "hubs": whole_numbers(hubs),
        "dofs": whole_numbers(dofs, 2),
    }
