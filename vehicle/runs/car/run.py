"""A finished simulation of the car, and what can be asked of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from vehicle.drawing.notebook.cards import run_card
from vehicle.drawing.notebook.frames import recording_dataset, recording_frame
from vehicle.drawing.notebook.picture import Picture, picture
from vehicle.drawing.notebook.run_response import RunResponse, of_wheel, require_moving, responses
from vehicle.engines.simulation.recording import Recording
from vehicle.names import AXES
from vehicle.signals.analysis.comfort import COMFORT_BAND, ComfortValue, comfort_value
from vehicle.signals.analysis.motion_response import MotionResponse
from vehicle.signals.analysis.seat_value import weighted_rms_of
from vehicle.signals.analysis.slip import first_slip, slip_share
from vehicle.signals.excitation.signal import Signal

if TYPE_CHECKING:
    from vehicle.runs.car.car import Car

FRF_BAND = (1.0, 50.0)
"""Frequencies of an FRF [Hz]."""

SATURATED_VELOCITY = 1e-3
"""Damper velocity [m/s] above which the smooth friction law is within 0.6 % of its limit: stick has ended. No slip yet:
that is `damper.slip_velocity`."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Run:
    """Finished simulation: time histories, FRFs, comfort, slip, pictures.

    Attributes:
        car: what was simulated; with the step that answers it, where its file gives none.
        signal: displacement of the plates.
        recording: channels over time, and how the engine fared.
        engine_reason: why that engine.
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
        engine = self.recording.statistics.engine
        source = Path(self.signal.source).name
        short = source if len(source) < 50 else f"{source[:47]}..."
        return f"Run({short}, {self.signal.duration:g} s, {engine}, {self.car!r})"

    def _repr_html_(self) -> str:
        return run_card(self)

    def plot(self) -> Picture:
        """The main time histories as a figure that a notebook shows."""
        from vehicle.drawing.rendering.plots import plot_time

        return picture(lambda path: plot_time(path, self))

    def to_dataframe(self) -> Any:
        """All channels as a pandas table over the time [s]; `attrs["units"]` has their units."""
        return recording_frame(self.recording)

    def to_xarray(self) -> Any:
        """All channels as an xarray dataset over the time, each with its unit."""
        return recording_dataset(self.recording)

    def __getitem__(self, channel: str) -> npt.NDArray[np.float64]:
        """Time history of a channel; names are those of `car.vehicle.channels`, units in `recording.units`."""
        return self.recording[channel]

    @property
    def time(self) -> npt.NDArray[np.float64]:
        """Sample times [s]."""
        return self.recording.time

    @property
    def evaluated(self) -> slice:
        """Samples of the evaluated span, from `skip` to the end."""
        return slice(round(self.skip / self.recording.timestep), None)

    @property
    def wheel(self) -> str:
        """The excited wheel; the right one where both are, the first of the signal where its plates stand still."""
        return (*self.recording.excited, *self.signal.wheels)[0]

    def frf(
        self, channels: Sequence[str] | None = None, *, window: float | None = None, wheel: str | None = None
    ) -> RunResponse:
        """FRFs of acceleration channels to the plate displacement, 1 to 50 Hz, with coherence and random error.

        They end where the band of the signal ends.

        Where several plates move independently, the FRF is that to the plate of one wheel alone, the coherence that
        with all; plates that are copies without a delay count as one, and the FRF is that to their common motion.

        Args:
            channels: names; all acceleration channels by default.
            window: None for the estimate without leakage from the whole record; a length [s] for the H1 estimate
                of averaged Hann windows.
            wheel: whose plate; `self.wheel` by default.

        Returns:
            The estimate; rows in the order of `channels`; NaN where the plate drives nothing.

        Raises:
            DataError: the record is too short, or no plate moves.
            DependentInputsError: one plate moves as the other some time before.
        """
        require_moving(self.recording, wheel)
        names = self.car.vehicle.acceleration_channels if channels is None else tuple(channels)
        return of_wheel(self.frfs(channels, window=window), wheel, names)

    def frfs(self, channels: Sequence[str] | None = None, *, window: float | None = None) -> tuple[MotionResponse, ...]:
        """FRFs of acceleration channels to each plate that moves by itself, separated; arguments as of `frf`.

        Returns:
            One for each independent motion; plates that move together without a delay are one.

        Raises:
            DataError, DependentInputsError: as of `frf`.
        """
        names = self.car.vehicle.acceleration_channels if channels is None else tuple(channels)
        return responses(self.recording, self.signal, names, self.signal.band(FRF_BAND), window)

    def comfort(self, place: str = "seat_rail") -> ComfortValue:
        """Return the unweighted RMS acceleration of a place in 2 to 50 Hz, per axis and overall [m/s2].

        The evaluated span counts. The band ends where that of the signal ends; see `ComfortValue.band`. For weighted
        values see `weighted_comfort`.
        """
        return comfort_value(self.recording.timestep, self.at(place), self.signal.band(COMFORT_BAND))

    def at(self, place: str) -> list[npt.NDArray[np.float64]]:
        """Accelerations of a place in x, y, z [m/s2] over the evaluated span."""
        return [self.recording[f"{place}_acc_{axis}"][self.evaluated] for axis in AXES]

    def weighted_comfort(self, place: str = "seat_rail") -> dict[str, float]:
        """Weighted RMS acceleration (ISO 2631-1, as on a seat: z by Wk, x and y by Wd) of a place [m/s2].

        Returns:
            By axis, and "overall", their vector sum: the value of the report and of `summary.json`.
        """
        axes = [self.recording[f"{place}_acc_{axis}"] for axis in AXES]
        weighted = weighted_rms_of(self.recording.timestep, axes, skip=self.skip)
        return dict(zip((*AXES, "overall"), weighted, strict=True))

    def slip_share(self, wheel: str, velocity: float | None = None) -> float:
        """Share of the evaluated span with |damper velocity| above one [m/s]; that of the parameters by default."""
        history, limit = self._damper(wheel, velocity)
        return slip_share(history[self.evaluated], limit)

    def first_slip(self, wheel: str, velocity: float | None = None) -> float | None:
        """First time [s] with |damper velocity| above a velocity [m/s], by default as `slip_share`; None for never."""
        return first_slip(self.time, *self._damper(wheel, velocity))

    def _damper(self, wheel: str, velocity: float | None) -> tuple[npt.NDArray[np.float64], float]:
        """Velocity of a damper, and the one that counts as slip [m/s]."""
        self.car.vehicle.require_wheels((wheel,))
        limit = self.car.vehicle.damper.slip_velocity if velocity is None else velocity
        return self.recording[f"damper_{wheel}_velocity"], limit
