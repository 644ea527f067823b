"""Measured and simulated frequency responses on the lines of the measurement, and how they agree."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.frf_agreement import BandError, band_errors, csac, csf, frac, scaled_frac
from vehicle.signals.records.frf_file import FrfData

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]

BANDS = (1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 50.0)
"""Edges of the bands of the table [Hz]: octaves."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FrfComparison:
    """One response.

    Attributes:
        channel: name in the model.
        frequency: lines of the measurement [Hz], (m,).
        measured, simulated: [m/s2 per m], (m,); NaN where undefined.
        measured_coherence, simulated_coherence: [-], (m,); NaN where not told.
        frac: over all lines [-].
        scaled_frac: at the best stretch of the simulated frequencies [-].
        scale: that stretch [-].
        bands: errors of the bands.
    """

    channel: str
    frequency: Vector
    measured: Complex
    simulated: Complex
    measured_coherence: Vector
    simulated_coherence: Vector
    frac: float
    scaled_frac: float
    scale: float
    bands: tuple[BandError, ...]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Signatures:
    """Agreement of all responses together, line by line.

    Attributes:
        frequency: [Hz], (m,).
        csac: of their shape [-], (m,).
        csf: of shape and amplitude [-], (m,).
        channels: how many responses.
    """

    frequency: Vector
    csac: Vector
    csf: Vector
    channels: int


def edges_of(text: str) -> tuple[float, ...]:
    """Edges of bands of an option, as 3,8,15,30.

    Raises:
        ConfigurationError: fewer than two numbers, or they do not rise.
    """
    try:
        found = tuple(float(part) for part in text.split(","))
    except ValueError:
        found = ()
    return checked_edges(found, f"--bands {text}")


def checked_edges(edges: Sequence[float], where: str) -> tuple[float, ...]:
    """Return edges of bands [Hz].

    Args:
        edges: frequencies [Hz].
        where: name and value, for the message.

    Raises:
        ConfigurationError: fewer than two numbers, or they do not rise.
    """
    if len(edges) < 2 or not edges[0] >= 0.0 or not all(low < high for low, high in pairwise(edges)):
        raise ConfigurationError(f"{where}: needed are rising edges in Hz, as 3,8,15,30")
    return tuple(edges)


def compare_responses(
    measured: FrfData, simulated: FrfData, edges: Sequence[float] = BANDS
) -> tuple[tuple[FrfComparison, ...], Signatures | None]:
    """Compare all responses that both have.

    The simulated ones are interpolated to the measured lines, real and imaginary part apart. A line counts by the
    product of both coherences; where one is not told, by the other.

    Args:
        measured, simulated: [m/s2 per m].
        edges: of the bands [Hz].

    Returns:
        A comparison for each response, and their agreement together, where they are two or more.

    Raises:
        DataError: no line in common.
    """
    inside = (measured.frequency >= simulated.frequency[0]) & (measured.frequency <= simulated.frequency[-1])
    frequency = measured.frequency[inside]
    if not frequency.size:
        raise DataError(
            f"measured from {measured.frequency[0]:g} to {measured.frequency[-1]:g} Hz, simulated from "
            f"{simulated.frequency[0]:g} to {simulated.frequency[-1]:g} Hz: no line in common"
        )
    bands = list(pairwise(edges))
    found = []
    for row, name in enumerate(measured.channels):
        if name not in simulated.channels:
            continue
        other = simulated.channels.index(name)
        top = measured.response[row, inside]
        bottom = np.interp(frequency, simulated.frequency, simulated.response[other])
        coherences = (
            measured.coherence[row, inside],
            np.interp(frequency, simulated.frequency, simulated.coherence[other]),
        )
        weight = np.nan_to_num(coherences[0], nan=1.0) * np.nan_to_num(coherences[1], nan=1.0)
        stretched, scale = scaled_frac(frequency, top, bottom)
        found.append(
            FrfComparison(
                channel=name,
                frequency=frequency,
                measured=top,
                simulated=bottom,
                measured_coherence=coherences[0],
                simulated_coherence=coherences[1],
                frac=frac(top, bottom),
                scaled_frac=stretched,
                scale=scale,
                bands=band_errors(frequency, top, bottom, weight, bands),
            )
        )
    if len(found) < 2:
        return tuple(found), None
    tops, bottoms = np.array([one.measured for one in found]), np.array([one.simulated for one in found])
    return tuple(found), Signatures(
        frequency=frequency, csac=csac(tops, bottoms), csf=csf(tops, bottoms), channels=len(found)
    )
