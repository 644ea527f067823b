"""Expected mean squares of a linear car on all roads of a class: closed integrals over frequency.

A road of a class (`vehicle.signals.excitation.iso_road`) is the sum of two independent sources, the mean and the
difference of the tracks. With the density G(n) of the class, the wavenumber n = f/V, the cross spectrum g(n) of the
tracks and the contact patch a, the plate of a wheel at the distance d behind the foremost wheel moves by

    sqrt(G(n)/V) sinc(n a) e^(-j 2 pi n d) [sqrt((1 + g)/2), +-sqrt((1 - g)/2)],    right with +, left with -,

for unit densities of the sources. An output y with the responses Y_1, Y_2 to the sources and the weighting W has

    S_y(f) = |Y_1|^2 + |Y_2|^2,    E[y_W^2] = integral of |W(f)|^2 S_y(f) df.

The value needs neither a road nor a run, and does not scatter. The lines f = k/P of a road that repeats after the time
P, with the width df = 1/P, give the expectation over the phases of this road.

Sources: Dodds and Robson, Journal of Sound and Vibration 31 (1973) 175; Robson, Vehicle System Dynamics 8 (1979) 43.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.engines.reduced.linear_twin import LinearTwin
from vehicle.errors import ConfigurationError
from vehicle.signals.analysis.road_level import REFERENCE
from vehicle.signals.analysis.samples import band_shares
from vehicle.signals.analysis.weighting import weighting
from vehicle.signals.excitation.iso_road import IsoRoad, Side, isotropic_coherence

LINES, LOWEST_LINE = 300, 0.1
"""Default number of lines of the integral, and lowest line [Hz]. Against 20 000 lines the weighted comfort, the tyre
loads and the damper velocities of the shipped cars differ by at most 0.003 %, comfort in 2 to 50 Hz by 0.011 %."""

EXPONENT = 0.3
"""Lines have equal steps of f^0.3: 0.05 Hz apart at 1 Hz and 0.6 Hz at 25 Hz, in proportion to the width of resonances
of equal damping ratio, and denser above."""


class Lines(NamedTuple):
    """Lines of an integral over frequency."""

    frequency: Vector
    """f [Hz]; (m,)"""
    width: Vector
    """df, the weights of the integral [Hz]; (m,)"""


def integral_lines(road: IsoRoad, speed: float, rate: float, count: int = LINES) -> Lines:
    """Return lines for integrals over the spectrum of a class, by the trapezoidal rule over f^0.3.

    Args:
        road: road of a class.
        speed: speed V [m/s].
        rate: sampling rate of the plate signal, whose waves end at 0.8 of the Nyquist frequency [Hz].
        count: number of lines.
    """
    low = max(road.lowest * speed, LOWEST_LINE)
    high = min(road.highest * speed, 0.4 * rate)
    if low >= high:
        raise ConfigurationError(f"speed {3.6 * speed:g} km/h: the road has no waves above {low:g} Hz; drive faster")
    u = np.linspace(low**EXPONENT, high**EXPONENT, count)
    frequency = u ** (1.0 / EXPONENT)
    # df = f^(1 - 0.3) du / 0.3, the two ends count half.
    width = frequency ** (1.0 - EXPONENT) / EXPONENT * (u[1] - u[0])
    width[[0, -1]] *= 0.5
    return Lines(frequency, width)


def repeating_lines(road: IsoRoad, speed: float, rate: float, period: float) -> Lines:
    """Return the lines of a road that repeats after a time [s]; further arguments see `integral_lines`."""
    length = period * speed
    highest = min(road.highest, 0.4 * rate / speed)
    numbers = np.arange(max(1, int(np.ceil(road.lowest * length))), int(highest * length) + 1)
    return Lines(numbers / period, np.full(numbers.size, 1.0 / period))


def track_sources(road: IsoRoad, speed: float, wheels: Mapping[str, tuple[float, Side]], frequency: Vector) -> Complex:
    """Return the plate displacements for unit densities of mean and difference of the tracks [m/sqrt(Hz)]; (w, 2, m).

    Args:
        road: road of a class, with contact over a patch.
        speed: speed V [m/s].
        wheels: name of each wheel to its distance behind the foremost wheel [m] and its track.
        frequency: lines [Hz]; (m,).

    Raises:
        ConfigurationError: cams, which take the road by its upper envelope, which is not linear.
    """
    if road.envelope is not None:
        raise ConfigurationError(
            "contact cams: two cams follow the upper envelope of the road, so the expectation over its phases has no "
            "closed form; set --contact patch"
        )
    wavenumber = frequency / speed
    related = isotropic_coherence(wavenumber, road.track) if road.coherence is None else road.coherence
    density = road.level * (wavenumber / REFERENCE) ** -2.0 / speed
    amplitude = np.sqrt(density) * np.sinc(wavenumber * road.patch)
    mean, difference = amplitude * np.sqrt(0.5 * (1.0 + related)), amplitude * np.sqrt(0.5 * (1.0 - related))
    behind = np.array([distance for distance, _ in wheels.values()])[:, None]
    sign = np.array([1.0 if side == "right" else -1.0 for _, side in wheels.values()])[:, None]
    delay = np.exp(-2j * np.pi * wavenumber * behind)
    return np.stack([delay * mean, sign * delay * difference], axis=1)


def density(responses: Complex) -> Vector:
    """Return S_y, the sum of |Y|^2 over the sources, from responses (k, 2, m); (k, m)."""
    return np.asarray(np.sum(responses.real**2 + responses.imag**2, axis=1))


def damper_speeds(twin: LinearTwin, damping: Vector, lines: Lines) -> Vector:
    """Return the expected RMS velocity of each damper [m/s] with damping constants c [N s/m]; (d,)."""
    return np.asarray(np.sqrt(density(twin.velocities(damping)) @ lines.width))


def weighting_width(lines: Lines, name: str) -> Vector:
    """Return |W|^2 df of a frequency weighting [Hz]; (m,)."""
    return np.asarray(weighting(name).spectrum_factor(lines.frequency) ** 2 * lines.width)


def band_width(lines: Lines, band: tuple[float, float], duration: float | None = None) -> Vector:
    """Return df inside a band [Hz]; (m,).

    Args:
        lines: lines of the integral.
        band: lowest and highest frequency [Hz].
        duration: length T of a record that is cut from a longer road [s], whose periodogram has lines f_k = k/T. Each
            of them reads the density through the window sinc^2((f - f_k) T): leakage; by default without it.
    """
    low, high = band
    if duration is None:
        # The cell of each line counts with its part inside the band.
        edges = _cell_edges(lines)
        inside = np.minimum(edges[1:], high) - np.maximum(edges[:-1], low)
        cell = np.diff(edges)
        return np.asarray(lines.width * np.clip(inside, 0.0, None) / cell)
    read = np.arange(int(low * duration), int(high * duration) + 2) / duration
    shares = band_shares(read, 1.0 / duration, band)
    leaked = np.sinc((lines.frequency[:, None] - read) * duration) ** 2
    return np.asarray(lines.width * (leaked @ shares))


def _cell_edges(lines: Lines) -> Vector:
    """Return the limits between the cells of neighbouring lines [Hz]; (m + 1,)."""
    middle = 0.5 * (lines.frequency[1:] + lines.frequency[:-1])
    first, last = 2.0 * lines.frequency[0] - middle[0], 2.0 * lines.frequency[-1] - middle[-1]
    return np.concatenate([[first], middle, [last]])
