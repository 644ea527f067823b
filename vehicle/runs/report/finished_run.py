"""Finished run, read from its folder for the report."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from vehicle.engines.simulation.recording import Recording
from vehicle.errors import DataError
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.names import side_of, wheel_words
from vehicle.runs.car import Car
from vehicle.runs.output.saved_run import file_of_run, read_recording
from vehicle.runs.targets.verdict import RatedRun
from vehicle.signals.analysis.evaluated_span import evaluated_span
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.motion_response import MotionResponse
from vehicle.signals.analysis.response_name import PLATE, ResponseName
from vehicle.signals.records.run_frf import run_frf
from vehicle.signals.records.run_summary import ComfortSummary, FrfSummary, Peaks, RunSummary, read_summary


@dataclass(frozen=True, kw_only=True, slots=True)
class PlateSignal:
    """Excitation of a finished run, from its summary."""

    source: str  # name of the file or of the road
    plate_rms: dict[str, float]  # RMS displacement of each plate [m]

    def rms(self, wheel: str) -> float:
        """RMS of the displacement of a plate [m]."""
        return self.plate_rms[wheel]


@dataclass(frozen=True, kw_only=True, eq=False)
class FinishedRun(RatedRun):
    """Content of the folder of a run; its recording has no poses, and its name is that in headings and legends."""

    folder: Path  # where its files are read
    place: Path  # final path of the folder, as in commands
    # FRFs of all acceleration channels to each independent motion of the plates; may be empty
    responses: tuple[MotionResponse, ...]

    @property
    def peaks(self) -> list[tuple[str, str, Peaks]]:
        """Resonances to each motion of the plates: wheel of its first plate, plates in words, peaks by channel.

        The words are empty for a single motion.
        """
        estimate, wheels = self.summary.frf, self.car.vehicle.wheels
        if len(self.responses) < 2 or estimate is None:
            return [(self.wheel, "", self.summary.peaks)]
        each = [self.summary.peaks if motion.peaks is None else motion.peaks for motion in estimate.to]
        return [
            (motion.first, " and ".join(f"plate {side_of(wheel, wheels)}" for wheel in motion.motion), peaks)
            for motion, peaks in zip(self.responses, each, strict=True)
        ]

    @property
    def comfort(self) -> dict[str, ComfortSummary]:
        """Comfort by point; "seat" only if the car has a seat, otherwise it is a point of the body."""
        seated = self.car.vehicle.seated
        return {point: value for point, value in self.summary.comfort.items() if point != "seat" or seated}

    @property
    def wheel(self) -> str:
        """The excited wheel."""
        return self.summary.input.wheel

    @property
    def friction(self) -> bool:
        """True if a damper has friction, so that it can stick and slip."""
        return any(damper.law.static_friction > 0.0 for damper in self.car.vehicle.composition.dampers)

    @property
    def evaluated(self) -> slice:
        """Evaluated samples, as in `Run`."""
        return evaluated_span(self.recording.time.size, self.recording.timestep, self.skip)

    @property
    def span(self) -> str:
        """Evaluated span in words; empty for the whole record."""
        return f"{self.skip:g} to {self.summary.evaluated_s[1]:g} s" if self.skip > 0.0 else ""

    @cached_property
    def signal(self) -> PlateSignal:
        """Excitation of the run."""
        return PlateSignal(source=self.summary.input.file, plate_rms=self.summary.input.plate_rms_m)

    @property
    def caption(self) -> str:
        """Caption of a plot: input, level, tyres and engine."""
        excitation, solver = self.summary.input, self.summary.solver
        estimator = f"; estimator: {self.responses[0].response.estimator}" if self.responses else ""
        wheel = wheel_words(excitation.wheel, self.car.vehicle.wheels)
        level = f"RMS {1e3 * excitation.rms_m:.3g} mm at the {wheel}" if excitation.rms_m else "plates at rest"
        return (
            f"{Path(excitation.file).name}, {level}, "
            f"{excitation.duration_s:g} s{estimator}; tyres {self.car.vehicle.driving.words}; engine: "
            f"{solver.engine}"
        )


def read_run(
    folder: Path, *, final_path: Path | None = None, car: Car | None = None, recording: Recording | None = None
) -> FinishedRun:
    """Read the folder of a run.

    Args:
        folder: folder with `summary.json`, `vehicle.toml`, `time.npz` or `time.csv`, and `frf.csv` if there are FRFs.
        final_path: final path of a folder that is still written under a temporary name.
        car: car of the run; by default built from `vehicle.toml`.
        recording: time histories; by default read from the folder.

    Raises:
        ConfigurationError: the folder is not of a run.
        DataError: a file of it is missing or damaged.
    """
    summary = read_summary(folder)
    vehicle_file, recording = file_of_run(folder, summary, "vehicle"), recording or read_recording(folder, summary)
    run_car = car or _car(vehicle_file, summary)
    estimate = summary.frf
    frfs: tuple[MotionResponse, ...] = ()
    if estimate is not None and "frf" in summary.files:
        table = file_of_run(folder, summary, "frf")
        frfs = _responses(table, run_car.vehicle.acceleration_channels, estimate, summary)
    return FinishedRun(
        name=(final_path or folder).resolve().name,
        folder=folder,
        place=final_path or folder,
        summary=summary,
        car=run_car,
        recording=recording,
        responses=frfs,
    )


def _car(path: Path, summary: RunSummary) -> Car:
    """Return the car of a run; files that `vehicle.toml` names are searched in the folder of the original file."""
    origin = summary.vehicle.file
    car = Car(load_vehicle(path), folder=path.parent if origin is None else Path(origin).parent)
    car.origin = {"file": origin, "overrides": summary.vehicle.overrides}
    return car


def _responses(
    path: Path, channels: Sequence[str], estimate: FrfSummary, summary: RunSummary
) -> tuple[MotionResponse, ...]:
    """Read the FRFs to each motion of the plates."""
    table = run_frf(path, summary)
    responses = []
    for motion in dict.fromkeys(name.motion for name in table.names):
        wanted = [ResponseName(name, motion) for name in channels]
        missing = next((str(name) for name in wanted if name not in table.names), None)
        if missing is not None:
            raise DataError(f"{path}: no FRFs of {missing}, a channel of the car; run the simulation again")
        rows = [table.names.index(name) for name in wanted]
        response = FrequencyResponse(
            frequency=table.frequency,
            response=table.response[rows],
            coherence=table.coherence[rows],
            random_error=table.random_error[rows],
            averages=np.full((len(rows), table.frequency.size), np.nan),
            segments=0,
            window=estimate.window,
            estimator=estimate.estimator,
            resolution_hz=estimate.resolution_hz,
            reasons=(),
        )
        plates = {plate.removeprefix(PLATE): factor for plate, factor in motion}
        responses.append(MotionResponse(motion=plates, response=response))
    return tuple(responses)
