"""Runs of a car on a four-post rig, and the same FRFs from its matrices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from scenarios.signals.four_post import MOTIONS, four_post
from vehicle.drawing.rendering.recorded_run import hub_channel
from vehicle.engines.linear.car_modes import Mode
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.response import frequency_response
from vehicle.names import AXES
from vehicle.runs.car import Car
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.peaks import Peak, resonance_peaks

Vector = npt.NDArray[np.float64]

Thing = TypeVar("Thing")

LEVELS = tuple(2.0**-n for n in range(5, -1, -1))
"""Displacements of the plates over those of a road of class A at 80 km/h."""

QUICK_LEVELS, QUICK_DURATION = (LEVELS[0], LEVELS[-1]), 8.0
"""Levels, and length of the signals [s], with --quick."""

STATES = ("stuck", "sliding")

LINES = np.geomspace(1.0, 40.0, 900)
"""Frequencies of the FRFs from matrices [Hz]."""

HIGHEST_PEAK_HZ = 30.0
"""Peaks are compared up to here [Hz]."""

NEAR = 0.05
"""Maximum relative distance in frequency of a peak of a run, or a mode, that matches a peak of the matrices."""

WHEELS_FROM_HZ = 10.0
"""Peaks of the wheel carriers are listed from here on [Hz]; below they ride with the body."""

PROMINENCE_DB = 6.0
"""Height of a peak of the matrices above its feet from which it is looked for: twice as high."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class OneRun:
    """Values of a run on the rig."""

    motion: str  # name of the motion of the plates
    level: float  # displacements over those of a road of class A
    engine: str  # engine of the run
    slip: dict[str, float]  # wheel to share of the time with |v| of its damper above the slip velocity
    comfort: float  # unfiltered RMS of the seat rail, 2 to 50 Hz, all axes [m/s2]
    response: FrequencyResponse | None  # FRFs of `channels_of` to the common motion [m/s2 per m]; None if not estimated


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Matched:
    """Peak of the FRF from the matrices with the matching mode and the matching peak of a run."""

    motion: str  # name of the motion
    channel: str  # acceleration channel of the FRF
    state: str  # of the dampers in the matrices
    peak: Peak  # of the matrices
    mode: Mode | None  # mode nearest in frequency; None if no mode is within `NEAR`
    found: Peak | None  # peak of the run; None if no peak is within `NEAR`

    @property
    def deviation(self) -> float | None:
        """Return the frequency of the run over that of the matrices, minus 1."""
        return None if self.found is None else self.found.frequency_hz / self.peak.frequency_hz - 1.0


def channels_of(car: Car, motion: str) -> tuple[str, ...]:
    """Return the channels of a motion: seat rail along the axis of the body response, and a hub of each axle.

    Heave excites the seat rail vertically, pitch longitudinally, roll and warp laterally.
    """
    body = {
        "heave": "seat_rail_acc_z",
        "pitch": "seat_rail_acc_x",
        "roll": "seat_rail_acc_y",
        "warp": "seat_rail_acc_y",
    }
    hubs = [hub_channel(car.vehicle.composition, wheel) for wheel in ("fr", "rr")]
    available = car.vehicle.acceleration_channels
    return (body[motion], *(hub for hub in hubs if hub in available))


def run_motion(car: Car, motion: str, level: float, *, duration: float, engine: str, response: bool = True) -> OneRun:
    """Run a car on the rig for a duration [s], with an engine of `Car.run`; FRFs only on demand."""
    asked = channels_of(car, motion)
    dampers = [
        damper_wheel for damper_wheel in MOTIONS[motion] if f"damper_{damper_wheel}_velocity" in car.vehicle.channels
    ]
    recorded = {*asked, *(f"seat_rail_acc_{axis}" for axis in AXES)}
    recorded |= {f"plate_{wheel}_displacement" for wheel in MOTIONS[motion]}
    recorded |= {f"damper_{wheel}_velocity" for wheel in dampers}
    order = [name for name in car.vehicle.channels if name in recorded]
    run = car.run(four_post(motion, factor=level, duration=duration), engine=engine, channels=order)
    return OneRun(
        motion=motion,
        level=level,
        engine=run.recording.statistics.engine,
        slip={wheel: run.slip_share(wheel) for wheel in dampers},
        comfort=run.comfort().unweighted.overall,
        response=run.frf(asked) if response else None,
    )


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


def matched_peaks(
    car: Car, one: OneRun, state: str, exact: npt.NDArray[np.complex128], modes: Sequence[Mode]
) -> list[Matched]:
    """Match the peaks of the transmissibility from the matrices with peaks of a run and with modes, by channel."""
    response = one.response
    assert response is not None
    size = (2.0 * np.pi * response.frequency) ** 2
    peaks = []
    for row, channel in enumerate(channels_of(car, one.motion)):
        measured = resonance_peaks(
            response.frequency,
            np.abs(response.response[row]) / size,
            response.coherence[row],
            response.random_error[row] / size,
        )
        for peak in resonance_peaks(LINES, transmissibility(LINES, exact[row]), prominence_db=PROMINENCE_DB):
            if (WHEELS_FROM_HZ if row else 0.0) <= peak.frequency_hz <= HIGHEST_PEAK_HZ:
                at = peak.frequency_hz
                near = _nearest(at, measured, [other.frequency_hz for other in measured])
                mode = _nearest(at, modes, [other.frequency for other in modes])
                peaks.append(
                    Matched(
                        motion=one.motion,
                        channel=channel,
                        state=state,
                        peak=peak,
                        mode=mode,
                        found=near,
                    )
                )
    return peaks


def _nearest(at: float, those: Sequence[Thing], frequencies: Sequence[float]) -> Thing | None:
    """Return the item nearest in frequency; None if no item is within `NEAR`."""
    offsets = np.abs(np.array(frequencies) / at - 1.0)
    return those[int(np.argmin(offsets))] if offsets.size and offsets.min() < NEAR else None
