"""Features of a record: logarithms of spectral densities in bands, and coherencies of pairs of channels.

Welch spectra S_ij of Hann windows are averaged over each part of the record and each band. Features are log S_ii in
narrow bands, and the real and imaginary parts of S_ij/sqrt(S_ii S_jj) in wide bands.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.errors import DataError
from vehicle.names import AXES, CORNERS

WINDOW_S = 4.0
"""Length of the windows [s]: lines of 0.25 Hz, narrower than every resonance of a damped body."""

LOWEST, HIGHEST = 0.75, 40.0
"""Range of the bands [Hz]: from below the bounce of the body to above the hop of the wheels and the modes of the
engine."""

NARROW, WIDE = 28, 10
"""Numbers of bands for densities and for coherencies."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Bands:
    """Averages over bands of the lines of a spectrum.

    Attributes:
        narrow, wide: weights of the lines in each band; (bands, lines).
        samples: samples of a window.
        rate: sampling rate [Hz].
    """

    narrow: Vector
    wide: Vector
    samples: int
    rate: float

    COUNT: ClassVar[int] = NARROW

    @classmethod
    def of(cls, rate: float, highest: float) -> Bands:
        """Return the bands for a sampling rate [Hz] up to a frequency [Hz]."""
        samples = round(WINDOW_S * rate)
        frequency = np.fft.rfftfreq(samples, 1.0 / rate).astype(np.float64)
        return cls(
            narrow=_weights(frequency, min(highest, HIGHEST), NARROW),
            wide=_weights(frequency, min(highest, HIGHEST), WIDE),
            samples=samples,
            rate=rate,
        )

    @staticmethod
    def middles(highest: float) -> Vector:
        """Return the middle frequencies of the narrow bands up to a frequency [Hz]."""
        edges = np.geomspace(LOWEST, min(highest, HIGHEST), NARROW + 1)
        return np.asarray(np.sqrt(edges[1:] * edges[:-1]))

    def features(
        self, parts: Sequence[Vector], pairs: Sequence[tuple[int, int]], free: Sequence[tuple[int, int, int]] = ()
    ) -> Vector:
        """Return the features of a record.

        Args:
            parts: samples of all channels in each part [m/s2]; (channels, n) each, n at least a window.
            pairs: pairs of channels with coherencies.
            free: rows x, y, z of points whose horizontal axes have any direction: they are turned to the principal
                axes of their motion, the larger first, with signs that make them move with z.

        Raises:
            DataError: a channel is at rest.
        """
        total: Complex = np.zeros(0, dtype=np.complex128)
        count = 0
        hann = np.hanning(self.samples + 1)[:-1]
        for part in parts:
            cut = np.lib.stride_tricks.sliding_window_view(part, self.samples, axis=1)[:, :: self.samples // 2]
            cut = cut - cut.mean(axis=2, keepdims=True)
            lines = np.fft.rfft(cut * hann, axis=2)
            cross = np.einsum("asf,bsf->abf", lines, lines.conj())
            total = cross if count == 0 else total + cross
            count += cut.shape[1]
        spectra: Complex = total * (2.0 / (self.rate * count * np.sum(hann**2)))
        for axes in free:
            spectra = self._turned(spectra, axes)
        power = np.einsum("aaf->af", spectra).real
        if np.any(power @ self.narrow.T <= 0.0):
            raise DataError("diagnose: a channel of the record is at rest; leave it out with --map")
        densities = np.log(power @ self.narrow.T).ravel()
        in_bands = spectra @ self.wide.T
        level = np.sqrt(np.einsum("aab->ab", in_bands).real)
        first, second = np.array(pairs, dtype=int).reshape(-1, 2).T
        coherency = in_bands[first, second] / (level[first] * level[second])
        return np.concatenate([densities, coherency.real.ravel(), coherency.imag.ravel()])

    def _turned(self, spectra: Complex, axes: tuple[int, int, int]) -> Complex:
        """Return the cross spectra with the horizontal axes of a point turned to the principal axes."""
        x, y, _ = axes
        used = self.narrow.sum(axis=0) > 0.0
        cross = spectra[np.ix_(axes, axes)][:, :, used].sum(axis=2).real
        _, principal = np.linalg.eigh(cross[:2, :2])
        turn = principal[:, ::-1].T
        turn = turn * np.where(turn @ cross[:2, 2] < 0.0, -1.0, 1.0)[:, None]
        whole = np.eye(len(spectra))
        whole[np.ix_((x, y), (x, y))] = turn
        return np.asarray(np.einsum("ab,bcf,dc->adf", whole, spectra, whole))


def _weights(frequency: Vector, highest: float, count: int) -> Vector:
    """Return weights of lines in bands of equal ratios, whose lines at the edges count in part; (bands, lines)."""
    edges = np.geomspace(LOWEST, highest, count + 1)
    half = 0.5 * frequency[1]
    inside = np.minimum(edges[1:, None], frequency + half) - np.maximum(edges[:-1, None], frequency - half)
    share = np.clip(inside, 0.0, None)
    return np.asarray(share / share.sum(axis=1, keepdims=True))


def related_pairs(channels: Sequence[str]) -> list[tuple[int, int]]:
    """Return the pairs of channels at one point or at one wheel.

    A strut top and a knuckle show the damper between them, two axes of a point the rotation of the car. Other pairs add
    more noise than knowledge: with them the errors of eight sensors are larger.
    """
    points = [channel.rpartition("_acc_")[0] for channel in channels]
    wheels = [point.rpartition("_")[2] for point in points]
    return [
        (first, second)
        for first in range(len(channels))
        for second in range(first + 1, len(channels))
        if points[first] == points[second] or (wheels[first] in CORNERS.values() and wheels[first] == wheels[second])
    ]


def rows_of_points(channels: Sequence[str], points: Sequence[str]) -> list[tuple[int, int, int]]:
    """Return the rows x, y and z of points that have all three among the channels."""
    names = list(channels)
    wanted = [tuple(f"{point}_acc_{axis}" for axis in AXES) for point in points]
    return [(names.index(x), names.index(y), names.index(z)) for x, y, z in wanted if {x, y, z} <= {*names}]
