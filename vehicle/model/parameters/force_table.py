"""Force of an element over its displacement, as a table of a vehicle file."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle.model.parameters.curves import require_curve
from vehicle.model.parameters.quantity import quantity, validate


@dataclass(frozen=True, kw_only=True, slots=True)
class ForceTable:
    """Force over displacement through points, positive in extension; outer segments are extrapolated."""

    displacement: tuple[float, ...] = quantity("m", "displacements, compression negative", at_least=-2.0, at_most=2.0)
    force: tuple[float, ...] = quantity("N", "forces, compression negative", at_least=-1e7, at_most=1e7)

    def __post_init__(self) -> None:
        validate(self)
        require_curve("ForceTable", "displacement", self.displacement, self.force)

    @property
    def opposite(self) -> ForceTable:
        """Table -F(-x) of the opposite direction, for the y axis on the other side of a car."""
        return ForceTable(
            displacement=tuple(-x for x in reversed(self.displacement)), force=tuple(-f for f in reversed(self.force))
        )
