"""Records of a time step: weights of the rows, state of the laws."""

from typing import NamedTuple

from vehicle.arrays import Vector
from vehicle.engines.simulation.element_records import Table


class Weights(NamedTuple):
    """Weights of the rows for a time step; arrays over the elements as in `Layout`.

    `preload` contains the static force of every row in element axes [N], followed by the static torques of the
    rotations in the axes of their carriers [N m]; (rows + 3 m,). `decay`, `gain`, `slope` and `average` belong to the
    Maxwell branches, (n, 3); `inertial` is the averaged stiffness of the tyres beta K h2, along x
    with the branch of the slip, (t, 3).
    """

    timestep: float
    preload: Vector
    decay: Table
    gain: Table
    slope: Table
    average: Table
    impedance: Table
    inertial: Table
    spring_impedance: Vector
    damper_impedance: Vector
    valve_impedance: Vector


class State(NamedTuple):
    """State variables and results of the laws; arrays over the elements as in `Layout`.

    Attributes:
        plate_velocity, plate_acceleration: motion of the plates, an input; (t, 3).
        slope_velocity: speed times slope of the road at the tyres [m/s], an input; (t,).
        branch_past: part of the branch forces f2 that is independent of the acceleration of the step; (n, 3).
        branch_force: f2 at the last completed step; (n, 3).
        last_rate: r' at the last completed step; (n, 3). last_time: time of that step [s], -1 at rest; (1,).
        residual, rate: r [m] and r' [m/s] in element axes; (n, 3).
        explicit: f0 of every row [N]; (rows,).
        force: f0 in element axes; (n, 3). torque: torques of the rotations in world axes; (m, 3).
        frame: frames at the nodes with rotational mode shapes, row by row; (k, 9).
        ends, line: lower and upper ends of the main springs with their modal displacement, and their directions.
        stretch: displacement of the nonlinear laws; (t,).
        deflection: modal displacement and velocity of the nodes in body axes; (2, 3 g).
        modal: modal coordinates and their velocities at the last evaluation; (2, modes).
        modal_force, modal_rate, modal_pull: spring force, velocity and attachment force over the last step, of the
            reduced modal coordinates; (r,), empty if the model contains the modes.
        heading: heading of the rolling wheels [rad], present and previous; (2, w).
        turning: angular velocity of the hubs [rad/s], present x, y, z and previous; (w, 6).
        slope: explicit force along x [N] and moment [N m] on the hubs; (w, 4).
        push: generalised force of all explicit and applied forces; (nv,), empty for a car on a shaker without them.
        contact: elastic force of one-sided elements [N], and r' at the last evaluation [m/s]; (2, k).
        rubber: forces of the Jenkins elements of the bushings [N] and their displacements [m], at the present time and
            then at the previous time; (4, m).
        slider: forces of the Jenkins elements of the dampers at the present and the previous time [N]; (2, m).
        stroke, limit: displacement [m] and friction limit [N] of the dampers at the present time; (w,).
        coefficient: damping coefficient c of the dampers [N s/m]; (w,).
        sensed: velocities at the sensors in the middle of the last two steps [m/s], latest first; (2 k, 2).
        past: memory of the controlled dampers, see `vehicle.model.laws.control_laws`; (k, ...).
        steps: index of the present step; (1,).
        speeds: velocities [m/s] of the dampers by address at the present time and at the last one; (k, 2).
        applied: applied forces at the present time, averaged over three steps [N or N m]; (f,).
    """

    plate_velocity: Table
    plate_acceleration: Table
    slope_velocity: Vector
    branch_past: Table
    branch_force: Table
    last_rate: Table
    last_time: Vector
    residual: Table
    rate: Table
    explicit: Vector
    force: Table
    torque: Table
    frame: Table
    ends: Table
    line: Table
    stretch: Vector
    deflection: Table
    modal: Table
    modal_force: Vector
    modal_rate: Vector
    modal_pull: Vector
    heading: Table
    turning: Table
    slope: Table
    push: Vector
    contact: Table
    rubber: Table
    slider: Table
    stroke: Vector
    limit: Vector
    coefficient: Vector
    sensed: Table
    past: Table
    steps: Vector
    speeds: Table
    applied: Vector
