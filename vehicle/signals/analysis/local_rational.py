"""FRF of a whole random record by local rational models: no leakage, and no bias of the peaks by noise.

A lightly damped car leaks in every windowed average: a body mode at 3.6 Hz with 3 % damping rings for longer than the
usual window of 4 s, and the coherence falls although nothing is nonlinear. On the spectrum of the whole record the
leakage is a smooth function of frequency and is estimated together with the FRF, in a window of lines around every
frequency of the result (see `output_error`). `input_floor` excludes lines at which the input does not excite the car.

The number of lines within the half-power width of a resonance, B = 2 zeta f T, limits the accuracy. At a coherence of
0.9 the peak is low by less than 4 % for B >= 16, and by 15 % at B = 4, below which the resonance is not resolved
 (`tests.benchmarks.frf_accuracy`).

Source: McKelvey and Guerin, Non-parametric frequency response estimation using a local rational model, IFAC SYSID 2012;
Pintelon and Schoukens, System Identification: A Frequency Domain Approach, 2nd ed. 2012, section 7.2.
"""

import itertools
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vehicle.arrays import Mask
from vehicle.digits import number
from vehicle.errors import DataError
from vehicle.signals.analysis.dependence import refuse_copies
from vehicle.signals.analysis.frf import CONSTANT, CORRELATED, FrequencyResponse
from vehicle.signals.analysis.input_floor import CAUSES, cause_messages, silent_lines
from vehicle.signals.analysis.output_error import WindowFit, fit_windows
from vehicle.signals.analysis.record_lines import RecordLines, is_long
from vehicle.signals.analysis.samples import (
    Complex,
    Vector,
    checked_names,
    checked_rows,
    checked_same_length,
    checked_signals,
    checked_time_step,
    is_constant,
    refuse_constant,
)
from vehicle.threads import one_blas_thread

LEAST_HALF_WIDTH, LINES_OF_AN_INPUT = 8, 5
"""Minimum half width n of a window [lines], 17 lines for 6 unknowns, and its increase for every further input."""

RELATIVE_WIDTH = 0.02
"""Half width of a window over the index of its centre line: each window then holds about one mode of a body."""

MOST_HALF_WIDTH = 300
"""Maximum half width n of a window [lines]; it limits the computing time of long records."""

RESOLVED = 4.0
"""Minimum lines within the half-power width of a resolved resonance."""

BODY_MODES = 5.0
"""Frequency [Hz] below which modes are narrow, so that the result has two lines in every `resolution`."""

COARSE_HZ = 0.06
"""Half-power width [Hz] of a lightly damped body mode: 1 % at 3 Hz. A shorter record causes a notice."""

WINDOWS_AT_ONCE, FITS_AT_ONCE = 100, 1600
"""Fits (windows times responses) in a batch: their arrays stay in the caches."""

RETAINED = 2**24
"""Bytes allocated and freed before the fits. The allocator of glibc then reuses freed memory of arrays below this size.
Otherwise the system provides new pages for every batch, which takes a third of the time of one channel."""

INDEPENDENT = 1e-2
"""Minimum eigenvalue of the input matrix of a window, scaled to unit diagonal, for separable responses."""

OUTPUTS_OF_A_LONG_RECORD = 12
"""Responses of a long record processed in a batch, to limit the memory."""


@one_blas_thread()
def shortest_record(inputs: int, highest: float) -> float:
    """Return the length of the shortest record for an FRF [s]: eight windows of lines up to the highest frequency."""
    return 8 * (LEAST_HALF_WIDTH + LINES_OF_AN_INPUT * (inputs - 1)) / highest


def local_rational_responses(
    time_step: float,
    excitations: ArrayLike,
    responses: ArrayLike | Sequence[Vector],
    *,
    band: tuple[float, float] = (1.0, 50.0),
    resolution: float = 0.1,
    names: Sequence[str] | None = None,
    input_names: Sequence[str] | None = None,
    rounding: Sequence[float] | None = None,
) -> tuple[FrequencyResponse, ...]:
    """Estimate the FRFs of a whole random record to each of p simultaneous inputs.

    Args:
        time_step: sampling interval [s].
        excitations: inputs, shape (p, n); they may begin and end in motion.
        responses: outputs, shape (n,) or (k, n), or a sequence of k outputs (n,).
        band: lowest and highest frequency [Hz].
        resolution: spacing of the frequencies of the result [Hz]; half of it below `BODY_MODES`.
        names: names of the responses in `reasons`.
        input_names: names of the inputs in messages.
        rounding: rounding step of each input; estimated from the samples if 0 or missing.

    Returns:
        One FRF for each input, on the spectral lines of the record nearest to the requested frequencies; NaN where an
        input does not excite the line or a response is constant. The coherence is the multiple coherence with all
        inputs.

    Raises:
        DataError: too few lines below the upper frequency, or a constant input.
        DependentInputsError: an input is a copy of another.
    """
    step = checked_time_step(time_step)
    inputs = checked_signals("excitations", excitations)
    outputs = checked_rows("responses", responses)
    for row in outputs:
        checked_same_length("responses", row, "the excitations", inputs.shape[1])
    labels = checked_names("input", input_names, len(inputs))
    output_names = checked_names("response", names, len(outputs))
    samples = inputs.shape[1]
    line = 1.0 / (samples * step)
    least_half = LEAST_HALF_WIDTH + LINES_OF_AN_INPUT * (len(inputs) - 1)
    shortest = shortest_record(len(inputs), band[1])
    if samples * step < shortest:
        raise DataError(
            f"record: {samples * step:.3g} s are too short for an FRF up to {band[1]:g} Hz; record at least "
            f"{shortest:.3g} s"
        )
    refuse_constant(inputs, labels)
    if len(inputs) > 1:
        refuse_copies(step, inputs, labels, band)
    last = samples // 2
    requested = np.arange(band[0], band[1] + resolution / 2, max(resolution, line))
    low = np.arange(band[0], min(band[1], BODY_MODES), max(resolution / 2, line))
    requested = np.union1d(requested, low)
    centres = np.unique(np.round(requested / line).astype(int))
    centres = centres[(centres > least_half) & (centres < last - least_half)]
    if not centres.size:
        raise DataError(f"record: {1.0 / step:.4g} Hz are too slow for an FRF from {band[0]:g} Hz on; sample faster")
    halves = np.clip(np.round(RELATIVE_WIDTH * centres), least_half, MOST_HALF_WIDTH).astype(int)
    # A window ends within the spectrum, without the line at 0 Hz.
    halves = np.minimum(halves, np.minimum(centres - 1, last - centres))
    lines_of = RecordLines(samples, 0, int(np.max(centres + halves, initial=0)) + 1)
    spectra = np.array([_without_mean(row, lines_of) for row in inputs])
    silent = silent_lines(inputs, spectra, centres, halves, rounding or (0.0,) * len(inputs))
    moving = np.array([not is_constant(row) for row in outputs])
    shape = (len(inputs), len(outputs), centres.size)
    response, coherence = np.full(shape, complex(np.nan, np.nan)), np.full(shape[1:], np.nan)
    deviation, averages = np.full((2, *shape), np.nan)
    driven_centres, moving_rows = np.flatnonzero(silent == 0), np.flatnonzero(moving)
    driven_centres = driven_centres[np.argsort(halves[driven_centres], kind="stable")]  # narrower near the Nyquist line
    np.empty(RETAINED, dtype=np.uint8)  # see RETAINED
    group_size = max(OUTPUTS_OF_A_LONG_RECORD if is_long(samples) else len(outputs), 1)
    for begin in range(0, max(moving_rows.size, 1), group_size):
        group = moving_rows[begin : begin + group_size]
        output_spectra = np.array([_without_mean(outputs[row], lines_of) for row in group])
        output_spectra = output_spectra.reshape(-1, spectra.shape[1]).T
        for members in _batches(halves[driven_centres] > least_half, group.size):
            selected = driven_centres[members]
            half = int(halves[selected].max())
            # Windows of unequal length in one array: lines outside of a shorter window are set to zero.
            inside = np.abs(np.arange(-half, half + 1)) <= halves[selected, None]  # (s, N)
            lines = np.where(inside, centres[selected, None] + np.arange(-half, half + 1), 0)
            size = inside.sum(axis=1)
            input_windows, input_level = _scaled(spectra[:, lines] * inside, 2, size)  # (p, s, N), (p, s)
            input_windows = np.ascontiguousarray(input_windows.swapaxes(0, 1))
            # Spectral matrix S of the inputs over the window, unit diagonal; (s, p, p).
            gram = input_windows @ input_windows.conj().swapaxes(1, 2) / size[:, None, None]
            separable = np.linalg.eigvalsh(gram)[:, 0] >= INDEPENDENT
            silent[selected[~separable]] = len(CAUSES) + 1
            if not separable.any():
                continue
            selected, gram, inside, size = selected[separable], gram[separable], inside[separable], size[separable]
            output_windows = output_spectra[lines[separable].T] * inside.T[:, :, None]  # (N, s, k)
            output_windows, output_level = _scaled(output_windows, 0, size[:, None])
            fit = fit_windows(
                input_windows[separable], output_windows, halves[selected], wide=bool(halves[selected[0]] > least_half)
            )
            variance = np.real(np.einsum("skii->isk", fit.covariance))
            # From scaled spectra back to the units of response and input.
            ratio = output_level / input_level[:, separable, None]  # (p, s, k)
            rows = np.ix_(np.arange(len(inputs)), group, selected)
            # (s, k, p) to (p, k, s), the axes of the result.
            response[rows] = (fit.response.transpose(2, 0, 1) * ratio).swapaxes(1, 2)
            # Half of the variance of a complex number is that of its magnitude.
            deviation[rows] = (np.sqrt(variance / 2.0) * ratio).swapaxes(1, 2)
            # A mean over n lines with unit input has the variance noise/n.
            averages[rows] = (fit.noise / variance).swapaxes(1, 2)
            coherence[rows[1][0], selected] = _coherence(fit, gram).T
    frequency = centres * line
    reasons = (
        *_coarse(line),
        *cause_messages(frequency, silent, (*CAUSES, CORRELATED)),
        *(CONSTANT.format(output_names[row]) for row in np.flatnonzero(~moving)),
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


def _without_mean(record: Vector, lines: RecordLines) -> Complex:
    """Return lines of the spectrum of a record without its mean."""
    mean = record.mean()
    return lines.of(lambda part: record[part] - mean)


def _batches(wide: Mask, outputs: int) -> Iterator[slice]:
    """Cut frequency windows, narrowest first, into batches with one grid of poles."""
    size = min(max(FITS_AT_ONCE // max(outputs, 1), 1), WINDOWS_AT_ONCE)
    for first, last in itertools.pairwise((0, int(np.count_nonzero(~wide)), wide.size)):
        for begin in range(first, last, size):
            yield slice(begin, min(begin + size, last))


def _scaled(spectra: Complex, axis: int, lines: NDArray[np.int_]) -> tuple[Complex, Vector]:
    """Scale frequency windows to unit mean power over their lines, and return their levels too; zeros stay."""
    power = np.sum(spectra.real**2 + spectra.imag**2, axis=axis)
    level = np.sqrt(power / lines)
    return spectra * np.expand_dims(1.0 / np.where(level > 0.0, level, 1.0), axis), level


def _coherence(fit: WindowFit, gram: Complex) -> Vector:
    """Return the share of the response power that the inputs explain, shape (s, k).

    Noise of the estimate increases the power H' S H by trace(S C) on average; this is subtracted.
    """
    power = np.einsum("ski,skj,sij->sk", fit.response, fit.response.conj(), gram).real
    power = np.maximum(power - np.einsum("skij,sij->sk", fit.covariance, gram).real, 0.0)
    return np.asarray(power / (power + fit.noise))


def _coarse(line: float) -> tuple[str, ...]:
    """Return a notice if the record is too short for lightly damped modes of a body."""
    resolution = RESOLVED * line
    if resolution <= COARSE_HZ:
        return ()
    low, high = (number(100.0 * resolution / (2.0 * frequency), 2) for frequency in (3.0, 30.0))
    return (
        f"{1.0 / line:.3g} s do not resolve peaks narrower than {number(resolution, 2)} Hz (damping ratio below {low} "
        f"% at 3 Hz, {high} % at 30 Hz): they are too low; use a longer record",
    )
