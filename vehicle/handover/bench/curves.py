"""Curves of the plots of the bench: the present car B over the reference A on the same axes."""

import numpy as np
from scipy.special import stdtrit

from vehicle.handover.bench.numbers import BenchNumbers
from vehicle.signals.analysis.phase_averages import PHASES
from vehicle.signals.analysis.samples import Vector

CLASSES = 120
"""Classes of the damper velocity in the plot of its force."""

BAND = float(stdtrit(2 * (PHASES - 1), 0.975))
"""Half width of the 95 % band of an FRF in standard errors: 2.45, as these come from four complex values alone. With
the 1.96 of a known error the band would contain 90 %."""


def frf_curves(present: BenchNumbers, reference: BenchNumbers) -> tuple[Vector, ...]:
    """Return frequency [Hz], |H| of B, lower and upper end of its 95 % band, and |H| of A [m/s2 per m]; seat rail."""
    frf, other = present.frf, reference.frf
    size, error = np.abs(frf.response[0]), BAND * frf.random_error[0]
    # The axis is logarithmic: a band that reaches zero ends far below it.
    # On a road, another wheelbase may have other lines.
    before = np.interp(frf.frequency, other.frequency, np.abs(other.response[0]))
    return frf.frequency, size, np.maximum(size - error, 1e-3 * size), size + error, before


def density_curves(present: BenchNumbers, reference: BenchNumbers) -> tuple[Vector, ...]:
    """Return frequency [Hz] and density of the vertical seat rail, B and A [(cm/s2)^2/Hz]; small powers of ten."""
    frequency, other = present.spectra[0].frequency, reference.spectra[0]
    # Another rate of the samples has other lines.
    before = np.interp(frequency, other.frequency, other.density)
    return frequency, 1e4 * present.spectra[0].density, 1e4 * before


def damper_curves(present: BenchNumbers, reference: BenchNumbers, wheel: str) -> tuple[Vector, ...]:
    """Return velocity [m/s], and the force range [N] in each class of it, of B and of A; NaN in an empty class."""
    both = present, reference
    highest = max(float(np.abs(values.damper_velocity[wheel]).max()) for values in both)
    edges = np.linspace(-1.0, 1.0, CLASSES + 1) * max(highest, 1e-6) * (1.0 + 1e-9)
    curves = [0.5 * (edges[1:] + edges[:-1])]
    for values in both:
        index = np.clip(np.searchsorted(edges, values.damper_velocity[wheel]) - 1, 0, CLASSES - 1)
        low, high = np.full(CLASSES, np.inf), np.full(CLASSES, -np.inf)
        np.minimum.at(low, index, values.damper_force[wheel])
        np.maximum.at(high, index, values.damper_force[wheel])
        curves += [np.where(np.isfinite(low), low, np.nan), np.where(np.isfinite(high), high, np.nan)]
    return tuple(curves)
