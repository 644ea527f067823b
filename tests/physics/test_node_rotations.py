"""Elements with a rotational stiffness on a flexible body whose nodes have rotations: against all of K and M."""

import mujoco
import numpy as np
import pytest
import scipy

from tests.engines.simulation.row_model import (
    QUARTER_TURN,
    TURN,
    Stepper,
    add_bushing,
    add_flexible_body,
    element_law,
    empty_spec,
)
from tests.model.flexbody.box_body import MASSES, PAIRS, POSITIONS, SECTION, box_fields
from tests.validation import validated
from vehicle.commands import body as body_command
from vehicle.engines.linear.car_matrices import car_matrices
from vehicle.engines.simulation.static_trim import StaticTrim
from vehicle.model.flexbody.beam import frame_stiffness
from vehicle.model.flexbody.body_model import BODY_DESIGN
from vehicle.model.flexbody.frame_modes import condense_rotations
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal

STIFFNESS = frame_stiffness(POSITIONS, [(a, b, SECTION) for a, b in PAIRS])
_, RECOVERY = condense_rotations(STIFFNESS)
ROTATIONS = np.arange(48).reshape(8, 6)[:, 3:]
NODE, HELD = 6, {0: 2e5, 3: 1e5, 5: 3e5}
"""Corner with the rotational spring; corners on springs to the ground [N/m], for a static response."""
TWIST = 2e4
"""As stiff as the beams, so that 10 % of it would show in the frequencies."""


def all_modes():
    """Return the box with all 18 elastic modes and the rotations of its corners in them."""
    fields = box_fields(18)
    turns = (RECOVERY @ fields["shapes"].reshape(18, -1).T)[ROTATIONS]  # (8, 3, 18)
    rotations = {name: turn.T for name, turn in zip(fields["nodes"], turns, strict=True)}
    return Superelement(**fields | {"rotations": rotations, "residual": {}})


BOX = all_modes()


def held_box(*, twist=TWIST, carrier=True, turned=False, rotations=True, preload=None, step=1e-4):
    """Return the box on three springs, and between a corner and the ground a spring against rotation."""
    spec = empty_spec(step)
    body = add_flexible_body(spec, BOX, turned=turned)
    for node in (*HELD, NODE):
        arm = BOX.positions[node] - BOX.cog
        ground = TURN @ arm if turned else arm
        law = element_law([HELD.get(node, 0.0)] * 3, rotational=twist if node == NODE else 0.0)
        sides = (spec.worldbody, body, ground, arm) if carrier else (body, spec.worldbody, arm, ground)
        add_bushing(spec, f"at_{node}", *sides[:2], law, at=sides[2], on_carrier=sides[3])
        spec.add_numeric(name=f"shape/bushing/at_{node}", data=BOX.shape_at(f"corner_{node}").ravel())
        if rotations and node == NODE:
            psi = BOX.rotations[f"corner_{node}"].T
            spec.add_numeric(name=f"rotation/bushing/at_{node}", data=psi.ravel())
    if turned:  # the ground's frame turns with it, so that the spring is without load
        spec.site(f"bushing/at_{NODE}/{'moving' if carrier else 'carrier'}").quat = QUARTER_TURN
    return Stepper(spec, preload)


def linear(run, preload=None):
    size = run.rows.layout.row_count + 3
    static = np.zeros(size) if preload is None else preload
    trim = StaticTrim(preload=static, tyre_load={}, support_load={}, residual=0.0)
    return car_matrices(run.model, trim).system


def whole_frame():
    """Return K and M of all six freedoms a corner, with the springs.

    The modes of translations omit the additional rotation of a corner, K_rr^-1: the spring of the frame is the one
    that is K_rot with this in series.
    """
    stiffness = STIFFNESS.copy()
    for node, k in HELD.items():
        stiffness[6 * node + np.arange(3), 6 * node + np.arange(3)] += k
    beside = np.linalg.inv(STIFFNESS[np.ix_(ROTATIONS.ravel(), ROTATIONS.ravel())])[3 * NODE :, 3 * NODE :][:3, :3]
    spring = np.linalg.inv(np.eye(3) / TWIST - beside)
    assert np.linalg.eigvalsh(spring)[0] > 0.0
    stiffness[np.ix_(ROTATIONS[NODE], ROTATIONS[NODE])] += spring
    return condense_rotations(stiffness)[0], np.repeat(MASSES, 3)


@pytest.mark.parametrize("carrier", [True, False], ids=["body carries", "body moves"])
@pytest.mark.parametrize("turned", [False, True], ids=["upright", "turned by 90 degrees"])
def test_frequencies_are_those_of_the_whole_frame(carrier, turned):
    stiffness, mass = whole_frame()
    exact = np.sqrt(scipy.linalg.eigh(stiffness, np.diag(mass), eigvals_only=True)) / (2.0 * np.pi)
    frequencies = {}
    for with_rotations in (True, False):
        system = linear(held_box(carrier=carrier, turned=turned, rotations=with_rotations))
        # The armature of the integration is a mass of the run: the bodies' own is wanted.
        reduced_mass = system.mass.copy()
        reduced_mass[np.arange(6, 24), np.arange(6, 24)] = 1.0
        frequencies[with_rotations] = np.sqrt(scipy.linalg.eigh(system.stiffness, reduced_mass, eigvals_only=True)) / (
            2.0 * np.pi
        )
    # Central differences of the forces leave 1e-8.
    place = f"{'body carries' if carrier else 'body moves'}, {'turned' if turned else 'upright'}"
    validated(
        "Body models", f"frequencies of a frame with a rotational spring at a node, {place}", frequencies[True], exact,
        rel=1e-6, unit="Hz", source="second derivation: K and M of all six degrees of freedom of each corner",
    )  # fmt: skip
    assert np.max(np.abs(frequencies[False] / exact - 1.0)) > 0.01


def test_static_response_to_a_torque_is_that_of_the_whole_frame():
    torque = np.array([300.0, -200.0, 500.0])
    stiffness = STIFFNESS.copy()
    for node, k in HELD.items():
        stiffness[6 * node + np.arange(3), 6 * node + np.arange(3)] += k
    load = np.zeros(48)
    load[ROTATIONS[NODE]] = torque
    exact = np.linalg.solve(stiffness, load).reshape(8, 6)[:, :3]
    run = held_box(twist=1e-6, carrier=False)  # the torque comes from outside, as a preload
    preload = np.zeros(run.rows.layout.row_count + 3)
    preload[-3:] = torque
    run = held_box(twist=1e-6, carrier=False, preload=preload)
    run.step(1, run.position)
    force = run.data.qfrc_applied.copy()
    system = linear(held_box(twist=1e-6, carrier=False))
    moved = np.linalg.solve(system.stiffness, force)
    rigid = moved[:3] + np.cross(moved[3:6], BOX.positions - BOX.cog)
    displacement = rigid + np.einsum("mni,m->ni", BOX.shapes, moved[6:])
    validated(
        "Body models", "static displacement of a frame under a torque at a node", displacement, exact, peak=1e-6,
        unit="m",
        source="second derivation: K of all six degrees of freedom of each corner",
    )  # fmt: skip


def test_the_run_vibrates_as_the_whole_frame():
    stiffness, mass = whole_frame()
    run = held_box()
    system = linear(run)
    _, shapes = scipy.linalg.eigh(system.stiffness, system.mass)
    squares = scipy.linalg.eigh(stiffness, np.diag(mass), eigvals_only=True)
    count = 600
    times = run.h * (np.arange(count) + 0.5)  # the velocity of half a step before the start is zero
    for number in (7, 12):
        run, way = held_box(), 1e-3 * shapes[:, number]
        mujoco.mj_integratePos(run.model, run.data.qpos, way, 1.0)
        amplitude = run.step(count, run.position)[:, 7:] @ way[6:] / (way[6:] @ way[6:])
        swing = np.cos(np.sqrt(squares[number]) * times)
        assert swing.min() < -0.9
        # (w h)^2/8 from the start, and what the box turns by.
        validated(
            "Integration in MuJoCo", f"free vibration of a frame in its natural mode {number}", amplitude, swing,
            abs=2e-3, source="closed form: cos w t, w from K and M of the whole frame",
        )  # fmt: skip


@pytest.mark.parametrize("carrier", [True, False], ids=["body carries", "body moves"])
def test_a_static_torque_turns_with_the_node_that_carries_it(carrier):
    load = np.array([2e3, -1e3, 3e3])
    preload = np.zeros(held_box().rows.layout.row_count + 3)
    preload[-3:] = load
    with_load, without = (
        linear(held_box(carrier=carrier, preload=at_rest), at_rest).stiffness
        for at_rest in (preload, np.zeros_like(preload))
    )
    psi = BOX.rotations[f"corner_{NODE}"].T
    # T = C p on the ground, -T on the node; d(theta x p)/dq = -[p]x Psi. The ground does not turn.
    moment_change = np.cross(psi, load, axisa=0, axisc=0) if carrier else np.zeros((3, 18))
    change = (with_load - without)[6:, 6:]
    validated(
        "Linear system",
        f"stiffness of a static torque that turns with its node, {'body carries' if carrier else 'body moves'}", change,
        psi.T @ moment_change, abs=1e-7 * np.abs(without).max(), source="closed form: d(theta x p) / dq",
    )  # fmt: skip
    assert not carrier or np.abs(psi.T @ moment_change).max() > 1e-5 * np.abs(without).max()


def test_both_engines_see_the_rotations_of_a_body_design(tmp_path, capsys):
    design = BODY_DESIGN.read_text(encoding="utf-8").replace("mode_count", "node_rotations = true\nmode_count")
    (tmp_path / "turning.toml").write_text(design, encoding="utf-8")
    stiff = [
        "front.bushings.suspension_mount.rotational_stiffness=3000",
        "engine.bushings.linear_mount.rotational_stiffness=3000",
    ]
    time = np.arange(0.0, 0.6, 1e-3)
    signal = Signal(time=time, displacement={"fr": 2e-3 * np.sin(2.0 * np.pi * (5.0 + 20.0 * time) * time)})
    rigid = Car(load_vehicle(None, stiff)).run(signal, engine="reduced")
    car = Car(load_vehicle(None, [*stiff, "body.superelement=turning.toml"]), folder=tmp_path)
    runs = [car.run(signal, engine=engine) for engine in ("mujoco", "reduced")]
    channel = "engine_acc_x"
    size, (stepped, linear) = np.std(runs[0][channel]), (run[channel] for run in runs)
    # The step of 0.5 ms leaves 0.1 %, with and without rotations.
    assert np.std(stepped - linear) < 0.003 * size
    assert np.std(rigid[channel] - linear) > 0.01 * size
    for file, notice in (
        (
            tmp_path / "turning.toml",
            "the body model contains the rotations at these points with rotational stiffness: strut_top_fr",
        ),
        (None, "rotational stiffness: missing at strut_top_fr"),
    ):
        options = [] if file is None else ["--vehicle", str(write_vehicle(tmp_path, file.name))]
        assert body_command.main(["show", *options]) == 0
        assert notice in capsys.readouterr().out


def write_vehicle(folder, body):
    """The shipped car on another body."""
    path = folder / "vehicle.toml"
    text = FOCUS_FILE.read_text(encoding="utf-8").replace('"body_design.toml"', f'"{body}"')
    path.write_text(text, encoding="utf-8")
    return path
