"""The part of a car without runs in time: its periodic states, and the diagnosis of a drive."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy.typing as npt

from vehicle.handed_down import HANDED
from vehicle.runs.car.law_band import BandedCar
from vehicle.threads import one_blas_thread

if TYPE_CHECKING:
    from vehicle.runs.car.levels import LevelMap, Plates


class SteadyCar(BandedCar):
    """Base of `Car`: periodic states without a start-up, and the diagnosis of a drive."""

    def diagnose(self, record: Path | str, speed: float | str | tuple[float, float], **settings: Any) -> Any:
        """Return a `CarDiagnosis`: worn dampers by a record of a drive, with probabilities; this car is not worn.

        Args:
            record: measurement file with accelerations at points of the car.
            speed: speed [km/h], lower and upper speed, or "channel:NAME".
            settings: `channels` {channel of the car: channel of the file}, `choice`, `inverted`, `free`, `parts`,
                `count`, `seed`, `progress`; see `vehicle.studies.diagnosis.diagnosis.diagnose_car`.
        """
        return HANDED["diagnose_car"](self, record, speed, **settings)

    @one_blas_thread()
    def levels(
        self,
        *,
        frequency: npt.ArrayLike,
        level: npt.ArrayLike,
        plates: Plates = "heave",
        channels: str | Sequence[str] = "seat rail z",
        samples: int = 128,
        progress: Callable[[float], None] | None = None,
    ) -> LevelMap:
        """Return the periodic states of the car with all its laws over frequency and level, on sinusoidal plates.

        At each pair of both the first harmonic (FRF), RMS, peak and distortion of the channels, slip and energy of the
        dampers; the level at which each damper begins to slip, and the damping that is left.

        Args:
            frequency: frequencies [Hz], ascending; at least 1 Hz for rolling tyres.
            level: amplitudes of the plates [m], ascending.
            plates: heave, pitch, roll or warp; a wheel; shares with phases in degrees as "fl=1,fr=1@90"; or a
                dictionary of complex numbers.
            channels: names or words of channels that respond to the plates, loads too.
            samples: samples of a period; a notice names channels that need more.
            progress: called with the finished fraction.

        Raises:
            ConfigurationError: a value out of range, an unstable or linear car, or a law without a periodic port:
                controlled dampers, laws by address, friction by side forces, applied forces.
        """
        from vehicle.runs.car.levels import car_levels

        return car_levels(
            self,
            plates=plates,
            frequency=frequency,
            level=level,
            channels=channels,
            samples=samples,
            progress=progress,
        )
