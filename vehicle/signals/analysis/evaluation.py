"""Vibration at a point of contact after ISO 2631-1, BS 6841, ISO 5349-1, EN 12299 or Giacomin; effect of an offset."""

from collections.abc import Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis import rail_comfort
from vehicle.signals.analysis.contact_vibration import AxisVibration, ContactVibration, VibrationSums
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
from vehicle.signals.analysis.samples import (
    USABLE,
    Vector,
    checked_rows,
    checked_signals,
    checked_time_step,
    is_constant,
)
from vehicle.signals.analysis.weighting import weighted_record, weighting

AXES = ("x", "y", "z")
"""Basicentric axes. The weightings of x and y are equal, so sign and order of the horizontal axes have no effect except
on a backrest, where x is fore and aft as in the vehicle frame."""
MOTION_SICKNESS = "Wf"
"""Weighting of the motion sickness dose value. The standards define it for z; the values of x and y are for
comparison only."""
MOTION_SICKNESS_PERIOD = 240.0
"""Minimum length of a measurement for a motion sickness dose value [s] (ISO 2631-1:1997, D.1)."""
START_UP_EFFECT = 0.01
"""Minimum relative excess of the maximum during the settling of a filter over the later maximum, for a notice [-]."""
CLOCK_TOLERANCE = 1e-3
"""Maximum relative error of a sampling rate computed from times with jitter [-]."""
OFFSET_EFFECT = 0.01
"""Maximum relative change of a weighted RMS or VDV by the offset; above it the user must choose a treatment [-]."""
LARGEST_MEAN = 1.0
"""Maximum mean acceleration of a ride [m/s2]; 20 s at this value change the speed by 72 km/h."""


@dataclass(frozen=True, slots=True)
class Application:
    """Weightings and multiplying factors of a point of contact."""

    standard: str
    """standard and clause"""
    weightings: tuple[str, str, str]
    """weightings for x, y, z"""
    comfort_factors: tuple[float, float, float]
    """multiplying factors k for comfort [-]"""
    health_factors: tuple[float, float, float] | None = None
    """multiplying factors k for health [-]; None if the standard has no such factors"""
    doses: bool = True
    """False for a standard without dose values"""


HEALTH = (1.4, 1.4, 1.0)
"""Factors of x, y and z for the health of a seated person [-] (ISO 2631-1:1997, 7.2.3; Directive 2002/44/EC)."""

_CLAUSE = "ISO 2631-1:1997, 8.2.2"
_SEAT, _BACKREST, _FEET = (1.0, 1.0, 1.0), (0.8, 0.5, 0.4), (0.25, 0.25, 0.4)  # k there
_ROTATION = f"{_CLAUSE}.1 (rotations rx, ry, rz: accelerations in rad/s2, factors in m/rad)"

APPLICATIONS: MappingProxyType[str, Application] = MappingProxyType(
    {
        "seat": Application("ISO 2631-1:1997, 7.2.3 and 8.2.2.1", ("Wd", "Wd", "Wk"), _SEAT, HEALTH),
        "backrest": Application(f"{_CLAUSE}.1", ("Wc", "Wd", "Wd"), _BACKREST),
        "feet": Application(f"{_CLAUSE}.1", ("Wk", "Wk", "Wk"), _FEET),
        "seat_rotation": Application(_ROTATION, ("We", "We", "We"), (0.63, 0.4, 0.2)),
        "standing": Application(f"{_CLAUSE}.2", ("Wd", "Wd", "Wk"), (1.0, 1.0, 1.0)),
        "seat_bs6841": Application("BS 6841:1987", ("Wd", "Wd", "Wb"), _SEAT),
        "backrest_bs6841": Application("BS 6841:1987", ("Wc", "Wd", "Wd"), _BACKREST),
        "hand": Application("ISO 5349-1:2001", ("Wh", "Wh", "Wh"), _SEAT, doses=False),
        "steering_wheel": Application("Giacomin et al. 2004", ("Ws", "Ws", "Ws"), _SEAT, doses=False),
        "train_floor": Application("EN 12299:2009", rail_comfort.WEIGHTINGS, _SEAT),
        "feet_bs6841": Application("BS 6841:1987", ("Wb", "Wb", "Wb"), _FEET),
    }
)
"""Points of contact by name."""


def application(name: str) -> Application:
    """Return the weightings and factors of a point of contact; raise `ConfigurationError` for an unknown name."""
    if name not in APPLICATIONS:
        raise ConfigurationError(f"point of contact: must be one of {', '.join(APPLICATIONS)}, not {name!r}")
    return APPLICATIONS[name]


@dataclass(frozen=True, kw_only=True, slots=True)
class _Span:
    """Evaluated part of the weighted records."""

    time_step: float
    """sampling interval [s]"""
    skip: float
    """time skipped at the beginning [s]"""
    from_rest: bool
    """True if the record starts at rest, so that the filters are settled from the first sample on"""

    def whole(self, weighted: Vector) -> Vector:
        """Return the record (n,) without the skipped time."""
        return weighted[round(self.skip / self.time_step) :]

    def settled(self, weighted: Vector, name: str) -> Vector:
        """Return the part of the record (n,) after the filter has settled; empty if the record is shorter."""
        settling = 0.0 if self.from_rest else weighting(name).settling_s
        return weighted[round(max(self.skip, settling) / self.time_step) :]


def _axis(
    span: _Span, record: Vector, name: str, factor: float, average: RunningAverage, *, doses: bool
) -> tuple[AxisVibration, list[str]]:
    """Return the measures of an axis (n,) and the notices on them; `doses`: see `Application`."""
    step = span.time_step
    response = weighted_record(step, record, name)
    weighted, settled = span.whole(response), span.settled(response, name)
    if not settled.size:
        raise DataError(
            f"acceleration: the record lasts {response.size * step:.4g} s but must be longer than the "
            f"{weighting(name).settling_s:g} s in which {name} settles; use a longer record, or set --offset keep if "
            "it starts at rest"
        )
    duration = weighted.size * step
    rms = weighted_rms(weighted)
    dose = vibration_dose_value(step, weighted)
    transient = mtvv(step, settled, average=average)
    # The RMS of a ratio is that of the span of its maximum: with another RMS a crest factor can be below 1.
    settled_rms = weighted_rms(settled)
    remarks = []
    if duration < weighting(name).shortest_record_s * (1.0 - 1e-9):
        lowest = weighting(name).lowest_frequency
        remarks.append(
            f"{duration:.3g} s are too short for a ride: {duration * lowest:.1f} periods of {lowest:g} Hz, where "
            f"{name} begins, for a ride at least {weighting(name).shortest_record_s:.3g} s; the values describe this "
            "event"
        )
    peak, with_it = np.abs(settled).max(), np.abs(weighted).max()
    if rms > 0.0 and with_it > (1.0 + START_UP_EFFECT) * peak:
        remarks.append(
            f"MTVV and crest factor leave out the first {weighting(name).settling_s:g} s, in which {name} settles: "
            f"with them MTVV is {mtvv(step, weighted, average=average):.3g} instead of {transient:.3g} m/s2, the peak "
            f"{with_it:.3g} instead of {peak:.3g} m/s2; if the record starts at rest, set --offset keep"
        )
    values = AxisVibration(
        weighting=name,
        multiplying_factor=factor,
        weighted_rms=rms,
        mtvv=transient,
        crest_factor=crest_factor(settled),
        vdv=dose if doses else None,
        estimated_vdv=estimated_vibration_dose_value(rms, duration) if doses else None,
        msdv=_motion_sickness(span, record) if doses else None,
        msdv_weighting=MOTION_SICKNESS if doses else None,
        mtvv_ratio=transient / settled_rms if settled_rms > 0.0 else None,
        vdv_ratio=dose / (rms * duration**0.25) if doses and rms > 0.0 else None,
    )
    return values, remarks


def _motion_sickness(span: _Span, record: Vector) -> float | None:
    """Return the MSDV of an axis (n,), extrapolated from the settled part; None if the record is too short.

    MSDV = a_w T^(1/2) with a_w of the part after the filter has settled and T the whole duration: method b of the
    standard. A record from rest is settled throughout, and the result equals method a, the integral.
    """
    weighted = weighted_record(span.time_step, record, MOTION_SICKNESS)
    duration = span.whole(weighted).size * span.time_step
    if duration < weighting(MOTION_SICKNESS).shortest_record_s * (1.0 - 1e-9):
        return None
    settled = span.settled(weighted, MOTION_SICKNESS)
    dose = motion_sickness_dose_value(span.time_step, settled)
    return float(dose * np.sqrt(duration / (settled.size * span.time_step)))


def _about_motion_sickness(duration: float) -> list[str]:
    """Return notices if a duration [s] is short for a motion sickness dose value."""
    curve = weighting(MOTION_SICKNESS)
    if duration >= MOTION_SICKNESS_PERIOD * (1.0 - 1e-9):
        return []
    shortest = curve.shortest_record_s
    held = f"{duration:.3g} s are {duration * curve.lowest_frequency:.1f} periods of {curve.lowest_frequency:g} Hz"
    if duration < shortest * (1.0 - 1e-9):
        return [f"no motion sickness dose (msdv): {held}; record at least {shortest:.3g} s"]
    return [
        f"motion sickness dose (msdv) is a rough estimate: {held}; ISO 2631-1, D.1, requires "
        f"{MOTION_SICKNESS_PERIOD:g} s"
    ]


def evaluate(
    time_step: float,
    xyz: ArrayLike | Sequence[Vector],
    *,
    contact: str = "seat",
    average: RunningAverage = "linear",
    skip: float = 0.0,
    from_rest: bool = False,
    axes: Sequence[str] = AXES,
    highest: float | None = None,
) -> ContactVibration:
    """Evaluate the acceleration of a point: weighted RMS, MTVV, crest factor, VDV, MSDV and vector sums.

    The filters are at rest before the record. For a simulated record that starts at rest this is exact. For a record
    cut out of a ride, mean and drift (sensor offset, gravity) are a step at the first sample, whose response must
    decay. So the maxima (MTVV, crest factor) and the MSDV are evaluated after each filter has settled (3.5 s; Wf
    17.5 s), and crest factor and `mtvv_ratio` are their ratios to the RMS of the same span. RMS and VDV include the
    whole record; `offset_effect` returns the effect of the mean on them.

    Args:
        time_step: sampling interval [s].
        xyz: acceleration of the point along `axes` [m/s2], shape (3, n) or a sequence of (n,).
        contact: point of contact, a name in `APPLICATIONS`: "seat" (z Wk, x and y Wd), "backrest", "feet",
            "standing", "seat_bs6841", ...
        average: running average of the MTVV, "linear" or "exponential".
        skip: time skipped at the beginning of the weighted records [s]; the filters process it.
        from_rest: True if the record starts at rest; the whole record is then evaluated.
        axes: measured axes, in the order x, y, z; all three by default.
        highest: maximum frequency in the record [Hz]; 0.4 of its sampling rate by default.

    Returns:
        Values of the axes and their sums. An undefined value is None, and `reasons` contains the reason: MSDV below
        43.2 s, for instance. An axis missing in `axes` is None, and then the sums are None.

    Raises:
        DataError: number of signals unequal to the number of axes, all signals zero, sampled below 25 Hz, values not
            finite, or record shorter than the settling time of the filters.
        ConfigurationError: unknown point of contact or average; a skip that is negative, not finite or as long as the
            record.

    Source: ISO 2631-1:1997, clauses 5.5 and 6 to 9, annex D; BS 6841:1987.
    """
    step = checked_time_step(time_step)
    contact_point = application(contact)
    rows = checked_rows("acceleration", xyz)
    if len(rows) != len(axes):
        raise DataError(f"acceleration: found {len(rows)} signals, must be the axes {', '.join(axes)}")
    if not any(row.any() for row in rows):
        still = "all three axes are" if len(axes) == 3 else f"{' and '.join(axes)} is"
        raise DataError(f"acceleration: {still} zero throughout; select channels that contain vibration")
    if not 0.0 <= skip < (rows[0].size - 1) * step:
        raise ConfigurationError(
            f"skip: found {skip:g} s, must be at least 0 and shorter than the record, {rows[0].size * step:.4g} s"
        )
    span = _Span(time_step=step, skip=skip, from_rest=from_rest)
    values: dict[str, AxisVibration] = {}
    remarks = []
    for axis, record in zip(axes, rows, strict=True):
        number = AXES.index(axis)
        name, factor = contact_point.weightings[number], contact_point.comfort_factors[number]
        values[axis], axis_remarks = _axis(span, record, name, factor, average, doses=contact_point.doses)
        remarks += [f"{axis}: {remark}" for remark in axis_remarks]
    duration = span.whole(rows[0]).size * step
    sums = None
    if len(axes) == 3:
        comfort, health = contact_point.comfort_factors, contact_point.health_factors
        rms = [values[axis].weighted_rms for axis in AXES]
        doses = [dose for axis in AXES if (dose := values[axis].vdv) is not None]
        sums = VibrationSums(
            weighted_rms=vector_sum(rms, comfort),
            vdv=vector_sum(doses, comfort, power=4.0) if doses else None,
            health_weighted_rms=None if health is None else vector_sum(rms, health),
        )
    reasons = [
        f"{axis}: the acceleration is zero throughout, so crest factor and ratios are undefined"
        for axis in axes
        if values[axis].crest_factor is None
    ]
    reasons += remarks + (_about_motion_sickness(duration) if contact_point.doses else [])
    if sums is None:
        missing = [axis for axis in AXES if axis not in axes]
        reasons.append(f"{' and '.join(missing)} missing: no vector sum")
    band = USABLE / step if highest is None else min(highest, USABLE / step)
    range_end = max(weighting(name).highest_frequency for name in contact_point.weightings)
    limited = band < range_end * (1.0 - CLOCK_TOLERANCE)
    if limited:
        reasons.append(
            f"the record, and so the values, end at {band:.3g} Hz, not at the {range_end:g} Hz of "
            f"{contact_point.standard.partition(':')[0]}"
        )
    if contact_point.health_factors is None:
        reasons.append(f"vector_sum.health_weighted_rms is empty: the standard has no health factors for {contact}")
    return ContactVibration(
        place=contact,
        standard=contact_point.standard,
        duration_s=duration,
        sampling_rate_hz=1.0 / step,
        highest_hz=band if limited else None,
        running_average=average,
        x=values.get("x"),
        y=values.get("y"),
        z=values.get("z"),
        vector_sum=sums,
        reasons=reasons,
    )


def offset_line(signals: ArrayLike) -> Vector:
    """Return the least-squares straight line of each signal (k, n): mean and drift, shape (k, n)."""
    array = checked_signals("acceleration", signals)
    count = np.arange(array.shape[1]) - 0.5 * (array.shape[1] - 1)
    slope = (array @ count) / max(float(count @ count), 1.0)
    line = array.mean(axis=1)[:, None] + slope[:, None] * count
    return np.where(is_constant(array)[:, None], array, line)


def without_offset(signals: ArrayLike) -> Vector:
    """Return the signals (k, n) without mean and drift; a constant signal becomes exactly zero.

    Every weighting has a double zero at 0 Hz, so the settled response to a straight line is zero and no vibration is
    lost.
    """
    array = checked_signals("acceleration", signals)
    return array - offset_line(array)


def offset_effect(time_step: float, xyz: ArrayLike, *, contact: str = "seat", axes: Sequence[str] = AXES) -> Vector:
    """Return the relative change of weighted RMS or VDV by mean and drift, |with - without| / without, shape (k,).

    The larger of both changes is returned. The weighting filters are at rest before the record, so a mean is a step at
    the first sample; in a long record it affects the VDV most. The effect is infinite for an axis that contains only an
    offset, and 0 for an axis that is zero.

    Args:
        time_step: sampling interval [s].
        xyz: acceleration [m/s2], shape (k, n).
        contact: point of contact, which selects the weightings.
        axes: names of the k axes, from x, y and z.
    """
    array = checked_signals("acceleration", xyz)
    effects = []
    names = [application(contact).weightings[AXES.index(axis)] for axis in axes]
    for record, clean, name in zip(array, without_offset(array), names, strict=True):
        weighted = [weighted_record(time_step, signal, name) for signal in (record, clean)]
        kept, removed = (np.array([weighted_rms(w), vibration_dose_value(time_step, w)]) for w in weighted)
        # below 1e-12 of the record the remainder is rounding
        if removed[0] > 1e-12 * float(np.abs(record).max()):
            effects.append(float(np.max(np.abs(kept - removed) / removed)))
        else:
            effects.append(np.inf if kept[0] > 0.0 else 0.0)
    return np.asarray(effects)
