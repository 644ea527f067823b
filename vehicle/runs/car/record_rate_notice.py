"""Notice on accelerations whose frequencies a record does not resolve.

The gain of a recorded acceleration falls from 1 to 0 at half the sampling rate
(`vehicle.engines.simulation.recorded_acceleration`). Dividing the spectrum by it gives what the record lacks up to
`RESOLVED` of the gain; motion at higher frequencies, of which nothing is left, comes on top.
"""

from collections.abc import Sequence

import numpy as np

from vehicle.digits import number
from vehicle.engines.simulation.recorded_acceleration import acceleration_gain
from vehicle.engines.simulation.recording import Recording
from vehicle.signals.analysis.spectra import power_spectral_density

RESOLVED = 0.5
"""Smallest gain by which a spectrum is divided: at 1 kHz up to 310 Hz."""

LOW = 0.003
"""Share of the RMS that a record lacks from which a channel is named. Strut tops of three cars at 1 kHz that lack 0.3 %
by this estimate read 0.7 % lower than at 8 kHz, those with 1.2 % read 2.5 % lower."""

SEGMENT, FEWEST = 512, 1024
"""Samples of a segment of the spectrum, and of the shortest record that is examined."""

FASTER = 8
"""Recommended multiple of the rate: up to 250 Hz times it a record is then exact within 3 %."""


def record_rate_notice(recording: Recording, names: Sequence[str]) -> tuple[str, ...]:
    """Return text on the acceleration that lacks most by the rate of its record.

    Args:
        recording: the run.
        names: channels that the user has chosen.
    """
    chosen = [name for name in names if recording.units.get(name) == "m/s2"]
    time = recording.time
    if not chosen or time.size < FEWEST:
        return ()
    interval = float(time[1] - time[0])
    records = np.array([recording.channels[name] for name in chosen])
    spectrum = power_spectral_density(interval, records, window_s=SEGMENT * interval)
    # Density of a mean of zero; the gain at 0 Hz is 1.
    angle = np.maximum(2.0 * np.pi * interval * spectrum.frequency, 1e-3)
    gain = -acceleration_gain(angle) / angle**2
    whole = spectrum.density / np.maximum(gain, RESOLVED) ** 2
    with np.errstate(invalid="ignore"):
        lacking = np.nan_to_num(1.0 - np.sqrt(spectrum.density.sum(axis=-1) / whole.sum(axis=-1)))
    worst = int(np.argmax(lacking))
    if lacking[worst] < LOW:
        return ()
    rate = round(1.0 / interval)
    others = int(np.sum(lacking >= LOW)) - 1
    return (
        f"{chosen[worst]} reads at least {number(100.0 * lacking[worst], 2)} % low (RMS)"
        f"{f', {others} more channels less' if others else ''}: the record at {rate} Hz does not contain its shocks "
        f"above {rate // 5} Hz; for these channels set solver.record_rate={FASTER * rate}",
    )
