"""Frequency responses to several excitations at once (both plates), with multiple coherence."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import csd, welch

from vehicle.analysis.frf import FrequencyResponse
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

INDEPENDENCE = 1e-2
"""Least eigenvalue of the excitation matrix scaled to unit diagonal [-]: for two inputs 1 minus the modulus of their
coherence. Below it the error of the separated responses is more than seven times that of a single input."""


def _refuse_dependent(
    scaled: NDArray[np.complex128], independence: NDArray[np.float64], labels: tuple[str, ...]
) -> None:
    """Refuse inputs of which one follows from the others over most of the band; name them."""
    if np.median(independence) >= INDEPENDENCE:
        return
    coherence = np.median(np.abs(scaled) ** 2, axis=0)  # (p, p)
    limit = (1.0 - INDEPENDENCE) ** 2
    pairs = [
        f"{labels[i]} and {labels[j]} (coherence {coherence[i, j]:.6f})"
        for i in range(len(labels))
        for j in range(i + 1, len(labels))
        if coherence[i, j] > limit
    ]
    which = "coinciding are " + ", ".join(pairs) if pairs else f"one of {', '.join(labels)} follows from the others"
    raise DataError(
        f"excitations: fully correlated inputs, the matrix Gxx is rank-deficient (median least eigenvalue "
        f"{np.median(independence):.3g}, needed is {INDEPENDENCE:g}): {which}; their responses cannot be separated. "
        "Use the single-input frequency_response with one of them (it gives the response to the common motion), "
        "or drive them with independent signals"
    )


def frequency_response_mimo(
    time_step: float,
    excitations: ArrayLike,
    responses: ArrayLike,
    *,
    window_s: float = 4.0,
    overlap: float = 0.5,
    band: tuple[float, float] = (1.0, 50.0),
    input_names: Sequence[str] | None = None,
    names: Sequence[str] | None = None,
    minimum_averages: float = MINIMUM_AVERAGES,
) -> tuple[FrequencyResponse, ...]:
    """Estimate H1 = Gxx^-1 Gxy for p simultaneous excitations, and the multiple coherence.

    gamma^2 = Gxy^H Gxx^-1 Gxy / Gyy

    Args:
        time_step: [s].
        excitations: shape (p, n), p >= 2.
        responses: shape (n,) or (k, n).
        window_s: segment length [s].
        overlap: share of a segment repeated by the next [-].
        band: lines returned, both edges included [Hz].
        input_names: of the excitations, for messages.
        names: of the responses, for `reasons`.
        minimum_averages: effective averages asked for; at least p + 1 are always needed.

    Returns:
        One FRF for each excitation; their coherence is that with all excitations together.

    Raises:
        DataError: an excitation is constant; the excitations are fully correlated (equal, scaled or delayed copies:
            the message names them and says that the single-input FRF must be used); record too short; lengths differ.

    Source: Bendat and Piersol, Random Data, 4th ed., chapter 7; bad-inputs item 15.
    """
    step = checked_time_step(time_step)
    edges = checked_band(band, step)
    x = checked_signals("excitations", excitations)
    y = checked_signals("responses", responses)
    inputs = x.shape[0]
    if inputs < 2:
        raise DataError(f"excitations: found {inputs} signal, needed are two or more; use frequency_response for one")
    checked_same_length("responses", y, "the excitations", x.shape[1])
    labels = checked_names("input", input_names, inputs)
    outputs = checked_names("response", names, y.shape[0])
    cut = cut_into_segments(
        x.shape[1], step, window_s=window_s, overlap=overlap, minimum_averages=max(minimum_averages, inputs + 1.0)
    )
    for i in np.flatnonzero(is_constant(x)):
        raise DataError(
            f"excitations: {labels[i]} is constant, so no response to it exists; use frequency_response with "
            f"{' or '.join(name for name in labels if name != labels[i])}"
        )

    options = {"window": cut.window, "nperseg": cut.length, "noverlap": cut.overlap, "detrend": "constant"}
    lines, syy = welch(y, 1.0 / step, **options)
    inside = lines_in_band(lines, edges)
    gxx = np.moveaxis(csd(x[:, None], x[None, :], 1.0 / step, **options)[1][..., inside], -1, 0)  # (m, p, p)
    gxy = np.moveaxis(csd(x[:, None], y[None, :], 1.0 / step, **options)[1][..., inside], -1, 0)  # (m, p, k)
    syy = syy[:, inside]
    size = np.sqrt(np.real(np.einsum("mii->mi", gxx)))  # (m, p)
    dark = (size <= 0.0).any(axis=1)
    safe = np.where(dark[:, None], 1.0, size)
    scaled = gxx / (safe[:, :, None] * safe[:, None, :])  # unit diagonal, (m, p, p)
    independence = np.where(dark, 0.0, np.linalg.eigvalsh(scaled)[:, 0].clip(0.0))
    _refuse_dependent(scaled, independence, labels)

    good = independence >= INDEPENDENCE
    still = is_constant(y)
    response = np.full((y.shape[0], inputs, good.size), complex(np.nan, np.nan))
    multiple = np.full((y.shape[0], good.size), np.nan)
    cross = gxy[good] / safe[good][:, :, None]
    solution = np.linalg.solve(scaled[good], cross)  # (m, p, k)
    response[:, :, good] = np.moveaxis(solution / safe[good][:, :, None], (0, 1, 2), (2, 1, 0))
    explained = np.real(np.einsum("mpk,mpk->km", cross.conj(), solution))
    moving = syy[:, good] > 0.0
    share = np.full(explained.shape, np.nan)
    np.divide(explained, syy[:, good], out=share, where=moving)
    multiple[:, good] = share
    response[still] = complex(np.nan, np.nan)
    multiple[still] = np.nan

    reasons = [f"{outputs[i]}: constant, so its FRF and its coherence are undefined" for i in np.flatnonzero(still)]
    if not good.all():
        bad = lines[inside][~good]
        reasons.append(
            f"{bad.size} lines between {bad[0]:g} and {bad[-1]:g} Hz: the inputs are fully correlated there, so their "
            "responses cannot be separated; use the single-input frequency_response"
        )
    # The error of a separated response grows with what the inputs have in common, (Sxx^-1)_ii Sxx_ii.
    inflation = np.full((inputs, good.size), np.nan)
    inflation[:, good] = np.real(np.einsum("mii->im", np.linalg.inv(scaled[good])))
    power = np.moveaxis(np.real(np.einsum("mii->mi", gxx)), 0, 1)  # (p, m)
    noise = np.sqrt((1.0 - np.minimum(multiple, 1.0)) * syy / (2.0 * (cut.averages - inputs + 1.0)))
    error = noise * np.sqrt(inflation / np.where(power > 0.0, power, np.nan))[:, None]  # (p, k, m)
    return tuple(
        FrequencyResponse(
            frequency=lines[inside],
            response=response[:, number],
            coherence=multiple,
            random_error=error[number],
            averages=np.broadcast_to((cut.averages - inputs + 1.0) / inflation[number], multiple.shape),
            segments=cut.count,
            window="hann",
            estimator=f"H1, {inputs} inputs",
            resolution_hz=float(lines[1]),
            reasons=tuple(reasons),
        )
        for number in range(inputs)
    )
