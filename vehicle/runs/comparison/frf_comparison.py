"""Agreement of measured and simulated frequency responses on the lines of the measurement."""

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
    """Comparison of one response.

    Attributes:
        channel: name in the model.
        frequency: lines of the measurement [Hz], (m,).
        measured, simulated: [m/s2 per m], (m,); NaN where undefined.
        measured_coherence, simulated_coherence: [-], (m,); NaN if unknown.
        frac: FRAC over all lines [-].
        scaled_frac: FRAC with the best scale of the simulated frequencies [-].
        scale: this scale [-].
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
        csac: CSAC, agreement of the shape [-], (m,).
        csf: CSF, agreement of shape and amplitude [-], (m,).
        channels: number of responses.
    """

    frequency: Vector
    csac: Vector
    csf: Vector
    channels: int


def edges_of(text: str) -> tuple[float, ...]:
    """Return the edges of bands [Hz] of the text of an option, as 3,8,15,30.

    Raises:
        ConfigurationError: fewer than two numbers, or they do not increase.
    """
    try:
        edges = tuple(float(part) for part in text.split(","))
    except ValueError:
        edges = ()
    return checked_edges(edges, f"--bands {text}")


def checked_edges(edges: Sequence[float], where: str) -> tuple[float, ...]:
    """Check and return edges of bands [Hz].

    Args:
        edges: frequencies [Hz].
        where: name and value, for the message.

    Raises:
        ConfigurationError: fewer than two numbers, or they do not rise.
    """
    if len(edges) < 2 or not edges[0] >= 0.0 or not all(low < high for low, high in pairwise(edges)):
        raise ConfigurationError(f"{where}: must be increasing edges in Hz, as 3,8,15,30")
    return tuple(edges)


def compare_responses(
    measured: FrfData, simulated: FrfData, edges: Sequence[float] = BANDS
) -> tuple[tuple[FrfComparison, ...], Signatures | None]:
    """Compare all common responses.

    Real and imaginary parts of the simulated responses are interpolated to the measured lines. The weight of a line is
    the product of both coherences; an unknown coherence counts as 1.

    Args:
        measured, simulated: [m/s2 per m].
        edges: edges of the bands [Hz].

    Returns:
        A comparison for each response, and the agreement of all together, None for a single response.

    Raises:
        DataError: no common line.
    """
    inside = (measured.frequency >= simulated.frequency[0]) & (measured.frequency <= simulated.frequency[-1])
    frequency = measured.frequency[inside]
    if not frequency.size:
        raise DataError(
            f"measured from {measured.frequency[0]:g} to {measured.frequency[-1]:g} Hz, simulated from "
            f"{simulated.frequency[0]:g} to {simulated.frequency[-1]:g} Hz: no common line; "
            "measure FRFs in the band of the run"
        )
    bands = list(pairwise(edges))
    comparisons = []
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
        comparisons.append(
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
    if len(comparisons) < 2:
        return tuple(comparisons), None
    tops, bottoms = (
        np.array([comparison.measured for comparison in comparisons]),
        np.array([comparison.simulated for comparison in comparisons]),
    )
    return tuple(comparisons), Signatures(
        frequency=frequency, csac=csac(tops, bottoms), csf=csf(tops, bottoms), channels=len(comparisons)
    )
