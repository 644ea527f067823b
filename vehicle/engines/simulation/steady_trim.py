"""Static equilibrium of a car in steady acceleration: a car that brakes, drives or holds a bend.

In the axes of the car, which accelerate with a, every mass m_b has the inertia force -m_b a: gravity becomes g - a. The
road answers with the horizontal forces X_i and Y_i of the tyres,

    sum X_i = m a_x,    sum Y_i = m a_y,    sum (x_i Y_i - y_i X_i) = sum m_b (x_b a_y - y_b a_x),

X_i by the shares of brake or drive, Y_i of each axle by its balance about the vertical, of each wheel by its load. X_i
and Y_i act at the contact, on the hub: a brake locks the wheel to its hub for a virtual displacement. A drive torque
X_i R by a shaft turns the hub one way and the part with the differential the other way, which moves X_i to the wheel
centre. In equilibrium the work of all forces is zero for each small motion of the car, which gives the
support of each axle: anti-dive, anti-squat, jacking.

The elements keep the laws of the car at rest, with its preloads f_0: f = f_0 - K r or the curve of the element.
Newton's method finds the position in which J' f + J_c' l and the weight are in equilibrium. Derivatives are differences
of the forces in MuJoCo. Tyres slide, rubber friction is relaxed, wheels do not turn, as at rest (`static_trim`).

Sources: Gillespie, Fundamentals of Vehicle Dynamics, chapters 1, 3 and 7; Milliken, Race Car Vehicle Dynamics,
chapter 17; signs of ISO 8855 in the parameters (x forwards, y to the left), of the hardpoints here.
"""

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.simulation.callbacks import standing_data
from vehicle.engines.simulation.element_records import RubberFriction
from vehicle.engines.simulation.force_curves import curve_of
from vehicle.engines.simulation.force_differences import differences
from vehicle.engines.simulation.moved_car import SCALARS, MovedCar, moved_car
from vehicle.engines.simulation.row_layout import wheels_of
from vehicle.engines.simulation.rows import Rows
from vehicle.engines.simulation.static_trim import StaticTrim, elastic_stiffness
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.model.parameters.driving import driven_wheels
from vehicle.model.parameters.vehicle import Vehicle

MOST_STEPS = 40
"""Maximum number of Newton steps; usually six are enough, more where bump stops come into contact."""

NEAR = 1e-10
"""Largest Newton step [m, rad] in equilibrium: round-off of the positions is some 1e-13."""


def steady_trim(
    vehicle: Vehicle, spec: mujoco.MjSpec, rows: Rows, static: StaticTrim
) -> tuple[mujoco.MjModel, StaticTrim, MovedCar]:
    """Move a car to its equilibrium in steady acceleration.

    Args:
        vehicle: the car, whose `driving` accelerates.
        spec: its specification, moved in place.
        rows: its rows at rest, with preloads.
        static: its static loads at rest.

    Returns:
        Compiled model in the new position, loads and preloads there, and the position.

    Raises:
        ConfigurationError: a tyre would slide or lift off, or the car stands on blocks.
        SimulationError: no equilibrium was found.
    """
    driving = vehicle.driving
    if vehicle.gravity == 0.0:
        raise ConfigurationError(f"{_named(vehicle)}: without gravity no tyre has a load and so no grip; set gravity")
    # Hardpoints have x to the rear and y to the right.
    acceleration = np.array([-driving.acceleration, -driving.lateral, 0.0])
    gravity = np.array([0.0, 0.0, -vehicle.gravity]) - acceleration
    design, joints = rows.model, rows.layout.joints.ravel()
    position, reactions, preload = design.qpos0.copy(), static.preload[joints], static.preload
    for _ in range(MOST_STEPS):
        moved = moved_car(rows, position, gravity, preload)
        moved.place(spec)
        model = spec.compile()
        model.qpos_spring[:] = design.qpos_spring
        for joint in range(design.njnt):
            if str(design.joint(joint).name).startswith(SCALARS):
                model.qpos_spring[design.jnt_qposadr[joint]] -= position[design.jnt_qposadr[joint]]
        preload = _element_forces(rows, position)
        preload[joints] = reactions
        _set_contacts(vehicle, rows, model, preload, acceleration)
        step, reaction = _newton_step(Rows(model, preload))
        if np.max(np.abs(step)) < NEAR:
            return model, _static(vehicle, rows, preload, float(np.max(np.abs(step)))), moved
        mujoco.mj_integratePos(design, position, step, 1.0)
        reactions = reactions - reaction
        if not np.all(np.isfinite(position)) or np.max(np.abs(step)) > 1e3:
            break
    raise SimulationError(
        f"{_named(vehicle)}: found no equilibrium of the car; it would tip over, or a spring or stop is outside its "
        "range; try a smaller acceleration"
    )


def _element_forces(rows: Rows, position: Vector) -> Vector:
    """Return the element forces in a position, by the laws at rest, as preloads without reactions of joints."""
    e, fresh, data = rows.layout, rows.anew(), mujoco.MjData(rows.model)
    data.qpos[:] = position
    mujoco.mj_fwdPosition(rows.model, data)
    mujoco.mj_fwdVelocity(rows.model, data)
    fresh(rows.model, data)
    preload, state = rows.weights.preload.copy(), fresh.state
    preload[e.bushings.rows] -= elastic_stiffness(e) * state.residual
    lines = state.ends[1::2] - state.ends[::2]
    extension = np.sqrt(np.sum(lines**2, axis=1)) - e.springs.lengths
    preload[e.springs.rows] -= e.springs.stiffness * extension
    t = e.tables
    for index, (law_type, element, axis) in enumerate(zip(t.kinds, t.elements, t.axes, strict=True)):
        if law_type == 0:
            at = t.at[index] + state.residual[element, axis]
            preload[e.bushings.rows[element, axis]] = -float(curve_of(t, index).force(at))
        elif law_type == 1:
            preload[e.springs.rows[element]] = -float(curve_of(t, index).force(t.at[index] + extension[element]))
    return preload


def _newton_step(rows: Rows) -> tuple[Vector, Vector]:
    """Return the step u to the equilibrium, and the change of the joint reactions.

    K u + J_c' l = f and J_c u = -gap, in the moved position. Sliding tyres leave the place of the car and its heading
    free, and the balance of all forces fulfils the equations of the body along x and y and in yaw: the rows there
    state u = 0, and in yaw the rotation back to the heading at rest.
    """
    e, model = rows.layout, rows.model
    stiffness = elastic_stiffness(e)
    stiffness[e.tyres, :2] = 0.0
    rubber = e.rubber
    none = RubberFriction(rubber.elements[:0], rubber.axes[:0], rubber.stiffness[:0], rubber.limit[:0])
    soft = rows.anew()
    soft.layout = e._replace(bushings=e.bushings._replace(stiffness=stiffness), rubber=none)
    matrix = -differences(soft, lambda data: data.qfrc_passive - data.qfrc_bias + data.qfrc_applied)
    data = standing_data(rows)
    force = data.qfrc_passive - data.qfrc_bias + data.qfrc_applied
    force[e.dampers.dofs] -= e.dampers.laws["rest_force"]
    ideal = e.joints.ravel()
    hard, gap = data.efc_J.reshape(e.row_count, model.nv)[ideal], data.efc_pos[ideal]
    system = np.block([[matrix, hard.T], [hard, np.zeros((len(hard), len(hard)))]])
    frame, first = data.xmat[e.modes.body], int(model.joint("body").dofadr[0])
    # Wheels do not turn.
    held = [*e.rolling.spins.tolist(), first, first + 1, first + 5]
    system[held], force[held] = 0.0, 0.0
    system[held, held] = 1.0
    force[first + 5] = -np.arctan2(frame[3], frame[0])
    # Scaled to equal diagonals, as in the trim at rest.
    scale = np.ones(len(system))
    scale[: model.nv] = 1.0 / np.sqrt(np.maximum(np.abs(np.diag(system)[: model.nv]), 1.0))
    try:
        solved = np.linalg.solve(system * scale[:, None] * scale[None, :], scale * np.concatenate([force, -gap]))
    except np.linalg.LinAlgError as error:
        raise SimulationError(f"steady acceleration: the car can move without resistance ({error})") from None
    solution = scale * solved
    return solution[: model.nv], solution[model.nv :]


def _set_contacts(vehicle: Vehicle, rows: Rows, model: mujoco.MjModel, preload: Vector, acceleration: Vector) -> None:
    """Write the horizontal forces of the tyres into the preloads of a moved car."""
    e, data = rows.layout, mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    bodies = [
        body
        for body in range(1, model.nbody)
        if model.body_mocapid[body] < 0 and not str(model.body(body).name).startswith(SCALARS)
    ]
    masses, centres = model.body_mass[bodies], data.xipos[bodies]
    wheels, tyre_rows = wheels_of(model), e.bushings.rows[e.tyres]
    axles = {wheel.name: wheel.axle for wheel in vehicle.composition.wheels}
    names = list(dict.fromkeys(axles.values()))
    load = np.maximum(preload[tyre_rows[:, 2]], 0.0)
    # A tyre touches the ground at the site of its plate.
    points = np.array([data.site_xpos[model.eq_obj2id[model.equality(rows.names[tyre]).id]] for tyre in e.tyres])
    shares = driven_wheels(vehicle.driving, vehicle.composition.wheels)
    along = float(masses.sum()) * acceleration[0] * np.array([shares[wheel] for wheel in wheels])
    # Y_i of the two axles: balance of forces, and of moments about the vertical.
    weights = np.array([[load[k] * (axles[wheel] == name) for k, wheel in enumerate(wheels)] for name in names])
    weights /= np.maximum(weights.sum(axis=1, keepdims=True), 1.0)
    arms = weights @ points[:, 0]
    moment = masses @ (centres[:, 0] * acceleration[1] - centres[:, 1] * acceleration[0]) + points[:, 1] @ along
    both = np.linalg.solve(np.stack([np.ones(2), arms]), [masses.sum() * acceleration[1], moment])
    preload[tyre_rows[:, 0]], preload[tyre_rows[:, 1]] = along, both @ weights


def _static(vehicle: Vehicle, rows: Rows, preload: Vector, residual: float) -> StaticTrim:
    """Return the static loads, checked; raises like `steady_trim`."""
    force = preload[rows.layout.bushings.rows[rows.layout.tyres]]
    wheels, friction = wheels_of(rows.model), vehicle.driving.friction
    for wheel, (x, y, z) in zip(wheels, force.tolist(), strict=True):
        if z <= 0.0:
            raise ConfigurationError(
                f"{_named(vehicle)}: wheel {wheel} would lift off its plate, so the car would tip over; set a smaller "
                "acceleration, or check body.cog"
            )
        needed = float(np.hypot(x, y)) / z
        if needed > friction:
            raise ConfigurationError(
                f"{_named(vehicle)}: tyre {wheel} would need a friction coefficient of {needed:.3g} at its load of "
                f"{z:.0f} N, but driving.friction is {friction:g}; set a smaller acceleration, or another share by "
                "driving.brake_balance or driving.driven_axle"
            )
    return StaticTrim(
        preload=preload,
        tyre_load=dict(zip(wheels, force[:, 2].tolist(), strict=True)),
        support_load={},
        residual=residual,
        tyre_grip={wheel: float(np.hypot(x, y)) for wheel, (x, y, _) in zip(wheels, force, strict=True)},
    )


def _named(vehicle: Vehicle) -> str:
    """Return parameter and value of the acceleration, for messages."""
    driving = vehicle.driving
    values = {"acceleration": driving.acceleration, "lateral": driving.lateral}
    return ", ".join(f"driving.{name} {value:g} m/s2" for name, value in values.items() if value)
