"""Finished simulation of a car with its results."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.drawing.notebook.cards import car_label, run_card
from vehicle.drawing.notebook.frames import recording_dataset, recording_frame
from vehicle.drawing.notebook.run_orders import RunOrderCut, RunOrders, named_cut, named_orders
from vehicle.drawing.notebook.run_response import RunResponse, of_wheel, require_moving, responses
from vehicle.drawing.notebook.run_spectra import RunSpectra, with_display
from vehicle.engines.simulation.recording import Recording
from vehicle.engines.simulation.stepping import Progress
from vehicle.errors import ConfigurationError
from vehicle.handed_down import HANDED
from vehicle.model.parameters.applied_force import CRANK
from vehicle.model.parameters.channel_words import channels_named
from vehicle.names import AXES
from vehicle.runs.car.run_twin import twin_comfort
from vehicle.signals.analysis.comfort import COMFORT_BAND
from vehicle.signals.analysis.evaluated_span import evaluated_span
from vehicle.signals.analysis.motion_response import MotionResponse
from vehicle.signals.analysis.order_cut import order_cut
from vehicle.signals.analysis.order_lines import order_lines
from vehicle.signals.analysis.ride_comfort import RIM, RunComfort, run_comfort
from vehicle.signals.analysis.slip import first_slip, slip_share
from vehicle.signals.excitation.force_lines import SweptLine
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.records.record_spectra import recorded_spectra

if TYPE_CHECKING:
    from vehicle.drawing.rendering.shot import Take
    from vehicle.runs.car.car import Car

FRF_BAND = (1.0, 50.0)
"""Frequencies of an FRF [Hz]."""

SATURATED_VELOCITY = 1e-3
"""Damper velocity [m/s] above which the smooth friction law is within 0.6 % of its limit: stick has ended. Slip begins
at the higher `damper.slip_velocity`."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Run:
    """Finished simulation: time histories, FRFs, comfort, slip, pictures.

    Attributes:
        car: simulated car; if its file sets no time step, with the step of `Car.stepped`.
        signal: displacement of the plates.
        recording: channels over time, and statistics of the engine.
        engine_reason: reason for the choice of the engine.
        skip: time [s] at the beginning that `comfort` and `slip_share` leave out.
        road: class or profile, speed and seed of the road, as in `summary.json`; None for plate signals.
    """

    car: Car
    signal: Signal
    recording: Recording
    engine_reason: str = "asked for"
    skip: float = 0.0
    road: Mapping[str, object] | None = None

    def __repr__(self) -> str:
        """One line."""
        engine, source = self.recording.statistics.engine, Path(self.signal.source).name
        short = source if len(source) < 50 else f"{source[:47]}..."
        return f"Run({short}, {self.signal.duration:g} s, {engine}, {self.car!r})"

    def _repr_html_(self) -> str:
        return run_card(self)

    @classmethod
    def load(cls, folder: Path | str) -> Run:
        """Read a saved run from its folder; see `vehicle.load_run`."""
        run: Run = HANDED["load_run"](folder)
        return run

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the recorded channels; their units are in `recording.units`."""
        return tuple(self.recording.channels)

    def plot(self, channels: str | Sequence[str] | None = None, ax: Any = None) -> Any:
        """Plot time histories.

        Args:
            channels: names or words of channels, as "seat rail z"; by default the plate, the seat rail, the knuckle and
                the damper of the excited wheel.
            ax: axes, one for each channel; a new figure by default.

        Returns:
            The axes: one, or an array.
        """
        from vehicle.drawing.rendering.curves import draw_histories
        from vehicle.drawing.rendering.open_axes import open_axes, plain

        names = self._named(channels) if channels is not None else self._main_channels()
        axes = open_axes(ax, (9.0, 1.0 + 1.7 * len(names)), len(names), sharex=True)
        units = self.recording.units
        draw_histories(axes, self.time, {name: (self[name], units[name]) for name in names}, car_label(self.car))
        return plain(axes)

    def to_dataframe(self) -> Any:
        """Return all channels as a pandas table over the time [s]; `attrs["units"]` contains the units."""
        return recording_frame(self.recording)

    def to_xarray(self) -> Any:
        """Return all channels as an xarray dataset over the time, with units."""
        return recording_dataset(self.recording)

    def __getitem__(self, channel: str) -> Vector:
        """Return the time history of a channel; its unit is in `recording.units`.

        Args:
            channel: name or words of a channel, as "seat_rail_acc_z" or "seat rail z".

        Raises:
            ConfigurationError: no recorded channel has this name or these words.
        """
        return self.recording[self._named(channel)[0]]

    @property
    def time(self) -> Vector:
        """Sample times [s]."""
        return self.recording.time

    @property
    def evaluated(self) -> slice:
        """Samples of the evaluated span, from `skip` to the end."""
        return evaluated_span(self.recording.time.size, self.recording.timestep, self.skip)

    @property
    def wheel(self) -> str:
        """Excited wheel: the first of several; the first of the signal if no plate moves."""
        return (*self.recording.excited, *self.signal.wheels)[0]

    def frf(
        self, channels: str | Sequence[str] | None = None, *, window: float | None = None, wheel: str | None = None
    ) -> RunResponse:
        """FRFs of acceleration channels to the plate displacement, 1 to 50 Hz, with coherence and random error.

        The FRFs end at the end of the band of the signal. If several plates move independently, the FRF refers to the
        plate of one wheel, and the coherence is the multiple coherence with all plates. Plates with equal motion count
        as one, with the FRF to this motion.

        Args:
            channels: names or words, as "seat rail z"; all acceleration channels by default.
            window: length of averaged Hann windows [s] for the H1 estimate; by default the whole record is evaluated
                without leakage, by its periods if the input is periodic, else by local rational models.
            wheel: wheel of the plate; `self.wheel` by default.

        Returns:
            The estimate; rows in the order of `channels`; NaN at lines without excitation.

        Raises:
            DataError: the record is too short, or no plate moves.
            DependentInputsError: a plate repeats the motion of another with a delay.
        """
        require_moving(self.recording, wheel)
        names = self._accelerations(channels)
        return of_wheel(self.frfs(names, window=window), wheel, names, car_label(self.car))

    def frfs(
        self, channels: str | Sequence[str] | None = None, *, window: float | None = None
    ) -> tuple[MotionResponse, ...]:
        """Return the FRFs of acceleration channels to each independent plate motion; arguments like `frf`.

        Returns:
            FRFs for each independent motion; plates with equal motion count as one.

        Raises:
            DataError, DependentInputsError: see `frf`.
        """
        names = self._accelerations(channels)
        return responses(self.recording, self.signal, names, self.signal.band(FRF_BAND), window)

    def comfort(self, point: str = "seat_rail") -> RunComfort:
        """Return both comfort values over the evaluated span, by axis and overall [m/s2].

        `unweighted` is the RMS in 2 to 50 Hz (Bommer 2006), at most up to the end of the band of the signal.
        `weighted` is the RMS weighted as on a seat (ISO 2631-1: Wk, Wd), at `steering_wheel_rim` as on a steering wheel
        (Giacomin et al. 2004: Ws). At the seat rail of a car with a seat, `cushion` has both on the cushion and
        `seat_value` the SEAT value. Report, `summary.json`, sweeps and searches have the same values under the names of
        `values`, those of the reduced engine within 1e-5 (many cars are computed in single precision).

        Args:
            point: output point of the car, for example "seat_rail".
        """
        recorded = all(f"seat_acc_{axis}" in self.recording.channels for axis in AXES)
        points = (point, "seat") if point == "seat_rail" and self.car.vehicle.seated and recorded else (point,)
        band, contact = self.signal.band(COMFORT_BAND), "steering_wheel" if point == RIM else "seat"
        return run_comfort(
            self.recording.timestep,
            *(self.recording.stacked([f"{name}_acc_{axis}" for axis in AXES]) for name in points),
            skip=self.skip,
            band=band,
            point=point.replace("_", " "),
            contact=contact,
            twin=twin_comfort(self.car, self.signal, self.recording, self.skip, points, band=band, contact=contact),
        )

    def figure(self, name: str) -> float:
        """Return a figure in its unit: NaN where it is undefined, infinite for a motion that does not settle.

        Args:
            name: name in the catalogue, as "travel_fr" or "rms:seat rail z:5-25"; `docs/howto/figures.md` lists all.

        Raises:
            ConfigurationError, DataError: an unknown figure, a missing channel, or a record too short for the band.
        """
        return float(HANDED["figure_of"](self, name))

    def orders(
        self,
        channels: str | Sequence[str] | None = None,
        *,
        angle: str | None = None,
        orders: Sequence[float] = (1.0, 2.0, 3.0),
    ) -> RunOrders:
        """Return complex amplitudes at orders of a turning part over the evaluated span, with their standard errors.

        Args:
            channels: names or words, as "seat rail z"; all acceleration channels by default.
            angle: "crank", a wheel, as "wheel_fr", or the name of a force with a frequency; by default that of the
                first applied force.
            orders: multiples of its frequency.

        Raises:
            ConfigurationError: nothing of this name turns.
            DataError: the record is too short, or an order above half its rate.
        """
        names = self._accelerations(None) if channels is None else self._named(channels)
        angle, speed = self.car.vehicle.composition.turning(angle)
        if angle == CRANK and self.car.vehicle.composition.crank_run_up is not None:
            raise ConfigurationError(f"orders: the speed of {angle} changes in this run; use order_cut")
        histories = self.recording.stacked(names)
        lines = order_lines(self.time, histories, speed / (2.0 * np.pi), orders, begin=self.skip)
        return named_orders(lines, names, tuple(self.recording.units[name] for name in names), angle)

    def order_cut(
        self, channels: str | Sequence[str] | None = None, *, orders: Sequence[float] = (2.0, 4.0)
    ) -> RunOrderCut:
        """Return complex amplitudes at orders of the crankshaft over its speed in a run-up.

        Args:
            channels: names or words, as "seat rail z"; all acceleration channels by default.
            orders: multiples of the speed.

        Raises:
            ConfigurationError: the speed of the crankshaft is constant.
            DataError: the record is too short, or an order above half its rate.
        """
        run_up = self.car.vehicle.composition.crank_run_up
        if run_up is None:
            raise ConfigurationError("order_cut needs a run-up; set crank.end_rpm and crank.run_up_time")
        names = self._accelerations(None) if channels is None else self._named(channels)
        inside = self.time <= run_up.duration
        time, histories = self.time[inside], np.array([self.recording[name][inside] for name in names])
        angle, speed = SweptLine(*run_up).angle(time)
        cut = order_cut(time, histories, angle, speed, orders, begin=self.skip)
        return named_cut(cut, names, tuple(self.recording.units[name] for name in names))

    def psd(self, channels: str | Sequence[str] | None = None) -> RunSpectra:
        """Return density, third octaves and cumulative RMS of channels, weighted too on seat and seat rail.

        Args:
            channels: names or words of channels of any unit, for example "seat rail z"; default: seat rail, a seat with
                an occupant, and the vertical acceleration of the knuckles.

        Raises:
            ConfigurationError: a channel is not recorded.
            DataError: the record is too short.
        """
        vehicle = self.car.vehicle
        source = Path(self.signal.source).name
        span = f"{self.skip:g} to {self.time[-1]:g} s"
        return with_display(
            recorded_spectra(
                self.recording,
                source,
                f"{source}, {span}, tyres {vehicle.driving.words}",
                None if channels is None else self._named(channels),
                begin=self.skip,
                seated=vehicle.seated,
                road=self.road,
                accelerations=False,
            ),
            car_label(self.car),
        )

    def save(self, folder: Path | str, *, force: bool = False) -> Path:
        """Write the folder of the command `shaker`; see `vehicle.save_run`."""
        path: Path = HANDED["save_run"](self, folder, force=force)
        return path

    def report(self, file: Path | str, *, force: bool = False, author: str = "", project: str = "") -> Path:
        """Write the report of the run as one HTML file; `vehicle.write_report` compares several saved runs.

        Args:
            file: name of the report, with the ending .html.
            force: replace a report that was written there before.
            author, project: names in the head of the report; may be empty.

        Raises:
            VehicleError: see `vehicle.save_run` and `vehicle.write_report`.
        """
        with TemporaryDirectory() as folder:
            saved = self.save(Path(folder) / Path(file).stem)
            path: Path = HANDED["write_report"]([saved], file, force=force, author=author, project=project)
        return path

    def film(
        self,
        file: Path | str,
        take: Take | None = None,
        *,
        beside: Run | None = None,
        names: tuple[str, str] = ("A", "B"),
        caption: str = "",
        progress: Progress | None = None,
    ) -> Path:
        """Write a film of a run of the MuJoCo engine as MP4.

        Args:
            file: name of the film, with the ending .mp4.
            take: start, length, slow motion, exaggeration and mode beside the run
                (`vehicle.drawing.rendering.shot.Take`); by default ten seconds with the largest motion, or a single
                event; slow where motion is fast.
            beside: another run of the same input, shown at the right of this one.
            names: names of both runs.
            caption: what differs between both, in a line.
            progress: called with the finished fraction.

        Raises:
            ConfigurationError: a run has no poses: the reduced engine stores none, nor does a saved run; or both have
                other inputs.
            MissingPartError: an off-screen OpenGL library or ffmpeg is missing.
            OutputError: the file cannot be written.
        """
        from vehicle.drawing.rendering.film import film, pair_film
        from vehicle.drawing.rendering.shot import Take

        if not all(run.recording.poses.size for run in (self, beside) if run is not None):
            raise ConfigurationError(
                f"{file}: the run has no positions of the parts, which the reduced engine and saved runs do not "
                "store; run the car with engine='mujoco'"
            )
        speed = (self.road or {}).get("speed_kmh")
        profile = (self.signal.time, self.signal.profile) if self.signal.profile else None
        driven = Take(speed=float(speed) / 3.6 if isinstance(speed, int | float) else None, profile=profile)
        if beside is None:
            film(self, Path(file), take or driven, progress=progress)
        else:
            both = dict(zip(names, (self, beside), strict=True))
            pair_film(both, caption or " and ".join(names), Path(file), take or driven, progress=progress)
        return Path(file)

    def at(self, point: str) -> list[Vector]:
        """Return the accelerations of an output point in x, y, z [m/s2] over the evaluated span."""
        return [self.recording[f"{point}_acc_{axis}"][self.evaluated] for axis in AXES]

    def slip_share(self, wheel: str, velocity: float | None = None) -> float:
        """Return the share of the evaluated span with |damper velocity| above a limit [m/s]; default: slip velocity."""
        history, limit = self._damper(wheel, velocity)
        return slip_share(history[self.evaluated], limit)

    def first_slip(self, wheel: str, velocity: float | None = None) -> float | None:
        """Return the first time [s] with |damper velocity| above a limit [m/s] (default: slip velocity), or None."""
        return first_slip(self.time, *self._damper(wheel, velocity))

    def _named(self, channels: str | Sequence[str]) -> tuple[str, ...]:
        """Return the recorded channels with these names or words."""
        return channels_named(channels, tuple(self.recording.channels))

    def _accelerations(self, channels: str | Sequence[str] | None) -> tuple[str, ...]:
        """Return the acceleration channels with these names or words; all by default."""
        names = self.car.vehicle.acceleration_channels
        return names if channels is None else channels_named(channels, names)

    def _main_channels(self) -> tuple[str, ...]:
        """Return the recorded channels among plate, seat rail, and knuckle and damper of the excited wheel."""
        wheel = self.wheel
        main = (f"plate_{wheel}_displacement", "seat_rail_acc_z", f"knuckle_{wheel}_acc_z", f"damper_{wheel}_velocity")
        recorded = tuple(name for name in main if name in self.recording.channels)
        return recorded or tuple(self.recording.channels)[:1]

    def _damper(self, wheel: str, velocity: float | None) -> tuple[Vector, float]:
        """Return the velocity of a damper, and the limit of slip [m/s]; default: its slip velocity."""
        self.car.vehicle.require_wheels((wheel,))
        history = self.recording[f"damper_{wheel}_velocity"]
        return history, self.car.vehicle.slip_velocities[wheel] if velocity is None else velocity
