"""Comfort of a vibration that repeats after the evaluated span, from its lines: no time record and no filter.

In the steady state the weighted vibration has the lines H(f_k) X_k, with the complex weighting H, so that

    W^2 = sum |H X_k|^2,    C_m = sum (H X_k)^H (H X_(k+m)) / (2 W)

are what the periodogram of a record of one period gives (`vehicle.signals.analysis.comfort_error`). The filter of a run
starts at rest before the evaluated span, so its record still contains the decay of the filter.
"""

from collections.abc import Collection

import numpy as np

from vehicle.names import AXES
from vehicle.signals.analysis.comfort_error import overall_waves
from vehicle.signals.analysis.evaluation import application
from vehicle.signals.analysis.ride_comfort import SEAT_PREFIX, UNWEIGHTED, WEIGHTED, wave_columns
from vehicle.signals.analysis.samples import Complex, Vector, band_shares
from vehicle.signals.analysis.weighting import weighting


def comfort_lines(
    frequency: Vector,
    rail: Complex,
    cushion: Complex | None = None,
    *,
    band: tuple[float, float],
    names: Collection[str] = (UNWEIGHTED, WEIGHTED),
    contact: str = "seat",
    axes: bool = False,
) -> dict[str, Vector]:
    """Return overall comfort values and their `wave_names` under the names of `comfort_columns`; (r,) each.

    Args:
        frequency: lines [Hz]; (m,).
        rail: lines of the accelerations of the seat rail in x, y, z, |line|^2 = S df; (r, 3, m).
        cushion: lines on the cushion, (r, 3, m); None for a car without a seat.
        band, names, contact: see `ride_comfort.comfort_columns`.
        axes: add the values and waves of each axis.
    """
    columns = _point(frequency, rail, band, names, contact, axes)
    if cushion is not None:
        on_seat = _point(frequency, cushion, band, names, "seat", axes)
        columns |= {f"{SEAT_PREFIX}{name}": values for name, values in on_seat.items()}
    return columns


def _point(
    frequency: Vector, lines: Complex, band: tuple[float, float], names: Collection[str], contact: str, axes: bool
) -> dict[str, Vector]:
    """Return the values at one point."""
    columns: dict[str, Vector] = {}
    if UNWEIGHTED in names:
        columns |= _overall(UNWEIGHTED, lines_of_share(frequency, lines, band), (1.0, 1.0, 1.0), axes)
    if WEIGHTED in names:
        used = application(contact)
        curves = np.stack([weighting(name).transfer_function(frequency) for name in used.weightings])
        columns |= _overall(WEIGHTED, curves * lines, used.comfort_factors, axes)
    return columns


def lines_of_share(frequency: Vector, lines: Complex, band: tuple[float, float]) -> Complex:
    """Return the lines in a band, (..., m), those at its edges with the root of their share of the power."""
    shares = band_shares(frequency, float(frequency[1] - frequency[0]), band)
    return np.asarray(lines[..., shares > 0.0] * np.sqrt(shares[shares > 0.0]))


def _overall(name: str, lines: Complex, factors: tuple[float, float, float], axes: bool) -> dict[str, Vector]:
    """Return the RMS and the waves of all axes, with their factors, and of each axis without one."""
    every = {name: np.array(factors)[:, None] * lines}
    if axes:
        every |= {f"{name}_{axis}": lines[:, number : number + 1] for number, axis in enumerate(AXES)}
    columns: dict[str, Vector] = {}
    for column, each in every.items():
        columns[column] = np.sqrt(np.sum(np.abs(each) ** 2, axis=(1, 2)))
        columns |= wave_columns(column, overall_waves(each))
    return columns
