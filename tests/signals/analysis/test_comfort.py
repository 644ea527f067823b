import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import DataError
from vehicle.signals.analysis.comfort import comfort_values, rms_standard_error, settling

STEP = 2e-3
TIME = np.arange(10_000) * STEP


def coloured(rng, runs, samples):
    """Gaussian noise with a resonance at 12 Hz of 10 % damping, periodic in the record."""
    lines = np.fft.rfftfreq(samples, STEP)
    shape = 1.0 / np.abs(1 - (lines / 12.0) ** 2 + 0.2j * lines / 12.0)
    return np.fft.irfft(np.fft.rfft(rng.standard_normal((runs, samples)), axis=1) * shape, samples, axis=1)


def test_the_comfort_value_of_sines_is_their_rms():
    xyz = [3 * np.sin(2 * np.pi * 5 * TIME), 4 * np.sin(2 * np.pi * 20 * TIME), 12 * np.cos(2 * np.pi * 40 * TIME)]
    # outside the band: a slow heave, gravity and a whine
    xyz[2] = xyz[2] + 9.81 + 5 * np.sin(2 * np.pi * 1.0 * TIME) + np.sin(2 * np.pi * 90 * TIME)
    value = comfort_values(STEP, [xyz])
    # whole periods in the record: exact but for rounding; 3-4-12-13
    validated(
        "Comfort, ISO 2631", "comfort value of sines, axes x, y, z and overall",
        np.array([*value.axes[0], value.overall[0]]), np.array([3, 4, 12, 13]) / np.sqrt(2), rel=1e-6,
        unit="m/s2", source="closed form: a / sqrt(2)",
    )  # fmt: skip


def test_comfort_needs_three_axes():
    with pytest.raises(DataError, match=r"found shape \(1, 2, 1000\), must be \(r, 3, n\)"):
        comfort_values(STEP, np.ones((1, 2, 1000)))


def test_standard_error_of_white_noise_is_the_bandwidth_time_formula():
    noise = np.random.default_rng(2).standard_normal((40, 10_000))
    errors = rms_standard_error(STEP, noise)
    # 1 / (2 sqrt(B T)) with 48 Hz and 20 s; a single estimate scatters by about 4 %
    validated(
        "Statistics and intervals", "relative standard error of the RMS of white noise", errors.mean(),
        1 / (2 * np.sqrt(48 * 20)), rel=0.03, source="closed form: 1 / (2 sqrt(B T)), Bendat and Piersol",
    )  # fmt: skip


def test_standard_error_of_coloured_noise_equals_the_observed_scatter():
    # second derivation: Monte Carlo, 400 records; the standard deviation of 400 values is known within 3.5 %
    records = coloured(np.random.default_rng(3), 400, 4000)
    rms = comfort_values(STEP, np.repeat(records[:, None], 3, axis=1)).axes[:, 0]
    seen = rms.std(ddof=1) / rms.mean()
    validated(
        "Statistics and intervals", "relative standard error of the RMS of coloured noise",
        rms_standard_error(STEP, records).mean(), seen, rel=0.11, source="second derivation: scatter of 400 records",
    )  # fmt: skip
    # the resonance makes it far larger than the full bandwidth would
    assert seen > 1.5 / (2 * np.sqrt(48 * 8))


def test_standard_error_of_silence_is_zero():
    assert rms_standard_error(STEP, np.zeros(1000)) == pytest.approx([0.0])


def test_a_decaying_transient_is_not_settled():
    (found,) = settling(STEP, np.exp(-0.2 * TIME) * coloured(np.random.default_rng(4), 1, TIME.size)[0])
    assert not found.settled
    # the RMS falls by exp(-0.2 * 10) = 0.135 from half to half: drift 2 (0.135 - 1) / 1.135, within the random scatter
    assert found.drift == pytest.approx(-1.52, abs=4 * found.standard_error)


def test_a_stationary_record_is_settled_although_its_halves_differ():
    found = settling(STEP, coloured(np.random.default_rng(5), 60, TIME.size))
    drifts = np.array([one.drift for one in found])
    # their scatter is what is predicted: 60 values know it within 9 %
    assert drifts.std() == pytest.approx(np.mean([one.standard_error for one in found]), rel=0.3)
    assert np.mean([abs(one.drift) > 0.01 for one in found]) > 0.5
    assert np.mean([one.settled for one in found]) > 0.95


def test_a_sine_is_settled_and_a_growing_sine_is_not():
    sine = np.sin(2 * np.pi * 10 * TIME)
    steady, silent = settling(STEP, [sine, 0 * sine])
    assert abs(steady.drift) < 1e-9
    assert steady.settled
    assert (silent.drift, silent.settled) == (0.0, True)
    # fifty sines, so that the random error of a line spectrum is small, growing five times from half to half
    lines = np.sin(2 * np.pi * np.outer(np.arange(2.0, 50.0), TIME) + np.arange(48)[:, None] ** 2).sum(axis=0)
    (growing,) = settling(STEP, lines * np.where(TIME < 10.0, 1.0, 5.0))
    assert growing.drift == pytest.approx(2 * 4 / 6, rel=0.01)
    assert not growing.settled


def test_settling_needs_two_halves():
    with pytest.raises(DataError, match="found 3 samples, must be at least 4"):
        settling(STEP, [1.0, 2.0, 3.0])
