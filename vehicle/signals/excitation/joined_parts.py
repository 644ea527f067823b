"""Parts of a long signal of the plates, joined to a short one: a car drives them one after the other.

Each part has a lead-in of `LEAD_S` from the signal itself. The first `BLEND_S` of the lead-in fade, by a half cosine,
from the continuation of the part before; the first part rises from the plane. One offset for all plates brings a part
to the height of the part before, so slopes and twists of the road remain.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vehicle.signals.analysis.samples import Vector
from vehicle.signals.excitation.iso_road import RISE_S
from vehicle.signals.excitation.rest import half_cosine_at
from vehicle.signals.excitation.road_drive import SKIP_S
from vehicle.signals.excitation.signal import Signal, uniform_time

LEAD_S, BLEND_S = SKIP_S, RISE_S
"""Lead-in of a part and its fade [s]: as at the start of a road."""


def joined_parts(signal: Signal, parts: Sequence[tuple[float, float]]) -> tuple[Signal, list[float]]:
    """Return the joined signal and the start of each part [s].

    Args:
        signal: plates without slopes of their own.
        parts: start and end of each part [s], in order, the first at least `LEAD_S` after the start of the signal.
    """
    step = signal.timestep
    lead, fade = round(LEAD_S / step), round(BLEND_S / step)
    segments: list[list[int]] = []
    starts: list[int] = []
    length = 0
    for begin, end in ((round(begin / step), round(end / step)) for begin, end in parts):
        # A part that begins within the lead-in of the next one, or before, continues.
        if not segments or begin - lead >= segments[-1][1]:
            segments.append([begin - lead, begin - lead])
        starts.append(length + begin - segments[-1][1])
        length += end - segments[-1][1]
        segments[-1][1] = end
    rise = half_cosine_at(np.asarray(np.arange(fade) * step), BLEND_S)
    pieces: list[Vector] = []
    offset, before = 0.0, np.zeros((len(signal.displacement), fade))
    plates = np.stack([*signal.displacement.values()])
    for begin, end in segments:
        piece = np.array(plates[:, begin:end])
        offset = float(np.mean(before - piece[:, :fade])) if pieces else -float(np.mean(piece[:, 0]))
        piece += offset
        piece[:, :fade] = rise * piece[:, :fade] + (1.0 - rise) * before
        pieces.append(piece)
        before = plates[:, end : end + fade] + offset
        if before.shape[1] < fade:  # the end of the signal: nothing follows
            break
    rows = np.concatenate(pieces, axis=1)
    return (
        replace(
            signal,
            time=uniform_time(samples=rows.shape[1], timestep=step),
            displacement=dict(zip(signal.displacement, rows, strict=True)),
            profile={},
        ),
        [start * step for start in starts],
    )
