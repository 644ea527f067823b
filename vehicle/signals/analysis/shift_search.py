"""First estimate of time shift and drift between two records: whitened windows of one, searched in all of the other."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import numpy.typing as npt
import scipy

Vector = npt.NDArray[np.float64]

RESOLUTION = 2.5e-4
"""Width of the smoothed spectrum over the sampling rate: 0.25 Hz at 1 kHz [-]."""
SMOOTHED = 15
"""Spectral lines that are averaged, at least: their mean then scatters by a quarter."""
LINES = 4097
"""Frequencies at which spectra are compared."""
SMALLEST = 1e-4
"""Power over the largest one that counts as none: the leakage of a record that begins and ends in motion [-]."""
INDEPENDENT = 200.0
"""Independent samples of a window (twice bandwidth times length). Noise then correlates with 0.07; a drift of 1e-3
smears a tenth of a period of the highest frequency."""
SECTIONS = 9
"""Windows at most: the most energetic one of each section of the record."""
PEAKS = 5
"""Correlation peaks kept for each window."""
LONGEST = 0.6
"""Length of a window over that of the shorter record, at most [-]."""
AS_GOOD = 0.98
"""Share of the best score from which on a line with a smaller shift is preferred [-]."""


def searched_line(first: Vector, second: Vector, offset: float, largest_drift: float) -> tuple[float, float] | None:
    """Return the straight line through most of the correlation peaks.

    Args:
        first: record x, (n,).
        second: record y, (m,).
        offset: index of the first sample of y in x [samples].
        largest_drift: steepest line [-].

    Returns:
        Samples by which y is late at the middle of x, and their change a sample; None where nothing correlates.
    """
    frequency, share, power = spectral_shares(first, second)
    if not share.any():
        return None
    bandwidth = 0.5 * float(share.sum() ** 2 / (share @ share)) / frequency.size
    factor = np.sqrt(share / power.clip(SMALLEST))
    white, other = _filtered(first, frequency, factor), _filtered(second, frequency, factor)
    shorter = min(first.size, second.size)
    length = int(min(max(INDEPENDENT / (2.0 * bandwidth), 16.0), LONGEST * shorter))
    peaks = [
        (*peak, number)
        for number, begin in enumerate(_begins(white, length))
        for peak in _peaks(white, other, begin, length, offset, 0.25 / bandwidth)
    ]
    return _consensus(np.array(peaks), first.size, max(2.0, 0.25 / bandwidth), largest_drift) if peaks else None


def spectral_shares(first: Vector, second: Vector) -> tuple[Vector, Vector, Vector]:
    """Return the share of the motion in the power at each frequency, (1 - noise / power)^2, as in a Wiener filter.

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
    """Return a record (n,) without its straight line through a filter without phase: factors (k,) at frequencies."""
    size = scipy.fft.next_fast_len(record.size, real=True)
    spectrum = scipy.fft.rfft(scipy.signal.detrend(record), size)
    spectrum *= np.interp(np.arange(spectrum.size) / size, frequency, factor)
    return np.asarray(scipy.fft.irfft(spectrum, size)[: record.size])


def _begins(record: Vector, length: int) -> list[int]:
    """First samples of the most energetic window of each section."""
    total = np.concatenate([[0.0], np.cumsum(record**2)])
    energy = total[length:] - total[:-length]
    number = int(np.clip(round(2.0 * (energy.size - 1) / length) + 1, 2, SECTIONS))
    edges = np.linspace(0, energy.size, number + 1).astype(int)
    return [int(low + np.argmax(energy[low:high])) for low, high in pairwise(edges) if high > low]


def _peaks(
    record: Vector, other: Vector, begin: int, length: int, offset: float, apart: float
) -> list[tuple[float, float, float]]:
    """Largest correlations of a window: its middle, the lag [samples], the coefficient times the root of its energy."""
    window = record[begin : begin + length]
    half = length // 2
    padded = np.pad(other, half)
    total = np.concatenate([[0.0], np.cumsum(padded**2)])
    energy = total[length:] - total[:-length]
    own = float(window @ window)
    if own == 0.0:
        return []
    cross = scipy.signal.oaconvolve(padded, window[::-1], mode="valid")
    correlation = cross / np.sqrt(own * np.maximum(energy, 1e-3 * energy.max()))
    lags = np.arange(correlation.size) - half - begin + offset
    # Of equal peaks of a periodic record those with the smallest lag.
    size = np.abs(correlation) * (1.0 - (1.0 - AS_GOOD) * np.abs(lags) / np.max(np.abs(lags)))
    found, blank = [], max(1, int(apart))
    for _ in range(PEAKS):
        at = int(np.argmax(size))
        if size[at] <= 0.0:
            break
        found.append((begin + 0.5 * (length - 1), float(lags[at]), float(correlation[at]) * np.sqrt(own)))
        size[max(0, at - blank) : at + blank + 1] = 0.0
    return found


def _consensus(peaks: Vector, count: int, near: float, steepest: float) -> tuple[float, float] | None:
    """Line with the largest sum of squared peaks near it, one of each window; rows: place, lag, peak, window."""
    place, lag, peak, window = peaks.T
    middle = 0.5 * (count - 1)
    one, two = np.triu_indices(lag.size, 1)
    apart = place[two] - place[one]
    one, two, apart = (values[apart != 0.0] for values in (one, two, apart))
    slope = (lag[two] - lag[one]) / apart
    # Below half a sample for each window length a slope is not told from none.
    gentle = np.abs(slope) <= steepest
    slopes = np.concatenate([np.zeros(lag.size), slope[gentle]])
    through = np.concatenate([np.arange(lag.size), one[gentle]])
    lines = lag[through] + slopes * (middle - place[through])
    sign = np.sign(peak[through])
    score = np.zeros(lines.size)
    for number in np.unique(window):
        own = window == number
        away = np.abs(lines[:, None] + slopes[:, None] * (place[own] - middle) - lag[own])
        worth = np.maximum(1.0 - (away / near) ** 2, 0.0) * (np.sign(peak[own]) == sign[:, None])
        score += np.max(worth * peak[own] ** 2, axis=1)
    good = np.flatnonzero(score >= AS_GOOD * score.max())
    best = good[np.argmin(np.abs(lines[good]) + np.abs(slopes[good]) * middle)]
    away = np.abs(lines[best] + slopes[best] * (place - middle) - lag)
    fits = (away <= near) & (np.sign(peak) == sign[best])
    if np.unique(window[fits]).size > 2:
        slope, line = np.polyfit(place[fits] - middle, lag[fits], 1, w=np.abs(peak[fits]))
        return float(line), float(np.clip(slope, -steepest, steepest))
    return float(lines[best]), float(slopes[best])
