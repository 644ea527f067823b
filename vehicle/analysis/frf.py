"""Frequency response and coherence of one excitation and any number of responses (H1 estimator)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import csd, welch

from vehicle.analysis.samples import (
    checked_band,
    checked_names,
    checked_same_length,
    checked_signals,
    checked_time_step,
    is_constant,
    lines_in_band,
)
from vehicle.analysis.segments import MINIMUM_AVERAGES, cut_into_segments
from vehicle.errors import DataError

EXCITED = 1e-24
"""Least share of the largest excitation power that a line must hold: an amplitude ratio of 1e-12, below which rounding
of the transform leaves fewer than three correct digits."""


@dataclass(frozen=True, kw_only=True, slots=True)
class FrequencyResponse:
    """Response over excitation, with the coherence that tells how far to trust it."""

    frequency: NDArray[np.float64]
    """lines [Hz], shape (m,)"""
    response: NDArray[np.complex128]
    """H(f) [unit of response / unit of excitation], shape (k, m); NaN where undefined"""
    coherence: NDArray[np.float64]
    """gamma^2 [-], shape (k, m); NaN where undefined"""
    random_error: NDArray[np.float64]
    """standard error of |H| [unit of H], shape (k, m): 95 % of all estimates lie within 1.96 of it in magnitude, within
    2.45 in the complex plane; NaN where undefined"""
    averages: NDArray[np.float64]
    """averages of independent spectra that give this error by H1, shape (k, m): its true degrees of freedom [-]"""
    segments: int
    """overlapping segments averaged [-]"""
    window: str
    """name of the window"""
    estimator: str
    """name of the estimator"""
    resolution_hz: float
    """least half-power width of a resonance whose height can be told; of H1 the distance of the lines [Hz]"""
    reasons: tuple[str, ...]
    """one sentence for each cause of NaN; empty when all is defined"""


def relative_error(coherence: ArrayLike, averages: float) -> NDArray[np.float64]:
    """Standard error of |H| over |H| of an H1 estimate, sqrt((1 - gamma^2) / (2 n gamma^2)); NaN where gamma is 0.

    Source: Bendat and Piersol, Random Data, 4th ed., section 9.2.
    """
    gamma2 = np.asarray(coherence, dtype=np.float64)
    gamma2 = np.where(gamma2 > 0.0, np.minimum(gamma2, 1.0), np.nan)
    return np.asarray(np.sqrt((1.0 - gamma2) / (2.0 * averages * gamma2)))


def frequency_response(
    time_step: float,
    excitation: ArrayLike,
    responses: ArrayLike,
    *,
    window_s: float = 4.0,
    overlap: float = 0.5,
    band: tuple[float, float] = (1.0, 50.0),
    names: Sequence[str] | None = None,
    minimum_averages: float = MINIMUM_AVERAGES,
) -> FrequencyResponse:
    """Estimate H1 = Sxy / Sxx and gamma^2 = |Sxy|^2 / (Sxx Syy) by Welch's method (Hann window, constant removed).

    H1 is unbiased by noise on the response. What biases it is leakage: a window must be long against the ringing of
    the resonance, for part of a segment's response was excited before the segment began. With a flat excitation the
    expected estimate is the transform of h(tau) rho(tau): the impulse response times the autocorrelation of the
    window, rho = 1 - (2 pi^2/3) (tau/window_s)^2 + ... for Hann. So a peak with the time constant
    tau0 = 1/(2 pi zeta f) is low by about (4 pi^2/3) (tau0/window_s)^2 while that is small: 1.0 % at 28 Hz with 5 %
    damping and 4 s; at 20 Hz with 1 % it is 25 %, and 3 % with 16 s. The coherence drops there although nothing is
    noisy. Use a longer window.

    A line that the excitation does not reach (a band-limited input below its lower edge) shows the leak of its
    neighbours only; choose the band within the band of the input.

    Args:
        time_step: [s].
        excitation: shape (n,).
        responses: shape (n,) or (k, n).
        window_s: segment length [s]; the lines are 1 / window_s apart.
        overlap: share of a segment repeated by the next [-].
        band: lines returned, both edges included [Hz].
        names: of the responses, for `reasons`.
        minimum_averages: effective averages asked for. Below 2 the coherence is NaN (one average gives 1 always).

    Returns:
        The FRF; a response that does not move gives NaN and a reason.

    Raises:
        DataError: too few averages (says how long the record must be), excitation constant, lengths differ,
            sampled too slowly, values not finite.
        ConfigurationError: window, overlap or band out of range.

    Source: Bendat and Piersol, Random Data, 4th ed., chapters 6 and 9.
    """
    step = checked_time_step(time_step)
    edges = checked_band(band, step)
    x = checked_signals("excitation", excitation)
    y = checked_signals("responses", responses)
    if x.shape[0] != 1:
        raise DataError(f"excitation: found {x.shape[0]} signals; use frequency_response_mimo for several inputs")
    checked_same_length("responses", y, "the excitation", x.shape[1])
    labels = checked_names("response", names, y.shape[0])
    cut = cut_into_segments(x.shape[1], step, window_s=window_s, overlap=overlap, minimum_averages=minimum_averages)
    if is_constant(x)[0]:
        raise DataError(
            f"excitation: constant at {x[0, 0]:g} over all {x.shape[1]} samples, so no frequency response exists; "
            "give the channel that moves"
        )

    options = {"window": cut.window, "nperseg": cut.length, "noverlap": cut.overlap, "detrend": "constant"}
    lines, sxx = welch(x[0], 1.0 / step, **options)
    sxy = csd(x, y, 1.0 / step, **options)[1]  # (k, m), conj(X) Y
    syy = welch(y, 1.0 / step, **options)[1]  # (k, m)
    reached = sxx > EXCITED * sxx.max()
    inside = lines_in_band(lines, edges)
    still = is_constant(y)
    defined = reached & ~still[:, None]  # (k, m)

    response = np.full(sxy.shape, complex(np.nan, np.nan))
    np.divide(sxy, sxx, out=response, where=defined)
    coherence = np.full(syy.shape, np.nan)
    reasons = [f"{labels[i]}: constant, so its FRF and its coherence are undefined" for i in np.flatnonzero(still)]
    if cut.averages < 2.0:
        reasons.append(f"coherence: undefined with {cut.averages:.3g} averages (a single one gives 1 whatever happens)")
    else:
        np.divide(np.abs(sxy) ** 2, sxx * syy, out=coherence, where=defined & (syy > 0.0))
    if not reached[inside].all():
        dark = lines[inside & ~reached]
        reasons.append(
            f"{dark.size} lines between {dark[0]:g} and {dark[-1]:g} Hz: not excited, so the FRF is undefined"
        )
    return FrequencyResponse(
        frequency=lines[inside],
        response=response[:, inside],
        coherence=coherence[:, inside],
        random_error=(np.abs(response) * relative_error(coherence, cut.averages))[:, inside],
        averages=np.full((y.shape[0], int(inside.sum())), cut.averages),
        segments=cut.count,
        window="hann",
        estimator="H1",
        resolution_hz=float(lines[1]),
        reasons=tuple(reasons),
    )
