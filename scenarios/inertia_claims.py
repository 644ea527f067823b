"""Published statements about modes and the moment of inertia Ixx beside ours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from scenarios.claim import Claim, number_claim, statement_claim
from vehicle.analysis.frf import FrequencyResponse
from vehicle.analysis.peaks import resonance_peaks
from vehicle.car import Car
from vehicle.linear.modes import Mode

ROLL, MEASURED_ROLL = 6.5, 5.8
"""Roll mode (Rx) of the model of the source with Ixx 1000, and of the measured car [Hz]."""

LARGEST_SHARE = 0.9
"""'More than 10 % lower'."""

ROUND = 0.05
"""Printed with one or two digits, as limits of a range or read off a figure: 5 %."""

ROLL_COORDINATE = 3
"""Of the six of a rigid body: x, y, z, Rx, Ry, Rz."""


def roll_mode(car: Car) -> Mode:
    """The mode, dampers stuck, with the largest share of its kinetic energy in the roll of the body."""
    rows, mass = car.matrices.body_rows["body"], car.matrices.body_masses["body"]

    def share(mode: Mode) -> float:
        velocity = rows @ mode.shape
        parts = np.real(np.conj(velocity) * (mass @ velocity))
        return float(mode.energy["body"] * parts[ROLL_COORDINATE] / np.sum(parts))

    return max(car.modes("stuck"), key=share)


def led_by(modes: Sequence[Mode], part: str) -> list[Mode]:
    """Modes with the largest share of their energy in a part."""
    return [mode for mode in modes if max(mode.energy, key=lambda name: mode.energy[name]) == part]


def mode_claims(cars: Sequence[Car]) -> list[Claim]:
    """Rows about the modes; `cars` with Ixx 1000 and with Ixx 1200."""
    published = roll_mode(cars[0]).frequency
    modes = cars[0].modes("stuck")
    rigid = [mode.frequency for mode in led_by(modes, "body")]
    engine = [mode.frequency for mode in led_by(modes, "engine")]
    flexible = np.sort(cars[0].trimmed_body.frequencies)
    return [
        number_claim(
            "roll mode (Rx) of the matrices, Ixx 1000 [Hz]",
            ROLL,
            published,
            ROUND * ROLL,
            "dampers stuck; 5 %. The source shows roll as a peak of its FRFs: that row is below",
            status="own check",
            source="text",
        ),
        statement_claim(
            "six rigid body modes",
            "all below 10 Hz",
            f"{len(rigid)}: {_list(rigid)} Hz",
            len(rigid) == 6 and max(rigid) < 10.0,
            "modes with the largest share of energy in the body, dampers stuck, Ixx 1000",
            status="predicted",
            source="text",
        ),
        statement_claim(
            "engine modes",
            "10 to 20 Hz",
            f"{len(engine)}: {_list(engine)} Hz",
            len(engine) == 6 and min(engine) >= (1 - ROUND) * 10.0 and max(engine) <= (1 + ROUND) * 20.0,
            "modes with the largest share of energy in the engine, dampers stuck; 5 % beyond the round limits. The "
            "engine brackets were fitted to it",
            status="fitted",
            source="text",
        ),
        statement_claim(
            "flexible modes of the trimmed body",
            "9, from 19 to 43 Hz",
            f"{len(flexible)}, from {flexible[0]:.1f} to {flexible[-1]:.1f} Hz",
            len(flexible) == 9 and bool(np.allclose(flexible[[0, -1]], (19.0, 43.0), atol=0.5)),
            "the free body; its frame was fitted to these frequencies, so this says that the fit was carried through",
            status="fitted",
            source="text",
        ),
    ]


def roll_peak(response: FrequencyResponse, roll: float) -> float:
    """Frequency [Hz] of the resonance peak of the first channel that is nearest to the roll mode; NaN without peaks.

    A line without an estimate is stepped over: on the flank of a peak it would hide the peak.
    """
    magnitude = np.abs(response.response[0])
    known = np.isfinite(magnitude)
    quality = (values[0][known] for values in (response.coherence, response.random_error))
    peaks = resonance_peaks(response.frequency[known], magnitude[known], *quality)
    return min((peak.frequency_hz for peak in peaks), key=lambda at: abs(at - roll), default=float("nan"))


def roll_claims(peaks: Sequence[float], modes: Sequence[float]) -> list[Claim]:
    """Rows about roll where the source shows it: at the peak of the FRF of the seat rail, figures 3.3 and 3.37.

    Args:
        peaks: frequencies of the peaks with Ixx 1000 and with Ixx 1200 [Hz].
        modes: of the roll modes of the matrices, for the reasons [Hz].
    """
    published, improved = peaks
    off = [abs(value - MEASURED_ROLL) for value in peaks]
    matrices = " and ".join(f"{value:.2f}" for value in modes)
    return [
        number_claim(
            "roll peak of the seat rail FRF, low level, Ixx 1000 [Hz]",
            ROLL,
            published,
            ROUND * ROLL,
            f"simulated; the matrices have it at {modes[0]:.2f} Hz; printed with two digits: 5 %",
            status="predicted",
            source="text",
        ),
        statement_claim(
            "roll peak of the seat rail FRF, Ixx 1200 against 1000",
            "more than 10 % lower",
            f"{improved:.2f} Hz, {100 * (1 - improved / published):.0f} % lower",
            improved < LARGEST_SHARE * published,
            f"the matrices have it at {matrices} Hz. 20 % more about the origin double the smallest principal moment "
            "about the centre of gravity (155 to 347 kg m2, before the repair of the first), so it falls by more and "
            "mixes with pitch near 5 Hz",
            status="predicted",
            source="text",
        ),
        statement_claim(
            "roll peak of the seat rail FRF, Ixx 1200 against the measured 5.8 Hz",
            "nearer to it than with Ixx 1000",
            f"{off[1]:.2f} Hz off with 1200, {off[0]:.2f} Hz off with 1000",
            off[1] < off[0],
            "the source only says that the fit will improve, and that the decrease is larger than the 10 % it wanted; "
            "here it overshoots 5.8 Hz by more than Ixx 1000 misses it",
            status="predicted",
            source="inferred",
        ),
    ]


def mode_table(cars: Mapping[str, Car]) -> str:
    """Modes below 20 Hz of all cars beside each other."""
    columns = [car.modes("stuck", highest=20.0) for car in cars.values()]
    lines = ["Modes below 20 Hz, dampers stuck (natural frequency, damping ratio, what moves):", ""]
    lines += ["| " + " | ".join(cars) + " |", "|" + "---|" * len(cars)]
    for row in range(max(len(column) for column in columns)):
        cells = [_cell(column[row]) if row < len(column) else "" for column in columns]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _cell(mode: Mode) -> str:
    return f"{mode.frequency:.2f} Hz, {100 * mode.damping_ratio:.1f} %, {mode.description}"


def _list(values: Sequence[float]) -> str:
    return ", ".join(f"{value:.1f}" for value in values)
