"""Modes about a motion: with constants c the poles are those of a car whose dampers are linear with c."""

import numpy as np
import pytest

from vehicle import Car
from vehicle.engines.linear.car_modes import car_modes
from vehicle.studies.diagnosis.drawn_car import CarPrior, DrawnCar
from vehicle.studies.diagnosis.driven_modes import driven_modes, equivalent_constants
from vehicle.studies.diagnosis.simulated_drives import SETTLED, drawn_road, plates_of, simulated

SPEED = 22.0


@pytest.fixture(scope="module")
def prior():
    return CarPrior(Car.load("sedan"), SPEED)


def test_other_constants_are_other_dampers(prior):
    """The car with the constants in its vehicle file, whose matrices and modes are made anew."""
    constants = np.array([1900.0, 1900.0, 700.0, 700.0])
    other = Car.load("sedan", {"driving.speed": SPEED, "front.damper.viscous_law": "linear", "rear.damper.viscous_law":
                               "linear", "front.damper.viscous": 1900.0, "rear.damper.viscous": 700.0})  # fmt: skip
    assert other.poles.matrices.viscous == pytest.approx(constants)
    expected = car_modes(other.poles.matrices, stuck=False)
    found = driven_modes(prior.car.poles, constants)
    for motion, mode in found.items():
        same = [each for each in expected if mode == pytest.approx((each.frequency, each.damping_ratio), rel=1e-6)]
        # Strong damping mixes pitch with other motions, whose shares then name the mode.
        part = motion.split()[1] if motion != "body pitch" else ""
        assert len(same) == 1 and part in same[0].description.replace("wheel hop", f"hop {part}")


def test_a_linear_damper_has_its_own_constant(prior):
    laws = Car.load("sedan", {"front.damper.coulomb_friction": 0.0, "rear.damper.coulomb_friction": 0.0})
    dampers = [damper.law for damper in laws.vehicle.composition.dampers]
    car = DrawnCar(values={}, poles=prior.car.poles, dampers=dampers, tyre_load=prior.car.static.tyre_load)
    rng = np.random.default_rng(1)
    batch = simulated([car], plates_of(drawn_road(prior.car, SPEED, rng), prior.car, 20.0, rng), (), car.poles)
    # The rear dampers of the sedan are linear, 1500 N s/m; samples of 250 Hz in single precision.
    assert equivalent_constants(batch, car.poles, SETTLED)[0, 2:] == pytest.approx([1500.0] * 2, rel=1e-3)
