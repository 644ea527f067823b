"""FRF of a whole random record without leakage, and without the bias that noise gives to peaks: local rational models.

A lightly damped car leaks in every windowed average: a body mode at 3.6 Hz with 3 % damping rings for longer than the
usual window of 4 s, and the coherence falls although nothing is nonlinear. On the spectrum of the whole record the
leakage is a smooth function of frequency and is estimated beside the FRF, in a stretch of lines around every frequency
of the result; `output_error` says how, `input_floor` where the input tells nothing.

What a resonance needs is lines within its half-power width, B = 2 zeta f T. At a coherence of 0.9 its peak is low by
less than 4 % from B = 16 on, and by 15 % at B = 4, below which it is not resolved (`tests.benchmarks.frf_accuracy`).

Source: McKelvey and Guerin, Non-parametric frequency response estimation using a local rational model, IFAC SYSID 2012;
Pintelon and Schoukens, System Identification: A Frequency Domain Approach, 2nd ed. 2012, section 7.2.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vehicle.errors import DataError
from vehicle.signals.analysis.dependence import refuse_copies
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.input_floor import CAUSES, sentences, silent_lines
from vehicle.signals.analysis.output_error import StretchFit, fit_stretches
from vehicle.signals.analysis.record_lines import RecordLines, is_long
from vehicle.signals.analysis.samples import (
    checked_names,
    checked_rows,
    checked_same_length,
    checked_signals,
    checked_time_step,
    is_constant,
)
from vehicle.signals.analysis.segments import stretches_of_one_length
from vehicle.threads import one_blas_thread

LEAST_HALF_WIDTH, LINES_OF_AN_INPUT = 8, 5
"""Lines n on each side at least: 17 lines, 6 unknowns; and as many more for every further input."""

RELATIVE_WIDTH = 0.02
"""Lines on each side over the number of the line: modes as close as those of a body are one pole each."""

MOST_HALF_WIDTH = 300
"""Lines n on each side at most, which bounds the work on long records."""

RESOLVED = 4.0
"""Lines within the half-power width of a resonance from which its height can be told."""

BODY_MODES = 5.0
"""Frequency [Hz] below which modes are so narrow that the result has two values for every `resolution`."""

COARSE_HZ = 0.06
"""Half-power width [Hz] of a lightly damped body mode: 1 % at 3 Hz. A record that does not resolve it says so."""

INDEPENDENT = 1e-2
"""Least eigenvalue of the matrix of the inputs, scaled to unit diagonal, over a stretch."""

OUTPUTS_OF_A_LONG_RECORD = 12
"""Responses of a long record whose lines are in memory at once."""

SAME = "the inputs are fully correlated there, so that their responses cannot be separated"


def local_rational_response(
    time_step: float,
    excitation: ArrayLike,
    responses: ArrayLike,
    *,
    band: tuple[float, float] = (1.0, 50.0),
    resolution: float = 0.1,
    names: Sequence[str] | None = None,
    rounding: float = 0.0,
) -> FrequencyResponse:
    """Estimate the FRF of a whole random record to one input; the arguments are those of `local_rational_responses`."""
    found = local_rational_responses(
        time_step,
        checked_signals("excitation", excitation)[:1],
        responses,
        band=band,
        resolution=resolution,
        names=names,
        input_names=("excitation",),
        rounding=(rounding,),
    )
    return found[0]


@one_blas_thread()
def local_rational_responses(
    time_step: float,
    excitations: ArrayLike,
    responses: ArrayLike | Sequence[NDArray[np.float64]],
    *,
    band: tuple[float, float] = (1.0, 50.0),
    resolution: float = 0.1,
    names: Sequence[str] | None = None,
    input_names: Sequence[str] | None = None,
    rounding: Sequence[float] | None = None,
) -> tuple[FrequencyResponse, ...]:
    """Estimate the FRFs of a whole random record to each of p inputs that act at once.

    Args:
        time_step: sampling interval [s].
        excitations: inputs, shape (p, n); they begin and end at rest or not, both are allowed.
        responses: outputs, shape (n,) or (k, n), or k of them one by one.
        band: lowest and highest frequency [Hz].
        resolution: distance of the frequencies of the result [Hz]; half of it below `BODY_MODES`.
        names: names of the responses for the reasons.
        input_names: names of the inputs for messages.
        rounding: step to which each input was rounded; found from the samples where 0 or not given.

    Returns:
        One FRF for each input, on the record's own lines nearest to the wanted frequencies; NaN where an input says
        nothing or a response does not move. The coherence is that with all inputs together.

    Raises:
        DataError: the record holds too few lines below the upper frequency, an input does not move.
        DependentInputsError: an input is a copy of another.
    """
    step = checked_time_step(time_step)
    inputs = checked_signals("excitations", excitations)
    outputs = checked_rows("responses", responses)
    for row in outputs:
        checked_same_length("responses", row, "the excitations", inputs.shape[1])
    labels = checked_names("input", input_names, len(inputs))
    answering = checked_names("response", names, len(outputs))
    samples = inputs.shape[1]
    line = 1.0 / (samples * step)
    least = LEAST_HALF_WIDTH + LINES_OF_AN_INPUT * (len(inputs) - 1)
    if band[1] < 8 * least * line:
        raise DataError(
            f"record: {samples * step:g} s is too short for an FRF up to {band[1]:g} Hz; record at least "
            f"{8 * least / band[1]:.3g} s"
        )
    for number in np.flatnonzero(is_constant(inputs)):
        raise DataError(
            f"{labels[number]}: is constant, at {inputs[number, 0]:g}; an FRF needs an input that moves; drive it, or "
            "ask for the FRF to one that moves"
        )
    if len(inputs) > 1:
        refuse_copies(step, inputs, labels, band)
    last = samples // 2
    wanted = np.arange(band[0], band[1] + resolution / 2, max(resolution, line))
    low = np.arange(band[0], min(band[1], BODY_MODES), max(resolution / 2, line))
    wanted = np.union1d(wanted, low)
    centres = np.unique(np.round(wanted / line).astype(int))
    centres = centres[(centres > least) & (centres < last - least)]
    halves = np.clip(np.round(RELATIVE_WIDTH * centres), least, MOST_HALF_WIDTH).astype(int)
    halves = np.minimum(halves, np.minimum(centres - 1, last - centres))
    lines_of = RecordLines(samples, 0, int(np.max(centres + halves, initial=0)) + 1)
    spectra = np.array([_without_mean(row, lines_of) for row in inputs])
    silent = silent_lines(inputs, spectra, centres, halves, rounding or (0.0,) * len(inputs))
    moving = np.array([not is_constant(row) for row in outputs])
    shape = (len(inputs), len(outputs), centres.size)
    response, coherence = np.full(shape, complex(np.nan, np.nan)), np.full(shape[1:], np.nan)
    deviation, averages = np.full((2, *shape), np.nan)
    driven, answering_rows = np.flatnonzero(silent == 0), np.flatnonzero(moving)
    at_once = max(OUTPUTS_OF_A_LONG_RECORD if is_long(samples) else len(outputs), 1)
    for begin in range(0, max(answering_rows.size, 1), at_once):
        group = answering_rows[begin : begin + at_once]
        answers = np.array([_without_mean(outputs[row], lines_of) for row in group]).reshape(-1, spectra.shape[1])
        for some, lines in stretches_of_one_length(centres[driven], halves[driven]):
            which = driven[some]
            drives, drive_level = _scaled(spectra[:, lines])  # (s, p, N), (s, p)
            gram = drives @ drives.conj().swapaxes(1, 2) / lines.shape[1]
            apart = np.linalg.eigvalsh(gram)[:, 0] >= INDEPENDENT
            silent[which[~apart]] = len(CAUSES) + 1
            if not apart.any():
                continue
            which, gram = which[apart], gram[apart]
            scaled, level = _scaled(answers[:, lines[apart]])
            fit = fit_stretches(drives[apart], scaled, wide=lines.shape[1] // 2 > least)
            variance = np.real(np.einsum("skii->isk", fit.covariance))
            ratio = level / drive_level[apart].T[:, :, None]  # (p, s, k)
            rows = np.ix_(np.arange(len(inputs)), group, which)
            response[rows] = (fit.response.transpose(2, 0, 1) * ratio).swapaxes(1, 2)
            deviation[rows] = (np.sqrt(variance / 2.0) * ratio).swapaxes(1, 2)
            averages[rows] = (fit.noise / variance).swapaxes(1, 2)
            coherence[rows[1][0], which] = _coherence(fit, gram).T
    frequency = centres * line
    reasons = (
        *_coarse(line),
        *sentences(frequency, silent, (*CAUSES, SAME)),
        *(f"{answering[row]}: constant, so its FRF and its coherence are undefined" for row in np.flatnonzero(~moving)),
    )
    return tuple(
        FrequencyResponse(
            frequency=frequency,
            response=response[number],
            coherence=coherence,
            random_error=deviation[number],
            averages=averages[number],
            segments=1,
            window="none (whole record)",
            estimator="local rational model, output error" + (f", {len(inputs)} inputs" if len(inputs) > 1 else ""),
            resolution_hz=RESOLVED * line,
            reasons=reasons,
        )
        for number in range(len(inputs))
    )


def _without_mean(record: NDArray[np.float64], lines: RecordLines) -> NDArray[np.complex128]:
    """Lines of the spectrum of a record about its mean."""
    mean = record.mean()
    return lines.of(lambda part: record[part] - mean)


def _scaled(spectra: NDArray[np.complex128]) -> tuple[NDArray[np.complex128], NDArray[np.float64]]:
    """Stretches (r, s, N) of r rows as (s, r, N), scaled to unit mean power, and their levels (s, r); zeros stay."""
    rows = spectra.swapaxes(0, 1)
    level = np.sqrt(np.mean(np.abs(rows) ** 2, axis=2))
    return rows / np.where(level > 0.0, level, 1.0)[:, :, None], level


def _coherence(fit: StretchFit, gram: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Share of a response that the inputs explain, shape (s, k).

    The power H' S H of the estimate is too large by what its own noise adds, trace(S C), on average.
    """
    power = np.einsum("ski,skj,sij->sk", fit.response, fit.response.conj(), gram).real
    power = np.maximum(power - np.einsum("skij,sij->sk", fit.covariance, gram).real, 0.0)
    return np.asarray(power / (power + fit.noise))


def _coarse(line: float) -> tuple[str, ...]:
    """A sentence where the record is too short for lightly damped modes of a body."""
    resolution = RESOLVED * line
    if resolution <= COARSE_HZ:
        return ()
    return (
        f"resonances narrower than {resolution:.2g} Hz between the half-power points (damping ratio below "
        f"{100 * resolution / 6.0:.2g} % at 3 Hz, {100 * resolution / 60.0:.2g} % at 30 Hz) are not resolved by a "
        f"record of {1.0 / line:.3g} s: their peaks come out too low; record longer",
    )
