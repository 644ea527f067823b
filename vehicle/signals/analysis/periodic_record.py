"""FRF of a record with a periodic input: ratio of spectral lines of whole periods, without window and without leakage.

In the steady state, a car on a periodic input of period T has the period T too, so that its spectrum over whole periods
has lines at k/T alone, and H(k/T) = Y_k / U_k is exact: no neighbouring line and no transient contributes. Three
conditions are checked, never assumed:

- The samples of the input repeat within their rounding.
- The last two periods of every response agree within `SETTLED`, or differ by noise alone: see `NOISE_PERIODS`.
- The lines of every response are those of a smooth FRF within `DISTORTED`. Nonlinear distortion, as by slipping
  dampers, repeats from period to period and differs from line to line: 30 to 40 % of |H| for the `focus` car on 1 mm
  RMS. A local rational model averages over lines, the ratio of lines does not.

The spread over periods is the noise of a response, and the scatter of the lines its distortion.

Source: Pintelon and Schoukens, System Identification: A Frequency Domain Approach, 2nd ed. 2012, sections 2.5 and 2.6.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vehicle.digits import number
from vehicle.signals.analysis.frf import CONSTANT, FrequencyResponse
from vehicle.signals.analysis.input_floor import ABOVE_FLOOR, rounding_step
from vehicle.signals.analysis.local_rational import local_rational_responses
from vehicle.signals.analysis.samples import (
    Complex,
    Vector,
    checked_names,
    checked_rows,
    checked_signals,
    checked_time_step,
    is_constant,
)
from vehicle.threads import one_blas_thread

SAME = 1e-9
"""Maximum difference of equal samples over the range of a record without a rounding step: an input between the samples
of a file, or computed, has a round-off of 1e-12."""

ROUNDED = 1.5
"""Maximum difference of equal samples in rounding steps: half a step for each of the two, and a half of reserve."""

RANGE = 1000.0
"""Minimum range of an input over the maximum difference of equal samples: a coarser record can repeat by chance."""

SETTLED = 0.01
"""Maximum RMS of the change of a response between the last two periods, over the RMS of the response, both on the lines
of the input. A transient that decays by half or more in a period leaves a smaller error than this change."""

NOISE = 2.0
"""Maximum change of a period to the last one, over the change between the last two periods, for noise: equal for all
periods, whereas a transient is larger the earlier the period."""

NOISE_PERIODS = 4
"""Minimum number of periods that differ by noise alone. For a transient that decays by the factor q in a period, the
change over three periods is 1 + 1/q + 1/q^2, at least three times the change over one."""

DISTORTED = 0.03
"""Maximum scatter of the lines around a smooth FRF over |H|, median over the lines. It is below 0.005 for the linear
`focus` car with lines every 0.25 Hz, and decreases with their distance."""

DISTINCT = 2.0
"""Minimum scatter of the lines over the noise of a response, both squared: below it, the scatter is that noise. The
ratio of both medians over a hundred lines has a standard deviation of 0.1."""

ADJACENT, DEGREE = 9, 2
"""Lines in a window that determine the smooth FRF (b0 + b1 x + b2 x^2) / (1 + a x), and degree of its numerator."""

DRIVEN = 1e-6
"""Minimum amplitude of a line of the input over its strongest line."""

PROBES = 64
"""Number of samples that are compared first, for every possible period."""


@one_blas_thread()
def whole_record_responses(
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
    """Estimate the FRFs of a whole record: by its periods if a single input is periodic, else by local rational models.

    Args:
        time_step, excitations, responses, band, names, input_names, rounding: see `local_rational_responses`.
        resolution: spacing of the frequencies of local rational models [Hz]; a periodic input determines its lines.

    Returns:
        One FRF for each input; `estimator` is the name of the estimator. If a periodic input is not evaluated by its
        periods, because a response has not settled or is nonlinear, the first of `reasons` is a message.
    """
    inputs, outputs = checked_signals("excitations", excitations), checked_rows("responses", responses)
    evaluated, notice = inputs.shape[1], ""
    if len(inputs) == 1 and all(row.size == inputs.shape[1] for row in outputs):
        first_rounding = (rounding or (0.0,))[0]
        periodic = _periodic_response(
            checked_time_step(time_step),
            inputs[0],
            outputs,
            band,
            checked_names("response", names, len(outputs)),
            first_rounding,
        )
        if isinstance(periodic, FrequencyResponse):
            return (periodic,)
        evaluated, notice = periodic
    estimates = local_rational_responses(
        time_step,
        inputs[:, -evaluated:],
        [row[-evaluated:] for row in outputs],
        band=band,
        resolution=resolution,
        names=names,
        input_names=input_names,
        rounding=rounding,
    )
    if notice:
        estimates = tuple(replace(estimate, reasons=(notice, *estimate.reasons)) for estimate in estimates)
    return estimates


def repeated_samples(samples: Vector, shortest: int, rounding: float = 0.0) -> tuple[int, int, float]:
    """Return the period of a record that repeats until its end, over at least its last half.

    Args:
        samples: record, shape (n,).
        shortest: minimum period [samples].
        rounding: rounding step of the samples; estimated from them if 0.

    Returns:
        Period [samples], number of whole periods that repeat (at least two), rounding step; zeros if the record does
        not repeat.
    """
    half = samples.size // 2
    extent = float(np.ptp(samples[-half:])) if half else 0.0
    periods = np.arange(max(shortest, 1), half + 1)
    if not periods.size or extent == 0.0:
        return 0, 0, 0.0
    # The rounding step needs a sorted copy, so exclude records first that do not repeat with any rounding.
    periods = _possible_periods(samples, periods, extent / RANGE)
    if not periods.size:
        return 0, 0, 0.0
    step = rounding or rounding_step(samples)
    # A tolerance near the range would find a period in any record.
    tolerance = max(ROUNDED * step, SAME * extent)
    if tolerance > extent / RANGE:
        return 0, 0, 0.0
    for period in _possible_periods(samples, periods, tolerance).tolist():
        # Samples after the last difference repeat.
        other = np.flatnonzero(np.abs(samples[period:] - samples[:-period]) > tolerance)
        repeated = samples.size - period - (int(other[-1]) + 1 if other.size else 0)
        # A slow motion changes by less than the tolerance in a short time.
        moving = float(np.ptp(samples[-period:])) >= RANGE * tolerance
        if moving and repeated >= max(half, period):
            return period, repeated // period + 1, step
    return 0, 0, 0.0


def _possible_periods(samples: Vector, periods: NDArray[np.int_], tolerance: float) -> NDArray[np.int_]:
    """Return the periods after which some samples of the last half of a record are repeated."""
    for probe in np.linspace(samples.size - samples.size // 2, samples.size - 1, PROBES).astype(int).tolist():
        # Each probe leaves the periods before which the sample was the same.
        periods = periods[np.abs(samples[probe] - samples[probe - periods]) <= tolerance]
    return periods


def _periodic_response(
    step: float, excitation: Vector, responses: Sequence[Vector], band: tuple[float, float], names: Sequence[str],
    rounding: float,
) -> FrequencyResponse | tuple[int, str]:  # fmt: skip
    """Return the FRFs to a periodic input, or the number of last samples for a local rational model and a message."""
    period, count, rounding = repeated_samples(excitation, math.ceil(ADJACENT / (band[1] * step)), rounding)
    if not period:
        return excitation.size, ""
    frequency = np.arange(period // 2 + 1) / (period * step)
    drive = np.fft.rfft(excitation[-count * period :].reshape(count, period).mean(axis=0))
    power = np.abs(drive) ** 2
    # Rounding adds white noise of q^2/12, n q^2/12 on a line, and the mean over the periods divides it by their
    # number.
    floor = max(DRIVEN**2 * float(power[1:].max()), ABOVE_FLOOR * period * rounding**2 / 12.0 / count)
    inside = (frequency >= band[0] * (1.0 - SAME)) & (frequency <= band[1] * (1.0 + SAME))
    lines = np.flatnonzero(inside & (power >= floor) & (frequency > 0.0))
    if lines.size < ADJACENT:
        return excitation.size, ""
    # Nine lines around each line, shifted inwards at the ends; (lines, ADJACENT).
    windows = np.clip(np.arange(lines.size) - ADJACENT // 2, 0, lines.size - ADJACENT)[:, None] + np.arange(ADJACENT)
    shape = len(responses), lines.size
    response, coherence = np.full(shape, complex(np.nan, np.nan)), np.full(shape, np.nan)
    deviation, averages = np.full(shape, np.nan), np.full(shape, np.nan)
    reasons = []
    for row, (samples, name) in enumerate(zip(responses, names, strict=True)):
        if is_constant(samples[None])[0]:
            reasons.append(CONSTANT.format(name))
            continue
        spectra = np.fft.rfft(samples[-count * period :].reshape(count, period), axis=1)[:, lines]
        changes = np.linalg.norm(spectra[:-1] - spectra[-1], axis=1)
        size = float(np.linalg.norm(spectra[-1]))
        # Periods after the last transient period differ by noise alone.
        earlier = np.flatnonzero(changes > NOISE * changes[-1])
        noisy = spectra[earlier[-1] + 1 if earlier.size else 0 :]
        if not changes[-1] <= SETTLED * size and len(noisy) < NOISE_PERIODS:
            return count * period, (
                f"the input repeats every {period * step:.4g} s, but {name} changes by "
                f"{number(100.0 * changes[-1] / size if size else math.inf, 2)} % between the last two periods but "
                f"must change by at most {100.0 * SETTLED:g} %: evaluated as random; record more periods"
            )
        variance = np.sum(np.abs(noisy - noisy.mean(axis=0)) ** 2, axis=0) / (len(noisy) - 1)
        # Two periods do not distinguish noise from the end of a transient, which has decayed more in the last one.
        mean, averaged = (noisy[-1], 1) if len(noisy) == 2 else (noisy.mean(axis=0), len(noisy))
        power_of_mean = np.abs(mean) ** 2
        scatter = _scatter(frequency[lines][windows], drive[lines][windows], mean[windows]) / power_of_mean
        distortion, noise = float(np.median(scatter)), float(np.median(variance / averaged / power_of_mean))
        # The scatter contains the noise of the mean.
        distortion = distortion - noise if distortion > DISTINCT * noise else 0.0
        if not distortion <= DISTORTED**2:
            return period, (
                f"the input repeats every {period * step:.4g} s, but the FRF of {name} scatters by "
                f"{number(100.0 * math.sqrt(distortion), 2)} % from line to line but must scatter by at most "
                f"{100.0 * DISTORTED:g} % (a nonlinear car, or lines too far apart): the last period is evaluated as "
                "random"
            )
        response[row] = mean / drive[lines]
        # Variance of Y: noise of the mean, or distortion, which repeats and no average lowers.
        error = np.maximum(variance / averaged, distortion * power_of_mean)
        variance = np.maximum(variance, error)
        explained = np.maximum(power_of_mean - error, 0.0)
        deviation[row] = np.sqrt(0.5 * error) / np.abs(drive[lines])
        averages[row] = variance / np.maximum(error, np.finfo(float).tiny)
        coherence[row] = explained / np.maximum(explained + variance, np.finfo(float).tiny)
    return FrequencyResponse(
        frequency=frequency[lines],
        response=response,
        coherence=coherence,
        random_error=deviation,
        averages=averages,
        segments=count,
        window="none (whole periods)",
        estimator=f"periodic input, {count} periods of {period * step:.4g} s",
        resolution_hz=float(np.diff(frequency[lines]).min()),
        reasons=tuple(reasons),
    )


def _scatter(frequency: Vector, drive: Complex, response: Complex) -> Vector:
    """Return the variance of a response about a smooth FRF, in windows of adjacent lines.

    With H = (b0 + b1 x + b2 x^2) / (1 + a x), Y = U (b0 + b1 x + b2 x^2) - a x Y is linear in the unknowns. The
    variance is that at the middle of the window, x = 0.

    Args:
        frequency: lines of each window [Hz], shape (m, N).
        drive, response: spectra U and Y, shape (m, N).

    Returns:
        Variance of a line, shape (m,).
    """
    # Scaled to -1 ... 1 with the middle line at 0.
    x = frequency - np.median(frequency, axis=1, keepdims=True)
    x /= np.abs(x).max(axis=1, keepdims=True)
    columns = np.stack([*(drive * x**degree for degree in range(DEGREE + 1)), -x * response], axis=-1)
    basis = np.linalg.qr(columns)[0]
    fitted = basis @ (basis.conj().swapaxes(1, 2) @ response[:, :, None])
    # ADJACENT lines less the unknowns b_0 ... b_DEGREE and a.
    variance: Vector = np.sum(np.abs(response - fitted[:, :, 0]) ** 2, axis=1) / (ADJACENT - DEGREE - 2)
    return variance
