"""Input of a car that drives over a road at constant speed: ISO 8608 class or measured profile."""

from __future__ import annotations

import hashlib
import math
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.signals.excitation.iso_road import RISE_S, IsoRoad, Side, drive
from vehicle.signals.excitation.measured_road import MeasuredRoad, read_road
from vehicle.signals.excitation.plausibility import acceleration_events
from vehicle.signals.excitation.signal import Signal

FASTEST = 400.0
"""Maximum speed [km/h]."""

CONTACT_PATCH = 0.10
"""Length of the contact patch of a car tyre under load [m], assumed; the tyre averages the road over this length."""

USUAL_DURATION = 60.0
"""Default length of a drive over a road class [s]."""

SKIP_S = 2.0
"""Minimum default of --skip on a road [s]: the rise from rest and 1 s, in which a motion of 1 Hz with a damping ratio
of 0.2 decays to 28 %, its power to 8 %."""

AFTER_RISE_S = 0.5
"""Minimum time [s] from the end of the rise at the last wheel to the default of --skip."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadDrive:
    """Drive at constant speed; each wheel reaches the road d / V after the foremost wheel, in its track.

    Attributes:
        road: class of ISO 8608, such as "C", or the file of a measured profile.
        speed: speed V [km/h].
        wheels: name of each wheel, its distance d behind the foremost wheel [m], its track.
        track: distance of the two tracks [m].
        duration: length [s]; None for 60 s of a class or a whole profile.
        rate: sampling rate [Hz].
        seed: seed of a class.
        coherence: coherence of the tracks of a class; None for an isotropic surface.
        tagged: the name contains the seed, for several seeds of one road.
        patch: length of the contact patch [m] over which a tyre averages the road; 0 for a point.
        driving: speed of rolling tyres [m/s], 0 for tyres that do not roll; None for the parameter of the car.

    Raises:
        ConfigurationError: a value out of range, or a coherence for a measured profile.
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
    tagged: bool = False
    driving: float | None = None

    def __post_init__(self) -> None:
        if not (math.isfinite(self.speed) and 0.0 < self.speed <= FASTEST):
            raise ConfigurationError(f"--speed {self.speed:g} km/h: must be above 0 and at most {FASTEST:g}")
        if isinstance(self.road, Path):
            if self.coherence is not None:
                raise ConfigurationError(
                    "--coherence: valid for a road class only, not for a measured profile; omit it"
                )
            if not 0.0 <= self.patch < 1.0:
                raise ConfigurationError(f"contact patch {self.patch!r} m; allowed: 0 to 1 m")
        elif self.road not in CLASSES:
            raise ConfigurationError(
                f"road class {self.road!r}: must be one of {', '.join(CLASSES)}, from good to poor, or the file of a "
                "measured profile"
            )

    @property
    def name(self) -> str:
        """Name of the results: "road_C_80", with several seeds "road_C_80_seed_2"."""
        tag = f"_seed_{self.seed}" if self.tagged else ""
        return f"road_{self.road.stem if isinstance(self.road, Path) else self.road}_{self.speed:g}{tag}"

    @property
    def skip(self) -> float:
        """Default start of the evaluation [s]: 2 s, or 0.5 s after the rise of the last wheel, whichever is later."""
        last = max(behind for _, behind, _ in self.wheels) / (self.speed / 3.6)
        return max(SKIP_S, math.ceil(10.0 * (RISE_S + AFTER_RISE_S + last)) / 10.0)

    @property
    def overrides(self) -> tuple[str, ...]:
        """Parameters that the drive sets on its car, as texts of `Car.load`: the speed of rolling tyres."""
        return () if self.driving is None else (f"driving.speed={self.driving!r}",)

    def signal(self) -> Signal:
        """Generate the plate signals.

        Raises:
            ConfigurationError, DataError: see `IsoRoad`, `read_road`, `drive`.
        """
        speed, duration = self.speed / 3.6, self.duration
        road: IsoRoad | MeasuredRoad
        if isinstance(self.road, Path):
            road = read_road(self.road, self.track, self.patch)
            duration = math.floor(road.length / speed * self.rate) / self.rate if duration is None else duration
        else:
            road = IsoRoad(
                level=CLASSES[self.road],
                seed=self.seed,
                track=self.track,
                coherence=self.coherence,
                patch=self.patch,
            )
        wheels = {name: (behind, side) for name, behind, side in self.wheels}
        duration = USUAL_DURATION if duration is None else duration
        signal = drive(road, speed=speed, wheels=wheels, duration=duration, rate=self.rate)
        if isinstance(road, IsoRoad):
            return signal
        return replace(signal, notices=(*road.notices, *acceleration_events(signal.displacement, signal.timestep)))

    def identity(self) -> dict[str, object]:
        """Return all data that determine the signal: parameters, and the digest of a measured profile."""
        identity = asdict(self) | {"road": str(self.road)}
        del identity["tagged"]
        if isinstance(self.road, Path):
            identity["road"] = hashlib.sha256(self.road.read_bytes()).hexdigest()
        return identity

    def summary(self, signal: Signal) -> dict[str, object]:
        """Return the description of the road for the summary of a run.

        Args:
            signal: signal of the drive.
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
