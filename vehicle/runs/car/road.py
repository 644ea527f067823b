"""A road as the input of a run: a class of ISO 8608, a measured profile or an obstacle, and the speed of the car."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.compose import APPLY_FORCES
from vehicle.model.parameters.driving import require_speed_once
from vehicle.model.parameters.force_elements import Tyre
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.model.parameters.wheel_forces import WHEEL_FORCES
from vehicle.settings import documented
from vehicle.signals.excitation.input_settings import DriveInput
from vehicle.signals.excitation.iso_road import Side
from vehicle.signals.excitation.measured_road import read_road
from vehicle.signals.excitation.obstacle import SHAPES, is_obstacle
from vehicle.signals.excitation.recorded_road import PREFIX, RecordedDrive
from vehicle.signals.excitation.road_drive import RoadDrive
from vehicle.signals.excitation.road_settings import LEVEL, RoadSettings
from vehicle.signals.records.choice import Choice

Drive = RoadDrive | RecordedDrive
"""A road under the wheels of one car."""


@documented
@dataclass(frozen=True, slots=True, repr=False)
class Road(RoadSettings):
    """Road for the wheels of any car, as road("C", 80); `Car.run` and `sweep` take it.

    Attributes:
        road: class of ISO 8608, "A" to "H"; an obstacle on a level road, as "cleat:20x50" (`Obstacle`); "level", for
            a car that its own forces shake; or the file of a measured profile (columns distance, left, right [m];
            OpenCRG; ERD), or of heights over time.
        speed: speed of the car [km/h]; "channel:NAME" for heights over time that were recorded with their speed.
        choice: channels of heights over time, their units and excerpt.
    """

    road: str | Path
    speed: float | str
    choice: Choice = field(default_factory=Choice, hash=False, kw_only=True)

    def __repr__(self) -> str:
        """Return the call of `road` that makes this road."""
        options = "".join(f", {name}={value!r}" for name, value in self.given().items())
        return f"road({str(self.road)!r}, {self.speed!r}{options})"

    @property
    def file(self) -> Path | None:
        """File of a measured road; None for a class."""
        path = Path(self.road)
        return path if isinstance(self.road, Path) or (len(self.road) > 1 and path.is_file()) else None

    def under(self, vehicle: Vehicle, overrides: Iterable[str] = ()) -> Drive:
        """Return the drive of a car over the road, with the wheels where the car has them.

        Args:
            overrides: texts "path=value" with which the car was loaded; driving.speed, which must be that of the road
                or 0, and one_sided among them decide on the tyres.

        Raises:
            ConfigurationError: a value out of range or of another type of road, or a car that cannot roll.
        """
        # A single letter is a class, even if a file of this name exists.
        # Tyres and brakes of a car that stands shake nothing, and are no forces.
        kinds, acts = {*vehicle.composition.kinds.values()}, vehicle.table.get(APPLY_FORCES, True)
        shaken = vehicle.composition.forces or (acts and kinds & {*WHEEL_FORCES.values()})
        track = 2.0 * sum(abs(wheel.patch[1]) for wheel in vehicle.composition.wheels) / len(vehicle.composition.wheels)
        file = None if isinstance(self.speed, str) else self.file
        if not shaken and (self.road == LEVEL or (file is not None and read_road(file, track).level)):
            raise ConfigurationError(
                f"--road {self.road}: {'' if file is None else 'is level, '}moves no plate, and {vehicle.name} has no "
                "force that shakes it; add a force, "
                "for example --set front.imbalance.mass=0.02 --set front.imbalance.radius=0.2, or a section "
                "[force.NAME]"
                + (
                    ""
                    if acts
                    else "; the forces of the vehicle file are left out by --no-forces or apply_forces = false"
                )
            )
        road = self.file or (str(self.road).upper() if len(str(self.road)) == 1 else str(self.road))
        driving = self._driving(vehicle, overrides)
        if isinstance(self.speed, str):
            return self._recorded(road, vehicle, driving)
        wheels = vehicle.composition.wheels
        return RoadDrive(
            road=road,
            speed=self.speed,
            wheels=_wheel_positions(vehicle),
            track=track,
            radius=sum(wheel.center[2] - wheel.patch[2] for wheel in wheels) / len(wheels),
            driving=driving,
            lifting=lifting_tyres(vehicle, overrides) if isinstance(road, str) and is_obstacle(road) else (),
            **self.given(without=("tyre",)),
        )

    def _recorded(self, road: str | Path, vehicle: Vehicle, driving: float | None) -> RecordedDrive:
        """Return the drive over a road that was recorded over time."""
        if not isinstance(road, Path):
            raise ConfigurationError(
                f"--speed {self.speed}: belongs to a recorded road (--road FILE), but {road} is a class; "
                "give the speed in km/h"
            )
        for name in self.given(without=("duration", "rate", "tyre")):
            raise ConfigurationError(
                f"--{name}: belongs to a road class or a profile; a recorded road is used unchanged; leave --{name} out"
            )
        return RecordedDrive(
            road=road,
            channel=str(self.speed).removeprefix(PREFIX),
            wheels=_wheel_positions(vehicle),
            choice=self.choice,
            driving=driving,
            **{name: value for name in ("duration", "rate") if (value := getattr(self, name)) is not None},
        )

    def _driving(self, vehicle: Vehicle, overrides: Iterable[str]) -> float | None:
        """Return the speed at which the tyres roll [m/s], 0 for standing tyres; None if the car itself specifies it.

        For a car that is on blocks too, standing tyres are the default. NaN means the mean speed of a recorded drive.
        """
        speed = math.nan if isinstance(self.speed, str) else float(self.speed) / 3.6
        if require_speed_once(overrides, speed):
            if self.tyre is not None:
                raise ConfigurationError(
                    f"--tyre {self.tyre} and --set driving.speed exclude each other; leave one of them out"
                )
            return None
        if self.tyre not in (None, "rolling", "standing"):
            raise ConfigurationError(f"tyre: must be rolling or standing, not {self.tyre!r}")
        on_blocks = any(
            connection.ground for connection in vehicle.composition.connections if not isinstance(connection.law, Tyre)
        )
        if self.tyre == "standing" or (self.tyre is None and on_blocks):
            return 0.0 if vehicle.driving.rolling else None
        return speed


def named_road(text: str) -> str | Path:
    """Return the class of ISO 8608, the text of an obstacle, or the file of a profile, that a text names.

    Raises:
        ConfigurationError: the text has another form.
    """
    if len(text) > 1 and not Path(text).is_file():
        if is_obstacle(text) or text == LEVEL:
            return text
        raise ConfigurationError(
            f"--road {text}: unknown; give a class of ISO 8608 (A to H), the file of a measured profile, an "
            f"obstacle ({', '.join(SHAPES)}) or {LEVEL}"
        )
    return text.upper() if len(text) == 1 else Path(text)


def road_of(drive: DriveInput, *, others: bool = False) -> Road:
    """Return the road of the settings of a drive.

    Args:
        others: see `RecordSettings.choice`.

    Raises:
        ConfigurationError: no speed, or a road of another form.
    """
    road = named_road(drive.road) if isinstance(drive.road, str) else drive.road
    return Road(road, drive.require_speed(), choice=drive.choice(others=others) or Choice(), **drive.settings.given())


road = Road
"""The form in which examples name a road: road("C", 80)."""


def lifting_tyres(vehicle: Vehicle, overrides: Iterable[str] = ()) -> tuple[str, ...]:
    """Return the paths of the linear tyres, which would pull at an obstacle; empty if the overrides decide on it.

    Args:
        overrides: texts "path=value" with which the car was loaded.
    """
    if any(text.partition("=")[0].strip().endswith("one_sided") for text in overrides):
        return ()
    laws = [(each.path, each.law) for each in vehicle.composition.connections if isinstance(each.law, Tyre)]
    return tuple(dict.fromkeys(path for path, law in laws if not law.one_sided and law.table_z is None))


def _wheel_positions(vehicle: Vehicle) -> tuple[tuple[str, float, Side], ...]:
    """Return name, distance behind the foremost wheel [m] and side of each wheel."""
    wheels = vehicle.composition.wheels
    foremost = min(wheel.center[0] for wheel in wheels)
    side: dict[bool, Side] = {True: "right", False: "left"}
    return tuple((wheel.name, wheel.center[0] - foremost, side[wheel.side > 0.0]) for wheel in wheels)
