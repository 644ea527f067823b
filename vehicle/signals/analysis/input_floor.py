"""Where an input says something about the car: its power against its own floor, line by line.

A division by what is left of a band-limited input gives an FRF of anything, with a coherence of one where that rest is
a rounding error or leaked from the excited band. So the power of every line is measured with five Slepian tapers, out
of which nothing leaks farther than six lines, and compared with what rounding and leakage would leave there.

Source: Thomson, Spectrum estimation and harmonic analysis, Proc. IEEE 70 (1982) 1055; Widrow and Kollar, Quantization
Noise, 2008: rounding to a step q adds white noise of variance q^2 / 12.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from vehicle.signals.analysis.record_lines import RecordLines, is_long
from vehicle.signals.analysis.segments import stretches_of_one_length

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

TAPERS, BANDWIDTH, TAPER_SAMPLES = 5, 6.0, 2048
"""Slepian tapers, their time-bandwidth product, and samples that each is computed at; a spline is laid through these.
Source: D. J. Thomson, Spectrum estimation and harmonic analysis, Proc. IEEE 70, 1982."""

ABOVE_FLOOR = 100.0
"""Power over the floor from which an input counts: its noise then changes the FRF by less than 1 %."""

LEAKAGE = 1e-10
"""Leakage of the tapers beyond six lines, of the strongest line [-]."""

ROUNDING = 1e-15
"""Rounding of double precision, of the largest sample [-]."""

OF_STRETCH = 0.03
"""Least power of a line over the mean of its stretch: below it the stretch tells of its other lines only."""

OF_OCTAVES = 1e-4
"""Least power of a line over the strongest an octave around it: below it stands the skirt of that one."""

FEWEST_LINES = 5.0
"""Least effective number of driven lines in a stretch, (sum |U|^2)^2 / sum |U|^4; a sine has one to three."""

FEWEST_BY_CHANCE = 3.5
"""The same for a line between driven ones: of the stretches of a random input half a percent have fewer than five, and
two in ten thousand fewer than this."""

ROUGHNESS, ROUGH_SHARE = 0.25, 0.05
"""Least part of an input, of its power there and of the mean of the stretch, that is not smooth from line to line. The
spectrum of a random input is rough; what is smooth is a transient of the input, or leaked, and cannot be told from the
transient of the car."""

CAUSES = (
    "the input lies below the floor of its own rounding and leakage",
    "the input has less than 3 % of the power of the lines beside them, at the edge of its band",
    "fewer than five lines of the input are driven, as by a sine: they cannot tell an FRF from a transient",
    "the input is 1e-4 and less of what it is within an octave: it leaks from there",
    "the spectrum of the input is smooth, as of a bump: it cannot be told from the car's own transient; drive it with "
    "a random signal",
)


def rounding_step(samples: Real) -> float:
    """Step to which samples were rounded, 0 where there is none: all small differences are multiples of the least."""
    steps = np.diff(np.sort(samples))
    steps = steps[steps > 1e-9 * np.ptp(samples)]
    if not steps.size:
        return 0.0
    ratio = steps / np.percentile(steps, 1)
    low = steps[ratio < 1.5]
    del steps  # of a long record each of these is as long
    ratio = ratio[ratio < 50.0]
    ratio -= np.round(ratio)
    if max(ratio.max(), -ratio.min()) > 0.02:
        return 0.0
    return float(np.median(low))


def tapered_power(samples: Real, rounding: float, lines: int | None = None) -> tuple[Real, float]:
    """Power of every line under five tapers, averaged over three lines, scaled like |rfft|^2; and its floor.

    Args:
        samples: shape (n,).
        rounding: their step, 0 where there is none.
        lines: how many are asked for; all by default. Of a long record no others are looked at where all of them
            together, by Parseval's theorem, are weaker than the strongest of these.
    """
    count, mean = samples.size, samples.mean()
    every = count // 2 + 1
    known = min(lines + 1, every) if lines is not None and is_long(count) else every
    transform, coarse = RecordLines(count, 0, known), np.linspace(0.0, 1.0, TAPER_SAMPLES)
    power, total = np.zeros(known), 0.0
    for taper in scipy.signal.windows.dpss(TAPER_SAMPLES, BANDWIDTH, TAPERS):
        window = partial(_window, scipy.interpolate.CubicSpline(coarse, taper), count)
        tapered = partial(_tapered, samples, mean, window)
        energy = sum(float(np.sum(window(part) ** 2)) for part in transform.parts)
        power += np.abs(transform.of(tapered)) ** 2 * count / energy / TAPERS
        if known < every:
            total += sum(float(np.sum(tapered(part) ** 2)) for part in transform.parts) * count**2 / energy / TAPERS
    if known < every and 0.5 * (total + float(power[0])) - float(np.sum(power)) > float(np.max(power)):
        return tapered_power(samples, rounding)
    power = np.convolve(power, np.full(3, 1.0 / 3.0), mode="same")
    exact = count * (ROUNDING * max(float(samples.max()), -float(samples.min()))) ** 2
    floor = max(count * rounding**2 / 12.0, LEAKAGE * float(np.max(power[TAPERS:])), exact)
    return power[:lines], floor


def _window(spline: Any, count: int, part: slice) -> Real:
    """A part of a taper over a record of `count` samples; the spline goes from 0 to 1."""
    values: Real = spline(np.minimum(np.arange(part.start, part.stop) * (1.0 / (count - 1)), 1.0))
    return values


def _tapered(samples: Real, mean: float, window: Callable[[slice], Real], part: slice) -> Real:
    """A part of a record about its mean, under a taper."""
    return (samples[part] - mean) * window(part)


def silent_lines(
    inputs: Real,
    spectra: Complex,
    centres: NDArray[np.int_],
    halves: NDArray[np.int_],
    rounding: Sequence[float],
) -> NDArray[np.int_]:
    """Why nothing can be said at a line.

    Args:
        inputs: samples, shape (p, n).
        spectra: their transform without mean, shape (p, n // 2 + 1).
        centres: lines of the FRF, shape (m,).
        halves: lines on each side in the stretch around each, shape (m,).
        rounding: step of each input, 0 where unknown.

    Returns:
        0 where every input drives the line, else 1 + the number of the cause, shape (m,).
    """
    # Those of the stretches, and of the octaves around their middles.
    farthest = int(np.max([centres + halves + 1, 2 * centres], initial=0))
    found, chance = np.zeros(centres.size, dtype=np.int_), np.ones(centres.size, dtype=np.bool_)
    for samples, spectrum, step in zip(inputs, spectra, rounding, strict=True):
        power, floor = tapered_power(samples, step or rounding_step(samples), farthest)
        for which, lines in stretches_of_one_length(centres, halves):
            half = lines.shape[1] // 2
            smooth = np.linalg.qr(np.vander(np.arange(-half, half + 1) / half, 4))[0]
            drive, own = spectrum[lines], power[centres[which]]
            energy = np.abs(drive) ** 2
            rough = np.mean(np.abs(drive - (drive @ smooth) @ smooth.T) ** 2, axis=1)
            lone = energy.sum(axis=1) ** 2 / np.sum(energy**2, axis=1)  # effective number of driven lines
            octaves = np.array([power[centre // 2 : 2 * centre].max() for centre in centres[which]])
            tests = np.array(
                [
                    own < ABOVE_FLOOR * floor,
                    own < OF_STRETCH * np.mean(power[lines], axis=1),
                    lone < FEWEST_LINES,
                    own < OF_OCTAVES * octaves,
                    rough < np.maximum(ROUGHNESS * own, ROUGH_SHARE * energy.mean(axis=1)),
                ]
            )
            cause = np.where(tests.any(axis=0), 1 + np.argmax(tests, axis=0), 0)
            found[which] = np.where(found[which], found[which], cause)
            chance[which] &= ~tests[[0, 1, 3, 4]].any(axis=0) & (lone >= FEWEST_BY_CHANCE)
    driven = np.concatenate([[False], found == 0, [False]])
    found[chance & driven[:-2] & driven[2:]] = 0
    return found


def sentences(frequency: Real, silent: NDArray[np.int_], causes: Sequence[str] = CAUSES) -> list[str]:
    """One sentence for each cause, with the stretches of frequencies that have it."""
    found = []
    for number, cause in enumerate(causes, 1):
        there = np.flatnonzero(silent == number)
        if there.size:
            runs = np.split(there, np.flatnonzero(np.diff(there) > 1) + 1)
            spans = [f"{frequency[run[0]]:.2f} to {frequency[run[-1]]:.2f}" for run in runs[:4]]
            more = f" and {len(runs) - 4} more stretches" if len(runs) > 4 else ""
            found.append(f"no FRF at {there.size} frequencies, {', '.join(spans)}{more} Hz: {cause}")
    return found
