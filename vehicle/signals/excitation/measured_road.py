"""Read measured roads: heights of two tracks over the distance.

Points at nearly equal distances are samples of a road, interpolated by a cubic spline. It retains 98.5 % of the
amplitude of a wave of four points, straight lines 81 %. Points at other distances are corners, for example of a cleat:
the road is straight between them, as a spline would overshoot by many times the heights. A contact patch of length a
averages either interpolation exactly, with its integral Z: (Z(x + a/2) - Z(x - a/2)) / a. The cams of a tyre roll over
the corners, or over the points of the spline every 5 mm.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import DataError, VehicleError
from vehicle.signals.excitation.iso_road import Contact, Side, contact_words
from vehicle.signals.excitation.tyre_envelope import SAMPLES, TyreEnvelope
from vehicle.signals.formats.channel import uniform_axis
from vehicle.signals.formats.crg_format import read_surface, road_words
from vehicle.signals.formats.file_digest import digest
from vehicle.signals.formats.formats import recognised_format
from vehicle.signals.formats.named_columns import named_columns
from vehicle.signals.formats.reader import read_record
from vehicle.signals.formats.table import Header, Wanted, name_and_unit
from vehicle.signals.formats.table_file import read_table

NEEDED = "'distance [m]', 'left [m]' and 'right [m]' ([mm] is accepted for the heights)"
TRACKS = {
    "left": (
        "left",
        "lelev",
        "lprof",
        "left elev",
        "left elevation",
        "left profile",
        "lwp",
        "height left",
        "height_left",
    ),
    "right": (
        "right",
        "relev",
        "rprof",
        "right elev",
        "right elevation",
        "right profile",
        "rwp",
        "height right",
        "height_right",
    ),
}
"""Track names in profiles of other programs, in lower case without dots."""
UNITS = {"m": 1.0, "mm": 1e-3}

SAMPLED = 2.0
"""Maximum ratio of the distances of adjacent points of a sampled road [-], with allowance for odometer jitter and a
missing point; at larger ratios the points are corners."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MeasuredRoad:
    """Measured profile; the road before the profile is a plane at the height of the first points.

    Attributes:
        distance: distance of each point [m], (n,), increasing.
        right, left: heights of the tracks [m], (n,).
        source: name of the file.
        notices: messages on unusual content that was accepted.
        patch: length of the contact patch [m], over which a tyre averages the road; 0 for a point.
        envelope: cams of the tyre, in place of the average over the contact patch.
        corners: True for a road that is straight between its points, whatever their distances.
    """

    distance: Vector
    right: Vector
    left: Vector
    source: str
    notices: tuple[str, ...] = ()
    patch: float = 0.0
    envelope: TyreEnvelope | None = None
    corners: bool = False

    @property
    def length(self) -> float:
        """Distance from the first to the last point [m]."""
        return float(self.distance[-1] - self.distance[0])

    @property
    def level(self) -> bool:
        """True if both tracks are level within 1 nm."""
        return bool(max(np.ptp(self.left), np.ptp(self.right)) < 1e-9)

    @property
    def repeats(self) -> bool:
        """False: a measured road is not periodic."""
        return False

    @property
    def words(self) -> str:
        """Description of the road, for messages and headers."""
        if self.corners:
            return f"{self.source}, {contact_words(self.patch, self.envelope)}"
        step = self.length / (self.distance.size - 1)
        points = f"a point every {step:.3g} m" if self.sampled else f"straight between {self.distance.size} points"
        sampling = f"{self.length:.4g} m, {points}, {contact_words(self.patch, self.envelope)}"
        return f"measured road {self.source}, {sampling}"

    @property
    def sampled(self) -> bool:
        """True if the points are samples of the road, False if they are corners."""
        steps = np.diff(self.distance)
        return not self.corners and bool(np.max(steps) <= SAMPLED * np.min(steps))

    @property
    def bare(self) -> MeasuredRoad:
        """The road itself, with contact at a point."""
        return replace(self, envelope=None, patch=0.0)

    def contact(self, start: float, step: float, steps: int, side: Side, highest: float) -> Contact:
        """Return heights and, with cams, slopes of a track at equal distances; arguments see `IsoRoad.height`."""
        return self.contact_at(uniform_axis(steps, step, start), side)

    def contact_at(self, positions: Vector, side: Side) -> Contact:
        """Return heights above the first point, as the tyre takes them, and slopes, (m,); 0 before the road.

        For contact patch and cams, the road is level beyond its last point.

        Args:
            positions: distances from the beginning of the road [m], (m,).
            side: right or left track.
        """
        if positions.max() > self.length * (1.0 + 1e-9):
            raise DataError(
                f"{self.source}: the road is {self.length:.6g} m long, but the car drives {positions.max():.6g} "
                "m; choose a shorter --duration"
            )
        track_heights = self.right if side == "right" else self.left
        degree = 3 if self.sampled else 1
        spline = scipy.interpolate.make_interp_spline(
            self.distance - self.distance[0], track_heights - track_heights[0], k=degree
        )
        if self.envelope is not None:
            x, z = self.distance - self.distance[0], track_heights - track_heights[0]
            if self.sampled:
                x = np.linspace(0.0, self.length, int(np.ceil(self.length / SAMPLES)) + 1)
                z = spline(x)
            return self.envelope.height_and_slope(x, z, positions)
        if self.patch > 0.0:
            integral, ends = spline.antiderivative(), positions + 0.5 * self.patch * np.array([[-1.0], [1.0]])
            areas = integral(np.clip(ends, 0.0, self.length))
            areas += np.maximum(ends - self.length, 0.0) * (track_heights[-1] - track_heights[0])
            return np.asarray((areas[1] - areas[0]) / self.patch), None
        return np.where(positions < 0.0, 0.0, spline(np.clip(positions, 0.0, self.length))), None


def read_road(path: Path, track: float, patch: float = 0.0, envelope: TyreEnvelope | None = None) -> MeasuredRoad:
    """Read a measured road profile.

    Args:
        path: file with the columns `distance [m]`, `left [m]`, `right [m]` in any order; or a file of any format of
            `vehicle.signals.formats` with channels of these names, or of `TRACKS`, in units of length; or an
            OpenCRG surface, whose reference line is under the middle of the car.
        track: distance of the tracks of the car [m], for a surface.
        patch: length of the contact patch [m] over which the profile is averaged.
        envelope: cams of the tyre, in place of the average.
    """
    recognised_format(path)  # its errors are about the file
    return replace(_road_of(path, digest(path), track), patch=patch, envelope=envelope)


@lru_cache(maxsize=1)
def _road_of(path: Path, content: str, track: float) -> MeasuredRoad:
    """Read a road under point contact; the same content is read once, as a run asks for it twice."""
    recognised = recognised_format(path)
    if recognised.name == "crg":
        return _surface_road(path, track)
    source = ""
    notices: tuple[str, ...] = ()
    try:
        table = read_table(path, Wanted(needed=NEEDED, key=lambda header: _columns(header)["distance"][0]))
        columns = {name: table.values[:, column] * scale for name, (column, scale) in _columns(table.header).items()}
        notices = tuple(f"{path.name}: {text}" for text in table.notices)
    except DataError as error:
        try:
            columns, notices = _named_tracks(path)
        except VehicleError:
            if not recognised.table:
                raise
            raise error from None
        source = str(path)
    steps = np.diff(columns["distance"])
    if steps.size < 3 or not (steps > 0.0).all():
        row = int(np.argmin(steps)) + 1 if steps.size else 0
        where = source or table.place(row)
        raise DataError(f"{where}: the distance must increase from row to row, in at least four rows")
    return MeasuredRoad(
        distance=columns["distance"], right=columns["right"], left=columns["left"], source=path.name, notices=notices
    )


def _named_tracks(path: Path) -> tuple[dict[str, Vector], tuple[str, ...]]:
    """Read distance, left and right track [m] from any format, and notices; use a single track for both sides."""
    names_in_file = {channel.name.strip().rstrip(".").lower(): channel.name for channel in read_record(path).channels}
    names = {
        side: next((names_in_file[name] for name in track_names if name in names_in_file), None)
        for side, track_names in TRACKS.items()
    }
    tracks = [name for name in names.values() if name is not None]
    if len(tracks) == 1:
        name_of_track = tracks[0].strip().lower()
        columns = named_columns(path, dict.fromkeys(("distance", name_of_track), "m"))
        track_heights = columns[name_of_track]
        notice = f"{path.name}: the file has one track, {tracks[0]!r}: both sides of the car drive on it"
        return {"distance": columns["distance"], "left": track_heights, "right": track_heights}, (notice,)
    left, right = ((names[side] or side).strip().lower() for side in ("left", "right"))
    columns = named_columns(path, dict.fromkeys(("distance", left, right), "m"))
    return {"distance": columns["distance"], "left": columns[left], "right": columns[right]}, ()


def _surface_road(path: Path, track: float) -> MeasuredRoad:
    """Return the two tracks of a car on an OpenCRG surface (v positive to the left)."""
    surface = read_surface(path)
    tracks = {}
    for side, v in (("left", 0.5 * track), ("right", -0.5 * track)):
        tracks[side] = surface.height(v)
        missing = np.flatnonzero(~np.isfinite(tracks[side]))
        if missing.size:
            raise DataError(
                f"{path}: the {side} wheels (v = {v:.3g} m) leave the road, which extends from {surface.v[0]:g} to "
                f"{surface.v[-1]:g} m, at {missing.size} of {surface.u.size} points, first after "
                f"{surface.u[missing[0]]:g} m; correct the surface, or cut it off there"
            )
    return MeasuredRoad(
        distance=surface.u, right=tracks["right"], left=tracks["left"], source=path.name, notices=(road_words(surface),)
    )


def _columns(header: Header) -> dict[str, tuple[int, float]]:
    """Return index and scale of the columns distance, left and right."""
    columns = {}
    for index, cell in enumerate(header.cells):
        name, unit = name_and_unit(cell)
        if name in ("distance", "left", "right") and name not in columns:
            if unit not in UNITS or (name == "distance" and unit != "m"):
                raise DataError(f"{header.where}: column {cell!r}; must be one of {NEEDED}")
            columns[name] = index, UNITS[unit]
    if len(columns) < 3 or len(columns) < len(header.cells):
        raise DataError(f"{header.where}: found {header.found}, must be {NEEDED}, each once")
    return columns
