"""What a plot or a film asks of a run: any object with these properties will do."""

from __future__ import annotations

from typing import Protocol

from vehicle.simulation.car_model import CarModel
from vehicle.simulation.recording import Recording


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
