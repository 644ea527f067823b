"""Periodic states over frequency and level: limits, lines of slip, peaks, modes, and what is refused."""

import numpy as np
import pytest

from vehicle import Car, ConfigurationError
from vehicle.runs.car.level_inputs import plate_shares
from vehicle.runs.car.levels import crossing

WHEELS = ("fr", "fl", "rr", "rl")
FREQUENCY, LEVEL = np.geomspace(2.0, 6.0, 25), np.geomspace(1e-5, 1e-2, 13)


@pytest.fixture(scope="module")
def car():
    return Car.load("focus_road")


@pytest.fixture(scope="module")
def states(car):
    return car.levels(frequency=FREQUENCY, level=LEVEL, channels=["seat rail z", "knuckle_fl_acc_z"])


def test_all_points_have_the_only_state(states):
    assert states.ended.all() and states.unique.all() and np.isfinite(states.frf).all()
    assert states.frf.shape == (2, 25, 13) and states.slip.shape == (4, 25, 13)
    # Where nothing slips there are no harmonics, and the other way round.
    slipping = states.slip.max(axis=0) > 0.0
    assert slipping.any() and not slipping.all()
    assert np.all((states.distortion[0] > 1e-5) == slipping)


def test_below_the_first_slip_the_car_is_that_with_stuck_dampers(car):
    """With a friction line of 1e8 s/m: at 1e5 s/m a stuck damper still moves, 1 % at an antiresonance."""
    found = car.with_(["*.damper.smoothing=1e8"]).levels(frequency=FREQUENCY, level=[1e-6])
    expected = sum(car.matrix_frf(["seat_rail_acc_z"], FREQUENCY, wheel=wheel)[0] for wheel in WHEELS)
    np.testing.assert_allclose(found.frf[0, :, 0], expected, rtol=1e-4)


def test_a_large_motion_has_the_frf_of_sliding_dampers(car):
    found = car.levels(frequency=FREQUENCY, level=[30.0]).frf[0, :, 0]
    expected = sum(car.matrix_frf(["seat_rail_acc_z"], FREQUENCY, damper="sliding", wheel=wheel)[0] for wheel in WHEELS)
    np.testing.assert_allclose(found, expected, rtol=1e-3)


def test_a_damper_slips_above_its_line(states):
    """The lines lie between the last level at which a damper sticks and the first at which it slips."""
    for damper, line in enumerate(states.unsticking):
        for column, level in enumerate(line):
            slips = states.slip[damper, column] > 0.0
            if np.isfinite(level) and level < LEVEL[-1]:
                assert not slips[level > LEVEL].any() and slips[np.searchsorted(LEVEL, level)]
    lowest = np.nanmin(states.unsticking, axis=0)
    np.testing.assert_array_equal(lowest, np.min(states.first, axis=0))


def test_friction_costs_the_peak_its_height_and_leaves_damping(states):
    at, height = states.peaks(3.0, 4.5)
    assert height[0] > 20.0 * np.nanmin(height) and at[0] == pytest.approx(3.66, abs=0.05)
    frequency, ratio = states.mode(3.67)
    # The mode of the car with stuck dampers, then the damping of the slipping ones.
    stuck = min(states.car.modes("stuck"), key=lambda mode: abs(mode.frequency - 3.656))
    assert frequency[0] == pytest.approx(stuck.frequency, rel=1e-3)
    assert ratio[0] == pytest.approx(stuck.damping_ratio, rel=0.05)  # the friction line is not rigid
    assert ratio[LEVEL > 1e-4].min() > 0.1 and np.nanmax(ratio) > 0.6
    # The modes of a car with such dampers, left and right alike; c of the front and of the rear.
    constants = [np.interp(3.67, FREQUENCY, each) for each in states.equivalent[:, :, -1]]
    changes = {"front.damper.viscous": np.mean(constants[:2]), "rear.damper.viscous": np.mean(constants[2:])}
    modes = states.car.with_({**changes, "*.damper.coulomb_friction": 0.0}).modes("sliding")
    viscous = min(
        modes, key=lambda mode: abs(mode.frequency / frequency[-1] - 1.0) + abs(mode.damping_ratio - ratio[-1])
    )
    assert ratio[-1] == pytest.approx(viscous.damping_ratio, rel=2e-3)


def test_a_cut_is_computed_at_its_own_frequency(states):
    cut = states.at(float(FREQUENCY[7]))
    np.testing.assert_allclose(cut.rms[:, 0], states.rms[:, 7], rtol=1e-5)


def test_a_point_without_a_result_is_a_counted_hole(car, monkeypatch):
    limits = {"present": None, "tolerance": 1e-7, "limit": 5, "ladder": ((1.0, 1.0),), "start": None}
    monkeypatch.setattr("vehicle.engines.steady.splitting.periodic_forces.__kwdefaults__", limits)
    found = car.levels(frequency=[3.0], level=[1e-5, 3e-3])
    left = ~found.ended
    assert left.any() and np.isnan(found.frf[0, left]).all() and np.isnan(found.slip[0, left]).all()
    assert f"{int(np.sum(~found.ended))} of 2 points have no result" in found.notices[0]


def test_notices_name_the_limits(car):
    (rotates, pulls, more) = car.levels(frequency=[11.0], level=[0.03], channels="damper top fl z").notices
    assert "deg" in rotates and "one_sided" in pulls and "damper_top_fl_acc_z" in more


@pytest.mark.parametrize(
    ("plates", "expected"),
    [
        ("heave", (1, 1, 1, 1)),
        ("pitch", (1, 1, -1, -1)),
        ("roll", (-1, 1, -1, 1)),
        ("warp", (-1, 1, 1, -1)),
        ("rl", (0, 0, 0, 1)),
        ("fl=1, fr=0.5@90", (0.5j, 1, 0, 0)),
        ({"fl": 2.0}, (0, 2, 0, 0)),
    ],
)
def test_plates(plates, expected):
    shares = plate_shares(plates, WHEELS)
    assert list(shares) == list(WHEELS)
    np.testing.assert_allclose(list(shares.values()), expected, atol=1e-15)


def test_the_share_of_a_plate_is_its_level(car):
    """Half the share at twice the level is the same motion, and a phase of all plates changes that of the response."""
    one = car.levels(frequency=[4.0], level=[5e-4], plates="fl")
    two = car.levels(frequency=[4.0], level=[1e-3], plates="fl=0.5@90")
    np.testing.assert_allclose(two.frf, 0.5j * one.frf, rtol=1e-6)


def test_crossing():
    level = np.array([1.0, 2.0, 4.0, 8.0])
    assert crossing(level, np.array([0.2, 0.4, 0.8, 3.0])) == pytest.approx(5.0)
    assert np.isnan(crossing(level, np.array([1.2, 1.4, 1.8, 3.0])))
    assert np.isnan(crossing(level, np.array([0.1, 0.2, 0.3, 0.4])))


POINT = {"frequency": [3.0], "level": [1e-3]}


@pytest.mark.parametrize(
    ("file", "changes", "more", "message"),
    [
        ("focus", [], {"level": [0.0]}, "level: must be finite numbers above 0 m"),
        ("focus", [], {"frequency": [3.0, 2.0]}, "frequency: must ascend"),
        ("focus", [], {"frequency": [-1.0]}, "frequency: must be finite numbers above 0 Hz"),
        ("focus", [], {"plates": "pitch"}, "plates pitch: the car has plates under one axle only"),
        ("focus", [], {"plates": "sway"}, "plates 'sway': must be heave"),
        ("focus", [], {"plates": {"rl": 1.0}}, "the car has no wheel 'rl'"),
        ("focus", [], {"plates": "fl=0"}, "plates: must have finite shares"),
        ("focus", [], {"samples": 33}, "samples 33: must be an even number"),
        ("focus", [], {"channels": "plate_fl_displacement"}, "it is no response of the car"),
        (
            "focus",
            [],
            {"frequency": np.linspace(1, 9, 5000), "level": np.linspace(1, 2, 50)},
            "points, must be at most",
        ),
        ("focus_road", ["driving.speed=20"], {"frequency": [0.5]}, "at least 1 Hz for rolling tyres"),
        ("focus", ["damper.coulomb_friction=0"], {}, "the car is linear"),
        ("focus", ["damper.side_force_coefficient=0.2"], {}, "side_force_coefficient above 0"),
        (
            "focus_road",
            ["front.damper.control.law=skyhook_on_off", "front.damper.control.maximum_damping=4000"],
            {},
            "damper_fr has a control (skyhook_on_off)",
        ),
    ],
)
def test_what_is_refused(file, changes, more, message):
    with pytest.raises(ConfigurationError) as raised:
        Car.load(file, changes).levels(**{**POINT, **more})
    assert message in str(raised.value)
