"""Evaluation of the vibration at one point of contact after ISO 2631-1 or BS 6841."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vehicle.analysis.exposure import (
    RunningAverage,
    crest_factor,
    estimated_vibration_dose_value,
    motion_sickness_dose_value,
    mtvv,
    vector_sum,
    vibration_dose_value,
    weighted_rms,
)
from vehicle.analysis.samples import checked_signals, checked_time_step
from vehicle.analysis.weighting import weighted_record
from vehicle.errors import ConfigurationError, DataError

AXES = ("x", "y", "z")
"""The basicentric axes; x and y are weighted alike, so the sign and the order of the horizontal axes do not matter,
except on a backrest, where x is fore and aft as in the frame of the car."""
MOTION_SICKNESS = "Wf"
"""Weighting of the motion sickness dose value. The standards define it vertically; on x and y it is given for
comparison only."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Application:
    """Weightings and multiplying factors of one point of contact."""

    standard: str
    """standard and clause"""
    weightings: tuple[str, str, str]
    """for x, y, z"""
    comfort_factors: tuple[float, float, float]
    """multiplying factors k for comfort [-]"""
    health_factors: tuple[float, float, float] | None
    """multiplying factors k for health [-]; None where the standard gives none"""


APPLICATIONS: MappingProxyType[str, Application] = MappingProxyType(
    {
        "seat": Application(
            standard="ISO 2631-1:1997, 7.2.3 and 8.2.2.1",
            weightings=("Wd", "Wd", "Wk"),
            comfort_factors=(1.0, 1.0, 1.0),
            health_factors=(1.4, 1.4, 1.0),
        ),
        "backrest": Application(
            standard="ISO 2631-1:1997, 8.2.2.1",
            weightings=("Wc", "Wd", "Wd"),
            comfort_factors=(0.8, 0.5, 0.4),
            health_factors=None,
        ),
        "feet": Application(
            standard="ISO 2631-1:1997, 8.2.2.1",
            weightings=("Wk", "Wk", "Wk"),
            comfort_factors=(0.25, 0.25, 0.4),
            health_factors=None,
        ),
        "seat_rotation": Application(
            standard="ISO 2631-1:1997, 8.2.2.1 (rx, ry, rz in rad/s2, factors in m/rad)",
            weightings=("We", "We", "We"),
            comfort_factors=(0.63, 0.4, 0.2),
            health_factors=None,
        ),
        "standing": Application(
            standard="ISO 2631-1:1997, 8.2.2.2",
            weightings=("Wd", "Wd", "Wk"),
            comfort_factors=(1.0, 1.0, 1.0),
            health_factors=None,
        ),
        "seat_bs6841": Application(
            standard="BS 6841:1987",
            weightings=("Wd", "Wd", "Wb"),
            comfort_factors=(1.0, 1.0, 1.0),
            health_factors=None,
        ),
        "backrest_bs6841": Application(
            standard="BS 6841:1987",
            weightings=("Wc", "Wd", "Wd"),
            comfort_factors=(0.8, 0.5, 0.4),
            health_factors=None,
        ),
        "feet_bs6841": Application(
            standard="BS 6841:1987",
            weightings=("Wb", "Wb", "Wb"),
            comfort_factors=(0.25, 0.25, 0.4),
            health_factors=None,
        ),
    }
)
"""Points of contact by name."""


def application(name: str) -> Application:
    """Return the point of contact of that name; raise `ConfigurationError` with the names that exist."""
    if name not in APPLICATIONS:
        raise ConfigurationError(f"point of contact: found {name!r}, allowed are {', '.join(APPLICATIONS)}")
    return APPLICATIONS[name]


def _axis(
    time_step: float, record: NDArray[np.float64], name: str, factor: float, average: RunningAverage
) -> dict[str, Any]:
    """Return the measures of one axis (n,)."""
    weighted = weighted_record(time_step, record, name)
    duration = record.size * time_step
    rms = weighted_rms(weighted)
    dose = vibration_dose_value(time_step, weighted)
    transient = mtvv(time_step, weighted, average=average)
    return {
        "weighting": name,
        "multiplying_factor": factor,
        "weighted_rms": rms,
        "mtvv": transient,
        "crest_factor": crest_factor(weighted),
        "vdv": dose,
        "estimated_vdv": estimated_vibration_dose_value(rms, duration),
        "msdv": motion_sickness_dose_value(time_step, weighted_record(time_step, record, MOTION_SICKNESS)),
        "msdv_weighting": MOTION_SICKNESS,
        "mtvv_ratio": transient / rms if rms > 0.0 else None,
        "vdv_ratio": dose / (rms * duration**0.25) if rms > 0.0 else None,
    }


def evaluate(
    time_step: float,
    xyz: ArrayLike,
    *,
    place: str = "seat",
    average: RunningAverage = "linear",
) -> dict[str, Any]:
    """Evaluate the acceleration of one point: weighted RMS, MTVV, crest factor, VDV, MSDV and vector sums.

    The filters are at rest before the record, so a constant offset acts as a step: remove the mean of a measured
    record first (a sensor's offset, gravity), leave a simulated one that starts at rest as it is.

    Args:
        time_step: [s].
        xyz: acceleration of the point in x, y, z [m/s2], shape (3, n).
        place: name in `APPLICATIONS`: "seat" (z Wk, x and y Wd), "backrest", "feet", "standing", "seat_bs6841", ...
        average: of the running RMS in MTVV, "linear" or "exponential".

    Returns:
        {"place", "standard", "duration_s", "sampling_rate_hz", "running_average",
         "x" | "y" | "z": {"weighting", "multiplying_factor", "weighted_rms", "mtvv", "crest_factor", "vdv",
                           "estimated_vdv", "msdv", "msdv_weighting", "mtvv_ratio", "vdv_ratio"},
         "vector_sum": {"weighted_rms", "vdv", "health_weighted_rms"}, "reasons": [...]}.
        The axes are without multiplying factors, the sums with them; `vdv` is summed in the fourth power. `mtvv_ratio`
        (MTVV / a_w) above 1.5 or `vdv_ratio` (VDV / (a_w T^(1/4))) above 1.75 mean that the RMS alone understates the
        shocks. A value that does not exist is None, and `reasons` says why.

    Raises:
        DataError: not three axes, none of them moves, sampled below 250 Hz, not finite.
        ConfigurationError: unknown place or average.

    Source: ISO 2631-1:1997, clauses 6 to 8; BS 6841:1987.
    """
    step = checked_time_step(time_step)
    use = application(place)
    array = checked_signals("acceleration", xyz)
    if array.shape[0] != 3:
        raise DataError(f"acceleration: found {array.shape[0]} signals, needed are the three axes x, y, z")
    if not array.any():
        raise DataError("acceleration: all three axes are zero throughout, so there is nothing to evaluate")
    axes = {
        axis: _axis(step, record, name, factor, average)
        for axis, record, name, factor in zip(AXES, array, use.weightings, use.comfort_factors, strict=True)
    }
    rms = [axes[axis]["weighted_rms"] for axis in AXES]
    sums: dict[str, float | None] = {
        "weighted_rms": vector_sum(rms, use.comfort_factors),
        "vdv": vector_sum([axes[axis]["vdv"] for axis in AXES], use.comfort_factors, power=4.0),
        "health_weighted_rms": None if use.health_factors is None else vector_sum(rms, use.health_factors),
    }
    reasons = [
        f"{axis}: zero throughout, so crest factor and ratios are undefined"
        for axis in AXES
        if axes[axis]["crest_factor"] is None
    ]
    if use.health_factors is None:
        reasons.append(f"vector_sum.health_weighted_rms: the standard gives no health factors for {place}")
    return {
        "place": place,
        "standard": use.standard,
        "duration_s": array.shape[1] * step,
        "sampling_rate_hz": 1.0 / step,
        "running_average": average,
        **axes,
        "vector_sum": sums,
        "reasons": reasons,
    }
