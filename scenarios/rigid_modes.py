"""Rigid body modes of a car, and rows on the modes that a change for the sake of the roll mode moves (section 3.4)."""

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.optimize import brentq, linear_sum_assignment

from scenarios.car_runs import CarRuns
from scenarios.claims import PREDICTED, Claim
from scenarios.evidence import MODE_ERROR
from scenarios.verdict import common
from vehicle.arrays import Vector
from vehicle.engines.linear.car_modes import Mode
from vehicle.model.parameters.paths import value_of
from vehicle.runs.car import Car

ROLL, MEASURED_ROLL = 6.5, 5.8
"""Roll mode (Rx) of the model of the source with Ixx 1000, and of the measured car [Hz]."""

ROUND = 0.05
"""Printed with one or two digits, limits of a range, or read off a figure: 5 %."""

ROLL_COORDINATE = 3
"""Of the six of a rigid body: x, y, z, Rx, Ry, Rz."""


def roll_mode(car: Car) -> Mode:
    """Return the mode, dampers stuck, with the largest share of its kinetic energy in the roll of the body."""
    return max(car.modes("stuck"), key=lambda mode: _shares(car, mode)[ROLL_COORDINATE])


def _shares(car: Car, mode: Mode) -> Vector:
    """Return the shares of the kinetic energy of a mode in the six coordinates of the body [-], (6,)."""
    velocity = car.matrices.body_rows["body"] @ mode.shape
    parts = np.real(np.conj(velocity) * (car.matrices.body_masses["body"] @ velocity))
    return np.asarray(mode.energy["body"] * parts / np.sum(parts))


def led_by(modes: Sequence[Mode], part: str) -> list[Mode]:
    """Return the modes with the largest share of their energy in a part."""
    return [mode for mode in modes if max(mode.energy, key=lambda name: mode.energy[name]) == part]


RIGID = ("fore-aft", "lateral", "heave", "roll", "pitch", "yaw")
"""Words for the six coordinates of the body, x, y, z, Rx, Ry, Rz."""

Rigid = Mapping[str, float]
"""Word of `RIGID` to the frequency of its mode [Hz], dampers stuck."""


def rigid_modes(car: Car) -> Rigid:
    """Return the frequencies of the rigid body modes.

    Each mode is assigned to a single coordinate; the assignment has the largest sum of the shares of energy in the
    coordinates, as heave and pitch may have their largest shares in the same mode.
    """
    modes = led_by(car.modes("stuck"), "body")
    coordinates, numbers = linear_sum_assignment([[-share for share in _shares(car, mode)] for mode in modes])[::-1]
    found = {
        RIGID[coordinate]: modes[number].frequency for coordinate, number in zip(coordinates, numbers, strict=True)
    }
    return {word: found[word] for word in RIGID}


STABILIZER = "front.stabilizer.torsional_stiffness=3000.0"
"""Bar before the tuning of the thesis [N m/rad]; tuned: 5000 (section 3.2.1.1)."""

TYRE = "bushings.tyre.stiffness.z"

BADLY = (0.02, 0.05, 0.1)
"""Changes of a frequency beyond which a mode may be called badly tuned [-]."""


def rolled_by_tyres(runs: CarRuns) -> tuple[float, Rigid]:
    """Return the vertical stiffness of the tyres that brings the roll mode to the measured one [N/m], and the modes."""
    printed = float(value_of(runs.car().vehicle, TYRE))

    def car(factor: float) -> Car:
        return runs.car(("body.inertia.ixx=1000", f"{TYRE}={factor * printed!r}"))

    factor = brentq(lambda factor: roll_mode(car(factor)).frequency - MEASURED_ROLL, 0.4, 1.0, xtol=1e-3)
    return factor * printed, rigid_modes(car(factor))


def tuning_claims(first: Rigid, heavier: Rigid, softer: Rigid, by_tyre: tuple[float, Rigid]) -> list[Claim]:
    """Return the rows on the rigid body modes that a change for the sake of the roll mode moves.

    Args:
        first: with Ixx 1000.
        heavier: with Ixx 1200.
        softer: with the stabilizer before its tuning.
        by_tyre: stiffness of the tyres for the measured roll mode [N/m], and the modes with it.
    """
    rule = f"no change: within {100.0 * MODE_ERROR:g} %, what the rounding of a tuned stiffness changes"
    stiffness, tuned = by_tyre
    return [
        PREDICTED.statement(
            "other rigid body modes, Ixx 1200 against 1000",
            "no change",
            _changes(first, heavier),
            max(_moved(first, heavier).values()) <= MODE_ERROR,
            f"{rule}; dampers stuck, each mode named by the coordinate of the body that has most of its energy. The "
            "roll mode comes near the pitch mode, and both mix",
        ).at("section 3.4"),
        PREDICTED.statement(
            "stabilizer of 3 to 5 kN m/rad moves a rigid body mode",
            "tuned by it",
            f"{_changes(softer, first)}, roll {100.0 * (first['roll'] / softer['roll'] - 1.0):+.1f} %",
            max(*_moved(softer, first).values(), abs(first["roll"] / softer["roll"] - 1.0)) > MODE_ERROR,
            f"rule: some mode by more than {100.0 * MODE_ERROR:g} %; on the rig the body rolls on stuck struts, whose "
            "mounts and tyres are far stiffer in roll than the bar. The source does not tell which mode it tuned so",
        ).at("section 3.2.1.1"),
        PREDICTED.statement(
            "other rigid body modes with the roll mode tuned to 5.8 Hz by the tyres",
            "three others badly tuned",
            _changes(first, tuned),
            common(sum(change > limit for change in _moved(first, tuned).values()) >= 3 for limit in BADLY),
            f"tyres of {stiffness:.3g} N/m along z, Ixx 1000; badly is no number: at least three of the five by "
            f"more than each of {', '.join(f'{100.0 * limit:g}' for limit in BADLY)} %. The source does not tell "
            "by which parameters it tried",
        ).at("section 3.4"),
    ]


def _moved(before: Rigid, after: Rigid) -> dict[str, float]:
    """Return the magnitudes of the changes of the modes other than roll [-]."""
    return {word: abs(after[word] / value - 1.0) for word, value in before.items() if word != "roll"}


def _changes(before: Rigid, after: Rigid) -> str:
    return ", ".join(
        f"{word} {after[word]:.2f} Hz ({100.0 * (after[word] / value - 1.0):+.1f} %)"
        for word, value in before.items()
        if word != "roll"
    )
