"""Points of a map of levels: what the iteration needs, and their states from zero, from below and from above."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Complex, Indices, Vector
from vehicle.engines.steady.cycle import Cycle
from vehicle.engines.steady.law_ports import Port
from vehicle.engines.steady.splitting import LADDER, PeriodicForces, PresentLoad, periodic_forces


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Points:
    """Arguments of `periodic_forces` of n points.

    Attributes:
        effects: motion of each port against a force of each; (n, ports, ports, k).
        linear: motions of all rows without forces of the ports; (n, r, k).
        at: rows of the ports.
        scaling: lambda; (n, ports).
        present: forces of rolling tyres; None if no tyre rolls.
    """

    effects: Complex
    linear: Complex
    at: Sequence[int]
    scaling: Vector
    present: PresentLoad | None

    def states(self, ports: Sequence[Port], cycle: Cycle, tolerance: float = 1e-7) -> PeriodicForces:
        """Return the states that the iteration reaches from zero."""
        drive = self.linear[:, self.at]
        return periodic_forces(
            ports, cycle, self.effects, drive, self.scaling, present=self.present, tolerance=tolerance
        )

    def branches(self, ports: Sequence[Port], cycle: Cycle, frequencies: int) -> list[PeriodicForces]:
        """Return the states from below and from above: each level starts at the state of the last one.

        Args:
            ports, cycle: see `periodic_forces`.
            frequencies: their number f; the points are (f, levels).
        """
        upwards = np.arange(len(self.linear)).reshape(frequencies, -1).T
        return [self._followed(ports, cycle, way) for way in (upwards, upwards[::-1])]

    def _followed(self, ports: Sequence[Port], cycle: Cycle, way: Indices) -> PeriodicForces:
        """Return the states of points in the order of their levels, (l, f); each level starts at the last state."""
        drive, parts = self.linear[:, self.at], list[PeriodicForces]()
        for points in way:
            present = None if self.present is None else self.present.at(points)
            start = parts[-1] if parts else None
            parts.append(
                periodic_forces(
                    ports,
                    cycle,
                    self.effects[points],
                    drive[points],
                    self.scaling[points],
                    present=present,
                    ladder=LADDER[:1],
                    start=start,
                )
            )
        order = np.argsort(way.ravel())
        joined = {
            name: np.concatenate([getattr(part, name) for part in parts])[order] for name in PeriodicForces.__slots__
        }
        return PeriodicForces(**joined)
