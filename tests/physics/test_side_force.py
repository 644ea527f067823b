"""Friction of a damper that grows with the side force on its rod: by the statics of a strut, and in both engines."""

import mujoco
import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from tests.engines.simulation.row_model import (
    Stepper,
    add_bushing,
    add_damper,
    add_free_body,
    add_mass,
    element_law,
    empty_spec,
)
from tests.validation import validated
from vehicle.engines.reduced.batch_simulation import simulate_batch
from vehicle.engines.simulation.row_layout import equality_rows
from vehicle.engines.simulation.rows import Rows
from vehicle.errors import ConfigurationError
from vehicle.model.laws.damper import RECORD
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road

LIMIT, COEFFICIENT = 100.0, 0.2
SIDE = {f"{axle}.damper.side_force_coefficient": 0.3 for axle in ("front", "rear")}


def leaning_strut(lean, height, offset):
    """A wheel carrier on a ball joint at the origin, held at the top by the rod of its damper, which leans sideways.

    A load acts upwards at the distance `offset` beside the ball joint; the mount of the rod is `height` above it.
    """
    spec = empty_spec(1e-3)
    upright = add_free_body(spec, "upright", 20.0, [1.0] * 3)
    spec.worldbody.add_site(name="bushing/ball/carrier")
    upright.add_site(name="bushing/ball/moving")
    # A stiff bushing in place of the ball joint; a weak rotational spring keeps the carrier from turning about the rod.
    spec.add_equality(
        name="bushing/ball", type=mujoco.mjtEq.mjEQ_CONNECT, objtype=mujoco.mjtObj.mjOBJ_SITE,
        name1="bushing/ball/moving", name2="bushing/ball/carrier",
    )  # fmt: skip
    spec.add_numeric(name="law/bushing/ball", data=element_law([1e9] * 3, [1e5] * 3, rotational=10.0, averaged=True))
    axis = np.array([0.0, np.sin(lean), np.cos(lean)])
    top = axis * height / np.cos(lean)
    rod = add_mass(upright, "rod", 1.0, position=top)
    add_damper(spec, rod, [500.0, 1e5, LIMIT, LIMIT, 1.0, 1.0])
    spec.joint("damper_fr").axis = axis
    parameters = np.array(spec.actuator("damper_fr").biasprm)
    assert RECORD.names is not None
    parameters[RECORD.names.index("side_force")] = COEFFICIENT
    spec.actuator("damper_fr").biasprm = parameters
    add_bushing(
        spec, "top", rod, spec.worldbody, element_law([1e9] * 3, [1e5] * 3, averaged=True), on_carrier=tuple(top)
    )
    run = Stepper(spec)

    def before(_):
        run.data.xfrc_applied[1] = [0.0, 0.0, 1000.0, 1000.0 * offset, 0.0, 0.0]

    return run, before, np.linalg.norm(top)


@pytest.mark.parametrize("lean", [0.0, 0.2])
def test_the_limit_is_that_of_the_statics_of_a_strut(lean):
    run, before, length = leaning_strut(lean, 0.6, 0.15)
    limit = run.step(3000, lambda: run.rows.state.limit[0], before)[-1]
    # Moments about the ball joint: load times offset = side force times length of the strut.
    validated(
        "Dampers and friction", f"friction limit of a strut that leans by {lean:g} rad and carries a side force", limit,
        LIMIT + COEFFICIENT * 1000.0 * 0.15 / length, rel=1e-6, unit="N",
        source="closed form: moments about the lower ball joint",
    )  # fmt: skip


def test_the_side_force_of_the_car_is_that_of_its_statics():
    """Both engines begin with the force across the slide that equilibrium gives to the parts below the mount."""
    car = Car.load("focus_road", SIDE)
    sides = np.hypot(*car.matrices.sides.static.reshape(-1, 2).T)
    rows, data = Rows(car.model.model, car.model.static.preload), mujoco.MjData(car.model.model)
    model = rows.model
    mujoco.mj_kinematics(model, data)
    rod = model.body("damper_top_fr").id
    axis = data.xaxis[model.joint("damper_fr").id]
    # The rod is fixed to the knuckle but for its slide: together they are free of what holds them from outside.
    below = [i for i in range(model.nbody) if model.body_rootid[i] == model.body_rootid[rod]]
    weight = model.opt.gravity * model.body_mass[below].sum()
    others = np.zeros(3)
    directions = {rows.laws.bushings[index]: way for index, way in rows.directions.items()}
    for name, row in equality_rows(model).items():
        if model.eq_type[model.equality(name).id] == mujoco.mjtEq.mjEQ_CONNECT:
            ends = [model.site_bodyid[model.site(f"{name}/{end}").id] for end in ("moving", "carrier")]
            inside = [end in below for end in ends]
            if sum(inside) == 1 and rod not in ends:
                force = directions.get(name, np.eye(3)).T @ car.model.static.preload[row.start : row.stop]
                others += force if inside[0] else -force
    for name, row in zip(rows.laws.springs, rows.layout.springs.rows, strict=True):
        if name == "main_spring_fr":
            low, high = (data.site_xpos[model.site(f"{name}/{end}").id] for end in ("lower", "upper"))
            others -= car.model.static.preload[row] * (high - low) / np.linalg.norm(high - low)
    mount = -(others + weight)
    across = mount - axis * (mount @ axis)
    assert sides[2] < 0.01 * sides[0]  # a damper between two joints
    validated(
        "Dampers and friction", "static side force on the front rod of focus_road", sides[0], np.linalg.norm(across),
        rel=1e-6, unit="N", source="second derivation: balance of all other forces on the wheel carrier",
    )  # fmt: skip


@pytest.mark.parametrize("law", ["coulomb", "presliding"])
def test_every_channel_against_mujoco(law):
    changes: dict[str, object] = {**SIDE}
    if law == "presliding":
        changes |= {f"{axle}.damper.{path}": value for axle in ("front", "rear")
                    for path, value in (("friction_law", law), ("presliding_stiffness", 5e5))}  # fmt: skip
    car, road = Car.load("focus_road", changes), Road("A", speed=80, duration=6)
    stepped, reduced = car.run(road), car.run(road, engine="reduced")
    ratios = {
        name: np.std(reduced[name][3000:]) / np.std(values[3000:])
        for name, values in stepped.recording.channels.items()
        if np.std(values) > 0.0
    }
    # Sideways the knuckles move to second order in the travel. A damper top is light and jumps where friction lets go.
    light = [name for name in ratios if name.startswith("damper_top")]
    kept = [name for name in ratios if name not in light and not (name.startswith("knuckle") and name[-1] in "xy")]
    for names, tolerance, which in ((kept, 5e-3, "all other channels"), (light, 1e-2, "the damper tops")):
        validated(
            "Reduced engine", f"RMS of {which} over that of MuJoCo, side force and {law} friction",
            np.array([ratios[name] for name in names]), 1.0, abs=tolerance, source="second derivation: MuJoCo",
        )  # fmt: skip


def test_a_batch_of_different_laws_has_the_values_of_each_car():
    signal = random_road(rms=2e-3, seed=7, wheel="fr", duration=2.0, lower_band_edge=0.5, upper_band_edge=30.0)
    laws: list[dict[str, object]] = [
        {},
        {"damper.side_force_coefficient": 0.2},
        {"damper.friction_law": "presliding", "damper.presliding_stiffness": 5e5},
        {"damper.side_force_coefficient": 0.1},
    ]
    cars = [Car.load("focus", changes) for changes in laws]

    def batch(chosen):
        return simulate_batch(
            [car.poles for car in chosen], signal, record_rate=1000.0,
            dampers=[[damper.law for damper in car.vehicle.composition.dampers] for car in chosen],
            tyre_load=[car.model.static.tyre_load for car in chosen],
            channels=["seat_rail_acc_z", "knuckle_fr_acc_z"],
        )  # fmt: skip

    together = batch(cars)
    for index, car in enumerate(cars):
        alone = batch([car])
        for name in ("seat_rail_acc_z", "knuckle_fr_acc_z"):
            assert np.array_equal(together.channels[name][index], alone.channels[name][0])
    assert np.std(together.channels["seat_rail_acc_z"][1]) != np.std(together.channels["seat_rail_acc_z"][0])


def test_a_rod_without_a_bushing_is_refused():
    run, _, _ = leaning_strut(0.0, 0.6, 0.15)
    assert run.rows.layout.sides.dampers.tolist() == [0]
    spec = empty_spec(1e-3)
    body = add_mass(spec.worldbody, "mass", 1.0)
    add_damper(spec, body, [500.0, 1e5, LIMIT, LIMIT, 1.0, 1.0])
    parameters = np.array(spec.actuator("damper_fr").biasprm)
    parameters[9] = COEFFICIENT
    spec.actuator("damper_fr").biasprm = parameters
    with pytest.raises(ConfigurationError) as caught:
        Rows(spec.compile())
    assert str(caught.value) == (
        "damper_fr: side_force_coefficient is 0.2, but its side force is unknown, because no bushing holds the "
        "rod; set the coefficient to 0, or give the mount of the rod a stiffness"
    )
