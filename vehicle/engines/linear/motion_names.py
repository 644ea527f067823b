"""Names of the motions of a car by kinetic energy: the moving part, the axis and the phase.

A mode is split into motions that are orthogonal in M, so that their shares of the kinetic energy add up to 1: six rigid
motions of each part, the relative motion of the suspension links, and each mode of the flexible body. The motions a, b
of the right and the left wheel of an axle are taken either separately or as (a + b)/sqrt(2), in phase, and
(a - b)/sqrt(2), opposite, whichever contains the larger single share. A motion with half of the energy names the mode.
If there is none, front and rear axle are combined in the same way. Otherwise the two largest motions name the mode,
with their shares.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from vehicle.arrays import Complex
from vehicle.names import axle_and_side

RIGID_WORDS = ("fore-aft (x)", "lateral (y)", "heave (z)", "roll (Rx)", "pitch (Ry)", "yaw (Rz)")
"""Names of the rigid motions of a part: along x, y, z and about them."""

_ENGINE_WORDS = (*RIGID_WORDS[:2], "bounce (z)", *RIGID_WORDS[3:])
_WHEEL_WORDS = ("fore-aft", "lateral", "vertical", "camber", "wind-up", "steer")
_HOP = (8.0, 35.0)
"""Frequency range of wheel hop [Hz]: a vertical motion of a wheel on its tyre."""

NAMED = 0.5
"""Minimum share of the kinetic energy for a single motion to name a mode."""

_EQUAL = 1e-6
"""Round-off of a share: a motion with a share of 0.5 within it may be one of two equal halves."""


def mode_words(number: int, names: Sequence[str]) -> str:
    """Return "mode N", followed by the name of the mode in brackets if it has another name.

    Args:
        number: number of the mode of the free body, from 1.
        names: names of all modes; empty if they have no names.
    """
    name = names[number - 1] if names else ""
    return f"mode {number}" + (f" ({name})" if name not in ("", f"mode {number}") else "")


def motion_shares(
    rigid: Mapping[str, Complex], energy: Mapping[str, float], modal: Complex, names: Sequence[str], frequency: float
) -> dict[str, float]:
    """Return the shares of the kinetic energy of a mode by named motion, largest first; they add up to 1.

    Args:
        rigid: energy coordinates of each group of parts (see `rigid_rows`), scaled so that |.|^2 is a share; (6,).
        energy: share of each group, "flexible" for the modes of the body.
        modal: modal coordinates of the body in the same scale; (k,).
        names: names of the body modes.
        frequency: natural frequency of the mode [Hz].
    """
    wheels = {group.removeprefix("wheel_"): motion for group, motion in rigid.items() if group.startswith("wheel_")}
    axles: dict[str, dict[str, str]] = {}
    for wheel in wheels:
        axle, side = axle_and_side(wheel)
        axles.setdefault(axle, {})[side] = wheel
    shares: dict[str, float] = {}
    axis_labels = list(_WHEEL_WORDS)
    if _HOP[0] <= frequency <= _HOP[1]:
        axis_labels[2] = "hop"
    pairs: dict[str, dict[str, Complex]] = {}
    for axle, sides in axles.items():
        side_motions = {side: wheels[wheel] for side, wheel in sides.items()}
        pairs[axle] = _phases(side_motions, "sides") if len(side_motions) == 2 else {}
        for axis, word in enumerate(axis_labels):
            separate = {f"{side} {axle} wheel {word}": motion[axis] for side, motion in side_motions.items()}
            paired = {f"{axle} wheel {word}, {phase}": motion[axis] for phase, motion in pairs[axle].items()}
            shares |= _larger(separate, paired)
        total = sum(energy[f"wheel_{wheel}"] for wheel in sides.values())
        remainder = total - sum(float(np.sum(np.abs(motion) ** 2)) for motion in side_motions.values())
        shares[f"{axle} suspension links"] = max(0.0, remainder)
    for group, motion in rigid.items():
        if group in ("stabilizer", "flexible"):
            shares[group] = energy[group]
        elif not group.startswith("wheel_"):
            axis_words = _ENGINE_WORDS if group == "engine" else RIGID_WORDS
            shares |= {
                f"{group.replace('_', ' ')} {word}": _share(a) for word, a in zip(axis_words, motion, strict=True)
            }
    shares |= {group: share for group, share in energy.items() if group.startswith(("fluid of ", "decoupler of "))}
    shares |= {f"flexible body, {mode_words(n + 1, names)}": _share(q) for n, q in enumerate(modal)}
    if max(shares.values()) < NAMED * (1.0 + _EQUAL) and len(pairs) == 2 and all(pairs.values()):
        shares = _combine_axles(shares, pairs, axis_labels)
    return dict(sorted(shares.items(), key=lambda item: -item[1]))


def leading_motions(shares: Mapping[str, float]) -> dict[str, float]:
    """Return the motions that name a mode, with their shares: the motion with half of its energy, or the two largest.

    Args:
        shares: share of the kinetic energy by motion, largest first.
    """
    first, *others = shares.items()
    return dict([first] if first[1] >= NAMED else [first, *others[:1]])


def description(shares: Mapping[str, float]) -> str:
    """Return the name of a mode: its leading motion, or two with their shares; arguments as in `leading_motions`."""
    leading = leading_motions(shares)
    if len(leading) == 1:
        return next(iter(leading))
    return " with ".join(f"{name} ({100.0 * share:.0f} %)" for name, share in leading.items())


def _phases(pair: Mapping[str, Complex], word: str) -> dict[str, Complex]:
    """Return the orthogonal combinations of two motions: in phase and opposite."""
    first, second = pair.values()
    return {f"{word} in phase": (first + second) / np.sqrt(2.0), f"{word} opposite": (first - second) / np.sqrt(2.0)}


def _larger(separate: Mapping[str, complex], paired: Mapping[str, complex]) -> dict[str, float]:
    """Return the shares of the set with the larger maximum; both sets have the same sum."""
    sets = [{name: _share(value) for name, value in named.items()} for named in (paired, separate)]
    return max(sets, key=lambda shares: max(shares.values(), default=0.0))


def _combine_axles(
    shares: Mapping[str, float], pairs: Mapping[str, Mapping[str, Complex]], axis_labels: Sequence[str]
) -> dict[str, float]:
    """Combine the motions of both axles where the combination has half of the energy."""
    (front, front_phases), (rear, rear_phases) = pairs.items()
    for phase in front_phases:
        combined = _phases({front: front_phases[phase], rear: rear_phases[phase]}, "axles")
        for axis, word in enumerate(axis_labels):
            parts = {
                f"{front} and rear wheel {word}, {phase}, {axle_phase}": _share(combined[axle_phase][axis])
                for axle_phase in combined
            }
            replaced = {f"{axle} wheel {word}, {phase}" for axle in (front, rear)}
            if replaced <= shares.keys() and max(parts.values()) >= NAMED:
                return {name: share for name, share in shares.items() if name not in replaced} | parts
    return dict(shares)


def _share(value: complex) -> float:
    return float(abs(value) ** 2)
