"""Combine columns over frequency: real and imaginary part, magnitude and phase, coherence."""

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

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
        upper, lower = channels[indices[first]], channels[indices[second]]
        if first == "real":
            if lower.unit not in ("", upper.unit):
                continue
            values = np.asarray(upper.values + 1j * lower.values, dtype=np.complex128)
        else:
            unit = find_unit(lower.unit or "deg")
            if unit is None or unit.quantity != "angle":
                continue
            values = np.asarray(upper.values * np.exp(1j * unit.factor * lower.values), dtype=np.complex128)
        match = _PART.fullmatch(upper.name.strip())
        assert match is not None
        name = match["head"].strip() or "frequency response"
        remark = f"of the columns {upper.name!r} and {lower.name!r}" + (
            "; the phase is read in degrees" if first == "magnitude" and not lower.unit else ""
        )
        result[indices[first]] = replace(upper, name=name, values=values, function="frequency response", remark=remark)
        result[indices[second]] = None
    return tuple(channel for channel in result.values() if channel is not None)
