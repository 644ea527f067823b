"""Recorder of a run: stores the state of every recorded step and computes channels and energies chunk by chunk."""

from collections.abc import Sequence

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.compiled import SteppingLoop
from vehicle.engines.simulation.damper_force import damper_forces, has_stops, stop_forces
from vehicle.engines.simulation.force_curves import curve_of
from vehicle.engines.simulation.load_channels import LoadPlaces, slope_forces, spring_coordinates
from vehicle.engines.simulation.plate_arrays import PlateArrays
from vehicle.engines.simulation.recorded_acceleration import AHEAD, acceleration
from vehicle.engines.simulation.recording import Energies, Recording, Statistics
from vehicle.engines.simulation.row_layout import numeric
from vehicle.engines.simulation.rows import Rows, joint_dampers
from vehicle.engines.simulation.sampling import Samples, empty_samples
from vehicle.engines.simulation.structures import offsets
from vehicle.engines.simulation.tyre_contact import lift_off_notices, pulling_tyres
from vehicle.mapped_table import release, table_of
from vehicle.names import AXES, channel_units
from vehicle.signals.excitation.signal import Signal, uniform_time

CHUNK = 512
"""Number of samples between two flushes of the buffers, state checks and progress calls."""


class Recorder:
    """Buffers, channels and energy sums of a run.

    Args:
        car: car of the run.
        model, data: prepared model and state.
        rows: rows of the model.
        samples: number of recorded samples.
        every: steps between two recorded samples.
        pose_every: samples between two stored poses.
        requested: names of additional channels: loads and damper settings.
    """

    def __init__(
        self,
        car: CarModel,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        rows: Rows,
        *,
        samples: int,
        every: int,
        pose_every: int,
        requested: Sequence[str] = (),
    ) -> None:
        self.car, self.model, self.data, self.rows = car, model, data, rows
        self.step = model.opt.timestep
        self.samples, self.every, self.pose_every = samples, every, pose_every
        e, modes = rows.layout, rows.layout.modes
        self.shapes = {}
        self.places = [output.name for output in car.vehicle.composition.outputs]
        self.wheels, self.dampers = car.vehicle.wheels, [damper.name for damper in car.vehicle.composition.dampers]
        for point in self.places:
            shape = numeric(car.model, f"shape/place/{point}")
            if shape is not None:
                self.shapes[point] = shape.reshape(3, -1)
        self.settings = [name for name in requested if name in car.vehicle.setting_channels]
        loads = [name for name in requested if name not in self.settings]
        self.loads = LoadPlaces(car, rows, loads) if loads else None
        joints = spring_coordinates(car, model)
        strokes = np.column_stack([e.dampers.places, e.dampers.dofs])[: len(self.dampers) * has_stops(e)]
        self.sites = np.array([model.site(f"place/{point}").id for point in self.places], dtype=np.int64)
        # Joints with a spring, and fluids: their velocities are needed for the energy.
        self.spring_dofs = np.concatenate([joints[:, 1], np.unique(e.fluids.dofs)])
        # Views of mjData and of the state of the rows, and indices into them, from which a sample is copied.
        self.sources = {
            "position": data.qpos,
            "velocity": data.qvel,
            "acceleration": data.qacc,
            "orientation": data.xmat,
            "origins": data.xpos,
            "site_positions": data.site_xpos,
            "sites": self.sites,
            "actuator": data.actuator_force,
            "dampers": e.dampers.dofs,
            "branch": rows.state.branch_past,
            "spring_rates": self.spring_dofs,
            # Bodies whose frames the loads need; coordinates of dampers with stops, then of springs that loads need.
            "load_bodies": joints[:0, 0].copy() if self.loads is None else self.loads.bodies,
            "load_springs": np.concatenate([strokes, joints[: len(joints) * bool(loads)]]),
            "space": e.space,
        }
        of_state = ("coefficient", "explicit", "rate", "modal", "modal_force", "contact", "rubber", "heading", "push")
        self.sources |= {name: getattr(rows.state, name) for name in of_state}
        self.buffers = empty_samples(CHUNK, self.sources)
        located = offsets()
        self.order = {
            "step": located.step,
            "model": model._address,
            "data": data._address,
            "force_offset": located.pointers["efc_force"],
            "every": every,
            "pose_every": pose_every,
            "body": modes.body,
            "first_velocity": modes.first_velocity,
            "half": -0.5 * self.step,
        }
        # Accelerations are positions during the run, AHEAD samples longer; differentiated twice at the end.
        names, moving = [*car.vehicle.channels, *requested], car.vehicle.acceleration_channels
        self.table = table_of((len(names), samples + AHEAD))
        self.channels = {
            name: row if name in moving else row[:samples] for name, row in zip(names, self.table, strict=True)
        }
        # Finished poses, the sample index of every pose, and the poses of the samples in the buffers.
        self.poses = np.zeros((-(-samples // pose_every), car.model.nq))
        self.pose_index: list[int] = []
        self.new_poses: list[Vector] = []
        self.filled = 0
        self.done = 0
        self.work_in = 0.0
        self.lifting = 0.0
        self.dissipated = 0.0
        self.last_powers: tuple[float, float] | None = None
        self.energy_at_start: float | None = None
        self.rubber_at_end = 0.0

    def before_step(self) -> None:
        """Store the present pose, which the step will overwrite."""
        if (self.done + self.filled) % self.pose_every == 0:
            self.new_poses.append(self.data.qpos.copy())
            self.pose_index.append(self.done + self.filled)

    def after_step(self, loop: SteppingLoop, *, moved: bool) -> None:
        """Store the sample of the present time; `moved` is True after a step, False after an evaluation."""
        half = -0.5 * self.step if moved else 0.5 * self.step
        loop.keep_sample(self.filled, half)
        self.filled += 1
        if self.energy_at_start is None or not moved:
            energy = self._stored_energy(half)
            if self.energy_at_start is None:
                self.energy_at_start = energy
            self.energy_at_end = energy

    def keep(self, last: int, posed: int) -> None:
        """Register the samples up to step `last` from the loop, and copy the `posed` new poses."""
        samples = np.arange(self.done + self.filled, last // self.every + 1)
        self.filled += len(samples)
        self.new_poses.extend(self.buffers.poses[:posed].copy())
        self.pose_index.extend(int(sample) for sample in samples[samples % self.pose_every == 0])

    def finite_samples(self) -> int:
        """Return the number of buffered samples before the first nonfinite sample."""
        finite = np.all(np.isfinite(self.buffers.solved[: self.filled]), axis=1)
        return self.filled if finite.all() else int(np.argmin(finite))

    def last_pose(self, good: int) -> tuple[float, Vector]:
        """Return time [s] and position of the last stored pose before sample `good` of the buffers."""
        last = max(self.done + good - 1, 0)
        index = max((i for i, sample in enumerate(self.pose_index) if sample <= last), default=0)
        return self.pose_index[index] / self.car.vehicle.solver.record_rate, self._pose(index)

    def _pose(self, index: int) -> Vector:
        """Return a stored pose with all modal coordinates, for samples in the buffers from `modal_position`."""
        new = index - (len(self.pose_index) - len(self.new_poses))
        if new < 0:
            return np.array(self.poses[index])
        return self.rows.whole(self.new_poses[new], self.buffers.modal_position[self.pose_index[index] - self.done])

    def _stored_energy(self, half: float) -> float:
        """Return the kinetic, elastic and gravity energy [J] at present; store the energy of the rubber friction."""
        # Use the generated model: the armature of the integration is not a mass of the car.
        model, rows = self.car.model, self.rows
        e, state, preload = rows.layout, rows.state, rows.weights.preload
        b, springs = e.bushings, e.springs
        data = mujoco.MjData(model)
        last = self.filled - 1
        modal = self.buffers.modal_position[last], self.buffers.modal_velocity[last]
        data.qpos[:] = rows.whole(self.data.qpos if half > 0.0 else self.new_poses[-1], modal[0])
        data.qvel[:] = rows.whole(self.data.qvel + half * self.data.qacc, modal[1])
        data.mocap_pos[:] = self.data.mocap_pos
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_energyPos(model, data)
        mujoco.mj_energyVel(model, data)
        residual, ground = state.residual.copy(), b.one_sided
        # A contact that lifts off keeps the energy of its unloaded spring, r = p/K.
        residual[ground, 2] = np.minimum(residual[ground, 2], preload[b.rows[ground, 2]] / b.stiffness[ground, 2])
        # Static forces of rolling tyres along the road do work over their slip, see `flush`: no potential.
        residual[e.rolling.tyres, :2] = 0.0
        # Potential of f = p - K r: K r^2/2 - p r.
        elastic = 0.5 * np.sum(b.stiffness * residual**2) - np.sum(preload[b.rows] * residual)
        turned, frames = rows.rotation(self.data)
        # sin(angle) n in the axes of the carrier, and the potential of T = T_0 - K_rot sin(angle) n, likewise.
        twist = np.einsum("nji,nj->ni", frames, turned)
        elastic += 0.5 * np.sum(e.rotations.stiffness[:, None] * twist**2) - np.sum(
            preload[e.row_count :] * twist.ravel()
        )
        # Lower and upper ends alternate.
        lines = state.ends[1::2] - state.ends[::2]
        extension = np.sqrt(np.sum(lines**2, axis=1)) - springs.lengths
        elastic += np.sum(0.5 * springs.stiffness * extension**2 - preload[springs.rows] * extension)
        for k, (law_type, element, axis) in enumerate(
            zip(e.tables.kinds, e.tables.elements, e.tables.axes, strict=True)
        ):
            curve, at, x = curve_of(e.tables, k), e.tables.at[k], state.stretch[k]
            # The sums above have the tangent K of this law: add what its curve differs by. Stops and seats are in no
            # sum.
            elastic += curve.energy(x) - curve.energy(at)
            if law_type < 2:
                tangent = b.stiffness[element, axis] if law_type == 0 else springs.stiffness[element]
                elastic -= float(curve.force(at)) * (x - at) + 0.5 * tangent * (x - at) ** 2
        rubber, (friction, strain) = e.rubber.stiffness, state.rubber[:2]
        self.rubber_at_end = 0.5 * float(np.sum(friction**2 / rubber))
        # K contains the stiffness k of the Jenkins elements: their springs t^2/(2 k) in place of k r^2/2.
        elastic += self.rubber_at_end - 0.5 * np.sum(rubber * strain**2)
        branch = self._branch_force(self.data.efc_force[None, :], state.branch_past[None])[0]
        present = b.branch_stiffness > 0.0
        # Spring of a branch: f2^2/(2 K2).
        elastic += 0.5 * np.sum(branch[present] ** 2 / b.branch_stiffness[present])
        return float(data.energy[0] + data.energy[1] + elastic)

    def _row_acceleration(self, solved: Vector) -> Vector:
        """Return the acceleration of the element rows, from f = -D J a; (chunk, n, 3)."""
        # The rotation between world and element axes is neglected.
        return np.asarray(-solved[:, self.rows.layout.bushings.rows] / self.rows.weights.impedance)

    def _branch_force(self, solved: Vector, past: Vector) -> Vector:
        """Return the force of the Maxwell branches; (chunk, n, 3)."""
        return past + self.rows.weights.slope * self._row_acceleration(solved)

    def flush(self, motion: PlateArrays, index: int, every: int) -> None:
        """Compute channels and energies of the buffered samples and clear the buffers."""
        count, b = self.filled, Samples(*(array[: self.filled] for array in self.buffers))
        # Samples of the record, and the steps of the block at which they were taken.
        chunk = slice(self.done, self.done + count)
        steps = slice(index - (count - 1) * every, index + 1, every)
        self._keep_positions(chunk, b.places, b.turn, b.modal_position)
        for pose in range(len(self.pose_index) - len(self.new_poses), len(self.pose_index)):
            self.poses[pose] = self._pose(pose)
        self.new_poses.clear()
        e, bushings = self.rows.layout, self.rows.layout.bushings
        # Force of a row: f = f0 - D J a, its explicit part and what the solver gave.
        total = b.solved + b.explicit
        damper_force = damper_forces(b.actuator, total, e)
        stop_force, strokes = np.zeros_like(damper_force), 2 * len(self.dampers) * has_stops(e)
        if strokes:
            stop_force = stop_forces(b.load_springs[:, :strokes:2], e)
        velocity = motion.velocity[steps]
        tyre = total[:, bushings.rows[e.tyres][:, 2]]
        for column, damper in enumerate(self.dampers):
            self.channels[f"{damper}_velocity"][chunk] = b.damper_velocity[:, column]
            self.channels[f"{damper}_force"][chunk] = damper_force[:, column] + stop_force[:, column]
        for column, wheel in enumerate(self.wheels):
            self.channels[f"tyre_{wheel}_force_z"][chunk] = tyre[:, column]
            self.channels[f"plate_{wheel}_displacement"][chunk] = motion.displacement[steps, column]
        for name in self.settings:
            self.channels[name][chunk] = b.coefficient[:, self.dampers.index(name.removesuffix("_coefficient"))]
        if self.loads is not None:
            stops = dict(zip(self.dampers, stop_force.T, strict=True))
            on_slope = slope_forces(b.explicit, motion.slope_velocity[steps], e)
            slopes = {self.wheels[plate]: force for plate, force in zip(e.rolling.plates, on_slope.T, strict=True)}
            springs = b.load_springs[:, strokes:]
            for name, values in self.loads.channels(total, b.load_frames, springs, stops, slopes).items():
                self.channels[name][chunk] = values
        # Energy balance of twelve terms: 1, 2 and 6 to 8 are put in, the others dissipated. (1) Dynamic tyre load times
        # plate velocity. (2) Static load times rise of the plates: exact and much larger than what is dissipated, so
        # kept out of the sum of powers.
        static = self.rows.weights.preload[bushings.rows[e.tyres, 2]]
        power_in = np.sum((tyre - static) * velocity, axis=1)
        if self.done == 0:
            self.start = motion.displacement[0].copy()
        self.lifting = float(static @ (motion.displacement[index] - self.start))
        # MuJoCo's rate is that of the middle of the past step: half a step of J a to the present.
        rate = b.rate + 0.5 * self.step * self._row_acceleration(b.solved)
        # Tyre damping uses the plate velocity averaged over three steps; its power uses the true plate velocity.
        true_rate = rate.copy()
        true_rate[:, e.tyres, 2] += (motion.row_velocity - motion.velocity)[steps]
        # (3) Dampers of bushings and tyres, B r' times the true rate.
        losses = bushings.damping * rate * true_rate
        # (4) Contacts that may lift off, in place of (3): their damping force is elastic force less total force.
        ground = bushings.one_sided
        losses[:, ground, 2] = (b.contact - total[:, bushings.rows[ground, 2]]) * true_rate[:, ground, 2]
        loss = np.sum(losses, axis=(1, 2))
        # (5) Jenkins elements of rubber, with the energy that their springs hold: `energies` takes it out at the end.
        loss = loss + np.sum(b.rubber * true_rate[:, e.rubber.elements, e.rubber.axes], axis=1)
        branch = self._branch_force(b.solved, b.branch)
        # (6) Explicit forces on all velocities: slope, moments and course control of a rolling car, applied forces.
        power_in = power_in + b.pushed
        rolling = e.rolling.tyres
        # (7) Force of the slip times what is no motion of the car: V psi, and the velocity of a tread, half a step
        # later, that what turns the wheel adds.
        steady = np.zeros((count, len(rolling), 2))
        steady[:, :, 1] = b.heading * e.rolling.speeds
        if motion.tread.shape[1]:
            steady[:, :, 0] = (motion.tread + 0.5 * self.step * motion.tread_change)[steps][:, e.rolling.plates]
        # (8) Static forces along the road, which hold a mean force, on the motion of the car alone.
        held = self.rows.weights.preload[bushings.rows[rolling, :2]]
        power_in = power_in + np.sum(branch[:, rolling, :2] * steady, axis=(1, 2))
        power_in = power_in + np.sum(held * (true_rate[:, rolling, :2] - steady), axis=(1, 2))
        present = bushings.branch_stiffness > 0.0
        # (9) Dashpots of the Maxwell branches, f2^2/(K2 tau).
        dashpots = (bushings.branch_stiffness * bushings.branch_time)[present]
        loss = loss + np.sum(branch[:, present] ** 2 / dashpots, axis=1)
        # (10) Dampers without their stops, whose energy is stored.
        loss = loss + np.sum(damper_force * b.damper_velocity, axis=1)
        # (11) Damping of the modes, and (12) that inside joints and of fluids.
        modal_damping = e.space.damping if e.space.damping.size else joint_dampers(self.model)[e.modes.velocities]
        loss = loss + np.sum(modal_damping * b.modal_velocity**2, axis=1)
        loss = loss + b.spring_rates**2 @ joint_dampers(self.model)[self.spring_dofs]
        self._add_work(power_in, loss, every)
        release(self.table)
        self.done += count
        self.filled = 0

    def _keep_positions(self, chunk: slice, positions: Vector, turn: Vector, modal: Vector) -> None:
        """Store positions (chunk, 3 points) with modal displacement, by frames (chunk, 9) and modes of the body."""
        for point, value in zip(self.places, np.split(positions, len(self.sites), axis=1), strict=True):
            if point in self.shapes:
                # Displaced point: x + R Phi q.
                value = value + np.einsum("nij,nj->ni", turn.reshape(-1, 3, 3), modal @ self.shapes[point].T)
            for axis, name in enumerate(AXES):
                self.channels[f"{point}_acc_{name}"][chunk] = value[:, axis]

    def keep_ahead(self, sample: int) -> None:
        """Store the positions of a sample after the end of the record; the first of these has index 0."""
        data, rows = self.data, self.rows
        mujoco.mj_kinematics(self.model, data)
        chunk = slice(self.samples + sample, self.samples + sample + 1)
        turn, modal = data.xmat[rows.layout.modes.body][None], rows.modal_positions(data)[None]
        self._keep_positions(chunk, data.site_xpos[self.sites].reshape(1, -1), turn, modal)

    def _add_work(self, power_in: Vector, loss: Vector, every: int) -> None:
        """Add the work of a chunk by the trapezoidal rule, continued across chunks."""
        if self.last_powers is not None:
            # The last sample of the chunk before is the first end of a trapezium.
            power_in = np.concatenate([[self.last_powers[0]], power_in])
            loss = np.concatenate([[self.last_powers[1]], loss])
        interval = self.step * every
        self.work_in += float(np.trapezoid(power_in) * interval)
        self.dissipated += float(np.trapezoid(loss) * interval)
        self.last_powers = (float(power_in[-1]), float(loss[-1]))

    def energies(self) -> Energies:
        """Return the energy balance of the run."""
        assert self.energy_at_start is not None
        return Energies(
            work_in=self.work_in + self.lifting,
            dissipated=self.dissipated - self.rubber_at_end,
            stored=self.energy_at_end - self.energy_at_start,
        )

    def messages(self) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Return warnings and notices about tyres that pulled on their plates, or left them."""
        e, rate = self.rows.layout, self.car.vehicle.solver.record_rate
        one_sided = [wheel for wheel, tyre in zip(self.wheels, e.tyres, strict=True) if tyre in e.bushings.one_sided]
        forces = {wheel: self.channels[f"tyre_{wheel}_force_z"] for wheel in self.wheels if wheel not in one_sided}
        warnings, notices = pulling_tyres(forces, rate)
        return warnings, (*notices, *lift_off_notices(self.channels, one_sided, self.car.static.tyre_load, rate))

    def recording(self, signal: Signal, statistics: Statistics) -> Recording:
        """Return the finished recording."""
        interval = 1.0 / self.car.vehicle.solver.record_rate
        time = uniform_time(samples=self.samples, timestep=interval)
        for name in self.car.vehicle.acceleration_channels:
            self.channels[name] = acceleration(self.channels[name], interval)
            release(self.table)
        return Recording(
            time=time,
            channels=self.channels,
            units=channel_units(self.channels),
            excited=tuple(wheel for wheel in signal.wheels if np.ptp(signal.displacement[wheel]) > 0.0),
            pose_time=time[self.pose_index],
            poses=self.poses,
            statistics=statistics,
        )
