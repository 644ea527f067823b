"""Input from a road recorded over time together with the speed of the car: a drive at the recorded speed.

The record contains the height z(t) of the road under the foremost wheels and the speed v(t). The distance is

    s(t) = integral of v from the first time to t,

by the trapezoidal rule, exact for a speed that is linear between its samples. A wheel at the distance d behind the
foremost wheel reaches at the time t the point that the foremost wheel reached at tau, s(tau) = s(t) - d, so

    z_d(t) = w(tau) (z(tau) - z(first)),    0 where s(t) < d.

w is the rise from rest over `RISE_S`, a part of the road as in `iso_road.drive`. tau is computed by linear
interpolation of the inverse of s between samples h apart, with an error below h^2 |dv/dt| / (8 v): 0.4 us at 1 kHz,
3 m/s2 and 1 m/s.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.excitation.iso_road import RISE_S, Side
from vehicle.signals.excitation.measured_road import TRACKS
from vehicle.signals.excitation.plausibility import acceleration_events
from vehicle.signals.excitation.rest import half_cosine_at
from vehicle.signals.excitation.road_drive import AFTER_RISE_S, SKIP_S
from vehicle.signals.excitation.signal import Signal, uniform_time
from vehicle.signals.excitation.time_grid import FINE_RATE, SMOOTH_RATE
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.formats.clock import UNIFORM_TOLERANCE
from vehicle.signals.formats.file_digest import digest
from vehicle.signals.formats.reader import read_record
from vehicle.signals.formats.table import USABLE
from vehicle.signals.records.channel_words import of_receiver
from vehicle.signals.records.choice import Choice, Chosen, choose
from vehicle.signals.records.integration import displacement
from vehicle.signals.records.resampled import resampled

PREFIX = "channel:"
"""Prefix of a speed that is a channel name."""

FASTEST = 111.0
"""Maximum speed of a record [m/s], 400 km/h; a larger one indicates a wrong unit."""

BACKWARDS = 0.3
"""Maximum negative speed that is accepted as sensor noise at rest [m/s]."""

STANDING = 0.1
"""Speed below which the car counts as standing [m/s]."""

NAMES = {
    "left": (*TRACKS["left"], "displacement_fl", "plate_fl_displacement"),
    "right": (*TRACKS["right"], "displacement_fr", "plate_fr_displacement"),
    "height": ("height", "profile", "road", "displacement", "elevation"),
}
"""Default channel names, in lower case."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RecordedDrive:
    """Drive over a recorded road at the recorded speed, with a delay for each wheel.

    Attributes:
        road: file of the record.
        channel: number, exact name, or pattern of the speed channel.
        wheels: name of each wheel, its distance d behind the foremost wheel [m], its track.
        choice: channels of the heights (left and right, or height for both tracks), and preprocessing.
        duration: length [s]; None for the whole record.
        rate: sampling rate [Hz].
        driving: speed at which the tyres roll [m/s]; NaN for the mean speed of the record while the car drives, 0 for
            tyres that do not roll, None for the parameter of the car.
    """

    road: Path
    channel: str
    wheels: tuple[tuple[str, float, Side], ...]
    choice: Choice = field(default_factory=Choice, hash=False)
    duration: float | None = None
    rate: float = FINE_RATE
    driving: float | None = None

    @property
    def name(self) -> str:
        """Name of the results: "road_record_recorded"."""
        return f"road_{self.road.stem}_recorded"

    @property
    def speed(self) -> None:
        """None, as the speed is not constant: a film shows the plates without the road."""
        return

    def signal(self) -> Signal:
        """Return the plate signals."""
        measurement = read_record(self.road, self.choice.databases)
        time, tracks, highest, notices = self._heights(measurement)
        speed, speed_notices = self._driven(measurement, time)
        notices += speed_notices
        distance = scipy.integrate.cumulative_trapezoid(speed, time, initial=0.0)
        if distance[-1] < max(behind for _, behind, _ in self.wheels):
            raise DataError(f"{self.road}: drives {distance[-1]:.4g} m, less than the wheelbase; use a longer record")
        grid = uniform_time(samples=self._samples(float(time[-1] - time[0])), timestep=1.0 / self.rate)
        plates = {}
        for wheel, behind, side in self.wheels:
            tau = delayed(time - time[0], distance, grid, behind)
            # z(tau) of the track, with the rise from rest at the time tau of the foremost wheel.
            spline = scipy.interpolate.CubicSpline(time - time[0], tracks[side] - tracks[side][0])
            reached = np.isfinite(tau)
            times = np.where(reached, tau, 0.0)
            plates[wheel] = np.where(reached, spline(times) * half_cosine_at(times, RISE_S), 0.0) + 0.0
        notices += acceleration_events(plates, 1.0 / self.rate)
        moving = speed[speed > STANDING]
        if self.driving is not None and math.isnan(self.driving):
            notices.append(
                f"the slip of the tyres is computed with the mean speed of the record, {moving.mean():.3g} m/s, "
                f"although the speed is {moving.min():.3g} to {moving.max():.3g} m/s"
            )
        return Signal(
            time=grid,
            displacement=plates,
            notices=tuple(dict.fromkeys(notices)),
            source=f"road of {self.road.name} over time, {distance[-1]:.5g} m at {3.6 * float(moving.min()):.3g} to "
            f"{3.6 * float(speed.max()):.3g} km/h, {RISE_S:g} s rise from rest",
            sha256=measurement.sha256,
            highest=highest,
        )

    @property
    def skip(self) -> float:
        """Default start of the evaluation [s], see `RoadDrive.skip`; computed with the recorded speed."""
        measurement = read_record(self.road, self.choice.databases)
        time = self._heights(measurement)[0]
        distance = scipy.integrate.cumulative_trapezoid(self._driven(measurement, time)[0], time, initial=0.0)
        # Position at which the road has risen; the last wheel is there after its distance behind.
        risen = np.interp(RISE_S + AFTER_RISE_S, time - time[0], distance)
        reached = int(np.searchsorted(distance, risen + max(behind for _, behind, _ in self.wheels)))
        last = float(time[min(reached, time.size - 1)] - time[0])
        return max(SKIP_S, math.ceil(10.0 * last) / 10.0)

    @property
    def overrides(self) -> tuple[str, ...]:
        """Parameters that the drive sets on its car, as texts of `Car.load`: the speed at which the tyres roll."""
        if self.driving is None or not math.isnan(self.driving):
            return () if self.driving is None else (f"driving.speed={self.driving!r}",)
        measurement = read_record(self.road, self.choice.databases)
        v = self._driven(measurement, self._heights(measurement)[0])[0]
        return (f"driving.speed={round(float(v[v > STANDING].mean()), 2)!r}",)

    def _driven(self, measurement: Measurement, time: Vector) -> tuple[Vector, list[str]]:
        """Read the speed at the times of the heights [m/s], (n,), and notices on the speed channel."""
        speed = choose(measurement, self._choice_of_speed())
        if speed.quantities["speed"] != "velocity":
            raise DataError(
                f"{self.road}: --speed {PREFIX}{self.channel}: is a {speed.quantities['speed']}, but must be a "
                "velocity; choose another channel, or set --unit speed=km/h or speed=m/s if the unit in the file is "
                "wrong"
            )
        v, notices = self._speed(speed, time)
        return v, [*notices, *speed.notices]

    def _choice_of_speed(self) -> Choice:
        """Return the selection of the speed channel, with the excerpt of the heights."""
        choice = self.choice
        times = {role: name for role, name in choice.channels.items() if role == "time"}
        units = {role: unit for role, unit in choice.units.items() if role in ("speed", "time")}
        return Choice(channels={**times, "speed": self.channel}, units=units, first=choice.first, last=choice.last)

    def _samples(self, length: float) -> int:
        """Return the number of samples of the signal for a record of this length [s]."""
        if self.duration is not None and not 0.0 < self.duration <= length * (1.0 + 1e-9):
            raise ConfigurationError(f"--duration {self.duration:g} s: must be at most the record, {length:.6g} s")
        return int(np.floor((self.duration or length) * self.rate * (1.0 + 1e-12))) + 1

    def _heights(self, measurement: Measurement) -> tuple[Vector, dict[str, Vector], float | None, list[str]]:
        """Read times [s], heights of both tracks [m], maximum frequency (None if not limiting), and notices."""
        roles = self._roles(measurement)
        choice = replace(self.choice, channels={**self.choice.channels, **roles})
        units = {role: unit for role, unit in choice.units.items() if role != "speed"}
        chosen = choose(measurement, replace(choice, units=units))
        chosen.require_uniform(self.road)
        values, notices_of_plates = displacement(chosen, choice, str(self.road))
        notices, time = [*chosen.notices, *notices_of_plates], chosen.time
        rate = (time.size - 1) / float(time[-1] - time[0])
        if rate < FINE_RATE * (1.0 - UNIFORM_TOLERANCE):
            values, notice = resampled(time, values, FINE_RATE, lambda row: f"{self.road}: sample {row + 1}", True)
            time = time[0] + np.arange(next(iter(values.values())).size) / FINE_RATE
            notices.append(notice)
        limited = chosen.highest < USABLE * SMOOTH_RATE * (1.0 - UNIFORM_TOLERANCE)
        if limited:
            notices.append(f"the heights are valid up to {chosen.highest:.4g} Hz; FRFs and comfort end there")
        if len(values) == 1:
            (role,) = values
            notices.append(
                f"{self.road.name}: the file has one track, {roles[role]!r}: both sides of the car drive on it"
            )
            values = dict.fromkeys(("left", "right"), values[role])
        return time, values, chosen.highest if limited else None, notices

    def _roles(self, measurement: Measurement) -> dict[str, str]:
        """Return the channels of the heights, from the selection or by default names."""
        roles = {role: name for role, name in self.choice.channels.items() if role != "time"}
        unknown = next((role for role in roles if role not in NAMES), None)
        if unknown is not None:
            raise ConfigurationError(f"--channel {unknown}=...: must be left, right or height for a recorded road")
        receiver = of_receiver(measurement.channels)
        if not roles:
            names_in_file = {channel.name.strip().rstrip(".").lower(): channel.name for channel in measurement.channels}
            for role, names in NAMES.items():
                match = next((names_in_file[name] for name in names if name in names_in_file), None)
                if match is not None and not (role == "height" and (roles or receiver)):
                    roles[role] = match
        if not roles or ("height" in roles and len(roles) > 1):
            above_sea = "; the height beside latitude and longitude belongs to the GPS receiver" if receiver else ""
            raise DataError(
                f"{self.road}: which channels are the heights? set --channel left=NAME --channel right=NAME, or "
                f"--channel height=NAME for both tracks; the file has {measurement.listed()}{above_sea}"
            )
        return roles

    def _speed(self, speed: Chosen, time: Vector) -> tuple[Vector, list[str]]:
        """Interpolate the speed to the times of the heights [m/s], (n,); return it with notices."""
        speed_time, values = speed.time, speed.values["speed"]
        slack = 1.5 * float(np.median(np.diff(speed_time)))
        if speed_time[0] > time[0] + slack or speed_time[-1] < time[-1] - slack:
            raise DataError(
                f"{self.road}: the speed covers {speed_time[0]:.6g} to {speed_time[-1]:.6g} s, the heights "
                f"{time[0]:.6g} to {time[-1]:.6g} s; set --from {max(speed_time[0], time[0]):.6g} --to "
                f"{min(speed_time[-1], time[-1]):.6g}"
            )
        low, high = float(values.min()), float(values.max())
        if low < -BACKWARDS or high > FASTEST or high <= STANDING:
            raise DataError(
                f"{self.road}: the speed {self.channel!r} is {low:.4g} to {high:.4g} m/s but must be {-BACKWARDS:g} "
                f"to {FASTEST:g} m/s, with some motion; is the unit right? set --unit speed=km/h or speed=m/s"
            )
        resampled_speed = np.maximum(np.interp(time, speed_time, values), 0.0)
        standing = float(np.mean(resampled_speed < STANDING))
        notices = []
        if standing > 0.0:
            notices.append(f"the car stands for {100.0 * standing:.3g} % of the record (below {STANDING:g} m/s)")
        return resampled_speed, notices

    def identity(self) -> dict[str, object]:
        """Return all data that determine the signal: parameters, and the digest of the record."""
        return {
            "road": digest(self.road),
            "channel": self.channel,
            "wheels": self.wheels,
            "choice": repr(self.choice),
            "duration": self.duration,
            "rate": self.rate,
        }

    def summary(self, signal: Signal) -> Mapping[str, object]:
        """Return the description of the road for the summary of a run."""
        return {
            "class": None,
            "profile": str(self.road),
            "speed_kmh": None,
            "speed_channel": self.channel,
            "seed": None,
            "coherence": None,
            "contact_patch_m": 0.0,
            "behind_m": {name: behind for name, behind, _ in self.wheels},
            "words": signal.source,
        }


def delayed(time: Vector, distance: Vector, grid: Vector, behind: float) -> Vector:
    """Return the times tau [s], (m,), with s(tau) = s(t) - d; NaN before the wheel reaches the beginning of the record.

    Args:
        time: times of the record [s], (n,), increasing.
        distance: s at these times [m], (n,), not decreasing.
        grid: times t [s], (m,), within the record.
        behind: distance d behind the foremost wheel [m], at least 0.
    """
    if behind == 0.0:
        return grid
    # A car at rest has many times for the same position: use the last one.
    last_times = np.append(np.diff(distance) > 0.0, True)
    positions = np.interp(grid, time, distance) - behind
    # Inverse of s(t), which increases between the chosen times.
    tau = np.interp(positions, distance[last_times], time[last_times])
    return np.where(positions < distance[0], np.nan, tau)
