"""Mode that causes the weighted vibration of a run in a band, and the path of this mode into the body."""

from collections.abc import Mapping, Sequence

import numpy as np

from vehicle.engines.linear.car_modes import Mode
from vehicle.engines.linear.mode_shares import mode_shares
from vehicle.engines.linear.path_shares import REST, path_shares
from vehicle.errors import ConfigurationError
from vehicle.names import CORNERS, point_words
from vehicle.runs.car.main_mode import mode_of, plate_lines
from vehicle.runs.car.order_points import RESONANT
from vehicle.runs.report.findings import damper_state
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.main_band import POINT, MainBand

LINES = 400
"""Number of spectral lines of a band that determine the shares of the modes."""

WORDS = {
    "arm_front": "control arm bearing at the front",
    "arm_rear": "control arm bushing at the rear",
    "damper_mount": "damper mount",
    "hydromount": "hydraulic engine mount",
    "linear_mount": "engine mount",
    "lower_front_inner": "lower link at the front",
    "lower_rear_inner": "lower link at the rear",
    "main_spring": "spring",
    "pivot": "bushing of the trailing arm",
    "stab_body": "anti-roll bar bearing",
    "tie_inner": "tie rod",
    "torque_arm_body": "torque arm",
    "trailing_lower_inner": "lower trailing link",
    "trailing_upper_inner": "upper trailing link",
    "upper_inner": "upper link",
}
"""Words for elements of the templates whose names are short."""

MAIN = 0.5
"""Minimum share of a path that is named, and limit of the sum of all that oppose it."""

OTHER_SIDE = 0.25
"""Minimum share of a side in the sum of both sides, for which both sides are named together."""


def strongest(run: FinishedRun, band: MainBand, modes: Sequence[Mode]) -> Mode | None:
    """Return the mode in resonance in a band of the seat rail with the largest share there.

    The plates move as in the run, at the lines of its periodogram; the state of the dampers is that of most of the run.

    Args:
        modes: modes of the car in this state of the dampers.

    Returns:
        The mode; None if no plate is recorded, or no mode that can cause the band (`MainBand.explained_by`) has at
        least `RESONANT` of it: a mode outside it only passes the vibration on.
    """
    system = run.car.matrices.system
    lines = plate_lines(run.recording, system.inputs, run.evaluated, (band.low, band.high), LINES)
    if lines is None:
        return None
    stuck = damper_state(run) == "stuck"
    result = mode_shares(system, f"{POINT}_acc_{band.axis}", lines.frequency, lines.plates, stuck=stuck)
    for at in np.argsort(-result.shares).tolist():
        if result.shares[at] < RESONANT:
            break
        mode = mode_of(modes, result, at)
        if mode is not None and band.explained_by(mode.frequency):
            return mode
    return None


def paths(run: FinishedRun, axis: str, mode: Mode) -> dict[str, float]:
    """Return attachments of the body to their shares in a mode at the seat rail; empty if it is not on the body.

    Args:
        run: the run, whose dampers stick or slide as during most of it.
        axis: axis of the acceleration, "x", "y" or "z".
        mode: mode of its car in this state of the dampers.
    """
    car, channel, stuck = run.car, f"{POINT}_acc_{axis}", damper_state(run) == "stuck"
    try:
        result = path_shares(car.model, car.matrices, car.load_rows, channel, mode.frequency, stuck=stuck)
    except ConfigurationError:
        return {}
    return {name: float(share) for name, share in zip(result.names, result.shares, strict=True) if name != REST}


def main_path(shares: Mapping[str, float]) -> str:
    """Return the path that carries most of a mode in words, with its share; empty without a main path.

    Both sides of an axle are named together if each of them carries `OTHER_SIDE` of their sum. None is named if it
    carries less than `MAIN` of the sum, or if the others oppose it by more: large paths that cancel explain nothing.
    """
    corners = {name: corner.replace("_", " ").split() for corner, name in CORNERS.items()}
    groups: dict[tuple[str, str], dict[str, float]] = {}
    for name, share in shares.items():
        part, _, corner = name.rpartition("_")
        axle, side = corners.get(corner, ["", ""]) if part else ["", ""]
        groups.setdefault((axle, part if axle else name), {})[side] = share
    singles = {(axle, side, part): share for (axle, part), sides in groups.items() for side, share in sides.items()}
    pairs = {
        (axle, "", part): sum(sides.values())
        for (axle, part), sides in groups.items()
        if len(sides) == 2 and min(sides.values()) >= OTHER_SIDE * sum(sides.values())
    }
    paths_of = singles | pairs
    axle, side, part = max(paths_of, key=lambda key: paths_of[key], default=("", "", ""))
    share = paths_of.get((axle, side, part), 0.0)
    if share < MAIN or -sum(min(each, 0.0) for each in shares.values()) > MAIN:
        return ""
    name = " ".join(word for word in ("the", axle, side, WORDS.get(part, point_words(part))) if word)
    both = ", left and right" if (axle, side, part) in pairs else ""
    # A share above the whole, which others reduce, would only puzzle.
    return name + both + (f" ({100.0 * share:.0f} %)" if share <= 1.0 else "")
