"""Rubber friction in MuJoCo: loops, creep, order in the step, small vibrations, energy; the reduced engine of a car."""

import numpy as np
import pytest

from tests.engines.simulation.row_model import Stepper, add_bushing, add_free_body, element_law, empty_spec, poles
from tests.validation import validated
from vehicle.model.laws.amplitude import friction_elements
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road

MASS, STIFFNESS, VISCOUS, FORCE, STROKE = 40.0, 4e5, 200.0, 240.0, 3e-4
LAW = friction_elements(FORCE, STROKE)
STEPS = np.array([2e-3, 1e-3, 5e-4, 2.5e-4])


def mount(step):
    """A free mass on a bushing with rubber friction along x."""
    spec = empty_spec(step)
    mass = add_free_body(spec, "mass", MASS, [1.0, 1.0, 1.0])
    add_bushing(spec, "mount", mass, spec.worldbody, element_law([STIFFNESS] * 3, [VISCOUS] * 3))
    spec.add_numeric(name="friction/bushing/mount/x", data=np.column_stack([LAW.stiffness, LAW.limit]).ravel())
    return Stepper(spec)


def push(time):
    """A force on the mass [N] with large and small loops."""
    return 300.0 * np.sin(2.0 * np.pi * 3.1 * time) + 150.0 * (np.sin(2.0 * np.pi * 11.0 * time + 1.0) - np.sin(1.0))


def stepped(step, duration=0.6, force=push):
    """Position [m] and friction [N] of the mass."""
    run = mount(step)

    def before(time):
        run.data.xfrc_applied[1, 0] = force(time)

    def read():
        return [run.data.qpos[0], run.rows.state.rubber[0].sum()]

    return run.step(round(duration / step) + 1, read, before)


def fine(samples, interval):
    """Positions by a central scheme with 200 steps in an interval."""
    x = v = t = 0.0
    h, forces, positions = interval / 200, np.zeros(len(LAW.limit)), [0.0]
    for _ in range(samples - 1):
        for _ in range(200):
            v += h * (push(t) - STIFFNESS * x - VISCOUS * v - forces.sum()) / MASS
            x, t = x + h * v, t + h
            forces = np.clip(forces + LAW.stiffness * h * v, -LAW.limit, LAW.limit)
        positions.append(x)
    return np.array(positions)


def test_a_run_follows_the_elements_along_its_path():
    # The elements are advanced in the step after the position was read.
    path, friction = stepped(1e-3).T
    x, friction = path[:-1], friction[1:]
    validated(
        "Bushings, springs and stops", "rubber friction of a run in MuJoCo along its path", friction, LAW.path(x),
        abs=1e-9, unit="N", source="second derivation: elements along the recorded positions",
    )  # fmt: skip
    assert np.max(friction) > 0.6 * FORCE and np.any(np.abs(friction[50:]) < 0.1 * FORCE)


def test_order_in_the_step():
    reference = fine(301, 2e-3)
    errors = [
        np.sqrt(np.mean((stepped(step)[:: round(2e-3 / step), 0] - reference) ** 2)) / np.std(reference)
        for step in STEPS
    ]
    source = "second derivation: explicit steps of 10 us"
    validated(
        "Integration in MuJoCo", "order of convergence of a mass on rubber with friction",
        np.polyfit(np.log(STEPS), np.log(errors), 1)[0], 2.0, within=(1.7, 2.3), source=source,
    )  # fmt: skip
    validated(
        "Integration in MuJoCo", "mass on rubber with friction, RMS error of the position at 0.5 ms", errors[2], 0.0,
        abs=2e-3, source=source,
    )  # fmt: skip


def test_small_vibrations_have_the_tangent_at_rest():
    run = mount(1e-4)
    run.data.qpos[0] = 1e-9
    path = run.step(2000, run.position)[:, 0]
    exact = np.roots([MASS, VISCOUS, STIFFNESS + FORCE / STROKE])
    validated(
        "Bushings, springs and stops", "pole of a mass on rubber with friction at 1 nm", poles(path, 1e-4)[0].imag,
        exact[0].imag, rel=1e-5, unit="rad/s", source="closed form: m s2 + B s + K + Fmax/x2 = 0",
    )  # fmt: skip


def test_no_creep_under_a_held_load():
    def held(time):
        return 200.0 * min(time / 0.2, 1.0) + 60.0 * np.sin(2.0 * np.pi * 12.5 * time)

    x = stepped(1e-3, duration=6.0, force=held)[:, 0]
    period = [np.mean(x[first : first + 80]) for first in (4000, 5600)]
    validated(
        "Bushings, springs and stops", "creep of rubber with friction under 200 N and a vibration, in MuJoCo",
        60.0 * (period[1] - period[0]) / 1.6, 0.0, abs=1e-12, unit="m/min",
        source="closed form: a held load does not creep",
    )  # fmt: skip


MOUNTS = {
    "front.bushings.suspension_mount": ((0.0, 0.0, 70.0), (0.0, 0.0, 2e-4)),
    "rear.bushings.damper_mount": ((0.0, 0.0, 40.0), (0.0, 0.0, 2e-4)),
    "engine.bushings.hydromount": ((40.0, 0.0, 40.0), (2e-4, 0.0, 2e-4)),
}
"""Friction force [N] and stroke [m] of bushings of the `focus_road` car."""


def rubber(factor=1.0):
    """Return the changes of a car to rubber friction, with this factor on its forces and strokes."""
    return {
        f"{path}.friction_{key}": [factor * value for value in values]
        for path, pair in MOUNTS.items()
        for key, values in zip(("force", "stroke"), pair, strict=True)
    }


def stiffened(car):
    """Return the changes of a car that add the tangent at rest of the friction to the stiffness."""
    changes = {}
    for path, (force, stroke) in MOUNTS.items():
        axle, _, name = path.split(".")
        tangent = [f / x if f else 0.0 for f, x in zip(force, stroke, strict=True)]
        stiffness = car.vehicle.table[axle]["bushings"][name]["stiffness"]
        changes[f"{path}.stiffness"] = [k + more for k, more in zip(stiffness, tangent, strict=True)]
    return changes


@pytest.mark.parametrize("variant", [False, True])
def test_matrices_have_the_tangent_at_rest(road_car, variant):
    """Of a built car and of a variant of a car with other friction; behind the sheet metal of the body too."""
    # The first corner of the shortest strokes is a tenth of the step of the differences.
    car = Car.load("focus_road", rubber(0.03))
    if variant:
        car = Car.load("focus_road", rubber()).with_(rubber(0.03))
    stiff = road_car.with_(stiffened(road_car)).matrices.system
    system, way = car.matrices.system, "of a variant" if variant else "of a built car"
    assert np.max(np.abs(system.stiffness - road_car.matrices.system.stiffness)) > 1e-4 * np.max(system.stiffness)
    assert car.static.preload == pytest.approx(road_car.static.preload, rel=1e-9, abs=1e-6)
    # Static loads share out by the elastic parts, which turns a part of the geometric stiffness.
    validated(
        "Linear system", f"stiffness matrix with rubber friction, {way}", system.stiffness, stiff.stiffness, peak=1e-6,
        source="second derivation: bushings with the stiffness K + Fmax/x2",
    )  # fmt: skip
    validated(
        "Linear system", f"branches of the attachments with rubber friction, {way}",
        np.concatenate([system.branch_stiffness, system.branch_time]),
        np.concatenate([stiff.branch_stiffness, stiff.branch_time]), rel=1e-5,
        source="second derivation: bushings with the stiffness K + Fmax/x2",
    )  # fmt: skip


def test_small_and_large_vibrations_of_a_car(road_car):
    """Rubber that does not slide is a spring; the energy of rubber that slides is accounted for."""
    road = Road("A", speed=80, duration=2.5, period="record")
    spring = road_car.with_(stiffened(road_car)).run(road)
    stuck, sliding = (Car.load("focus_road", rubber(factor)).run(road) for factor in (400.0, 1.0))
    for name in ("seat rail z", "engine z", "knuckle fr z"):
        validated(
            "Bushings, springs and stops", f"{name} of a car with 400 times the friction force and stroke",
            stuck[name], spring[name], peak=1e-3,
            source="second derivation: bushings with the stiffness K + Fmax/x2",
        )  # fmt: skip
    assert np.max(np.abs(sliding["engine z"] - spring["engine z"])) > 0.05 * np.max(np.abs(spring["engine z"]))
    energies = sliding.recording.statistics.energies
    assert energies is not None
    validated(
        "Bushings, springs and stops", "work on a car with rubber friction, less stored and dissipated energy",
        energies.residual, 0.0, abs=2e-4, source="conservation: energy balance",
    )  # fmt: skip


EVERYWHERE: dict[str, tuple[tuple[float, ...], tuple[float, ...]]] = {
    "front.bushings.suspension_mount": ((0, 0, 70), (0, 0, 2e-4)),
    "front.bushings.arm_rear": ((0, 60, 0), (0, 2e-4, 0)),
    "rear.bushings.damper_mount": ((0, 0, 40), (0, 0, 2e-4)),
    "rear.bushings.trailing_upper_inner": ((60, 0, 0), (2e-4, 0, 0)),
    "engine.bushings.linear_mount": ((60, 0, 60), (2e-4, 0, 2e-4)),
    "engine.bushings.hydromount": ((40, 0, 40), (2e-4, 0, 2e-4)),
    "engine.bushings.torque_arm_body": ((60, 0, 0), (2e-4, 0, 0)),
    "engine.bushings.torque_arm_engine": ((60, 0, 0), (2e-4, 0, 0)),
}
"""Friction force [N] and stroke [m] along 14 axes of the bushings of the `focus_road` car."""


@pytest.fixture(scope="module")
def cars():
    """The car with friction along 14 axes, and without, at a step of 0.25 ms in MuJoCo."""
    friction = {
        f"{path}.friction_{key}": list(values)
        for path, pair in EVERYWHERE.items()
        for key, values in zip(("force", "stroke"), pair, strict=True)
    }
    step = {"solver.timestep": 0.00025}
    return Car.load("focus_road", {**friction, **step}), Car.load("focus_road", step)


LOADS = {
    "suspension_mount_fr_force_z", "arm_rear_fr_force_y", "damper_mount_rr_force_z",
    "trailing_upper_inner_rr_force_x", "linear_mount_force_z", "hydromount_force_z", "torque_arm_body_force_x",
}  # fmt: skip


def ratios(car, road, names, *, less_stated=False):
    """RMS of channels in the reduced engine over that in MuJoCo, less the stated error of its linear geometry."""
    stepped, run = (car.run(road, engine=engine, channels=names) for engine in ("mujoco", "reduced"))
    stated = run.recording.statistics.errors if less_stated else {}
    return np.array([np.std(run[name]) / np.std(stepped[name]) - stated.get(name, 0.0) for name in names])


def test_both_engines_with_friction_along_14_axes(cars):
    """What is left is the third order in the motion; the second, 1 % of a knuckle along y, is stated by the run.

    Loads have no stated error: the force of the front arm along y, which carries the knuckle, is 0.28 % off, and
    0.16 % without friction.
    """
    car, _ = cars
    assert sum(law.friction for law in car.matrices.laws) == 14
    names = [name for name in car.vehicle.channels if not name.startswith("plate")]
    columns = [*names, *sorted(LOADS)]
    found = dict(zip(columns, ratios(car, Road("A", speed=80, duration=5), columns, less_stated=True), strict=True))
    source = "second derivation: MuJoCo at 0.25 ms"
    validated(
        "Reduced engine", "RMS of all channels over that of MuJoCo less the stated error, rubber friction, class A",
        np.array([found[name] for name in names]), 1.0, abs=3e-3, source=source,
    )  # fmt: skip
    validated(
        "Reduced engine", "RMS of the loads of bushings over that of MuJoCo, along axes with rubber friction, class A",
        np.array([found[name] for name in sorted(LOADS)]), 1.0, abs=4e-3, source=source,
    )  # fmt: skip


def test_friction_adds_no_difference_between_the_engines(cars):
    """On a cleat the finite motion of the suspension separates the engines, with friction and without."""
    road = Road("cleat:10x50", speed=30)
    names = [name for name in cars[0].vehicle.channels if not name.startswith("plate") and name[-6:] != "_acc_y"]
    found, plain = (ratios(car, road, names) for car in cars)
    validated(
        "Reduced engine", "RMS over that of MuJoCo, with rubber friction over without, a cleat of 10 mm", found / plain,
        1.0, abs=5e-3, source="second derivation: MuJoCo at 0.25 ms",
    )  # fmt: skip
