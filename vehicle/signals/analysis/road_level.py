"""Level of a road after ISO 8608: the density of its height over the wavenumber, and the class of a straight fit.

G(n) = v S(f),  n = f / v;    fitted: G(n) = G(n0) (n / n0)^-2,  n0 = 0.1 cycles/m
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vehicle.errors import DataError
from vehicle.signals.analysis.cumulative_spectrum import CumulativeSpectrum
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.analysis.spectra import power_spectral_density

CLASSES = {letter: 16e-6 * 4.0**number for number, letter in enumerate("ABCDEFGH")}
"""G(n0) [m3] of each class, the geometric mean of its range. Source: ISO 8608, table of road classes."""

REFERENCE = 0.1
"""Reference wavenumber n0 of the level of a class [cycles/m] (ISO 8608)."""

FITTED = (0.011, 2.83)
"""Range of the fit [cycles/m] (ISO 8608, clause 5: the general range of the road classes)."""

LEAST_BANDS = 6
"""Minimum number of third octaves of a fit: two octaves."""

CLASS_WIDTH = 2.0
"""Upper limit of G(n0) of a class over its geometric mean (ISO 8608: the limits of two classes differ by 4)."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RoadLevel:
    """Density and class of a road.

    Attributes:
        wavenumber: n [cycles/m]; (m,).
        density: G [m3]; (m,).
        reference_density: G(n0) of the fit [m3].
        letter: class with this G(n0), "A" to "H".
        fitted: range of the third octaves of the fit [cycles/m].
    """

    wavenumber: Vector
    density: Vector
    reference_density: float
    letter: str
    fitted: tuple[float, float]


def road_level(time_step: float, height: ArrayLike, speed: float, *, window_s: float = 8.0) -> RoadLevel:
    """Return the level of a road from its height under a wheel at constant speed.

    The fit has the slope -2 in logarithmic scales and passes through the mean logarithm of n^2 G(n) over the third
    octaves inside `FITTED`, each with its mean density, so that every octave has the same weight.

    Args:
        time_step: sampling interval [s].
        height: height of the road under the wheel [m], shape (n,).
        speed: speed of the wheel [m/s].
        window_s: length of the Hann windows of the density [s].

    Raises:
        DataError: the record is too short for a fit, or the wheel stands.

    Source: ISO 8608:2016.
    """
    record = np.asarray(height, dtype=np.float64)
    if not speed > 0.0:
        raise DataError(f"speed: found {speed:g} m/s, must be above 0 for a road spectrum against wavenumber")
    spectrum = power_spectral_density(time_step, record, window_s=min(window_s, record.size * time_step / 2.0))
    nyquist = 0.4 / time_step
    bands = CumulativeSpectrum(time_step, record).third_octaves(
        1.25 * FITTED[0] * speed, min(FITTED[1] * speed / 1.25, nyquist)
    )
    usable = np.isfinite(bands.rms) & (bands.rms > 0.0)
    if np.count_nonzero(usable) < LEAST_BANDS:
        raise DataError(
            f"road: {np.count_nonzero(usable)} third octaves between {FITTED[0]:g} and {FITTED[1]:g} cycles/m, must be "
            f"at least {LEAST_BANDS} for a road class; record a longer road"
        )
    low, high = bands.edges[:-1][usable] / speed, bands.edges[1:][usable] / speed
    # Mean square over the width of the band in cycles/m.
    density = bands.rms[usable] ** 2 / (high - low)
    # The mean of (n / n0)^-2 over a band is n0^2 / (low high).
    reference = float(np.exp(np.mean(np.log(density * low * high / REFERENCE**2))))
    inside = spectrum.frequency > 0.0
    return RoadLevel(
        wavenumber=spectrum.frequency[inside] / speed,
        # G(n) = v S(f), because dn = df/v.
        density=spectrum.density[0, inside] * speed,
        reference_density=reference,
        letter=class_of(reference),
        fitted=(float(low[0]), float(high[-1])),
    )


def class_of(reference_density: float) -> str:
    """Return the class of ISO 8608 with a density G(n0) [m3]; A has no lower limit, H no upper one."""
    return next((name for name, mean in CLASSES.items() if reference_density <= mean * CLASS_WIDTH), "H")
