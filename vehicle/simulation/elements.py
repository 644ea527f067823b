"""The element constants of a compiled car, read back from its model and arranged for the callback."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.names import WHEELS

Vector = npt.NDArray[np.float64]
Index = npt.NDArray[np.intp]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Elements:
    """Arrays over the elements of a car; n elements with a three-axis law, g groups on flexible nodes.

    Attributes:
        names: names of the n elements.
        rows: rows of their translations, (n, 3).
        carriers: body whose axes the law follows, (n,).
        stiffness, damping: K [N/m] and B [N s/m], (n, 3).
        branch_stiffness, branch_time: Maxwell branch K2 [N/m] and tau [s], (n, 3).
        averaged: True where the stiffness is averaged over three steps, (n,).
        rotation_sites: site of the moving part and of the carrier of the m elements that resist rotations, (m, 2).
        rotation_stiffness: K_rot [N m/rad], (m, 1).
        rotation_dofs: +1 where a velocity coordinate turns the moving part, -1 where it turns the carrier; (m, nv).
        tyres: positions of the tyres in `names`, in the order of WHEELS.
        hard_rows: rows of the ideal ball joints without a law, (k, 3).
        springs: rows of the main springs, (2,).
        spring_stiffness: [N/m], (2,).
        spring_lengths: lengths in the design position [m], (2,).
        spring_sites: lower and upper site of each main spring, (2, 2).
        spring_dofs: what moves the ends: spring, end (0 lower, 1 upper), velocity coordinate and the tree it belongs
            to; a row each.
        dampers: equality rows of the dampers, (2,).
        frictions: friction rows of the dampers, (2,).
        valves: second friction rows of degressive dampers, (2,); none for linear ones.
        damper_dofs: velocity index of the damper joints, (2,).
        modal_columns: columns of the modal coordinates.
        node_rows: rows that touch a flexible node, (3, g).
        node_shapes: signed shapes of these nodes, (3, g * modes), in body axes [kg^-1/2].
        spring_shapes: shapes at the upper spring seats, (2, 3, modes).
        reach: where rows with explicit forces are not zero: first row, number of rows (3 or 1), first column, end.
        body: id of the flexible body.
        body_turns: velocity coordinates that turn it, (3,).
        row_count: number of constraint rows.
    """

    names: tuple[str, ...]
    rows: Index
    carriers: Index
    stiffness: Vector
    damping: Vector
    branch_stiffness: Vector
    branch_time: Vector
    averaged: npt.NDArray[np.bool_]
    rotation_sites: Index
    rotation_stiffness: Vector
    rotation_dofs: Vector
    tyres: Index
    hard_rows: Index
    springs: Index
    spring_stiffness: Vector
    spring_lengths: Vector
    spring_sites: Index
    spring_dofs: Index
    dampers: Index
    frictions: Index
    valves: Index
    damper_dofs: Index
    modal_columns: slice
    node_rows: Index
    node_shapes: Vector
    spring_shapes: Vector
    reach: Index
    body: int
    body_turns: Index
    row_count: int


def numeric(model: mujoco.MjModel, name: str) -> Vector | None:
    """A custom numeric field of the model, None where it does not exist."""
    index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_NUMERIC, name)
    if index < 0:
        return None
    start = model.numeric_adr[index]
    return np.array(model.numeric_data[start : start + model.numeric_size[index]])


def modal_joints(model: mujoco.MjModel) -> list[int]:
    """Ids of the joints that hold the modal coordinates."""
    found: list[int] = []
    while True:
        index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, f"mode_{len(found) + 1}")
        if index < 0:
            return found
        found.append(index)


def read_elements(model: mujoco.MjModel) -> Elements:
    """Collect the element constants from the custom fields of a compiled car.

    Args:
        model: made by `vehicle.assembly`, or loaded from its MJCF file.

    Returns:
        The arrays, in the order of the constraint rows.
    """
    joints = modal_joints(model)
    first = int(model.jnt_dofadr[joints[0]]) if joints else 0
    modes = len(joints)
    kinds = mujoco.mjtEq
    row = 0
    names, rows, carriers, laws, rotation_sites, rotation_stiffness = [], [], [], [], [], []
    hard_rows, node_rows, node_shapes = [], [], []
    springs, spring_stiffness, spring_lengths, spring_sites, spring_shapes, dampers = [], [], [], [], [], []
    reach: list[tuple[int, int, int, int]] = []
    modal = range(first, first + modes)
    for index in range(model.neq):
        name = model.equality(index).name
        kind = mujoco.mjtEq(model.eq_type[index])
        law = numeric(model, f"law/{name}")
        shape = numeric(model, f"shape/{name}")
        triple = np.arange(row, row + 3)
        if kind == kinds.mjEQ_CONNECT:
            sites = (int(model.eq_obj1id[index]), int(model.eq_obj2id[index]))
            moving, carrier = (int(model.site_bodyid[site]) for site in sites)
            reach += _reach(model, row, 3, sites, modal)
            if shape is not None:
                # The residual is moving less carrier: the body's own shape counts with the sign of its role.
                sign = 1.0 if model.body(moving).name == "body" else -1.0
                node_rows.append(triple)
                node_shapes.append(sign * shape.reshape(3, modes))
            if law is None:
                hard_rows.append(triple)
            else:
                names.append(name)
                rows.append(triple)
                carriers.append(carrier)
                laws.append(law)
                if law[12] > 0.0:
                    rotation_sites.append(sites)
                    rotation_stiffness.append(law[12])
            row += 3
        elif kind == kinds.mjEQ_TENDON:
            assert law is not None
            springs.append(row)
            spring_stiffness.append(law[0])
            spring_lengths.append(float(model.tendon_length0[model.eq_obj1id[index]]))
            spring_sites.append((model.site(f"{name}/lower").id, model.site(f"{name}/upper").id))
            reach += _reach(model, row, 1, spring_sites[-1], modal)
            spring_shapes.append(np.zeros((3, modes)) if shape is None else shape.reshape(3, modes))
            row += 1
        else:
            dampers.append(row)
            row += 1
    damper_joints = [model.joint(f"damper_{wheel}").id for wheel in WHEELS if _has_joint(model, f"damper_{wheel}")]
    dofs = model.jnt_dofadr[damper_joints] if damper_joints else np.zeros(0, dtype=int)
    valves = [index for index in range(model.ntendon) if model.tendon_frictionloss[index] > 0.0]
    table = np.array(laws).reshape(len(laws), 14)
    shapes = np.array(node_shapes).reshape(len(node_shapes), 3, modes)
    return Elements(
        names=tuple(names),
        rows=np.array(rows, dtype=np.intp).reshape(-1, 3),
        carriers=np.array(carriers, dtype=np.intp),
        stiffness=table[:, 0:3].copy(),
        damping=table[:, 3:6].copy(),
        branch_stiffness=table[:, 6:9].copy(),
        branch_time=np.divide(table[:, 9:12], table[:, 6:9], out=np.zeros((len(laws), 3)), where=table[:, 6:9] > 0.0),
        averaged=table[:, 13] > 0.0,
        rotation_sites=np.array(rotation_sites, dtype=np.intp).reshape(-1, 2),
        rotation_stiffness=np.array(rotation_stiffness).reshape(-1, 1),
        rotation_dofs=_rotation_dofs(model, rotation_sites),
        tyres=np.array([names.index(f"bushing/tyre_{w}") for w in WHEELS if f"bushing/tyre_{w}" in names], np.intp),
        hard_rows=np.array(hard_rows, dtype=np.intp).reshape(-1, 3),
        springs=np.array(springs, dtype=np.intp),
        spring_stiffness=np.array(spring_stiffness),
        spring_lengths=np.array(spring_lengths),
        spring_sites=np.array(spring_sites, dtype=np.intp).reshape(-1, 2),
        spring_dofs=_spring_dofs(model, spring_sites),
        dampers=np.array(dampers, dtype=np.intp),
        # Friction rows follow the equality rows: those of joints in their order, then those of tendons.
        frictions=row + np.argsort(np.argsort(dofs)),
        valves=row + len(damper_joints) + np.arange(len(valves)),
        damper_dofs=np.array(dofs, dtype=np.intp),
        modal_columns=slice(first, first + modes),
        node_rows=np.array(node_rows, dtype=np.intp).reshape(-1, 3).T,
        node_shapes=shapes.transpose(1, 0, 2).reshape(3, len(node_shapes) * modes),
        spring_shapes=np.array(spring_shapes).reshape(len(springs), 3, modes),
        reach=np.array(reach, dtype=np.intp).reshape(-1, 4),
        body=_body_id(model),
        body_turns=_body_turns(model),
        row_count=row + len(damper_joints) + len(valves),
    )


def _rotation_dofs(model: mujoco.MjModel, sites: list[tuple[int, int]]) -> Vector:
    """Which coordinates turn the moving part (+1) and the carrier (-1) of each element; both cancel."""
    signs = np.zeros((len(sites), model.nv))
    for row, (moving, carrier) in zip(signs, sites, strict=True):
        row[_moved_by(model, moving)] += 1.0
        row[_moved_by(model, carrier)] -= 1.0
    signs[:, ~_turns(model)] = 0.0
    return signs


def _turns(model: mujoco.MjModel) -> npt.NDArray[np.bool_]:
    """Which velocity coordinates turn a body: all but slides and the first three of free bodies; (nv,)."""
    found = np.ones(model.nv, dtype=np.bool_)
    kinds = mujoco.mjtJoint
    for joint in range(model.njnt):
        shifts = {int(kinds.mjJNT_SLIDE): 1, int(kinds.mjJNT_FREE): 3}.get(int(model.jnt_type[joint]), 0)
        found[model.jnt_dofadr[joint] : model.jnt_dofadr[joint] + shifts] = False
    return found


def _body_turns(model: mujoco.MjModel) -> Index:
    """Velocity coordinates that turn the flexible body."""
    dofs = np.array(_above(model, _body_id(model)), dtype=np.intp)
    return dofs[_turns(model)[dofs]]


def _spring_dofs(model: mujoco.MjModel, sites: list[tuple[int, int]]) -> Index:
    """Spring, end, velocity coordinate and its tree, for all coordinates that move an end of a spring."""
    found = [
        (spring, end, dof, int(model.body_rootid[model.dof_bodyid[dof]]))
        for spring, ends in enumerate(sites)
        for end, site in enumerate(ends)
        for dof in _moved_by(model, site)
    ]
    return np.array(found, dtype=np.intp).reshape(-1, 4)


def _moved_by(model: mujoco.MjModel, site: int) -> list[int]:
    """Velocity coordinates that move a site."""
    return _above(model, int(model.site_bodyid[site]))


def _above(model: mujoco.MjModel, body: int) -> list[int]:
    """Velocity coordinates that move a body, from itself down to the world."""
    found: list[int] = []
    while body > 0:
        first = int(model.body_dofadr[body])
        found += range(first, first + int(model.body_dofnum[body]))
        body = int(model.body_parentid[body])
    return found


def _reach(
    model: mujoco.MjModel, row: int, rows: int, sites: tuple[int, int], modal: range
) -> list[tuple[int, int, int, int]]:
    """Rows, and the runs of columns in which the motion of two sites has derivatives."""
    columns = np.unique([*_moved_by(model, sites[0]), *_moved_by(model, sites[1]), *modal])
    runs = np.split(columns, np.flatnonzero(np.diff(columns) > 1) + 1)
    return [(row, rows, int(run[0]), int(run[-1]) + 1) for run in runs if len(run)]


def _has_joint(model: mujoco.MjModel, name: str) -> bool:
    return bool(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name) >= 0)


def _body_id(model: mujoco.MjModel) -> int:
    return max(int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "body")), 0)
