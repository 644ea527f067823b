"""Combine columns over frequency: real and imaginary part, magnitude and phase, coherence."""

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vehicle.digits import number
from vehicle.errors import DataError
from vehicle.signals.formats.channel import Channel
from vehicle.signals.formats.units import find_unit

EDGE = 2.5
"""Minimum change of a phase in radians over a resonance, which is about pi [rad]."""

DEGREES = 45.0
"""Largest phase that may be in radians, unwrapped over seven turns; phases in degrees reach +-180."""

_PART = re.compile(
    r"(?P<head>.*?)[ _.:,-]*\(?(?:(?P<real>re|real)|(?P<imaginary>im|imag|imaginary)|(?P<magnitude>mag|magnitude|ampl?|"
    r"amplitude|abs|modulus)|(?P<phase>phase|angle|arg)|(?P<coherence>coh|coherence|gamma2))\)?(?:[ _]?part)?",
    re.IGNORECASE,
)


def joined(where: object, channels: Sequence[Channel]) -> tuple[Channel, ...]:
    """Combine real and imaginary parts, or magnitudes and phases, to frequency responses.

    Args:
        where: file, for messages.
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
            unit = find_unit(lower.unit or _angle_unit(where, upper, lower))
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


def _angle_unit(where: object, magnitude: Channel, phase: Channel) -> str:
    """Return the unit of a phase (m,) without a unit; phases in degrees of a narrow band may lie within 2 pi, too.

    Radians lie within a turn, which they fill: they jump by 2 pi, or change by more than `EDGE` over a resonance, where
    degrees change by about 180.

    Raises:
        DataError: no value is beyond `DEGREES`, and the phase is not clearly in radians.
    """
    known = np.isfinite(phase.values) & np.isfinite(magnitude.values)
    angle, size = np.asarray(phase.values[known], dtype=float), np.abs(magnitude.values[known])
    largest = float(np.max(np.abs(angle))) if angle.size else 0.0
    turn = 2.0 * np.pi * (1.0 + 1e-6)
    if largest > DEGREES:
        return "deg"
    extent = float(np.ptp(angle)) if angle.size else 0.0
    jumps = angle.size > 1 and float(np.max(np.abs(np.diff(angle)))) > 2.0 * EDGE
    resonates = size.size > 0 and float(np.max(size)) > 2.0 * max(size[0], size[-1])
    if EDGE < extent <= turn and (jumps or resonates):
        return "rad"
    raise DataError(
        f"{where}: the phase {phase.name!r} has no unit, and its values (at most {number(largest, 3)}) may be degrees "
        f"or radians; write {phase.name} [deg] or {phase.name} [rad] into the header"
    )


def _why(word: str) -> str:
    return (
        "because all values lie within a turn of 2 pi"
        if word == "radians"
        else f"because its values exceed {DEGREES:g}"
    )
