"""What a plot or a film asks of a run: any object with these properties will do; its wheels and its best moment."""

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
    """The excitation of a run."""

    @property
    def source(self) -> str:
        """Name of the file or of the generator."""

    def rms(self, wheel: str) -> float:
        """RMS of the displacement of a plate [m]."""


class RecordedCar(Protocol):
    """The car of a run."""

    @property
    def model(self) -> CarModel:
        """Its compiled model with the parameters behind it."""


class RecordedRun(Protocol):
    """A finished run."""

    @property
    def car(self) -> RecordedCar:
        """The car that ran."""

    @property
    def signal(self) -> RecordedSignal:
        """The signal it ran on."""

    @property
    def recording(self) -> Recording:
        """What the run left behind."""

    @property
    def wheel(self) -> str:
        """The excited wheel; the right one where both are."""


def wheels_of(recording: Recording) -> tuple[str, ...]:
    """Names of the wheels of a car: those whose plates are recorded, in the order of the channels."""
    return _between(recording, "plate_", "_displacement")


def dampers_of(recording: Recording) -> tuple[str, ...]:
    """Names of the dampers behind "damper_": those of their wheels, in the order of the channels."""
    return _between(recording, "damper_", "_velocity")


def _between(recording: Recording, start: str, end: str) -> tuple[str, ...]:
    found = [name for name in recording.channels if name.startswith(start) and name.endswith(end)]
    return tuple(name.removeprefix(start).removesuffix(end) for name in found)


def hub_of(composition: Composition, wheel: str) -> str:
    """The part that carries a wheel."""
    rolling = next(one.part for one in composition.wheels if one.name == wheel)
    return next(part.parent for part in composition.parts if part.name == rolling)


def hub_channel(composition: Composition, wheel: str) -> str:
    """Channel of the vertical acceleration on the part that carries a wheel; the tyre force where none is recorded."""
    hub = hub_of(composition, wheel)
    names = [output.name for output in composition.outputs if output.on == hub]
    return f"{names[0]}_acc_z" if names else f"tyre_{wheel}_force_z"


def level_words(recording: Recording, wheel: str, rms: float) -> str:
    """How large a plate moves, in words: a bump by its height, what goes on by its RMS.

    Args:
        recording: the run.
        wheel: whose plate.
        rms: of its displacement [m].
    """
    plate = 1e3 * recording[f"plate_{wheel}_displacement"]
    largest = float(np.max(np.abs(plate, out=plate)))
    if np.mean(plate > 0.01 * largest) < BUMP_SHARE:
        return f"{largest:.2g} mm bump"
    return f"RMS {1e3 * rms:.3g} mm"


BUMP_SHARE = 0.5
"""Share of the record below which a plate that moves is one single event."""


def liveliest(time: Vector, values: Vector, length: float) -> float:
    """Start [s] of the stretch of a given length with the largest mean square of a channel.

    Args:
        time: uniform sample times [s], (n,).
        values: channel, (n,).
        length: of the stretch [s]; the whole record where it is shorter.

    Returns:
        First time of the stretch [s].
    """
    count = min(round(length / (time[1] - time[0])) + 1, len(time))
    sums = np.zeros(len(time) + 1)
    np.cumsum(values**2, out=sums[1:])
    return float(time[np.argmax(sums[count:] - sums[:-count])])


def excerpt_start(recording: Recording, wheel: str, hub: str, slip_velocity: float, length: float) -> tuple[float, str]:
    """Choose a stretch: where the damper of a wheel works most; where it never slips, where the knuckle shakes most.

    Args:
        recording: the run.
        wheel: the excited wheel.
        hub: channel that tells how the part shakes that carries it.
        slip_velocity: [m/s].
        length: of the stretch [s].

    Returns:
        First time [s], and why.
    """
    velocity = recording.channels.get(f"damper_{wheel}_velocity")
    if velocity is not None and np.any(np.abs(velocity) > slip_velocity):
        return liveliest(recording.time, velocity, length), "most damper motion"
    return liveliest(recording.time, recording[hub], length), "liveliest knuckle; no slip"
