"""The road signals: exact level, flat velocity PSD, band, one road at two levels."""

import numpy as np
import pytest

from scenarios.signals.exact_road import RATE_HZ, ROAD_RMS, road, velocity_density
from vehicle.errors import ConfigurationError

LEAD = 5.0


def record(signal):
    """The evaluated part: one period of the lines."""
    return signal.displacement["fr"][round(LEAD * RATE_HZ) + 1 :]


def test_velocity_density_is_flat_at_the_level_that_the_band_gives():
    # An edge of three lines: at 0.017 Hz, of one line of 1/60 Hz, the sum over lines is 7 % below the integral over the
    # band, and the exact RMS takes the density up.
    edge = 0.05
    signal = road(rms=0.0075, seed=3, wheel="fr", duration=60.0, lead=LEAD, lower_band_edge=edge)
    # At half a line off the grid a record of T = 60 s holds broken periods: differences show the velocity, a Hann
    # window keeps the leak of the large low lines away; 11 Hz of band average 660 lines.
    velocity = np.diff(signal.displacement["fr"][round(LEAD * RATE_HZ) :]) * RATE_HZ
    window = np.hanning(velocity.size)
    density = 2.0 * np.abs(np.fft.rfft(window * velocity)) ** 2 / (RATE_HZ * np.sum(window**2))
    frequency = np.fft.rfftfreq(velocity.size, 1.0 / RATE_HZ)
    for low, high in ((1.0, 12.0), (12.0, 23.0), (37.0, 48.0)):
        inside = (frequency >= low) & (frequency < high)
        # A difference over 1 ms sees sinc(f / rate): 0.8 % at 48 Hz. Interference of neighbours under the window
        # leaves about 1 / sqrt(660) of it.
        assert np.mean(density[inside]) == pytest.approx(velocity_density(0.0075, edge), rel=0.08)
    assert np.mean(density[(frequency > 51.0) & (frequency < 100.0)]) < 1e-4 * velocity_density(0.0075, edge)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_level_does_not_depend_on_the_seed(seed):
    # Ten periods of the lowest line: what its broken period leaves is far below the 22 % that random amplitudes would.
    signal = road(rms=0.01, seed=seed, wheel="fr", duration=50.0, lead=LEAD, lower_band_edge=0.2)
    assert np.std(record(signal)) == pytest.approx(0.01, rel=0.02)
    # With the edge half a line below a multiple of 1/T all lines are periods of the record: exact within rounding.
    exact = road(rms=0.01, seed=seed, wheel="fr", duration=50.0, lead=LEAD, lower_band_edge=0.19)
    assert np.std(record(exact)) == pytest.approx(0.01, rel=1e-9)


def test_both_roads_are_one_road():
    smooth, rough = (road(rms=rms, seed=1, wheel="fr", duration=10.0, lead=LEAD) for rms in ROAD_RMS.values())
    ratio = ROAD_RMS["rough"] / ROAD_RMS["smooth"]
    np.testing.assert_allclose(rough.displacement["fr"], ratio * smooth.displacement["fr"], rtol=1e-12, atol=1e-15)
    other = road(rms=ROAD_RMS["smooth"], seed=2, wheel="fr", duration=10.0, lead=LEAD)
    assert np.std(record(other) - record(smooth)) > 0.5 * np.std(record(smooth))


def test_the_lead_begins_at_rest_and_runs_into_the_record():
    signal = road(rms=0.01, seed=0, wheel="fr", duration=20.0, lead=LEAD)
    z = signal.displacement["fr"]
    assert z[0] == 0.0
    assert abs(z[1]) < 1e-6
    assert signal.duration == pytest.approx(25.0)
    # No jump where the period closes: acceleration there as everywhere.
    bend = np.abs(np.diff(z, 2))
    joint = round(LEAD * RATE_HZ)
    assert np.max(bend[joint - 3 : joint + 3]) < np.max(bend[joint + 100 :]) * 1.5


def test_impossible_roads_are_refused():
    for wrong in ({"rms": 0.0}, {"rms": 0.01, "lower_band_edge": 0.0}, {"rms": 0.01, "duration": -1.0}):
        with pytest.raises(ConfigurationError):
            road(**{"seed": 0, "wheel": "fr", **wrong})
