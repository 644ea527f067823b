"""Gravity and static trim: the car is in equilibrium in its design position."""

import mujoco
import numpy as np
import pytest

from tests.validation import validated
from vehicle.engines.simulation.law_arrays import law_names
from vehicle.engines.simulation.row_layout import read_layout
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal, uniform_time


def at_rest(seconds):
    time = uniform_time(samples=int(1000 * seconds) + 1, timestep=1e-3)
    return Signal(time=time, displacement={"fr": np.zeros(time.size)})


def test_the_residual_is_below_a_micrometre(car):
    validated(
        "Static equilibrium", "rest of the car: displacement that is left after the trim", car.model.static.residual,
        0.0, abs=1e-6, unit="m", source="conservation: equilibrium of all forces",
    )  # fmt: skip


def test_ground_forces_and_weight_are_in_equilibrium(car):
    # All six components: the forces of tyres and rubber blocks at their points, the weight of every body at its place.
    model, static = car.model.model, car.model.static
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    layout = read_layout(model)
    force, moment = np.zeros(3), np.zeros(3)
    for name, rows in zip(law_names(model).bushings, layout.bushings.rows, strict=True):
        if name.startswith(("bushing/tyre", "bushing/rear_support")):
            load = static.preload[rows]
            force += load
            moment += np.cross(data.site(f"{name}/moving").xpos, load)
            # Its law is a torque about the same point too.
            torques = static.preload[layout.row_count :].reshape(-1, 3)
            site = model.site(f"{name}/moving").id
            moment += torques[list(layout.rotations.sites[:, 0]).index(site)]
    for body in range(1, model.nbody):
        weight = model.body_mass[body] * model.opt.gravity
        force += weight
        moment += np.cross(data.xipos[body], weight)
    total = car.vehicle.gravity * model.body_mass.sum()
    law = "conservation: forces of tyres and supports at their points, weight of every body at its place"
    validated(
        "Static equilibrium", "forces on the parked car are in equilibrium", force, np.zeros(3), abs=1e-9 * total,
        unit="N", source=law,
    )  # fmt: skip
    validated(
        "Static equilibrium", "moments on the parked car are in equilibrium", moment, np.zeros(3), abs=1e-8 * total,
        unit="N m", source=law,
    )  # fmt: skip


def test_the_ground_pulls_nowhere_sideways(car):
    # On plates and rubber blocks a parked car relaxes: rolled into place and shaken, it is not pinched by thousands of
    # newtons sideways. Then the vertical loads follow from the moments alone.
    model, static = car.model.model, car.model.static
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    points = car.vehicle.points
    front, rear = points["tyre_patch_fr"][0], points["rear_support_right"][0]
    weight = car.vehicle.gravity * model.body_mass.sum()
    centre = np.sum(model.body_mass * data.xipos[:, 0]) / model.body_mass.sum()
    axle = weight * (rear - centre) / (rear - front)
    # One per cent for the torques of the 100 N m/rad bushings.
    validated(
        "Static equilibrium", "load of the front axle", sum(static.tyre_load.values()), axle, rel=0.01, unit="N",
        source="closed form: lever of the weight between front tyres and rear supports",
    )  # fmt: skip


def test_left_and_right_carry_nearly_the_same(car):
    # Only engine mounts and torque arm stand off the middle plane, and they are inner forces: the masses are mirrored.
    static = car.model.static
    validated(
        "Static equilibrium", "right front wheel carries as much as the left one", static.tyre_load["fr"],
        static.tyre_load["fl"], rel=1e-3, unit="N", source="conservation: masses mirrored at the middle plane",
    )  # fmt: skip
    assert static.support_load["rear_support_right"] == pytest.approx(
        static.support_load["rear_support_left"], rel=1e-3
    )


@pytest.mark.parametrize(
    "settings", [[], ["body.flexible=false"], ["body.attachment_flexibility=false"], ["body.inertia.ixx=1200"]]
)
def test_without_input_nothing_moves(settings):
    run = Car.load(None, settings).run(at_rest(1.0))
    largest = max(np.max(np.abs(run[channel])) for channel in run.car.vehicle.acceleration_channels)
    validated(
        "Static equilibrium", f"without input nothing accelerates, {settings or 'nominal car'}", largest, 0.0, abs=1e-6,
        unit="m/s2", source="conservation: a car at rest stays at rest",
    )  # fmt: skip
    assert max(np.max(np.abs(run[f"damper_{wheel}_velocity"])) for wheel in ("fr", "fl")) < 1e-9
    static = run.car.model.static
    np.testing.assert_allclose(run["tyre_fr_force_z"], static.tyre_load["fr"], rtol=1e-6)
    energies = run.recording.statistics.energies
    assert energies is not None
    assert energies.residual < 1e-3 or abs(energies.work_in) < 1e-9
