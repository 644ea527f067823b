"""Slip velocity and lower band edges of the inputs, which Bommer 2006 does not specify: sets of consistent values.

Bommer prints neither the velocity that counts as slip nor the lower edge of a band. The printed slip shares determine
pairs (slip velocity, shaker edge) and (slip velocity, road edge), each along a line. They are chosen together with
sides and body by half of the statements of the source (`scenarios.source_choice`): slip shares, bumps, comfort, levels
and modes.
"""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True, slots=True)
class SlipSet:
    """Consistent set of slip velocity and band edges.

    Attributes:
        slip_velocity: minimum damper velocity that counts as slip [m/s].
        shaker_edge_hz: lower band edge of the shaker inputs and of the noise around a bump, half power [Hz].
        road_edge_hz: lower band edge of the roads [Hz].
        log_likelihood: log-likelihood of the half of the statements used for the choice, sides and body as shipped.
    """

    slip_velocity: float
    shaker_edge_hz: float
    road_edge_hz: float
    log_likelihood: float

    def text(self) -> str:
        """Return the values as text, for a list of sets."""
        return (
            f"{1e3 * self.slip_velocity:g} mm/s, {self.shaker_edge_hz:g} Hz, {self.road_edge_hz:g} Hz "
            f"({self.log_likelihood:.1f})"
        )


def _set(velocity: float, shaker: float, road: float, log_likelihood: float) -> SlipSet:
    return SlipSet(slip_velocity=velocity, shaker_edge_hz=shaker, road_edge_hz=road, log_likelihood=log_likelihood)


CHOSEN = _set(0.006, 2.5, 0.017, -19.8)
"""Set used for shaker inputs, noise of the bumps, roads and `damper.slip_velocity` of the car.

From 4 to 9 mm/s the best edges are within 1 of the most likely set; 6 mm/s is the median of them. With 6 mm/s,
3 Hz is more likely by 0.3 than 2.5 Hz, which has the smallest deviation of the eight printed slip shares: all are
within 3 points.
"""

OTHERS = (
    _set(0.004, 2.5, 0.015, -20.0),
    _set(0.005, 2.5, 0.017, -19.3),
    _set(0.007, 3.0, 0.019, -19.6),
    _set(0.009, 4.0, 0.022, -20.0),
    _set(0.012, 6.0, 0.029, -21.5),
)
"""Best edges at other slip velocities; a difference of log-likelihood of 1 is insignificant."""


def sets_text() -> str:
    """Describe the chosen set and the other sets in one paragraph."""
    return (
        "The source does not publish the slip velocity and the lower band edges of shaker inputs and roads. "
        f"They were chosen together with sides and body on half of the source's statements: {CHOSEN.text()}. In "
        f"brackets: log-likelihood, larger is better. Other sets: {'; '.join(other.text() for other in OTHERS)}."
    )
