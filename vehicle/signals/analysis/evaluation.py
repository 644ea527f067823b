"""Evaluation of the vibration at one point of contact after ISO 2631-1 or BS 6841; what an offset does to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.exposure import (
    RunningAverage,
    crest_factor,
    estimated_vibration_dose_value,
    motion_sickness_dose_value,
    mtvv,
    vector_sum,
    vibration_dose_value,
    weighted_rms,
)
from vehicle.signals.analysis.samples import USABLE, checked_rows, checked_signals, checked_time_step, is_constant
from vehicle.signals.analysis.weighting import FULL_SAMPLING_RATE, weighted_record, weighting

AXES = ("x", "y", "z")
"""The basicentric axes; x and y are weighted alike, so the sign and the order of the horizontal axes do not matter,
except on a backrest, where x is fore and aft as in the frame of the car."""
MOTION_SICKNESS = "Wf"
"""Weighting of the motion sickness dose value. The standards define it vertically; on x and y it is given for
comparison only."""
MOTION_SICKNESS_PERIOD = 240.0
"""Least measurement from which a motion sickness dose value should be estimated [s] (ISO 2631-1:1997, D.1)"""
START_UP_EFFECT = 0.01
"""Share by which a maximum in the start-up of a filter must exceed those after it to be worth a sentence [-]"""
CLOCK_TOLERANCE = 1e-3
"""Error of a rate that is known from jittered times [-]."""
OFFSET_EFFECT = 0.01
"""Change of a weighted RMS or VDV by the offset above which someone must say what the offset is [-]."""
LARGEST_MEAN = 1.0
"""Mean acceleration that no ride keeps up: 20 s of it are 72 km/h [m/s2]"""


@dataclass(frozen=True, slots=True)
class Application:
    """Weightings and multiplying factors of one point of contact."""

    standard: str
    """standard and clause"""
    weightings: tuple[str, str, str]
    """for x, y, z"""
    comfort_factors: tuple[float, float, float]
    """multiplying factors k for comfort [-]"""
    health_factors: tuple[float, float, float] | None = None
    """multiplying factors k for health [-]; None where the standard gives none"""


_CLAUSE = "ISO 2631-1:1997, 8.2.2"
_SEAT, _BACKREST, _FEET = (1.0, 1.0, 1.0), (0.8, 0.5, 0.4), (0.25, 0.25, 0.4)  # k there
_ROTATION = f"{_CLAUSE}.1 (rx, ry, rz in rad/s2, factors in m/rad)"

APPLICATIONS: MappingProxyType[str, Application] = MappingProxyType(
    {
        "seat": Application("ISO 2631-1:1997, 7.2.3 and 8.2.2.1", ("Wd", "Wd", "Wk"), _SEAT, (1.4, 1.4, 1.0)),
        "backrest": Application(f"{_CLAUSE}.1", ("Wc", "Wd", "Wd"), _BACKREST),
        "feet": Application(f"{_CLAUSE}.1", ("Wk", "Wk", "Wk"), _FEET),
        "seat_rotation": Application(_ROTATION, ("We", "We", "We"), (0.63, 0.4, 0.2)),
        "standing": Application(f"{_CLAUSE}.2", ("Wd", "Wd", "Wk"), (1.0, 1.0, 1.0)),
        "seat_bs6841": Application("BS 6841:1987", ("Wd", "Wd", "Wb"), _SEAT),
        "backrest_bs6841": Application("BS 6841:1987", ("Wc", "Wd", "Wd"), _BACKREST),
        "feet_bs6841": Application("BS 6841:1987", ("Wb", "Wb", "Wb"), _FEET),
    }
)
"""Points of contact by name."""


def application(name: str) -> Application:
    """Return the point of contact of that name; raise `ConfigurationError` with the names that exist."""
    if name not in APPLICATIONS:
        raise ConfigurationError(f"point of contact: found {name!r}, allowed are {', '.join(APPLICATIONS)}")
    return APPLICATIONS[name]


@dataclass(frozen=True, kw_only=True, slots=True)
class _Span:
    """Which part of the weighted records counts."""

    time_step: float
    """[s]"""
    skip: float
    """[s] left out at the beginning"""
    from_rest: bool
    """whether the filters are settled from the first sample on"""

    def whole(self, weighted: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the record (n,) without the part left out."""
        return weighted[round(self.skip / self.time_step) :]

    def settled(self, weighted: NDArray[np.float64], name: str) -> NDArray[np.float64]:
        """Return the part of the record (n,) in which the filter has settled; empty if it never does."""
        settling = 0.0 if self.from_rest else weighting(name).settling_s
        return weighted[round(max(self.skip, settling) / self.time_step) :]


def _axis(
    span: _Span, record: NDArray[np.float64], name: str, factor: float, average: RunningAverage
) -> tuple[dict[str, Any], list[str]]:
    """Return the measures of one axis (n,) and what must be said about them."""
    step, sickness = span.time_step, _motion_sickness(span, record)
    response = weighted_record(step, record, name)
    weighted, settled = span.whole(response), span.settled(response, name)
    if not settled.size:
        raise DataError(
            f"acceleration: found {response.size * step:g} s, but weighting {name} settles in "
            f"{weighting(name).settling_s:g} s; give a longer record, or say that it starts at rest (--offset keep)"
        )
    duration = weighted.size * step
    rms = weighted_rms(weighted)
    dose = vibration_dose_value(step, weighted)
    transient = mtvv(step, settled, average=average)
    said = []
    if duration < weighting(name).shortest_record_s * (1.0 - 1e-9):
        said.append(
            f"{duration:g} s hold {duration * weighting(name).lowest_frequency:.1f} periods of "
            f"{weighting(name).lowest_frequency:g} Hz, where {name} begins; {weighting(name).shortest_record_s:.3g} s "
            "are needed to resolve it: take the values for this event alone, not for a ride"
        )
    peak, with_it = np.abs(settled).max(), np.abs(weighted).max()
    if rms > 0.0 and with_it > (1.0 + START_UP_EFFECT) * peak:
        said.append(
            f"MTVV and crest factor leave out the first {weighting(name).settling_s:g} s, in which {name} settles; "
            f"with them MTVV is {mtvv(step, weighted, average=average):.3g} instead of {transient:.3g} m/s2 and the "
            f"peak {with_it:.3g} instead of {peak:.3g} m/s2 (--offset keep for a record that starts at rest)"
        )
    values = {
        "weighting": name,
        "multiplying_factor": factor,
        "weighted_rms": rms,
        "mtvv": transient,
        "crest_factor": crest_factor(settled, rms),
        "vdv": dose,
        "estimated_vdv": estimated_vibration_dose_value(rms, duration),
        "msdv": sickness,
        "msdv_weighting": MOTION_SICKNESS,
        "mtvv_ratio": transient / rms if rms > 0.0 else None,
        "vdv_ratio": dose / (rms * duration**0.25) if rms > 0.0 else None,
    }
    return values, said


def _motion_sickness(span: _Span, record: NDArray[np.float64]) -> float | None:
    """Return MSDV of one axis (n,), from the settled part for the whole duration; None where the record is too short.

    MSDV = a_w T^(1/2) with a_w of the part after the filter has settled: method b of the standard. Of a record from
    rest all of it is settled, and this is method a, the integral.
    """
    weighted = weighted_record(span.time_step, record, MOTION_SICKNESS)
    duration = span.whole(weighted).size * span.time_step
    if duration < weighting(MOTION_SICKNESS).shortest_record_s * (1.0 - 1e-9):
        return None
    settled = span.settled(weighted, MOTION_SICKNESS)
    dose = motion_sickness_dose_value(span.time_step, settled)
    return float(dose * np.sqrt(duration / (settled.size * span.time_step)))


def _about_motion_sickness(duration: float) -> list[str]:
    """Return what must be said of the motion sickness dose value of a record of this duration [s]."""
    curve = weighting(MOTION_SICKNESS)
    if duration >= MOTION_SICKNESS_PERIOD * (1.0 - 1e-9):
        return []
    least = curve.shortest_record_s
    held = f"{duration:g} s hold {duration * curve.lowest_frequency:.1f} periods of {curve.lowest_frequency:g} Hz"
    if duration < least * (1.0 - 1e-9):
        return [f"msdv: {held}, at least {least:.3g} s are needed to resolve that frequency, so it is not given"]
    return [f"msdv: {held}; ISO 2631-1, D.1, asks for {MOTION_SICKNESS_PERIOD:g} s: a rough estimate"]


def evaluate(
    time_step: float,
    xyz: ArrayLike | Sequence[NDArray[np.float64]],
    *,
    place: str = "seat",
    average: RunningAverage = "linear",
    skip: float = 0.0,
    from_rest: bool = False,
    axes: Sequence[str] = AXES,
    highest: float | None = None,
) -> dict[str, Any]:
    """Evaluate the acceleration of one point: weighted RMS, MTVV, crest factor, VDV, MSDV and vector sums.

    The filters are at rest before the record. That is exact for a simulated one that starts at rest. A record cut out
    of a ride is switched on instead, and with it its mean and drift (a sensor's offset, gravity): a step, whose
    response must die away. So its maxima (MTVV, crest factor) and its MSDV are those after each filter has settled
    (3.5 s; Wf 17.5 s); RMS and VDV hold all of it, and `offset_effect` tells what the mean does to them.

    Args:
        time_step: [s].
        xyz: acceleration of the point in x, y, z [m/s2], shape (3, n), or one by one; only those of `axes`.
        place: name in `APPLICATIONS`: "seat" (z Wk, x and y Wd), "backrest", "feet", "standing", "seat_bs6841", ...
        average: of the running RMS in MTVV, "linear" or "exponential".
        skip: seconds of the weighted records left out at the beginning; the filters run through them.
        from_rest: the record starts at rest, so all of it counts.
        axes: measured axes, in the order x, y, z; all three by default.
        highest: highest frequency that the record holds [Hz]; 0.4 of its rate by default.

    Returns:
        {"place", "standard", "duration_s", "sampling_rate_hz", "highest_hz", "running_average",
         "x" | "y" | "z": {"weighting", "multiplying_factor", "weighted_rms", "mtvv", "crest_factor", "vdv",
                           "estimated_vdv", "msdv", "msdv_weighting", "mtvv_ratio", "vdv_ratio"},
         "vector_sum": {"weighted_rms", "vdv", "health_weighted_rms"}, "reasons": [...]}.
        The axes are without multiplying factors, the sums with them; `vdv` is summed in the fourth power. `mtvv_ratio`
        (MTVV / a_w) above 1.5 or `vdv_ratio` (VDV / (a_w T^(1/4))) above 1.75 mean that the RMS alone understates the
        shocks. A value that does not exist is None, and `reasons` says why: MSDV below 43.2 s, for instance. An axis
        that is not among `axes` is None, and then so are the sums. `highest_hz` is None from 80 Hz on, the range of
        the standard; below, vibration above it is in no value.

    Raises:
        DataError: not one signal for each axis, none of them moves, sampled below 25 Hz, not finite, over before the
            filters settle.
        ConfigurationError: unknown place or average, a skip that is negative, not finite or the whole record.

    Source: ISO 2631-1:1997, clauses 5.5 and 6 to 9, annex D; BS 6841:1987.
    """
    step = checked_time_step(time_step)
    use = application(place)
    rows = checked_rows("acceleration", xyz)
    if len(rows) != len(axes):
        raise DataError(f"acceleration: found {len(rows)} signals, needed are the axes {', '.join(axes)}")
    if not any(row.any() for row in rows):
        which = "all three axes are" if len(axes) == 3 else f"{' and '.join(axes)} is"
        raise DataError(f"acceleration: {which} zero throughout, so there is nothing to evaluate")
    if not 0.0 <= skip < (rows[0].size - 1) * step:
        raise ConfigurationError(
            f"skip: found {skip:g} s, allowed is 0 s to less than the record, {rows[0].size * step:g} s"
        )
    span = _Span(time_step=step, skip=skip, from_rest=from_rest)
    found: dict[str, Any] = dict.fromkeys(AXES)
    said = []
    of = dict(zip(AXES, zip(use.weightings, use.comfort_factors, strict=True), strict=True))
    for axis, record in zip(axes, rows, strict=True):
        found[axis], remarks = _axis(span, record, *of[axis], average)
        said += [f"{axis}: {remark}" for remark in remarks]
    duration = span.whole(rows[0]).size * step
    sums = _sums(found, use) if len(axes) == 3 else None
    reasons = [
        f"{axis}: zero throughout, so crest factor and ratios are undefined"
        for axis in axes
        if found[axis]["crest_factor"] is None
    ]
    reasons += said + _about_motion_sickness(duration)
    if sums is None:
        missing = [axis for axis in AXES if axis not in axes]
        reasons.append(f"{' and '.join(missing)}: not given, so there is no vector sum")
    band = USABLE / step if highest is None else min(highest, USABLE / step)
    limited = band < USABLE * FULL_SAMPLING_RATE * (1.0 - CLOCK_TOLERANCE)
    if limited:
        reasons.append(
            f"the record holds vibration up to {band:.4g} Hz; what lies above, to 80 Hz in ISO 2631-1, is in no value"
        )
    if use.health_factors is None:
        reasons.append(f"vector_sum.health_weighted_rms: the standard gives no health factors for {place}")
    return {
        "place": place,
        "standard": use.standard,
        "duration_s": duration,
        "sampling_rate_hz": 1.0 / step,
        "highest_hz": band if limited else None,
        "running_average": average,
        **found,
        "vector_sum": sums,
        "reasons": reasons,
    }


def _sums(found: dict[str, Any], use: Application) -> dict[str, float | None]:
    """Return the vector sums of the measures of three axes."""
    rms = [found[axis]["weighted_rms"] for axis in AXES]
    return {
        "weighted_rms": vector_sum(rms, use.comfort_factors),
        "vdv": vector_sum([found[axis]["vdv"] for axis in AXES], use.comfort_factors, power=4.0),
        "health_weighted_rms": None if use.health_factors is None else vector_sum(rms, use.health_factors),
    }


def offset_line(signals: ArrayLike) -> NDArray[np.float64]:
    """Return the straight line nearest to each of the signals (k, n): mean and drift, shape (k, n)."""
    array = checked_signals("acceleration", signals)
    count = np.arange(array.shape[1]) - 0.5 * (array.shape[1] - 1)
    slope = (array @ count) / max(float(count @ count), 1.0)
    line = array.mean(axis=1)[:, None] + slope[:, None] * count
    return np.where(is_constant(array)[:, None], array, line)


def without_offset(signals: ArrayLike) -> NDArray[np.float64]:
    """Return the signals (k, n) with mean and drift of each taken away; a constant one becomes exactly zero.

    Every weighting has a double zero at 0 Hz: once settled it does not see a straight line, so nothing of the vibration
    is lost.
    """
    array = checked_signals("acceleration", signals)
    return array - offset_line(array)


def offset_effect(
    time_step: float, xyz: ArrayLike, *, place: str = "seat", axes: Sequence[str] = AXES
) -> NDArray[np.float64]:
    """Return by how much mean and drift change weighted RMS or VDV, |with - without| / without, shape (k,).

    The larger of the two changes. The weighting filters are at rest before the record, so a mean is a step at its
    beginning; of a long record the VDV feels it longest. An axis that is nothing but an offset has an infinite effect,
    one that is zero none.

    Args:
        time_step: [s].
        xyz: acceleration [m/s2], shape (k, n).
        place: point of contact, which names the weightings.
        axes: k of x, y and z.
    """
    array = checked_signals("acceleration", xyz)
    effects = []
    names = [application(place).weightings[AXES.index(axis)] for axis in axes]
    for record, clean, name in zip(array, without_offset(array), names, strict=True):
        weighted = [weighted_record(time_step, signal, name) for signal in (record, clean)]
        kept, removed = (np.array([weighted_rms(w), vibration_dose_value(time_step, w)]) for w in weighted)
        # below 1e-12 of the record itself the rest is rounding
        if removed[0] > 1e-12 * float(np.abs(record).max()):
            effects.append(float(np.max(np.abs(kept - removed) / removed)))
        else:
            effects.append(np.inf if kept[0] > 0.0 else 0.0)
    return np.asarray(effects)
