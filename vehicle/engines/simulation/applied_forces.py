"""Applied forces of a car: their records for the core, their rows over the velocity coordinates, their histories."""

from collections.abc import Iterable, Sequence

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.simulation.element_records import Applied, Index, Layout
from vehicle.engines.simulation.step_weights import FOURTH_ORDER
from vehicle.errors import ConfigurationError
from vehicle.model.assembly.element_numbers import FORCE, TORQUE
from vehicle.model.parameters.applied_force import CRANK
from vehicle.model.parameters.composition import Composition
from vehicle.model.parameters.driving import RunUp
from vehicle.model.parameters.placed_force import PlacedForce, on_parts
from vehicle.signals.excitation.force_lines import ForceLines, History, SweptLine
from vehicle.signals.excitation.force_record import ForceRecord

MINOR = 0.01
"""Share of the largest amplitude of a force below which a harmonic does not choose the time step."""

STEP_ERROR = 1e-3
"""Largest error of the response to a force with a chosen time step; with a given step it is `GIVEN_ERROR`."""

GIVEN_ERROR = 5e-3

RESOLVED = 0.2
"""Highest frequency over the record rate: accelerations are second differences of positions, 2.4 % low there."""


def force_rows(model: mujoco.MjModel, data: mujoco.MjData, layout: Layout) -> Vector:
    """Return the generalised force of a unit of each applied force in a position of the car; (f, n).

    Args:
        model: compiled car.
        data: its state after `mj_fwdPosition`.
        layout: its elements.
    """
    a, modes = layout.applied, layout.modes
    rows = np.zeros((len(a.means), model.nv))
    turn = data.xmat[modes.body].reshape(3, 3)
    shapes = dict(zip(a.nodes.tolist(), a.shapes.reshape(len(a.nodes), 6, modes.size), strict=True))
    for element, (site, way, force) in enumerate(zip(a.sites, a.directions, a.forces, strict=True)):
        jacobian = np.zeros((6, model.nv))
        mujoco.mj_jacSite(model, data, jacobian[:3], jacobian[3:], int(site))
        if element in shapes:
            jacobian[:3, modes.velocities] += turn @ shapes[element][:3]
            jacobian[3:, modes.velocities] += turn @ shapes[element][3:]
        frame = int(a.frames[element])
        # J_p' f + J_r' m; directions that follow a part are rotated with it, R f and R m.
        rows[force] += (way if frame < 0 else (way.reshape(2, 3) @ data.xmat[frame].reshape(3, 3).T).ravel()) @ jacobian
    rows[a.torques[:, 1], a.torques[:, 0]] = 1.0
    return rows


def tyre_inputs(forces: Sequence[PlacedForce], layout: Layout, wheels: Sequence[str]) -> tuple[Vector, Vector]:
    """Return the velocities of the Maxwell branches, (f, b), and the heights of the plates, (f, w), per unit of forces.

    Args:
        forces: applied forces.
        layout: elements of the car.
        wheels: names of the wheels, in the order of the tyres.
    """
    present = layout.bushings.branch_stiffness > 0.0
    # (element, axis) to the number of its Maxwell branch; the slip along x is axis 0.
    branches = np.cumsum(present).reshape(present.shape) - 1
    slips = np.zeros((len(forces), int(np.count_nonzero(present))))
    plate_heights = np.zeros((len(forces), len(wheels)))
    for index, force in enumerate(forces):
        if force.unit == "m":
            plate_heights[index, wheels.index(force.tyre)] = 1.0
        elif force.unit == "m/s":
            slips[index, branches[layout.tyres[wheels.index(force.tyre)], 0]] = 1.0
    return slips, plate_heights


def force_lines(forces: Sequence[PlacedForce]) -> tuple[ForceLines, Vector]:
    """Return the histories of some forces, and the coefficients of each force on them; (f, lines)."""
    histories = [_histories(force) for force in forces]
    lines = ForceLines.of(histories)
    return lines, np.array([lines.coefficients(each) for each in histories]).reshape(len(forces), len(lines))


def _histories(force: PlacedForce) -> dict[History, complex]:
    """Return the amplitude of each history of a force."""
    law, amplitudes = force.law, force.harmonics
    if force.recorded:
        file, channel, unit = law.file or "", law.channel or "", law.unit or ""
        return {ForceRecord(force.path, file, channel, unit, force.unit, law.ends_at_zero, force.given): law.factor}
    if force.run_up is None:
        return dict(amplitudes.items())
    power = 0.0 if law.reference_frequency is None else 2.0
    return {
        SweptLine(*force.run_up, order=frequency / force.speed, power=power): amplitude
        for frequency, amplitude in amplitudes.items()
    }


def averaged_forces(forces: Sequence[PlacedForce], step: float, rows: slice) -> Vector:
    """Return the forces at the ends of some steps, averaged over three steps like springs and plates; (rows, f).

    Args:
        forces: applied forces; f of them act on parts and joints.
        step: time step [s].
        rows: range of the steps.
    """
    forces = on_parts(forces)
    lines, coefficients = force_lines(forces)
    values = lines.values(step * np.arange(rows.start - 1, rows.stop + 1))
    # F + (F(t + h) - 2 F(t) + F(t - h))/12.
    values = values[1:-1] + FOURTH_ORDER * np.diff(values, 2, axis=0)
    return np.asarray(values @ coefficients.T + [force.mean for force in forces])


def force_histories(car: Composition, names: Iterable[str], time: Vector) -> dict[str, Vector]:
    """Return the histories of applied forces and of the crankshaft at some times [s], by channel.

    Args:
        car: elements of the car.
        names: channels among `Vehicle.force_channels`.
        time: times [s]; (n,).
    """
    histories, turned = dict[str, Vector](), (np.zeros_like(time), np.zeros_like(time))
    by_channel = {force.channel: force for force in on_parts(car.forces)}
    if speed := car.speeds.get(CRANK, 0.0):
        run_up = RunUp((0.0, 1.0), (speed, speed)) if car.crank_run_up is None else car.crank_run_up
        turned = SweptLine(*run_up).angle(time)
    for name in names:
        if name in by_channel:
            lines, (coefficients,) = force_lines([by_channel[name]])
            histories[name] = lines.values(time) @ coefficients + by_channel[name].mean
        else:
            # Angle, or speed in revolutions a minute.
            histories[name] = turned[0] if name.startswith("angle") else turned[1] * 30.0 / np.pi
    return histories


def highest_frequency(forces: Sequence[PlacedForce]) -> float:
    """Return the highest frequency of some forces with at least `MINOR` of the largest amplitude of its force [Hz]."""
    highest = 0.0
    for force in forces:
        sizes = {frequency: abs(amplitude) for frequency, amplitude in force.harmonics.items()}
        threshold = MINOR * max(sizes.values(), default=0.0)
        highest = max([highest, *(frequency for frequency, size in sizes.items() if size > threshold)])
    lines, _ = force_lines(forces)
    return max([highest / (2.0 * np.pi), *(record.read().highest for record in lines.records)])


def step_for(forces: Sequence[PlacedForce], step: float, error: float = STEP_ERROR) -> float:
    """Return the step, halved until the response of a part to all forces is accurate: (w h)^2/12 at most `error`."""
    while (2.0 * np.pi * highest_frequency(forces) * step) ** 2 * FOURTH_ORDER > error:
        step *= 0.5
    return step


def require_step_of_forces(forces: Sequence[PlacedForce], step: float) -> None:
    """Check a given time step [s].

    Raises:
        ConfigurationError: it is too long for the frequencies of the forces.
    """
    needed = step_for(forces, step, GIVEN_ERROR)
    if needed < step:
        raise ConfigurationError(
            f"solver.timestep: found {step:g} s, must be at most {needed:g} s for a force of "
            f"{highest_frequency(forces):.4g} Hz; leave it out, or choose a shorter step"
        )


def force_notices(forces: Sequence[PlacedForce]) -> tuple[str, ...]:
    """Return the messages on the records of some forces."""
    from_python = [force.path for force in forces if force.given is not None]
    messages = (
        [f"{', '.join(from_python)}: comes from Python, so the vehicle file of this run does not contain it"]
        if from_python
        else []
    )
    return (*(notice for record in force_lines(forces)[0].records for notice in record.read().notices), *messages)


def require_resolved(forces: Sequence[PlacedForce], record_rate: float) -> None:
    """Check the speed of each angle, and the sampling rate of each force.

    Args:
        forces: applied forces of a car.
        record_rate: rate of its samples [Hz].

    Raises:
        ConfigurationError: an angle is at rest, or a frequency too high for the record.
    """
    for force in forces:
        law = force.law
        if not (law.enabled and law.harmonics) or not force.path.startswith("force."):
            continue
        if force.speed == 0.0:
            remedy = (
                "set the speed of the crankshaft [1/min], for example --set crank.rpm=750"
                if law.angle == CRANK
                else (
                    "the wheels stand; drive on a road, for example --road level --speed 110, or set "
                    "driving.speed [m/s]"
                )
            )
            raise ConfigurationError(f"{force.path}.angle: {law.angle} does not rotate; {remedy}")
    highest = highest_frequency(forces)
    if highest > RESOLVED * record_rate:
        rate = 1000.0 * np.ceil(highest / (1000.0 * RESOLVED))
        raise ConfigurationError(
            f"solver.record_rate: found {record_rate:g} Hz, must be at least {rate:g} Hz, or a force of "
            f"{highest:.4g} Hz appears more than 2 % too low"
        )


def applied_record(model: mujoco.MjModel, above: Sequence[Sequence[int]], modes: int) -> Applied:
    """Return the record of the applied forces of a compiled car.

    Args:
        model: compiled car.
        above: velocity coordinates that move each body.
        modes: number of the modes of its body.
    """
    names = [str(model.numeric(index).name) for index in range(model.nnumeric)]
    names = [name for name in names if name.startswith((FORCE, TORQUE))]
    sites, forces, nodes, torques = list[int](), list[int](), list[int](), list[tuple[int, int]]()
    directions, shapes, means, frames = list[Vector](), list[Vector](), list[float](), list[int]()
    for index, name in enumerate(names):
        *way, follows, mean = _field(model, name).tolist()
        means.append(mean)
        if name.startswith(TORQUE):
            torques.append((int(model.joint(name.rpartition("/")[2]).dofadr[0]), index))
            continue
        for end, sign in (("on", 1.0), ("against", -1.0)):
            site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, f"{name}/{end}")
            if site < 0:
                continue
            shape, rotation = (_field(model, f"{field}/{name}/{end}") for field in ("shape", "rotation"))
            if shape.size:
                nodes.append(len(sites))
                shapes.append(np.concatenate([shape, rotation if rotation.size else np.zeros(3 * modes)]))
            sites.append(site)
            # Force and reaction have the axes of the part that the force acts on.
            frames.append(int(model.site_bodyid[model.site(f"{name}/on").id]) if follows else -1)
            directions.append(sign * np.array(way))
            forces.append(index)
    bodies = [int(model.site_bodyid[site]) for site in sites]
    dofs = [(n, dof, int(model.body_rootid[body])) for n, body in enumerate(bodies) for dof in above[body]]
    return Applied(
        sites=_whole(sites),
        frames=_whole(frames),
        directions=np.reshape(directions, (len(sites), 6)).astype(float),
        forces=_whole(forces),
        dofs=np.ascontiguousarray(np.reshape(_whole(dofs), (-1, 3))),
        nodes=_whole(nodes),
        shapes=np.reshape(shapes, (len(nodes), 6 * modes)).astype(float),
        torques=np.ascontiguousarray(np.reshape(_whole(torques), (-1, 2))),
        means=np.array(means),
    )


def _whole(values: Sequence[object]) -> Index:
    return np.array(values, dtype=np.int64)


def _field(model: mujoco.MjModel, name: str) -> Vector:
    """Return a custom field of the model; empty if it has none."""
    index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_NUMERIC, name)
    start, size = (int(model.numeric_adr[index]), int(model.numeric_size[index])) if index >= 0 else (0, 0)
    return np.array(model.numeric_data[start : start + size])
