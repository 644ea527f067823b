from functools import partial

import numpy as np
import pytest
from scipy.signal import welch
from scipy.stats import kurtosis

from scenarios.signals.random_road import random_road
from tests.validation import validated
from vehicle.errors import ConfigurationError


@pytest.mark.parametrize("rms", [1.06e-4, 3.17e-4, 5.25e-4])
@pytest.mark.parametrize("taper", [0.0, 0.5])
def test_rms_and_mean_are_exact(rms, taper):
    signal = random_road(rms=rms, seed=5, wheel="fr", taper_length=taper)
    # rounding of 60001 samples
    validated(
        "Roads and excitation", f"RMS of a random input of {1e3 * rms:g} mm, taper {taper:g} s", signal.rms("fr"), rms,
        rel=1e-12, unit="m", source="closed form: the RMS that was asked for",
    )  # fmt: skip
    assert abs(np.mean(signal.displacement["fr"])) < 1e-12 * rms
    assert signal.time.size == 60001
    assert signal.duration == 60.0


def test_same_seed_same_signal_and_another_seed_another():
    a, b = (random_road(rms=1e-4, seed=5, wheel="fr", duration=5.0).displacement["fr"] for _ in range(2))
    assert np.array_equal(a, b)
    c = random_road(rms=1e-4, seed=6, wheel="fr", duration=5.0).displacement["fr"]
    assert abs(np.corrcoef(a, c)[0, 1]) < 0.5  # about 1/sqrt(2 * 48 Hz * 5 s) = 0.05 for independent ones


def test_begins_and_ends_at_rest():
    signal = random_road(rms=1e-4, seed=5, wheel="fr", duration=5.0)
    z = signal.displacement["fr"]
    assert z[0] == 0.0
    assert z[-1] == 0.0
    assert not np.signbit(z[0])  # "-0.0" would appear in the file
    velocity = signal.plate_motion([0.0, 5.0]).velocity["fr"]
    # Weight (pi t / 2 T)^2: the first step has 2.5e-6 of the motion; 1e-4 of the RMS velocity (6e-3 m/s) is at rest.
    assert np.all(np.abs(velocity) < 6e-7)


def test_without_taper_the_record_is_one_period():
    z = random_road(rms=1e-4, seed=5, wheel="fr", duration=5.0, taper_length=0.0).displacement["fr"]
    assert z[0] == z[-1]
    lines = np.abs(np.fft.rfft(z[:-1])) / z.size
    outside = np.ones(lines.size, dtype=bool)
    outside[10:251] = False  # 2 to 50 Hz at 0.2 Hz
    # Nothing but rounding outside the band, not even its neighbours; line 0 holds the mean of the extra sample.
    assert lines[1:][outside[1:]].max() < 1e-12 * lines.max()
    assert lines[10] > 1e-3 * lines.max()  # both edges belong to the band
    assert lines[250] > 1e-4 * lines.max()


def test_displacement_psd_falls_with_the_square_of_frequency():
    signal = random_road(rms=5.25e-4, seed=5, wheel="fr", duration=240.0)
    f, psd = welch(signal.displacement["fr"], fs=1000.0, nperseg=8000)
    band = (f >= 3.0) & (f <= 48.0)
    slope, intercept = np.polyfit(np.log(f[band]), np.log(psd[band]), 1)
    # 59 averages: each line of ln PSD scatters by 0.13 to 0.18; 360 correlated lines, spread of ln f 0.65: the slope
    # scatters by 0.016, three times that is allowed.
    validated(
        "Roads and excitation", "slope of the density of a random input", slope, -2.0, abs=0.05,
        source="closed form: velocity of constant density",
    )  # fmt: skip
    # Level from the RMS: 4 pi^2 G_z f^2 = G_v gives G_z f^2 = rms^2 / (1/f1 - 1/f2). The RMS sits in the lowest octave:
    # 2 Hz * 240 s = 480 cycles, 5 % scatter of its square, and 1 % of the fit.
    level = 5.25e-4**2 / (1.0 / 2.0 - 1.0 / 50.0)
    validated(
        "Roads and excitation", "density of a random input times f^2",
        np.exp(intercept + slope * np.log(12.0)) * 12.0**2, level, rel=0.12, unit="m2 Hz",
        source="closed form: rms^2 / (1 / f1 - 1 / f2)",
    )  # fmt: skip


def test_amplitudes_are_gaussian():
    z = random_road(rms=1e-4, seed=5, wheel="fr", duration=240.0).displacement["fr"]
    # Kurtosis of a Gaussian 0; effective samples about 2 * 8 Hz * 240 s: 1 sigma = sqrt(24 / 4000) = 0.08.
    assert abs(kurtosis(z)) < 0.3
    # Rayleigh amplitudes: the line powers times f^2 scatter exponentially (std = mean); pure random phases would have
    # none.
    lines = np.abs(np.fft.rfft(z[:-1])) ** 2
    k = np.arange(600, 11900)
    scaled = lines[k] * k**2
    assert np.std(scaled) / np.mean(scaled) == pytest.approx(1.0, abs=0.2)


def test_the_band_edge_does_not_change_the_road():
    # One seed is one road: without taper the content above 5 Hz has the same phases and ratios whatever the lower edge.
    wide, narrow = (
        np.fft.rfft(
            random_road(
                rms=1e-4, seed=5, wheel="fr", duration=5.0, lower_band_edge=edge, taper_length=0.0
            ).displacement["fr"][:-1]
        )
        for edge in (1.0, 5.0)
    )
    ratio = wide[25:251] / narrow[25:251]
    np.testing.assert_allclose(ratio, ratio[0], rtol=1e-9)  # rounding of lines 50 times below the largest


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"rms": 0.0}, "RMS 0.0 m"),
        ({"rms": float("nan")}, "RMS nan m"),
        ({"duration": -1.0}, "duration -1.0 s at 1000.0 Hz"),
        ({"duration": 1.0005}, "1000.5 time steps"),
        ({"lower_band_edge": 60.0}, "band 60.0 to 50.0 Hz"),
        ({"lower_band_edge": 0.0}, "band 0.0 to 50.0 Hz"),
        ({"upper_band_edge": 450.0}, "upper <= 400 Hz"),
        ({"lower_band_edge": 2.01, "upper_band_edge": 2.09}, "2.01 to 2.09 Hz has no line (they are 0.2 Hz apart)"),
        ({"level": "bands"}, "level 'bands'; allowed: record, lines"),
        ({"taper_length": 3.0}, "taper 3.0 s; allowed: 0 to half of the record, 2.5 s"),
    ],
)
def test_bad_parameters_are_refused(change, message):
    with pytest.raises(ConfigurationError) as caught:
        random_road(**{"rms": 1e-4, "seed": 5, "wheel": "fr", "duration": 5.0, **change})
    assert message in str(caught.value)


@pytest.mark.parametrize("order", [0, 2])
def test_each_line_has_the_level_of_the_density(order):
    road = partial(
        random_road, rms=5e-4, wheel="fr", duration=20.0, lower_band_edge=4.0, roll_off_order=order, level="lines"
    )
    records = [road(seed=seed, taper_length=0.0).displacement["fr"] for seed in (1, 2)]
    assert abs(np.corrcoef(records[0], records[1])[0, 1]) < 0.5
    checked: list[object] = []
    for z in records:
        power = 2.0 * np.abs(np.fft.rfft(z[:-1]) / (z.size - 1)) ** 2  # A_k^2 / 2 of each line
        k = np.arange(20 if order else 80, 1001)  # 1 or 4 to 50 Hz at 0.05 Hz
        density = 1.0 / k**2.0 / (1.0 + (80 / k) ** (2 * order) if order else 1.0)
        validated(
            "Roads and excitation",
            f"power of the lines of a road, roll-off of order {order}, record {len(checked) + 1}", power[k],
            5e-4**2 * density / density.sum(), rel=1e-9, unit="m2",
            source="closed form: density times distance of lines",
        )  # fmt: skip
        checked.append(power)
        assert power.sum() - power[0] == pytest.approx(5e-4**2, rel=1e-9)
    tapered = road(seed=1)
    # (1 - cos)^2 / 4 has the mean 3/8: two ends of 0.5 s of 20 s lose 5/8 of 1/20, half of it in the RMS: 1.6 %
    assert tapered.rms("fr") == pytest.approx(5e-4 * (1.0 - 0.016), rel=0.02)
    assert tapered.displacement["fr"][0] == tapered.displacement["fr"][-1] == 0.0
