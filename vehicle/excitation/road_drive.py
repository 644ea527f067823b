"""A car that drives over a road, as an input: class of ISO 8608 or measured profile, speed, where the wheels are."""

from __future__ import annotations

import hashlib
import math
from dataclasses import asdict, dataclass
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.excitation.iso_road import CLASSES, IsoRoad, Road, Side, drive
from vehicle.excitation.measured_road import read_road
from vehicle.excitation.signal import Signal

FASTEST = 400.0
"""Largest speed [km/h]."""

CONTACT_PATCH = 0.10
"""Length of a contact patch [m], assumed: of a car tyre at its load; the tyre averages the road over it."""

USUAL_DURATION = 60.0
"""Length of a drive over a class [s] where none is asked for."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadDrive:
    """A drive at constant speed; each wheel meets the same road d / V after the foremost one, in its track.

    Attributes:
        road: class of ISO 8608 as "C", or the file of a measured profile.
        speed: [km/h].
        wheels: name of each wheel, its distance d behind the foremost one [m], its track.
        track: distance of the two tracks [m].
        duration: length [s]; 60 for a class, the whole of a profile, where None.
        rate: samples a second [Hz].
        seed: of a class.
        coherence: of the tracks of a class; None for the isotropic plane.
        patch: length of the contact patch [m] over which a tyre averages the road; 0 for a point.
        driving: speed [m/s] at which the tyres roll, 0 where they stand; None leaves that to the car.

    Raises:
        ConfigurationError: a value out of range, or one that a measured profile does not have.
    """

    road: str | Path
    speed: float
    wheels: tuple[tuple[str, float, Side], ...]
    track: float
    duration: float | None = None
    rate: float = 1000.0
    seed: int = 1
    coherence: float | None = None
    patch: float = CONTACT_PATCH
    driving: float | None = None

    def __post_init__(self) -> None:
        if not (math.isfinite(self.speed) and 0.0 < self.speed <= FASTEST):
            raise ConfigurationError(f"--speed {self.speed:g} km/h: allowed above 0 to {FASTEST:g}")
        if isinstance(self.road, Path):
            if self.coherence is not None:
                raise ConfigurationError("--coherence: belongs to a class; a measured profile is taken as it is")
            if not 0.0 <= self.patch < 1.0:
                raise ConfigurationError(f"contact patch {self.patch!r} m; allowed: 0 to 1 m")
        elif self.road not in CLASSES:
            raise ConfigurationError(
                f"road class {self.road!r}: allowed are {', '.join(CLASSES)}, from good to poor; or give the file of a "
                "measured profile"
            )

    @property
    def name(self) -> str:
        """Of its results: "road_C_80"."""
        return f"road_{self.road.stem if isinstance(self.road, Path) else self.road}_{self.speed:g}"

    @property
    def overrides(self) -> tuple[str, ...]:
        """What the drive asks of its car: whether the tyres roll, as texts of `Car.load`."""
        return () if self.driving is None else (f"driving.speed={self.driving!r}",)

    def signal(self) -> Signal:
        """The plate signals.

        Raises:
            ConfigurationError, DataError: as of `IsoRoad`, `read_road`, `drive`.
        """
        speed, duration = self.speed / 3.6, self.duration
        road: Road
        if isinstance(self.road, Path):
            road = read_road(self.road, self.patch)
            duration = math.floor(road.length / speed * self.rate) / self.rate if duration is None else duration
        else:
            road = IsoRoad(
                level=CLASSES[self.road],
                seed=self.seed,
                track=self.track,
                coherence=self.coherence,
                patch=self.patch,
            )
        places = {name: (behind, side) for name, behind, side in self.wheels}
        duration = USUAL_DURATION if duration is None else duration
        return drive(road, speed=speed, wheels=places, duration=duration, rate=self.rate)

    def identity(self) -> dict[str, object]:
        """What tells the signal from others: all numbers, and the content of a measured profile."""
        found = asdict(self) | {"road": str(self.road)}
        if isinstance(self.road, Path):
            found["road"] = hashlib.sha256(self.road.read_bytes()).hexdigest()
        return found

    def summary(self, signal: Signal) -> dict[str, object]:
        """The road for the summary of a run: kind, speed, seed, words.

        Args:
            signal: its signal.
        """
        measured = isinstance(self.road, Path)
        return {
            "class": None if measured else self.road,
            "profile": str(self.road) if measured else None,
            "speed_kmh": self.speed,
            "seed": None if measured else self.seed,
            "coherence": self.coherence,
            "contact_patch_m": self.patch,
            "behind_m": {name: behind for name, behind, _ in self.wheels},
            "words": signal.source,
        }
