"""What MuJoCo would pass over in silence stops a run: too long steps, lost states, lift-off; no file was changed."""

import re

import mujoco
import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle.engines.simulation.stepping import record_every
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal, uniform_time

SHORT = random_road(rms=1e-4, seed=1, wheel="fr", duration=1.5)


def test_item_36_a_lost_state_stops_with_time_and_joint(car, monkeypatch, tmp_path):
    # A plate that jumps by a thousand kilometres: finite numbers in, a lost state out, whatever loop steps the car.
    monkeypatch.chdir(tmp_path)
    jump = np.where(SHORT.time < 0.7, 0.0, 1e6)
    with pytest.raises(SimulationError) as caught:
        car.run(Signal(time=SHORT.time, displacement={"fr": jump}))
    message = str(caught.value)
    found = re.search(r"no longer finite at t = (\S+) s", message)
    assert found, message
    time = float(found.group(1))
    # The spline through the samples swings before the jump, by a factor of 4 less each sample.
    assert time == pytest.approx(0.7, abs=0.02)
    assert re.search(r"\(joint [a-z_0-9]+\); the step is stable for the car at rest, but not for this motion", message)
    assert caught.value.state is not None
    assert 0.6 < float(caught.value.state["time"]) <= time
    assert np.isfinite(caught.value.state["qpos"]).all()
    assert mujoco.get_mjcb_control() is None
    assert list(tmp_path.iterdir()) == [], "no MUJOCO_LOG.TXT"


def test_a_signal_shorter_than_a_recorded_interval_is_refused(car):
    short = Signal(time=uniform_time(samples=32, timestep=1e-5), displacement={"fr": np.zeros(32)})
    with pytest.raises(ConfigurationError, match=r"0\.31 sampling intervals but must last at least 1"):
        car.run(short)


def test_an_exception_in_the_middle_of_a_run_leaves_no_callbacks(car):
    def stop(fraction):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        car.run(SHORT, progress=stop)
    assert mujoco.get_mjcb_control() is None
    # The next run is untouched by it.
    assert np.isfinite(car.run(SHORT)["seat_rail_acc_z"]).all()


def test_lift_off_is_reported_with_the_time(car):
    # The static deflection of the tyre is 3500 N / 2.5e5 N/m = 14 mm: 40 mm within 67 ms throw the wheel up.
    time = uniform_time(samples=1501, timestep=1e-3)
    pulse = 0.02 * (1.0 - np.cos(2.0 * np.pi * 15.0 * (time - 0.2)))
    height = np.where((time > 0.2) & (time < 0.2 + 1.0 / 15.0), pulse, 0.0)
    run = car.run(Signal(time=time, displacement={"fr": height}))
    warnings = run.recording.statistics.warnings
    assert len(warnings) == 1 and "fr" in warnings[0]
    found = re.fullmatch(
        r"tyre fr would lift off its plate at t = (\S+) s \(lowest load (\S+) N at (\S+) s\); "
        r".* --set AXLE\.bushings\.tyre\.one_sided=true.*",
        warnings[0],
    )
    assert found
    load = run["tyre_fr_force_z"]
    first = int(np.argmax(load < 0.0))
    assert float(found.group(1)) == pytest.approx(run.time[first], abs=1e-3)
    assert float(found.group(2)) == pytest.approx(load.min(), abs=1.0)
    assert float(found.group(3)) == pytest.approx(run.time[np.argmin(load)], abs=2e-3)
    assert not car.run(SHORT).recording.statistics.warnings


@pytest.mark.parametrize("rate", ["300", "3000"])
def test_rates_that_do_not_divide_are_refused(rate):
    car = Car.load(None, [f"solver.record_rate={rate}"])
    with pytest.raises(ConfigurationError) as caught:
        record_every(car.model)
    assert str(caught.value) == (
        f"solver.record_rate: found {rate} Hz, must be the step rate {1.0 / car.vehicle.solver.step:g} Hz or a "
        "whole fraction of it"
    )


def test_recording_at_a_lower_rate_is_a_part_of_the_full_one():
    coarse = Car.load(None, ["solver.timestep=0.001", "solver.record_rate=500"]).run(SHORT)
    fine = Car.load(None, ["solver.timestep=0.001", "solver.record_rate=1000"]).run(SHORT)
    for channel in ("damper_fr_velocity", "tyre_fr_force_z"):
        np.testing.assert_array_equal(coarse[channel], fine[channel][::2])
    for channel in ("knuckle_fr_acc_z", "seat_rail_acc_x"):
        # Differences of positions over twice the interval: 0.014 % low at 50 Hz, 2.4 % at 100 Hz.
        size = np.max(np.abs(fine[channel]))
        np.testing.assert_allclose(coarse[channel], fine[channel][::2], rtol=0.0, atol=5e-3 * size)


def test_item_21_a_car_that_nothing_holds_is_refused():
    settings = [f"bushings.{name}.stiffness=[0, 0, 0]" for name in ("linear_mount", "hydromount", "torque_arm_engine")]
    with pytest.raises(SimulationError, match="static trim: the car can move without resistance"):
        _ = Car.load(None, [*settings, "bushings.hydromount.maxwell_stiffness=0"]).model
