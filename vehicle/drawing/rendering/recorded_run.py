"""Protocol of a run for plots and films, and functions for its wheels and for the choice of an excerpt."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np
import numpy.typing as npt

from vehicle.engines.simulation.recording import Recording
from vehicle.model.parameters.composition import Composition

if TYPE_CHECKING:  # processes that draw a film need no compiler of models
    from vehicle.engines.simulation.car_model import CarModel

Vector = npt.NDArray[np.float64]


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
    """Describe the size of a plate motion: the height of a bump, or the RMS of a continuous motion.

    Args:
        recording: recording of the run.
        wheel: wheel of the plate.
        rms: RMS of the plate displacement [m].
    """
    plate = 1e3 * recording[f"plate_{wheel}_displacement"]
    largest = float(np.max(np.abs(plate, out=plate)))
    if np.mean(plate > 0.01 * largest) < BUMP_SHARE:
        return f"{largest:.2g} mm bump"
    return f"RMS {1e3 * rms:.3g} mm"


BUMP_SHARE = 0.5
"""Maximum share of the record in which the plate is displaced for a motion to count as a single bump."""


def liveliest(time: Vector, values: Vector, length: float) -> float:
    """Return the start [s] of the time window of a given length with the largest mean square of a channel.

    Args:
        time: uniform sample times [s], (n,).
        values: channel, (n,).
        length: length of the window [s]; limited to the record.

    Returns:
        First time of the window [s].
    """
    count = min(round(length / (time[1] - time[0])) + 1, len(time))
    sums = np.zeros(len(time) + 1)
    np.cumsum(values**2, out=sums[1:])
    return float(time[np.argmax(sums[count:] - sums[:-count])])


def excerpt_start(recording: Recording, wheel: str, hub: str, slip_velocity: float, length: float) -> tuple[float, str]:
    """Choose the time window with the largest damper motion of a wheel; without slip, with the largest knuckle motion.

    Args:
        recording: recording of the run.
        wheel: the excited wheel.
        hub: acceleration channel of the part that carries the wheel.
        slip_velocity: damper velocity above which the damper slips [m/s].
        length: length of the window [s].

    Returns:
        First time [s], and the reason for the choice.
    """
    velocity = recording.channels.get(f"damper_{wheel}_velocity")
    if velocity is not None and np.any(np.abs(velocity) > slip_velocity):
        return liveliest(recording.time, velocity, length), "most damper motion"
    return liveliest(recording.time, recording[hub], length), "liveliest knuckle; no slip"
