"""First estimate of time shift and drift: whitened windows of a record, correlated with a second record."""

from itertools import pairwise

import numpy as np
import scipy

from vehicle.signals.analysis.samples import Vector

RESOLUTION = 2.5e-4
"""Width of the smoothed spectrum over the sampling rate: 0.25 Hz at 1 kHz [-]."""
SMOOTHED = 15
"""Minimum number of averaged spectral lines: the standard deviation of their mean is then a quarter of it."""
LINES = 4097
"""Number of frequencies at which spectra are compared."""
SMALLEST = 1e-4
"""Minimum power over the largest power [-]; lower values are leakage of a record that begins and ends in motion."""
INDEPENDENT = 200.0
"""Independent samples of a window (twice bandwidth times length). Noise then has a correlation of 0.07; a drift of 1e-3
smears a tenth of a period of the highest frequency."""
SECTIONS = 9
"""Maximum number of windows: the window of largest energy in each section of the record."""
PEAKS = 5
"""Number of stored correlation peaks of each window."""
LONGEST = 0.6
"""Maximum length of a window over the length of the shorter record [-]."""
AS_GOOD = 0.98
"""Minimum share of the best score at which a line with a smaller shift is preferred [-]."""


def searched_line(first: Vector, second: Vector, offset: float, largest_drift: float) -> tuple[float, float] | None:
    """Return the straight line of shift over time through most of the correlation peaks.

    Args:
        first: record x, (n,).
        second: record y, (m,).
        offset: index of the first sample of y in x [samples].
        largest_drift: maximum slope of the line [-].

    Returns:
        Delay of y at the middle of x [samples], and its change per sample; None if nothing correlates.
    """
    frequency, share, power = spectral_shares(first, second)
    if not share.any():
        return None
    # Effective number of lines, (sum p)^2 / sum p^2, over half the sampling rate [1/sample].
    bandwidth = 0.5 * float(share.sum() ** 2 / (share @ share)) / frequency.size
    # Divided by the spectrum (whitened), times the share of the signal (Wiener).
    factor = np.sqrt(share / power.clip(SMALLEST))
    whitened, whitened_second = _filtered(first, frequency, factor), _filtered(second, frequency, factor)
    shorter = min(first.size, second.size)
    length = int(min(max(INDEPENDENT / (2.0 * bandwidth), 16.0), LONGEST * shorter))
    peaks = [
        (*peak, number)
        for number, begin in enumerate(_begins(whitened, length))
        for peak in _peaks(whitened, whitened_second, begin, length, offset, 0.25 / bandwidth)
    ]
    return _consensus(np.array(peaks), first.size, max(2.0, 0.25 / bandwidth), largest_drift) if peaks else None


def spectral_shares(first: Vector, second: Vector) -> tuple[Vector, Vector, Vector]:
    """Return the share of the signal in the power at each frequency, (1 - noise / power)^2, as in a Wiener filter.

    The noise is white, three times the lower quartile of the smoothed power, but at most a tenth of the largest power.

    Args:
        first, second: records, (n,) and (m,).

    Returns:
        Frequencies [1/sample], the smaller of both shares [-], and the root of the product of both powers.
    """
    frequency = np.linspace(0.0, 0.5, LINES)
    shares, powers = [], []
    for record in (first, second):
        size = scipy.fft.next_fast_len(record.size, real=True)
        power = np.abs(scipy.fft.rfft(scipy.signal.detrend(record), size)) ** 2
        width = max(SMOOTHED, int(RESOLUTION * size))
        power = scipy.ndimage.uniform_filter1d(power, width, mode="nearest")
        power = np.interp(frequency, np.arange(power.size) / size, power) / power.max()
        noise = float(np.clip(3.0 * np.quantile(power, 0.25), SMALLEST, 0.1))
        shares.append(np.maximum(1.0 - noise / power.clip(SMALLEST), 0.0) ** 2)
        powers.append(power)
    return frequency, np.minimum(*shares), np.sqrt(powers[0] * powers[1])


def _filtered(record: Vector, frequency: Vector, factor: Vector) -> Vector:
    """Return a detrended record (n,), filtered without phase by factors (k,) at frequencies."""
    size = scipy.fft.next_fast_len(record.size, real=True)
    spectrum = scipy.fft.rfft(scipy.signal.detrend(record), size)
    spectrum *= np.interp(np.arange(spectrum.size) / size, frequency, factor)
    return np.asarray(scipy.fft.irfft(spectrum, size)[: record.size])


def _begins(record: Vector, length: int) -> list[int]:
    """Return the first samples of the window of largest energy in each section."""
    # Energy of every window as a difference of cumulated sums.
    total = np.concatenate([[0.0], np.cumsum(record**2)])
    energy = total[length:] - total[:-length]
    number = int(np.clip(round(2.0 * (energy.size - 1) / length) + 1, 2, SECTIONS))
    edges = np.linspace(0, energy.size, number + 1).astype(int)
    return [int(low + np.argmax(energy[low:high])) for low, high in pairwise(edges) if high > low]


def _peaks(
    record: Vector, other: Vector, begin: int, length: int, offset: float, apart: float
) -> list[tuple[float, float, float]]:
    """Return the largest correlations of a window: centre, lag [samples], coefficient times the root of its energy."""
    window = record[begin : begin + length]
    half = length // 2
    padded = np.pad(other, half)
    total = np.concatenate([[0.0], np.cumsum(padded**2)])
    energies = total[length:] - total[:-length]
    window_energy = float(window @ window)
    if window_energy == 0.0:
        return []
    # Correlation with all of the other record: convolution with the reversed window.
    cross = scipy.signal.oaconvolve(padded, window[::-1], mode="valid")
    correlation = cross / np.sqrt(window_energy * np.maximum(energies, 1e-3 * energies.max()))
    # The padding shifts the index of a window by half of its length.
    lags = np.arange(correlation.size) - half - begin + offset
    # Among equal peaks of a periodic record, prefer the smallest lag.
    size = np.abs(correlation) * (1.0 - (1.0 - AS_GOOD) * np.abs(lags) / np.max(np.abs(lags)))
    peaks, gap = [], max(1, int(apart))
    for _ in range(PEAKS):
        index = int(np.argmax(size))
        if size[index] <= 0.0:
            break
        peaks.append(
            (begin + 0.5 * (length - 1), float(lags[index]), float(correlation[index]) * np.sqrt(window_energy))
        )
        size[max(0, index - gap) : index + gap + 1] = 0.0
    return peaks


def _consensus(peaks: Vector, count: int, tolerance: float, steepest: float) -> tuple[float, float] | None:
    """Return the line with the largest sum of squared peaks near it, at most one per window; peaks: see `_peaks`."""
    position, lag, peak, window = peaks.T
    middle = 0.5 * (count - 1)
    first, second = np.triu_indices(lag.size, 1)
    distance = position[second] - position[first]
    first, second, distance = (values[distance != 0.0] for values in (first, second, distance))
    slope = (lag[second] - lag[first]) / distance
    allowed = np.abs(slope) <= steepest
    # Candidates: a level line through each peak, and the line through each pair of peaks of two windows.
    slopes = np.concatenate([np.zeros(lag.size), slope[allowed]])
    through = np.concatenate([np.arange(lag.size), first[allowed]])
    # Height of each line at the middle of the record.
    lines = lag[through] + slopes * (middle - position[through])
    sign = np.sign(peak[through])
    score = np.zeros(lines.size)
    for number in np.unique(window):
        in_window = window == number
        deviation = np.abs(lines[:, None] + slopes[:, None] * (position[in_window] - middle) - lag[in_window])
        # Peaks near the line and of equal sign count; of each window the largest.
        weight = np.maximum(1.0 - (deviation / tolerance) ** 2, 0.0) * (np.sign(peak[in_window]) == sign[:, None])
        score += np.max(weight * peak[in_window] ** 2, axis=1)
    candidates = np.flatnonzero(score >= AS_GOOD * score.max())
    # Of nearly equal lines the line with the smallest shift over the record.
    best = candidates[np.argmin(np.abs(lines[candidates]) + np.abs(slopes[candidates]) * middle)]
    deviation = np.abs(lines[best] + slopes[best] * (position - middle) - lag)
    inliers = (deviation <= tolerance) & (np.sign(peak) == sign[best])
    if np.unique(window[inliers]).size > 2:
        slope, line = np.polyfit(position[inliers] - middle, lag[inliers], 1, w=np.abs(peak[inliers]))
        return float(line), float(np.clip(slope, -steepest, steepest))
    return float(lines[best]), float(slopes[best])
