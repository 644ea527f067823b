"""Inputs of which one follows from another: equal, scaled, inverted or delayed copies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

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
    for i in range(len(names)):
        for j in range(i + 1, len(names)):
            found = copy_of(time_step, inputs[i], inputs[j], band)
            if found.coherence < DEPENDENT:
                continue
            late = f", delayed by {found.delay:.4g} s" if found.delay > 0.0 else ""
            early = f", ahead by {-found.delay:.4g} s" if found.delay < 0.0 else ""
            how = "a filtered" if np.isnan(found.factor) else f"{found.factor:.4g} times"
            raise DependentInputsError(
                f"excitations: fully correlated inputs: {names[j]} is {how} {names[i]}{late}{early} "
                f"(coherence {found.coherence:.4f}, allowed is below {DEPENDENT:g}), so their responses cannot be "
                "separated; drive them with independent signals, or one of them alone",
                found.delay,
                found.factor,
            )


def common_motion(time_step: float, inputs: Real, names: Sequence[str], band: tuple[float, float]) -> str | None:
    """How inputs without delay move together; None where they are independent.

    Raises:
        DependentInputsError: one is a delayed or filtered copy, so there is no common motion either.
    """
    try:
        refuse_copies(time_step, inputs, names, band)
    except DependentInputsError as error:
        if error.delay != 0.0 or np.isnan(error.factor):
            raise
        return "alike" if abs(error.factor - 1.0) < ALIKE else f"together, one {error.factor:.4g} times the other"
    return None
