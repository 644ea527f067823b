import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.spectra import band_rms, periodogram, power_spectral_density


@pytest.mark.parametrize("samples", [1000, 1001])
def test_periodogram_holds_the_mean_square_exactly(samples):
    signal = 3.0 + np.random.default_rng(1).standard_normal((2, samples))
    spectrum = periodogram(1e-3, signal)
    # Parseval's theorem: equal but for rounding
    validated(
        "FRF estimation and spectra", f"area under the periodogram of {samples} samples",
        spectrum.density.sum(axis=1) * spectrum.resolution_hz, (signal**2).mean(axis=1), rel=1e-13,
        source="conservation: Parseval's theorem",
    )  # fmt: skip


def test_welch_density_of_white_noise_is_flat_at_its_known_value():
    rng = np.random.default_rng(2)
    spectrum = power_spectral_density(1e-3, 2.0 * rng.standard_normal(200_000), window_s=1.0)
    # one-sided density of variance 4 over 500 Hz; the mean over 400 lines x 375 averages scatters by 0.3 %
    validated(
        "FRF estimation and spectra", "Welch density of white noise", spectrum.density[0, 20:420].mean(), 4.0 / 500.0,
        rel=0.01, unit="1/Hz", source="closed form: variance over bandwidth",
    )  # fmt: skip
    assert spectrum.resolution_hz == 1.0
    # Parseval: the window weighs the samples of each segment unevenly, so equal only within the same scatter
    assert spectrum.density.sum() * spectrum.resolution_hz == pytest.approx(4.0, rel=0.02)


def test_welch_density_of_a_sine_holds_its_mean_square():
    time = np.arange(8000) * 1e-3
    spectrum = power_spectral_density(1e-3, 5.0 * np.sin(2 * np.pi * 10.0 * time), window_s=2.0)
    # whole periods in each window: the Hann window spreads the line over three and keeps the sum
    validated(
        "FRF estimation and spectra", "area under the Welch density of a sine",
        spectrum.density.sum() * spectrum.resolution_hz, 12.5, rel=1e-12, source="closed form: a^2 / 2",
    )  # fmt: skip


def test_band_rms_includes_only_lines_in_the_band():
    time = np.arange(10_000) * 1e-3
    low, inside, high = (np.sin(2 * np.pi * f * time) for f in (1.0, 10.0, 80.0))
    signal = 7.0 * low + 2.0 * inside + 4.0 * high + 9.81
    # whole periods in 10 s: RMS of amplitude 2, exact but for rounding
    validated(
        "FRF estimation and spectra", "RMS in 2 to 50 Hz of three sines and a constant",
        band_rms(1e-3, signal, (2.0, 50.0)), np.sqrt(2.0), rel=1e-12,
        source="closed form: a / sqrt(2) of the sine in the band",
    )  # fmt: skip


@pytest.mark.parametrize("frequency", [2.0, 50.0])
def test_a_line_on_an_edge_of_the_band_counts_half(frequency):
    """Half of its cell is inside."""
    time = np.arange(10_000) * 1e-3
    assert band_rms(1e-3, np.sin(2 * np.pi * frequency * time), (2.0, 50.0))[0] == pytest.approx(0.5, rel=1e-9)


@pytest.mark.parametrize("samples", [6000, 10_000, 30_000, 7130])
def test_a_flat_density_has_its_mean_square_over_the_width_of_the_band(samples):
    """Lines of equal power every 1/T: the mean square is S (high - low) for any length; neighbouring bands add up."""
    phases = np.exp(2j * np.pi * np.random.default_rng(1).random(samples // 2 + 1))
    noise = np.fft.irfft(phases, samples) * np.sqrt(0.5 * samples / 1e-3)  # S = 1/Hz
    squares = [band_rms(1e-3, noise, band)[0] ** 2 for band in ((2.0, 50.0), (2.0, 17.0), (17.0, 50.0))]
    assert squares[0] == pytest.approx(48.0, rel=1e-9)
    assert squares[1] + squares[2] == pytest.approx(squares[0], rel=1e-12)


def test_slow_sampling_is_refused_with_the_rate_needed():
    with pytest.raises(DataError) as refusal:
        band_rms(0.01, np.zeros(1000), (2.0, 50.0))
    assert str(refusal.value) == (
        "sampling rate: found 100 Hz, must be at least 125 Hz to evaluate up to 50 Hz; sample faster or lower the "
        "band edge to 40 Hz"
    )


@pytest.mark.parametrize("band", [(50.0, 2.0), (2.0, 2.0), (-1.0, 5.0), (2.0, np.nan)])
def test_an_empty_band_is_refused(band):
    with pytest.raises(ConfigurationError, match="band: found"):
        band_rms(1e-3, np.ones(1000), band)


def test_a_record_without_a_line_in_the_band_is_refused():
    with pytest.raises(DataError, match=r"10 Hz apart, .* 2 to 5 Hz"):
        band_rms(1e-3, np.ones(100), (2.0, 5.0))


@pytest.mark.parametrize("step", [0.0, -1e-3, np.nan, np.inf])
def test_an_invalid_time_step_is_rejected(step):
    with pytest.raises(ConfigurationError, match="time step: found"):
        periodogram(step, np.ones(10))
