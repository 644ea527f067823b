"""FRF of a random record without leakage: the local polynomial method.

A lightly damped car leaks in every windowed average: a body mode at 3.6 Hz with 3 % damping rings for longer than the
usual window of 4 s, and the coherence falls although nothing is nonlinear. On the spectrum of the whole record the
leakage is a smooth function of frequency and can be estimated beside the FRF. Over the lines k + r, |r| <= n,

    Y(k + r) = (h0 + h1 r + h2 r2 + h3 r3) U(k + r) + (t0 + t1 r + t2 r2 + t3 r3) + noise,

least squares give the FRF h0 and, from the residual, the noise power: the coherence is the share of the response
power that the FRF explains.

Source: Pintelon and Schoukens, System Identification: A Frequency Domain Approach, 2nd ed. 2012, section 7.2;
Schoukens et al., Nonparametric preprocessing in system identification, 2006.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vehicle.analysis.frf import FrequencyResponse
from vehicle.analysis.samples import checked_signals, checked_time_step
from vehicle.errors import DataError

ORDER = 3
"""Degree of both polynomials: over 13 lines of a minute, a mode at 3.1 Hz with 1.7 % damping is no parabola."""

LEAST_HALF_WIDTH = 6
"""Lines n on each side at least: 13 lines, 8 unknowns, 5 complex degrees of freedom for the noise."""

RELATIVE_WIDTH = 0.03
"""Width of the stretch over its frequency: half the bandwidth of a mode with 3 % damping, which a cubic follows."""

WORST_CONDITION = 1e-3
"""Smallest over largest singular value of a stretch; below it too few of its lines are excited to tell the FRF."""

MOST_HALF_WIDTH = 60
"""Lines n on each side at most, which bounds the work on long records."""

COARSE_HZ = 0.5
"""Widest stretch [Hz] that still separates the body modes of a car, which lie half a hertz apart."""

SMALLEST_SHARE = 1e-8
"""Excitation power of a stretch of lines over that of the strongest line, below which nothing drives the car there."""


def local_polynomial_response(
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
        DataError: the record is shorter than twice the lines of one estimate, or the input is zero.
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
        powers = (offsets / half)[:, None] ** np.arange(ORDER + 1)
        lines = centre + offsets
        drive = spectrum[lines]
        power = float(np.mean(np.abs(drive) ** 2))
        if power < SMALLEST_SHARE * strongest:
            continue
        scale = np.sqrt(power)
        regressors = np.hstack([powers * (drive / scale)[:, None], powers])
        solution, _, rank, singular = np.linalg.lstsq(regressors, answers[:, lines].T, rcond=None)
        if singular[-1] < WORST_CONDITION * singular[0]:
            continue
        residual = answers[:, lines].T - regressors @ solution
        freedom = offsets.size - int(rank)
        noise = np.sum(np.abs(residual) ** 2, axis=0) / freedom
        explained = np.mean(np.abs(regressors[:, : ORDER + 1] @ solution[: ORDER + 1]) ** 2, axis=0)
        total = explained + noise
        response[:, index] = solution[0] / scale
        with np.errstate(invalid="ignore", divide="ignore"):
            coherence[:, index] = np.where(total > 0.0, explained / total, np.nan)
    return FrequencyResponse(
        frequency=centres * line,
        response=response,
        coherence=coherence,
        averages=float(2 * LEAST_HALF_WIDTH + 1 - 2 * (ORDER + 1)),
        segments=1,
        window="none (whole record)",
        estimator="local polynomial",
        resolution_hz=line * (2 * LEAST_HALF_WIDTH + 1),
        reasons=(*_coarse(line), *_reasons(centres * line, response, names)),
    )


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
