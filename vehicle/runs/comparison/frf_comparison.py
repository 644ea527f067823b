"""Agreement of measured and simulated frequency responses on the lines of the measurement."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.frf_agreement import BandError, band_errors, csac, csf, frac, scaled_frac
from vehicle.signals.analysis.response_name import row_of
from vehicle.signals.analysis.samples import Complex, Vector
from vehicle.signals.formats.frf_file import FrfData

BANDS = (1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 50.0)
"""Edges of the bands of the table [Hz]: octaves."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FrfComparison:
    """Comparison of one response."""

    channel: str  # output, a channel of the model
    plate: str  # input, as "plate_fr"; empty if unknown
    frequency: Vector  # lines of the measurement [Hz], (m,)
    measured: Complex  # measured, simulated: [m/s2 per m], (m,); NaN where undefined
    simulated: Complex
    measured_coherence: Vector  # measured_coherence, simulated_coherence: [-], (m,); NaN if unknown
    simulated_coherence: Vector
    frac: float  # FRAC over all lines [-]
    scaled_frac: float  # FRAC with the best scale of the simulated frequencies [-]
    scale: float  # this scale [-]
    bands: tuple[BandError, ...]  # errors of the bands


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Signatures:
    """Agreement of all responses together, line by line."""

    frequency: Vector  # [Hz], (m,)
    csac: Vector  # CSAC, agreement of the shape [-], (m,)
    csf: Vector  # CSF, agreement of shape and amplitude [-], (m,)
    channels: int  # number of responses, each an output to an input


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
        raise ConfigurationError(f"{where}: must be increasing frequencies [Hz], for example 3,8,15,30")
    return tuple(edges)


def paired(measured: FrfData, simulated: FrfData) -> list[tuple[int, float] | None]:
    """Return the row and the factor of the simulated response of each measured one, see `row_of`; None without one.

    Plates that move apart in the measurement and as one in the simulation have no common response.
    """
    pairs = [row_of(name, simulated.names) for name in measured.names]
    rows = [pair and pair[0] for pair in pairs]
    return [None if pair is None or rows.count(pair[0]) > 1 else pair for pair in pairs]


def other_plates(measured: FrfData, simulated: FrfData) -> list[str]:
    """Return a notice for inputs that only the measurement or only the simulation contains."""
    pairs = paired(measured, simulated)
    unpaired = [name.input for name, pair in zip(measured.names, pairs, strict=True) if pair is None and name.motion]
    compared = {pair[0] for pair in pairs if pair is not None}
    driven = [name.input for row, name in enumerate(simulated.names) if name.motion and row not in compared]
    notices = []
    if left_out := list(dict.fromkeys(unpaired)):
        notices.append(
            f"measured FRFs from {', '.join(left_out)} are left out: the run moves "
            f"{', '.join(simulated.inputs) or 'no plate'}; drive the same plates"
        )
    if driven := [plate for plate in dict.fromkeys(driven) if plate not in measured.inputs]:
        notices.append(
            f"the run also drives {', '.join(driven)}, from which there is no measured FRF; if it moved in the "
            "measurement, map its displacement too: otherwise it counts as noise"
        )
    return notices


def compare_responses(
    measured: FrfData, simulated: FrfData, edges: Sequence[float] = BANDS
) -> tuple[tuple[FrfComparison, ...], Signatures | None]:
    """Compare all responses with the same output and the same input, see `row_of`.

    Real and imaginary parts of the simulated responses are interpolated to the measured lines. The weight of a line is
    the product of both coherences; an unknown coherence counts as 1.

    Args:
        measured, simulated: [m/s2 per m].

    Returns:
        A comparison for each response, and the agreement of all together, None for a single response.

    Raises:
        DataError: no common line, or a measured response without a plate among responses to several plates.
    """
    inside = (measured.frequency >= simulated.frequency[0]) & (measured.frequency <= simulated.frequency[-1])
    frequency = measured.frequency[inside]
    if not frequency.size:
        raise DataError(
            f"measured from {measured.frequency[0]:g} to {measured.frequency[-1]:g} Hz, simulated from "
            f"{simulated.frequency[0]:g} to {simulated.frequency[-1]:g} Hz: no common frequency; "
            "measure FRFs in the band of the run"
        )
    bands = list(pairwise(edges))
    comparisons = []
    for row, (name, pair) in enumerate(zip(measured.names, paired(measured, simulated), strict=True)):
        if pair is None:
            continue
        other, factor = pair
        top = measured.response[row, inside]
        bottom = factor * np.interp(frequency, simulated.frequency, simulated.response[other])
        coherences = (
            measured.coherence[row, inside],
            np.interp(frequency, simulated.frequency, simulated.coherence[other]),
        )
        weight = np.nan_to_num(coherences[0], nan=1.0) * np.nan_to_num(coherences[1], nan=1.0)
        stretched, scale = scaled_frac(frequency, top, bottom)
        comparisons.append(
            FrfComparison(
                channel=name.output,
                plate=name.input or simulated.names[other].input,
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
