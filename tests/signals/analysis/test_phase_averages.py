"""Periodic inputs with random phases: density, delays, exact FRFs of a linear system, error of a nonlinear one."""

import numpy as np
import pytest

from tests.signals.analysis.oscillator import state_space, transmissibility
from vehicle.errors import DataError
from vehicle.signals.analysis.phase_averages import PERIOD, PHASES, phase_inputs
from vehicle.signals.analysis.spectra import power_spectral_density

STEP = 1e-3


def record(seconds=20.0, seed=4):
    noise = np.random.default_rng(seed).normal(size=round(seconds / STEP))
    return np.convolve(noise, np.ones(9) / 9, "same")


def test_inputs_have_the_density_of_the_record():
    z = record()
    inputs = phase_inputs(STEP, {"fr": z})
    periods = inputs.periods(inputs.samples["fr"][None])[0]
    assert periods.shape == (PHASES, round(PERIOD / STEP))
    wanted = power_spectral_density(STEP, z, window_s=PERIOD)
    power = 2.0 * np.abs(np.fft.rfft(periods, axis=1)) ** 2 * STEP / periods.shape[1]
    np.testing.assert_allclose(power[:, inputs.lines], np.tile(wanted.density[0, inputs.lines], (PHASES, 1)), rtol=1e-9)
    np.testing.assert_allclose(np.fft.rfft(periods, axis=1)[:, inputs.lines], inputs.spectra, rtol=1e-9)
    assert inputs.samples["fr"][0] == 0.0
    # No jump where one input follows another: the largest step is one of the waves themselves.
    assert np.abs(np.diff(inputs.samples["fr"])).max() < 1.2 * np.abs(np.diff(periods, axis=1)).max()


def test_a_delayed_input_is_the_first_one_later():
    z = record()
    inputs = phase_inputs(STEP, {"fr": z, "rr": z}, {"rr": 0.25})
    first, later = (inputs.periods(inputs.samples[name][None])[0] for name in ("fr", "rr"))
    np.testing.assert_allclose(later, np.roll(first, 250, axis=1), atol=1e-12)


def test_linear_system_has_its_exact_response():
    from scipy.signal import lsim

    inputs = phase_inputs(STEP, {"fr": record()})
    u = inputs.samples["fr"]
    _, y, _ = lsim(state_space(), u, np.arange(u.size) * STEP)
    found = inputs.response(y[None])
    # The input moves linearly between samples: (pi f dt)^2 / 3 = 8e-3 at 50 Hz, 3e-4 at 10 Hz.
    low = found.frequency <= 10.0
    assert np.abs(found.response[0] / transmissibility(found.frequency) - 1.0)[low].max() < 4e-4
    assert np.max(found.random_error[0, low] / np.abs(found.response[0, low])) < 1e-6


def test_error_of_a_nonlinear_system_is_its_scatter_over_seeds():
    z = record()
    responses, errors = [], []
    for seed in range(30):
        inputs = phase_inputs(STEP, {"fr": z}, seed=seed)
        u = inputs.samples["fr"]
        found = inputs.response((u + 0.8 * np.sign(u) * np.std(u))[None])
        responses.append(found.response[0])
        errors.append(found.random_error[0])
    scatter = np.sqrt(0.5 * np.mean(np.abs(responses - np.mean(responses, axis=0)) ** 2))
    # 30 seeds of 4 phases over 200 lines: 1 % in the scatter, and both include neighbouring lines.
    assert np.sqrt(np.mean(np.square(errors))) == pytest.approx(scatter, rel=0.05)
    # Bussgang: the best linear approximation of x + a s sign(x) for a Gaussian x is 1 + a sqrt(2 / pi).
    assert np.mean(np.real(responses)) == pytest.approx(1.0 + 0.8 * np.sqrt(2.0 / np.pi), rel=5e-3)
    assert np.all(found.coherence < 1.0)


def test_bad_records_are_refused():
    for z, message in ((record(3.0), "3 s, .* 4 s"), (np.zeros(9000), "no input moves")):
        with pytest.raises(DataError, match=message):
            phase_inputs(STEP, {"fr": z})
