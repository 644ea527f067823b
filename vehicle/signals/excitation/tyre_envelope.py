"""Enveloping of a road by a tyre with two elliptical cams, a front cam and a rear cam.

The centre of each cam is as low as the profile z(x) allows. The lower edge at the offset u from the centre is
b - b e(u) above the lowest point, with e(u) = (1 - |u/a|^c)^(1/c). The lowest point of a cam at X is at the height

    Z(X) = max over |x - X| <= a of [z(x) + b e(x - X)] - b,

and the tyre with its middle at X has the effective height w and the effective slope tan(beta)

    w = (Z(X + s/2) + Z(X - s/2)) / 2,        tan(beta) = (Z(X + s/2) - Z(X - s/2)) / s.

On a straight segment of slope m the maximum is at u = a sign(m) (q / (1 + q))^(1/c), q = (|m| a / b)^(c / (c - 1)), or
at the nearest end of the segment: Z is exact for a road of straight lines. Small waves pass with the factor
cos(pi n s), as they move both cams and turn none around a corner.

Source: Schmeitz, A semi-empirical three-dimensional model of the pneumatic tyre rolling over arbitrarily uneven road
surfaces, TU Delft 2004; Pacejka, Tire and Vehicle Dynamics, 3rd ed., section 10.1.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Self

import numpy as np
from numpy.typing import NDArray

from vehicle.signals.analysis.samples import Vector
from vehicle.signals.excitation.band import positive

SAMPLES = 0.005
"""Maximum distance of the points between which a random road is taken as straight [m]; RMS error of the effective
height on class C: 1.6 um."""

BLOCK = 2048
"""Number of positions evaluated together, which limits the memory."""


@dataclass(frozen=True, kw_only=True, slots=True)
class CamSet:
    """Numbers of two elliptical cams without dimension, with the names of property files of MF-Swift.

    Attributes:
        shift: distance of the cams over the length of the contact patch (ELLIPS_SHIFT).
        length: half length of a cam over the free radius of the tyre (ELLIPS_LENGTH).
        height: half height of a cam over the free radius of the tyre (ELLIPS_HEIGHT).
        order: exponent c of the ellipse (ELLIPS_ORDER).
        source: origin of the numbers.
    """

    shift: float
    length: float
    height: float
    order: float
    source: str


CAM_SETS: Mapping[str, CamSet] = MappingProxyType(
    {
        "205/60 R15": CamSet(
            shift=0.8335,
            length=1.471,
            height=0.9622,
            order=1.5174,
            source="property set of MF-Swift 6.1 of a tyre with a free radius of 0.3135 m at 2.2 bar",
        ),
        "car tyre (MF-Swift)": CamSet(
            shift=0.8328,
            length=1.4634,
            height=0.9551,
            order=1.5257,
            source="defaults of the section CONTACT_PATCH in a public reader of property files of MF-Swift",
        ),
        "car tyre (rounded)": CamSet(
            shift=0.83,
            length=1.3,
            height=1.0,
            order=1.5,
            source="public data of a car model with the names of MF-Swift",
        ),
    }
)
"""Published numbers of car tyres by name."""

CAMS = CAM_SETS["205/60 R15"]
"""Default numbers: a measured tyre of the size of the `focus` car, 195/60 R15."""


@dataclass(frozen=True, kw_only=True, slots=True)
class TyreEnvelope:
    """Two cams of a tyre.

    Attributes:
        distance: s, between the centres of the rear and the front cam [m].
        half_length: a [m].
        half_height: b [m].
        order: c [-], above 1.
    """

    distance: float
    half_length: float
    half_height: float
    order: float

    def __post_init__(self) -> None:
        positive("distance of the cams", self.distance, "m")
        positive("half length of a cam", self.half_length, "m")
        positive("half height of a cam", self.half_height, "m")
        positive("exponent of the cam shape, above 1", self.order - 1.0, "")

    @classmethod
    def of(cls, cams: CamSet, *, radius: float, patch: float) -> Self:
        """Return the cams of a tyre.

        Args:
            radius: radius of the tyre [m].
            patch: length of the contact patch [m].
        """
        return cls(
            distance=cams.shift * patch,
            half_length=cams.length * radius,
            half_height=cams.height * radius,
            order=cams.order,
        )

    @property
    def words(self) -> str:
        """Return a description of the cams for messages and headers."""
        size = f"{2e3 * self.half_length:.4g} x {2e3 * self.half_height:.4g} mm, {1e3 * self.distance:.3g} mm apart"
        return f"two elliptical cams of {size}"

    @property
    def reach(self) -> float:
        """Distance from the middle of the tyre to the farthest point that a cam can touch [m]."""
        return self.half_length + 0.5 * self.distance

    def height_and_slope(self, x: Vector, z: Vector, positions: Vector) -> tuple[Vector, Vector]:
        """Return effective heights w [m] and slopes tan(beta) of the tyre on a road of straight lines.

        Args:
            x: distances of the points of the road [m], not decreasing; (n,). Two equal distances are a vertical step.
            z: heights of the points [m]; (n,). Outside the points the road is level.
            positions: distances of the middle of the tyre [m]; (m,).
        """
        front = self.cam_heights(x, z, positions + 0.5 * self.distance)
        rear = self.cam_heights(x, z, positions - 0.5 * self.distance)
        return 0.5 * (front + rear), (front - rear) / self.distance

    def cam_heights(self, x: Vector, z: Vector, positions: Vector) -> Vector:
        """Return the heights Z of the lowest point of one cam [m], (m,); arguments see `height_and_slope`."""
        low, high = float(positions.min()) - self.half_length, float(positions.max()) + self.half_length
        x = np.concatenate(([min(low, x[0])], x, [max(high, x[-1])]))
        z = np.concatenate((z[:1], z, z[-1:]))
        run, rise = np.diff(x), np.diff(z)
        slopes = np.divide(rise, run, out=np.zeros_like(run), where=run > 0.0)
        # On a line of slope m the ellipse touches where its slope is m: |x/a|^c = p/(1 + p), p = (|m| a/b)^(c/(c -
        # 1)).
        power = (np.abs(slopes) * self.half_length / self.half_height) ** (self.order / (self.order - 1.0))
        touch = self.half_length * np.sign(slopes) * (power / (1.0 + power)) ** (1.0 / self.order)
        highest = _Maxima(np.maximum(z[:-1], z[1:]))
        lowest = np.empty(positions.size)
        for first in range(0, positions.size, BLOCK):
            at = positions[first : first + BLOCK]
            # A cam cannot touch where its gap exceeds the largest height above the road below its centre.
            begin, end = _segments(x, at - self.half_length, at + self.half_length)
            excess = np.maximum(highest(begin, end) - np.interp(at, x, z), 0.0) * (1.0 + 1e-9) + 1e-12
            farthest = self.half_length * self._ellipse(1.0 - np.minimum(excess / self.half_height, 1.0))
            begin, end = _segments(x, at - farthest, at + farthest)
            counts = end - begin
            # All pairs of position and segment in one row: the segments of position i begin at starts[i].
            starts = np.cumsum(counts) - counts
            segment = np.arange(counts.sum()) + np.repeat(begin - starts, counts)
            centre = np.repeat(at, counts)
            left = np.maximum(x[segment], centre - self.half_length)
            right = np.minimum(x[segment + 1], centre + self.half_length)
            contact = np.clip(centre + touch[segment], left, right)
            height = z[segment] + slopes[segment] * (contact - x[segment])
            # A vertical step touches with its upper edge.
            height = np.where(run[segment] > 0.0, height, np.maximum(z[segment], z[segment + 1]))
            # Height of the cam above its lowest point at the contact.
            gap = self.half_height * (1.0 - self._ellipse(np.abs(contact - centre) / self.half_length))
            lowest[first : first + BLOCK] = np.maximum.reduceat(height - gap, starts)
        return lowest

    def _ellipse(self, share: Vector) -> Vector:
        """Return (1 - share^c)^(1/c) for shares from 0 to 1."""
        return np.asarray(np.maximum(1.0 - share**self.order, 0.0) ** (1.0 / self.order))


def _segments(x: Vector, low: Vector, high: Vector) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return first and end index of the segments of the road in each window; (m,) each."""
    begin = np.clip(np.searchsorted(x, low, "left") - 1, 0, x.size - 2)
    return begin, np.clip(np.searchsorted(x, high, "right"), begin + 1, x.size - 1)


class _Maxima:
    """Maxima of values over ranges of indices, from maxima over powers of two."""

    def __init__(self, values: Vector) -> None:
        self.levels = [values]
        self.size = values.size

    def __call__(self, begin: NDArray[np.int64], end: NDArray[np.int64]) -> Vector:
        """Return the maxima of values[begin:end]; (m,)."""
        level = (np.log2(end - begin) + 1e-9).astype(np.int64)
        while len(self.levels) <= level.max():
            half, last = 1 << (len(self.levels) - 1), self.levels[-1]
            self.levels.append(np.maximum(last, np.append(last[half:], np.full(min(half, last.size), -np.inf))))
        # Two overlapping windows of a power of two cover the range.
        table = np.array([self.levels[k] for k in range(int(level.max()) + 1)])
        return np.asarray(np.maximum(table[level, begin], table[level, end - (1 << level)]))
