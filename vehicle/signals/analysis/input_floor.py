"""Select the lines at which an input excites the car: power of the input over its noise floor.

Outside the band of an input its spectrum contains only rounding errors and leakage. Dividing by them gives a
meaningless FRF, with a coherence of one. So the power of every line is estimated with five Slepian tapers, which leak
over at most six lines, and compared with the floor of rounding and leakage.

Source: Thomson, Spectrum estimation and harmonic analysis, Proc. IEEE 70 (1982) 1055; Widrow and Kollar, Quantization
Noise, 2008: rounding to a step q adds white noise of variance q^2 / 12.
"""

from collections.abc import Callable, Sequence
from functools import cache, lru_cache

import numpy as np
import scipy
from numpy.typing import NDArray

from vehicle.signals.analysis.record_lines import RecordLines, is_long
from vehicle.signals.analysis.samples import Complex, Vector
from vehicle.signals.analysis.segments import windows_of_equal_length
from vehicle.signals.analysis.spline import CubicSpline

TAPERS, BANDWIDTH, TAPER_SAMPLES = 5, 6.0, 2048
"""Number of Slepian tapers, time-bandwidth product, and samples of each, which a spline interpolates.
Source: D. J. Thomson, Spectrum estimation and harmonic analysis, Proc. IEEE 70, 1982."""

ABOVE_FLOOR = 100.0
"""Minimum power of an input over the floor: its noise then changes the FRF by less than 1 %."""

LEAKAGE = 1e-10
"""Leakage of the tapers beyond six lines over the strongest line [-]."""

ROUNDING = 1e-15
"""Rounding of double precision over the largest sample [-]."""

OF_STRETCH = 0.03
"""Minimum power of a line over the mean of its window: below it, the window describes only the other lines."""

OF_OCTAVES = 1e-4
"""Minimum power of a line over the strongest line within an octave: below it, the power is leakage of that line."""

FEWEST_LINES = 5.0
"""Minimum effective number of driven lines in a window, (sum |U|^2)^2 / sum |U|^4; a sine has one to three."""

FEWEST_BY_CHANCE = 3.5
"""Minimum effective number for a line between driven lines: among the windows of a random input, 0.5 % have fewer than
five and 0.02 % fewer than 3.5."""

ROUGHNESS, ROUGH_SHARE = 0.25, 0.05
"""Minimum power of the part of an input that is not smooth over frequency, relative to the power of the line and to the
mean of the window. The spectrum of a random input is rough. A smooth spectrum is a transient or leakage of the input
and cannot be separated from the transient of the car."""

CAUSES = (
    "the input is weaker than its rounding errors and leakage",
    "the input has less than 3 % of the power of the lines beside it",
    "the input has fewer than five lines, like a sine, so FRF and transient cannot be separated",
    "the input has at most 1e-4 of the power within an octave, which is leakage",
    "the input is a single event, for example a bump, so FRF and transient cannot be separated",
)
"""Causes of an undefined FRF at a line, for messages."""

TRANSIENT = (CAUSES[2], CAUSES[4])
"""Causes of an input that is no random signal."""

MOST = 0.9
"""Minimum share of lines without FRF above a frequency, for messages that name this frequency alone."""

MOST_RANGES = 4
"""Maximum number of frequency ranges in a message; more are given by their span."""

FEW = 0.05
"""Maximum share of lines without FRF below which the input is good, for messages: a random input may miss single lines.
"""


def rounding_step(samples: Vector) -> float:
    """Return the rounding step of samples (n,), of which all small differences are multiples; 0 without a step."""
    steps = np.diff(np.sort(samples))
    steps = steps[steps > 1e-9 * np.ptp(samples)]
    if not steps.size:
        return 0.0
    # If samples are rounded, all differences are whole multiples of the smallest; large multiples are left out,
    # because an error of the step adds up there.
    ratio = steps / np.percentile(steps, 1)
    smallest = steps[ratio < 1.5]
    del steps  # free memory: as long as the record
    ratio = ratio[ratio < 50.0]
    ratio -= np.round(ratio)
    if max(ratio.max(), -ratio.min()) > 0.02:
        return 0.0
    return float(np.median(smallest))


def tapered_power(samples: Vector, rounding: float, lines: int | None = None) -> tuple[Vector, float]:
    """Return the power of the lines with five tapers, averaged over three lines, scaled like |rfft|^2, and the floor.

    Args:
        samples: record, shape (n,).
        rounding: rounding step of the samples, 0 if there is none.
        lines: number of returned lines; all by default. For a long record the other lines are not computed if their
            total power, by Parseval's theorem, is below the strongest returned line.
    """
    count, mean = samples.size, samples.mean()
    all_lines = count // 2 + 1
    # One line more, for the average over three lines.
    computed = min(lines + 1, all_lines) if lines is not None and is_long(count) else all_lines
    transform = RecordLines(count, 0, computed)
    power, total = np.zeros(computed), 0.0
    for number in range(TAPERS):

        def window(part: slice, number: int = number) -> Vector:
            return _window(number, count, part.start, part.stop)

        def tapered(part: slice, window: Callable[[slice], Vector] = window) -> Vector:
            return np.asarray((samples[part] - mean) * window(part))

        energy = sum(float(np.sum(window(part) ** 2)) for part in transform.parts)
        # Scaled like a rectangular window, whose energy is `count`.
        power += np.abs(transform.of(tapered)) ** 2 * count / energy / TAPERS
        if computed < all_lines:
            total += sum(float(np.sum(tapered(part) ** 2)) for part in transform.parts) * count**2 / energy / TAPERS
    # Parseval: `total` is the sum of |X_k|^2 over all lines of both signs, so that (total + |X_0|^2)/2 is that of one
    # side.
    if computed < all_lines and 0.5 * (total + float(power[0])) - float(np.sum(power)) > float(np.max(power)):
        return tapered_power(samples, rounding)
    power = np.convolve(power, np.full(3, 1.0 / 3.0), mode="same")
    exact = count * (ROUNDING * max(float(samples.max()), -float(samples.min()))) ** 2
    # White noise of variance q^2/12 has the power n q^2/12 on each line of |rfft|^2.
    floor = max(count * rounding**2 / 12.0, LEAKAGE * float(np.max(power[TAPERS:])), exact)
    return power[:lines], floor


@cache
def _taper_splines() -> list[CubicSpline]:
    """Return a cubic spline through each Slepian taper, from 0 to 1."""
    return [CubicSpline(np.linspace(0.0, 1.0, TAPER_SAMPLES), taper) for taper in slepian_tapers()]


def slepian_tapers() -> Vector:
    """Return the tapers with unit energy, the most concentrated one first, with any sign; (TAPERS, TAPER_SAMPLES).

    Source: Percival and Walden, Spectral Analysis for Physical Applications, 1993, equation 386a: eigenvectors of a
    tridiagonal matrix with the largest eigenvalues.
    """
    count, index = TAPER_SAMPLES, np.arange(TAPER_SAMPLES)
    diagonal = (0.5 * (count - 1 - 2 * index)) ** 2 * np.cos(2.0 * np.pi * BANDWIDTH / count)
    beside = 0.5 * index[1:] * (count - index[1:])
    chosen = (count - TAPERS, count - 1)
    vectors = scipy.linalg.eigh_tridiagonal(diagonal, beside, select="i", select_range=chosen)[1]
    return np.ascontiguousarray(vectors[:, ::-1].T)


@lru_cache(maxsize=1)
def _window(number: int, count: int, start: int, stop: int) -> Vector:
    """Return samples of a taper over `count` samples; the last part is stored, as energy and spectrum each need it."""
    values: Vector = _taper_splines()[number](np.minimum(np.arange(start, stop) * (1.0 / (count - 1)), 1.0))
    return values


@lru_cache(maxsize=64)
def _cubic_basis(half: int) -> Vector:
    """Return an orthonormal basis of the cubic polynomials over 2 n + 1 lines, shape (2 n + 1, 4)."""
    basis: Vector = np.linalg.qr(np.vander(np.arange(-half, half + 1) / half, 4))[0]
    return basis


def silent_lines(
    inputs: Vector, spectra: Complex, centres: NDArray[np.int_], halves: NDArray[np.int_], rounding: Sequence[float]
) -> NDArray[np.int_]:
    """Return the cause of an undefined FRF at each line.

    Args:
        inputs: samples, shape (p, n).
        spectra: transforms of the inputs without mean, shape (p, n // 2 + 1).
        centres: lines of the FRF, shape (m,).
        halves: half widths of the windows around these lines [lines], shape (m,).
        rounding: rounding step of each input, 0 if unknown.

    Returns:
        0 where every input drives the line, else 1 + the index in `CAUSES`, shape (m,).
    """
    # Last line in the windows, and in the octaves around their centres.
    farthest = int(np.max([centres + halves + 1, 2 * centres], initial=0))
    causes, chance = np.zeros(centres.size, dtype=np.int_), np.ones(centres.size, dtype=np.bool_)
    for samples, spectrum, step in zip(inputs, spectra, rounding, strict=True):
        power, floor = tapered_power(samples, step or rounding_step(samples), farthest)
        for selected, lines in windows_of_equal_length(centres, halves):
            half = lines.shape[1] // 2
            smooth = _cubic_basis(half)
            drive, line_power = spectrum[lines], power[centres[selected]]
            energy = np.abs(drive) ** 2
            # Power that remains after a fit by cubic polynomials over the window.
            roughness = np.mean(np.abs(drive - (drive @ smooth) @ smooth.T) ** 2, axis=1)
            effective_lines = energy.sum(axis=1) ** 2 / np.sum(energy**2, axis=1)  # effective number of driven lines
            octaves = np.array([power[centre // 2 : 2 * centre].max() for centre in centres[selected]])
            tests = np.array(
                [
                    line_power < ABOVE_FLOOR * floor,
                    line_power < OF_STRETCH * np.mean(power[lines], axis=1),
                    effective_lines < FEWEST_LINES,
                    line_power < OF_OCTAVES * octaves,
                    roughness < np.maximum(ROUGHNESS * line_power, ROUGH_SHARE * energy.mean(axis=1)),
                ]
            )
            cause = np.where(tests.any(axis=0), 1 + np.argmax(tests, axis=0), 0)
            causes[selected] = np.where(causes[selected], causes[selected], cause)
            chance[selected] &= ~tests[[0, 1, 3, 4]].any(axis=0) & (effective_lines >= FEWEST_BY_CHANCE)
    # A line with drive on both sides that fails by the number of its lines alone counts as driven: chance of a random
    # input.
    driven = np.concatenate([[False], causes == 0, [False]])
    causes[chance & driven[:-2] & driven[2:]] = 0
    return causes


def cause_messages(frequency: Vector, silent: NDArray[np.int_], causes: Sequence[str] = CAUSES) -> list[str]:
    """Return a message for each remedy: ranges and number of lines without FRF, and their most frequent cause."""
    groups: dict[str, list[int]] = {}
    for number, cause in enumerate(causes, 1):
        remedy = "drive the car with a random signal" if cause in TRANSIENT else "give the input more power there"
        groups.setdefault(remedy if cause in CAUSES else cause, []).append(number)
    messages = []
    for remedy, numbers in groups.items():
        affected = np.flatnonzero(np.isin(silent, numbers))
        if affected.size:
            upper = affected[-1] == frequency.size - 1 and affected.size >= MOST * (frequency.size - affected[0])
            # Consecutive lines form a range.
            ranges = np.split(affected, np.flatnonzero(np.diff(affected) > 1) + 1)
            ends = [[f"{frequency[line]:.3g}" for line in part[[0, -1]]] for part in ranges]
            if upper:
                span = f"above {ends[0][0]}"
            elif len(ranges) > MOST_RANGES:
                span = f"between {ends[0][0]} and {ends[-1][1]}"
            else:
                span = "at " + ", ".join(low if low == high else f"{low} to {high}" for low, high in ends)
            counts = {number: np.count_nonzero(silent == number) for number in numbers}
            cause = causes[max(numbers, key=lambda number: counts[number]) - 1]
            mostly = "mostly, " if max(counts.values()) < affected.size else ""
            advice = "the other lines are good" if affected.size <= FEW * frequency.size else remedy
            more = "" if advice == cause else f"; {advice}"
            messages.append(f"no FRF {span} Hz ({affected.size} of {frequency.size} lines): {mostly}{cause}{more}")
    return messages
