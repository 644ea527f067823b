"""Many cars at once against each of them alone: the same bits in any company, the same motion, exact friction."""

import dataclasses
from typing import Any

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from tests.engines.linear.plain_matrices import plain_matrices
from tests.engines.reduced.test_reduced_quarter_car import damper, matrices
from tests.scenarios.lumped.stick_slip import ExactStickSlip
from vehicle.engines.reduced.batch_simulation import COARSE_STEP, simulate_batch
from vehicle.engines.reduced.pole_model import pole_model
from vehicle.engines.reduced.reduced_run import LONGEST_STEP, simulate_reduced
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal, uniform_time

ROAD = random_road(rms=1e-3, seed=5, wheel="fr", duration=2.0)
CHANNELS = [
    *(f"seat_rail_acc_{axis}" for axis in "xyz"),
    *(f"damper_{wheel}_{kind}" for wheel in ("fr", "fl") for kind in ("velocity", "force")),
    *("knuckle_fr_acc_z", "tyre_fr_force_z", "tyre_fl_force_z", "plate_fr_displacement", "plate_fl_displacement"),
]
LAWS: dict[str, dict[str, Any]] = {
    "coulomb": {},
    "stribeck": {"coulomb_friction": 60.0, "friction_law": "stribeck"},
    "degressive": {"coulomb_friction": 60.0, "viscous_law": "degressive"},
    "table": {"viscous_law": "table", "velocity": (-0.5, 0.0, 0.05, 0.5), "force": (-1400.0, 0.0, 350.0, 1362.5)},
    "no friction": {"coulomb_friction": 0.0},
}
"""Laws with one least slope, 2250 N s/m, which the poles hold."""


def dampers(car, name):
    return [dataclasses.replace(damper.law, **LAWS[name]) for damper in car.vehicle.composition.dampers]


def with_idle_poles(model, pairs, reals):
    """Add idle poles to a car, since another car may have more poles."""
    at = [model.pairs] * pairs + [len(model.poles)] * reals
    return dataclasses.replace(
        model,
        poles=np.insert(model.poles, at, [-5.0 + 3.0j] * pairs + [-7.0] * reals),
        pairs=model.pairs + pairs,
        scalar_rows=dataclasses.replace(model.scalar_rows, poles=np.insert(model.scalar_rows.poles, at, 0.0, axis=1)),
        **{
            name: np.insert(getattr(model, name), at, 0.0, axis=0)
            for name in ("height", "velocity", "force", "slope", "scalar_force", "applied")
        },
        **{name: np.insert(getattr(model, name), at, 0.0, axis=1) for name in ("slip", "modal", "branch")},
    )


def run_many(models, laws, signal, tyre_load, channels=CHANNELS, **more):
    return simulate_batch(
        models, signal, dampers=laws, record_rate=1000.0, tyre_load=tyre_load, channels=channels, **more
    )


@pytest.fixture(scope="module")
def company(car):
    """Ten cars of all laws and of several numbers of poles, their laws and tyre loads."""
    models = [with_idle_poles(car.poles, k % 3, (2 * k) % 5) for k in range(10)]
    laws = [dampers(car, name) for name in (*LAWS, *LAWS)]
    return models, laws, [car.model.static.tyre_load] * 10


@pytest.fixture(scope="module")
def batch_of_ten(company):
    models, laws, loads = company
    return run_many(models, laws, ROAD, loads)


@pytest.mark.parametrize("order", [[9], [3, 1], [9, 8, 7, 6, 5, 4, 3, 2, 1, 0]])
def test_a_car_is_bitwise_independent_of_the_other_cars(company, batch_of_ten, order):
    chosen = [[part[k] for k in order] for part in company]
    other = run_many(chosen[0], chosen[1], ROAD, chosen[2], channels=CHANNELS[::-1])
    for index, k in enumerate(order):
        for name in CHANNELS:
            np.testing.assert_array_equal(other.channels[name][index], batch_of_ten.channels[name][k], err_msg=name)
        assert other.statistics[index].warnings == batch_of_ten.statistics[k].warnings


@pytest.mark.parametrize("name", LAWS)
def test_a_car_of_a_batch_moves_as_in_a_single_run(company, batch_of_ten, name):
    models, laws, loads = company
    k = list(LAWS).index(name)
    single, same = (
        simulate_reduced(
            models[k], ROAD, dampers=laws[k], record_rate=1000.0, tyre_load=loads[k], channels=CHANNELS, step=step
        )
        for step in (LONGEST_STEP / 8.0, COARSE_STEP)
    )
    for channel in CHANNELS:
        # One march in two precisions: round-off, and the poles that are not integrated in single precision.
        difference = np.std(batch_of_ten.channels[channel][k] - same[channel])
        assert difference <= 1e-3 * np.std(same[channel]), channel
    for step, of_rail, bound in ((COARSE_STEP, 6e-3, 0.02), (LONGEST_STEP, 1.5e-3, 4e-3)):
        batch = run_many(models[k : k + 1], laws[k : k + 1], ROAD, loads, step=step)
        for channel in CHANNELS:
            difference = np.std(batch.channels[channel][0] - single[channel])
            largest = of_rail if channel.startswith("seat_rail") else bound
            # A force jumps, and the others only where it does.
            assert difference <= largest * np.std(single[channel]), (channel, step)
        assert batch.recording(0).statistics.warnings == single.statistics.warnings


def test_cars_of_a_batch_that_need_double_precision(car):
    """One whose dampers move each other by a tenth, as tied by a lever."""
    signal = Signal(time=ROAD.time[:301], displacement={"fr": ROAD.displacement["fr"][:301]})
    plain, load = dampers(car, "coulomb"), car.model.static.tyre_load
    force, slip = car.poles.force, car.poles.slip
    tied = dataclasses.replace(car.poles, force=force + 0.1 * force[:, ::-1], slip=slip + 0.1 * slip[::-1])
    models, laws = [car.poles, tied, car.poles], [plain, plain, dampers(car, "stribeck")]
    batch = run_many(models, laws, signal, [load] * 3)
    single = simulate_reduced(
        tied, signal, dampers=plain, record_rate=1000.0, tyre_load=load, channels=CHANNELS, step=COARSE_STEP
    )
    assert batch.statistics[1].timestep == single.statistics.timestep == COARSE_STEP
    for name in CHANNELS:
        np.testing.assert_array_equal(batch.channels[name][1], single[name], err_msg=name)
    others = run_many(models[::2], laws[::2], signal, [load] * 2)
    for row, position in enumerate((0, 2)):
        assert batch.statistics[position].timestep == COARSE_STEP
        for name in CHANNELS:
            np.testing.assert_array_equal(batch.channels[name][position], others.channels[name][row], err_msg=name)


def test_set_valued_friction_under_a_sine():
    """A mass on a tyre over a plate, its damper to the ground: Den Hartog's oscillator, with stops, in closed form."""
    stiffness, limit, omega = 100.0, 18.0, 4.0
    system = plain_matrices(
        mass=np.eye(2), damping=np.zeros((2, 2)), stiffness=stiffness * np.eye(2), dampers=np.array([0, 1]),
        viscous=np.zeros(2), plate_stiffness=stiffness * np.eye(2), plate_damping=np.zeros((2, 2)),
        tyre_stiffness=np.full(2, stiffness), tyre_damping=np.zeros(2),
        outputs={"knuckle_fr_acc_z": np.array([1.0, 0.0])}, body_rows={"body": np.zeros((6, 2))},
        body_masses={"body": np.eye(6)},
    )  # fmt: skip
    law = dataclasses.replace(load_vehicle().damper, viscous=0.0, coulomb_friction=limit)
    time = uniform_time(samples=4001, timestep=1e-3)
    plate = 0.3 * np.sin(omega * time)
    batch = run_many(
        [pole_model(system)], [[law, law]], Signal(time=time, displacement={"fr": plate}), [{"fr": 0.0, "fl": 0.0}],
        channels=["tyre_fr_force_z", "damper_fr_velocity"],
    )  # fmt: skip
    exact = ExactStickSlip(1.0, stiffness, limit, 0.3 * stiffness, omega)
    pieces = exact.motion(4.0, 0.0, 0.0)
    assert 0.1 < sum(end - start for start, end, phase, _ in pieces if phase == 0) / 4.0 < 0.9
    position = plate - batch.channels["tyre_fr_force_z"][0] / stiffness
    # In stick the clamped law creeps with at most 16 um/s.
    assert np.max(np.abs(position - exact.sample(pieces, time))) < 2e-5


def test_a_stuck_damper_is_of_third_order():
    time = uniform_time(samples=1001, timestep=1e-3)
    plate = 5e-4 * np.sin(np.pi * time) ** 4 * np.sin(2.0 * np.pi * 25.0 * time)
    law, channel = damper(coulomb_friction=5e3), "suspension_mount_fr_acc_z"
    run = {
        "signal": Signal(time=time, displacement={"fr": plate}),
        "tyre_load": [{"fr": 1e6, "fl": 1e6}],
        "channels": [channel, "damper_fr_velocity"],
    }
    coarse, middle, fine = (
        run_many([pole_model(matrices())], [[law, law]], step=step, **run).channels[channel][0]
        for step in (1e-3, 5e-4, 1.25e-4)
    )
    errors = [float(np.std(coarser - fine)) for coarser in (coarse, middle)]
    # Eight times; four times with a force that is constant over a step.
    assert errors[0] / errors[1] > 6.0


def test_four_dampers_and_four_plates():
    car = Car.load("focus_road")
    late = {wheel: np.roll(ROAD.displacement["fr"], 40 * k) for k, wheel in enumerate(car.vehicle.wheels)}
    signal = Signal(time=ROAD.time[:801], displacement={wheel: z[:801] for wheel, z in late.items()})
    laws, loads = [damper.law for damper in car.vehicle.composition.dampers], car.model.static.tyre_load
    channels = ["seat_rail_acc_z", *(f"damper_{wheel}_velocity" for wheel in car.vehicle.wheels), "tyre_rl_force_z"]
    single = simulate_reduced(car.poles, signal, dampers=laws, record_rate=1000.0, tyre_load=loads, channels=channels)
    batch = run_many([car.poles], [laws], signal, [loads], channels=channels)
    for channel in channels:
        assert np.std(batch.channels[channel][0] - single[channel]) < 5e-3 * np.std(single[channel]), channel
    assert batch.statistics[0].within_validity == single.statistics.within_validity


def test_only_the_car_outside_the_valid_range_is_reported(car):
    violent = Signal(time=ROAD.time, displacement={"fr": 40.0 * ROAD.displacement["fr"]})
    loads = [car.model.static.tyre_load, dict.fromkeys(("fr", "fl"), 1000000000.0)]
    batch = run_many([car.poles] * 2, [dampers(car, "coulomb")] * 2, violent, loads, channels=["seat_rail_acc_z"])
    single = simulate_reduced(
        car.poles, violent, dampers=dampers(car, "coulomb"), record_rate=1000.0, tyre_load=loads[0],
        channels=["seat_rail_acc_z"],
    )  # fmt: skip
    assert len(single.statistics.warnings) > len(batch.statistics[1].warnings)
    assert [text[:20] for text in batch.statistics[0].warnings] == [text[:20] for text in single.statistics.warnings]
    assert not batch.statistics[0].within_validity
