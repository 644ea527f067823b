import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle.errors import DataError
from vehicle.signals.excitation.signal import Signal, uniform_time

TIME = uniform_time(samples=1001, timestep=1e-3)


def hertz(frequency: float, amplitude: float = 1e-3) -> Signal:
    z = 0.5 * amplitude * (1.0 - np.cos(2.0 * np.pi * frequency * TIME))
    return Signal(time=TIME, displacement={"fr": z})


def test_properties():
    signal = hertz(10.0)
    assert signal.timestep == pytest.approx(1e-3, rel=1e-12)  # rounding of one division
    assert signal.duration == 1.0
    assert signal.wheels == ("fr",)
    # A whole number of periods plus one sample: RMS A / (2 sqrt 2), the extra sample changes it by 1/1001 at most.
    assert signal.rms("fr") == pytest.approx(0.5e-3 / np.sqrt(2.0), rel=1e-3)
    assert signal.rms("fl") == 0.0


def test_rms_is_about_the_mean():
    z = hertz(10.0).displacement["fr"]
    assert Signal(time=TIME, displacement={"fr": z + 0.05}).rms("fr") == pytest.approx(np.std(z), rel=1e-9)


def test_arrays_are_copies_that_nobody_can_change():
    z = np.zeros(TIME.size)
    signal = Signal(time=TIME, displacement={"fr": z})
    z[5] = 1.0
    assert signal.displacement["fr"][5] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        signal.displacement["fr"][5] = 1.0


@pytest.mark.parametrize(
    ("time", "displacement", "message"),
    [
        (TIME, {}, "moves no wheel"),
        (TIME, {"xx": np.zeros(1001)}, "unknown wheel 'xx'; must be one of fr, fl, rr, rl"),
        (TIME, {"fr": np.zeros(1000)}, "displacement of fr has shape (1000,), time has (1001,)"),
        (TIME, {"fr": np.where(TIME == 0.5, np.nan, 0.0)}, "displacement of fr is nan at sample 500"),
        (TIME[:31], {"fr": np.zeros(31)}, "size (31,) but must be one vector of at least 32 samples"),
        (TIME + 1.0, {"fr": np.zeros(1001)}, "the time begins at 1.0 s"),
        (TIME**2, {"fr": np.zeros(1001)}, "resample the signal to a uniform grid first"),
    ],
)
def test_bad_signals_are_refused(time, displacement, message):
    with pytest.raises(DataError) as caught:
        Signal(time=time, displacement=displacement)
    assert message in str(caught.value)
    assert str(caught.value).startswith("array: ")


def test_plate_motion_of_a_cubic_is_exact_between_samples():
    # Not-a-knot reproduces every cubic, ends included; a natural or clamped end would not.
    z = 1e-3 * (TIME - 0.3) * (TIME - 0.7) * (TIME + 0.2)
    at = np.linspace(0.0, 1.0, 777)
    motion = Signal(time=TIME, displacement={"fr": z}).plate_motion(at)
    cubic = np.polynomial.Polynomial.fromroots([0.3, 0.7, -0.2]) * 1e-3
    # Rounding of z (1e-19) divided by dt, dt^2 and amplified by the spline: 1e-15, 1e-12.
    np.testing.assert_allclose(motion.displacement["fr"], cubic(at), rtol=0, atol=1e-17)
    np.testing.assert_allclose(motion.velocity["fr"], cubic.deriv()(at), rtol=0, atol=1e-14)
    np.testing.assert_allclose(motion.acceleration["fr"], cubic.deriv(2)(at), rtol=0, atol=1e-11)


def test_plate_velocity_and_acceleration_are_the_derivatives_of_the_displacement():
    signal = random_road(rms=5.25e-4, seed=3, wheel="fr", duration=4.0)
    # Strictly inside one piece of the spline central differences of a cubic have errors of order h^2 only.
    h = 1e-5
    at = np.arange(0.1004, 3.9, 0.0137)
    before, now, after = (signal.plate_motion(at + shift) for shift in (-h, 0.0, h))
    velocity = (after.displacement["fr"] - before.displacement["fr"]) / (2 * h)
    acceleration = (after.velocity["fr"] - before.velocity["fr"]) / (2 * h)
    # h^2/6 z''' with z''' up to about 1e4 m/s3: 2e-7 m/s of 0.03 m/s.
    np.testing.assert_allclose(now.velocity["fr"], velocity, rtol=0, atol=1e-6)
    # Velocity is a parabola within a piece, so only rounding is left.
    inside = np.abs(at * 1000 - np.round(at * 1000)) > 0.05
    assert inside.sum() > 200
    np.testing.assert_allclose(now.acceleration["fr"][inside], acceleration[inside], rtol=0, atol=1e-6)


def test_spline_of_a_50_hz_sine_at_1_khz_keeps_the_stated_accuracy():
    signal = hertz(50.0)
    at = np.linspace(0.1, 0.9, 3001)  # away from the ends
    motion = signal.plate_motion(at)
    w = 2.0 * np.pi * 50.0
    speed, acceleration = 0.5e-3 * w, 0.5e-3 * w**2
    # At 20 samples per period the docstring promises 0.03 % (worst between samples) and 1 % of the peak.
    assert np.max(np.abs(motion.velocity["fr"] - speed * np.sin(w * at))) < 3e-4 * speed
    assert np.max(np.abs(motion.acceleration["fr"] - acceleration * np.cos(w * at))) < 1e-2 * acceleration


def test_a_wheel_without_excitation_stands_still():
    motion = hertz(10.0).plate_motion([0.0, 0.1, 0.25], ("fr", "fl"))
    for values in (motion.displacement, motion.velocity, motion.acceleration):
        assert set(values) == {"fr", "fl"}
        assert np.array_equal(values["fl"], np.zeros(3))


@pytest.mark.parametrize("time", [-1e-3, 1.001])
def test_plate_motion_is_not_extrapolated(time):
    with pytest.raises(DataError, match=r"array: plate motion requested at t = .*, must be 0 to 1 s; shorten"):
        hertz(10.0).plate_motion([0.5, time])


def test_a_time_that_rounding_carried_beyond_the_record_is_its_end():
    motion = hertz(10.0).plate_motion([1.0 + 1e-12, -1e-12])
    assert np.array_equal(motion.time, [1.0, 0.0])
