"""Second order of the motion of a car: products of the linear motion as forces on the linear car.

The equations of motion of the car in its coordinates u (velocity coordinates of MuJoCo, small rotations as rotation
vectors) are R(u, u', u'', f_b, l, z, z') = 0 with the joints g(u) = 0, l being the forces of the joints and f_b those
of the Maxwell branches, f_b' = K2 r(u, u') - f_b/tau. With u = u1 + u2 and the linear motion u1, the second order is

    M u2'' + C u2' + K u2 + H' f_b2 - Jc' l2 = -R_2,    Jc u2 = -g_2,    f_b2' = K2 (e u2' + g u2 + r_2) - f_b2/tau,
    y_2 = L u2 + y_2(u1),

with index 2 for what is quadratic in the linear motion: half the sum of a function at the motion and at the reversed
motion, less that at rest. MuJoCo supplies kinematics and inertia, the compiled rows the laws; neither the constraint
solver nor the integrator of MuJoCo takes part. Source: regular perturbation, Nayfeh and Mook, Nonlinear Oscillations,
1979, chapter 2.
"""

import copy
from typing import Any, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.first_order import free_basis
from vehicle.engines.linear.system import LinearSystem
from vehicle.engines.simulation.recorded_acceleration import AHEAD, WEIGHTS
from vehicle.engines.simulation.row_layout import numeric, places_of
from vehicle.engines.simulation.rows import Rows
from vehicle.names import AXES
from vehicle.runs.car import Car

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]

NO_STEP = 1e-7
"""Time step of the laws [s]: so short that all forces of the rows are explicit."""


class Motion(NamedTuple):
    """Periodic linear motion at samples, (..., samples) each: u, u', u'', f_b, z, z', V tan(beta), joint forces l."""

    displacement: Vector
    velocity: Vector
    acceleration: Vector
    branch: Vector
    height: Vector
    height_rate: Vector
    slope: Vector
    joints: Vector


class Products(NamedTuple):
    """Quadratic parts at samples, (..., samples) each: generalised force R, gaps g, branch rates r, places y."""

    force: Vector
    gaps: Vector
    rates: Vector
    places: Vector


def _branch_gain(system: LinearSystem, s: complex) -> tuple[Complex, Vector, Vector]:
    """Return K2/(s + 1/tau), (b,), and the rows e and g of the rates of the branches, (b, n)."""
    drifts = np.zeros_like(system.branch_rows) if system.branch_drifts is None else system.branch_drifts
    return system.branch_stiffness / (s + 1.0 / system.branch_time), system.branch_rows, drifts


def _stiffness(system: LinearSystem, s: complex, damping: Vector) -> Complex:
    """Return the dynamic stiffness s^2 M + s C + K with the Maxwell branches; (n, n)."""
    gain, rows, drifts = _branch_gain(system, s)
    branches = (system.effects.T * gain) @ (s * rows + drifts)
    return np.asarray(s * s * system.mass + s * damping + system.stiffness + branches)


def linear_motion(
    matrices: CarMatrices,
    height: Vector,
    interval: float,
    *,
    friction: Vector | None = None,
    slope: Vector | None = None,
) -> Motion:
    """Return the periodic motion of the linear car.

    Args:
        matrices: matrices of the car.
        height: displacements of the plates without their means [m]; (w, samples).
        interval: sampling interval [s].
        friction: nonlinear forces of the dampers, against their velocity [N]; (d, samples).
        slope: V tan(beta) of the road under rolling tyres [m/s], z' by default; (w, samples).
    """
    system, samples = matrices.system, height.shape[1]
    basis, s = free_basis(system), 2j * np.pi * np.fft.rfftfreq(samples, interval)
    z = np.fft.rfft(height, axis=1)
    forces = system.input_stiffness @ z + system.input_damping @ (s * z)
    if friction is not None:
        forces -= system.slide_rows.T @ np.fft.rfft(friction, axis=1)
    rising = s * z if slope is None else np.fft.rfft(slope, axis=1)
    if matrices.slope.size:
        forces += matrices.slope @ (rising - s * z)
    u = np.zeros((system.size, s.size), dtype=complex)
    branch = np.zeros((system.branch_time.size, s.size), dtype=complex)
    significant = np.max(np.abs(forces), axis=0) > 1e-12 * np.max(np.abs(forces))
    for line in np.flatnonzero(significant & (s.imag > 0.0)).tolist():
        stiffness = basis.T @ _stiffness(system, s[line], system.damping) @ basis
        u[:, line] = basis @ np.linalg.solve(stiffness, basis.T @ forces[:, line])
        gain, rows, drifts = _branch_gain(system, s[line])
        branch[:, line] = gain * ((s[line] * rows + drifts) @ u[:, line])
    needed = system.mass @ (s**2 * u) + system.damping @ (s * u) + system.stiffness @ u + system.effects.T @ branch
    joints = np.linalg.pinv(system.constraints.T) @ (needed - forces)
    spectra = (u, s * u, s**2 * u, branch, z * (s.imag > 0.0), s * z, rising, joints)
    return Motion(*(np.fft.irfft(spectrum, samples, axis=1) for spectrum in spectra))


class Equations:
    """Equations of motion of a car, evaluated in MuJoCo at any position, velocity and acceleration.

    Args:
        car: car without one-sided tyres and displacement tables.
    """

    def __init__(self, car: Car) -> None:
        self.model = copy.copy(car.model.model)
        self.model.opt.timestep = NO_STEP
        self.rows, self.slope = Rows(self.model, car.model.static.preload), car.matrices.slope
        self.data = mujoco.MjData(self.model)
        self.start, self.level = self.data.qpos.copy(), self.data.mocap_pos[:, 2].copy()
        self.joints = self.rows.layout.joints.ravel()
        self.present = self.rows.layout.bushings.branch_stiffness > 0.0
        model = self.model
        self.turning = [
            int(model.jnt_dofadr[joint]) + (3 if kind == mujoco.mjtJoint.mjJNT_FREE else 0)
            for joint, kind in enumerate(map(mujoco.mjtJoint, model.jnt_type.tolist()))
            if kind in (mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_BALL)
        ]
        self.places = [
            (model.site(f"place/{place}").id, numeric(model, f"shape/place/{place}")) for place in places_of(model)
        ]
        self.channels = [f"{place}_acc_{axis}" for place in places_of(model) for axis in AXES]

    def at(
        self, motion: Motion, sample: int, sign: float, present_load: bool = True
    ) -> tuple[Vector, Vector, Vector, Vector]:
        """Return R, gaps, rates of the branches and places at a sample of a motion times +1, 0 or -1.

        Without the present load, the static loads act on the slopes of the road, at the displaced wheels.
        """
        model, data, state = self.model, self.data, self.rows.state
        u, v, a, branch, z, rate, slope, joints = (sign * values[:, sample] for values in motion)
        velocity, acceleration = v.copy(), a.copy()
        for first in self.turning:
            # Angular velocity of the rotation exp(theta) in axes of the body: theta' - theta x theta'/2 + ...
            angle = slice(first, first + 3)
            velocity[angle] -= 0.5 * np.cross(u[angle], v[angle])
            acceleration[angle] -= 0.5 * np.cross(u[angle], a[angle])
        data.qpos[:], data.qvel[:], data.time = self.start, velocity, 0.0
        mujoco.mj_integratePos(model, data.qpos, u, 1.0)
        data.mocap_pos[:, 2] = self.level + z
        state.plate_velocity[:, 2], state.slope_velocity[:] = rate, slope
        state.last_time[0] = -1.0
        state.branch_past[:], state.branch_past[self.present] = 0.0, branch
        state.branch_force[:] = state.branch_past
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_fwdVelocity(model, data)
        # The law extrapolates it from the last time, which is the present.
        state.turning[:, :3] = data.cvel[self.rows.layout.rolling.hubs, :3]
        self.rows(model, data)
        inertia = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, inertia)
        jacobian = data.efc_J.reshape(-1, model.nv)[self.joints]
        force = inertia @ acceleration - jacobian.T @ joints
        force -= data.qfrc_passive - data.qfrc_bias + data.qfrc_applied
        rates, rolling, modes = state.rate.copy(), self.rows.layout.rolling, self.rows.layout.modes
        if not present_load:
            static = self.rows.weights.preload[self.rows.layout.bushings.rows[rolling.tyres, 2]]
            change = state.force[rolling.tyres, 2] / static - 1.0
            force += self.slope[:, rolling.plates] @ (change * slope[rolling.plates])
        # At t = 0 the laws leave out the heading of rolling wheels.
        rates[rolling.tyres, 1] += rolling.speeds * state.heading[0]
        turn, modal = data.xmat[modes.body].reshape(3, 3), data.qpos[modes.positions]
        places = [
            data.site_xpos[site] + (0.0 if shape is None else turn @ (shape.reshape(3, -1) @ modal))
            for site, shape in self.places
        ]
        return force, data.efc_pos[self.joints].copy(), rates[self.present], np.concatenate(places)

    def products(self, motion: Motion, every: int = 1, present_load: bool = True) -> Products:
        """Return the quadratic parts of a motion at each `every`-th sample."""
        rest = self.at(motion, 0, 0.0)
        parts = [
            [
                0.5 * (ahead + back) - still
                for ahead, back, still in zip(
                    *(self.at(motion, sample, sign, present_load) for sign in (1.0, -1.0)), rest, strict=True
                )
            ]
            for sample in range(0, motion.height.shape[1], every)
        ]
        return Products(*(np.array(part).T for part in zip(*parts, strict=True)))


def second_order(
    car: Car,
    motion: Motion,
    interval: float,
    *,
    every: int = 1,
    damping: Vector | None = None,
    highest: float = 150.0,
    present_load: bool = True,
) -> dict[str, Vector]:
    """Return the second order of all acceleration channels, defined as in `recorded_acceleration`.

    Args:
        car: the car.
        motion: its periodic linear motion.
        interval: sampling interval of the motion and of the result [s].
        every: samples from one evaluation of the equations to the next; the products contain nothing above
            1/(2 every interval).
        damping: constants of further viscous dampers in the place of friction [N s/m]; (d,).
        highest: highest frequency of the response [Hz].
        present_load: False if the change of the load on slopes is left out, as it is in the reduced engine.

    Returns:
        Channel to acceleration [m/s2]; (samples,).
    """
    equations, system, samples = Equations(car), car.matrices.system, motion.height.shape[1]
    force, gaps, rates, places = (
        np.fft.rfft(part, axis=1) * every for part in equations.products(motion, every, present_load)
    )
    s = 2j * np.pi * np.fft.rfftfreq(samples, interval)[: force.shape[1]]
    total = system.damping.copy()
    if damping is not None:
        total += system.slide_rows.T @ (damping[:, None] * system.slide_rows)
    basis, fit = free_basis(system), np.linalg.pinv(system.constraints)
    rows = np.array([system.outputs[channel][: system.size] for channel in equations.channels])
    response: Any = np.zeros((len(rows), samples // 2 + 1), dtype=complex)
    for line in np.flatnonzero((s.imag > 0.0) & (s.imag < 2.0 * np.pi * highest)).tolist():
        stiffness, gain = _stiffness(system, s[line], total), _branch_gain(system, s[line])[0]
        load, shift = -force[:, line] - system.effects.T @ (gain * rates[:, line]), -fit @ gaps[:, line]
        free = np.linalg.solve(basis.T @ stiffness @ basis, basis.T @ (load - stiffness @ shift))
        response[:, line] = rows @ (basis @ free + shift) + places[:, line]
    phase = np.outer(np.arange(-AHEAD, AHEAD + 1), 2j * np.pi * np.arange(response.shape[1]) / samples)
    response *= np.real(WEIGHTS @ np.exp(phase)) / interval**2
    return dict(zip(equations.channels, np.fft.irfft(response, samples, axis=1), strict=True))
