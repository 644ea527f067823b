"""Drawn roads: the density of the class, the delay of the axles, the coherence of the tracks."""

import numpy as np
import pytest
import scipy

from vehicle.signals.excitation.iso_road import Side
from vehicle.signals.excitation.road_drive import CONTACT_PATCH
from vehicle.studies.diagnosis.drawn_road import DrawnRoad

WHEELS: dict[str, tuple[float, Side]] = {"fl": (0.0, "left"), "fr": (0.0, "right"), "rl": (2.75, "left")}


@pytest.mark.parametrize(("waviness", "variation"), [(2.0, 0.0), (1.7, 0.4), (2.3, 0.0)])
def test_the_density_is_that_of_the_level_and_the_waviness(waviness, variation):
    speed, level, rate = 20.0, 64e-6, 200.0
    road = DrawnRoad(level=level, waviness=waviness, track=1.5, variation=variation, speed=speed)
    signal = road.signal(WHEELS, 2000.0, rate, 80.0, np.random.default_rng(1))
    frequency, found = scipy.signal.welch(signal.displacement["fl"], rate, nperseg=8000)
    for low, high in ((0.5, 2.0), (2.0, 8.0), (8.0, 40.0)):
        inside = (frequency >= low) & (frequency < high)
        n = frequency[inside] / speed
        expected = level * (n / 0.1) ** -waviness / speed * np.sinc(n * CONTACT_PATCH) ** 2
        # 50 windows and at least 60 lines: 2 % by chance; a variation of 0.4 over 4 s triples it.
        assert np.mean(found[inside] / expected) == pytest.approx(1.0, abs=0.06 if variation == 0.0 else 0.12)


def test_a_rear_wheel_follows_after_the_wheelbase_and_the_tracks_differ_at_short_waves():
    road = DrawnRoad(level=64e-6, waviness=2.0, track=1.5, variation=0.0, speed=22.0)
    signal = road.signal(WHEELS, 100.0, 200.0, 80.0, np.random.default_rng(2))
    left, right, rear = (signal.displacement[wheel] for wheel in WHEELS)
    delay = round(2.75 / 22.0 * 200.0)
    assert delay == 25
    # The road repeats after the record and one sample or two: compared inside.
    assert rear[delay + 5 :] == pytest.approx(left[5:-delay], abs=1e-9)
    frequency, coherence = scipy.signal.coherence(left, right, 200.0, nperseg=1000)
    assert coherence[frequency < 1.0].mean() > 0.8
    assert coherence[frequency > 20.0].mean() < 0.2
