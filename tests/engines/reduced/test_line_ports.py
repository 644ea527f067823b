"""Twins by ports: against new poles, and the proof of stability against eigenvalues."""

from dataclasses import replace

import numpy as np
import pytest

from tests.engines.reduced.test_road_expectation import RAIL, SPEED, road_of, wheels_of
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.natural_modes import grows
from vehicle.engines.reduced.line_ports import LinePorts
from vehicle.engines.reduced.linear_twin import linear_twin
from vehicle.engines.reduced.pole_model import pole_model
from vehicle.engines.reduced.road_expectation import integral_lines, track_sources
from vehicle.runs.car import Car

CHANGES = {
    "front.bushings.tyre.stiffness.z": 260000, "front.bushings.tyre.damping.z": 300,
    "front.main_spring.stiffness": 36000, "front.stabilizer.torsional_stiffness": 8000,
}  # fmt: skip


@pytest.fixture(scope="module")
def car() -> Car:
    """Return the rolling sedan, one-sided tyres among the laws over displacement."""
    return Car.load("sedan", {"driving.speed": SPEED, "*.bushings.tyre.one_sided": True})


def ports_of(car: Car, examples: list[CarMatrices]):
    """Return the ports of a car on class C, and a function from matrices to the twin by new poles."""
    channels = (*RAIL, "tyre_fr_force_z", "tyre_rl_force_z")
    lines = integral_lines(road := road_of(car), SPEED, 1000.0, 60).frequency
    plates = track_sources(road, SPEED, wheels_of(car), lines)

    def by_poles(matrices: CarMatrices):
        model = pole_model(matrices)
        return linear_twin(model, channels, lines, plates, further=model.law_outputs)

    return LinePorts(car.poles, channels, lines, plates, examples), by_poles


def changed(car: Car, row: np.ndarray, column: np.ndarray, factor: float) -> CarMatrices:
    """Return the matrices of a car with a stiffness between two directions."""
    system = car.matrices.system
    return replace(car.matrices, system=replace(system, stiffness=system.stiffness + factor * np.outer(row, column)))


def largest_difference(first, second) -> float:
    """Return the largest difference of two twins, over the largest value of each output."""
    pairs = [(getattr(first, name), getattr(second, name)) for name in (
        "outputs", "slip", "outputs_by_force", "slip_by_force")]  # fmt: skip
    return max(float(np.max(np.abs(a - b).max(axis=(1, 2)) / np.abs(b).max(axis=(1, 2)))) for a, b in pairs)


def test_a_change_within_the_ports_is_exact(car: Car):
    """A spring between two points, a damper and a mass along one row: rank 3, all responses as by new poles."""
    system, tyres = car.matrices.system, car.matrices.tyre_rows
    row, other = tyres[0] - tyres[1], tyres[2]
    full = changed(car, row, row, 5e4)
    damping = system.damping + 700.0 * np.outer(other, other)
    mass = system.mass + 9.0 * np.outer(other, other)
    full = replace(full, system=replace(full.system, damping=damping, mass=mass))
    ports, by_poles = ports_of(car, [changed(car, row, row, 1e4), changed(car, other, other, 1e4)])
    twin = ports.twin(full)
    assert twin is not None and len(ports.rows) == 2
    assert largest_difference(twin, by_poles(full)) < 1e-8


def test_variants_by_ports_are_those_by_poles(car: Car):
    """Tyre, spring and stabiliser also move preloads, of which the ports leave out directions below 3e-4."""
    examples = [car.with_({path: 1.25 * (car[path].value or 1.0)}).matrices for path in CHANGES]
    ports, by_poles = ports_of(car, examples)
    matrices = car.with_(CHANGES).matrices
    twin = ports.twin(matrices)
    assert twin is not None
    assert 1e-9 < largest_difference(twin, by_poles(matrices)) < 2e-4


def test_a_car_beyond_the_ports_has_no_twin(car: Car):
    """Another direction, another hydromount or another mass of the body need new poles."""
    ports, _ = ports_of(car, [car.with_({"front.bushings.tyre.stiffness.z": 230000}).matrices])
    assert ports.twin(car.with_({"front.bushings.tyre.stiffness.z": 200000}).matrices) is not None
    for changes in ({"front.main_spring.stiffness": 36000}, {"body.mass": 1100}):
        assert ports.twin(car.with_(changes).matrices) is None


def test_an_unstable_car_has_no_twin(car: Car):
    """Stiffness between two motions that feeds one by the other: 120 cars, judged by their eigenvalues."""
    rng, rows = np.random.default_rng(1), car.matrices.tyre_rows
    ports, _ = ports_of(car, [changed(car, a, b, 1e5) for a in rows[:2] for b in rows[:2]])
    proven = dict[bool, list[bool]]({True: [], False: []})
    for _ in range(120):
        a, b = rows[:2].T @ rng.standard_normal(2), rows[:2].T @ rng.standard_normal(2)
        matrices = changed(car, a, b, 10.0 ** rng.uniform(3.0, 6.0))
        proven[not np.any(grows(pole_model(matrices).poles))].append(ports.twin(matrices) is not None)
    assert len(proven[False]) > 10 and not any(proven[False])
    assert len(proven[True]) > 10 and np.mean(proven[True]) > 0.8
