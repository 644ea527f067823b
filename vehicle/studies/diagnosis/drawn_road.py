"""Roads of drawn drives: two random tracks of any level, waviness and coherence, whose level varies along the way.

The sources of the mean and of the difference of the tracks are white Gaussian noise, shaped over frequency by
`vehicle.engines.reduced.road_expectation.track_sources`, with the delay d/V of each wheel and the average over the
contact patch. A waviness w changes the density by (n/n0)^(2 - w). Before they are shaped, the sources are multiplied by
exp(m(t)) with a slow Gaussian m, since no real road is equally rough all along.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.reduced.road_expectation import track_sources
from vehicle.signals.analysis.road_level import REFERENCE
from vehicle.signals.excitation.iso_road import LOWEST, IsoRoad, Side
from vehicle.signals.excitation.road_drive import CONTACT_PATCH
from vehicle.signals.excitation.signal import Signal, uniform_time

SLOW = 4.0
"""Time over which the level of a road changes [s], assumed."""


@dataclass(frozen=True, kw_only=True, slots=True)
class DrawnRoad:
    """Road and speed of a drive.

    Attributes:
        level: density G(n0) at n0 = 0.1 cycles/m [m3].
        waviness: exponent w of the density [-]; 2 for ISO 8608.
        track: distance of tracks with this coherence on an isotropic plane [m].
        variation: standard deviation of the logarithm of the height along the way [-].
        speed: speed V [m/s].
    """

    level: float
    waviness: float
    track: float
    variation: float
    speed: float

    def signal(
        self,
        wheels: Mapping[str, tuple[float, Side]],
        duration: float,
        rate: float,
        highest: float,
        rng: np.random.Generator,
    ) -> Signal:
        """Return the plates of one drive.

        Args:
            wheels: name of each wheel to its distance behind the foremost wheel [m] and its track.
            duration: length [s].
            rate: sampling rate [Hz].
            highest: highest frequency of the plates [Hz].
            rng: random numbers of the drive.
        """
        samples = round(duration * rate) + 1
        size = 2 * (samples // 2 + 1)
        frequency = np.fft.rfftfreq(size, 1.0 / rate).astype(np.float64)
        lines = np.flatnonzero((frequency >= LOWEST * self.speed) & (frequency <= highest))
        slow = np.fft.rfft(rng.standard_normal(size)) * np.exp(-((SLOW * frequency) ** 2))
        change = np.fft.irfft(slow, size)
        modulation = np.exp(self.variation * change / np.std(change))
        # The mean square of the road has the stated level.
        modulation /= np.sqrt(np.mean(modulation**2))
        # White noise of unit one-sided density has the variance rate/2.
        sources = np.fft.rfft(rng.standard_normal((2, size)) * modulation * np.sqrt(0.5 * rate), axis=1)[:, lines]
        road = IsoRoad(level=self.level, seed=1, track=self.track, patch=CONTACT_PATCH)
        shaped = track_sources(road, self.speed, wheels, frequency[lines])
        bent = (frequency[lines] / self.speed / REFERENCE) ** (1.0 - 0.5 * self.waviness)
        spectrum = np.zeros((len(wheels), frequency.size), dtype=np.complex128)
        spectrum[:, lines] = np.einsum("wsm,sm->wm", shaped, sources) * bent
        tracks: Vector = np.fft.irfft(spectrum, size, axis=1)[:, :samples]
        return Signal(
            time=uniform_time(samples=samples, timestep=1.0 / rate),
            displacement=dict(zip(wheels, tracks, strict=True)),
            source="drawn road",
        )
