"""Recognition of periodic inputs, and FRFs over whole periods, against an analytic oscillator and known noise."""

import numpy as np
import pytest
from scipy.signal import lsim

from tests.signals.analysis.oscillator import state_space, stationary_response, transmissibility
from vehicle.signals.analysis.local_rational import local_rational_responses
from vehicle.signals.analysis.periodic_record import repeated_samples, whole_record_responses

STEP, PERIOD = 2e-4, 2.0
COUNT = round(PERIOD / STEP)


def wave(count=COUNT, lines=120):
    """Lines k / T with quadratic phases (Schroeder); 0.5 to 60 Hz by default."""
    line = np.arange(1, lines + 1)
    return np.cos(2 * np.pi * np.outer(np.arange(count) / count, line) - np.pi * line**2 / line.size).sum(axis=1)


def settled(periods, noise=0.0, seed=3):
    """Input, steady-state response and noise of `periods` periods."""
    excitation = np.tile(wave(), periods)
    response = stationary_response(excitation, STEP, transmissibility)
    return excitation, response + noise * np.std(response) * np.random.default_rng(seed).normal(size=response.size)


def test_an_oscillator_integrated_in_time_shows_its_analytic_response():
    excitation = np.tile(wave(), 4)
    _, response, _ = lsim(state_space(), excitation, np.arange(excitation.size) * STEP)
    (found,) = whole_record_responses(STEP, excitation[None], response)
    assert found.estimator == "periodic input, 4 periods of 2 s"
    np.testing.assert_allclose(found.frequency, np.arange(1.0, 50.25, 0.5))
    # The plate moves linearly between samples: (pi f dt)^2 / 3 = 3.3e-4 at 50 Hz; the transient has fallen by
    # exp(-0.1 * 2 pi * 8 * 6) = 8e-14.
    assert np.abs(found.response[0] / transmissibility(found.frequency) - 1.0).max() < 4e-4
    # The oscillator is not exactly a fraction with one pole over nine lines.
    assert np.max(found.random_error / np.abs(found.response)) < 1e-3
    assert found.coherence.min() > 1.0 - 1e-6


def test_the_spread_over_periods_is_the_error_of_the_response():
    periods, noise, gaps, errors, unexplained = 8, 0.05, [], [], []
    for seed in range(20):
        excitation, response = settled(periods, noise, seed)
        (found,) = whole_record_responses(STEP, excitation[None], response)
        assert np.all(found.averages == periods)
        gaps.append(np.abs(found.response[0] - transmissibility(found.frequency)) ** 2 / 2.0)
        errors.append(found.random_error[0] ** 2)
        unexplained.append(1.0 - found.coherence[0])
    # 20 x 99 lines: the mean square has a standard error of 2.3 %, and that of the estimate is 0.9 %.
    assert np.sqrt(np.mean(gaps) / np.mean(errors)) == pytest.approx(1.0, abs=0.05)
    # gamma^2 = P / (P + N) of a line in a single period: N is noise^2 of the total power, spread over all lines.
    line_power = np.abs(transmissibility(found.frequency)) ** 2
    total = np.sum(np.abs(transmissibility(np.arange(1, 121) / PERIOD)) ** 2)
    expected = 1.0 - line_power / (line_power + noise**2 * total / (COUNT / 2))
    assert np.mean(np.mean(unexplained, axis=0) / expected) == pytest.approx(1.0, abs=0.05)


def test_a_response_that_has_not_settled_is_estimated_as_a_random_record():
    excitation = np.tile(wave(), 3)
    _, response, _ = lsim(state_space(damping=0.01), excitation, np.arange(excitation.size) * STEP)
    (found,) = whole_record_responses(STEP, excitation[None], response, names=["seat"])
    assert found.estimator.startswith("local rational")
    assert "seat changes by" in found.reasons[0] and "periods" in found.reasons[0]


def test_a_nonlinear_response_is_estimated_as_a_random_record():
    excitation, response = settled(4)
    friction = np.sign(np.gradient(response))
    for share, name in ((0.001, "periodic"), (0.5, "local rational")):
        (found,) = whole_record_responses(STEP, excitation[None], response + share * np.std(response) * friction)
        assert found.estimator.startswith(name)
    assert "scatters by" in found.reasons[0]
    np.testing.assert_allclose(found.frequency * PERIOD, np.round(found.frequency * PERIOD))  # lines of one period


def test_other_records_keep_their_estimator():
    rng = np.random.default_rng(5)
    noise = rng.normal(size=4 * COUNT)
    once = wave()  # a single period is not seen to repeat
    other = np.tile(wave(), 4)
    other[-COUNT // 2] += 1e-3  # a sample differs
    for excitation in (noise, once, other):
        (found,) = whole_record_responses(STEP, excitation[None], excitation)
        (expected,) = local_rational_responses(STEP, excitation[None], excitation)
        assert found.estimator == expected.estimator
        np.testing.assert_array_equal(found.response, expected.response)


def test_periods_are_recognised_within_the_rounding_of_a_file():
    clean = np.tile(wave(1000), 4)[: 3 * 1000 + 700]
    moved = clean.copy()
    moved[:600] *= np.linspace(0.0, 1.0, 600)  # fades in
    for samples, whole in ((clean, 3), (moved, 3)):
        assert repeated_samples(samples, 100)[:2] == (1000, whole)
        assert repeated_samples(np.round(samples, 4), 100)[:2] == (1000, whole)
    # Rounded after a shift by a part of a step, as two periods of a measured record are.
    shifted = clean + 3e-5 * np.sin(np.arange(clean.size))
    assert repeated_samples(np.round(shifted, 4), 100)[:2] == (1000, 3)
    assert repeated_samples(shifted, 100)[0] == 0  # not a rounding
    # 1000.5 samples: the record repeats after twice that.
    half = np.interp(np.arange(6003) % 1000.5, np.arange(1001.0), np.append(wave(1000), wave(1000)[0]))
    assert repeated_samples(half, 100)[0] == 2001


@pytest.mark.parametrize(
    "samples",
    [
        np.zeros(4000),
        np.concatenate([wave(1000), np.zeros(3000)]),
        np.linspace(0.0, 1.0, 4000),
        np.round(np.linspace(0.0, 1.0, 4000), 5),
        np.sin(2e-6 * np.arange(4000) ** 2),
        np.round(np.random.default_rng(1).normal(size=4000)),
        np.tile(np.round(wave(1000)), 4),
    ],
    ids=["zero", "rest", "ramp", "rounded ramp", "sweep", "few values", "coarse"],
)
def test_rest_slow_motion_and_coarse_samples_are_not_taken_for_periods(samples):
    assert repeated_samples(samples, 100) == (0, 0, 0.0)


def test_a_sine_and_a_constant_response():
    sine = np.sin(2 * np.pi * 5.0 * np.arange(20000) * 1e-3)
    (found,) = whole_record_responses(1e-3, sine[None], sine)
    assert found.estimator.startswith("local rational")  # a single line does not show that the response is linear
    excitation, response = settled(3)
    (found,) = whole_record_responses(STEP, excitation[None], [response, np.full_like(response, 0.2)], names=("a", "b"))
    (reason,) = found.reasons
    assert reason.startswith("b: constant")
    assert np.isfinite(found.response[0]).all()
    assert np.isnan(found.response[1]).all()
