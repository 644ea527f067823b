"""Input of a car that drives over a road at constant speed: class of ISO 8608, measured profile, obstacle or level."""

import math
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TypeVar, get_args

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.road_level import CLASSES, RoadLevel, road_level
from vehicle.signals.analysis.roughness_index import RoughnessIndex, roughness_index
from vehicle.signals.excitation.band import samples_of
from vehicle.signals.excitation.iso_road import RISE_S, IsoRoad, Side, check_patch, drive
from vehicle.signals.excitation.measured_road import MeasuredRoad, read_road
from vehicle.signals.excitation.obstacle import Obstacle, is_obstacle
from vehicle.signals.excitation.plausibility import acceleration_events
from vehicle.signals.excitation.road_settings import LEVEL, SETTINGS
from vehicle.signals.excitation.signal import Signal, uniform_time
from vehicle.signals.excitation.tyre_envelope import CAMS, TyreEnvelope
from vehicle.signals.formats.file_digest import digest

FASTEST = 400.0
"""Maximum speed [km/h]."""

CONTACT_PATCH = 0.10
"""Length of the contact patch of a car tyre under load [m], assumed; the tyre averages the road over this length."""

USUAL_DURATION = 60.0
"""Default length of a drive over a road class or a level road [s]."""

SKIP_S = 2.0
"""Minimum default of --skip on a road [s]: the rise from rest and 1 s, in which a motion of 1 Hz with a damping ratio
of 0.2 decays to 28 %, its power to 8 %."""

RADIUS = 0.30
"""Default radius of a tyre [m], to which its cams are proportional."""

IN_NAMES = str.maketrans({":": "_", "@": "_at_"})
"""Replacements in the text of an obstacle for names of files."""

BEFORE_S, AFTER_S = 0.5, 3.0
"""Default times [s] between the start of the evaluation and the obstacle, and between the last wheel leaving the
obstacle and the end. In 3 s a motion of 1 Hz with a damping ratio of 0.2 decays to 2 %."""

AROUND, SHOWN = 0.3, 10.0
"""Lengths for a picture [m]: on both sides of an obstacle, and of another road."""

ROUGHNESS_STEP, LEVEL_WINDOW = 0.05, 100.0
"""Distance of the points for the roughness index [m], 5 to its average over 250 mm; windows of a road's density [m]."""

SHORTEST_SPAN_S = 6.0
"""Minimum evaluated span of a road that repeats [s]: at 50 km/h four lines of a span of 3 s take 1.3 Hz, over which the
response of a car changes, and the scatter is twice as large; class A at 50 km/h needs 16 s."""

AFTER_RISE_S = 0.5
"""Minimum time [s] from the end of the rise at the last wheel to the default of --skip."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadDrive:
    """Drive at constant speed; each wheel reaches the road d / V after the foremost wheel, in its track.

    Attributes:
        road: class of ISO 8608 ("C"), file of a measured profile, obstacle ("cleat:20x50"), or "level".
        speed: speed V [km/h]; 0 on a level road for a car at rest.
        wheels: name of each wheel, its distance d behind the foremost wheel [m], its track.
        track: distance of the two tracks [m].
        duration: length [s]; by default 60 s of a class, a whole profile, or an obstacle and 3 s after it.
        precision: wanted half of the 95 % interval of the weighted comfort [%], from which
            `vehicle.runs.car.road_precision` chooses the duration of a class, and `vehicle.runs.car.profile_value` the
            pieces of a profile; None with a duration.
        chosen: message on this choice; empty without one.
        rate: sampling rate [Hz].
        seed: seed of a class.
        period: "evaluated" for a class that repeats after the evaluated span, with phases of the tracks in quadruples;
            "record" for one with independent phases that repeats nowhere in the drive; None for "evaluated".
        start: start of the evaluation [s], see `evaluated_from`; None for the default.
        coherence: coherence of the tracks of a class; None for an isotropic surface.
        tagged: the name contains the seed, for several seeds of one road.
        patch: length of the contact patch [m] over which a tyre averages the road; 0 for a point.
        contact: "patch" for the average over the contact patch, "cams" for two elliptical cams (`TyreEnvelope`); None
            for cams on an obstacle and the average on other roads.
        radius: radius of the tyres [m], for the cams.
        driving: speed of rolling tyres [m/s], 0 for tyres that do not roll; None for the parameter of the car.
        lifting: paths of the tyres that can leave the road at an obstacle; a linear tyre would pull.
    """

    road: str | Path
    speed: float
    wheels: tuple[tuple[str, float, Side], ...]
    track: float
    duration: float | None = None
    precision: float | None = None
    chosen: str = ""
    rate: float = 1000.0
    seed: int = 1
    coherence: float | None = None
    patch: float = CONTACT_PATCH
    tagged: bool = False
    driving: float | None = None
    lifting: tuple[str, ...] = ()
    contact: str | None = None
    radius: float = RADIUS
    period: str | None = None
    start: float | None = None

    def __post_init__(self) -> None:
        stands = self.road == LEVEL and self.speed == 0.0
        if not stands and not (math.isfinite(self.speed) and 0.0 < self.speed <= FASTEST):
            raise ConfigurationError(f"--speed {self.speed:g} km/h: must be above 0 and at most {FASTEST:g}")
        on_obstacle = isinstance(self.road, str) and is_obstacle(self.road)
        if isinstance(self.road, Path) or on_obstacle or self.road == LEVEL:
            if self.coherence is not None:
                raise ConfigurationError("--coherence: works only with a road class; leave it out")
            if self.period is not None:
                raise ConfigurationError("--period: works only with a road class; leave it out")
            if self.precision is not None and not isinstance(self.road, Path):
                raise ConfigurationError(
                    "--precision: works only with a road class or a measured profile; leave it out"
                )
            if on_obstacle:
                Obstacle.parse(str(self.road))
        elif self.road not in CLASSES:
            raise ConfigurationError(
                f"road class {self.road!r}: must be one of {', '.join(CLASSES)} (good to poor), the file of a "
                f"measured profile, an obstacle, for example cleat:20x50, or {LEVEL}"
            )
        check_patch(self.patch)
        for name, value in (("contact", self.contact), ("period", self.period)):
            choices = SETTINGS[name]["option"]["choices"]
            if value is not None and value not in choices:
                raise ConfigurationError(f"{name} {value!r}: must be one of {', '.join(choices)}")
        if self.precision is not None:
            self._require_precision()
        _ = self.envelope

    def _require_precision(self) -> None:
        """Check that the road is one whose error is known from a short run."""
        reasons = {
            "and --duration exclude each other; leave one of them out": self.duration is not None,
            "needs a road that repeats; leave --period record out, or set --duration": self.road in CLASSES
            and not self.repeats,
            "is not known with cams, which have no linear twin; set --contact patch, or --duration": self.envelope,
        }
        for reason, applies in reasons.items():
            if applies:
                raise ConfigurationError(f"--precision {reason}")

    @property
    def obstacle(self) -> Obstacle | None:
        """Return the obstacle on the road, if there is one."""
        if not isinstance(self.road, str) or not is_obstacle(self.road):
            return None
        obstacle = Obstacle.parse(self.road)
        # To the millimetre, for messages.
        usual = round((self.skip + BEFORE_S) * self.speed / 3.6, 3)
        return replace(obstacle, place=usual if obstacle.place is None else obstacle.place)

    @property
    def envelope(self) -> TyreEnvelope | None:
        """Cams of the tyres, if they are chosen."""
        on_obstacle = isinstance(self.road, str) and is_obstacle(self.road)
        if (self.contact or ("cams" if on_obstacle else "patch")) == "patch":
            return None
        if not 0.0 < self.patch < 1.0:
            raise ConfigurationError(
                f"contact patch {self.patch!r} m: must be above 0 with cams, whose distance is proportional to it; for "
                "contact at a point set --contact patch --patch 0"
            )
        return TyreEnvelope.of(CAMS, radius=self.radius, patch=self.patch)

    @property
    def name(self) -> str:
        """Name of the results: "road_C_80", with several seeds "road_C_80_seed_2"."""
        tag = f"_seed_{self.seed}" if self.tagged else ""
        road = self.road.stem if isinstance(self.road, Path) else self.road
        return f"road_{road.translate(IN_NAMES)}_{self.speed:g}{tag}"

    @property
    def skip(self) -> float:
        """Start of the evaluation [s]; default: 2 s, or 0.5 s after the rise of the last wheel, whichever is later."""
        if self.start is not None:
            return self.start
        if self.road == LEVEL:
            return SKIP_S
        return max(SKIP_S, math.ceil(10.0 * (self._risen + AFTER_RISE_S)) / 10.0)

    @property
    def _risen(self) -> float:
        """Time at which the road has risen under the last wheel [s]; the road is not level."""
        return RISE_S + max(behind for _, behind, _ in self.wheels) / (self.speed / 3.6)

    @property
    def overrides(self) -> tuple[str, ...]:
        """Parameters that the drive sets on its car, as texts of `Car.load`: speed of rolling tyres, lifting tyres."""
        speed = () if self.driving is None else (f"driving.speed={self.driving!r}",)
        return (*speed, *(f"{path}.one_sided=true" for path in self.lifting))

    @property
    def random(self) -> bool:
        """Return True for a class or a profile, False for an obstacle or a level road; see `Signal`."""
        return self.road != LEVEL and self.obstacle is None

    @property
    def repeats(self) -> bool:
        """True for a class that repeats after the evaluated span."""
        return self.road in CLASSES and self.period != "record"

    @property
    def span(self) -> float | None:
        """Length of the evaluated span after which the road repeats [s]; None for a road that does not repeat.

        A drive that ends before the evaluation begins has no such span, nor one that is evaluated while the road rises.
        """
        if not self.repeats or self.skip < self._risen:
            return None
        span = (USUAL_DURATION if self.duration is None else self.duration) - self.skip
        return float(span) if span > 0.0 else None

    @property
    def notices(self) -> tuple[str, ...]:
        """Messages on the choice of the span, on one in which the road rises, and on a short one that scatters."""
        chosen = (self.chosen,) if self.chosen else ()
        if self.random and self.skip < self._risen:
            return (
                *chosen,
                f"{self.name} rises from the plane until {self._risen:.3g} s, but is evaluated from "
                f"{self.skip:g} s: comfort is too low; choose a later --skip",
            )
        if self.span is None or self.span >= SHORTEST_SPAN_S * (1.0 - 1e-9):
            return chosen
        return (
            f"{self.span:.3g} s of road {self.name} are evaluated: from {SHORTEST_SPAN_S:g} s on comfort scatters by "
            "less than 1 %; choose a longer --duration",
        )

    def signal(self) -> Signal:
        """Generate the plate signals.

        Raises:
            ConfigurationError: the duration has not been chosen by the precision.
        """
        if self.precision is not None:
            raise ConfigurationError(
                "--precision: works in shaker, sweep and optimise and in Car.run; set a duration here"
            )
        if self.road == LEVEL:
            return self._level(USUAL_DURATION if self.duration is None else self.duration)
        road, duration = self._road()
        wheels = {name: (behind, side) for name, behind, side in self.wheels}
        begin = None if self.span is None else self.skip
        signal = drive(road, speed=self.speed / 3.6, wheels=wheels, duration=duration, rate=self.rate, begin=begin)
        if isinstance(road, IsoRoad) or not self.random:
            obstacle = self.obstacle
            left = None if obstacle is None else self._times(obstacle)[1]
            return replace(
                signal, random=self.random, left_obstacle=left, notices=self.notices, repeats_after=self.span
            )
        return replace(
            signal, notices=(*self.notices, *road.notices, *acceleration_events(signal.displacement, signal.timestep))
        )

    def _road(self) -> tuple[IsoRoad | MeasuredRoad, float]:
        """Return the road, which is not level, and the length of the drive [s]."""
        speed, duration = self.speed / 3.6, self.duration
        if isinstance(self.road, Path):
            road = read_road(self.road, self.track, self.patch, self.envelope)
            return road, math.floor(road.length / speed * self.rate) / self.rate if duration is None else duration
        if (obstacle := self.obstacle) is not None:
            if duration is None:
                duration = math.ceil(10.0 * (self._times(obstacle)[1] + AFTER_S)) / 10.0
            return obstacle.road(length=duration * speed + 1.0, patch=self.patch, envelope=self.envelope), duration
        iso_road = IsoRoad(
            level=CLASSES[self.road],
            seed=self.seed,
            track=self.track,
            coherence=self.coherence,
            patch=self.patch,
            quadruples=self.span is not None,
            envelope=self.envelope,
        )
        return iso_road, USUAL_DURATION if duration is None else duration

    def roughness(self) -> dict[Side, tuple[RoughnessIndex, RoadLevel | None]]:
        """Return the international roughness index of each track over the driven length, and its ISO 8608 level.

        It is that of the road itself, without contact patch or cams and without the rise at the start. A profile with
        equal steps is rated at its own points, any other road every `ROUGHNESS_STEP`. An obstacle, and a track
        too short for a class, have no level.
        """
        if self.road == LEVEL:
            raise ConfigurationError("IRI: a level road has no roughness; give a road class, a profile or an obstacle")
        road, duration = self._road()
        # A road that repeats is rated over one period.
        length, step = (self.span or duration) * self.speed / 3.6, ROUGHNESS_STEP
        if isinstance(road, MeasuredRoad):
            length = road.length if self.duration is None else min(length, road.length)
            if road.sampled:
                step = road.length / (road.distance.size - 1)
        steps = math.floor(length / step * (1.0 + 1e-9)) + 1
        if self.span is not None:
            step = length / (steps := max(round(length / step), 2))
        indices: dict[Side, tuple[RoughnessIndex, RoadLevel | None]] = {}
        for side in reversed(get_args(Side)):
            height, _ = road.bare.contact(0.0, step, steps, side, 0.4 / step)
            level = None
            if self.obstacle is None:
                with suppress(DataError):
                    level = road_level(step, height, 1.0, window_s=LEVEL_WINDOW)
            indices[side] = roughness_index(step, height), level
        return indices

    def _level(self, duration: float) -> Signal:
        """Return plates at rest."""
        time = uniform_time(samples=samples_of(duration, self.rate) + 1, timestep=1.0 / self.rate)
        height = {name: np.zeros(time.size) for name, _, _ in self.wheels}
        return Signal(
            time=time, displacement=height, source=f"level road; {self.speed:.6g} km/h", profile=height, random=False
        )

    def slopes(self, signal: Signal) -> dict[str, Vector]:
        """Return the slope of the road that each wheel takes, tan(beta) [-], (n,): from the cams, or w'/V."""
        rates = signal.slope_velocity or signal.plate_motion(signal.time).velocity
        return {wheel: rates[wheel] * 3.6 / self.speed for wheel in signal.wheels}

    @property
    def shown(self) -> tuple[float, float]:
        """Range of distances of the foremost wheels for a picture [m]: the obstacle, or the first 10 m evaluated."""
        if (obstacle := self.obstacle) is not None:
            around = AROUND + (0.0 if self.envelope is None else self.envelope.reach)
            return obstacle.begin - around, obstacle.begin + obstacle.length + around
        begin = self.skip * self.speed / 3.6
        return begin, begin + SHOWN

    def _times(self, obstacle: Obstacle) -> tuple[float, float]:
        """Return when the foremost wheels reach an obstacle and when the last wheels leave it [s]."""
        last = obstacle.begin + obstacle.length + max(behind for _, behind, _ in self.wheels)
        return obstacle.begin * 3.6 / self.speed, last * 3.6 / self.speed

    def identity(self) -> dict[str, object]:
        """Return all data that determine the signal: parameters, and the digest of a measured profile."""
        identity = asdict(self) | {"road": str(self.road)}
        for name in ("tagged", "contact", "radius", "lifting", "period", "start", "precision", "chosen"):
            del identity[name]
        if self.span is not None:
            identity["repeats_after"] = self.span
        if self.envelope is not None:
            identity["envelope"] = asdict(self.envelope)
        if isinstance(self.road, Path):
            identity["road"] = digest(self.road)
        return identity

    def summary(self, signal: Signal) -> dict[str, object]:
        """Return the description of the road for the summary of a run."""
        measured, obstacle = isinstance(self.road, Path), self.obstacle
        no_class = measured or not self.random
        return {
            "class": None if no_class else self.road,
            "profile": str(self.road) if measured else None,
            "speed_kmh": self.speed,
            "seed": None if no_class else self.seed,
            "coherence": self.coherence,
            **({} if self.span is None else {"repeats_after_s": self.span}),
            "contact_patch_m": self.patch,
            **({} if self.envelope is None else {"tyre_contact": self.envelope.words}),
            **({"level": True} if self.road == LEVEL else {}),
            **({} if obstacle is None else {"obstacle": obstacle.words, "obstacle_s": list(self._times(obstacle))}),
            "behind_m": {name: behind for name, behind, _ in self.wheels},
            "words": signal.source,
        }


Source = TypeVar("Source")


def evaluated_from(source: Source, start: float | None) -> Source:
    """Return a road evaluated from a start on [s], None for the default; a class repeats after its evaluated span.

    An obstacle and other inputs do not depend on the start, and are returned unchanged.
    """
    if isinstance(source, RoadDrive) and source.random and start is not None and start != source.skip:
        return replace(source, start=start)
    return source
