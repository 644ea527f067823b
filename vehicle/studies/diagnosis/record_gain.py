"""Test of the units of a record: the gain that all its accelerations share, estimated from the record itself.

A linear car gives the same record on a road that is g times as high and by sensors of g times the gain. The friction of
the dampers, the bends of their curves and the noise of the sensors do not grow with the road: they show the roughness
of the road. Each simulated drive is multiplied by a random gain, ln g uniform from -ln `LARGEST` to ln `LARGEST`, and
ln g is learned from the features as every other unknown (`vehicle.studies.diagnosis.learned`). A record in the right
unit has g = 1. A car without friction shows no gain, and passes: its dampers show in any unit.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector
from vehicle.studies.diagnosis.learned import Learned

LARGEST = 15.0
"""Largest gain and inverse of the smallest one [-]: beyond g in place of m/s2, the usual mistake."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Gain:
    """Gain of a record.

    Attributes:
        factor: estimate of g [-].
        apart: distance of ln g from 0, over the standard deviation of its posterior [-].
    """

    factor: float
    apart: float


class GainTest:
    """Regression of the gain over the features.

    Args:
        features: features of the simulated drives; (n, p).
        densities: number of the first features that are logarithms of densities; a gain adds 2 ln g to them.
        block: number of successive drives that share a car or a road.
    """

    def __init__(self, features: Vector, densities: int, block: int) -> None:
        rng = np.random.Generator(np.random.PCG64(0))
        gain = rng.uniform(-np.log(LARGEST), np.log(LARGEST), len(features))
        scaled = features.copy()
        scaled[:, :densities] += 2.0 * gain[:, None]
        self.learned = Learned(scaled, np.column_stack([gain, scaled[:, :densities].mean(axis=1)]), block)

    def gain(self, features: Vector) -> Gain:
        """Return the gain of a record with these features; (p,)."""
        posterior = self.learned.posteriors(features)[0]
        return Gain(factor=float(np.exp(posterior.mean)), apart=abs(posterior.mean) / posterior.deviation)
