"""FRFs at levels of a random input: against runs in time, against the linear car, and what is refused."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle import Car, ConfigurationError, Signal
from vehicle.runs.car.random_levels import BAND, PERIOD, SAMPLES, flat_velocity

CHANNELS = ("seat_rail_acc_z", "knuckle_fl_acc_z", "tyre_rl_force_z")
LEVEL = np.array([4e-4, 2e-3, 10e-3])


@pytest.fixture(scope="module")
def states():
    return Car.load("focus_road", ["solver.record_rate=2000"]).random_levels(
        level=LEVEL, channels=CHANNELS, realisations=6
    )


def plate(states, which, count, rate=2000):
    """The signal of a realisation, with a start over 2 s, for a number of periods."""
    frequency = states.frequency
    amplitude = flat_velocity(frequency, *BAND)
    phases = np.random.default_rng(0).uniform(0.0, 2.0 * np.pi, (6, len(frequency)))
    time = np.arange(int(count * PERIOD * rate) + 1) / rate
    waves = np.exp(2j * np.pi * np.outer(time % PERIOD, frequency))
    return time, np.real(waves @ (amplitude * np.exp(1j * phases[which]))) * np.minimum(1.0, 0.5 * time)


def test_lines_have_the_density_of_a_flat_velocity():
    """Of the displacement 1/(f^2 (1/low - 1/high)), RMS 1; half of the cell of the first line is in the band."""
    frequency = np.arange(2048) / PERIOD
    power = 0.5 * flat_velocity(frequency, *BAND) ** 2
    assert np.sum(power) == pytest.approx(1.0, rel=1e-12) and not power[[0, 3, 321]].any()
    density = 1.0 / (frequency[5:320] ** 2 * (1.0 / BAND[0] - 1.0 / BAND[1]))
    np.testing.assert_allclose(power[5:320] * PERIOD, density, rtol=0.02)  # a cell is wide at 0.6 Hz
    assert power[4] * PERIOD == pytest.approx(0.5 * 4.0 / (1.0 / BAND[0] - 1.0 / BAND[1]), rel=0.12)


@pytest.mark.parametrize("column", [0, 1])
def test_a_realisation_is_that_of_its_run(states, column):
    time, shape = plate(states, 1, 3)
    displacement = dict.fromkeys(states.car.vehicle.wheels, LEVEL[column] * shape)
    run = states.car.run(
        Signal(time=time, displacement=displacement, source="random"), engine="reduced", channels=CHANNELS
    )
    last = (run.recording.time >= 2 * PERIOD - 1e-9) & (run.recording.time < 3 * PERIOD - 1e-9)
    lines = np.round(states.frequency * PERIOD).astype(int)
    expected = []
    for name in CHANNELS:
        values = run.recording.channels[name][last]
        amplitudes = 2.0 / len(values) * np.abs(np.fft.rfft(values)[lines])
        expected.append(np.sqrt(0.5 * np.sum(amplitudes**2)))
    # 512 samples a second miss harmonics above 256 Hz, which fold back.
    validated(
        "Reduced engine", f"RMS of a car on random plates of {1e3 * LEVEL[column]:g} mm: periodic state",
        states.rms[:, column, 1], expected, rel=2e-3, unit="m/s2 or N",
        source="second derivation: the third period of its run in time",
    )  # fmt: skip


def test_the_scatter_is_largest_where_dampers_stick_and_slip(states):
    assert states.ended.all() and 0.0 < states.slip[0, 0] < 0.5 < states.slip[0, 2]
    inside = states.frequency < 10.0
    first, second, last = np.median(states.distortion[0, inside], axis=0)
    assert first > 2.0 * last and second > last


def test_statistical_linearisation_holds_for_large_motion_alone(states):
    assert np.isnan(states.linearised[..., :2]).all()
    sizes = np.abs(states.linearised[0, :, 2]) / np.abs(states.frf[0, :, 2])
    # The standard error of the mean of six, 2 %, and the remainder of the linearisation.
    assert np.median(np.abs(sizes - 1.0)) < 0.03


def test_almost_no_friction_leaves_the_frf_of_the_linear_car_without_scatter():
    car = Car.load("focus", ["damper.coulomb_friction=1e-2"])
    states = car.random_levels(level=1e-3, plates="fl", realisations=4)
    expected = car.matrix_frf(["seat_rail_acc_z"], states.frequency, damper="sliding", wheel="fl")
    # A hundredth of a newton itself changes the peak by 2.5e-4, a tenth by 2.5e-3.
    validated(
        "Reduced engine", "FRF of a car with 0.01 N of friction on a random plate: best linear approximation",
        states.frf[..., 0], expected, peak=5e-4, unit="m/s2 per m",
        source="second derivation: linear FRF from the matrices",
    )  # fmt: skip
    assert states.scatter.max() < 5e-4 * np.abs(expected).max() and SAMPLES == 4096


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"realisations": 3}, "realisations 3: must be 4 to 1000"),
        ({"level": [0.0]}, "level: must be finite numbers above 0 m"),
        ({"plates": "sway"}, "plates 'sway': must be heave"),
        ({"channels": "plate_fl_displacement"}, "it is no response of the car"),
    ],
)
def test_what_is_refused(more, message):
    with pytest.raises(ConfigurationError) as raised:
        Car.load("focus").random_levels(**{"level": 1e-3, **more})
    assert message in str(raised.value)
