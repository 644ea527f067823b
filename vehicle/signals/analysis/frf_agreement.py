"""Agreement of measured and simulated FRFs: over all lines, over all points at a line, and by band.

Sources: W. Heylen and S. Lammens, FRAC: a consistent way of comparing frequency response functions, Proc. Int. Conf. on
Identification in Engineering Systems, Swansea 1996, 48-57; R. J. Allemang, The modal assurance criterion - twenty years
of use and abuse, Sound and Vibration 37 (2003), 14-23; E. Dascotte and J. Strobbe, Updating finite element models using
FRF correlation functions, Proc. IMAC XVII 1999, 1169-1174.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.signals.analysis.samples import Complex, Vector

LARGEST_SCALE = 0.1
"""Maximum |ln s| of the frequency scale: resonances up to a tenth apart are matched."""

LEAST_LINES = 3
"""Minimum lines of a band for an error."""


def frac(measured: npt.ArrayLike, simulated: npt.ArrayLike) -> float:
    """Return the frequency response assurance criterion over the lines where both FRFs are defined.

    FRAC = |sum H_m H_s*|^2 / (sum |H_m|^2 sum |H_s|^2): 1 for curves that differ only by a constant factor.

    Args:
        measured, simulated: FRFs on the same lines, (m,).

    Returns:
        FRAC [-]; NaN if no line is defined or an FRF is zero.
    """
    top, bottom = np.asarray(measured, dtype=complex), np.asarray(simulated, dtype=complex)
    defined = np.isfinite(top) & np.isfinite(bottom)
    top, bottom = top[defined], bottom[defined]
    power = np.sum(np.abs(top) ** 2) * np.sum(np.abs(bottom) ** 2)
    return float(np.abs(np.vdot(bottom, top)) ** 2 / power) if power > 0.0 else float("nan")


def scaled_frac(frequency: npt.ArrayLike, measured: npt.ArrayLike, simulated: npt.ArrayLike) -> tuple[float, float]:
    """Return the maximum FRAC over a scaling s of the frequency axis of the simulated FRF, H_s(f / s).

    The scale separates a car whose resonances are all shifted by a common factor from a car with another curve shape.

    Args:
        frequency: increasing lines [Hz], (m,).
        measured, simulated: FRFs on these lines, (m,).

    Returns:
        FRAC at the best s, and s [-]: above 1 if the measured resonances are higher than the simulated resonances.
    """
    lines = np.asarray(frequency, dtype=float)
    top, bottom = np.asarray(measured, dtype=complex), np.asarray(simulated, dtype=complex)
    defined = np.isfinite(bottom)
    if not defined.any():
        return float("nan"), 1.0

    def loss(logarithm: float) -> float:
        scaled_lines = lines / np.exp(logarithm)
        # H_s(f/s), linear between the lines; no value outside the record.
        scaled = np.interp(scaled_lines, lines[defined], bottom[defined], left=np.nan, right=np.nan)
        agreement = frac(top, scaled)
        return 1.0 - agreement if np.isfinite(agreement) else 1.0

    # FRAC has several maxima over the scale: a coarse search first, then a fine search around the best value.
    grid = np.linspace(-LARGEST_SCALE, LARGEST_SCALE, 81)
    losses = [loss(logarithm) for logarithm in grid]
    index = int(np.argmin(losses))
    low, high = grid[max(index - 1, 0)], grid[min(index + 1, grid.size - 1)]
    fine = scipy.optimize.minimize_scalar(loss, bounds=(low, high), method="bounded", options={"xatol": 1e-5})
    best = min(((loss(0.0), 0.0), (losses[index], grid[index]), (float(fine.fun), float(fine.x))))
    return 1.0 - best[0], float(np.exp(best[1]))


def csac(measured: npt.ArrayLike, simulated: npt.ArrayLike) -> Vector:
    """Return the cross signature assurance criterion: agreement of the shape over all points at each line.

    CSAC(f) = |H_m^H H_s|^2 / ((H_m^H H_m) (H_s^H H_s)), H the column of all responses at f.

    Args:
        measured, simulated: FRFs, (points, m).

    Returns:
        CSAC [-], (m,); NaN where an FRF is undefined or zero.
    """
    product, upper, lower = _products(measured, simulated)
    agreement = np.full(upper.shape, np.nan)
    np.divide(np.abs(product) ** 2, upper * lower, out=agreement, where=upper * lower > 0.0)
    return agreement


def csf(measured: npt.ArrayLike, simulated: npt.ArrayLike) -> Vector:
    """Return the cross signature scale factor: agreement of shape and amplitude over all points at each line.

    CSF(f) = 2 |H_m^H H_s| / (H_m^H H_m + H_s^H H_s).

    Args:
        measured, simulated: FRFs, (points, m).

    Returns:
        CSF [-], (m,); NaN where an FRF is undefined or both are zero.
    """
    product, upper, lower = _products(measured, simulated)
    agreement = np.full(upper.shape, np.nan)
    np.divide(2.0 * np.abs(product), upper + lower, out=agreement, where=upper + lower > 0.0)
    return agreement


def _products(measured: npt.ArrayLike, simulated: npt.ArrayLike) -> tuple[Complex, Vector, Vector]:
    """Return H_m^H H_s, H_m^H H_m and H_s^H H_s at each line."""
    top, bottom = np.atleast_2d(np.asarray(measured)), np.atleast_2d(np.asarray(simulated))
    return (
        np.sum(np.conj(top) * bottom, axis=0),
        np.sum(np.abs(top) ** 2, axis=0),
        np.sum(np.abs(bottom) ** 2, axis=0),
    )


def log_ratio(measured: npt.ArrayLike, model: npt.ArrayLike) -> Complex:
    """Return ln(H / Hm) = ln|H / Hm| + j arg(H / Hm), with the phase of the ratio between -pi and pi.

    Turns of the phase common to both FRFs cancel in the ratio. The phase is not unwrapped over frequency: a noisy line
    near pi would then add 2 pi to all lines above it, and the sum of squares would jump, whereas the square of the
    principal value is continuous.

    Args:
        measured: measured FRF H.
        model: FRF Hm of the model, shape as H.

    Returns:
        Complex logarithm; NaN where H or Hm is undefined or zero.
    """
    top, bottom = np.asarray(measured, dtype=complex), np.asarray(model, dtype=complex)
    fine = np.isfinite(top) & np.isfinite(bottom) & (top != 0.0) & (bottom != 0.0)
    ratio = np.full(top.shape, complex(np.nan, np.nan))
    np.divide(top, bottom, out=ratio, where=fine)
    logarithm = np.full(top.shape, complex(np.nan, np.nan))
    np.log(ratio, out=logarithm, where=fine)
    return logarithm


@dataclass(frozen=True, kw_only=True, slots=True)
class BandError:
    """Disagreement of two responses in a band, weighted by the coherence.

    Attributes:
        low, high: edges of the band [Hz]; the lower edge is included.
        lines: number of evaluated lines.
        weight: mean weight of the lines [-].
        error: root of the weighted mean of |ln(H_s / H_m)|^2 [-]: 0.1 is a tenth in magnitude, or 0.1 rad.
        magnitude_db: weighted mean of 20 lg|H_s / H_m| [dB]: positive if the simulated FRF is larger.
        magnitude_rms_db: root of its weighted mean square [dB].
        phase_deg: root of the weighted mean square of the phase of H_s / H_m [deg].
    """

    low: float
    high: float
    lines: int
    weight: float
    error: float
    magnitude_db: float
    magnitude_rms_db: float
    phase_deg: float


def band_errors(
    frequency: npt.ArrayLike,
    measured: npt.ArrayLike,
    simulated: npt.ArrayLike,
    weight: npt.ArrayLike,
    bands: Sequence[tuple[float, float]],
) -> tuple[BandError, ...]:
    """Return the errors of a response by band, sum w |ln(H_s / H_m)|^2 / sum w.

    Args:
        frequency: lines [Hz], (m,).
        measured, simulated: FRFs, (m,).
        weight: weights of the lines, for example the product of both coherences, (m,) [-].
        bands: lower and upper edges [Hz].

    Returns:
        Errors of the bands with at least `LEAST_LINES` lines of positive weight.
    """
    lines, logarithm = np.asarray(frequency, dtype=float), log_ratio(simulated, measured)
    share = np.where(np.isfinite(logarithm), np.nan_to_num(np.asarray(weight, dtype=float)), 0.0)
    errors = []
    for low, high in bands:
        inside = (lines >= low) & (lines < high) & (share > 0.0)
        if np.count_nonzero(inside) < LEAST_LINES:
            continue
        w, ratio = share[inside], logarithm[inside]
        # 20 lg|r| = 20/ln(10) ln|r|.
        decibel = 20.0 / np.log(10.0) * ratio.real
        errors.append(
            BandError(
                low=low,
                high=high,
                lines=int(np.count_nonzero(inside)),
                weight=float(np.mean(w)),
                error=float(np.sqrt(np.average(np.abs(ratio) ** 2, weights=w))),
                magnitude_db=float(np.average(decibel, weights=w)),
                magnitude_rms_db=float(np.sqrt(np.average(decibel**2, weights=w))),
                phase_deg=float(np.degrees(np.sqrt(np.average(ratio.imag**2, weights=w)))),
            )
        )
    return tuple(errors)
