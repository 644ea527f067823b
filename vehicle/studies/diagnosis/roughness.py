"""International roughness index (IRI) of the driven road from the record: of the whole drive, and of every 100 m.

The index of every simulated road is computed from its heights (`vehicle.signals.analysis.roughness_index`); its
logarithm is one more unknown of the regression (`learned`). Within a drive, pieces of 100 m differ by their level:

    ln(IRI_piece/IRI) = b0 + sum of b_ck ln(E_ck/E_mean,ck) + e,

with the mean square E_ck of the vertical acceleration c in the wavenumbers k to which the standard quarter car of the
index responds. The least squares b over all pieces of the simulated drives weight what the car passes on, and the
residuals e are the distribution of the error.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from vehicle.arrays import Vector
from vehicle.signals.analysis.roughness_index import roughness_index
from vehicle.signals.excitation.signal import Signal
from vehicle.studies.diagnosis.drive_record import DriveRecord, Parts
from vehicle.studies.diagnosis.features import HIGHEST, LOWEST
from vehicle.studies.diagnosis.learned import Posterior

PIECE = 100.0
"""Length of a piece [m], the usual one of road surveys and of `road --iri`."""

EDGES = (0.04, 0.14, 0.3, 0.9)
"""Edges of the bands [cycles/m]: the two resonances of the standard quarter car, at 0.065 and 0.42 cycles/m, and
between. Waves outside have less than 3 % of the mean square of the index on a road of ISO 8608."""


NARROWEST = 1.3
"""Smallest ratio of the edges of a band: at low speeds the first waves are below the lowest frequency."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RoadPiece:
    """A piece of the road.

    Attributes:
        start: distance [m] and time [s] of its begin, from the begin of the record.
        end: distance [m] and time [s] of its end.
        index: IRI [m/km].
    """

    start: tuple[float, float]
    end: tuple[float, float]
    index: Posterior


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PieceFit:
    """Regression of the index of pieces over their accelerations.

    Attributes:
        coefficients: b0 and b [-]; (1 + levels,).
        residuals: e of all pieces [-]; (pieces,).
    """

    coefficients: Vector
    residuals: Vector

    @classmethod
    def of(cls, levels: Sequence[Vector], ratios: Sequence[Vector]) -> PieceFit | None:
        """Fit the pieces of simulated drives; None without a piece of 100 m in any drive.

        Args:
            levels: `Pieces.levels` of each drive; (pieces, levels) each.
            ratios: ln(IRI_piece/IRI) of each drive, at least as many.
        """
        x = np.concatenate(levels)
        # At least ten pieces for each coefficient.
        if len(x) < 10 * (x.shape[1] + 1):
            return None
        y = np.concatenate([ratio[: len(level)] for level, ratio in zip(levels, ratios, strict=True)])
        terms = np.column_stack([np.ones(len(x)), x])
        coefficients = np.linalg.lstsq(terms, y, rcond=None)[0]
        return cls(coefficients=coefficients, residuals=y - terms @ coefficients)

    def index(self, overall: Posterior, levels: Vector) -> list[Posterior]:
        """Return the posterior of the IRI of each piece [m/km].

        Args:
            overall: log10 of the IRI of the drive [m/km].
            levels: `Pieces.levels` of the record; (pieces, levels).
        """
        # Each draw of the drive with a residual drawn at random.
        chosen = np.random.Generator(np.random.PCG64(1)).choice(self.residuals, (len(levels), overall.draws.size))
        ratios = self.coefficients[0] + levels @ self.coefficients[1:]
        draws = 10.0**overall.draws * np.exp(ratios[:, None] + chosen)
        return [Posterior(draws=each, weights=overall.weights, prior=float(np.std(each))) for each in draws]


def road_index(plates: Signal, sides: Sequence[str], step: float, skipped: int) -> tuple[float, Vector]:
    """Return log10 of the IRI of a simulated road [m/km], and ln(IRI_piece/IRI) of its pieces, means of the tracks.

    Args:
        plates: heights under the wheels.
        sides: a wheel on each track.
        step: distance of the samples [m].
        skipped: samples before the record.
    """
    tracks = [roughness_index(step, plates.displacement[wheel][skipped:], segment=PIECE) for wheel in sides]
    overall = float(np.mean([track.overall for track in tracks]))
    pieces = np.mean([track.segments for track in tracks], axis=0)
    return float(np.log10(overall)), np.log(pieces / overall)


def vertical(channels: Sequence[str]) -> list[int]:
    """Return the rows of vertical accelerations; all rows without one."""
    return [row for row, name in enumerate(channels) if name.endswith("_z")] or [*range(len(channels))]


@dataclass(frozen=True, kw_only=True, slots=True)
class Pieces:
    """Pieces of 100 m of a record, and the bands of their levels.

    Attributes:
        rate: sampling rate [Hz].
        speed: speed V [m/s].
        edges: edges n V of the bands [Hz].
    """

    rate: float
    speed: float
    edges: tuple[float, ...]

    @classmethod
    def of(cls, rate: float, speed: float, highest: float) -> Pieces:
        """Return the pieces at a sampling rate [Hz] and a speed [m/s], with bands up to a frequency [Hz]."""
        edges = list[float]()
        for edge in np.clip(np.array(EDGES) * speed, LOWEST, min(highest, HIGHEST)):
            if not edges or edge > NARROWEST * edges[-1]:
                edges.append(float(edge))
        return cls(rate=rate, speed=speed, edges=tuple(edges))

    @property
    def samples(self) -> int:
        """Return the samples of a piece."""
        return round(PIECE / self.speed * self.rate)

    def levels(self, parts: Sequence[Vector]) -> Vector:
        """Return ln(E/E_mean) of whole pieces in each band and channel; (pieces, bands x channels).

        Args:
            parts: accelerations in each part of a record; (channels, n) each.
        """
        energies, lengths = list[Vector](), list[int]()
        for part in parts:
            for first in range(0, part.shape[1], self.samples):
                piece = part[:, first : first + self.samples]
                power = np.abs(np.fft.rfft(piece - piece.mean(axis=1, keepdims=True), axis=1)) ** 2
                bands = np.searchsorted(np.fft.rfftfreq(piece.shape[1], 1.0 / self.rate), self.edges)
                each = [power[:, low:high].sum(axis=1) for low, high in pairwise(bands)]
                # Parseval: |X|^2/n is the energy, the mean square times n.
                energies.append(np.concatenate(each) / piece.shape[1])
                lengths.append(piece.shape[1])
        whole = np.array(lengths) == self.samples
        mean = np.sum(energies, axis=0) / np.sum(lengths)
        return np.asarray(np.log(np.array(energies)[whole] / self.samples / mean))


def road_pieces(
    fit: PieceFit | None, overall: Posterior, record: DriveRecord, parts: Parts, highest: float
) -> tuple[RoadPiece, ...]:
    """Return the whole pieces of 100 m in the parts of a record, by distance; none without a fit.

    Args:
        fit: fit of the pieces of simulated drives.
        overall: log10 of the IRI of the record [m/km].
        record: record of the drive.
        parts: its usable parts.
        highest: highest usable frequency [Hz].
    """
    if fit is None:
        return ()
    speed = float(np.sqrt(parts.speeds[0] * parts.speeds[1]))
    cut = Pieces.of(record.rate, speed, highest)
    spans = sorted(parts.spans)
    levels = cut.levels([record.samples[vertical(record.channels), first:last] for first, last in spans])
    starts = [start for first, last in spans for start in range(first, last - cut.samples + 1, cut.samples)]
    speeds = np.full(record.samples.shape[1], speed) if record.speed is None else record.speed
    distance = np.concatenate([[0.0], np.cumsum(speeds) / record.rate])
    return tuple(
        RoadPiece(
            start=(float(distance[start]), start / record.rate),
            end=(float(distance[start + cut.samples]), (start + cut.samples) / record.rate),
            index=index,
        )
        for start, index in zip(starts, fit.index(overall, levels), strict=True)
    )
