"""The mode with the largest part in a run: of plates that swing at a natural frequency it is the mode of it."""

import numpy as np
import pytest

from vehicle.runs.car import Car
from vehicle.runs.car.main_mode import CHANNEL, as_measured, beside, main_mode, plate_lines
from vehicle.signals.excitation.signal import Signal


@pytest.fixture(scope="module")
def heave():
    """Mode of the body heave of a car with sticking dampers, and a run whose plates swing at its frequency."""
    car = Car.load("sedan").with_({f"{axle}.damper.coulomb_friction": 5000.0 for axle in ("front", "rear")})
    mode = next(mode for mode in car.modes() if mode.description.startswith("body heave"))
    time = np.arange(8001) / 1000.0
    plate = 1e-4 * np.sin(2.0 * np.pi * mode.frequency * time)
    signal = Signal(time=time, displacement=dict.fromkeys(car.vehicle.wheels, plate), source="heave")
    return mode, car.run(signal, engine="reduced")


def test_plates_at_the_frequency_of_a_mode_move_the_car_in_it(heave):
    mode, run = heave
    main = main_mode(run)
    assert (main.mode.frequency, main.damper) == (mode.frequency, "stuck")
    # At resonance a mode of damping ratio 1.8 % moves 28 times its static part, other modes about theirs.
    assert main.share is not None and 0.9 < main.share < 1.1
    words = beside(run).words
    assert words[0] == f"share of the seat rail's vertical acceleration: {100.0 * main.share:.0f} %"


def test_another_mode_is_that_nearest_to_its_frequency(heave):
    mode, run = heave
    other = main_mode(run, 12.0)
    assert abs(other.mode.frequency - 12.0) == min(abs(each.frequency - 12.0) for each in run.car.modes())
    assert other.mode.frequency != mode.frequency and abs(other.share or 1.0) < 0.1


def test_the_shares_are_those_of_the_recorded_level(heave):
    """The acceleration to which the shares belong has the magnitude of the recorded one."""
    _, run = heave
    lines = plate_lines(run.recording, run.car.matrices.system.inputs, run.evaluated, (1.0, 20.0))
    assert lines is not None
    shares = as_measured(run, lines, stuck=True)
    values = run[CHANNEL][:-1]
    spectrum = np.fft.rfft(np.hanning(values.size) * (values - values.mean()))
    frequency = np.fft.rfftfreq(values.size, run.recording.timestep)
    recorded = np.abs(spectrum[(frequency >= 1.0) & (frequency <= 20.0)])
    np.testing.assert_allclose(np.abs(shares.acceleration), recorded, rtol=1e-9)


def test_a_run_at_rest_shows_the_lowest_mode_without_a_share(heave):
    _, run = heave
    still = Signal(time=run.time, displacement={"fr": 0.0 * run.time}, source="rest")
    main = main_mode(run.car.run(still, engine="reduced"))
    assert main.mode.frequency == run.car.modes()[0].frequency and main.share is None
