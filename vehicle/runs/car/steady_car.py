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
    from vehicle.runs.car.level_inputs import Shares
    from vehicle.runs.car.levels import LevelMap
    from vehicle.runs.car.random_levels import RandomLevelMap
    from vehicle.runs.car.road import Road
    from vehicle.signals.excitation.signal import Signal


class SteadyCar(BandedCar):
    """Base of `Car`: periodic states without a start-up, and the diagnosis of a drive."""

    def diagnose(self, record: Path | str, speed: float | str | tuple[float, float], **settings: Any) -> Any:
        """Return a `CarDiagnosis`: worn dampers by a record of a drive, with probabilities; this car is not worn.

        Args:
            record: measurement file with accelerations at points of the car.
            speed: speed [km/h], lower and upper speed, "channel:NAME", or "position:LATITUDE,LONGITUDE".
            settings: `channels` {channel of the car: channel of the file}, `choice`, `inverted`, `free`, `forward`,
                `parts`, `count`, `seed`, `progress`; see `vehicle.studies.diagnosis.diagnosis.diagnose_car`.
        """
        return HANDED["diagnose_car"](self, record, speed, **settings)

    @one_blas_thread()
    def steady(self, source: Signal | Road | Path | str, *, channels: Sequence[str] | None = None) -> Any:
        """Return a run without a start-up: the periodic state of the car on plates or a road that repeat.

        The last period of the record is evaluated; the periods before it let the weighting filters settle. The laws
        act as in `Car.run` with the reduced engine, and `SteadyRun.gradient` has derivatives by the parameters. With
        presliding or rubber friction, or where nearly all dampers stick, the iteration does not end, and a run in time
        over several periods takes its place, with a notice.

        Args:
            source: a `Signal` of one period, whose last sample is the first of the next one, a file or name of one; or
                a road of a class, for example road("C", 80), which repeats after its evaluated span.
            channels: names of the recorded channels; default: all but `vehicle.requested_channels`.

        Returns:
            The run, a `vehicle.runs.car.steady_run.SteadyRun`.

        Raises:
            ConfigurationError, DataError: ends that differ, a road that does not repeat, an unstable car, or a law
                without a periodic port, see `levels`.
        """
        return HANDED["steady_run"](self, source, channels)

    @one_blas_thread()
    def levels(
        self,
        *,
        frequency: npt.ArrayLike,
        level: npt.ArrayLike,
        level_unit: str | None = None,
        plates: Shares = "heave",
        force: Shares | None = None,
        axle_delay: float | None = None,
        channels: str | Sequence[str] = "seat rail z",
        samples: int = 128,
        progress: Callable[[float], None] | None = None,
    ) -> LevelMap:
        """Return the periodic states of the car with all its laws over frequency and level, on a sinusoidal input.

        At each pair of both the first harmonic (FRF), RMS, peak and distortion of the channels, slip and energy of the
        dampers; the level at which each damper begins to slip, and the damping that is left.

        Args:
            frequency: frequencies [Hz], ascending; at least 1 Hz for rolling tyres.
            level: amplitudes of the plates [m], or of the force [N or N m], ascending.
            level_unit: "m/s2" for amplitudes of the acceleration of the plates.
            plates: heave, pitch, roll or warp; a wheel; shares with phases in degrees as "fl=1,fr=1@90"; or a
                dictionary of complex numbers.
            force: applied forces in place of the plates, with the level as their amplitude in place of their histories:
                the name of a force; a beginning of names as "imbalance_fr", for forces that turn together; shares as
                above; or a dictionary.
            axle_delay: speed of the car over the plates [km/h], whose rear axles move later; none by default.
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
            force=force,
            axle_delay=axle_delay,
            level_unit=level_unit,
            frequency=frequency,
            level=level,
            channels=channels,
            samples=samples,
            progress=progress,
        )

    @one_blas_thread()
    def random_levels(
        self,
        *,
        level: npt.ArrayLike,
        plates: Shares = "heave",
        axle_delay: float | None = None,
        channels: str | Sequence[str] = "seat rail z",
        realisations: int = 40,
        seed: int = 0,
        progress: Callable[[float], None] | None = None,
    ) -> RandomLevelMap:
        """Return the best linear approximation of the car on random plates: an FRF for each level.

        The plates repeat after 8 s and have a flat velocity spectrum from 0.5 to 40 Hz, like a road after ISO 8608.

        Args:
            level: RMS of the displacement of the plates [m], ascending.
            plates, axle_delay, channels: as in `levels`.
            realisations: number of signals with other phases, whose scatter is the distortion.
            seed: of the phases.
            progress: called with the finished fraction.

        Raises:
            ConfigurationError: as in `levels`.
        """
        from vehicle.runs.car.random_levels import car_random_levels

        return car_random_levels(
            self,
            level=level,
            plates=plates,
            axle_delay=axle_delay,
            channels=channels,
            realisations=realisations,
            seed=seed,
            progress=progress,
        )
