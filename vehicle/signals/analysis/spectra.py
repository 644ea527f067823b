"""One-sided power spectral densities and the RMS in a band; sum(S df) equals the mean square (Parseval)."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from vehicle.errors import DataError
from vehicle.signals.analysis.record_lines import RecordLines
from vehicle.signals.analysis.samples import (
    Complex,
    Vector,
    band_shares,
    checked_band,
    checked_signals,
    checked_time_step,
    lines_in_band,
)
from vehicle.signals.analysis.segments import cut_into_segments

SEGMENTS_AT_ONCE = 256
"""Segments of a long record transformed in a batch."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PowerSpectralDensity:
    """One-sided density S(f), whose integral over f is the mean square."""

    frequency: Vector
    """frequency lines [Hz], shape (m,)"""
    density: Vector
    """density [unit^2/Hz], shape (k, m)"""
    resolution_hz: float
    """line spacing [Hz]"""
    averages: float
    """effective independent averages [-]"""
    lines: Complex | None = None
    """complex lines of a periodogram [unit], |line|^2 = S df, shape (k, m); None for an averaged density"""


def power_spectral_density(
    time_step: float, signals: ArrayLike, *, window_s: float = 4.0, overlap: float = 0.5, minimum_averages: float = 1.0
) -> PowerSpectralDensity:
    """Estimate one-sided densities by Welch's method: Hann window, mean of each segment removed.

    Args:
        time_step: sampling interval [s].
        signals: records, shape (n,) or (k, n).
        window_s: segment length [s].
        overlap: overlap of successive segments over their length [-].
        minimum_averages: required effective averages [-].

    Raises:
        DataError: record too short or not finite.

    Source: Welch (1967).
    """
    step = checked_time_step(time_step)
    array = checked_signals("signals", signals)
    cut = cut_into_segments(array.shape[1], step, window_s=window_s, overlap=overlap, minimum_averages=minimum_averages)
    power = np.zeros((len(array), cut.length // 2 + 1))
    for first in range(0, cut.count, SEGMENTS_AT_ONCE):
        count = min(SEGMENTS_AT_ONCE, cut.count - first)
        group = array[:, first * cut.step : (first + count - 1) * cut.step + cut.length]
        segments = np.lib.stride_tricks.sliding_window_view(group, cut.length, axis=1)[:, :: cut.step]
        # Not by `scipy.signal`, whose import takes longer than the densities of a run.
        spectra = np.fft.rfft((segments - segments.mean(axis=2, keepdims=True)) * cut.window, axis=2)
        power += np.sum(spectra.real**2 + spectra.imag**2, axis=1)
    # S = c |X|^2 dt/sum(w^2), mean over the segments; c = 2 except at 0 Hz and at Nyquist.
    power[:, 1 : (cut.length + 1) // 2] *= 2.0
    frequency = np.fft.rfftfreq(cut.length, step).astype(np.float64)
    return PowerSpectralDensity(
        frequency=frequency,
        density=power * (step / (cut.count * np.sum(cut.window**2))),
        resolution_hz=float(frequency[1]),
        averages=cut.averages,
    )


def periodogram(time_step: float, signals: ArrayLike) -> PowerSpectralDensity:
    """Return the periodogram of the whole record without a window; the line at 0 Hz contains the mean.

    S_k = c |X_k|^2 dt / n,  c = 2 except at 0 Hz and at Nyquist;  sum(S_k df) = mean(x^2) exactly

    Args:
        time_step: sampling interval [s].
        signals: records, shape (n,) or (k, n).
    """
    step = checked_time_step(time_step)
    return _periodogram(step, checked_signals("signals", signals), slice(None))


def _periodogram(step: float, array: Vector, lines: slice) -> PowerSpectralDensity:
    """Return the selected lines of the periodogram of signals (k, n)."""
    samples = array.shape[1]
    spectra, sides = _spectra(array, len(array), samples, lines)
    density = sides * np.abs(spectra) ** 2 * step / samples
    # |line|^2 = S df = c |X|^2/n^2.
    spectra *= np.sqrt(sides) / samples
    return PowerSpectralDensity(
        frequency=np.fft.rfftfreq(samples, step).astype(np.float64)[lines],
        density=density,
        resolution_hz=1.0 / (samples * step),
        averages=1.0,
        lines=spectra,
    )


def _spectra(rows: Iterable[Vector], count: int, samples: int, lines: slice) -> tuple[Complex, Vector]:
    """Return selected lines of the transforms of records, (count, m), and their sides c, 1 or 2, (m,)."""
    sides = np.full(samples // 2 + 1, 2.0)
    # Lines at 0 Hz and at Nyquist have no mirror image.
    sides[0] = 1.0
    if samples % 2 == 0:
        sides[-1] = 1.0
    transform = RecordLines(samples, *lines.indices(sides.size)[:2])
    sides = sides[lines]
    spectra = np.empty((count, sides.size), dtype=np.complex128)
    for row, of_row in zip(rows, spectra, strict=True):
        of_row[:] = transform.of(row.__getitem__)
    return spectra, sides


def record_lines(rows: Iterable[Vector], count: int, samples: int, lines: slice) -> Complex:
    """Return the lines of `periodogram` of records that are read one after the other, without the densities.

    Args:
        rows: records, (n,) each.
        count: number of records.
        samples: their length n.
        lines: slice of the lines, see `lines_of_band`.
    """
    spectra, sides = _spectra(rows, count, samples, lines)
    spectra *= np.sqrt(sides) / samples
    return spectra


def band_periodogram(time_step: float, signals: ArrayLike, band: tuple[float, float]) -> PowerSpectralDensity:
    """Return the periodogram of the whole record in a band [Hz]; lines at its edges count with their `band_shares`."""
    step = checked_time_step(time_step)
    edges, array = checked_band(band, step), checked_signals("signals", signals)
    inside = lines_of_band(array.shape[1], step, edges)
    # The cells of the next lines may reach into the band.
    spectrum = _periodogram(step, array, slice(max(inside.start - 1, 0), inside.stop + 1))
    shares = band_shares(spectrum.frequency, spectrum.resolution_hz, edges)
    assert spectrum.lines is not None  # a periodogram
    return replace(spectrum, density=shares * spectrum.density, lines=np.sqrt(shares) * spectrum.lines)


def lines_of_band(samples: int, step: float, band: tuple[float, float]) -> slice:
    """Return the lines of a record of n samples in the closed band [Hz]."""
    inside = np.flatnonzero(lines_in_band(np.fft.rfftfreq(samples, step).astype(np.float64), band))
    if not inside.size:
        raise DataError(
            f"record too short: its frequency lines are {1.0 / (samples * step):g} Hz apart, and none "
            f"lies in {band[0]:g} to {band[1]:g} Hz; record at least {1.0 / (band[1] - band[0]):g} s"
        )
    return slice(inside[0], inside[-1] + 1)


def band_rms(time_step: float, signals: ArrayLike, band: tuple[float, float]) -> Vector:
    """Return the RMS of each signal in a band, sqrt(sum_band S_k df) of the periodogram, shape (k,).

    Whole record, no window: a component with an integer number of periods in the record counts fully or not at all, or
    half on an edge of the band. A
    component with another number of periods leaks by about one line (1 / duration), so a record should be long against
    1 / low edge, and a drift of the mean should be far smaller than the vibration.

    Args:
        time_step: sampling interval [s].
        signals: records, shape (n,) or (k, n).
        band: (low, high) [Hz].
    """
    return rms_of(band_periodogram(time_step, signals, band))


def rms_of(spectrum: PowerSpectralDensity) -> Vector:
    """Return the RMS of each signal over the lines of its periodogram, shape (k,)."""
    return np.asarray(np.sqrt(spectrum.density.sum(axis=1) * spectrum.resolution_hz))
