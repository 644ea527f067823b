"""Generate random plate displacements with constant velocity PSD: the standard road of Bommer 2006."""

from typing import Literal

import numpy as np

from vehicle.arrays import Complex
from vehicle.errors import ConfigurationError
from vehicle.signals.excitation.band import (
    LOWER_BAND_EDGE_HZ,
    LOWEST_FREQUENCY_HZ,
    UPPER_BAND_EDGE_HZ,
    lines_in_band,
    period_of,
    positive,
    samples_of,
)
from vehicle.signals.excitation.rest import RAMP_S, taper
from vehicle.signals.excitation.signal import Signal, uniform_time


def random_road(
    *,
    rms: float,
    seed: int,
    wheel: str,
    duration: float = 60.0,
    rate: float = 1000.0,
    lower_band_edge: float = LOWER_BAND_EDGE_HZ,
    upper_band_edge: float = UPPER_BAND_EDGE_HZ,
    roll_off_order: int = 0,
    taper_length: float = RAMP_S,
    level: Literal["record", "lines"] = "record",
) -> Signal:
    """Generate a band-limited Gaussian displacement with a PSD proportional to 1/f^2 between two band edges.

    G_z(f) = G_v / (2 pi f)^2, G_v constant, from the lower to the upper edge; z = sum of A_k cos(2 pi k t / T +
    phi_k) over the lines k / T in the band, A_k = R_k / k with Rayleigh R_k and uniform phases: a sample of a
    Gaussian process, unlike random phases alone, whose estimated PSD would have no scatter. Periodic over the record
    before the taper. With the taper (half cosine at both ends) it begins and ends at rest; then the mean is removed in
    proportion to the taper, and the record scaled, so that mean 0 and RMS are exact.

    This is `level="record"`: the scale factor depends on the random amplitudes of all lines, mainly the lowest ones.
    `level="lines"` gives each line exactly the power of the density, A_k^2 / 2 = G_z(k / T) / T with G_v for the RMS of
    all lines, and a random phase: the level of each frequency band is exact, its estimate has no scatter, and the RMS
    is exact before the taper, which reduces it (by 0.5 % with 0.5 s at both ends of 60 s).

    R_k and phase of a line do not depend on the band edges: a seed determines the road, filtered by the band.

    Args:
        rms: root mean square of the displacement [m], over the record or before the taper, see `level`.
        seed: seed of the PCG64 generator; only its uniform numbers are used, the most stable part of NumPy.
        wheel: wheel whose plate moves, such as `car.vehicle.shaker_wheel`.
        duration: length T [s].
        rate: samples per second [Hz].
        lower_band_edge: lowest frequency [Hz].
        upper_band_edge: highest frequency [Hz], at most 0.8 of the Nyquist frequency.
        roll_off_order: 0 for a sharp lower edge; n > 0 for the power 1 / (1 + (edge/f)^2n) of a Butterworth edge,
            with lines down to 1 Hz.
        taper_length: length of the half cosine at each end [s]; 0 keeps the record periodic, not at rest.
        level: exact quantity: "record" for the RMS of the record, "lines" for the power of each line.

    Returns:
        Signal with duration * rate + 1 samples, from 0 to `duration`.

    Raises:
        ConfigurationError: a parameter is out of range.

    Source: thesis sections 2.3.1 and 3.2 (constant velocity PSD); synthesis as Shinozuka and Deodatis, Appl. Mech. Rev.
    44 (1991), with Rayleigh amplitudes ("record") or as there, with those of the density ("lines").
    """
    positive("RMS", rms, "m")
    steps = samples_of(duration, rate)
    if not 0.0 <= taper_length <= 0.5 * duration:
        raise ConfigurationError(f"taper {taper_length!r} s; allowed: 0 to half of the record, {0.5 * duration:g} s")
    if roll_off_order < 0:
        raise ConfigurationError(f"roll-off order {roll_off_order!r}; allowed: 0 for a sharp edge, or above")
    lowest = min(LOWEST_FREQUENCY_HZ, lower_band_edge) if roll_off_order else lower_band_edge
    lines = lines_in_band(steps=steps, rate=rate, lower=lowest, upper=upper_band_edge)
    if level not in ("record", "lines"):
        raise ConfigurationError(f"level {level!r}; allowed: record, lines")
    amplitudes = _gaussian(seed, int(lines[-1]))[lines - 1]
    if level == "lines":
        amplitudes = np.exp(1j * np.angle(amplitudes))
    amplitudes = amplitudes / lines
    if roll_off_order:
        edge_ratio = lower_band_edge * steps / rate / lines
        amplitudes = amplitudes / np.sqrt(1.0 + edge_ratio ** (2 * roll_off_order))
    if level == "lines":
        amplitudes = amplitudes * (rms / np.sqrt(0.5 * np.sum(np.abs(amplitudes) ** 2)))
    period = period_of(amplitudes, lines, steps)
    z = np.append(period, period[0])
    weights = taper(samples=z.size, timestep=1.0 / rate, length=taper_length)
    z = weights * (z - np.sum(weights * z) / np.sum(weights))
    if level == "record":
        z = z * (rms / np.std(z))
    z = z + 0.0
    return Signal(
        time=uniform_time(samples=z.size, timestep=1.0 / rate),
        displacement={wheel: z},
        source=(
            f"random road, RMS {rms:g} m "
            f"({'of the record, exact' if level == 'record' else 'before the taper, each line exactly at its level'}), "
            f"constant velocity PSD {lower_band_edge:g} to {upper_band_edge:g} Hz, "
            f"(lower edge {f'of order {roll_off_order}' if roll_off_order else 'sharp'}), "
            f"{duration:g} s at {rate:g} Hz, "
            f"seed {seed}, half-cosine taper {taper_length:g} s"
        ),
    )


def _gaussian(seed: int, count: int) -> Complex:
    """Return complex Gaussian numbers R exp(j phi), (count,), by Box and Muller: R^2 = -2 ln(1 - u), phi = 2 pi v."""
    uniform = np.random.Generator(np.random.PCG64(seed)).random((count, 2))
    values: Complex = np.sqrt(-2.0 * np.log1p(-uniform[:, 0])) * np.exp(2j * np.pi * uniform[:, 1])
    return values
