"""Comfort of a run at the seat rail, on the seat and at the steering wheel: values, SEAT value and notices."""

from dataclasses import asdict

import numpy as np

from vehicle.names import AXES, point_words
from vehicle.runs.car import Run
from vehicle.runs.car.class_value import class_values
from vehicle.signals.analysis.comfort import COMFORT_BAND, settling
from vehicle.signals.analysis.comfort_error import NORMAL_95
from vehicle.signals.analysis.evaluation import application, evaluate
from vehicle.signals.analysis.ride_comfort import RIM, UNWEIGHTED, WEIGHTED
from vehicle.signals.analysis.seat_value import SeatValue, seat_value
from vehicle.signals.records.run_summary import ComfortSummary, RimSummary

RAIL, SEAT = "seat_rail", "seat"

NO_SEAT = (
    "comfort of the seat: the car has no seat, so 'seat' is a point on the body and there is no SEAT value; "
    'add [seat.driver] with template = "seat_occupant" to the vehicle file'
)


def comfort_values(run: Run) -> dict[str, ComfortSummary]:
    """Return the comfort values at seat rail and seat, if recorded: unweighted RMS (Bommer 2006), and ISO 2631-1."""
    return {point: _at(run, point) for point in (RAIL, SEAT) if _recorded(run, point)}


def seat_values(run: Run) -> SeatValue | None:
    """Return the SEAT value of a run, by RMS and by dose; None for a car without seat, or a rail at rest."""
    if not (run.car.vehicle.seated and _recorded(run, RAIL) and _recorded(run, SEAT)):
        return None
    seat, rail = (run[f"{point}_acc_z"][: run.evaluated.stop] for point in (SEAT, RAIL))
    if not np.any(rail):
        return None
    return seat_value(run.recording.timestep, seat, rail, skip=run.skip)


def rim_values(run: Run) -> RimSummary | None:
    """Return the comfort values at the rim of the steering wheel; None without the output."""
    if not _recorded(run, RIM):
        return None
    value = run.comfort(RIM)
    return RimSummary(
        rms=asdict(value.unweighted),
        band_hz=list(value.band),
        weighted_rms=asdict(value.weighted),
        weighting=application("steering_wheel").weightings[1],
        standard=value.standard,
    )


def comfort_notices(run: Run) -> list[str]:
    """Return notices on a nonstationary level of the seat rail, and on a missing seat."""
    bare = [NO_SEAT] if _recorded(run, SEAT) and not run.car.vehicle.seated else []
    if run.road and run.car.static.support_load:
        blocks = ", ".join(point_words(name) for name in run.car.static.support_load)
        bare.append(
            f"comfort: only {len(run.car.vehicle.wheels)} wheels of {run.car.vehicle.name} are on the road, and its "
            f"blocks ({blocks}) stand still; take a car on four wheels, for example focus_road"
        )
    # An obstacle is a single event.
    if not _recorded(run, RAIL) or "obstacle" in (run.road or {}):
        return bare
    drifting = [
        f"{100 * abs(part.drift):.0f} % along {axis} (chance: {300 * part.standard_error:.0f} %)"
        for axis, part in zip(
            AXES, settling(run.recording.timestep, run.at(RAIL), run.signal.band(COMFORT_BAND)), strict=True
        )
        if not part.settled
    ]
    if not drifting:
        return bare
    return [
        f"comfort of the seat rail: the halves of the record differ in RMS by {', '.join(drifting)}; record longer",
        *bare,
    ]


def _recorded(run: Run, point: str) -> bool:
    return all(f"{point}_acc_{axis}" in run.recording.channels for axis in AXES)


def _over_class(run: Run) -> dict[str, dict[str, float]] | None:
    """Return the comfort of the seat rail over roads of a class, from a road that does not repeat; None elsewhere."""
    band = run.signal.band(COMFORT_BAND)
    values = class_values(run.car, run.signal, run.recording, run.skip, run.road or {}, band)
    return {name: value._asdict() for name, value in values.items()} or None


def _at(run: Run, point: str) -> ComfortSummary:
    value = run.comfort(point)
    xyz = [run[f"{point}_acc_{axis}"][: run.evaluated.stop] for axis in AXES]
    rms, slow, half, explained = asdict(value.unweighted), run.signal.highest is not None, None, None
    if (run.road or {}).get("class"):
        names = [f"{name}{end}" for name in (UNWEIGHTED, WEIGHTED) for end in ("", *(f"_{axis}" for axis in AXES))]
        half = {name: NORMAL_95 * value.errors[name] * value.values[name] for name in names}
        explained = {name: round(value.explained[name], 4) for name in names if name in value.explained} or None
    return ComfortSummary(
        rms_2_50_hz=dict.fromkeys(rms) if slow else rms,
        iso2631=evaluate(run.recording.timestep, xyz, skip=run.skip, from_rest=True, highest=run.signal.highest),
        rms_of_band={"band_hz": list(value.band), **rms} if slow else None,
        half_interval=half,
        explained_by_linear_car=explained,
        over_class=_over_class(run) if point == RAIL else None,
    )
