"""Generate the smooth and the rough road of Bommer 2006 under one wheel.

Both are the same road at two levels: constant velocity PSD G_v = (2 pi RMS)^2 / (1/f1 - 1/f2) from f1 to f2, so the
lower edge f1 determines the share of the printed RMS that excites the suspension.
"""

from functools import lru_cache

import numpy as np

from vehicle.signals.excitation.band import UPPER_BAND_EDGE_HZ, positive, samples_of
from vehicle.signals.excitation.rest import half_cosine
from vehicle.signals.excitation.signal import Signal, uniform_time
from vehicle.signals.excitation.slip_set import CHOSEN

ROAD_RMS = {"smooth": 0.0075, "rough": 0.043}
"""RMS of the displacement [m] (Bommer 2006, chapter 4)."""

ROAD_EDGE_HZ = CHOSEN.road_edge_hz
"""Lower band edge f1 of both roads [Hz]. Fitted to two slip shares: 31.6 % and 81.5 %, printed 31.3 % and
79.4 %. A record of 30 s, shown in the source with peak to peak 0.1 to 0.2 m, has its lowest line at 0.033 Hz."""

LEAD_S = 10.0
"""Time before the evaluated record [s]: several decay times of the slowest mode with both dampers stuck."""

RISE_S = 2.0
"""Half-cosine rise from rest at the beginning of the lead [s]."""

RATE_HZ = 1000.0
"""Sampling rate of the signals [Hz]."""


@lru_cache(maxsize=16)
def road(
    *,
    rms: float,
    seed: int,
    wheel: str,
    duration: float = 60.0,
    lead: float = LEAD_S,
    lower_band_edge: float = ROAD_EDGE_HZ,
) -> Signal:
    """Generate a road of constant velocity PSD with exact level: a lead from rest, then the record to evaluate.

    z(t) = a sum over j of cos(2 pi f_j t + phi_j) / f_j,  f_j = f1 + (j + 1/2) / T, one line in each cell of the band

    Equal velocity amplitude on every line, random phases. Gaussian amplitudes scaled to the RMS are not suitable: the
    few lowest lines dominate the RMS, so the level at 2 to 50 Hz would differ by a fifth between records of 60 s.
    Here both RMS and PSD are exact, and only the phases are random. Lines 1 / T apart are
    orthogonal over the record, whole periods or not.

    Args:
        rms: root mean square of the displacement [m], a^2 sum(1 / f_j^2) / 2.
        seed: seed of the PCG64 generator of the phases; one seed is one road at any level.
        wheel: wheel whose plate moves, such as `car.vehicle.shaker_wheel`.
        duration: evaluated length T [s].
        lead: length of the lead before the evaluated record [s], with a rise from rest.
        lower_band_edge: lower band edge f1 [Hz].

    Returns:
        Signal from 0 to lead + duration.

    Raises:
        ConfigurationError: a parameter is out of range.

    Source: Bommer 2006, sections 2.3.1 and 4; Shinozuka and Deodatis, Appl. Mech. Rev. 44 (1991).
    """
    positive("RMS", rms, "m")
    positive("lower band edge", lower_band_edge, "Hz")
    steps, before = samples_of(duration, RATE_HZ), samples_of(lead, RATE_HZ)
    cells = int((UPPER_BAND_EDGE_HZ - lower_band_edge) * duration + 1e-9)
    frequency = lower_band_edge + (np.arange(cells) + 0.5) / duration
    phase = 2.0 * np.pi * np.random.Generator(np.random.PCG64(seed)).random(cells)
    amplitude = rms * np.sqrt(2.0 / np.sum(frequency**-2.0)) / frequency
    spectrum = np.zeros(steps, dtype=np.complex128)
    spectrum[:cells] = amplitude * np.exp(1j * phase) * steps
    # The inverse transform has the period T; a phase rotation shifts its lines from the multiples of 1 / T.
    index = np.arange(-before, steps + 1)
    record = np.fft.ifft(spectrum)[index % steps] * np.exp(2j * np.pi * frequency[0] / RATE_HZ * index)
    rise = half_cosine(samples=index.size, timestep=1.0 / RATE_HZ, length=min(RISE_S, lead))
    return Signal(
        time=uniform_time(samples=index.size, timestep=1.0 / RATE_HZ),
        displacement={wheel: record.real * rise},
        source=(
            f"road, RMS {rms:g} m, constant velocity PSD {lower_band_edge:g} to {UPPER_BAND_EDGE_HZ:g} Hz, {duration:g}"
            f" s after a lead of {lead:g} s, seed {seed}"
        ),
    )


def velocity_density(rms: float, lower_band_edge: float = ROAD_EDGE_HZ) -> float:
    """Return the one-sided velocity PSD of a road, G_v = (2 pi RMS)^2 / (1/f1 - 1/f2) [(m/s)^2/Hz].

    Args:
        rms: RMS displacement between f1 and f2 [m].
        lower_band_edge: f1 [Hz]; f2 is `UPPER_BAND_EDGE_HZ`.
    """
    return float((2.0 * np.pi * rms) ** 2 / (1.0 / lower_band_edge - 1.0 / UPPER_BAND_EDGE_HZ))
