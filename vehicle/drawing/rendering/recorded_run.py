"""Protocol of a run for plots and films, and functions for its wheels and its liveliest moment."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

import numpy as np

from vehicle.engines.simulation.recording import Recording
from vehicle.model.parameters.composition import Composition
from vehicle.signals.analysis.samples import Vector

if TYPE_CHECKING:  # processes that draw a film need no compiler of models
    from vehicle.engines.simulation.car_model import CarModel


class RecordedSignal(Protocol):
    """Excitation of a run."""

    @property
    def source(self) -> str:
        """Return the name of the file or of the generator."""

    def rms(self, wheel: str) -> float:
        """Return the RMS of the displacement of a plate [m]."""


class RecordedCar(Protocol):
    """Car of a run."""

    @property
    def model(self) -> CarModel:
        """Return the compiled model with the parameters of the car."""


class RecordedRun(Protocol):
    """Finished run."""

    @property
    def car(self) -> RecordedCar:
        """Return the car."""

    @property
    def signal(self) -> RecordedSignal:
        """Return the input signal."""

    @property
    def recording(self) -> Recording:
        """Return the recording."""

    @property
    def wheel(self) -> str:
        """Return the excited wheel; the right wheel if both are excited."""


def wheels_of(recording: Recording) -> tuple[str, ...]:
    """Return the names of the wheels with recorded plates, in the order of the channels."""
    return _between(recording, "plate_", "_displacement")


def dampers_of(recording: Recording) -> tuple[str, ...]:
    """Return the names of the dampers after "damper_", the names of their wheels, in the order of the channels."""
    return _between(recording, "damper_", "_velocity")


def _between(recording: Recording, start: str, end: str) -> tuple[str, ...]:
    names = [name for name in recording.channels if name.startswith(start) and name.endswith(end)]
    return tuple(name.removeprefix(start).removesuffix(end) for name in names)


def hub_of(composition: Composition, wheel: str) -> str:
    """Return the name of the part that carries a wheel."""
    rolling = next(placed.part for placed in composition.wheels if placed.name == wheel)
    return next(part.parent for part in composition.parts if part.name == rolling)


def hub_channel(composition: Composition, wheel: str) -> str:
    """Return the vertical acceleration channel of the part that carries a wheel, or else the tyre force channel."""
    hub = hub_of(composition, wheel)
    names = [output.name for output in composition.outputs if output.on == hub]
    return f"{names[0]}_acc_z" if names else f"tyre_{wheel}_force_z"


def level_words(recording: Recording, wheel: str, rms: float) -> str:
    """Describe a plate motion of a given RMS [m]: the height of a bump, or the RMS of a continuous motion."""
    if rms == 0.0:
        return "at rest"
    if event_of(recording, [wheel]) is None:
        return f"RMS {1e3 * rms:.3g} mm"
    return f"{1e3 * np.max(np.abs(recording[f'plate_{wheel}_displacement'])):.3g} mm bump"


def event_of(recording: Recording, wheels: Sequence[str]) -> tuple[float, float] | None:
    """Return begin and end of a single event of plates [s], as a bump; None if the motion is continuous or zero."""
    plates = np.abs([recording[f"plate_{wheel}_displacement"] for wheel in wheels])
    moved = np.flatnonzero(np.any(plates > EVENT_LEVEL * plates.max(initial=0.0), axis=0))
    if not moved.size or moved[-1] - moved[0] > EVENT_SHARE * recording.time.size:
        return None
    return float(recording.time[moved[0]]), float(recording.time[moved[-1]])


EVENT_LEVEL, EVENT_SHARE = 0.1, 0.5
"""Share of the largest displacement above which a plate is part of an event, and maximum share of the record."""


def liveliest(time: Vector, values: Vector, length: float) -> float:
    """Return the start [s] of the time window of a given length with the largest mean square of a channel.

    Args:
        time: uniform sample times [s], (n,).
        values: channel, (n,).
        length: length of the window [s]; limited to the record.
    """
    count = min(round(length / (time[1] - time[0])) + 1, len(time))
    sums = np.zeros(len(time) + 1)
    np.cumsum(values**2, out=sums[1:])
    return float(time[np.argmax(sums[count:] - sums[:-count])])
