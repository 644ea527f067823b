"""A measured road: heights of two tracks over the distance, from a file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy
from numpy.typing import NDArray

from vehicle.errors import DataError, VehicleError
from vehicle.excitation.iso_road import Side
from vehicle.records.formats import read_table
from vehicle.records.named_columns import named_columns
from vehicle.records.table import Header, Wanted, name_and_unit

NEEDED = "'distance [m]', 'left [m]' and 'right [m]' ([mm] is accepted for the heights)"
UNITS = {"m": 1.0, "mm": 1e-3}


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MeasuredRoad:
    """A profile; the road before it is a plane at the height of its first points, so the car stands on it.

    Attributes:
        distance: places [m], (n,), increasing.
        right, left: heights of the tracks [m], (n,).
        source: name of the file.
        patch: length of the contact patch [m] over which a tyre averages it; 0 for a point.
    """

    distance: NDArray[np.float64]
    right: NDArray[np.float64]
    left: NDArray[np.float64]
    source: str
    patch: float = 0.0

    @property
    def length(self) -> float:
        """From its first place to its last [m]."""
        return float(self.distance[-1] - self.distance[0])

    @property
    def words(self) -> str:
        """What it is, for messages and headers."""
        step = self.length / (self.distance.size - 1)
        every = f"{self.length:.4g} m, a point every {step:.3g} m, contact patch {self.patch:g} m"
        return f"measured road {self.source}, {every}"

    def height(self, start: float, step: float, steps: int, side: Side, highest: float) -> NDArray[np.float64]:
        """Heights at equal distances, by a cubic spline, or its mean over the patch; arguments as of `IsoRoad.height`.

        Half a patch beyond its ends the road goes on level.

        Raises:
            DataError: the road ends before.
        """
        place = self.distance[0] + start + step * np.arange(steps)
        if place[-1] > self.distance[-1] + 1e-9 * self.length:
            raise DataError(
                f"{self.source}: the road ends after {self.length:.6g} m, {place[-1] - self.distance[0]:.6g} m are "
                "driven; ask for a shorter --duration"
            )
        heights = self.right if side == "right" else self.left
        spline = scipy.interpolate.CubicSpline(self.distance, heights - heights[0])
        if self.patch > 0.0:
            whole, first, last = spline.antiderivative(), self.distance[0], self.distance[-1]
            ends = place + 0.5 * self.patch * np.array([[-1.0], [1.0]])
            areas = whole(np.clip(ends, first, last)) + np.maximum(ends - last, 0.0) * (heights[-1] - heights[0])
            return np.asarray((areas[1] - areas[0]) / self.patch)
        found: NDArray[np.float64] = spline(np.maximum(place, place[0]))
        return np.where(place < self.distance[0], 0.0, found)


def read_road(path: Path, patch: float = 0.0) -> MeasuredRoad:
    """Read a profile.

    Args:
        patch: length of the contact patch [m] over which it is averaged.
        path: columns `distance [m]`, `left [m]`, `right [m]` in any order; or a file of any format of
            `vehicle.records` with channels of these names in units of length.

    Raises:
        ConfigurationError: there is no such file.
        DataError: bad data; the message names the place.
    """
    source = ""
    try:
        table = read_table(path, Wanted(needed=NEEDED, key=lambda header: _columns(header)["distance"][0]))
        found = {name: table.values[:, column] * scale for name, (column, scale) in _columns(table.header).items()}
    except DataError as error:
        try:
            found = named_columns(path, dict.fromkeys(("distance", "left", "right"), "m"))
        except VehicleError:
            raise error from None
        source = str(path)
    steps = np.diff(found["distance"])
    if steps.size < 3 or not (steps > 0.0).all():
        row = int(np.argmin(steps)) + 1 if steps.size else 0
        place = source or table.place(row)
        raise DataError(f"{place}: the distance must increase from row to row, over four rows or more")
    return MeasuredRoad(
        distance=found["distance"], right=found["right"], left=found["left"], source=path.name, patch=patch
    )


def _columns(header: Header) -> dict[str, tuple[int, float]]:
    """Index and scale of the three columns."""
    found = {}
    for index, cell in enumerate(header.cells):
        name, unit = name_and_unit(cell)
        if name in ("distance", "left", "right") and name not in found:
            if unit not in UNITS or (name == "distance" and unit != "m"):
                raise DataError(f"{header.where}: column {cell!r}; needed are {NEEDED}")
            found[name] = index, UNITS[unit]
    if len(found) < 3 or len(found) < len(header.cells):
        raise DataError(f"{header.where}: found {header.found}; needed are {NEEDED}, each once")
    return found
