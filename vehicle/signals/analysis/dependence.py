"""Detect inputs that are copies of other inputs: equal, scaled, inverted, delayed or filtered."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
import scipy

from vehicle.errors import DataError
from vehicle.signals.analysis.record_lines import RecordLines, is_long
from vehicle.signals.analysis.samples import Complex, Vector

DEPENDENT = 0.98
"""Minimum coherence of two time-aligned inputs that count as copies: separated responses would have more than seven
times the error of a single input."""

ALIKE = 0.02
"""Maximum difference of the factor from 1 for which two inputs count as equal."""

DRIVEN = 1e-6
"""Minimum power of a line over the strongest line; weaker lines are ignored in the comparison."""

SIDE_LINES = 8
"""Lines on each side over which the coherence is averaged."""


class DependentInputsError(DataError):
    """Two inputs are copies of each other, so their responses cannot be separated.

    Attributes:
        delay: delay of the second input against the first [s].
        factor: ratio of the second input to the first; NaN if they are related by a filter.
    """

    def __init__(self, message: str, delay: float, factor: float) -> None:
        super().__init__(message)
        self.delay = delay
        self.factor = factor


@dataclass(frozen=True, kw_only=True, slots=True)
class Copy:
    """Relation of a second input to a first: coherence, delay and factor."""

    coherence: float
    """coherence of the time-aligned inputs [-]"""
    delay: float
    """delay of the second input against the first [s]"""
    factor: float
    """ratio of the second input to the first [-]; NaN if they are related by a filter"""


def copy_of(time_step: float, first: Vector, second: Vector, band: tuple[float, float]) -> Copy:
    """Estimate delay, factor and coherence of a second input against a first.

    The delay is the maximum of the correlation of the whitened signals. Both signals are then cut to their common time
    and windowed. The coherence is averaged over 17 lines; the result is its median over the driven lines of the band.

    Args:
        time_step: sampling interval [s].
        first: samples of the first input, shape (n,).
        second: samples of the second input, shape (n,).
        band: evaluated frequencies (low, high) [Hz].

    Source: Knapp and Carter, IEEE Trans. ASSP 24 (1976) 320 (phase transform).
    """
    count = first.size
    length = int(scipy.fft.next_fast_len(2 * count, real=True))  # a prime factor of the count takes much memory
    line = 1.0 / (length * time_step)
    window = slice(int(band[0] / line), int(band[1] / line) + 1)
    # Copies of the lines of the band, so that the others are freed.
    x, y = (np.fft.rfft(signal - signal.mean(), length)[window].copy() for signal in (first, second))
    cross = np.zeros(window.stop, dtype=np.complex128)
    size = np.abs(x * y)
    driven = size > DRIVEN * size.max()
    # Phase transform: every driven line has the weight 1, so that the correlation is a sharp peak at the delay.
    cross[window][driven] = (y * x.conj())[driven] / size[driven]
    shift = int(np.argmax(np.abs(np.fft.irfft(cross, length))))
    # The second half of a circular correlation contains the negative delays.
    shift -= length if shift > length // 2 else 0
    shift = shift if abs(shift) < count // 2 else 0
    early, late = (first[: count - shift], second[shift:]) if shift >= 0 else (first[-shift:], second[:shift])
    taper = np.hanning(early.size)
    x, y = (_spectrum((signal - signal.mean()) * taper) for signal in (early, late))
    line = 1.0 / (early.size * time_step)
    mean = np.ones(2 * SIDE_LINES + 1)
    # Sums over 17 lines: without averaging the coherence would be 1.
    s11, s22, s12 = (np.convolve(p, mean, mode="same") for p in (abs(x) ** 2, abs(y) ** 2, x.conj() * y))
    inside = np.zeros(s11.size, dtype=bool)
    inside[int(band[0] / line) : int(band[1] / line) + 1] = True
    for power in (s11, s22):
        inside &= power > DRIVEN * power[inside].max()
    coherence = np.abs(s12[inside]) ** 2 / (s11[inside] * s22[inside])
    first_power, second_power, cross_power = (np.sum(s[inside].real) for s in (s11, s22, s12))
    # Least-squares factor Re S12/S11, if a real factor explains the power.
    factor = cross_power / first_power if cross_power**2 > DEPENDENT * first_power * second_power else np.nan
    return Copy(coherence=float(np.median(coherence)), delay=shift * time_step, factor=float(factor))


def _spectrum(samples: Vector) -> Complex:
    """Return all lines of a record; of a long one in blocks, which take less memory than a transform of all samples."""
    lines = samples.size // 2 + 1
    return (
        RecordLines(samples.size, 0, lines).of(samples.__getitem__) if is_long(samples.size) else np.fft.rfft(samples)
    )


def refuse_copies(time_step: float, inputs: Vector, names: Sequence[str], band: tuple[float, float]) -> None:
    """Raise an error if an input is a copy of another."""
    for i, j in combinations(range(len(names)), 2):
        relation = copy_of(time_step, inputs[i], inputs[j], band)
        if relation.coherence >= DEPENDENT:
            raise _refusal(names[i], names[j], relation)


def common_motions(
    time_step: float, inputs: Sequence[Vector] | Vector, names: Sequence[str], band: tuple[float, float]
) -> list[dict[int, float]]:
    """Group the inputs that are scaled copies without a delay; the groups are independent motions.

    Args:
        time_step: sampling interval [s].
        inputs: samples, shape (p, n), or a sequence of (n,).
        names: names of the inputs, for messages.
        band: evaluated frequencies (low, high) [Hz].

    Returns:
        Groups in the order of their first inputs: index of each input to its factor; 1 for the first input.
    """
    groups: list[dict[int, float]] = []
    for j in range(len(names)):
        for group in groups:
            first = next(iter(group))
            relation = copy_of(time_step, inputs[first], inputs[j], band)
            if relation.coherence < DEPENDENT:
                continue
            if relation.delay != 0.0 or np.isnan(relation.factor):
                raise _refusal(names[first], names[j], relation)
            group[j] = relation.factor
            break
        else:
            groups.append({j: 1.0})
    return groups


def motion_words(motion: Mapping[Any, float]) -> str:
    """Describe how the inputs of a motion move: "alike", or "together" with their factors."""
    factors = list(motion.values())[1:]
    if all(abs(factor - 1.0) < ALIKE for factor in factors):
        return "alike"
    if len(factors) == 1:
        return f"together, one {factors[0]:.4g} times the other"
    return f"together, {', '.join(f'{factor:.4g}' for factor in factors)} times the first"


def what_moves(motions: Sequence[Mapping[str, float]], chosen: int | None = None) -> str:
    """Describe which plates move and which plate motion the FRFs refer to; empty for a single plate.

    Args:
        motions: independent motions: wheel to its factor; 1 for the first wheel.
        chosen: index of the motion that the FRFs refer to; None for FRFs to each motion.
    """
    wheels = [wheel for motion in motions for wheel in motion]
    if len(wheels) == 1:
        return ""
    subject, every = ("both plates move", "both") if len(wheels) == 2 else (f"{len(wheels)} plates move", "all")
    if len(motions) > 1 and chosen is None:
        subject += " independently of each other" if len(motions) == len(wheels) else ""
        shared = [f"; {', '.join(motion)} move {motion_words(motion)}" for motion in motions if len(motion) > 1]
        each = ", ".join(next(iter(motion)) for motion in motions)
        return f"{subject}{''.join(shared)}: an FRF from each of {each}, one coherence with {every} plates together"
    motion = motions[chosen or 0]
    first = f"plate_{next(iter(motion))}_displacement"
    if len(motion) == 1:
        return f"{subject}: the FRFs are from {first} alone, the coherence is with {every} plates together"
    if len(motions) > 1:
        plates = ", ".join(f"plate_{wheel}_displacement" for wheel in motion)
        subject, every = f"{subject}, of them {plates}", "these"
    manner = motion_words(motion)
    motion_of_frfs = "their common motion" if manner == "alike" else f"{first} while {every} do"
    return f"{subject} {manner}: the FRFs are from {motion_of_frfs}"


def _refusal(first: str, second: str, relation: Copy) -> DependentInputsError:
    """Build the error for two dependent inputs."""
    late = f", delayed by {relation.delay:.4g} s" if relation.delay > 0.0 else ""
    early = f", ahead by {-relation.delay:.4g} s" if relation.delay < 0.0 else ""
    scaling = "a filtered" if np.isnan(relation.factor) else f"{relation.factor:.4g} times"
    return DependentInputsError(
        f"excitations: {second} is {scaling} {first}{late}{early} (coherence {relation.coherence:.4f}, must be below "
        f"{DEPENDENT:g}), so their responses cannot be separated; drive the plates independently, or only one",
        relation.delay,
        relation.factor,
    )
