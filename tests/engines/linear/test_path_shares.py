"""Contributions of the attachments of the body: their sum, their forces, and a road that comes by one wheel alone."""

from __future__ import annotations

import numpy as np
import pytest

from tests.validation import validated
from vehicle.engines.linear.path_shares import REST, path_shares
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car

FREQUENCY = np.array([1.5, 3.7, 9.7, 18.0, 26.0, 42.0])

WEAK = 0.1
"""Torsional stiffness of every bushing [N m/rad], a thousandth of the usual one."""


def shares_of(car, plates, *, stuck=True, channel="seat_rail_acc_z"):
    return path_shares(car.model, car.matrices, car.load_rows, channel, FREQUENCY, plates, stuck=stuck)


def any_plates(car):
    generator = np.random.default_rng(1)
    shape = (len(car.vehicle.wheels), FREQUENCY.size)
    return generator.normal(size=shape) + 1j * generator.normal(size=shape)


@pytest.mark.parametrize("damper", ["stuck", "sliding"])
@pytest.mark.parametrize("name", ["focus", "sedan"])
def test_contributions_add_up_to_the_frf_by_poles(name, damper):
    car = Car.load(name)
    plates, channels = any_plates(car), ["seat_rail_acc_z"]
    result = shares_of(car, plates, stuck=damper == "stuck")
    wheels = zip(car.vehicle.wheels, plates, strict=True)
    exact = sum(plate * car.matrix_frf(channels, FREQUENCY, damper=damper, wheel=wheel)[0] for wheel, plate in wheels)
    validated(
        "Linear system", f"sum of the contributions of all paths to the seat rail of {name}, dampers {damper}",
        result.contributions.sum(axis=0), exact,
        rel=1e-9, source="second derivation: FRF by poles",
    )  # fmt: skip
    assert result.shares.sum() == pytest.approx(1.0, abs=1e-12)
    # No single path makes the sum, otherwise the shares would prove nothing.
    assert np.sum(np.abs(result.shares) > 0.1) > 1
    assert result.names[-1] == REST and abs(result.shares[-1]) < 0.01


@pytest.mark.parametrize("name", ["focus", "focus_road_seated", "sedan"])
def test_forces_of_the_attachments_are_all_that_moves_the_body(name):
    # Without weight no preload rotates: Newton's law of the body, rigid or flexible, holds with the forces alone. Its
    # rotation is also driven by the moments of torsional stiffnesses, which are no load channels: weak ones here.
    stiffnesses = Car.load(name).search("rotational_stiffness")
    car = Car.load(name, ["gravity=0", *(f"{parameter.path}={WEAK}" for parameter in stiffnesses)])
    for stuck in (True, False):
        result = shares_of(car, any_plates(car), stuck=stuck)
        largest = np.abs(result.forces[:-1]).max(axis=(0, 2))
        without_rotation = [0, 1, 2, *range(6, result.forces.shape[1])]
        assert (np.abs(result.forces[-1]).max(axis=1) / largest)[without_rotation].max() < 1e-6
        assert (np.abs(result.forces[-1]).max(axis=1) / largest).max() < 1e-3


def test_a_plate_acts_by_its_own_corner(car):
    """A plate front left, symmetric car: the paths of the left carry more than those of the right."""
    plates = np.zeros((len(car.vehicle.wheels), FREQUENCY.size), complex)
    plates[car.vehicle.wheels.index("fl")] = 1e-3
    result = shares_of(car, plates)
    by_name = dict(zip(result.names, result.shares, strict=True))
    assert by_name["suspension_mount_fl"] > by_name["suspension_mount_fr"]
    assert shares_of(car, 2.0 * plates).shares == pytest.approx(result.shares, rel=1e-9)


def test_a_channel_off_the_body_is_rejected(car):
    with pytest.raises(ConfigurationError, match="knuckle_fl_acc_z: must be an acceleration of a point on the body"):
        shares_of(car, any_plates(car), channel="knuckle_fl_acc_z")
