"""A measured road: heights of two tracks over the distance, from a file.

Points at nearly equal distances are samples of a road: a cubic spline goes through them. It retains 98.5 % of a wave
of four points, where straight lines retain 81 %. Points at other distances are corners, as of a cleat: the road is
straight between them, where a spline would swing by many times the heights. A contact patch of length a takes the exact
mean of either, from its integral Z: (Z(x + a/2) - Z(x - a/2)) / a.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy
from numpy.typing import NDArray

from vehicle.errors import DataError, VehicleError
from vehicle.signals.excitation.iso_road import Side
from vehicle.signals.records.channel import uniform_axis
from vehicle.signals.records.crg_format import read_surface, road_words
from vehicle.signals.records.formats import recognised_format
from vehicle.signals.records.named_columns import named_columns
from vehicle.signals.records.reader import read_record, read_table
from vehicle.signals.records.table import Header, Vector, Wanted, name_and_unit

NEEDED = "'distance [m]', 'left [m]' and 'right [m]' ([mm] is accepted for the heights)"
TRACKS = {"left": ("left", "lelev", "lprof", "left elev", "left elevation", "left profile", "lwp"),
          "right": ("right", "relev", "rprof", "right elev", "right elevation", "right profile", "rwp")}  # fmt: skip
"""Names of the tracks in profiles of other programs, in small letters without dots."""
UNITS = {"m": 1.0, "mm": 1e-3}

SAMPLED = 2.0
"""Maximum ratio of two distances between neighbouring points of a sampled road [-], which allows for the jitter of an
odometer and for a missing point; above it the points are corners."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MeasuredRoad:
    """A profile; the road before it is a plane at the height of its first points, so the car stands on it.

    Attributes:
        distance: places [m], (n,), increasing.
        right, left: heights of the tracks [m], (n,).
        source: name of the file.
        notices: a sentence for everything that was accepted.
        patch: length of the contact patch [m] over which a tyre averages it; 0 for a point.
    """

    distance: NDArray[np.float64]
    right: NDArray[np.float64]
    left: NDArray[np.float64]
    source: str
    notices: tuple[str, ...] = ()
    patch: float = 0.0

    @property
    def length(self) -> float:
        """From its first place to its last [m]."""
        return float(self.distance[-1] - self.distance[0])

    @property
    def repeats(self) -> bool:
        """False: the road ends."""
        return False

    @property
    def words(self) -> str:
        """What it is, for messages and headers."""
        step = self.length / (self.distance.size - 1)
        points = f"a point every {step:.3g} m" if self.sampled else f"straight between {self.distance.size} points"
        every = f"{self.length:.4g} m, {points}, contact patch {self.patch:g} m"
        return f"measured road {self.source}, {every}"

    @property
    def sampled(self) -> bool:
        """True if the points are samples of the road, False if they are corners of it."""
        steps = np.diff(self.distance)
        return bool(np.max(steps) <= SAMPLED * np.min(steps))

    def height(self, start: float, step: float, steps: int, side: Side, highest: float) -> NDArray[np.float64]:
        """Return heights at equal distances, as of `height_at`; arguments as of `IsoRoad.height`.

        Raises:
            DataError: the road ends before.
        """
        return self.height_at(uniform_axis(steps, step, start), side)

    def height_at(self, place: NDArray[np.float64], side: Side) -> NDArray[np.float64]:
        """Return heights above the first point [m], (m,): of the road, or means over the patch; 0 before the road.

        Half a patch beyond its last point the road goes on level.

        Args:
            place: distances from the beginning of the road [m], (m,).
            side: right or left track.

        Raises:
            DataError: the road ends before.
        """
        if place.max() > self.length * (1.0 + 1e-9):
            raise DataError(
                f"{self.source}: the road ends after {self.length:.6g} m, {place.max():.6g} m are driven; set a "
                "shorter --duration"
            )
        heights = self.right if side == "right" else self.left
        degree = 3 if self.sampled else 1
        spline = scipy.interpolate.make_interp_spline(self.distance - self.distance[0], heights - heights[0], k=degree)
        if self.patch > 0.0:
            whole, ends = spline.antiderivative(), place + 0.5 * self.patch * np.array([[-1.0], [1.0]])
            areas = whole(np.clip(ends, 0.0, self.length))
            areas += np.maximum(ends - self.length, 0.0) * (heights[-1] - heights[0])
            return np.asarray((areas[1] - areas[0]) / self.patch)
        return np.where(place < 0.0, 0.0, spline(np.clip(place, 0.0, self.length)))


def read_road(path: Path, track: float, patch: float = 0.0) -> MeasuredRoad:
    """Read a profile.

    Args:
        path: columns `distance [m]`, `left [m]`, `right [m]` in any order; or a file of any format of
            `vehicle.signals.records` with channels of these names, or those of `TRACKS`, in units of length; or an
            OpenCRG surface, whose reference line is the middle of the car.
        track: distance of the tracks of the car [m], for a surface.
        patch: length of the contact patch [m] over which the profile is averaged.

    Raises:
        ConfigurationError: there is no such file.
        DataError: bad data; the message names the place.
    """
    recognised = recognised_format(path)
    if recognised.name == "crg":
        return _surface_road(path, track, patch)
    source = ""
    notices: tuple[str, ...] = ()
    try:
        table = read_table(path, Wanted(needed=NEEDED, key=lambda header: _columns(header)["distance"][0]))
        found = {name: table.values[:, column] * scale for name, (column, scale) in _columns(table.header).items()}
    except DataError as error:
        try:
            found, notices = _named_tracks(path)
        except VehicleError:
            if not recognised.table:
                raise
            raise error from None
        source = str(path)
    steps = np.diff(found["distance"])
    if steps.size < 3 or not (steps > 0.0).all():
        row = int(np.argmin(steps)) + 1 if steps.size else 0
        place = source or table.place(row)
        raise DataError(f"{place}: the distance must increase from row to row, over four rows or more")
    return MeasuredRoad(
        distance=found["distance"],
        right=found["right"],
        left=found["left"],
        source=path.name,
        notices=notices,
        patch=patch,
    )


def _named_tracks(path: Path) -> tuple[dict[str, Vector], tuple[str, ...]]:
    """Return distance, left and right [m] of a file of any format, and notices; one track alone is both."""
    held = {one.name.strip().rstrip(".").lower(): one.name for one in read_record(path).channels}
    names = {side: next((held[name] for name in those if name in held), None) for side, those in TRACKS.items()}
    there = [name for name in names.values() if name is not None]
    if len(there) == 1:
        alone = there[0].strip().lower()
        found = named_columns(path, dict.fromkeys(("distance", alone), "m"))
        heights = found[alone]
        notice = f"{path.name}: one track, {there[0]!r}: both sides of the car drive on it"
        return {"distance": found["distance"], "left": heights, "right": heights}, (notice,)
    left, right = ((names[side] or side).strip().lower() for side in ("left", "right"))
    found = named_columns(path, dict.fromkeys(("distance", left, right), "m"))
    return {"distance": found["distance"], "left": found[left], "right": found[right]}, ()


def _surface_road(path: Path, track: float, patch: float) -> MeasuredRoad:
    """Take the two tracks of a car from a surface; v goes to the left."""
    surface = read_surface(path)
    found = {}
    for side, v in (("left", 0.5 * track), ("right", -0.5 * track)):
        found[side] = surface.height(v)
        missing = np.flatnonzero(~np.isfinite(found[side]))
        if missing.size:
            raise DataError(
                f"{path}: the {side} track, v = {v:.3f} m, is outside the road at {missing.size} of {surface.u.size} "
                f"places, first at u = {surface.u[missing[0]]:g} m; the road holds v from {surface.v[0]:g} to "
                f"{surface.v[-1]:g} m; repair the surface, or cut it off there"
            )
    return MeasuredRoad(distance=surface.u, **found, source=path.name, notices=(road_words(surface),), patch=patch)


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
