"""Mass, damping and stiffness matrices of the assembled car in its design position, read from its MuJoCo model.

u are the velocity coordinates of MuJoCo as small displacements. K holds the geometric stiffness of gravity and
preloads: it is the derivative of the very forces that the time simulation applies.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.rolling_terms import rolling_terms
from vehicle.engines.linear.system import LinearSystem
from vehicle.engines.simulation.callbacks import compiled_rows, installed
from vehicle.engines.simulation.force_curves import curve_of
from vehicle.engines.simulation.row_layout import numeric, places_of, wheels_of
from vehicle.engines.simulation.rows import Rows, joint_dampers
from vehicle.engines.simulation.static_trim import StaticTrim
from vehicle.names import AXES

Vector = npt.NDArray[np.float64]

DIFFERENCE_STEP = 1e-6
"""Step [m, rad, kg^1/2 m] of the central differences of the forces: truncation and round-off are both below 1e-8."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Bend:
    """A law over displacement that is linear between two displacements from the design position.

    Attributes:
        name: of its element.
        row: its displacement over the velocity coordinates; (n,).
        plate: input that it is on, -1 where there is none.
        low, high: ends of the piece of the curve on which the car stands [m].
        steeper: slope of the steepest piece less that of this one [N/m].
    """

    name: str
    row: Vector
    plate: int
    low: float
    high: float
    steeper: float = 0.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarMatrices:
    """The linear car: a system with the plates as inputs and the dampers as sliding pairs, and what its parts are.

    Attributes:
        system: matrices of `vehicle.engines.linear.system`; C holds the viscous part of the dampers, inputs are the
            wheels, outputs turn u'' into the acceleration channels.
        dampers: velocity coordinates of the damper joints; (d,).
        viscous: damping constants of the dampers [N s/m], softest settings of controlled ones; (d,).
        sensors: rows that turn u' into the velocities along controlled dampers, on the wheel and on the body; (2 k, n).
        bends: where the linear car ends.
        tyre_stiffness, tyre_damping: vertical stiffness [N/m] and damping [N s/m] of the tyres; (w,).
        body_rows: rows that turn u' into velocity of the centre of gravity and angular velocity of each body;
            body name to (6, n).
        body_masses: mass [kg] and inertia tensor [kg m2] of each body, as a (6, 6) matrix.
        body_places: centre of gravity of each body in the design position [m]; (3,).
        tyre_rows: rows that turn u into the height of the tyres over their plates; (w, n).
        one_sided: wheels whose tyres do not pull.
        spinning: bodies that turn with a rolling wheel: their angle is of no importance, and not known.
        carried_by: body that each body is fixed to, itself where it can move on its parent.
        slope: forces on the coordinates per velocity of a plate, by the static load of a rolling tyre on the slope of
            the road, a part of the inputs of `system`; (n, w), (n, 0) for tyres that stand.
        modal: velocity coordinates of the flexible modes.
    """

    system: LinearSystem
    dampers: npt.NDArray[np.intp]
    viscous: Vector
    sensors: Vector = field(default_factory=lambda: np.zeros((0, 0)))
    bends: tuple[Bend, ...] = ()
    one_sided: frozenset[str] = frozenset()
    tyre_stiffness: Vector
    tyre_damping: Vector
    tyre_rows: Vector
    spinning: frozenset[str] = frozenset()
    body_rows: dict[str, Vector]
    body_masses: dict[str, Vector]
    body_places: dict[str, Vector]
    carried_by: dict[str, str]
    modal: slice
    slope: Vector = field(default_factory=lambda: np.zeros((0, 0)))


def car_matrices(model: mujoco.MjModel, static: StaticTrim, *, compiled: bool = True) -> CarMatrices:
    """Read the matrices of a trimmed car from its model.

    Args:
        model: compiled and trimmed car (not yet prepared for stepping).
        static: its preloads.
        compiled: whether its laws are compiled for that. Compiling takes 15 s where nothing is kept from before; of one
            car alone the Python form takes 0.3 s, with the same result but for round-off, 1e-11.

    Returns:
        The matrices.
    """
    data = mujoco.MjData(model)
    rows = Rows(model, static.preload)
    e = rows.layout
    stiffness = _tangent_stiffness(rows, compiled)
    with installed(rows):
        mujoco.mj_forward(model, data)
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    jacobian = data.efc_J.reshape(e.row_count, model.nv).copy()
    dofs, still = e.dampers.dofs, np.zeros(len(e.tyres))
    rows_of_bodies = _body_rows(model, data)
    laws = law_matrices(rows, jacobian, joint_dampers(model), static.preload)
    turning = set(model.dof_bodyid[e.rolling.spins].tolist())
    return CarMatrices(
        system=LinearSystem(
            coordinates=(),
            inputs=wheels_of(model),
            mass=mass,
            stiffness=stiffness,
            slide_rows=np.eye(model.nv)[dofs],
            slide_inputs=np.zeros((len(dofs), len(e.tyres))),
            constraints=jacobian[e.joints.ravel()],
            load=np.zeros(model.nv),
            cyclic=tuple(e.rolling.spins.tolist()),
            outputs={
                name: np.concatenate([row, still]) for name, row in _outputs(model, data, e.modes.velocities).items()
            },
            **laws.system,
        ),
        dampers=dofs,
        **laws.car,
        sensors=_sensors(rows, data),
        one_sided=frozenset(
            wheel for wheel, tyre in zip(wheels_of(model), e.tyres, strict=True) if tyre in e.bushings.one_sided
        ),
        spinning=frozenset(str(model.body(i).name) for i, root in enumerate(model.body_weldid) if int(root) in turning),
        body_rows=rows_of_bodies,
        body_masses=_body_masses(model, data),
        body_places={name: data.xipos[model.body(name).id].copy() for name in rows_of_bodies},
        carried_by={
            str(model.body(i).name): str(model.body(int(root)).name) for i, root in enumerate(model.body_weldid)
        },
        modal=e.modes.velocities,
    )


class LawMatrices(NamedTuple):
    """What the laws of a car make of its linear form, but the stiffness matrix: fields of both classes."""

    system: dict[str, Any]
    car: dict[str, Any]


def law_matrices(rows: Rows, jacobian: Vector, joint_damping: Vector, preload: Vector) -> LawMatrices:
    """Fields of `LinearSystem` and of `CarMatrices` that depend on the numbers of the laws.

    Args:
        rows: of the car at rest.
        jacobian: of its rows; (rows, n).
        joint_damping: damping inside joints; (n,).
        preload: static forces of the rows; a rolling tyre takes its load on the slope of the road.
    """
    e, bushings, dofs = rows.layout, rows.layout.bushings, rows.layout.dampers.dofs
    viscous = e.dampers.laws["viscous_damping"]
    # In the design position all carriers are parallel to the vehicle frame, so rows are element axes.
    row_damping = np.zeros(e.row_count)
    row_damping[bushings.rows] = bushings.damping
    damping = jacobian.T @ (row_damping[:, None] * jacobian)
    damping[np.diag_indices(len(damping))] += joint_damping
    damping[dofs, dofs] += viscous
    present = bushings.branch_stiffness > 0.0
    vertical = jacobian[bushings.rows[e.tyres][:, 2]]
    tyres = {"stiffness": bushings.stiffness[e.tyres, 2], "damping": bushings.damping[e.tyres, 2]}
    inputs = {f"input_{kind}": vertical.T * numbers for kind, numbers in tyres.items()}
    branch_rows = jacobian[bushings.rows[present]]
    rolling = None
    if len(e.rolling.tyres):
        rolling = rolling_terms(rows, preload)
        damping += rolling.damping
        inputs["input_damping"] = inputs["input_damping"] + rolling.slope
    return LawMatrices(
        system={
            "damping": damping,
            "branch_rows": branch_rows,
            **({} if rolling is None else rolling.branches(branch_rows, present)),
            "branch_inputs": np.zeros((int(np.count_nonzero(present)), len(e.tyres))),
            "branch_stiffness": bushings.branch_stiffness[present],
            "branch_time": bushings.branch_time[present],
            **inputs,
        },
        car={
            "viscous": viscous,
            "bends": _bends(rows, jacobian),
            "tyre_rows": vertical,
            **{f"tyre_{kind}": numbers for kind, numbers in tyres.items()},
            "slope": np.zeros((len(damping), 0)) if rolling is None else rolling.slope,
        },
    )


def _bends(rows: Rows, jacobian: Vector) -> tuple[Bend, ...]:
    """Where the laws over displacement leave their tangents."""
    found, e, t = [], rows.layout, rows.layout.tables
    for index, (kind, element, axis, at) in enumerate(zip(t.kinds, t.elements, t.axes, t.at, strict=True)):
        if kind == 0:
            row, name = jacobian[e.bushings.rows[element, axis]], f"{rows.names[element]} along {AXES[axis]}"
        else:
            row = jacobian[e.springs.rows[element]] if kind == 1 else np.eye(rows.model.nv)[e.dampers.dofs[element]]
            name = ("", "spring", "stop of damper")[kind] + f" {element + 1}"
        curve = curve_of(t, index)
        # A point on the line through its neighbours is no corner.
        corners = curve.knots[np.abs(np.diff(curve.slopes)) > 1e-9 * np.max(curve.slopes)]
        edges = np.concatenate([[-np.inf], corners, [np.inf]])
        piece = int(np.searchsorted(edges[1:-1], at))
        plate = list(e.tyres).index(element) if kind == 0 and axis == 2 and element in e.tyres else -1
        steeper = float(np.max(curve.slopes) - curve.slope(at))
        low, high = edges[piece] - at, edges[piece + 1] - at
        found.append(Bend(name=name, row=row, plate=plate, low=low, high=high, steeper=steeper))
    return tuple(found)


def _tangent_stiffness(rows: Rows, compiled: bool) -> Vector:
    """K = -dF/du of all static forces, by central differences."""
    return -differences(rows, lambda data: data.qfrc_passive - data.qfrc_bias + data.qfrc_applied, compiled=compiled)


def differences(rows: Rows, read: Callable[[mujoco.MjData], Vector], *, compiled: bool = True) -> Vector:
    """Central differences of what is read from a state, over the velocity coordinates in the design position.

    Args:
        rows: of the car at rest.
        read: an array of a state whose rows are written, (...); of the step everything is there but the solution.
        compiled: as of `car_matrices`.

    Returns:
        (..., n).
    """
    model = rows.model
    data = mujoco.MjData(model)
    rewrite: Callable[[mujoco.MjModel, mujoco.MjData], None] = rows
    if compiled:
        rewrite = own = compiled_rows(rows)
        own.attach(data)
    start, way, found = data.qpos.copy(), np.zeros(model.nv), []
    for column in range(model.nv):
        ends = []
        for sign in (1.0, -1.0):
            data.qpos[:] = start
            way[column] = sign
            mujoco.mj_integratePos(model, data.qpos, way, DIFFERENCE_STEP)
            # Everything of a step but the solution of the rows, which would cost as much again.
            mujoco.mj_fwdPosition(model, data)
            mujoco.mj_fwdVelocity(model, data)
            rewrite(model, data)
            ends.append(read(data))
        way[column] = 0.0
        found.append((ends[0] - ends[1]) / (2.0 * DIFFERENCE_STEP))
    return np.stack(found, axis=-1)


def _sensors(rows: Rows, data: mujoco.MjData) -> Vector:
    """Rows of the velocities that the sensors of controlled dampers measure."""
    model, own = rows.model, rows.layout.controls
    found = np.zeros((2 * len(own.dampers), model.nv))
    for row, (site, shape) in enumerate(zip(own.sites.ravel(), own.shapes, strict=True)):
        jacobian = np.zeros((3, model.nv))
        mujoco.mj_jacSite(model, data, jacobian, None, int(site))
        jacobian[:, rows.layout.modes.velocities] += shape.reshape(3, -1)
        damper = rows.layout.dampers.dofs[own.dampers[row // 2]]
        found[row] = data.xaxis[model.dof_jntid[damper]] @ jacobian
    return found


def _outputs(model: mujoco.MjModel, data: mujoco.MjData, modes: slice) -> dict[str, Vector]:
    """Rows of all acceleration channels."""
    outputs = {}
    for place in places_of(model):
        jacobian = np.zeros((3, model.nv))
        mujoco.mj_jacSite(model, data, jacobian, None, model.site(f"place/{place}").id)
        shape = numeric(model, f"shape/place/{place}")
        if shape is not None:
            jacobian[:, modes] = shape.reshape(3, -1)
        for axis, row in zip(AXES, jacobian, strict=True):
            outputs[f"{place}_acc_{axis}"] = row
    return outputs


def _body_rows(model: mujoco.MjModel, data: mujoco.MjData) -> dict[str, Vector]:
    found = {}
    for body in range(1, model.nbody):
        if model.body_mocapid[body] < 0 and not model.body(body).name.startswith("mode_"):
            rows = np.zeros((6, model.nv))
            mujoco.mj_jacBodyCom(model, data, rows[:3], rows[3:], body)
            found[model.body(body).name] = rows
    return found


def _body_masses(model: mujoco.MjModel, data: mujoco.MjData) -> dict[str, Vector]:
    found = {}
    for body in range(1, model.nbody):
        if model.body_mocapid[body] < 0 and not model.body(body).name.startswith("mode_"):
            matrix = np.zeros((6, 6))
            matrix[:3, :3] = model.body_mass[body] * np.eye(3)
            frame = data.ximat[body].reshape(3, 3)
            matrix[3:, 3:] = frame @ np.diag(model.body_inertia[body]) @ frame.T
            found[model.body(body).name] = matrix
    return found
