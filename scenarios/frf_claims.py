"""Statements of chapter 3 about all FRFs at once: their size against the axes, and their coherence."""

from collections.abc import Mapping, Sequence
from operator import itemgetter

import numpy as np

from scenarios.claims import PREDICTED, Claim, interval_claim
from vehicle.arrays import Vector
from vehicle.signals.analysis.frf import FrequencyResponse

FRF_AXIS = (1e1, 1e5)
"""Ends of the axes of the FRFs [(m/s2)/m]."""

FRF_END = 50.0
"""End of the range of interest [Hz]."""

SATISFACTORY, COHERENCE_BAND = 0.5, 5.0
"""Least median coherence [-] that is called satisfactory: half of the power is from the plate; in bands of this width
[Hz], so that an antiresonance alone does not count."""


def axis_claims(
    responses: Mapping[str, FrequencyResponse], names: Sequence[str], rigid: Vector | None = None
) -> list[Claim]:
    """Return the rows on the extreme lines of all FRFs against the axes of figures 3.3 to 3.36.

    Args:
        responses: level to FRFs.
        names: names of the rows of the FRFs.
        rigid: |H| of the rows at 1 Hz for a car with a rigid body and stuck dampers, as evidence for the reason of a
            line below the axis.
    """
    lines = [
        (float(magnitude), f"{channel}, {level}, {frequency:.3g} Hz")
        for level, response in responses.items()
        for channel, row in zip(names, np.abs(response.response), strict=True)
        for frequency, magnitude in zip(response.frequency, row, strict=True)
        if np.isfinite(magnitude)
    ]
    sizes = np.array([value for value, _ in lines])
    below, above = (100.0 * float(np.mean(outside)) for outside in (sizes < FRF_AXIS[0], sizes > FRF_AXIS[1]))
    reasons = {"largest": f"{above:.1f} % of all lines above the axis", "smallest": f"{below:.1f} % below it"}
    if rigid is not None:
        low = [f"{name} {value:.1f}" for name, value in zip(names, rigid, strict=True) if value < FRF_AXIS[0]]
        reasons["smallest"] += (
            f"; experiment: with a rigid body too {len(low)} outputs are below {FRF_AXIS[0]:g} at 1 Hz "
            f"({', '.join(low)}), where the plate has {(2.0 * np.pi) ** 2:.0f} (m/s2)/m and an output its share of the "
            "static lift: this axis cuts off lines of any such rig"
        )
    return [
        interval_claim(
            f"{word} line of the FRFs, 1 to 50 Hz [(m/s2)/m]",
            FRF_AXIS,
            value,
            f"{where}; every figure from 3.3 to 3.36 has this axis; {len(names)} outputs, {len(responses)} levels, "
            f"{reasons[word]}",
        ).at("figures 3.3 to 3.36")
        for word, extreme in (("largest", max), ("smallest", min))
        for value, where in [extreme(lines, key=itemgetter(0))]
    ]


def least_coherence(response: FrequencyResponse) -> float:
    """Return the lowest median coherence [-] of any output in any band up to `FRF_END`.

    Lines below the axis of the thesis are excluded: an antiresonance contains only noise.
    """
    seen = np.isfinite(response.coherence) & (np.abs(response.response) >= FRF_AXIS[0])
    bands = [
        (response.frequency >= low) & (response.frequency <= low + COHERENCE_BAND)
        for low in np.arange(0.0, FRF_END, COHERENCE_BAND)
    ]
    medians = [
        np.median(row[band & kept])
        for row, kept in zip(response.coherence, seen, strict=True)
        for band in bands
        if np.any(band & kept)
    ]
    return float(np.min(medians))


def coherence_claim(
    responses: Mapping[str, FrequencyResponse], knuckle: int, less_friction: FrequencyResponse | None = None
) -> Claim:
    """Return the row on the coherences of the model.

    Args:
        responses: level to FRFs.
        knuckle: index of the row of the knuckle over the shaker plate.
        less_friction: FRFs at the high level with a tenth of the friction, as evidence for a reason.
    """
    lowest = {level: least_coherence(response) for level, response in responses.items()}
    knuckle_lowest = min(float(np.nanmin(response.coherence[knuckle])) for response in responses.values())
    why = (
        f"satisfactory is no number: median of at least {SATISFACTORY:g}, half of the power, in every "
        f"{COHERENCE_BAND:g} Hz at every output; lines below the axis are left out; the knuckle has at least "
        f"{knuckle_lowest:.2f} at every line"
    )
    if less_friction is not None:
        why += f"; experiment: with a tenth of the friction the high level has {least_coherence(less_friction):.2f}"
    return PREDICTED.statement(
        "coherence of the model, low, mid and high",
        f"satisfactory up to {FRF_END:g} Hz",
        "least median " + ", ".join(f"{value:.2f} ({level})" for level, value in lowest.items()),
        min(lowest.values()) >= SATISFACTORY,
        why,
    ).at("section 3.3", "knuckle_z.png")
