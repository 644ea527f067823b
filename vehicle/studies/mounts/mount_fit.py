"""Fit of the laws of mounts to measured dynamic stiffness, by least squares of the logarithm.

    minimise  sum of |ln(K_law / K)|^2,    ln(K_law / K) = relative error of |K| + i error of the loss angle [rad],

over u = ln(parameter), from several starts, within the limits of the vehicle file and of the points (`limits_of`):
without them a part of a law that the points do not show may become rigid. The covariance of u is s^2 (J'J)^-1 with
s^2 = RSS/(2 m - p) at m points, so one standard error of u is the relative standard error of the value. The law with
the least

    BIC = 2 m ln(RSS/(2 m)) + p ln(2 m)

is chosen (Bayesian information criterion, Schwarz, Annals of Statistics 6 (1978)).
"""

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.arrays import Complex, Mask, Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.parameters.force_elements import SHORTEST_STROKE, Hydromount
from vehicle.studies.mounts.measured_stiffness import MeasuredStiffness, read_stiffness
from vehicle.studies.mounts.mount_laws import LAWS, MountLaw, Stiffness

WIDEST = float(np.log(1e6))
"""Maximum distance of ln(parameter) from its start."""

SOFTEST = 0.2
"""Minimum static stiffness over the smallest measured one: rubber is less than five times stiffer in vibration."""

STIFFEST = 30.0
"""Maximum ratio at which a part of a law still changes K visibly: a spring 30 times stiffer is rigid within 3 %."""

SEEN = 5.0
"""Maximum ratio of the friction stroke to the largest amplitude, and of the smallest amplitude to this stroke."""

DETERMINED = 0.5
"""Maximum relative standard error of a parameter that the points determine."""

REFINED = 2
"""Number of fits of an approximation that are continued."""

FLOOR = 1e-12
"""Minimum mean square of the residuals in the criterion: below it are the errors of the arithmetic."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MountFit:
    """A law fitted to measured points.

    Attributes:
        law: the law.
        values: parameters in the order of `law.parameters`, SI units; (p,).
        errors: standard errors of `values`; infinite if the points do not determine a parameter; (p,).
        criterion: BIC; smaller is better.
        stiffness_error: RMS and maximum of the relative error of |K| [-]; (2,).
        angle_error: RMS and maximum of the error of the loss angle [rad]; (2,).
    """

    law: MountLaw
    values: Vector
    errors: Vector
    criterion: float
    stiffness_error: Vector
    angle_error: Vector

    def stiffness(self, frequency: npt.ArrayLike, amplitude: npt.ArrayLike) -> Complex:
        """Return K [N/m] at frequencies [Hz] and peak amplitudes [m]."""
        omega = 2.0 * np.pi * np.asarray(frequency, dtype=float)
        return self.law.stiffness(self.values, *np.broadcast_arrays(omega, np.asarray(amplitude, dtype=float)))

    @property
    def determined(self) -> Mask:
        """True for the parameters with a relative standard error of at most `DETERMINED`; (p,)."""
        return np.asarray(self.errors <= DETERMINED * self.values)


def limits_of(data: MeasuredStiffness, law: MountLaw) -> tuple[Vector, Vector]:
    """Return the lowest and highest values of the parameters of a law, in their order; both (p,)."""
    size, omega = np.abs(data.stiffness), 2.0 * np.pi * data.frequency
    of_points = {
        "stiffness": (SOFTEST * np.min(size), np.inf),
        "maxwell_stiffness": (0.0, STIFFEST * np.max(size)),
        "maxwell_damping": (0.0, STIFFEST * np.max(size) / np.min(omega)),
        "friction_stroke": (max(np.min(data.amplitude) / SEEN, SHORTEST_STROKE), np.max(data.amplitude) * SEEN),
    }
    of_file = {field.name: field.metadata for field in dataclasses.fields(Hydromount)}
    limits = []
    for name in law.parameters:
        lower, upper = of_points.get(name, (0.0, np.inf))
        limits.append((max(lower, of_file[name]["at_least"] or 0.0), min(upper, of_file[name]["at_most"] or np.inf)))
    low, high = np.array(limits).T
    return low, high


def fit_law(data: MeasuredStiffness, law: MountLaw) -> MountFit:
    """Fit a law by least squares of ln(S/S_measured), real part (stiffness) and imaginary part (loss angle) alike.

    Args:
        data: measured points of the complex dynamic stiffness S [N/m].

    Returns:
        Parameters with standard errors, BIC, and errors of stiffness and loss angle: best fit of all start values.
    """
    with np.errstate(divide="ignore"):
        low, high = (np.log(limit) for limit in limits_of(data, law))
    omega, amplitude, measured = 2.0 * np.pi * data.frequency, data.amplitude, data.stiffness

    def fit(stiffness: Stiffness, start: Vector, tolerance: float = 1e-12, evaluations: int | None = None) -> Any:
        def residuals(logarithms: Vector) -> Vector:
            error = np.log(stiffness(np.exp(logarithms), omega, amplitude) / measured)
            return np.concatenate([error.real, error.imag])

        start = np.clip(start, low, high)
        bounds = np.maximum(start - WIDEST, low), np.minimum(start + WIDEST, high)
        limits = dict.fromkeys(("xtol", "ftol", "gtol"), tolerance)
        with np.errstate(over="ignore", invalid="ignore"):
            return scipy.optimize.least_squares(residuals, start, bounds=bounds, max_nfev=evaluations, **limits)

    starts = np.log(law.starts(omega, amplitude, measured))
    if law.approximation and law.refined:
        rough = [fit(law.approximation, start, 1e-4, 20) for start in starts]
        rough.sort(key=lambda each: each.cost)
        fits = [fit(law.refined(), each.x, 1e-7, 50) for each in rough[:REFINED]]
    else:
        fits = [fit(law.stiffness, start) for start in starts]
    best = min(fits, key=lambda each: each.cost)
    count, size = len(best.fun), len(best.x)
    squares = 2.0 * float(best.cost)
    _, singular, directions = np.linalg.svd(best.jac, full_matrices=False)
    spread = directions.T / np.maximum(singular, 1e-9 * singular[0])
    relative = np.sqrt(squares / max(count - size, 1) * np.sum(spread**2, axis=1))
    error = best.fun.reshape(2, -1)
    rms, largest = np.sqrt(np.mean(error**2, axis=1)), np.max(np.abs(error), axis=1)
    return MountFit(
        law=law,
        values=np.exp(best.x),
        errors=np.exp(best.x) * relative,
        criterion=count * float(np.log(max(squares / count, FLOOR))) + size * float(np.log(count)),
        stiffness_error=np.array([rms[0], largest[0]]),
        angle_error=np.array([rms[1], largest[1]]),
    )


def fit_mount(points: MeasuredStiffness | str | PathLike[str], laws: Sequence[str] | None = None) -> list[MountFit]:
    """Fit laws of a mount to measured dynamic stiffness and loss angle, and sort them by BIC, the best law first.

    Args:
        points: table of the points, or the points themselves, see `read_stiffness`.
        laws: names of laws in `LAWS`; all by default, "decoupler" for two amplitudes or more.

    Returns:
        The fits; `fits[0].values` are the parameters of the best law in the order of `fits[0].law.parameters`.

    Raises:
        ConfigurationError: an unknown law, or the file does not exist.
        DataError: a bad table, or one amplitude for the law "decoupler".
    """
    data = points if isinstance(points, MeasuredStiffness) else read_stiffness(Path(points))
    unknown = [name for name in laws or () if name not in LAWS]
    if unknown:
        raise ConfigurationError(f"law {unknown[0]!r}: must be {', '.join(LAWS)}")
    several = len(data.levels()) > 1
    if laws and "decoupler" in laws and not several:
        raise DataError(
            "law 'decoupler': found points at a single amplitude, must be at least two; measure within and "
            "beyond the gap of the decoupler"
        )
    chosen = laws or [name for name in LAWS if several or name != "decoupler"]
    return sorted((fit_law(data, LAWS[name]) for name in chosen), key=lambda fit: fit.criterion)
