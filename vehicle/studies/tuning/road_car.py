"""Variants of a car of a fit on a road: the speed of the road turns the wheels."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle.runs.car import Car


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RoadCar:
    """Car of a fit on a road, and its variants with other parameters.

    A variant is made from the car on the road: the terms of its matrices are computed once for all variants
    (`Car.varied`).

    Attributes:
        start: car at the start of the fit, with standing tyres or the speed of its file.
        rolling: the same car with the parameters that the road sets, as driving.speed.
    """

    start: Car
    rolling: Car

    def variant(self, car: Car) -> Car:
        """Return a variant of `start` on the road.

        Args:
            car: variant, from `start.varied`.
        """
        return self.rolling.with_(car.overrides[len(self.start.overrides) :])
