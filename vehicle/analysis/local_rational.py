"""FRF of a random record without leakage: the local rational model.

A lightly damped car leaks in every windowed average: a body mode at 3.6 Hz with 3 % damping rings for longer than the
usual window of 4 s, and the coherence falls although nothing is nonlinear. On the spectrum of the whole record the
leakage is a smooth function of frequency and can be estimated beside the FRF. Over the lines k + r, |r| <= n,

    (1 + a r) Y(k + r) = (b0 + b1 r) U(k + r) + (t0 + t1 r) + noise,

one pole (which follows a resonance however sharp), a line for what lies behind it, and the transient. Least squares
give the FRF b0 and, from the residual, the noise power: the coherence is the share of the power that b explains.

Source: McKelvey and Guerin, Non-parametric frequency response estimation using a local rational model, IFAC SYSID 2012;
Pintelon and Schoukens, System Identification: A Frequency Domain Approach, 2nd ed. 2012, section 7.2.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vehicle.analysis.frf import FrequencyResponse
from vehicle.analysis.samples import checked_signals, checked_time_step
from vehicle.errors import DataError

UNKNOWNS = 5
"""b0, b1, t0, t1 and a."""

LEAST_HALF_WIDTH = 6
"""Lines n on each side at least: 13 lines, 5 unknowns, 8 complex degrees of freedom for the noise."""

RELATIVE_WIDTH = 0.03
"""Width of the stretch over its frequency: half the bandwidth of a mode with 3 % damping."""

WORST_CONDITION = 1e-3
"""Smallest over largest singular value of a stretch; below it too few of its lines are excited to tell the FRF."""

MOST_HALF_WIDTH = 60
"""Lines n on each side at most, which bounds the work on long records."""

COARSE_HZ = 0.5
"""Widest stretch [Hz] that still separates the body modes of a car, which lie half a hertz apart."""

SMALLEST_SHARE = 1e-8
"""Excitation power of a stretch of lines over that of the strongest line, below which nothing drives the car there."""


def local_rational_response(
    time_step: float,
    excitation: ArrayLike,
    responses: ArrayLike,
    *,
    band: tuple[float, float] = (1.0, 50.0),
    resolution: float = 0.1,
    names: Sequence[str] | None = None,
) -> FrequencyResponse:
    """Estimate the FRF of a whole random record.

    Args:
        time_step: sampling interval [s].
        excitation: input, shape (n,); begins and ends at rest or not, both are allowed.
        responses: outputs, shape (n,) or (k, n).
        band: lowest and highest frequency [Hz].
        resolution: distance of the frequencies of the result [Hz].
        names: names of the responses for the reasons.

    Returns:
        The FRF on the record's own lines nearest to the wanted frequencies; NaN where nothing is excited.

    Raises:
        DataError: the record holds too few lines below the upper frequency, or the input is zero.
    """
    step = checked_time_step(time_step)
    inputs = checked_signals("excitation", excitation)[0]
    outputs = checked_signals("responses", responses)
    samples = inputs.size
    line = 1.0 / (samples * step)
    if band[1] < 8 * LEAST_HALF_WIDTH * line:
        raise DataError(f"record: {samples * step:g} s is too short for an FRF up to {band[1]:g} Hz; record longer")
    spectrum = np.fft.rfft(inputs - inputs.mean())
    answers = np.fft.rfft(outputs - outputs.mean(axis=1, keepdims=True), axis=1)
    wanted = np.arange(band[0], band[1] + resolution / 2, max(resolution, line))
    lowest, highest = LEAST_HALF_WIDTH + 1, spectrum.size - LEAST_HALF_WIDTH - 1
    centres = np.unique(np.clip(np.round(wanted / line).astype(int), lowest, highest))
    strongest = float(np.max(np.abs(spectrum)) ** 2)
    if strongest == 0.0:
        raise DataError("excitation: is zero throughout; an FRF needs an input that moves")
    response = np.full((outputs.shape[0], centres.size), np.nan, dtype=complex)
    coherence = np.full(response.shape, np.nan)
    for index, centre in enumerate(centres):
        half = int(np.clip(round(0.5 * RELATIVE_WIDTH * centre), LEAST_HALF_WIDTH, MOST_HALF_WIDTH))
        half = min(half, int(centre) - 1, spectrum.size - int(centre) - 1)
        offsets = np.arange(-half, half + 1)
        lines = centre + offsets
        drive = spectrum[lines]
        power = float(np.mean(np.abs(drive) ** 2))
        if power < SMALLEST_SHARE * strongest:
            continue
        response[:, index], coherence[:, index] = _fit(offsets / half, drive / np.sqrt(power), answers[:, lines])
        response[:, index] /= np.sqrt(power)
    return FrequencyResponse(
        frequency=centres * line,
        response=response,
        coherence=coherence,
        averages=float(2 * LEAST_HALF_WIDTH + 1 - UNKNOWNS),
        segments=1,
        window="none (whole record)",
        estimator="local rational model",
        resolution_hz=line * (2 * LEAST_HALF_WIDTH + 1),
        reasons=(*_coarse(line), *_reasons(centres * line, response, names)),
    )


def _fit(
    offset: NDArray[np.float64], drive: NDArray[np.complex128], answers: NDArray[np.complex128]
) -> tuple[NDArray[np.complex128], NDArray[np.float64]]:
    """FRF and coherence of every response over one stretch of lines.

    Args:
        offset: r / n, shape (lines,).
        drive: scaled input, shape (lines,).
        answers: responses, shape (k, lines).

    Returns:
        b0 and the coherence, shape (k,); NaN where too few lines are excited, and a NaN coherence for a zero response.
    """
    response = np.full(len(answers), np.nan, dtype=complex)
    coherence = np.full(len(answers), np.nan)
    smooth = np.stack([drive, offset * drive, np.ones_like(drive), offset.astype(complex)], axis=1)
    singular = np.linalg.svd(smooth, compute_uv=False)
    if singular[-1] < WORST_CONDITION * singular[0]:
        return response, coherence
    for row, answer in enumerate(answers):
        level = float(np.sqrt(np.mean(np.abs(answer) ** 2)))
        if level == 0.0:
            response[row] = 0.0
            continue
        scaled = answer / level
        regressors = np.column_stack([smooth, -offset * scaled])
        solution = np.linalg.lstsq(regressors, scaled, rcond=None)[0]
        pole = 1.0 + solution[4] * offset
        noise = np.sum(np.abs((scaled - regressors @ solution) / pole) ** 2) / (offset.size - UNKNOWNS)
        explained = np.mean(np.abs(smooth[:, :2] @ solution[:2] / pole) ** 2)
        response[row] = solution[0] * level
        coherence[row] = explained / (explained + noise)
    return response, coherence


def _coarse(line: float) -> tuple[str, ...]:
    """A sentence where the record is too short to separate the modes of a car."""
    resolution = line * (2 * LEAST_HALF_WIDTH + 1)
    if resolution <= COARSE_HZ:
        return ()
    return (
        f"the FRF resolves {resolution:.2g} Hz only, since the record lasts {1.0 / line:.3g} s; "
        f"resonances below 10 Hz need {(2 * LEAST_HALF_WIDTH + 1) / COARSE_HZ:.0f} s",
    )


def _reasons(
    frequency: NDArray[np.float64], response: NDArray[np.complex128], names: Sequence[str] | None
) -> tuple[str, ...]:
    """A sentence for frequencies without excitation and one for each response that does not move."""
    found = []
    silent = np.all(np.isnan(response), axis=0)
    if silent.any():
        found.append(
            f"nothing is excited at {int(silent.sum())} frequencies from {frequency[silent][0]:.2f} to "
            f"{frequency[silent][-1]:.2f} Hz: no FRF there"
        )
    for row, values in enumerate(response):
        if not silent.all() and np.all(values[~silent] == 0.0):
            found.append(f"{names[row] if names else f'response {row}'} does not move: its coherence is undefined")
    return tuple(found)
