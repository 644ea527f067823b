"""Inputs of periodic states: forces against the matrices and a run, axles in turn, levels of acceleration."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle import Car, ConfigurationError, road

SPEED = 30.0
IMBALANCE = [
    "driving.speed=30", "front.right.imbalance.mass=0.1", "front.right.imbalance.radius=0.2",
    "solver.record_rate=4000",
]  # fmt: skip
LINEAR = ["front.damper.viscous_law=linear", "front.damper.viscous=3000"]
CHANNELS = ("seat_rail_acc_z", "knuckle_fr_acc_z", "tyre_fr_force_z", "damper_fr_force", "main_spring_fr_force")


@pytest.fixture(scope="module")
def car():
    return Car.load("sedan", IMBALANCE)


@pytest.mark.parametrize("damper", ["stuck", "sliding"])
def test_a_force_at_the_linear_limits(car, damper):
    """A small force with a steep friction line, and almost no friction."""
    change = "*.damper.smoothing=1e8" if damper == "stuck" else "*.damper.coulomb_friction=1e-6"
    changed, frequency, names = (
        Car.load("sedan", [*IMBALANCE, *LINEAR, change]),
        np.array([2.0, 6.0, 16.0]),
        CHANNELS[:2],
    )
    found = changed.levels(force="imbalance_fr_z", frequency=frequency, level=1e-3, channels=names)
    expected = changed.force_frf(names, frequency, force="imbalance_fr_z", damper=damper)
    np.testing.assert_allclose(found.frf[..., 0], expected, rtol=2e-4)
    assert found.driven.unit == "N"


def test_an_imbalance_is_that_of_its_settled_run(car):
    """Both parts of the rotating force, with a damper that slips most of the time."""
    ((speed, amplitude),) = car.vehicle.composition.forces[0].harmonics.items()
    frequency = speed / (2.0 * np.pi)
    run = car.run(road("level", 3.6 * SPEED, duration=20), engine="reduced", channels=CHANNELS)
    last = run.recording.time >= run.recording.time[-1] - 10.0 / frequency
    phase = speed * run.recording.time[last]
    table = np.column_stack([np.ones_like(phase), np.cos(phase), np.sin(phase)])
    values = np.column_stack([run.recording.channels[name][last] for name in CHANNELS])
    _, real, imaginary = np.linalg.lstsq(table, values, rcond=None)[0]
    found = car.levels(force="imbalance_fr", frequency=frequency, level=abs(amplitude), channels=CHANNELS, samples=256)
    assert found.slip[0, 0, 0] > 0.5
    # After 20 s the run still moves by some 0.02 %.
    validated(
        "Reduced engine", "first harmonics of a car with an imbalance at 30 m/s: periodic state",
        found.frf[:, 0, 0] * amplitude, real - 1j * imaginary, rel=5e-4, unit="m/s2 or N",
        source="second derivation: its run in time after 20 s",
    )  # fmt: skip


def test_axles_in_turn_are_shares_with_their_phases():
    car, frequency, speed = Car.load("focus_road"), 5.0, 60.0
    turned = car.levels(frequency=[2.0, frequency], level=2e-3, axle_delay=speed)
    along = {wheel.name: wheel.patch[0] for wheel in car.vehicle.composition.wheels}
    lag = {name: (x - along["fl"]) / (speed / 3.6) for name, x in along.items()}
    shares = {name: np.exp(-2j * np.pi * frequency * value) for name, value in lag.items()}
    expected = car.levels(frequency=frequency, level=2e-3, plates=shares)
    np.testing.assert_allclose(turned.frf[:, 1], expected.frf[:, 0], rtol=1e-5)


def test_levels_of_acceleration():
    """The plate at a/w^2, and the FRF to its acceleration."""
    car, frequency, level = Car.load("focus"), np.array([3.0, 9.0]), 0.5
    found = car.levels(frequency=frequency, level=level, level_unit="m/s2")
    for column, at in enumerate(frequency):
        height = level / (2.0 * np.pi * at) ** 2
        expected = car.levels(frequency=at, level=height)
        np.testing.assert_allclose(found.rms[:, column], expected.rms[:, 0], rtol=1e-5)
        np.testing.assert_allclose(found.frf[:, column], -height / level * expected.frf[:, 0], rtol=1e-5)
        np.testing.assert_allclose(found.first[:, column], level / height * expected.first[:, 0], rtol=1e-9)


def test_the_parts_of_an_imbalance_turn_together(car):
    shares = car.levels(force="imbalance_fr", frequency=5.0, level=1.0).driven.shares
    assert shares["imbalance_fr_z"] / shares["imbalance_fr_x"] == pytest.approx(-1j)
    same = car.levels(force="imbalance_fr_x=1, imbalance_fr_z=1@-90", frequency=5.0, level=1.0).driven.shares
    assert {name: pytest.approx(share) for name, share in shares.items()} == same


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"force": "imbalance_rr"}, "force: unknown name 'imbalance_rr'"),
        ({"force": "imbalance_fr_x=big"}, "force 'imbalance_fr_x=big': must be a name, or shares"),
        ({"force": {"imbalance_fr_x": 0.0}}, "force: must have finite shares"),
        ({"force": "imbalance_fr", "plates": "roll"}, "force: acts in place of the plates"),
        ({"force": "imbalance_fr", "axle_delay": 80.0}, "force: acts in place of the plates"),
        ({"force": "imbalance_fr", "level_unit": "m"}, "level: unit 'm', must be 'N' for this force"),
        ({"axle_delay": 0.0}, "axle_delay 0 km/h: must be a speed above 0"),
        ({"level_unit": "mm"}, "level: unit 'mm', must be m or m/s2"),
        ({}, "the car has applied forces or wheels with run-out"),
    ],
)
def test_what_is_refused(car, more, message):
    with pytest.raises(ConfigurationError) as raised:
        car.levels(**{"frequency": 5.0, "level": 1.0, **more})
    assert message in str(raised.value)


def test_forces_of_one_level_have_one_unit_and_act_on_parts():
    """A run-out moves the road below a tyre; a torque is no force."""
    car = Car.load("sedan", [*IMBALANCE, "front.right.nonuniformity.runout=[[1, 0.3e-3, 0]]",
                             "front.right.brake_variation.torque=[[1, 20, 0]]"])  # fmt: skip
    names = {force.unit: force.name for force in car.vehicle.composition.forces}
    with pytest.raises(ConfigurationError, match="it changes a tyre"):
        car.levels(force=names["m"], frequency=5.0, level=1.0)
    with pytest.raises(ConfigurationError, match="has forces and moments"):
        car.levels(force={names["N m"]: 1.0, names["N"]: 1.0}, frequency=5.0, level=1.0)
