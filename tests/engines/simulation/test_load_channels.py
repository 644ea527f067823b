"""Loads of the car: against the trim, Newton's law, the closed form of a bushing, and between the engines."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

from scenarios.signals.bump import bump_shape
from tests.validation import validated
from vehicle.errors import ConfigurationError
from vehicle.names import AXES
from vehicle.runs.car import Car
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.signals.excitation.iso_road import IsoRoad, Side, drive
from vehicle.signals.excitation.signal import Signal, uniform_time

FINE = "solver.timestep=0.000125"
"""The step of the reduced engine, so that MuJoCo's own error stays below 0.1 %."""


@pytest.fixture(scope="module")
def bumped():
    """A car whose samples are its steps, over a bump of 3 mm, with all loads."""
    car = Car.load(None, [FINE, "solver.record_rate=8000"])
    return car.run(bump(), channels=(*car.vehicle.channels, *car.vehicle.load_channels))


def bump():
    time = uniform_time(samples=301, timestep=1e-3)
    return Signal(time=time, displacement={"fr": bump_shape(time, amplitude=3e-3, start=0.05)})


def forces_on(run, parts):
    """Sum of the recorded forces of all connections between these parts and the others, in their axes; (samples, 3)."""
    found = np.zeros((len(run.time), 3))
    for one in run.car.vehicle.composition.connections:
        sign = int(one.moving in parts) - int(one.carrier in parts)
        if sign:
            found += sign * np.column_stack([run[f"{one.name}_force_{axis}"] for axis in AXES])
    return found


def centres(run, parts):
    """Mass and positions of the common centre of gravity of parts at the stored poses; (f, 3)."""
    model = run.car.model.model
    data, found = mujoco.MjData(model), []
    ids = [model.body(part).id for part in parts]
    mass = model.body_mass[ids]
    for pose in run.recording.poses:
        data.qpos[:] = pose
        mujoco.mj_kinematics(model, data)
        found.append(mass @ data.xipos[ids] / mass.sum())
    return float(mass.sum()), np.array(found)


def at_poses(run):
    """Samples of the stored poses."""
    return np.rint(run.recording.pose_time / run.recording.timestep).astype(int)


def moved_by(force, mass, step):
    """Displacement of a mass at rest under forces: two sums, the way the solver steps; (samples, 3)."""
    velocity = np.cumsum(force / mass, axis=0) * step
    return np.concatenate([np.zeros((1, 3)), np.cumsum(velocity, axis=0)[:-1] * step])


def test_loads_at_rest_are_those_of_the_trim(bumped):
    static = bumped.car.model.static
    loads = {f"tyre_{wheel}": load for wheel, load in static.tyre_load.items()} | static.support_load
    for name, load in loads.items():
        validated(
            "Static equilibrium", f"recorded load of {name} at rest", bumped[f"{name}_force_z"][0], load, rel=1e-9,
            unit="N", source="second derivation: trim of the car",
        )  # fmt: skip
    mass = sum(one[0, 0] for one in bumped.car.matrices.body_masses.values())
    assert sum(loads.values()) == pytest.approx(mass * bumped.car.vehicle.gravity, rel=1e-9)
    # Before the bump the car stands in its design position.
    for wheel in ("fr", "fl"):
        assert abs(bumped[f"suspension_travel_{wheel}"][0]) < 1e-12


def test_ground_forces_move_the_car(bumped):
    parts = list(bumped.car.matrices.body_masses)
    mass, centre = centres(bumped, parts)
    weight = np.array([0.0, 0.0, -mass * bumped.car.vehicle.gravity])
    found = moved_by(forces_on(bumped, parts) + weight, mass, 1.25e-4)[at_poses(bumped)]
    expected = centre - centre[0]
    size = np.max(np.abs(expected))
    assert size > 1e-5
    # The two sums are those of the solver: left is what joints in closed loops give way within a step.
    validated(
        "Integration in MuJoCo", "motion of the centre of gravity on a bump from the forces of the ground", found,
        expected, peak=2e-3, unit="m", source="conservation: Newton, summed twice over time",
    )  # fmt: skip


def test_plates_carry_and_move_a_car_on_the_road():
    """Sum of the plate forces = m (g + a): summed twice over time, that of a class C road moves the centre of mass."""
    # A sample for each step, so that the sums are those of the solver.
    car = Car.load(Path("focus_road"), ["solver.timestep=0.001", "solver.record_rate=1000"])
    wheels: dict[str, tuple[float, Side]] = {
        "fr": (0.0, "right"), "fl": (0.0, "left"), "rr": (2.615, "right"), "rl": (2.615, "left")
    }  # fmt: skip
    road = IsoRoad(level=CLASSES["C"], seed=1, track=1.49)
    signal = drive(road, speed=80.0 / 3.6, wheels=wheels, duration=0.6, rate=1000.0)
    run = car.run(signal, channels=(*car.vehicle.channels, *car.vehicle.load_channels))
    parts = list(car.matrices.body_masses)
    mass, centre = centres(run, parts)
    plates = forces_on(run, parts)
    expected = centre - centre[0]
    weight = np.array([0.0, 0.0, mass * car.vehicle.gravity])
    found = moved_by(plates - weight, mass, 1e-3)[at_poses(run)]
    assert np.all(np.max(np.abs(expected), axis=0) > 1e-5)
    validated(
        "Integration in MuJoCo", "motion of the centre of gravity on a class C road from the forces of the plates",
        found, expected, peak=1e-4, unit="m", source="conservation: Newton, summed twice over time",
    )  # fmt: skip
    named = sum(run[f"tyre_{wheel}_force_z"] for wheel in car.vehicle.wheels)
    np.testing.assert_allclose(plates[:, 2], named, rtol=1e-12)


def test_forces_move_the_body(bumped):
    """Springs and stabilizer pull at it too; the flexible modes have no momentum."""
    run, own = bumped, bumped.car.vehicle.composition
    fixed = {"body", *(part.name for part in own.parts if part.parent == "body" and not part.joints)}
    mass, centre = centres(run, sorted(fixed))
    force = forces_on(run, fixed) + np.array([0.0, 0.0, -mass * run.car.vehicle.gravity])
    for spring in own.springs:
        line = np.subtract(spring.at[1], spring.at[0])
        force += np.outer(run[f"{spring.name}_force"], line / np.linalg.norm(line))
    expected = centre - centre[0]
    found = moved_by(force, mass, 1.25e-4)[at_poses(run)]
    # The spring line is that of the design position: it turns by 3 mm over 0.5 m, and with it 3.2 kN of preload.
    validated(
        "Integration in MuJoCo", "vertical motion of the body on a bump from the recorded forces on it", found[:, 2],
        expected[:, 2], abs=1e-2 * np.max(np.abs(expected)), unit="m",
        source="conservation: Newton, summed twice over time",
    )  # fmt: skip


def test_the_torque_of_a_joint_is_that_of_its_angle(bumped):
    """At the instant of the sample, not a step later; the torsion bar has no damping."""
    joint = bumped.car.vehicle.composition.joint_springs[0].joint
    generated = bumped.car.model.model.joint(joint)
    assert bumped.car.model.model.dof_damping[generated.dofadr[0]] == 0.0
    angle = bumped.recording.poses[:, generated.qposadr[0]] - bumped.car.model.model.qpos_spring[generated.qposadr[0]]
    stiffness = bumped.car.vehicle.composition.joint_springs[0].stiffness
    found = bumped[f"{joint}_torque"][at_poses(bumped)]
    assert np.ptp(found) > 1.0
    validated(
        "Bushings, springs and stops", "torque of a torsion bar on a bump", found, -stiffness * angle,
        peak=1e-9, unit="N m", source="closed form: -K phi at the stored poses",
    )  # fmt: skip


def test_a_bushing_over_a_sine_cycle():
    """f = -K r - B r': amplitude -(K + i w B) R, and pi w B |R|^2 dissipated in each cycle."""
    car = Car.load(None, ["damper.coulomb_friction=0"])
    frequency, last = 10.0, 0.5
    time = uniform_time(samples=2001, timestep=1e-3)
    signal = Signal(time=time, displacement={"fr": 1e-3 * np.sin(2 * np.pi * frequency * time) * np.minimum(time, 1)})
    run = car.run(signal, channels=["torque_arm_engine_force_x"])
    model, pose_time = car.model.model, run.recording.pose_time
    data, apart = mujoco.MjData(model), []
    equality = model.equality("bushing/torque_arm_engine").id
    sites = model.eq_obj1id[equality], model.eq_obj2id[equality]
    for pose in run.recording.poses:
        data.qpos[:] = pose
        mujoco.mj_kinematics(model, data)
        way = data.site_xpos[sites[0]] - data.site_xpos[sites[1]]
        apart.append(data.xmat[model.body("engine").id].reshape(3, 3)[:, 0] @ way)

    def amplitude(at, values):
        chosen = at > at[-1] - last + 1e-9
        return 2.0 * np.mean(np.asarray(values)[chosen] * np.exp(-2j * np.pi * frequency * at[chosen]))

    moved, force = amplitude(pose_time, apart), amplitude(run.time, run["torque_arm_engine_force_x"])
    law = next(one.law for one in car.vehicle.composition.connections if one.name == "torque_arm_engine")
    assert law is not None
    omega, stiffness, damping = 2.0 * np.pi * frequency, law.stiffness[0], law.damping[0]
    assert abs(moved) > 1e-6
    # What is left of the transient is no harmonic.
    validated(
        "Bushings, springs and stops", "force over displacement of a bushing of the car at 10 Hz", force / moved,
        -(stiffness + 1j * omega * damping), rel=2e-3, unit="N/m", source="closed form: -(K + i w B)",
    )  # fmt: skip
    dissipated = np.pi * (force * np.conj(moved)).imag
    validated(
        "Bushings, springs and stops", "energy that a bushing of the car takes in a cycle at 10 Hz", -dissipated,
        np.pi * omega * damping * abs(moved) ** 2, rel=2e-2, unit="J", source="closed form: pi w B R^2",
    )  # fmt: skip


def test_both_engines_agree(bumped):
    car = Car.load(None, [FINE])
    names = car.vehicle.load_channels
    reduced = car.run(bump(), engine="reduced", channels=names)
    assert tuple(reduced.recording.channels) == names
    families: dict[str, list[str]] = {}
    for name in names:
        families.setdefault(name[:-2] if name[-2:] in ("_x", "_y", "_z") else name, []).append(name)
    gaps = []
    for members in families.values():
        expected = np.array([bumped[name][::8] for name in members])
        found = np.array([reduced[name] for name in members])
        np.testing.assert_allclose(found[:, 0], expected[:, 0], atol=1e-6 * max(np.max(np.abs(expected)), 1e-9))
        difference = np.sqrt(np.sum(np.var(found - expected, axis=1)))
        gaps.append(difference / np.sqrt(np.sum(np.var(expected, axis=1))))
    # The demand of the project, with as much again for preloads that turn by finite angles.
    validated(
        "Reduced engine", "RMS difference of all loads of the car on a bump to those of MuJoCo", np.array(gaps), 0.0,
        abs=1e-2, source="second derivation: MuJoCo, step 0.125 ms",
    )  # fmt: skip


def test_loads_are_recorded_on_request(car):
    signal = Signal(time=uniform_time(samples=51, timestep=1e-3), displacement={"fr": np.zeros(51)})
    assert tuple(car.run(signal).recording.channels) == car.vehicle.channels
    names = ["hydromount_force_z", "seat_rail_acc_z", "suspension_travel_fr"]
    for engine in ("mujoco", "reduced"):
        recording = car.run(signal, engine=engine, channels=names).recording
        assert list(recording.channels) == names
        assert [recording.units[name] for name in names] == ["N", "m/s2", "m"]
    with pytest.raises(ConfigurationError, match=r"no channel 'hydromount_force'; did you mean hydromount_force_"):
        car.run(signal, channels=["hydromount_force"])
