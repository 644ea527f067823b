"""Orders of an engine: crank drive by its kinetic energy and by series, gas by its work, cylinders by their firing."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tests.validation import validated
from vehicle import Car, road
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.engine_orders import EngineOrders
from vehicle.model.parameters.slider_crank import block_forces, crank_angles, gas_torque, piston

FOUR: dict[str, Any] = {
    "cylinders": 4, "bore": 0.079, "stroke": 0.0814, "rod": 0.137, "reciprocating_mass": 0.45, "spacing": 0.087,
    "firing": [1, 3, 4, 2], "torque": 60.0,
}  # fmt: skip
SPEED = 3000 * math.pi / 30.0
R, LAMBDA = 0.5 * FOUR["stroke"], 0.5 * FOUR["stroke"] / FOUR["rod"]
UNIT = FOUR["reciprocating_mass"] * R * SPEED**2


def engine(**changes: Any) -> EngineOrders:
    numbers = {**FOUR, **changes}
    return EngineOrders(**{**numbers, "firing": tuple(map(float, numbers["firing"]))})


def test_torque_of_the_pistons_by_the_derivative_of_their_kinetic_energy() -> None:
    # At constant speed the crankshaft gets -d/dphi of the kinetic energy m w^2 x'(phi)^2 / 2; its spectrum is exact.
    without_gas = engine(torque=0.0, bore=0.0201)
    _, rate, _ = piston(without_gas, crank_angles())
    energy = 0.5 * FOUR["reciprocating_mass"] * (SPEED * rate) ** 2
    orders = np.arange(energy.size // 2 + 1) / 2.0
    slope = 1j * orders * np.fft.rfft(energy) * 2.0 / energy.size
    gas = np.fft.rfft(gas_torque(without_gas)) * 2.0 / energy.size
    block = block_forces(without_gas, SPEED, 8).torque
    found = [block[2.0], block[4.0], block[6.0], block[8.0]]
    # Four cylinders, all in phase in even orders; the block gets minus the torque on the crankshaft.
    expected = [4.0 * (slope[int(2 * order)] - gas[int(2 * order)]) for order in (2, 4, 6, 8)]
    validated(
        "Applied forces",
        "orders 2, 4, 6 and 8 of the torque of the pistons of a four-cylinder engine on its block",
        np.array(found),
        np.array(expected),
        source="second derivation: derivative of the kinetic energy of the pistons over the crank angle",
        peak=1e-9,
        unit="N m",
    )


def test_force_of_the_pistons_by_their_series() -> None:
    # Den Hartog, Mechanical Vibrations, chapter 5; the next terms are of the order lambda^7.
    second = LAMBDA + LAMBDA**3 / 4 + 15 * LAMBDA**5 / 128
    fourth, sixth = -(LAMBDA**3 / 4 + 3 * LAMBDA**5 / 16), 9 * LAMBDA**5 / 128
    found = block_forces(engine(), SPEED, 6)
    expected = {2.0: 4 * UNIT * second, 4.0: 4 * UNIT * fourth, 6.0: 4 * UNIT * sixth}
    for order, force in expected.items():
        assert found.force[order] == pytest.approx(force, abs=4 * UNIT * 40 * LAMBDA**7 / 128)
    assert max(abs(found.force[order]) for order in found.force if order not in expected) < 1e-9 * UNIT
    assert max(map(abs, found.moment.values())) < 1e-9 * UNIT
    balanced = block_forces(engine(balance_share=1.0), SPEED, 6)
    assert balanced.force[2.0] == 0.0
    assert balanced.force[4.0] == found.force[4.0]


def test_a_three_has_moments_of_order_one_and_two_and_no_force() -> None:
    three = block_forces(engine(cylinders=3, firing=[1, 3, 2]), SPEED, 6)
    arm = math.sqrt(3.0) * FOUR["spacing"] * UNIT
    assert abs(three.moment[1.0]) == pytest.approx(arm, rel=1e-9)
    assert abs(three.moment[2.0]) == pytest.approx(arm * (LAMBDA + LAMBDA**3 / 4 + 15 * LAMBDA**5 / 128), rel=1e-4)
    assert max(abs(three.force[order]) for order in three.force if order < 6.0) < 1e-9 * UNIT
    assert {order for order, torque in three.torque.items() if abs(torque) > 1e-6} == {1.5, 3.0, 4.5, 6.0}


@pytest.mark.parametrize("torque", [0.0, 30.0, 140.0])
def test_the_gas_gives_its_mean_torque(torque: float) -> None:
    assert 4.0 * float(np.mean(gas_torque(engine(torque=torque)))) == pytest.approx(torque, abs=1e-9)


def test_half_the_counterweight_leaves_a_moment_of_constant_size_that_turns_backward() -> None:
    numbers = {**FOUR, "cylinders": 3, "firing": [1, 3, 2], "counterweight_share": 0.5}
    car = Car.load("sedan", {"crank.rpm": 3000, **{f"engine.orders.{key}": value for key, value in numbers.items()}})
    forces = {force.name: force for force in car.vehicle.composition.forces}
    across, along = forces["engine_moment_across"], forces["engine_moment_along"]
    assert (across.moment, along.moment) == ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    ahead, later = across.harmonics[SPEED], along.harmonics[SPEED]
    size = 0.5 * math.sqrt(3.0) * FOUR["spacing"] * UNIT
    angles = np.linspace(0.0, 2.0 * np.pi, 7)
    x, z = ((amplitude * np.exp(1j * angles)).real for amplitude in (ahead, later))
    assert np.hypot(x, z) == pytest.approx(np.full(7, size), rel=1e-9)
    # The crankshaft turns about +y: from z to x. The moment turns from x to z.
    assert np.diff(np.unwrap(np.arctan2(z, x))) == pytest.approx(np.full(6, np.pi / 3.0))


@pytest.mark.parametrize("name", ["focus", "sedan"])
def test_both_engines_agree_on_idle(name: str) -> None:
    numbers = {f"engine.orders.{key}": value for key, value in {**FOUR, "torque": 20.0}.items()}
    car = Car.load(name, {"crank.rpm": 750, **numbers})
    source = road("level", 0, duration=6)
    channels = ["seat_rail_acc_z", "seat_rail_acc_x", "engine_acc_z"]
    precise, reduced = (
        car.run(source, engine=kind, channels=channels, skip=3.0).orders(channels, orders=[2, 4])
        for kind in ("mujoco", "reduced")
    )
    assert precise.frequency == pytest.approx([25.0, 50.0])
    validated(
        "Applied forces",
        f"idle of a four-cylinder engine at 750 rpm in {name}: orders 2 and 4 of seat rail and engine in both engines",
        reduced.amplitude,
        precise.amplitude,
        source="second derivation: MuJoCo",
        rel=5e-3,
        peak=1e-4,
    )


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"firing": [1, 3, 4]}, "engine.orders.firing: found [1.0, 3.0, 4.0], must name each of the 4 cylinders"),
        ({"rod": 0.04}, "engine.orders.rod: found 0.04 m, must be above half the stroke"),
        ({"cylinder_axis": [0, 1, 0]}, "engine.orders.cylinder_axis: found [0.0, 1.0, 0.0], must be across"),
        ({"torque": 1500.0}, "engine.orders.torque: found 1500 N m, this engine gives at most"),
    ],
)
def test_a_wrong_engine_is_refused(changes: dict[str, Any], said: str) -> None:
    numbers = {f"engine.orders.{key}": value for key, value in {**FOUR, **changes}.items()}
    with pytest.raises(ConfigurationError) as raised:
        Car.load("sedan", {"crank.rpm": 750, **numbers})
    assert said in str(raised.value)
