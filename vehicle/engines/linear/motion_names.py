"""Names of the motions of a car by kinetic energy: which part moves, along or about which axis, with which phase.

A mode is split into motions that are orthogonal in M, so that their shares of the kinetic energy add up to 1: six rigid
motions of each part, what the links of a suspension do beside them, each mode of the flexible body. The motions a, b of
the right and the left wheel of an axle are taken either one by one or as (a + b)/sqrt(2), in phase, and
(a - b)/sqrt(2), opposite: the pair with the larger single share. A motion that holds half of the energy names the mode;
else front and rear axle are taken together in the same way; else the two largest motions name it with their shares.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from vehicle.names import axle_and_side

Complex = npt.NDArray[np.complex128]

RIGID_WORDS = ("fore-aft (x)", "lateral (y)", "heave (z)", "roll (Rx)", "pitch (Ry)", "yaw (Rz)")
"""Words for the rigid motions of a part: along x, y, z and about them."""

_ENGINE_WORDS = (*RIGID_WORDS[:2], "bounce (z)", *RIGID_WORDS[3:])
_WHEEL_WORDS = ("fore-aft", "lateral", "vertical", "camber", "wind-up", "steer")
_HOP = (8.0, 35.0)
"""Natural frequencies between which a wheel that moves vertically hops on its tyre [Hz]."""

NAMED = 0.5
"""Share of the kinetic energy from which one motion names a mode."""

_EQUAL = 1e-6
"""Round-off in a share: what holds half within it may as well be one of two equal halves."""


def mode_words(number: int, names: Sequence[str]) -> str:
    """Number of a mode of the free body, and its name where it has another one.

    Args:
        number: of the mode, from 1.
        names: of all modes; none where they have no names.
    """
    name = names[number - 1] if names else ""
    return f"mode {number}" + (f" ({name})" if name not in ("", f"mode {number}") else "")


def motion_shares(
    rigid: Mapping[str, Complex], energy: Mapping[str, float], modal: Complex, names: Sequence[str], frequency: float
) -> dict[str, float]:
    """Shares of the kinetic energy of a mode by named motion, largest first; they add up to 1.

    Args:
        rigid: energy coordinates of each group of parts as of `rigid_rows`, scaled so that |.|^2 is a share; (6,).
        energy: share of each group, "flexible" for the modes of the body.
        modal: coordinates of these modes in the same scale; (k,).
        names: of these modes.
        frequency: natural frequency of the mode [Hz].
    """
    wheels = {group.removeprefix("wheel_"): motion for group, motion in rigid.items() if group.startswith("wheel_")}
    axles: dict[str, dict[str, str]] = {}
    for wheel in wheels:
        axle, side = axle_and_side(wheel)
        axles.setdefault(axle, {})[side] = wheel
    shares: dict[str, float] = {}
    words = list(_WHEEL_WORDS)
    if _HOP[0] <= frequency <= _HOP[1]:
        words[2] = "hop"
    pairs: dict[str, dict[str, Complex]] = {}
    for axle, sides in axles.items():
        own = {side: wheels[wheel] for side, wheel in sides.items()}
        pairs[axle] = _phases(own, "sides") if len(own) == 2 else {}
        for axis, word in enumerate(words):
            parted = {f"{side} {axle} wheel {word}": motion[axis] for side, motion in own.items()}
            together = {f"{axle} wheel {word}, {phase}": motion[axis] for phase, motion in pairs[axle].items()}
            shares |= _larger(parted, together)
        whole = sum(energy[f"wheel_{wheel}"] for wheel in sides.values())
        rest = whole - sum(float(np.sum(np.abs(motion) ** 2)) for motion in own.values())
        shares[f"{axle} suspension links"] = max(0.0, rest)
    for group, motion in rigid.items():
        if group in ("stabilizer", "flexible"):
            shares[group] = energy[group]
        elif not group.startswith("wheel_"):
            kinds = _ENGINE_WORDS if group == "engine" else RIGID_WORDS
            shares |= {f"{group.replace('_', ' ')} {word}": _share(a) for word, a in zip(kinds, motion, strict=True)}
    shares |= {f"flexible body, {mode_words(n + 1, names)}": _share(q) for n, q in enumerate(modal)}
    if max(shares.values()) < NAMED * (1.0 + _EQUAL) and len(pairs) == 2 and all(pairs.values()):
        shares = _with_axles_together(shares, pairs, words)
    return dict(sorted(shares.items(), key=lambda item: -item[1]))


def description(shares: Mapping[str, float]) -> str:
    """Name of a mode: the motion with half of its energy, else the two largest with their shares.

    Args:
        shares: by motion, largest first.
    """
    (first, most), *others = shares.items()
    if most >= NAMED or not others:
        return first
    second, share = others[0]
    return f"{first} ({100.0 * most:.0f} %) with {second} ({100.0 * share:.0f} %)"


def _phases(pair: Mapping[str, Complex], word: str) -> dict[str, Complex]:
    """In phase and opposite: the orthogonal combinations of two motions."""
    one, other = pair.values()
    return {f"{word} in phase": (one + other) / np.sqrt(2.0), f"{word} opposite": (one - other) / np.sqrt(2.0)}


def _larger(parted: Mapping[str, complex], together: Mapping[str, complex]) -> dict[str, float]:
    """Shares of the set whose largest one is larger; the sums of both sets are the same."""
    sets = [{name: _share(value) for name, value in named.items()} for named in (together, parted)]
    return max(sets, key=lambda one: max(one.values(), default=0.0))


def _with_axles_together(
    shares: Mapping[str, float], pairs: Mapping[str, Mapping[str, Complex]], words: Sequence[str]
) -> dict[str, float]:
    """The shares with the motion of both axles as one where that holds half of the energy."""
    (front, own), (rear, other) = pairs.items()
    for phase in own:
        both = _phases({front: own[phase], rear: other[phase]}, "axles")
        for axis, word in enumerate(words):
            parts = {f"{front} and rear wheel {word}, {phase}, {way}": _share(both[way][axis]) for way in both}
            gone = {f"{axle} wheel {word}, {phase}" for axle in (front, rear)}
            if gone <= shares.keys() and max(parts.values()) >= NAMED:
                return {name: share for name, share in shares.items() if name not in gone} | parts
    return dict(shares)


def _share(value: complex) -> float:
    return float(abs(value) ** 2)
