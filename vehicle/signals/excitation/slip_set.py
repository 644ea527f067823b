"""What counts as slip, and how far down the inputs go: one set of numbers that the source does not give.

Source 1 prints neither the velocity that counts as slip nor the lower edge of a band. Slip shares fix pairs (slip
velocity, shaker edge) and (slip velocity, road edge), each along a line. They are chosen together with sides and body
on half of what the source says (`scenarios.source_choice`): slip shares, bumps, comfort, levels and modes.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True, slots=True)
class SlipSet:
    """Numbers that go together.

    Attributes:
        slip_velocity: damper velocity above which time counts as slip [m/s].
        shaker_edge_hz: lower edge of the shaker inputs and of the noise beside a bump, half power [Hz].
        road_edge_hz: lower edge of the roads [Hz].
        log_likelihood: of the half that chose, sides and body as shipped.
    """

    slip_velocity: float
    shaker_edge_hz: float
    road_edge_hz: float
    log_likelihood: float

    def text(self) -> str:
        """For a table of sets."""
        return (
            f"{1e3 * self.slip_velocity:g} mm/s, {self.shaker_edge_hz:g} Hz, {self.road_edge_hz:g} Hz "
            f"({self.log_likelihood:.1f})"
        )


def _set(velocity: float, shaker: float, road: float, log_likelihood: float) -> SlipSet:
    return SlipSet(slip_velocity=velocity, shaker_edge_hz=shaker, road_edge_hz=road, log_likelihood=log_likelihood)


CHOSEN = _set(0.006, 2.5, 0.017, -19.8)
"""Shaker inputs, noise of the bumps, roads and `damper.slip_velocity` of the car.

From 4 to 9 mm/s the best edges are within 1 of the most likely set; 6 mm/s is the median of them. With it 3 Hz is more
likely by 0.3 than 2.5 Hz, with which the eight printed slip shares deviate least: all are within 3 points.
"""

OTHERS = (
    _set(0.004, 2.5, 0.015, -20.0),
    _set(0.005, 2.5, 0.017, -19.3),
    _set(0.007, 3.0, 0.019, -19.6),
    _set(0.009, 4.0, 0.022, -20.0),
    _set(0.012, 6.0, 0.029, -21.5),
)
"""Best edges at other slip velocities; a difference of 1 is not worth more than a bare mention."""


def sets_text() -> str:
    """The chosen set and the others, one paragraph."""
    return (
        "Slip velocity, lower edge of the shaker inputs and of the roads are one set, not published and chosen with "
        f"sides and body on half of the statements of the source (in brackets its log-likelihood): {CHOSEN.text()}. "
        f"Others: {'; '.join(other.text() for other in OTHERS)}."
    )
