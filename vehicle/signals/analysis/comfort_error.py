"""Standard error of an overall RMS over roads of one class, and of the difference of two cars on the same road.

On the lines of the periodogram of the evaluated record, X_k (axes), |X_k|^2 = S_k df, the mean square over all axes is
W = sum X_k^H X_k. For a stationary Gaussian vibration the lines are independent complex Gaussian vectors, so that

    Var W = sum tr(S_k S_k) df^2 = sum_ij int |S_ij|^2 df / T

with the cross spectra S_ij of the axes: correlated axes count with their coherence. Neighbouring lines are independent
and have the same S, so E |X_k^H X_(k+1)|^2 = tr(S_k S_k) df^2, and the sum of |X_k^H X_(k+1)|^2 estimates Var W. This
holds for a Gaussian road, and for a road whose lines have fixed amplitudes and random phases; for the latter the
squares |X_k|^4 have half the expectation. With rms = sqrt(W), the normalised standard error is
sqrt(Var W) / (2 W).

A weighted RMS, sqrt(sum k_i^2 a_i^2) over the axes with the factors k_i of ISO 2631-1, is that of the weighted records
times k_i: X_k are then their lines (`weighted_lines`).

For two cars on the same road, Z = [X_a; X_b] and J = diag(1, -1) give Var(W_a - W_b) = tr(J S J S) df^2 likewise: the
products of neighbours are subtracted before they are squared. A sum of products at the distance m,

    C_m = sum X_k^H X_(k+m) / (2 sqrt(W)),  m = 1, 2, ...,

is the Fourier line at m/T of the instantaneous mean square over 2 rms. Its spectrum is flat near 0 Hz, so each C_m has
the variance of the mean. The first `WAVES` are stored with each run, and mean |C_m,a - C_m,b|^2 is the variance of
rms_a - rms_b with two degrees of freedom for each m.

On a road that repeats after the evaluated span, the value of a linear car is the same for all phases, so what a run
differs by is what its linear twin on the same road does not explain (a control variate). With the waves C'_m of the
twin, the waves that are left are

    R_m = C_m - b C'_m,    b = Re sum C'_m^* C_m / sum |C'_m|^2,

widened for the fitted b, and mean |R_m|^2 is the variance of the value over roads of the class (`paired`), mean
|R_m,a - R_m,b|^2 that of a difference. What the phases of this road add to the value of the twin,
`vehicle.runs.car.run_twin`, is known, p, and is stored as one more wave, of such a size that the intervals contain
+-1.96 p of a value and +-1.96 (p_a - p_b) of a difference.

Sources: Bendat and Piersol, Random Data, 4th ed., chapter 8; Heidelberger and Welch, Communications of the ACM 24
(1981): variance of a mean from the spectrum near zero frequency; Ripley, Stochastic Simulation (1987), section 5.3:
control variates.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from vehicle.signals.analysis.samples import Complex, Vector
from vehicle.signals.analysis.spectra import lines_of_band, record_lines

WAVES = 3
"""Number of stored C_m. They reach 3/T, 0.4 Hz for 8 s: about the half-power bandwidth of the modes from 2 Hz on. With
6 it is 0.75 Hz, and the error of a difference in records of 8 s is a third too small (`tests.benchmarks.coverage`)."""

NORMAL_95 = 1.96
"""Standard errors in half of a 95 % interval; its coverage is measured in `docs/theory/statistics.md`."""

STUDENT_95 = 2.446911851
"""The same for an error that is itself estimated with 2 `WAVES` degrees of freedom: t_0.975 with 6 of them."""

OF_PHASE = float(np.sqrt(WAVES)) * NORMAL_95 / STUDENT_95
"""Size of the wave of the phases over p."""

WIDENED = float(np.sqrt(6.0 / 5.0)) * 2.570581836 / STUDENT_95
"""Factor on waves from which one degree of freedom is taken by a fit, with t_0.975 of the 5 left: then `STUDENT_95`
fits them too."""

LEAST_EXPLAINED = 0.5
"""Minimum share of the scatter that the twin must explain. Below it, the run and its twin are two different cars, and
the error of the run alone counts."""


class Paired(NamedTuple):
    """Error of values of which the linear twin on the same road is known; (r,) each, waves (r, `WAVES` + 1).

    Attributes:
        error: standard error, see `wave_error`; of the run alone where the twin explains less than half.
        waves: waves R_m that the twin does not explain, and the phase wave.
        explained: share of the scatter that the twin explains, 1 - sum |R_m|^2 / sum |C_m|^2 [-]; NaN without a twin.
    """

    error: Vector
    waves: Complex
    explained: Vector


def wave_error(waves: Complex) -> Vector:
    """Return the standard error of values from their waves, (r, `WAVES` + 1), in the unit of the waves; (r,).

    The estimate has 2 `WAVES` degrees of freedom. It is widened, so that `NORMAL_95` errors are the half width of the
    95 % interval of Student's t.
    """
    return np.asarray(STUDENT_95 / NORMAL_95 * np.sqrt(np.sum(np.abs(waves) ** 2, axis=1) / WAVES))


def paired(error: Vector, waves: Complex, twin_waves: Complex, phase: Vector | float = 0.0) -> Paired:
    """Return the error of values with their linear twins, see `Paired`.

    Args:
        error: standard errors of r runs without twins; (r,).
        waves: C_m of the runs, the last 0; (r, WAVES + 1).
        twin_waves: C'_m of the twins, the last 0; 0 without a twin.
        phase: what the phases of this road add to the values of the twins; (r,).
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        factor = np.sum((twin_waves.conj() * waves).real, axis=1) / np.sum(np.abs(twin_waves) ** 2, axis=1)
        residual = waves - factor[:, None] * twin_waves
        explained = 1.0 - np.sum(np.abs(residual) ** 2, axis=1) / np.sum(np.abs(waves) ** 2, axis=1)
    defined = np.isfinite(explained)
    left = WIDENED * residual
    left[:, -1] = OF_PHASE * phase
    return Paired(
        error=np.where(defined & (explained >= LEAST_EXPLAINED), wave_error(left), error),
        waves=np.where(defined[:, None], left, waves),
        explained=explained,
    )


def weighted_lines(time_step: float, weighted: Vector, factors: Sequence[float]) -> Complex:
    """Return the lines of weighted records, of which an overall weighted RMS consists.

    Args:
        time_step: sampling interval [s].
        weighted: weighted accelerations in x, y, z [m/s2], (3, n).
        factors: multiplying factors k of the axes [-].

    Returns:
        Complex lines from the first to 0.8 of the Nyquist frequency, as all weightings end far below; (3, m).
    """
    count = weighted.shape[1]
    inside = lines_of_band(count, time_step, (1.0 / (count * time_step), 0.4 / time_step))
    # Axis by axis, which takes less memory.
    rows = (factor * row for factor, row in zip(factors, weighted, strict=True))
    return record_lines(rows, len(weighted), count, inside)


def overall_error(lines: Complex) -> Vector:
    """Return the normalised standard error of an overall RMS for a stationary Gaussian vibration.

    Args:
        lines: complex lines of the periodogram, |line|^2 = S df; (r, axes, m).

    Returns:
        sqrt(Var W) / (2 W) [-], 0 without vibration; (r,).
    """
    square = np.sum(np.abs(lines) ** 2, axis=(1, 2))
    # X_k^H X_(k+1), summed over the axes; (r, m - 1).
    products = np.sum(lines[:, :, :-1].conj() * lines[:, :, 1:], axis=1)
    variance = np.sum(np.abs(products) ** 2, axis=1)
    error: Vector = np.divide(np.sqrt(variance), 2.0 * square, out=np.zeros_like(square), where=square > 0.0)
    return error


def overall_waves(lines: Complex) -> Complex:
    """Return the slow variations C_m of an overall RMS, m = 1 to `WAVES`.

    Args:
        lines: complex lines of the periodogram, |line|^2 = S df; (r, axes, m).

    Returns:
        C_m [unit of the lines], 0 where the record has too few lines, and a 0 for the wave of the phases;
        (r, WAVES + 1).
    """
    rms = np.sqrt(np.sum(np.abs(lines) ** 2, axis=(1, 2)))
    waves = np.zeros((len(lines), WAVES + 1), dtype=np.complex128)
    for number in range(min(WAVES, lines.shape[2] - 1)):
        shift = number + 1
        waves[:, number] = np.sum(lines[:, :, :-shift].conj() * lines[:, :, shift:], axis=(1, 2))
    normalised: Complex = np.divide(waves, 2.0 * rms[:, None], out=np.zeros_like(waves), where=rms[:, None] > 0.0)
    return normalised


def power_waves(value: Vector, rows: Vector) -> Complex:
    """Return the slow variations of a fourth root of a mean of fourth powers, V = (c mean a^4)^(1/4), as in a dose.

    The Fourier lines q_m of sum a^4 over the channels take the place of C_m, with the factor dV/dq = V/(4 mean a^4).
    With a flat spectrum near 0 Hz each has the variance of V.

    Args:
        value: V; (r,).
        rows: histories a of all channels over the evaluated span; (r, channels, n).

    Returns:
        Waves, 0 at rest, and 0 for the phases; (r, WAVES + 1).
    """
    power = np.sum(rows**4, axis=1)
    lines = np.fft.rfft(power, axis=1)[:, : WAVES + 1]
    mean = lines[:, :1].real
    waves = np.divide(0.25 * value[:, None] * lines, mean, out=np.zeros_like(lines), where=mean > 0.0)
    return np.asarray(np.roll(waves, -1, axis=1) * np.array([1.0] * WAVES + [0.0]))


def difference_error(first: Complex, second: Complex) -> Vector:
    """Return the standard error of the difference of two overall RMS values on the same road.

    Args:
        first, second: C_m of both runs, see `overall_waves`; (..., WAVES + 1).

    Returns:
        Standard error with 2 `WAVES` degrees of freedom, in the unit of the C_m; (...).
    """
    return np.asarray(np.sqrt(np.sum(np.abs(first - second) ** 2, axis=-1) / WAVES))
