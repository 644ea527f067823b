"""Cars in steady acceleration: balance of forces and moments, the same system elsewhere, modes, rides, anti-dive."""

import math
import re
from pathlib import Path

import mujoco
import numpy as np
import pytest
import scipy

from tests.validation import validated
from vehicle.commands.mjcf import main as mjcf
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.step_map import step_map, step_rows
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.rows import Rows, prepare_model
from vehicle.engines.simulation.run_model import run_model
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road

ONE_PIECE = Path(__file__).parents[2] / "docs" / "howto" / "add" / "one-piece-axle.md"
ROLLING = "driving.speed=22"
LINEAR = (
    "front.damper.viscous_law=linear", "front.damper.viscous=2500", "front.damper.coulomb_friction=0",
    "rear.damper.coulomb_friction=0", "solver.timestep=0.0005",
)  # fmt: skip
CASES = {
    "sedan -6": ("sedan", ["driving.acceleration=-6", ROLLING]),
    "sedan +3, left 2": ("sedan", ["driving.acceleration=3", "driving.lateral=2", ROLLING]),
    "focus_road -9": ("focus_road", ["driving.acceleration=-9", "driving.brake_balance=0.8", ROLLING]),
    "kinematic_reference left 6": ("kinematic_reference", ["driving.lateral=6", "driving.friction=1.2", ROLLING]),
}
CHANNELS = ("suspension_travel_fr", "tyre_fr_force_x", "seat_rail_acc_z", "knuckle_fr_acc_z", "tyre_fr_force_z")
AXES_OF_FILE = [-1.0, -1.0, 1.0]  # x to the rear and y to the right, against ISO 8855


def contacts(car):
    """Return forces of the road and their points, masses and centres of all bodies; (4, 3), (4, 3), (b,), (b, 3)."""
    model, data = car.model.model, mujoco.MjData(car.model.model)
    mujoco.mj_kinematics(model, data)
    rows = Rows(model, car.static.preload)
    tyres = rows.layout.tyres
    forces = car.static.preload[rows.layout.bushings.rows[tyres]]
    points = np.array([data.site_xpos[model.eq_obj2id[model.equality(rows.names[tyre]).id]] for tyre in tyres])
    return forces, points, model.body_mass, data.xipos.copy()


@pytest.mark.parametrize("case", CASES)
def test_loads_are_those_of_statics_by_hand(case):
    """About the contacts of the front axle: N_r l = sum of m g (x - x_f) + m a_x z of all parts where they now are."""
    car = Car.load(CASES[case][0], CASES[case][1])
    driving, (forces, points, masses, centres) = car.vehicle.driving, contacts(car)
    upward = np.array(AXES_OF_FILE) * [driving.acceleration, driving.lateral, car.vehicle.gravity]
    total = masses.sum()
    validated("Static equilibrium", f"{case} m/s2: force of the road is mass times acceleration, and the weight",
              forces.sum(axis=0), total * upward, peak=1e-9, unit="N",
              source="closed form: Newton's law")  # fmt: skip
    inertia = np.cross(centres - points[0], masses[:, None] * upward).sum(axis=0)
    validated("Static equilibrium", f"{case} m/s2: moment of the road about a contact point",
              np.cross(points - points[0], forces).sum(axis=0), inertia, peak=1e-9, unit="N m",
              source="closed form: law of angular momentum")  # fmt: skip
    assert points[:, 2] == pytest.approx(car.vehicle.composition.wheels[0].patch[2], abs=1e-12)


@pytest.mark.parametrize("case", CASES)
def test_the_car_stays_where_it_is_trimmed(case):
    car = Car.load(*CASES[case])
    model, space = run_model(car.model)
    data, rows = mujoco.MjData(model), Rows(model, car.static.preload, space)
    with installed(rows):
        mujoco.mj_forward(model, data)
    # Links of 0.1 kg between bushings of 1e7 N/m, 1e-12 m from equilibrium.
    assert np.max(np.abs(data.qacc)) < 1e-5


def design_coordinates(car, design):
    """Return the position of a moved car in the coordinates of the model of its design position."""
    moved, position = mujoco.MjData(car.model.model), car.model.model.qpos0.copy()
    mujoco.mj_kinematics(car.model.model, moved)
    for joint in np.flatnonzero(design.jnt_type == mujoco.mjtJoint.mjJNT_BALL):
        body = int(design.jnt_bodyid[joint])
        frames = moved.xmat[[design.body_parentid[body], body]].reshape(2, 3, 3)
        quaternion = np.zeros(4)
        # A ball joint begins anew in the moved car.
        mujoco.mju_mat2Quat(quaternion, (frames[0].T @ frames[1]).ravel())
        position[design.jnt_qposadr[joint] + np.arange(4)] = quaternion
    return position, moved


def test_the_moved_car_is_the_same_mechanical_system():
    """In the coordinates of the moved car, the model of the design position has all its parts in the same places."""
    design = Car.load("sedan", [ROLLING]).model.model
    data = mujoco.MjData(design)
    data.qpos[:], moved = design_coordinates(Car.load(*CASES["sedan +3, left 2"]), design)
    start = mujoco.MjData(design)
    for one in (data, start):
        mujoco.mj_kinematics(design, one)
    assert np.max(np.abs(moved.xpos - start.xpos)) > 0.01
    np.testing.assert_allclose(data.xpos, moved.xpos, atol=1e-12)
    np.testing.assert_allclose(data.xmat, moved.xmat, atol=1e-12)


def test_loads_under_inclined_gravity():
    """The car at rest, run in MuJoCo under inclined gravity with the brake forces at the contacts, not in the tyres.

    The tyres give little side force, because the toe of the moved wheels gives none in the trim.
    """
    changes = [*LINEAR[:-1], "solver.timestep=0.001", "*.tyre.cornering_stiffness=1000", ROLLING]
    still = Car.load("kinematic_reference", changes)
    car = Car.load("kinematic_reference", [*changes, "driving.acceleration=-3"])
    model = still.model.spec.compile()
    model.qpos_spring[:] = still.model.model.qpos_spring
    prepare_model(model)
    model.opt.gravity[:] = [-3.0, 0.0, -still.vehicle.gravity]
    data, rows = mujoco.MjData(model), Rows(model, still.static.preload)
    data.qpos[:], _ = design_coordinates(car, model)
    mujoco.mj_kinematics(model, data)
    layout, rolling, (forces, *_) = rows.layout, rows.layout.rolling, contacts(car)
    ends = [model.equality(name).id for name in rows.names]
    parts, carriers = model.eq_obj1id[ends], model.eq_obj2id[ends]
    bushings = np.setdiff1d(np.arange(len(ends)), layout.tyres)
    loads, couples = [], []
    with installed(rows):
        for step in range(1500):
            for site, arm, force in zip(rolling.sites, rolling.arms, forces[rolling.plates], strict=True):
                hub = int(model.site_bodyid[site])
                frame = data.xmat[hub].reshape(3, 3)
                # Below the wheel centre in the plane of the wheel, at the height of the plate.
                low = data.site_xpos[site] + arm[2] * frame[:, 2]
                down = frame[2, 1] * frame[:, 1] - [0.0, 0.0, 1.0]
                point = low + (low[2] - data.mocap_pos[0, 2]) / -down[2] * down
                data.xfrc_applied[hub, :3] = along = [force[0], 0.0, 0.0]
                data.xfrc_applied[hub, 3:] = np.cross(point - data.xipos[hub], along)
            mujoco.mj_step(model, data)
            if step >= 1000:
                acting = (data.efc_force + rows.state.explicit)[layout.bushings.rows]
                loads.append(acting[layout.tyres, 2])
                lever = data.site_xpos[parts] - data.site_xpos[carriers]
                couples.append(np.cross(lever[bushings], acting[bushings]).sum(axis=0))
    # Force and reaction of a bushing at rest act at two points, r apart: the couple of all, 3 N m of 5000, moves load.
    couple, at = np.mean(couples, axis=0), [wheel.center[0] for wheel in car.vehicle.composition.wheels]
    share = 0.5 * couple[1] / (max(at) - min(at)) * np.where(np.array(at) > np.mean(at), -1.0, 1.0)
    assert np.max(np.abs(share)) > 1e-4 * np.min(forces[:, 2])
    validated("Static equilibrium", "kinematic_reference at -3 m/s2: wheel loads under inclined gravity",
              forces[:, 2], np.mean(loads, axis=0) + share, rel=2e-5, unit="N",
              source="second derivation: run of the car at rest with forces at the contacts, less r x f")  # fmt: skip


def undamped(stiffness, model, rows):
    """Return the natural frequencies with stuck dampers [Hz]."""
    data, mass = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    with installed(rows):
        mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, mass)
    jacobian = data.efc_J.reshape(-1, model.nv)
    stuck = np.eye(model.nv)[[*rows.layout.dampers.dofs, *rows.layout.rolling.spins]]
    basis = scipy.linalg.null_space(np.vstack([jacobian[rows.layout.joints.ravel()], stuck]))
    squares = scipy.linalg.eigvals(basis.T @ stiffness @ basis, basis.T @ mass @ basis)
    return np.sqrt(np.sort(squares.real)) / (2.0 * np.pi)


@pytest.mark.parametrize("name", ["sedan", "kinematic_reference"])
def test_modes_are_those_of_an_independent_linearisation(name):
    """Differences of fourth order over ten times the step, of fresh rows in a plain state of MuJoCo."""
    car = Car.load(name, ["driving.acceleration=-5"])
    model, h = car.model.model, 1e-5
    rows, data = Rows(model, car.static.preload), mujoco.MjData(model)

    def force(motion):
        data.qpos[:] = model.qpos0
        mujoco.mj_integratePos(model, data.qpos, motion, 1.0)
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_fwdVelocity(model, data)
        rows.anew()(model, data)
        return data.qfrc_passive - data.qfrc_bias + data.qfrc_applied

    units = h * np.eye(model.nv)
    columns = [(force(-2 * u) - 8 * force(-u) + 8 * force(u) - force(2 * u)) / (-12.0 * h) for u in units]
    found, expected = (undamped(k, model, rows) for k in (car.matrices.system.stiffness, np.array(columns).T))
    validated("Linear system", f"{name} at -5 m/s2: its 25 lowest undamped frequencies", found[:25], expected[:25],
              rel=1e-5, unit="Hz", source="second derivation: differences of MuJoCo's forces")  # fmt: skip


@pytest.mark.parametrize("changes", [["driving.acceleration=-6"], ["driving.acceleration=3", "driving.lateral=2"]])
def test_a_step_of_the_model_is_that_of_its_matrices(changes):
    """A disturbed run less an undisturbed one, over 50 steps: damping, slip, headings and gyroscopic moments too."""
    car = Car.load("sedan", [*changes, ROLLING, *LINEAR])
    one_step = step_map(step_rows(car.model, car.matrices, 5e-4), form := first_order(car.matrices.system, stuck=False))
    basis, model = form.basis, car.model.spec.compile()
    model.qpos_spring[:] = car.model.model.qpos_spring
    prepare_model(model)
    start = basis.T @ np.where(np.arange(len(basis)) < 6, 1e-6, 0.0)
    state = np.zeros(len(one_step.matrix))
    state[: form.placed] = start[: form.placed]
    ends = []
    for disturbance in (np.zeros(model.nv), basis @ start):
        data, rows = mujoco.MjData(model), Rows(model, car.static.preload)
        mujoco.mj_integratePos(model, data.qpos, disturbance, 1.0)
        with installed(rows):
            for _ in range(50):
                mujoco.mj_step(model, data)
        ends.append(data.qpos.copy())
    moved = np.zeros(model.nv)
    mujoco.mj_differentiatePos(model, moved, 1.0, *ends)
    for _ in range(50):
        state = one_step.matrix @ state
    expected = basis @ np.concatenate([state[: form.placed], np.zeros(basis.shape[1] - form.placed)])
    free = np.setdiff1d(np.arange(model.nv), car.matrices.system.cyclic)
    assert np.max(np.abs(expected)) > 1e-7
    validated("Integration in MuJoCo", f"motion about the trim over 50 steps, {', '.join(changes)}", moved[free],
              expected[free], peak=2e-3, source="second derivation: one-step map from M, C, K")  # fmt: skip


def test_both_engines_ride_alike_while_braking():
    car = Car.load("sedan", ["driving.acceleration=-4"])
    runs = [car.run(Road("B", 80, duration=10), engine, channels=CHANNELS)
            for engine in ("mujoco", "reduced")]  # fmt: skip
    precise, quick = (run.recording for run in runs)
    energies, errors, shown = precise.statistics.energies, quick.statistics.errors, car.show()
    assert energies is not None and shown.steady is not None
    assert energies.residual < 1e-4
    travel = {wheel.name: wheel.travel_m for wheel in shown.steady.wheels}["fr"]
    steady = slice(2000, None)
    for channel, mean in (("suspension_travel_fr", travel), ("tyre_fr_force_x", 0.35 * 4.0 * shown.mass_kg)):
        # The mean over 8 s of a random road is known to a tenth of its standard deviation.
        spread = float(np.std(precise[channel][steady]))
        assert np.mean(precise[channel][steady]) == pytest.approx(mean, abs=0.1 * spread)
        assert np.mean(quick[channel][steady]) == pytest.approx(np.mean(precise[channel][steady]), abs=0.02 * spread)
    for channel in CHANNELS[2:]:
        ratio = np.std(quick[channel][steady]) / np.std(precise[channel][steady]) - 1.0
        # Stated is the error of linear geometry; 1e-3 is that of the friction in a step.
        assert abs(ratio - errors[channel]) < 2e-3


def test_the_support_of_a_trailing_arm_is_that_of_its_pivot():
    """The twist beam turns about its pivots, so its instant centre in the side view is the pivot."""
    car = Car.load("kinematic_reference", ["driving.acceleration=-5", "driving.brake_balance=0.6"])
    shown, points = car.show(), car.vehicle.points
    pivot, centre, patch = (np.array(points[f"{name}_rr"]) for name in ("pivot", "wheel_center", "tyre_patch"))
    assert shown.steady is not None
    tangent = (pivot[2] - patch[2]) / (centre[0] - pivot[0])
    by_hand = 100.0 * 0.4 * tangent * shown.wheelbase_m / shown.cog_height_m
    rear = shown.steady.supports[1]
    validated("Suspension kinematics", "anti-lift of a trailing arm with 40 % of the brakes", rear.percent, by_hand,
              rel=1e-3, unit="%", source="closed form: instant centre in the side view")  # fmt: skip
    assert rear.travel_m * shown.axles[1].wheel_rate_n_per_m == pytest.approx(
        0.2 * 5.0 * shown.mass_kg * tangent, rel=1e-3
    )


@pytest.mark.parametrize("reaction", ["engine", "wheel"])
def test_the_travel_is_what_the_linkage_leaves_to_the_springs(reaction):
    """dN - X tan(angle) on the wheel rate: geometry moves a little under 2 m/s2, and so do bushings."""
    shown = Car.load("sedan", ["driving.acceleration=2", f"driving.drive_reaction={reaction}"]).show()
    assert shown.steady is not None
    axle, wheel = shown.axles[0], shown.steady.wheels[0]
    angle = axle.geometry.drive_support_deg if reaction == "engine" else axle.geometry.brake_support_deg
    # In front, the drive force lifts less where its line to the swing centre rises, by 3 mm with a motor in the wheel.
    expected = (wheel.load_change_n + wheel.along_n * math.tan(math.radians(angle))) / axle.wheel_rate_n_per_m
    assert wheel.travel_m == pytest.approx(expected, rel=0.05)


def test_an_axle_of_one_piece_is_driven_at_the_contact(tmp_path):
    """Wheels, shafts and differential in the axle are one part: moments inside cancel, the force of the road is left.

    (m a / 2) tan(angle) / k is then the travel that the links take from each spring.
    """
    for block in re.findall(r"```toml\n(.*?)```", ONE_PIECE.read_text(encoding="utf-8"), re.DOTALL):
        (tmp_path / Path(block.splitlines()[0]).name).write_text(block, encoding="utf-8")
    # Bushings of the page let the axle wind up, which is 9 % of the travel.
    stiff = [f"rear.bushings.{link}_inner.stiffness=[2e8,1e8,2e8]" for link in ("lower", "upper")]
    changes = ["driving.acceleration=0.2", "driving.driven_axle=rear", *stiff]
    usual, inside, wheel, engine = (
        Car.load(tmp_path / "vehicle.toml", [*changes, *(f"driving.drive_reaction={part}" for part in reaction)]).show()
        for reaction in ([], ["axle_rl"], ["wheel"], ["engine"])
    )
    assert usual.steady == wheel.steady == inside.steady
    assert usual.steady is not None and engine.steady is not None
    axle, rear = usual.axles[1], usual.steady.wheels[2]
    rise = rear.along_n * math.tan(math.radians(axle.geometry.brake_support_deg))
    assert usual.steady.supports[1].travel_m == pytest.approx(rise / axle.wheel_rate_n_per_m, rel=1e-9)
    assert rear.travel_m == pytest.approx((rear.load_change_n - rise) / axle.wheel_rate_n_per_m, rel=0.05)
    # A beam with its differential on the engine (De Dion) has the force at the wheel centre.
    assert engine.steady.wheels[2].travel_m != pytest.approx(rear.travel_m, rel=0.05)
    assert engine.steady.supports[1].percent > 1.3 * usual.steady.supports[1].percent


def test_captions_name_the_acceleration():
    driving = Car.load("sedan", ["driving.acceleration=-3", "driving.lateral=2", ROLLING]).vehicle.driving
    assert driving.words == "rolling at 79.2 km/h, acceleration -3 m/s2, lateral acceleration 2 m/s2"
    assert Car.load("sedan", [ROLLING]).vehicle.driving.words == "rolling at 79.2 km/h"


def test_a_model_of_the_car_at_rest_is_not_written_for_one_that_accelerates(tmp_path, capsys):
    folder = tmp_path / "mjcf"
    assert mjcf(["--vehicle", "sedan", "--set", "driving.acceleration=-3", "--output", str(folder)])
    assert "writes the car at rest" in capsys.readouterr().err
    assert not folder.exists()


def test_without_acceleration_nothing_changes():
    plain = Car.load("sedan", [ROLLING])
    zero = Car.load("sedan", [ROLLING, "driving.acceleration=0", "driving.lateral=0", "driving.brake_balance=0.5"])
    assert np.array_equal(zero.static.preload, plain.static.preload)
    for name in ("mass", "damping", "stiffness", "branch_drifts"):
        assert np.array_equal(getattr(zero.matrices.system, name), getattr(plain.matrices.system, name))
    assert zero.show().steady is None


@pytest.mark.parametrize(
    ("name", "changes", "message"),
    [
        ("sedan", ["driving.acceleration=-11"], "tyre fr would need a friction coefficient of 1.1"),
        ("sedan", ["driving.lateral=14", "driving.friction=2"], "wheel rl would lift off its plate"),
        ("sedan", ["driving.acceleration=nan"], "must be a finite number"),
        ("sedan", ["driving.acceleration=-20"], "must be at least -15"),
        ("sedan", ["driving.lateral=1", "gravity=0"], "without gravity no tyre has a load"),
        ("sedan", ["driving.acceleration=1", "driving.driven_axle=middle"], "must be one of front, rear, all"),
        ("sedan", ["driving.acceleration=1", "driving.drive_reaction=door"], "must be wheel, or the name of a rigid"),
        (
            "focus",
            ["driving.acceleration=-3"],
            "stands on rear.bushings.rear_support, whose share of the forces is unknown",
        ),
    ],
)
def test_what_no_car_can_do_is_refused(name, changes, message):
    with pytest.raises(ConfigurationError, match=message) as caught:
        _ = Car.load(name, changes).model
    assert str(caught.value).count("\n") == 0


def test_a_sweep_over_the_acceleration_builds_each_car():
    """Loads of variants are those of cars loaded so, and the reduced engine takes the trim of each."""
    car = Car.load("sedan", ["driving.acceleration=-2"])
    for acceleration in (-4.0, 0.0):
        variant = car.with_({"driving.acceleration": acceleration})
        loaded = Car.load("sedan", [f"driving.acceleration={acceleration}"])
        assert variant.static.tyre_load == loaded.static.tyre_load
        assert np.array_equal(variant.matrices.system.stiffness, loaded.matrices.system.stiffness)
    heavier, loaded = (
        car.with_({"body.mass": 1300.0}),
        Car.load("sedan", ["driving.acceleration=-2", "body.mass=1300"]),
    )
    assert heavier.static.tyre_load == loaded.static.tyre_load


@pytest.mark.parametrize("engine", ["mujoco", "reduced"])
def test_a_tyre_that_loses_its_grip_on_a_cleat_is_named(engine):
    """At 0.95 of the friction a loss of 5 % of the load is enough; on a level road there is none."""
    car = Car.load("sedan", ["driving.acceleration=-4", "driving.brake_balance=0.6"])
    grip, loads = car.static.tyre_grip, car.static.tyre_load
    friction = max(grip[wheel] / loads[wheel] for wheel in loads) / 0.95
    run = car.with_({"driving.friction": friction}).run(Road("cleat:10x50", 40, duration=4), engine)
    (text,) = [notice for notice in run.recording.statistics.notices if "would slide" in notice]
    wheel = max(loads, key=lambda name: grip[name] / loads[name])
    share = np.mean(friction * run.recording[f"tyre_{wheel}_force_z"] < grip[wheel])
    assert 0.0 < share < 0.5 and text.startswith(f"tyre {wheel[:1]}")
    rough = car.with_({"driving.friction": 2.0}).run(Road("cleat:10x50", 40, duration=4), engine)
    assert not [notice for notice in rough.recording.statistics.notices if "would slide" in notice]
