"""Comfort of an acceleration record after ISO 2631-1, BS 6841, ISO 5349-1 or EN 12299: offset, SEAT value."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.digits import beside_limit, number
from vehicle.errors import ConfigurationError, DataError
from vehicle.names import AXES
from vehicle.signals.analysis.contact_vibration import ContactVibration
from vehicle.signals.analysis.daily_exposure import DailyExposure, exposure
from vehicle.signals.analysis.evaluated_span import evaluated_span
from vehicle.signals.analysis.evaluation import (
    LARGEST_MEAN,
    OFFSET_EFFECT,
    application,
    evaluate,
    offset_effect,
    offset_line,
    without_offset,
)
from vehicle.signals.analysis.exposure import RunningAverage
from vehicle.signals.analysis.rail_comfort import comfort_words, rail_comfort
from vehicle.signals.analysis.seat_value import SeatValue, seat_value
from vehicle.signals.formats.table import Record
from vehicle.signals.records.acceleration import read_acceleration
from vehicle.signals.records.channel_faults import copies
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.finding import FindingError, findings_of
from vehicle.signals.records.run_summary import available_summary
from vehicle.stored import Stored

OFFSETS = ("refuse", "remove", "keep")
"""Treatments of mean and drift of an axis."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Offset(Stored):
    """Mean and drift of the axes of a record [m/s2], "removed" or "kept"."""

    treatment: str
    mean: dict[str, float]
    drift: dict[str, float]


@dataclass(frozen=True, kw_only=True, slots=True)
class RailRating(Stored):
    """Mean comfort N_MV of each 5 minutes with its words, and the largest continuous comfort by axis [m/s2]."""

    mean: list[float]
    words: list[str]
    largest_continuous: dict[str, float]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RecordComfort:
    """Comfort values of an acceleration record.

    Attributes:
        input: the record.
        offset: mean and drift of the axes, and their treatment.
        vibration: values of the axes and their sums.
        remarks: messages on the record.
        exposure: daily exposure; None without daily hours.
        rail: mean comfort on the floor of a train; None at other points of contact.
        seat: SEAT value of z; None if no rail was specified.
    """

    input: str
    offset: Offset
    vibration: ContactVibration
    remarks: tuple[str, ...]
    exposure: DailyExposure | None = None
    rail: RailRating | None = None
    seat: SeatValue | None = None

    @property
    def weighted_rms(self) -> dict[str, float]:
        """Weighted RMS acceleration of each measured axis [m/s2]."""
        return {axis: values.weighted_rms for axis, values in self.vibration.axes.items()}

    @property
    def overall(self) -> float | None:
        """Vector sum of the weighted RMS accelerations for comfort [m/s2]; None if an axis is missing."""
        return None if self.vibration.vector_sum is None else self.vibration.overall

    @property
    def seat_value(self) -> float | None:
        """SEAT value of the weighted RMS along z [-]; None without a rail."""
        return None if self.seat is None else self.seat.rms

    @property
    def notices(self) -> tuple[str, ...]:
        """Messages on the record, and reasons for missing values."""
        return (*self.remarks, *self.vibration.reasons)

    def to_json(self) -> dict[str, Any]:
        """Return all values as an object of JSON."""
        further = {"exposure": self.exposure, "rail_comfort": self.rail, "seat_value": self.seat}
        return {
            "input": self.input,
            "offset": self.offset.to_json(),
            **self.vibration.to_json(),
            "notices": list(self.remarks),
            **{name: value.to_json() for name, value in further.items() if value is not None},
        }

    def __repr__(self) -> str:
        """Return the weighted RMS by axis and overall in a line."""
        axes = ", ".join(f"{axis} {value:.4g}" for axis, value in self.weighted_rms.items())
        overall = "" if self.overall is None else f"; overall {self.overall:.4g}"
        return f"RecordComfort(weighted RMS {axes}{overall} m/s2)"

    def __str__(self) -> str:
        """Return the table of all values."""
        return self.text()

    def text(self) -> str:
        """Return the values as a table for the console."""
        values, axes = self.vibration, self.vibration.axes
        lines = [
            f"{self.input}: {values.duration_s:g} s at {values.sampling_rate_hz:g} Hz, {values.place} "
            f"({values.standard})",
            f"{'':16}" + "".join(f"{axis:>12}" for axis in axes),
        ]
        for title, key, unit in ROWS:
            cells = [getattr(axis, key) for axis in axes.values()]
            shown = ["-" if v is None else v if isinstance(v, str) else f"{v:.4g}" for v in cells]
            lines.append(f"{title:16}" + "".join(f"{cell:>12}" for cell in shown) + f"  {unit}".rstrip())
        if (sums := values.vector_sum) is not None:
            lines.append(f"vector sum of RMS (comfort)  {sums.weighted_rms:.4g} m/s2")
            if sums.health_weighted_rms is not None:
                lines.append(f"vector sum of RMS (health)   {sums.health_weighted_rms:.4g} m/s2")
            if sums.vdv is not None:
                lines.append(f"sum of VDV (fourth power)    {sums.vdv:.4g} m/s^1.75")
        if (seat := self.seat) is not None:
            lines.append(f"SEAT value (z, {seat.weighting})       {seat.rms:.4g}, of VDV {seat.vdv:.4g}")
        if (day := self.exposure) is not None:
            above = sum(day.a8 >= limit for limit in (day.action_value, day.limit_value))
            state = ("below the action value", "above the action value", "above the limit value")[above]
            lines.append(f"exposure A(8), {day.hours:g} h a day  {day.a8:.4g} m/s2, {state}")
            lines.append(f"{'':16}action value {day.action_value:g}, limit value {day.limit_value:g} m/s2")
        if (rated := self.rail) is not None:
            means = ", ".join(f"{mean:.3g} ({text})" for mean, text in zip(rated.mean, rated.words, strict=True))
            lines.append(f"mean comfort N_MV of each 5 minutes (EN 12299)  {means}")
            largest = ", ".join(f"{axis} {value:.3g}" for axis, value in rated.largest_continuous.items())
            lines.append(f"largest continuous comfort, 5 s  {largest} m/s2")
        lines.append("values of this record alone; repeat the ride to see their scatter")
        return "\n".join(lines)


ROWS = (
    ("weighting", "weighting", ""),
    ("weighted RMS", "weighted_rms", "m/s2"),
    ("MTVV", "mtvv", "m/s2"),
    ("crest factor", "crest_factor", ""),
    ("VDV", "vdv", "m/s^1.75"),
    ("estimated VDV", "estimated_vdv", "m/s^1.75"),
    ("MSDV (Wf)", "msdv", "m/s^1.5"),
)
"""Title, key and unit of each row of the table."""


def evaluate_comfort(
    file: Path | str,
    point: str | None = None,
    *,
    choice: Choice | None = None,
    rail: str | None = None,
    rail_choice: Choice | None = None,
    contact: str = "seat",
    offset: str = "refuse",
    average: RunningAverage = "linear",
    skip: float = 0.0,
    hours: float | None = None,
) -> RecordComfort:
    """Evaluate a record of acceleration: weighted RMS, MTVV, crest factor, VDV, MSDV and vector sums.

    Args:
        file: table with the columns time [s], x, y, z [m/s2] or [g], or a measurement file of any format.
        point: point of a run, such as "seat_rail" in its time.csv or time.npz; columns x, y, z by default.
        choice: channels of a measurement file for x, y and z, units, rate and excerpt.
        rail: point below the seat, such as "seat_rail", for the SEAT value.
        rail_choice: channel of a measurement file for z below the seat, for the SEAT value.
        contact: point of contact, which selects weightings and factors: seat, backrest, feet, standing, ...
        offset: treatment of mean and drift: "refuse" (error if they change the result), "remove", or "keep" for a
            record that begins at rest.
        average: running average of the MTVV, "linear" or "exponential".
        skip: time skipped at the beginning of the weighted records [s].
        hours: daily duration of this vibration [h], for the exposure A(8); None without it.

    Returns:
        Comfort values; `print` shows a table.

    Raises:
        ConfigurationError: unknown file or point of contact, or a SEAT value of a point other than a seat.
        DataError: bad data, a mean or drift that changes the result, or a seat and a rail at different times.

    Source: ISO 2631-1:1997; BS 6841:1987; ISO 10326-1 (SEAT); ISO 5349-1:2001; EN 12299:2009; Directive 2002/44/EC.
    """
    application(contact)
    if offset not in OFFSETS:
        raise ConfigurationError(f"offset: must be one of {', '.join(OFFSETS)}, not {offset!r}")
    seated = rail is not None or rail_choice is not None
    if seated and contact not in ("seat", "seat_bs6841"):
        raise ConfigurationError(f"--place {contact}: only a seat has a SEAT value (--rail); leave out one of them")
    record = _read(file, point, choice, contact, offset)
    axes, xyz = list(record.channels), np.array(list(record.channels.values()))
    copied = [
        f"{first} and {second} are the same channel, and the vector sum counts it twice; choose another one with "
        f"--channel {second}=NAME"
        for first, second in copies(record.channels)
    ]
    removed = offset == "remove"
    vibration = evaluate(
        record.step,
        without_offset(xyz) if removed else xyz,
        contact=contact,
        average=average,
        skip=skip,
        from_rest=offset == "keep",
        axes=axes,
        highest=record.usable,
    )
    line = offset_line(xyz)
    taken_out = findings_of(record.notices, kinds=("gravity",)) if removed else []
    notices = [text for text in record.notices if text not in taken_out]
    day = None if hours is None else exposure(vibration, hours)
    rating = seat = None
    if contact == "train_floor":
        rated = without_offset(xyz) if removed else xyz
        floor = rail_comfort(record.step, rated, skip=skip, from_rest=offset == "keep")
        rating = RailRating(
            mean=floor.mean.tolist(),
            words=[comfort_words(mean) for mean in floor.mean],
            largest_continuous=dict(zip(AXES, floor.continuous.max(axis=1).tolist(), strict=True)),
        )
    if seated:
        below = _read(file, rail, rail_choice, contact, offset, checked="z")
        if "z" not in record.channels or "z" not in below.channels:
            raise ConfigurationError("--rail: z is missing; the SEAT value needs z at the seat and at the rail")
        ends, ends_below = (np.array([each.time[0], each.time[-1], each.step]) for each in (record, below))
        if np.max(np.abs(ends - ends_below)) > 0.5 * record.step or record.time.size != below.time.size:
            spans = [
                f"{1.0 / step:.6g} Hz from {first:.6g} to {last:.6g} s" for first, last, step in (ends, ends_below)
            ]
            raise DataError(
                f"{file}: the seat has {spans[0]}, the rail {spans[1]}, but both must be the same; set --resample HZ "
                "for "
                "another rate, --from and --to for another span"
            )
        seat_and_rail = np.array([record.channels["z"], below.channels["z"]])
        seat_and_rail = without_offset(seat_and_rail) if removed else seat_and_rail
        seat = seat_value(record.step, seat_and_rail[0], seat_and_rail[1], contact=contact, skip=skip)
    return RecordComfort(
        input=str(file),
        offset=Offset(
            treatment="removed" if removed else "kept",
            mean=dict(zip(axes, map(float, xyz.mean(axis=1)), strict=True)),
            drift=dict(zip(axes, map(float, line[:, -1] - line[:, 0]), strict=True)),
        ),
        vibration=vibration,
        remarks=(*notices, *copied),
        exposure=day,
        rail=rating,
        seat=seat,
    )


def _read(
    file: Path | str, point: str | None, choice: Choice | None, contact: str, offset: str, checked: str = "xyz"
) -> Record:
    """Read the acceleration of a point; reject mean and drift of the checked axes that change the comfort values."""
    record = read_acceleration(file, point, choice)
    if (choice is None or choice.last is None) and available_summary(Path(file).parent):
        # Only the record of a run has a sample that closes its span.
        part = evaluated_span(record.time.size, record.step, 0.0)
        channels = {name: values[part] for name, values in record.channels.items()}
        record = replace(record, time=record.time[part], channels=channels)
    if offset != "refuse":
        return record
    gravity = findings_of(record.notices, kinds=("gravity",))
    if gravity:
        raise FindingError(file, gravity)
    xyz = np.array(list(record.channels.values()))
    line = offset_line(xyz)
    effects = offset_effect(record.step, xyz, contact=contact, axes=list(record.channels))
    for axis, effect, mean, drift in zip(
        record.channels, effects, xyz.mean(axis=1), line[:, -1] - line[:, 0], strict=True
    ):
        if axis in checked and (effect > OFFSET_EFFECT or abs(mean) > LARGEST_MEAN):
            shown, limit = beside_limit(mean, LARGEST_MEAN)
            percent, allowed = beside_limit(100.0 * effect, 100.0 * OFFSET_EFFECT)
            raise DataError(
                f"{file}: the mean of column {axis!r} is {shown} m/s2, must be at most {limit} m/s2; with the drift of "
                f"{number(drift, 2)} m/s2 it changes weighted RMS or VDV by {percent} %, must be at most {allowed} %; "
                "set --offset remove for a sensor offset or gravity, --offset keep "
                "if the record begins at rest"
            )
    return record
