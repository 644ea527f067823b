"""Fits of the car to synthetic data: with its matrices, with the reduced engine, and with MuJoCo."""

import dataclasses
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from scenarios.signals.bump import bump
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.parameters.paths import overrides_of
from vehicle.model.parameters.ranges import Range
from vehicle.runs.car import Car
from vehicle.signals.analysis.response_name import parsed_name
from vehicle.signals.formats.frf_file import FrfData
from vehicle.signals.formats.table import Record
from vehicle.studies.tuning.car_fit import tune
from vehicle.studies.tuning.frf_target import FrfTarget
from vehicle.studies.tuning.full_steps import SMALL, full_steps
from vehicle.studies.tuning.least_squares import fit
from vehicle.studies.tuning.measured_targets import MeasuredTarget
from vehicle.studies.tuning.record_target import RecordTarget
from vehicle.studies.tuning.tuned_car import TunedCar, tuned_car
from vehicle.studies.tuning.tuning_page import tuning_page
from vehicle.studies.tuning.tuning_text import tuning_text

CHANNELS = ("knuckle_fr_acc_z", "seat_rail_acc_z")
NAMES = tuple(parsed_name(f"{channel}/plate_fr") for channel in CHANNELS)
FREQUENCY = np.arange(5.0, 41.0)
MOUNT = Range(path="bushings.suspension_mount.stiffness.z", low=2e5, high=3e6, start=8.2e5)
VISCOUS = Range(path="damper.viscous", low=3e2, high=8e3, start=1500.0)
FRICTION = Range(path="damper.coulomb_friction", low=15.0, high=400.0, start=75.0)
NOISE = 0.03


@pytest.fixture(scope="module")
def build(car):
    return lambda values: Car.load(overrides=overrides_of(car.vehicle, values))


def frf_data(response, seed):
    real, imaginary = np.random.default_rng(seed).standard_normal((2, *response.shape))
    noisy = response * np.exp(NOISE * (real + 1j * imaginary))
    coherence = np.full(response.shape, 1.0 / (1.0 + 16.0 * NOISE**2))
    return FrfData(
        frequency=FREQUENCY, names=NAMES, response=noisy, coherence=coherence, random_error=np.full(noisy.shape, np.nan)
    )


def target_of(car, signal, seed=1):
    """Return FRFs of the car on a signal (None: stuck dampers) with added noise as a target."""
    blank = FrfTarget(name="synthetic", data=frf_data(np.ones((2, FREQUENCY.size)), 0), signal=signal, averages=8.0)
    return dataclasses.replace(blank, data=frf_data(blank.model_response(car), seed))


def record_of(run, seed=3):
    noise = np.random.default_rng(seed)
    inside = (run.time >= 0.3) & (run.time <= 1.2)
    histories = {}
    for channel in ("knuckle_fr_acc_z", "damper_fr_velocity"):
        level = NOISE * np.sqrt(np.mean(run[channel][inside] ** 2))
        histories[channel] = run[channel] + level * noise.standard_normal(run.time.size)
    return RecordTarget(name="bump", signal=run.signal, record=in_si_units(run.time, histories), window=(0.3, 1.2))


def residuals(target, model):
    """Return the residuals of a target without delays."""
    return target.misfit(target.response(model), {}, {})


def in_si_units(time, histories):
    """Return a record of channels in SI units."""
    return Record(time=time, channels=histories, units=dict.fromkeys(histories, ""))


def test_stuck_and_sliding_levels_and_a_bump_in_one_fit(build, high_piece):
    true = {MOUNT.path: 6.8e5, FRICTION.path: 118.0}
    hidden = build(true)
    short = bump(amplitude=7.5e-3, wheel="fr", duration=1.2, start=0.3, noise_rms=0.0)
    record = record_of(hidden.run(short, engine="reduced"))
    targets = [target_of(hidden, None), target_of(hidden, high_piece, seed=2), record]
    result = fit([MOUNT, FRICTION], targets, build)
    assert result.converged and not result.unidentified
    for path, value in true.items():
        assert abs(result.deviation(path, value)) < 3.0
        # With a larger standard error than 2 % the check above would be too weak.
        assert result.standard_errors[path] < 0.02 * value
    assert result.before > 3.0 * result.after
    # The fit estimates the added noise: 3 % in FRFs (assumed right) and in records (assumed 1). The low-pass at 100 Hz
    # leaves 0.18 of the power in records: the integral of 1/(1 + x^8)^2 is 0.898, times 100 over 500 Hz.
    assert [row.rms for row in result.rows[:8]] == pytest.approx([1.0] * 8, abs=0.35)  # 36 values: 3 times 12 %
    assert [row.rms for row in result.rows[8:]] == pytest.approx(
        [NOISE * 0.18**0.5] * 2, rel=0.17
    )  # 180 values: 3 times 5 %


@pytest.mark.parametrize("fitted", [[FRICTION], [FRICTION, MOUNT]])
def test_a_fit_that_leaves_a_large_error_says_so_first(build, fitted):
    """The hidden car differs in friction and mount; with friction alone most of the error remains."""
    hidden = build({MOUNT.path: 4.5e5, FRICTION.path: 85.0})
    short = bump(amplitude=7.5e-3, wheel="fr", duration=1.2, start=0.3, noise_rms=0.0)
    measured = MeasuredTarget(target=record_of(hidden.run(short, engine="reduced")), signal=short)
    tuned = tuned_car(build({}), fitted, [measured], engine="reduced")
    said, page, summary = tuning_text(tuned), tuning_page(tuned, {}, "tune"), tuned.summary()
    answer = page.partition('<p class="answer">')[2].partition("</p>")[0]
    worst = max(row.after for row in tuned.agreement)
    assert summary["error_percent"]["after"] <= worst  # a mean over channels
    if MOUNT in fitted:
        assert worst < 5.0 and tuned.unexplained == summary["unexplained"] == ""
        assert "the data determine every parameter" in said and "the data determine every parameter" in answer
        return
    assert worst > 20.0 and said.splitlines()[0] == tuned.unexplained == summary["unexplained"]
    assert f"{worst:.3g} % " in tuned.unexplained
    assert "for example suspension_mount.stiffness.z" in said  # the other wrong parameter
    assert answer.startswith(tuned.unexplained[:1].upper() + tuned.unexplained[1:80])
    assert "data determine" not in said + page


def test_mass_and_moments_about_the_origin_are_fitted_together(car):
    """Of the car about the origin a step of one of them alone is no body; the fit was refused at its first step."""
    true = {"body.mass": 850.0, "body.inertia.ixx": 1090.0, "body.inertia.iyy": 5600.0}
    start = {"body.mass": 813.0, "body.inertia.ixx": 1000.0, "body.inertia.iyy": 5268.0}
    ranges = [Range(path=path, low=0.8 * value, high=1.3 * value, start=value) for path, value in start.items()]
    result = tune(car, ranges, [target_of(car.with_(true), None)])
    for path, value in true.items():
        assert result.values[path] == pytest.approx(value, abs=4.0 * result.errors[path])
        assert result.errors[path] < 0.05 * value


def test_parameters_of_a_stuck_damper_are_unidentified(build):
    target = target_of(build({MOUNT.path: 6.8e5}), None)
    result = fit([MOUNT, VISCOUS, FRICTION], [target], build)
    assert {held.path for held in result.unidentified} == {VISCOUS.path, FRICTION.path}
    assert result.values[FRICTION.path] == FRICTION.start
    assert abs(result.deviation(MOUNT.path, 6.8e5)) < 3.0


def test_the_last_steps_lead_to_the_full_simulation(build, car, high_run):
    # Data of MuJoCo almost without noise: the residual is the error of the fast model, many standard errors.
    true = {VISCOUS.path: car.vehicle.damper.viscous, FRICTION.path: car.vehicle.damper.coulomb_friction}
    quiet = {name: high_run[name] for name in ("knuckle_fr_acc_z", "damper_fr_velocity")}
    level = {name: 1e-4 * np.std(values) for name, values in quiet.items()}
    noise = np.random.default_rng(8)
    noisy = {name: values + level[name] * noise.standard_normal(values.size) for name, values in quiet.items()}
    record = in_si_units(high_run.time, noisy)
    target = RecordTarget(name="high", signal=high_run.signal, record=record, window=(0.5, 4.0))
    result = fit([VISCOUS, FRICTION], [target], build)
    final = full_steps(result, [target], lambda values: [build(values).run(high_run.signal)])
    assert final.settled and final.largest_steps[-1] <= SMALL < final.largest_steps[0]
    # The size of the reduction depends on the weights of the rows: most of the residual is the noise of the data.
    assert final.result.after < final.first
    for path, value in true.items():
        assert abs(final.result.deviation(path, value)) < 3.0
        assert final.moved[path] == pytest.approx(
            result.deviation(path, final.result.values[path]) * -1.0, rel=0.02
        )  # the logarithm of a change below a percent
    before, after = (
        max(abs(fitted.values[path] / true[path] - 1.0) for path in true) for fitted in (result, final.result)
    )
    assert after < before


def test_a_run_and_its_target_have_the_same_residuals(build, car, high_piece):
    target = target_of(build({FRICTION.path: 100.0}), high_piece)
    run = car.run(high_piece, engine="reduced")
    np.testing.assert_allclose(residuals(target, run), residuals(target, car), atol=1e-6)
    # Data of stuck dampers can be compared with a run too, as in the last steps of a fit.
    stuck = dataclasses.replace(target, signal=None)
    np.testing.assert_array_equal(residuals(stuck, run), residuals(target, run))
    windowed = dataclasses.replace(target, window=0.5)
    np.testing.assert_allclose(residuals(windowed, run), residuals(windowed, car), atol=1e-6)
    assert len(target.rows) == len(residuals(target, car)) == 4
    record = record_of(car.run(bump(amplitude=7.5e-3, wheel="fr", duration=1.3, start=0.3), engine="reduced"))
    assert len(record.rows) == len(record.residuals(car)) == 2


def test_a_channel_without_a_coherent_point_has_no_error(car):
    target = target_of(car, None)
    coherence = target.data.coherence * [[1.0], [0.01]]
    target = dataclasses.replace(target, data=dataclasses.replace(target.data, coherence=coherence))
    nothing: Any = SimpleNamespace(values={}, at_bound=(), unknowns=())
    measured = MeasuredTarget(target=target, signal=None)
    tuned = TunedCar(start=car, result=nothing, measurements=(measured,), engine="reduced", final=None)
    assert [(row.channel, row.measure) for row in tuned.agreement] == [
        (CHANNELS[0], "magnitude"), (CHANNELS[0], "phase")
    ]  # fmt: skip
    assert [row.before for row in tuned.agreement] == pytest.approx([0.26, 1.7], rel=0.3)  # noise of 3 %, 36 lines
    assert tuned.refusal == ""


def test_bad_targets_are_rejected(car, high_piece):
    data = frf_data(np.ones((2, FREQUENCY.size)), 0)

    def of_plate(plate):
        return data.renamed([parsed_name(f"{channel}{plate}") for channel in CHANNELS])

    with pytest.raises(ConfigurationError, match=r"wheel rl \(rear_left\): focus "):
        residuals(FrfTarget(name="low", data=of_plate("/plate_rl"), signal=None), car)
    for changes, message in (
        ({"averages": 0.0}, "low: found 0 averages"),
        ({"data": of_plate("")}, "low: the FRF of knuckle_fr_acc_z "),
        ({"data": of_plate("/plate_fl"), "signal": high_piece}, "low: knuckle_fr_acc_z/plate_fl: "),
        ({"data": dataclasses.replace(data, coherence=0.01 * data.coherence)}, "low: .*coherence"),
    ):
        with pytest.raises((ConfigurationError, DataError), match=message):
            FrfTarget(**{"name": "low", "data": data, "signal": None} | changes)
    time: np.ndarray = np.arange(4001) * 1e-3
    good = {"name": "bump", "signal": high_piece, "window": (1.0, 2.0)}
    ones = np.ones(4001)
    for histories, message in (
        ({}, "bump: "),
        ({"knuckle_acc": ones}, "'knuckle_acc'"),
        ({"engine_acc_z": ones[:9]}, "engine_acc_z .*9 .*4001"),
        ({"engine_acc_z": np.where(time == 1.5, np.nan, ones)}, "engine_acc_z .*NaN"),
        ({"engine_acc_z": np.where(time > 2.0, ones, 0.0)}, "engine_acc_z .*1 to 2 s"),
    ):
        with pytest.raises((DataError, ConfigurationError), match=message):
            RecordTarget(record=in_si_units(time, histories), **good)
    with pytest.raises(ConfigurationError, match=r"bump: .*500 Hz .*4001"):
        RecordTarget(record=in_si_units(time, {"engine_acc_z": ones}), lowpass=500.0, **good)
    slow = RecordTarget(record=in_si_units(time[::2], {"engine_acc_z": ones[::2]}), **good)
    with pytest.raises(DataError, match=r"2001 .*4001"):
        slow.residuals(car)
