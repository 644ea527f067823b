"""Which damper of a car is worn: a record of a drive against simulated drives of cars that may be the same.

Cars with other dampers, tyres, springs, mounts and loads drive over random roads (`drawn_car`, `simulated_drives`) with
the sensors, the speed and the length of the record. The features of the record (`features`) are compared with theirs
(`learned`): a regression estimates each unknown, the drives left out have the distribution of its error, and a record
that is far from all drives is refused.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.errors import ConfigurationError, DataError
from vehicle.names import in_order
from vehicle.runs.car import Car
from vehicle.signals.records.choice import Choice
from vehicle.studies.diagnosis.car_diagnosis import GROUPS, CarDiagnosis
from vehicle.studies.diagnosis.device_axes import oriented
from vehicle.studies.diagnosis.drawn_car import CarPrior
from vehicle.studies.diagnosis.drive_record import DriveRecord, Parts, read_drive, usable_parts
from vehicle.studies.diagnosis.driven_modes import ModeFit
from vehicle.studies.diagnosis.features import Bands, related_pairs, rows_of_points
from vehicle.studies.diagnosis.learned import Learned
from vehicle.studies.diagnosis.record_gain import GainTest
from vehicle.studies.diagnosis.roughness import road_pieces
from vehicle.studies.diagnosis.simulated_drives import RATE, TOGETHER, Drives, nominal_modes, simulated_drives

DRIVES, MORE_DRIVES = 1200, 1440
"""Simulated drives for a known speed, and for a range of speeds."""

SPEED_RATIO = 1.12
"""Largest ratio of the speeds that cars with one rolling speed of the tyres are used for."""

USUAL, UNLIKE, WIDENING = 1.0, 3.5, 0.5
"""Unlikeness of a record, see `Learned`: up to the first (84 % of the drives) intervals are not widened, beyond the
second (0.3 %) the record is refused, and between both intervals grow by exp(WIDENING) a unit."""

SURE_GAIN, WRONG_GAIN, GAIN_WIDENING = 2.0, 2.6, 1.0
"""Distance of the gain of a record from 1, see `record_gain`: up to the first (95 % of the drives) intervals are not
widened, beyond the second (1 %) the record is refused, and between both intervals grow by exp(GAIN_WIDENING) a unit."""

LEVEL_MARGIN = 0.3
"""Largest excess of the mean log density of a record over all simulated drives [-]: a gain of 1.2 of the sensor."""

MOST = 12
"""Largest number of channels: a thousand drives are too few for the features of more channels."""

ROUGHER, NARROWER = 0.6, 0.9
"""log10 of the ratio of two classes of roads; largest ratio of widths that is printed [-]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Diagnostics:
    """A car with simulated drives for one kind of record: sensors, speed and length.

    Attributes:
        car: name of the car.
        channels: accelerations of the record.
        highest: highest usable frequency of the record [Hz].
        free: points whose horizontal axes have any direction.
        drives: simulated drives.
        learned: regression of the unknowns over the features.
        gain_test: regression of the common gain of all sensors.
        at_wheels: the same regression with sensors at all wheels and strut tops; None for a car without these points.
        modes: regression of the modes.
        prior: cars at the middle speed.
    """

    car: str
    channels: tuple[str, ...]
    highest: float
    free: tuple[str, ...]
    drives: Drives
    learned: Learned = field(repr=False)
    gain_test: GainTest = field(repr=False)
    at_wheels: Learned | None = field(repr=False)
    modes: ModeFit = field(repr=False)
    prior: CarPrior = field(repr=False)

    @classmethod
    def of(
        cls,
        car: Car,
        channels: Sequence[str],
        speeds: tuple[float, float],
        seconds: float,
        *,
        highest: float,
        free: Sequence[str] = (),
        count: int | None = None,
        seed: int = 1,
        progress: Callable[[float], None] | None = None,
    ) -> Diagnostics:
        """Simulate drives.

        Args:
            car: car that is not worn.
            channels: accelerations of the record.
            speeds: least and greatest speed [m/s].
            seconds: length of the record that is used [s].
            highest: highest usable frequency of the record [Hz].
            free: points whose horizontal axes have any direction.
            count: number of drives.
            seed: seed of all random numbers.
            progress: called with the share that is done.
        """
        pieces = max(1, int(np.ceil(np.log(speeds[1] / speeds[0]) / np.log(SPEED_RATIO))))
        edges = np.geomspace(*speeds, pieces + 1)
        ranges = [(float(low), float(high)) for low, high in pairwise(edges)]
        priors = [CarPrior(car, round(float(np.sqrt(low * high)), 2)) for low, high in ranges]
        at_wheels = wheel_sensors(car)
        simulated = simulated_drives(
            priors,
            ranges,
            [channels, at_wheels] if at_wheels else [channels],
            highest=highest,
            free=free,
            count=count or (DRIVES if pieces == 1 else MORE_DRIVES),
            duration=seconds,
            seed=seed,
            progress=progress,
        )
        return cls(
            car=car.vehicle.name,
            channels=tuple(channels),
            highest=highest,
            free=tuple(free),
            drives=simulated,
            learned=Learned(simulated.features[0], simulated.values, TOGETHER),
            gain_test=GainTest(simulated.features[0], len(channels) * Bands.COUNT, TOGETHER),
            at_wheels=Learned(simulated.features[1], simulated.values, TOGETHER) if at_wheels else None,
            modes=ModeFit(simulated.features[0], simulated.modes, simulated.of("level"), TOGETHER),
            prior=priors[len(priors) // 2],
        )

    def features(self, record: DriveRecord, parts: Parts) -> Vector:
        """Return the features of a record."""
        bands = Bands.of(record.rate, self.highest)
        pieces = [record.samples[:, first:last] for first, last in parts.spans]
        return bands.features(pieces, related_pairs(self.channels), rows_of_points(self.channels, self.free))

    def diagnosis(self, record: DriveRecord, parts: Parts, shown: Sequence[str] = ("dampers",)) -> CarDiagnosis:
        """Return the diagnosis of a record.

        Raises:
            DataError: the record is unlike all simulated drives, or in another unit.
        """
        features = self.features(record, parts)
        self._require_level(record, features)
        unlike = self.learned.unlikeness(features)
        if not unlike <= UNLIKE:
            raise DataError(
                f"{record.name}: cannot be a drive of {self.car} as described: its spectra are "
                f"{number(unlike, 2)} standard deviations away from {len(self.drives.values)} simulated drives, "
                f"but at most {UNLIKE:g} are accepted; farthest is {self._farthest(features)}. Check the car, "
                "--speed, the channels of --map with their directions and units, that the engine does not shake the "
                "car, and that the road has no cobbles, nor slabs whose joints meet both tracks at once"
            )
        gain = self.gain_test.gain(features)
        if not gain.apart <= WRONG_GAIN:
            raise DataError(
                f"{record.name}: its accelerations are about {number(gain.factor, 2)} times those that belong to the "
                f"friction of the dampers of {self.car} and to the noise of sensors: {number(gain.apart, 2)} standard "
                f"deviations away, but at most {WRONG_GAIN:g} are accepted; check the units (--unit)"
            )
        excess = max(0.0, WIDENING * (unlike - USUAL), GAIN_WIDENING * (gain.apart - SURE_GAIN))
        widened = float(np.exp(excess))
        unknowns = dict(zip(self.drives.names, self.learned.posteriors(features, widened), strict=True))
        speed, level, waviness = (unknowns[name].quantile(0.5) for name in ("speed", "level", "waviness"))
        nominal = nominal_modes(self.prior, speed, 10.0**level, waviness)
        return CarDiagnosis(
            record=record.name,
            car=self.car,
            channels=self.channels,
            parts=parts,
            unknowns=unknowns,
            modes=self.modes.modes(features, widened, nominal),
            road_pieces=road_pieces(self.drives.pieces, unknowns["roughness"], record, parts, self.highest),
            wheels=in_order(name.removeprefix("damper ") for name in self.drives.names if name.startswith("damper ")),
            unlikely=float(np.mean(self.learned.unlike >= unlike)),
            widened=widened,
            shown=tuple(shown),
            drives=len(self.drives.values),
            more=self._more(features),
            notices=record.notices,
        )

    def _more(self, features: Vector) -> dict[str, float]:
        """Return changes of the test that narrow the intervals of the dampers, with the ratio of widths, below 1."""
        dampers = [number for number, name in enumerate(self.drives.names) if name.startswith("damper ")]
        rougher = np.mean([self.learned.rougher(features, damper, ROUGHER) for damper in dampers])
        more = {"a road one class rougher": float(rougher)}
        if self.at_wheels is not None:
            errors = [np.sqrt(np.mean(each.left_out[:, dampers] ** 2)) for each in (self.at_wheels, self.learned)]
            more["sensors along z at all wheels and strut tops"] = float(errors[0] / errors[1])
        return {name: ratio for name, ratio in more.items() if ratio < NARROWER}

    def _require_level(self, record: DriveRecord, features: Vector) -> None:
        """Check that the record is neither smoother nor rougher than the simulated drives."""
        count = len(self.channels) * Bands.COUNT
        levels, level = self.drives.features[0][:, :count].mean(axis=1), float(features[:count].mean())
        for rougher, beyond in ((True, level - levels.max()), (False, levels.min() - level)):
            if beyond > LEVEL_MARGIN:
                # The densities are squares.
                factor = np.exp(0.5 * beyond)
                comparison, roads, remedy = (
                    ("rougher", "class D", "drive on a smoother road") if rougher else
                    ("smoother", "class A", "drive on a rougher road, and not at a standstill")
                )  # fmt: skip
                raise DataError(
                    f"{record.name}: its accelerations are {factor:.3g} times {comparison} than in any simulated drive "
                    f"up to roads of {roads}; check the units (--unit), or {remedy}"
                )

    def _farthest(self, features: Vector) -> str:
        """Return the channel and the frequency at which a record is farthest from the drives, in words."""
        densities = len(self.channels) * Bands.COUNT
        apart = np.abs((features - self.learned.center) / self.learned.scale)[:densities]
        channel, band = divmod(int(np.argmax(apart)), Bands.COUNT)
        return f"{self.channels[channel]}, {number(Bands.middles(self.highest)[band], 2)} Hz"


def wheel_sensors(car: Car) -> list[str]:
    """Return the vertical accelerations at wheels and strut tops; [] for a car without these points."""
    names = [f"{point}_{wheel}_acc_z" for point in ("knuckle", "damper_top") for wheel in car.vehicle.wheels]
    return names if {*names} <= {*car.vehicle.acceleration_channels} else []


def diagnose_car(
    car: Car,
    record: Path | str,
    speed: float | str | tuple[float, float],
    *,
    channels: Mapping[str, str] | None = None,
    choice: Choice | None = None,
    inverted: Collection[str] = (),
    free: Sequence[str] = (),
    forward: str = "",
    parts: Sequence[str] = ("dampers",),
    count: int | None = None,
    seed: int = 1,
    progress: Callable[[float], None] | None = None,
) -> CarDiagnosis:
    """Tell from a record of a drive which damper of a car is worn, with probabilities; the road need not be known.

    Args:
        car: car that is not worn.
        record: measurement file of any format, with accelerations at points of the car, or the name of a shipped one.
        speed: speed [km/h], lower and upper speed, "channel:NAME", or "position:LATITUDE,LONGITUDE".
        channels: channel of the model to channel of the file; by default equal names.
        choice: units, times and excerpt of the file.
        inverted: channels measured in the opposite direction.
        free: points with a device in any direction, for example ("seat_rail",); x, y and z are axes of the device,
            and the record contains gravity.
        forward: axis of these devices that points forward, for example "y" or "-z"; unknown by default, then it
            follows from the changes of a recorded speed.
        parts: groups of unknowns for the table, of `GROUPS`.
        count: number of simulated drives; by default 1200, and 1440 for a range of speeds.
        seed: seed of the simulated drives.
        progress: called with the share that is done.

    Raises:
        ConfigurationError: a wrong argument, or a car with controlled dampers.
        DataError: bad data, less than 16 s of steady drive, or a record that cannot be of this car.
    """
    wrong = next((name for name in parts if name not in GROUPS), None)
    if wrong is not None:
        raise ConfigurationError(f"--parts {wrong}: must be one or more of {','.join(GROUPS)}")
    asked = choice or Choice()
    asked = replace(asked, channels={**asked.channels, **(channels or {})})
    drive = _main_channels(car, read_drive(Path(record), car.vehicle.acceleration_channels, speed, asked, inverted))
    drive, unknown = oriented(drive, free, forward)
    usable = usable_parts(drive)
    diagnostics = Diagnostics.of(
        car,
        drive.channels,
        usable.speeds,
        usable.seconds,
        highest=min(drive.highest, 0.4 * RATE),
        free=unknown,
        count=count,
        seed=seed,
        progress=progress,
    )
    return diagnostics.diagnosis(drive, usable, parts)


def _main_channels(car: Car, drive: DriveRecord) -> DriveRecord:
    """Return a record with at most `MOST` channels: those at wheels and strut tops and on the seat rail.

    Raises:
        ConfigurationError: more channels at other points.
    """
    if len(drive.channels) <= MOST:
        return drive
    kept = [
        row
        for row, name in enumerate(drive.channels)
        if name in wheel_sensors(car) or name.startswith("seat_rail_acc_")
    ]
    if not 0 < len(kept) <= MOST:
        raise ConfigurationError(
            f"{drive.name}: has {len(drive.channels)} accelerations of the car, but at most {MOST} can be used; choose "
            "them with --map CHANNEL=NAME"
        )
    channels = tuple(drive.channels[row] for row in kept)
    notice = f"of {len(drive.channels)} accelerations the {len(kept)} main ones are used: {', '.join(channels)}"
    return replace(drive, channels=channels, samples=drive.samples[kept], notices=(*drive.notices, notice))
