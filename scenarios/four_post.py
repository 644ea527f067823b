"""Cars on a four-post rig: heave, pitch, roll and warp of the plates, dampers stuck and sliding.

python -m scenarios.four_post [--output DIR] [--quick] [--engine mujoco|reduced|auto] [--vehicle FILE.toml]
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from scenarios.charts import figure_file
from scenarios.claims import OWN_CHECK, Claim, Findings, markdown
from scenarios.signals.four_post import DURATION_S, MOTIONS, four_post
from scenarios.study import QUICK_NOTE, Study, study_parser
from vehicle.commands.options import setting_options, vehicle_options
from vehicle.commands.parser import Parser
from vehicle.drawing.rendering.figure import COLOURS, FRF_TICKS
from vehicle.drawing.rendering.figure import LINES as STYLES
from vehicle.drawing.rendering.recorded_run import hub_channel
from vehicle.engines.linear.car_modes import Mode
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.response import frequency_response
from vehicle.model.parameters.driving import tyre_words
from vehicle.names import AXES
from vehicle.runs.car import Car
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.peaks import Peak, resonance_peaks
from vehicle.studies.sweeps.sweep_settings import SweepSettings

Vector = npt.NDArray[np.float64]

CARS = ("focus_road", "sedan")
"""Shipped cars on four wheels."""

LEVELS = tuple(2.0**-n for n in range(5, -1, -1))
"""Displacements of the plates over those of a road of class A at 80 km/h."""

QUICK_LEVELS, QUICK_DURATION = (LEVELS[0], LEVELS[-1]), 8.0
"""Levels, and length of the signals [s], with --quick."""

TOO_SHORT = f"{QUICK_DURATION:g} s of signal do not resolve the peaks of a car without damping"

STATES = {"stuck": ("#222222", ":"), "sliding": ("#888888", "--")}
"""State of the dampers to colour and style of the curves from matrices."""

RAIL = {"heave": "seat_rail_acc_z", "pitch": "seat_rail_acc_x", "roll": "seat_rail_acc_y", "warp": "seat_rail_acc_y"}
"""Motion to the channel of the seat rail along the axis of the body response."""

LINES = np.geomspace(1.0, 40.0, 900)
"""Frequencies of the FRFs from matrices [Hz]."""

HIGHEST_PEAK_HZ = 30.0
"""Peaks are compared up to here [Hz]."""

WHEELS_FROM_HZ = 10.0
"""Peaks of the wheel carriers are listed from here on [Hz]; below they ride with the body."""

NEAR = 0.05
"""Maximum relative distance in frequency of a peak of a run, or a mode, that matches a peak of the matrices."""

PROMINENCE_DB = 6.0
"""Height of a peak of the matrices above its feet from which it is looked for: twice as high."""

STICKS, SLIDES = 0.01, 0.3
"""Share of the time in slip up to which a car sticks, and from which it slides."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class OneRun:
    """Values of a run on the rig."""

    motion: str  # name of the motion of the plates
    level: float  # displacements over those of a road of class A
    engine: str  # engine of the run
    slip: Mapping[str, float]  # wheel to share of the time with |v| of its damper above the slip velocity
    comfort: float  # unfiltered RMS of the seat rail, 2 to 50 Hz, all axes [m/s2]
    # state of the dampers to the distance of the FRFs from those of the matrices [dB]; lowest and highest level
    to: Mapping[str, float]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Matched:
    """Peak of the transmissibility from the matrices with stuck dampers, with the nearest mode and peak of a run."""

    motion: str  # name of the motion
    channel: str  # acceleration channel of the FRF
    peak: Peak  # of the matrices
    mode: Mode | None  # mode nearest in frequency; None if no mode is within `NEAR`
    found: Peak | None  # peak of the run; None if no peak is within `NEAR`

    @property
    def deviation(self) -> float:
        """Return the frequency of the run over that of the matrices, minus 1; NaN without a peak of the run."""
        return np.nan if self.found is None else self.found.frequency_hz / self.peak.frequency_hz - 1.0

    @property
    def allowed(self) -> float:
        """Return half of the half-power width of the peak plus a line spacing of the record, over the frequency."""
        damping = 0.0 if self.mode is None else self.mode.damping_ratio
        return damping + 1.0 / (DURATION_S * self.peak.frequency_hz)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Found:
    """Results of one car on the rig."""

    car: Car  # the car
    exact: Mapping[tuple[str, str], npt.NDArray[np.complex128]]  # (motion, state) to FRFs from the matrices
    runs: Sequence[OneRun]  # runs of all motions and levels, the lowest level of a motion first
    # (motion, level) to FRFs of `channels_of` to the common motion [m/s2 per m]; lowest and highest level
    responses: Mapping[tuple[str, float], FrequencyResponse]
    peaks: Sequence[Matched]  # peaks of the lowest level


def channels_of(car: Car, motion: str) -> tuple[str, ...]:
    """Return the channels of a motion: seat rail along the axis of the body response, and a hub of each axle."""
    hubs = [hub_channel(car.vehicle.composition, wheel) for wheel in ("fr", "rr")]
    return (RAIL[motion], *(hub for hub in hubs if hub in car.vehicle.acceleration_channels))


def matrix_response(car: Car, motion: str, state: str) -> npt.NDArray[np.complex128]:
    """Return FRFs of `channels_of` to the common motion from the matrices, over `LINES`; (channels, lines)."""
    form = first_order(car.matrices.system, stuck=state == "stuck")
    driven = [MOTIONS[motion].get(wheel, 0.0) for wheel in car.vehicle.wheels]
    return frequency_response(form, LINES, channels_of(car, motion), "acceleration", driven=driven)


def transmissibility(frequency: Vector, response: npt.NDArray[np.complex128]) -> Vector:
    """Return |displacement of the point over that of the plates| = |H| / (2 pi f)^2 [-]."""
    return np.asarray(np.abs(response) / (2.0 * np.pi * frequency) ** 2)


def distance_db(response: FrequencyResponse, exact: npt.NDArray[np.complex128]) -> float:
    """Return the RMS over lines and channels of 20 lg of |H| of a run over |H| of the matrices [dB]."""
    frequency = response.frequency
    finite = np.isfinite(response.response).all(axis=0) & (frequency <= HIGHEST_PEAK_HZ)
    level = [np.interp(np.log(frequency[finite]), np.log(LINES), np.log10(row)) for row in np.abs(exact)]
    ratio = 20.0 * (np.log10(np.abs(response.response[:, finite])) - np.array(level))
    return float(np.sqrt(np.mean(ratio**2)))


def examine(car: Car, *, quick: bool, engine: str) -> Found:
    """Run a car in all motions and levels, and compare the runs with the matrices."""
    exact = {(motion, state): matrix_response(car, motion, state) for motion in MOTIONS for state in STATES}
    levels, duration = (QUICK_LEVELS, QUICK_DURATION) if quick else (LEVELS, DURATION_S)
    runs, responses = [], {}
    for motion in MOTIONS:
        asked = channels_of(car, motion)
        dampers = [wheel for wheel in MOTIONS[motion] if f"damper_{wheel}_velocity" in car.vehicle.channels]
        recorded = {*asked, *(f"seat_rail_acc_{axis}" for axis in AXES)}
        recorded |= {f"plate_{wheel}_displacement" for wheel in MOTIONS[motion]}
        recorded |= {f"damper_{wheel}_velocity" for wheel in dampers}
        for level in levels:
            signal = four_post(motion, factor=level, duration=duration)
            run = car.run(signal, engine=engine, channels=[name for name in car.vehicle.channels if name in recorded])
            to: dict[str, float] = {}
            if level in (levels[0], levels[-1]):
                responses[motion, level] = run.frf(asked)
                to = {state: distance_db(responses[motion, level], exact[motion, state]) for state in STATES}
            runs.append(
                OneRun(
                    motion=motion,
                    level=level,
                    engine=run.recording.statistics.engine,
                    slip={wheel: run.slip_share(wheel) for wheel in dampers},
                    comfort=run.comfort().unweighted.overall,
                    to=to,
                )
            )
    modes = car.modes("stuck")
    peaks = [
        peak
        for motion in MOTIONS
        for peak in matched_peaks(car, motion, responses[motion, levels[0]], exact[motion, "stuck"], modes)
    ]
    return Found(car=car, exact=exact, runs=runs, responses=responses, peaks=peaks)


def matched_peaks(
    car: Car, motion: str, response: FrequencyResponse, exact: npt.NDArray[np.complex128], modes: Sequence[Mode]
) -> list[Matched]:
    """Match the peaks of the transmissibility from the matrices with peaks of a run and with modes, by channel."""
    size = (2.0 * np.pi * response.frequency) ** 2
    peaks = []
    for row, channel in enumerate(channels_of(car, motion)):
        height, error = (values[row] / size for values in (np.abs(response.response), response.random_error))
        measured = resonance_peaks(response.frequency, height, response.coherence[row], error)
        for peak in resonance_peaks(LINES, transmissibility(LINES, exact[row]), prominence_db=PROMINENCE_DB):
            at = peak.frequency_hz
            if (WHEELS_FROM_HZ if row else 0.0) <= at <= HIGHEST_PEAK_HZ:
                mode = min(modes, key=lambda other: abs(other.frequency - at))
                found = min(measured, key=lambda other: abs(other.frequency_hz - at), default=None)
                peaks.append(
                    Matched(
                        motion=motion,
                        channel=channel,
                        peak=peak,
                        mode=mode if abs(mode.frequency / at - 1.0) < NEAR else None,
                        found=found if found and abs(found.frequency_hz / at - 1.0) < NEAR else None,
                    )
                )
    return peaks


def study(cars: Sequence[Car], folder: Path, options: argparse.Namespace) -> Findings:
    """Put every car on the rig, draw the responses into the folder, and compare."""
    examined = [examine(car, quick=options.quick, engine=options.engine) for car in cars]
    for entry in examined:
        engines = " and ".join(sorted({run.engine for run in entry.runs}))
        caption = (
            "Displacements of the plates as on, and a share of those on, a road of class A at 80 km/h; tyres "
            f"{entry.car.vehicle.driving.words}; engine {engines}; {QUICK_DURATION if options.quick else DURATION_S:g} "
            "s each"
        )
        response_figure(folder / f"{entry.car.vehicle.name}_responses.png", entry, caption)
    claims = [claim for entry in examined for claim in claims_of(entry)]
    peaks = {claim.name for claim in claims if "peaks" in claim.name}
    return Findings(
        title="Cars on a four-post rig",
        claims=claims,
        tyres=tyre_words(entry.vehicle.driving for entry in cars),
        unjudged=dict.fromkeys(peaks, TOO_SHORT) if options.quick else {},
        notes=[
            *(text for entry in examined for text in (peak_table(entry), level_table(entry))),
            *([QUICK_NOTE] if options.quick else []),
        ],
        data={"cars": {entry.car.vehicle.name: {"runs": numbers(entry)} for entry in examined}},
    )


def level_words(level: float) -> str:
    """Return a text for a level: displacements over those of a road of class A."""
    return "class A" if level == 1.0 else f"1/{1.0 / level:g} of class A"


def claims_of(examined: Found) -> list[Claim]:
    """Return the rows on the runs of a car: checks against the matrices and the friction law."""
    name, runs = examined.car.vehicle.name, examined.runs
    low, high = ([run for run in runs if run.level == level] for level in (runs[0].level, runs[-1].level))
    at_low, at_high = level_words(low[0].level), level_words(high[0].level)
    stuck, sliding = ([max(run.slip.values()) for run in part] for part in (low, high))
    found = [peak for peak in examined.peaks if peak.found is not None]
    outside = sum(abs(peak.deviation) > peak.allowed for peak in found)
    largest = max((abs(peak.deviation) for peak in found), default=np.inf)
    closer = [
        below.to["stuck"] < below.to["sliding"] and above.to["sliding"] < above.to["stuck"]
        for below, above in zip(low, high, strict=True)
    ]
    # 1 for a linear car
    rougher = {
        below.motion: below.comfort / below.level / (above.comfort / above.level)
        for below, above in zip(low, high, strict=True)
    }
    return [
        OWN_CHECK.statement(
            f"{name}: dampers on {at_low}",
            "stuck",
            f"at most {100 * max(stuck):.2f} % of the time in slip",
            max(stuck) <= STICKS,
            f"all four motions, the damper that slips most; up to {100 * STICKS:g} % counts as stuck",
        ),
        OWN_CHECK.statement(
            f"{name}: dampers on {at_high}",
            "sliding",
            f"at least {100 * min(sliding):.0f} % of the time in slip",
            min(sliding) >= SLIDES,
            f"all four motions, the damper that slips most; from {100 * SLIDES:g} % on counts as sliding",
        ),
        OWN_CHECK.statement(
            f"{name}: peaks on {at_low} against the matrices with stuck dampers",
            "all within their width",
            f"{len(found)} of {len(examined.peaks)} found, {outside} outside, largest deviation {100 * largest:.2f} %",
            len(found) >= 0.8 * len(examined.peaks) and not outside,
            f"peaks of the matrices of {PROMINENCE_DB:g} dB and more; half of the half-power width, the damping ratio "
            "of the mode, and a line of the record; one in five may be too narrow for the record",
        ),
        OWN_CHECK.statement(
            f"{name}: which linear car the FRFs are near to",
            "stuck below, sliding above",
            f"{sum(closer)} of {len(closer)} motions",
            all(closer),
            "RMS distance of the magnitudes in dB, 1 to 30 Hz, body and wheel carriers",
        ),
        OWN_CHECK.statement(
            f"{name}: seat rail over the level, {at_low} against {at_high}",
            "more, since nothing but rubber damps a car whose dampers stick",
            ", ".join(f"{motion} {ratio:.1f} times" for motion, ratio in rougher.items()),
            min(rougher.values()) > 1.0,
            "RMS of the unfiltered acceleration, 2 to 50 Hz, over the displacement of the plates",
        ),
    ]


def peak_table(examined: Found) -> str:
    """Return a table of the peaks of the matrices with stuck dampers beside those of the runs, lowest level."""
    rows = [
        [
            peak.motion,
            peak.channel,
            f"{peak.peak.frequency_hz:.2f}",
            "-" if peak.found is None else f"{peak.found.frequency_hz:.2f}",
            "-" if peak.found is None else f"{100 * peak.deviation:+.2f}",
            "-" if peak.found is None else f"{peak.found.magnitude / peak.peak.magnitude:.2f}",
            "-" if peak.mode is None else f"{peak.mode.frequency:.2f} Hz, {peak.mode.description}",
        ]
        for peak in examined.peaks
    ]
    head = (
        f"{examined.car.vehicle.name}: peaks of the transmissibility, run on {level_words(examined.runs[0].level)} "
        "against the matrices with stuck dampers, and the mode nearest in frequency:\n\n"
    )
    heads = ("plates", "channel", "matrices [Hz]", "run [Hz]", "deviation [%]", "height over matrices", "mode")
    return head + markdown(heads, rows)


def level_table(examined: Found) -> str:
    """Return a table of slip, comfort and distance to both linear cars over the level."""
    rows = [
        [
            run.motion,
            level_words(run.level),
            run.engine,
            *(f"{100 * run.slip.get(wheel, float('nan')):.1f}" for wheel in ("fr", "rr")),
            f"{run.comfort:.3f}",
            *(f"{run.to[state]:.2f}" if run.to else "-" for state in STATES),
        ]
        for run in examined.runs
    ]
    heads = ("plates", "level", "engine", "slip front [%]", "slip rear [%]", "seat rail RMS [m/s2]")
    head = f"{examined.car.vehicle.name}: share of the time in slip, and how far the FRFs are from the linear car:\n\n"
    return head + markdown((*heads, "to stuck [dB]", "to sliding [dB]"), rows)


def numbers(examined: Found) -> list[dict[str, Any]]:
    """Return the values of the runs as plain data."""
    return [
        {"motion": run.motion, "level": run.level, "engine": run.engine, "slip": run.slip, "comfort": run.comfort}
        | {f"to_{state}_db": run.to.get(state) for state in STATES}
        for run in examined.runs
    ]


def response_figure(path: Path, examined: Found, caption: str) -> None:
    """Draw the transmissibility of body and wheel carriers to each motion of the plates, from runs and matrices."""
    car = examined.car
    title = f"{car.vehicle.name} on four posts: displacement over that of the plates"
    with figure_file(path, (15.0, 9.0), title, caption) as figure:
        rows = max(len(channels_of(car, motion)) for motion in MOTIONS)
        axes = figure.subplots(rows, len(MOTIONS), sharex=True, sharey="row", squeeze=False)
        for column, motion in zip(axes.T, MOTIONS, strict=True):
            shown = {level: response for (moved, level), response in examined.responses.items() if moved == motion}
            for row, (axis, channel) in enumerate(zip(column, channels_of(car, motion), strict=False)):
                for state, (colour, style) in STATES.items():
                    size = transmissibility(LINES, examined.exact[motion, state][row])
                    axis.plot(LINES, size, color=colour, linestyle=style, label=f"matrices, dampers {state}")
                for (level, response), colour, line in zip(shown.items(), COLOURS, STYLES, strict=False):
                    size = transmissibility(response.frequency, response.response[row])
                    look = {"color": colour, "linestyle": line, "linewidth": 1.0, "label": level_words(level)}
                    axis.plot(response.frequency, size, **look)
                axis.set(xscale="log", yscale="log", xlim=(1.0, 40.0))
                axis.set_title(f"{motion}: {channel.replace('_acc_', ', ').replace('_', ' ')}")
        axes[0, 0].legend(loc="lower left")
        for axis in axes[-1]:
            axis.set_xlabel("frequency [Hz]")
            axis.set_xticks([tick for tick in FRF_TICKS if tick < 50], [str(t) for t in FRF_TICKS if t < 50])
            axis.set_xticks([], minor=True)
        for axis in axes[:, 0]:
            axis.set_ylabel("transmissibility [-]")


def load(options: argparse.Namespace) -> list[Car]:
    """Return the car of --vehicle, or the shipped cars on four wheels."""
    names = CARS if options.vehicle is None else (options.vehicle,)
    cars = [Car.load(name, options.overrides) for name in names]
    for car in cars:
        car.vehicle.require_wheels(MOTIONS["heave"])
    return cars


def _parser() -> Parser:
    jobs = "; this study runs in one process, so that it changes nothing"
    parser = study_parser("four_post", quick="short signals at two levels; peaks are left open", jobs=jobs)
    vehicle_options(parser)
    setting_options(parser, SweepSettings, "engine")
    return parser


main = Study(parser=_parser(), load=load, study=study)


if __name__ == "__main__":
    sys.exit(main())
