from __future__ import annotations

import numpy as np
import pytest

from vehicle.errors import ConfigurationError
from vehicle.excitation.bump import bump, bump_shape
from vehicle.excitation.multisine import multisine
from vehicle.excitation.sine import sine
from vehicle.excitation.sweep import log_sweep


@pytest.mark.parametrize(("reading", "peak"), [("height", 7.5e-3), ("literal", 15e-3)])
def test_bump_is_one_period_with_its_peak_in_the_middle(reading, peak):
    t = np.array([0.0, 4.999, 5.0, 5.0 + 1 / 12, 5.0 + 1 / 6, 5.0 + 1 / 4, 5.0 + 1 / 3, 5.4])
    x = bump_shape(t, amplitude=7.5e-3, reading=reading)
    np.testing.assert_allclose(x, peak * np.array([0, 0, 0, 0.5, 1.0, 0.5, 0, 0]), rtol=0, atol=1e-15)
    # Independent form: (1 - cos a) / 2 = sin^2(a / 2).
    inside = np.linspace(5.001, 5.333, 50)
    expected = peak * np.sin(3.0 * np.pi * (inside - 5.0)) ** 2
    np.testing.assert_allclose(bump_shape(inside, amplitude=7.5e-3, reading=reading), expected, rtol=0, atol=1e-15)


@pytest.mark.parametrize("end", [5.0, 5.0 + 1.0 / 3.0])
def test_bump_velocity_is_continuous_at_both_ends(end):
    h = 1e-6
    x = bump_shape([end - 2 * h, end - h, end, end + h, end + 2 * h], amplitude=7.5e-3)
    before, after = (x[1] - x[0]) / h, (x[4] - x[3]) / h
    # Curvature 18 pi^2 A = 1.3 m/s2 times 1.5 h = 2e-6 m/s is left; a corner would show the bump's 0.07 m/s.
    assert abs(after - before) < 1e-5
    assert np.max(np.abs(bump_shape(np.linspace(5, 5.4, 999), amplitude=7.5e-3))) > 7e-3


def test_bump_noise_has_its_rms_outside_and_runs_on_inside():
    signal = bump(amplitude=7.5e-3)
    t, z = signal.time, signal.displacement["fr"]
    outside = (t <= 5.0) | (t >= 5.0 + 1.0 / 3.0)
    assert np.std(z[outside]) == pytest.approx(5e-5, rel=1e-12)  # rounding
    noise = z - bump_shape(t, amplitude=7.5e-3)
    assert 1e-5 < np.std(noise[~outside]) < 2e-4  # 1/3 s of a 5e-5 m noise that begins at 2 Hz
    # No seam: the noise changes by no more per step at the ends of the bump than elsewhere.
    steps = np.abs(np.diff(noise))
    at_ends = [4999, 5000, 5333, 5334]
    assert steps[at_ends].max() <= np.quantile(steps, 0.999)
    assert z[0] == 0.0


def test_bump_without_noise_is_the_shape():
    signal = bump(amplitude=1.5e-3, noise_rms=0.0, wheel="fl")
    assert signal.wheels == ("fl",)
    assert np.array_equal(signal.displacement["fl"], bump_shape(signal.time, amplitude=1.5e-3))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"amplitude": -1.0}, "bump amplitude -1.0 m; allowed: positive and finite"),
        ({"start": 9.8}, "bump at 9.8 s; allowed: 0 to 9.66667 s, so that it ends within the record"),
        ({"noise_rms": -1.0}, "noise RMS -1.0 m; allowed: positive and finite"),
        ({"reading": "tall"}, "reading 'tall' of the bump; allowed: 'height', 'literal'"),
    ],
)
def test_bad_bumps_are_refused(change, message):
    with pytest.raises(ConfigurationError) as caught:
        bump(**{"amplitude": 1e-3, **change})
    assert str(caught.value) == message


def test_sine_has_its_amplitude_and_frequency_after_the_rise():
    signal = sine(frequency=4.0, amplitude=2e-3, duration=5.0, ramp_periods=2.0)
    z, t = signal.displacement["fr"], signal.time
    after = t >= 0.5
    np.testing.assert_allclose(z[after], 2e-3 * np.sin(8.0 * np.pi * t[after]), rtol=0, atol=1e-15)
    assert z[0] == 0.0
    # w ~ (pi t / 2 T)^2: the velocity grows with t^2 from 0; without the rise it would be 0.05 m/s.
    assert abs(signal.plate_motion([0.0]).velocity["fr"][0]) < 1e-5


@pytest.mark.parametrize("exponent", [0.0, -1.0, -2.0])
def test_sweep_frequency_and_amplitude_follow_their_laws(exponent):
    signal = log_sweep(
        start_frequency=1.0, end_frequency=32.0, amplitude=1e-3, duration=50.0, amplitude_exponent=exponent
    )
    z, t = signal.displacement["fr"], signal.time
    # Zero crossings: half a period between two of them gives the frequency midway, f = 2^(t / 10 s).
    rising = np.flatnonzero((z[:-1] < 0) & (z[1:] >= 0))
    crossing = t[rising] - z[rising] * 1e-3 / (z[rising + 1] - z[rising])
    middle = 0.5 * (crossing[1:] + crossing[:-1])
    frequency = 1.0 / np.diff(crossing)
    kept = (middle > 1.5) & (middle < 49.0)
    assert kept.sum() > 300
    # Linear interpolation of the crossing and the curvature of f over one period: 0.3 % at 1 Hz.
    np.testing.assert_allclose(frequency[kept], 2.0 ** (middle[kept] / 10.0), rtol=1e-2)
    for start in (10.0, 40.0):
        part = z[(t >= start) & (t <= start + 1.0)]
        # The peak within 1 s is at the end where the law is largest: one octave lasts 10 s, 7 % per second and power.
        assert part.max() == pytest.approx(
            1e-3 * (2.0 ** (start / 10.0)) ** exponent, rel=0.08 * max(abs(exponent), 0.1)
        )


def test_multisine_is_periodic_with_exact_rms_and_equal_velocity_lines():
    signal = multisine(rms=1e-4, seed=4, period=4.0, periods=3, lower_band_edge=1.0, upper_band_edge=50.0)
    z = signal.displacement["fr"]
    second, third = z[4000:8000], z[8000:12000]
    assert np.array_equal(second, third)
    assert z[-1] == z[8000]
    assert np.sqrt(np.mean(second**2)) == pytest.approx(1e-4, rel=1e-12)  # rounding
    lines = np.abs(np.fft.rfft(second))
    band = np.arange(4, 201)
    velocity = lines[band] * band
    np.testing.assert_allclose(velocity, velocity[0], rtol=1e-9)  # rounding of lines 50 times below the largest
    others = np.delete(lines, band)
    assert others.max() < 1e-12 * lines.max()
    assert z[0] == 0.0  # ramp
    assert signal.notices == ("half-cosine ramp over the first 0.5 s of the first period",)


def test_multisine_without_ramp_is_periodic_from_the_first_sample():
    signal = multisine(rms=1e-4, seed=4, period=4.0, periods=2, ramp_length=0.0)
    assert np.array_equal(signal.displacement["fr"][:4000], signal.displacement["fr"][4000:8000])
    assert signal.notices == ()


@pytest.mark.parametrize(
    ("make", "arguments", "message"),
    [
        (multisine, {"rms": 1e-4, "seed": 1, "periods": 0}, "0 periods; allowed: from 1"),
        (multisine, {"rms": 1e-4, "seed": 1, "ramp_length": 5.0}, "ramp 5.0 s; allowed: 0 to one period, 4 s"),
        (
            sine,
            {"frequency": 450.0, "amplitude": 1e-3, "duration": 1.0},
            "frequency 450.0 Hz; allowed: above 0 to 400 Hz",
        ),
        (
            sine,
            {"frequency": 1.0, "amplitude": 1e-3, "duration": 1.0, "ramp_periods": 2.0},
            "ramp of 2.0 periods; allowed: 0 to the record's 1",
        ),
        (
            log_sweep,
            {"start_frequency": 1.0, "end_frequency": 1.0, "amplitude": 1e-3, "duration": 5.0},
            "sweep from 1.0 Hz to itself; allowed: two frequencies; a sine has one",
        ),
        (
            log_sweep,
            {"start_frequency": 0.0, "end_frequency": 1.0, "amplitude": 1e-3, "duration": 5.0},
            "frequency 0.0 Hz; allowed: above 0 to 400 Hz",
        ),
        (
            log_sweep,
            {"start_frequency": 2.0, "end_frequency": 1.0, "amplitude": 1e-3, "duration": 5.0, "taper_length": 3.0},
            "taper 3.0 s; allowed: 0 to half of the record, 2.5 s",
        ),
    ],
)
def test_bad_parameters_are_refused(make, arguments, message):
    with pytest.raises(ConfigurationError) as caught:
        make(**arguments)
    assert str(caught.value).startswith(message)
