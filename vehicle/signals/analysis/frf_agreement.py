"""How well two frequency responses agree: over all lines, over all places at a line, and band by band.

Sources: W. Heylen and S. Lammens, FRAC: a consistent way of comparing frequency response functions, Proc. Int. Conf. on
Identification in Engineering Systems, Swansea 1996, 48-57; R. J. Allemang, The modal assurance criterion - twenty years
of use and abuse, Sound and Vibration 37 (2003), 14-23; E. Dascotte and J. Strobbe, Updating finite element models using
FRF correlation functions, Proc. IMAC XVII 1999, 1169-1174.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]

LARGEST_SCALE = 0.1
"""Largest |ln s| of the frequency-scaled form: resonances that lie a tenth apart are still taken for the same."""

LEAST_LINES = 3
"""Lines of a band below which no error of it is given."""


def frac(measured: npt.ArrayLike, simulated: npt.ArrayLike) -> float:
    """Frequency response assurance criterion over the lines where both are defined.

    FRAC = |sum H_m H_s*|^2 / (sum |H_m|^2 sum |H_s|^2): 1 for curves that differ by a constant factor alone.

    Args:
        measured, simulated: one response each on the same lines, (m,).

    Returns:
        [-]; NaN where no line is defined or one of them is zero.
    """
    top, bottom = np.asarray(measured, dtype=complex), np.asarray(simulated, dtype=complex)
    known = np.isfinite(top) & np.isfinite(bottom)
    top, bottom = top[known], bottom[known]
    power = np.sum(np.abs(top) ** 2) * np.sum(np.abs(bottom) ** 2)
    return float(np.abs(np.vdot(bottom, top)) ** 2 / power) if power > 0.0 else float("nan")


def scaled_frac(frequency: npt.ArrayLike, measured: npt.ArrayLike, simulated: npt.ArrayLike) -> tuple[float, float]:
    """FRAC of the simulated response on a stretched axis, H_s(f / s), for the s that makes it largest.

    It tells a car whose resonances are all high or low by one factor from one whose curve has another shape.

    Args:
        frequency: lines [Hz], (m,), rising.
        measured, simulated: as of `frac`.

    Returns:
        FRAC at the best s, and s [-]: above 1 where the measured resonances lie above the simulated ones.
    """
    lines = np.asarray(frequency, dtype=float)
    top, bottom = np.asarray(measured, dtype=complex), np.asarray(simulated, dtype=complex)
    known = np.isfinite(bottom)
    if not known.any():
        return float("nan"), 1.0

    def loss(logarithm: float) -> float:
        places = lines / np.exp(logarithm)
        moved = np.interp(places, lines[known], bottom[known], left=np.nan, right=np.nan)
        found = frac(top, moved)
        return 1.0 - found if np.isfinite(found) else 1.0

    grid = np.linspace(-LARGEST_SCALE, LARGEST_SCALE, 81)
    losses = [loss(one) for one in grid]
    place = int(np.argmin(losses))
    low, high = grid[max(place - 1, 0)], grid[min(place + 1, grid.size - 1)]
    fine = scipy.optimize.minimize_scalar(loss, bounds=(low, high), method="bounded", options={"xatol": 1e-5})
    best = min(((loss(0.0), 0.0), (losses[place], grid[place]), (float(fine.fun), float(fine.x))))
    return 1.0 - best[0], float(np.exp(best[1]))


def csac(measured: npt.ArrayLike, simulated: npt.ArrayLike) -> Vector:
    """Cross signature assurance criterion: agreement of the shape over all places, line by line.

    CSAC(f) = |H_m^H H_s|^2 / ((H_m^H H_m) (H_s^H H_s)), H the column of all responses at f.

    Args:
        measured, simulated: (places, m).

    Returns:
        (m,) [-]; NaN where one of them is undefined or zero.
    """
    product, upper, lower = _products(measured, simulated)
    found = np.full(upper.shape, np.nan)
    np.divide(np.abs(product) ** 2, upper * lower, out=found, where=upper * lower > 0.0)
    return found


def csf(measured: npt.ArrayLike, simulated: npt.ArrayLike) -> Vector:
    """Cross signature scale factor: agreement of shape and amplitude over all places, line by line.

    CSF(f) = 2 |H_m^H H_s| / (H_m^H H_m + H_s^H H_s).

    Args:
        measured, simulated: (places, m).

    Returns:
        (m,) [-]; NaN where one of them is undefined or both are zero.
    """
    product, upper, lower = _products(measured, simulated)
    found = np.full(upper.shape, np.nan)
    np.divide(2.0 * np.abs(product), upper + lower, out=found, where=upper + lower > 0.0)
    return found


def _products(measured: npt.ArrayLike, simulated: npt.ArrayLike) -> tuple[Complex, Vector, Vector]:
    """H_m^H H_s, H_m^H H_m and H_s^H H_s at each line."""
    top, bottom = np.atleast_2d(np.asarray(measured)), np.atleast_2d(np.asarray(simulated))
    return (
        np.sum(np.conj(top) * bottom, axis=0),
        np.sum(np.abs(top) ** 2, axis=0),
        np.sum(np.abs(bottom) ** 2, axis=0),
    )


def log_ratio(measured: npt.ArrayLike, model: npt.ArrayLike) -> Complex:
    """ln(H / Hm) = ln|H / Hm| + j arg(H / Hm), with the phase of the ratio between -pi and pi.

    The phase is that of one FRF relative to the other, so that the turns both have in common drop out. It is not
    unwrapped over frequency: one noisy point near pi would then add a whole turn to all points above it, and the sum of
    squares would jump, whereas the square of the principal value is continuous everywhere.

    Args:
        measured: H.
        model: Hm, same shape.

    Returns:
        The logarithm; NaN where either is undefined or zero.
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
        low, high: edges of the band [Hz]; the lower one is in it.
        lines: that count.
        weight: mean weight of the lines [-].
        error: root of the weighted mean of |ln(H_s / H_m)|^2 [-]: 0.1 is a tenth in magnitude, or 0.1 rad.
        magnitude_db: weighted mean of 20 lg|H_s / H_m| [dB]: positive where the simulated one is larger.
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
    """Errors of one response band by band, sum w |ln(H_s / H_m)|^2 / sum w.

    Args:
        frequency: lines [Hz], (m,).
        measured, simulated: (m,).
        weight: of the lines, as the product of both coherences, (m,) [-].
        bands: lower and upper edges [Hz].

    Returns:
        Those of the bands with `LEAST_LINES` lines or more of some weight.
    """
    lines, logarithm = np.asarray(frequency, dtype=float), log_ratio(simulated, measured)
    share = np.where(np.isfinite(logarithm), np.nan_to_num(np.asarray(weight, dtype=float)), 0.0)
    found = []
    for low, high in bands:
        inside = (lines >= low) & (lines < high) & (share > 0.0)
        if np.count_nonzero(inside) < LEAST_LINES:
            continue
        w, ratio = share[inside], logarithm[inside]
        decibel = 20.0 / np.log(10.0) * ratio.real
        found.append(
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
    return tuple(found)
