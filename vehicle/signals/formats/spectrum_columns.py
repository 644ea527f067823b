"""Combine columns over frequency: real and imaginary part, magnitude and phase, coherence."""

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vehicle.arrays import Vector
from vehicle.signals.formats.channel import Channel
from vehicle.signals.formats.units import find_unit

_PART = re.compile(
    r"(?P<head>.*?)[ _.:,-]*\(?(?:(?P<real>re|real)|(?P<imaginary>im|imag|imaginary)|(?P<magnitude>mag|magnitude|ampl?|"
    r"amplitude|abs|modulus)|(?P<phase>phase|angle|arg)|(?P<coherence>coh|coherence|gamma2))\)?(?:[ _]?part)?",
    re.IGNORECASE,
)


def joined(channels: Sequence[Channel]) -> tuple[Channel, ...]:
    """Combine real and imaginary parts, or magnitudes and phases, to frequency responses.

    Args:
        channels: columns over one frequency axis: `H real`, `H imag`; `H_magnitude`, `H_phase [deg]`; `H coherence`.

    Returns:
        Channels with responses in place of their first parts; other columns unchanged.
    """
    parts: dict[str, dict[str, int]] = {}
    for index, channel in enumerate(channels):
        match = _PART.fullmatch(channel.name.strip())
        if match:
            part = next(name for name, text in match.groupdict().items() if text and name != "head")
            parts.setdefault(match["head"].strip().lower(), {}).setdefault(part, index)
    result: dict[int, Channel | None] = dict(enumerate(channels))
    for indices in parts.values():
        if "coherence" in indices:
            result[indices["coherence"]] = replace(channels[indices["coherence"]], function="coherence")
        first, second = ("real", "imaginary") if "real" in indices else ("magnitude", "phase")
        if first not in indices or second not in indices:
            continue
        upper, lower, phase = channels[indices[first]], channels[indices[second]], ""
        if first == "real":
            if lower.unit not in ("", upper.unit):
                continue
            values = np.asarray(upper.values + 1j * lower.values, dtype=np.complex128)
        else:
            unit = find_unit(lower.unit or _angle_unit(np.asarray(lower.values, dtype=float)))
            if unit is None or unit.quantity != "angle":
                continue
            if not lower.unit:
                word = "degrees" if unit.factor < 1.0 else "radians"
                phase = f"; the phase has no unit and is read in {word}, {_why(word)}; write its unit into the header"
            values = np.asarray(upper.values * np.exp(1j * unit.factor * lower.values), dtype=np.complex128)
        match = _PART.fullmatch(upper.name.strip())
        assert match is not None
        name = match["head"].strip() or "frequency response"
        remark = f"of the columns {upper.name!r} and {lower.name!r}{phase}"
        result[indices[first]] = replace(upper, name=name, values=values, function="frequency response", remark=remark)
        result[indices[second]] = None
    return tuple(channel for channel in result.values() if channel is not None)


def _angle_unit(phase: Vector) -> str:
    """Return the unit of a phase (m,) without a unit: rad if a turn of 2 pi holds all values, else deg.

    Phases in radians within +-pi or 0 to 2 pi, and not beyond, are those of a response. In degrees they would be those
    of a response without any phase.
    """
    finite = phase[np.isfinite(phase)]
    turn = 2.0 * np.pi * (1.0 + 1e-6)
    return "rad" if finite.size and np.max(np.abs(finite)) <= turn and np.ptp(finite) <= turn else "deg"


def _why(word: str) -> str:
    return "because all values lie within a turn of 2 pi" if word == "radians" else "because its values exceed 2 pi"
