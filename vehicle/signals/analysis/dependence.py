"""Inputs of which one follows from another: equal, scaled, inverted or delayed copies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehicle.errors import DataError

Real = NDArray[np.float64]

DEPENDENT = 0.98
"""Coherence of two inputs, one shifted onto the other, from which they are one: their responses would be separated with
more than seven times the error of a single input."""

ALIKE = 0.02
"""Difference of the factor from 1 up to which two inputs move alike."""

DRIVEN = 1e-6
"""Power of a line over the strongest from which it counts in the comparison."""

SIDE_LINES = 8
"""Lines on each side over which the coherence is averaged."""


class DependentInputsError(DataError):
    """Two inputs are copies of each other, so their responses cannot be separated.

    Attributes:
        delay: of the second behind the first [s].
        factor: second over first; NaN where it is a filter.
    """

    def __init__(self, message: str, delay: float, factor: float) -> None:
        super().__init__(message)
        self.delay = delay
        self.factor = factor


@dataclass(frozen=True, kw_only=True, slots=True)
class Copy:
    """How an input follows from another."""

    coherence: float
    """of the two, one shifted onto the other [-]"""
    delay: float
    """of the second behind the first [s]"""
    factor: float
    """second over first [-]; NaN where it is a filter"""


def copy_of(time_step: float, first: Real, second: Real, band: tuple[float, float]) -> Copy:
    """The delay [s] and factor that make a second input most like a first one, and how like it then is.

    The delay is the maximum of the correlation of the whitened signals; both are then cut to the time that they share,
    windowed, and their coherence averaged over 17 lines; its median over the driven lines of the band counts.

    Args:
        time_step: [s].
        first: samples, shape (n,).
        second: samples, shape (n,).
        band: frequencies that count [Hz].

    Source: Knapp and Carter, IEEE Trans. ASSP 24 (1976) 320 (phase transform).
    """
    count = first.size
    line = 1.0 / (2 * count * time_step)
    window = slice(int(band[0] / line), int(band[1] / line) + 1)
    one, two = (np.fft.rfft(signal - signal.mean(), 2 * count) for signal in (first, second))
    cross = np.zeros_like(one)
    size = np.abs(one * two)[window]
    driven = size > DRIVEN * size.max()
    cross[window][driven] = (two * one.conj())[window][driven] / size[driven]
    correlation = np.fft.irfft(cross)
    shift = int(np.argmax(np.abs(correlation)))
    shift -= 2 * count if shift > count else 0
    shift = shift if abs(shift) < count // 2 else 0
    early, late = (first[: count - shift], second[shift:]) if shift >= 0 else (first[-shift:], second[:shift])
    taper = np.hanning(early.size)
    one, two = (np.fft.rfft((signal - signal.mean()) * taper) for signal in (early, late))
    line = 1.0 / (early.size * time_step)
    mean = np.ones(2 * SIDE_LINES + 1)
    s11, s22, s12 = (np.convolve(p, mean, mode="same") for p in (abs(one) ** 2, abs(two) ** 2, one.conj() * two))
    inside = np.zeros(s11.size, dtype=bool)
    inside[int(band[0] / line) : int(band[1] / line) + 1] = True
    for power in (s11, s22):
        inside &= power > DRIVEN * power[inside].max()
    coherence = np.abs(s12[inside]) ** 2 / (s11[inside] * s22[inside])
    one_power, two_power, both = (np.sum(s[inside].real) for s in (s11, s22, s12))
    factor = both / one_power if both**2 > DEPENDENT * one_power * two_power else np.nan
    return Copy(coherence=float(np.median(coherence)), delay=shift * time_step, factor=float(factor))


def refuse_copies(time_step: float, inputs: Real, names: Sequence[str], band: tuple[float, float]) -> None:
    """Refuse inputs of which one is a copy of another, with its delay and factor.

    Raises:
        DependentInputsError: with delay and factor.
    """
    for i, j in combinations(range(len(names)), 2):
        found = copy_of(time_step, inputs[i], inputs[j], band)
        if found.coherence >= DEPENDENT:
            raise _refusal(names[i], names[j], found)


def common_motions(
    time_step: float, inputs: Real, names: Sequence[str], band: tuple[float, float]
) -> list[dict[int, float]]:
    """Inputs that move together without a delay, in groups; the groups are independent of each other.

    Args:
        time_step: [s].
        inputs: samples, shape (p, n).
        names: of the inputs, for messages.
        band: frequencies that count [Hz].

    Returns:
        Groups in the order of their first inputs: index of each input to its factor, 1 of the first.

    Raises:
        DependentInputsError: one is a delayed or filtered copy, so there is no common motion either.
    """
    groups: list[dict[int, float]] = []
    for j in range(len(names)):
        for group in groups:
            first = next(iter(group))
            found = copy_of(time_step, inputs[first], inputs[j], band)
            if found.coherence < DEPENDENT:
                continue
            if found.delay != 0.0 or np.isnan(found.factor):
                raise _refusal(names[first], names[j], found)
            group[j] = found.factor
            break
        else:
            groups.append({j: 1.0})
    return groups


def motion_words(motion: Mapping[Any, float]) -> str:
    """How the inputs of a motion move: alike, or together with their factors."""
    factors = list(motion.values())[1:]
    if all(abs(factor - 1.0) < ALIKE for factor in factors):
        return "alike"
    if len(factors) == 1:
        return f"together, one {factors[0]:.4g} times the other"
    return f"together, {', '.join(f'{factor:.4g}' for factor in factors)} times the first"


def what_moves(motions: Sequence[Mapping[str, float]], chosen: int | None = None) -> str:
    """A sentence on plates that move at once, and what FRFs are to; empty of one plate alone.

    Args:
        motions: that are independent of each other: wheel to its factor, 1 of the first.
        chosen: number of the motion that the FRFs are to; None of FRFs to each.
    """
    wheels = [wheel for motion in motions for wheel in motion]
    if len(wheels) == 1:
        return ""
    subject, every = ("both plates move", "both") if len(wheels) == 2 else (f"{len(wheels)} plates move", "all")
    if len(motions) > 1 and chosen is None:
        subject += " independently of each other" if len(motions) == len(wheels) else ""
        shared = [f"; {', '.join(motion)} move {motion_words(motion)}" for motion in motions if len(motion) > 1]
        said = f"{subject}{''.join(shared)}: the FRFs are separated, to {', '.join(next(iter(m)) for m in motions)}"
        return f"{said}; the coherence is that with {every}"
    motion = motions[chosen or 0]
    first = f"plate_{next(iter(motion))}_displacement"
    if len(motion) == 1:
        return f"{subject}: the FRFs are those to {first} alone, the coherence is that with {every}"
    if len(motions) > 1:
        plates = ", ".join(f"plate_{wheel}_displacement" for wheel in motion)
        subject, every = f"{subject}, of them {plates}", "these"
    together = motion_words(motion)
    return f"{subject} {together}: the FRFs are those to " + (
        "their common motion" if together == "alike" else f"{first} while {every} do"
    )


def _refusal(first: str, second: str, found: Copy) -> DependentInputsError:
    late = f", delayed by {found.delay:.4g} s" if found.delay > 0.0 else ""
    early = f", ahead by {-found.delay:.4g} s" if found.delay < 0.0 else ""
    how = "a filtered" if np.isnan(found.factor) else f"{found.factor:.4g} times"
    return DependentInputsError(
        f"excitations: fully correlated inputs: {second} is {how} {first}{late}{early} "
        f"(coherence {found.coherence:.4f}, allowed is below {DEPENDENT:g}), so their responses cannot be "
        "separated; drive them with independent signals, or one of them alone",
        found.delay,
        found.factor,
    )
