"""Friction between any coordinates of any linear system: both suspensions of the half car with rider."""

import numpy as np
import pytest

from scenarios.lumped.bump_response import bump_passage, bump_response
from scenarios.lumped.half_car_rider_model import half_car_rider
from scenarios.lumped.half_car_rider_parameters import half_car_rider_parameters
from scenarios.lumped.stiff_solution import Tolerances, stiff_solution
from tests.validation import validated
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.system import Slide
from vehicle.errors import ConfigurationError
from vehicle.model.laws.coulomb import Coulomb

CAR = half_car_rider_parameters()
PASSAGE = bump_passage(CAR.bump, 20.0 / 3.6, 2.8, start=0.05)
TIME = np.linspace(0.0, 1.0, 1001)
FINE = Tolerances(relative=1e-8, displacement=1e-12, velocity=1e-10)


class Wheel:
    """Road under one wheel."""

    def __init__(self, number):
        self.number = number

    def at(self, time):
        return float(PASSAGE.heights(time)[self.number]), float(PASSAGE.rates(time)[self.number])


ROADS = (Wheel(0), Wheel(1))


def with_friction(limit):
    """Return the half car with friction in the front and in the rear suspension."""
    system = half_car_rider(CAR)
    arms = {"front": -CAR.body.front_arm, "rear": CAR.body.rear_arm}
    for end, arm in arms.items():
        row = {"heave": 1.0, "pitch": arm, f"{end}_wheel": -1.0}
        system = system.with_slide(Slide(row=row, friction=Coulomb(friction_limit=limit, smoothing=1e5)))
    return system


def test_without_a_limit_it_is_the_exact_linear_response():
    history = stiff_solution(first_order(with_friction(0.0)), TIME, road=ROADS, tolerances=FINE, longest_step=1e-3)
    exact = bump_response(half_car_rider(CAR), PASSAGE, time_step=1e-3, duration=1.0)
    for output in ("upper_limb", "heave", "front_wheel", "rear_wheel"):
        # The solver steps over the jumps of the road rate: 1e-5 of the motion.
        validated(
            "Quarter and half cars", f"half car without friction limit, stiff solver, displacement of {output}",
            history.displacement(output), exact.displacement(output), peak=1e-4, unit="m",
            source="second derivation: exact response of the linear car",
        )  # fmt: skip


def test_beyond_every_force_both_ends_are_locked():
    """100 kN are never reached: the pairs creep at 1e-5 m/s times tan(pi/2 share), and the car is one body on tyres."""
    system = with_friction(1e5)
    history = stiff_solution(first_order(system), TIME, road=ROADS, longest_step=1e-3)
    locked = stiff_solution(first_order(system, stuck=True), TIME, road=ROADS, longest_step=1e-3)
    for pair, end in enumerate(("front", "rear")):
        assert np.abs(history.sliding_velocity(pair)).max() < 1e-5
        assert np.abs(history.displacement(f"{end}_travel")).max() < 1e-5
    for output in ("upper_limb", "front_wheel", "rear_wheel"):
        validated(
            "Quarter and half cars", f"half car with locked suspensions, displacement of {output}",
            history.displacement(output), locked.displacement(output), peak=2e-3, unit="m",
            source="second derivation: linear car with the sliding motion eliminated",
        )  # fmt: skip


def test_each_end_has_its_own_friction():
    system = with_friction(200.0)
    history = stiff_solution(first_order(system), TIME, road=ROADS, longest_step=1e-3)
    assert history.sliding_force.shape == (TIME.size, 2)
    arrived = PASSAGE.arrivals[1] - 0.01
    # Until the rear wheel meets the bump its suspension is moved by the body alone, and its friction holds.
    early = TIME < 0.1
    assert np.abs(history.sliding_velocity(0)[early]).max() > 10.0 * np.abs(history.sliding_velocity(1)[early]).max()
    assert np.abs(history.sliding_velocity(1)[arrived < TIME]).max() > 0.1
    assert (np.abs(history.sliding_force) <= 200.0).all()


def test_a_pair_of_unknown_coordinates_and_too_few_roads_are_refused():
    law = Coulomb(friction_limit=1.0, smoothing=1e5)
    with pytest.raises(ConfigurationError, match=r"^linear form: must be one of upper_limb, .* not 'roof'"):
        half_car_rider(CAR).with_slide(Slide(row={"roof": 1.0}, friction=law))
    with pytest.raises(ConfigurationError, match=r"^road: found 1 signals for 2 inputs$"):
        stiff_solution(first_order(with_friction(1.0)), TIME, road=ROADS[0])
