"""The error of an overall RMS and of a difference, against the scatter of Gaussian records."""

import numpy as np
import pytest
import scipy

from vehicle.signals.analysis.comfort import comfort_values
from vehicle.signals.analysis.comfort_error import (
    NORMAL_95,
    STUDENT_95,
    WAVES,
    WIDENED,
    difference_error,
    paired,
    wave_error,
)
from vehicle.signals.analysis.ride_comfort import comfort_columns, wave_names

STEP, SAMPLES, RECORDS = 5e-3, 2000, 400
FREQUENCY = np.fft.rfftfreq(SAMPLES, STEP)


def lines(natural, damping, rng, count=RECORDS, *, fixed=False):
    """Lines of an oscillator under white noise, Gaussian or of fixed amplitude; (count, lines)."""
    answer = 1.0 / (natural**2 - FREQUENCY**2 + 2j * damping * natural * FREQUENCY)
    real, imaginary = rng.standard_normal((2, count, FREQUENCY.size))
    noise = real + 1j * imaginary
    return answer * (np.sqrt(2.0) * noise / np.abs(noise) if fixed else noise)


def history(*axes):
    return np.fft.irfft(np.stack(axes, axis=1), SAMPLES, axis=2)


@pytest.mark.parametrize("related", [0.0, 1.0])
def test_stated_error_is_the_scatter(related):
    """Axes that do not know each other, and axes that are copies: the second scatter sqrt(3) as much."""
    rng = np.random.default_rng(1)
    first = lines(12.0, 0.05, rng)
    others = [first if related else lines(12.0, 0.05, rng) for _ in range(2)]
    found = comfort_values(STEP, history(first, *others))
    scatter = found.overall.std(ddof=1) / found.overall.mean()
    # 400 records give a standard deviation within 3.5 %; three times that.
    assert np.sqrt(np.mean(found.error**2)) == pytest.approx(scatter, rel=0.11)
    away = np.abs(found.overall / found.overall.mean() - 1.0)
    # 0.94 with many records; a share of 400 is known within 0.012, three times that.
    assert 0.9 < np.mean(away < 1.96 * found.error) < 0.98


def test_intervals_are_those_of_student():
    left, fitted = (scipy.stats.t.ppf(0.975, 2 * WAVES - less) for less in (0, 1))
    assert pytest.approx(left, rel=1e-9) == STUDENT_95
    assert pytest.approx(np.sqrt(2 * WAVES / (2 * WAVES - 1)) * fitted / left, rel=1e-9) == WIDENED


def test_white_noise_has_the_bandwidth_time_formula():
    noise = np.random.default_rng(4).standard_normal((40, 1, SAMPLES))
    # One axis moves: 1 / (2 sqrt(B T)) with 48 Hz and 10 s. Three copies of it: the same.
    for weights in ([1.0, 0.0, 0.0], [1.0, 1.0, 1.0]):
        found = comfort_values(STEP, noise * np.array(weights)[:, None])
        assert np.sqrt(np.mean(found.error**2)) == pytest.approx(0.5 / np.sqrt(48.0 * 10.0), rel=0.03)


def test_lines_of_fixed_amplitude_have_the_error_of_the_gaussian_road():
    rng = np.random.default_rng(2)
    errors = [
        comfort_values(STEP, history(*[lines(12.0, 0.05, rng, 50, fixed=fixed)] * 3)).error for fixed in (False, True)
    ]
    assert np.sqrt(np.mean(errors[1] ** 2)) == pytest.approx(np.sqrt(np.mean(errors[0] ** 2)), rel=0.1)
    same = comfort_values(STEP, history(*[lines(12.0, 0.05, rng, 50, fixed=True)] * 3)).overall
    assert same.std() < 1e-9 * same.mean()


def test_error_of_a_difference_on_the_same_road():
    """Two cars on one road: the difference scatters far less than each of them."""
    rng = np.random.default_rng(3)
    noise = lines(12.0, 0.05, rng)
    cars = [noise, noise / lines_ratio(0.05, 0.06)]
    values = [comfort_values(STEP, history(one, one, one)) for one in cars]
    gap = values[0].overall - values[1].overall
    stated = difference_error(values[0].waves, values[1].waves)
    assert gap.std(ddof=1) < 0.3 * values[0].overall.std(ddof=1)
    assert np.sqrt(np.mean(stated**2)) == pytest.approx(gap.std(ddof=1), rel=0.11)
    assert values[0].waves.shape == (RECORDS, WAVES + 1) and not values[0].waves[:, -1].any()


def test_the_error_of_the_weighted_value_is_its_scatter():
    """Gaussian motions of 1.5 Hz along x, 4 and 9 Hz along z, by Wd and Wk: not the error of the unweighted RMS."""
    rng = np.random.default_rng(5)
    heave, road = 0.2 * lines(1.5, 0.2, rng), [lines(frequency, 0.1, rng) for frequency in (4.0, 9.0)]
    records = history(heave, 0.0 * heave, road[0] + road[1] + heave)
    other = history(heave, 0.0 * heave, road[0] + 0.9 * road[1] + heave)
    cars = [comfort_columns(STEP, each, skip=2.0) for each in (records, other)]
    for name in ("weighted", "unweighted"):
        values, stated = cars[0][name], cars[0][f"{name}_error"]
        assert rms(stated) == pytest.approx(values.std(ddof=1) / values.mean(), rel=0.11)
        gap = cars[1][name] - values
        waves = [np.stack([car[each] for each in wave_names(name)], axis=1).view(complex) for car in cars]
        assert rms(difference_error(*waves)) == pytest.approx(gap.std(ddof=1), rel=0.11)
    assert rms(cars[0]["unweighted_error"]) > 1.1 * rms(cars[0]["weighted_error"])


def rms(values):
    return np.sqrt(np.mean(values**2))


def lines_ratio(first, second):
    """Answer of the oscillator with the first damping over that with the second."""
    one, other = (1.0 / (144.0 - FREQUENCY**2 + 24j * damping * FREQUENCY) for damping in (first, second))
    return one / other


def test_silence_has_no_error():
    found = comfort_values(STEP, np.zeros((1, 3, SAMPLES)))
    assert found.error == pytest.approx([0.0]) and not found.waves.any()


def complex_waves(rng, count):
    """Return circular Gaussian waves with the variance 1, and a wave 0 of the phases."""
    waves = (rng.standard_normal((count, WAVES, 2)) @ np.array([1.0, 1j])) / np.sqrt(2.0)
    return np.pad(waves, ((0, 0), (0, 1)))


def test_the_error_with_a_twin_covers_what_the_twin_does_not_explain():
    """The value has what is left, as its waves; the twin's part, 30 times larger, is the same on every road."""
    rng, count = np.random.default_rng(7), 20000
    of_twin, left = 30.0 * complex_waves(rng, count), complex_waves(rng, count)
    value = 100.0 + rng.standard_normal(count)
    # A run that follows its twin with the factor 0.9: friction makes a rough stretch a little smoother.
    pair = paired(np.full(count, 30.0), 0.9 * of_twin + left, of_twin)
    assert np.mean(np.abs(value - 100.0) < NORMAL_95 * pair.error) == pytest.approx(0.95, abs=0.005)
    assert np.median(pair.explained) == pytest.approx(1.0 - 1.0 / (1.0 + 0.81 * 900.0), abs=1e-3)
    # Of two cars with equal twins, what is left of both counts.
    other = paired(value, 0.8 * of_twin + complex_waves(rng, count), of_twin)
    gap = np.sqrt(2.0) * rng.standard_normal(count)
    stated = STUDENT_95 * difference_error(pair.waves, other.waves)
    assert np.mean(np.abs(gap) < stated) == pytest.approx(0.95, abs=0.01)


def test_a_twin_that_explains_less_than_half_leaves_the_error_of_the_run():
    rng, count = np.random.default_rng(8), 500
    waves = complex_waves(rng, count)
    stranger = paired(np.full(count, 0.1), waves, complex_waves(rng, count))
    weak = stranger.explained < 0.5
    assert 0.8 < np.mean(weak) < 1.0 and np.all(stranger.error[weak] == 0.1)
    assert np.all(stranger.error[~weak] == wave_error(stranger.waves)[~weak])
    at_rest = paired(np.full(count, 0.1), waves, np.zeros_like(waves))
    assert np.all(at_rest.waves == waves) and np.all(at_rest.error == 0.1) and np.all(np.isnan(at_rest.explained))
