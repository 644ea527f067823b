"""A finished run, read back from its folder: what a report needs of it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.engines.simulation.recording import Recording, Statistics
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.motion_response import MotionResponse
from vehicle.signals.records.frf_file import read_frf
from vehicle.signals.records.reader import read_columns


@dataclass(frozen=True, kw_only=True, slots=True)
class PlateSignal:
    """Excitation of a finished run, as its summary tells it.

    Attributes:
        source: name of the file or of the road.
        plate_rms: RMS displacement of each plate [m].
    """

    source: str
    plate_rms: dict[str, float]

    def rms(self, wheel: str) -> float:
        """RMS of the displacement of a plate [m]."""
        return self.plate_rms[wheel]


@dataclass(frozen=True, kw_only=True, eq=False)
class FinishedRun:
    """A folder of a run as objects.

    Attributes:
        name: short name in headings and legends.
        folder: where its files are read.
        place: the folder as commands name it.
        summary: content of `summary.json`.
        car: the car with the parameters as used.
        recording: time histories; no poses.
        responses: FRFs of all acceleration channels to each motion of the plates; none where there are none.
    """

    name: str
    folder: Path
    place: Path
    summary: dict[str, Any]
    car: Car
    recording: Recording
    responses: tuple[MotionResponse, ...]

    @property
    def response(self) -> FrequencyResponse | None:
        """FRFs to the first motion of the plates; None where there are none."""
        return self.responses[0].response if self.responses else None

    @property
    def wheel(self) -> str:
        """The excited wheel."""
        return str(self.summary["input"]["wheel"])

    @property
    def span(self) -> str:
        """Evaluated span in words, empty for the whole record."""
        begin, end = self.summary.get("evaluated_s") or (0.0, 0.0)
        return f"{begin:g} to {end:g} s" if begin > 0.0 else ""

    @cached_property
    def signal(self) -> PlateSignal:
        """What drove it."""
        return PlateSignal(source=self.summary["input"]["file"], plate_rms=self.summary["input"]["plate_rms_m"])

    @property
    def caption(self) -> str:
        """Input, level and engine in a line."""
        given, solver = self.summary["input"], self.summary["solver"]
        estimator = f"; estimator: {self.response.estimator}" if self.response is not None else ""
        return (
            f"{Path(given['file']).name}, RMS {1e3 * given['rms_m']:.3g} mm at wheel {given['wheel']}, "
            f"{given['duration_s']:g} s{estimator}; tyres {self.car.vehicle.driving.words}; engine: {solver['engine']}"
        )


def read_run(
    folder: Path, *, place: Path | None = None, car: Car | None = None, recording: Recording | None = None
) -> FinishedRun:
    """Read the folder of a run.

    Args:
        folder: with `summary.json`, `vehicle.toml`, `time.npz` or `time.csv`, and `frf.csv` where there are FRFs.
        place: what the folder will be called, where it is still written under another name.
        car: its car where it is at hand; else built from `vehicle.toml`.
        recording: its time histories where they are at hand; else read.

    Raises:
        ConfigurationError: no folder of a run.
        DataError: a file of it is missing or damaged.
    """
    if not (folder / "summary.json").is_file():
        raise ConfigurationError(f"{folder}: holds no summary.json; give the folder of a run, as runs/low")
    try:
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        names, given, solver = summary["files"], summary["input"], summary["solver"]
        places = {kind: folder / names[kind] for kind in ("vehicle", "time", "frf") if kind in names}
        excited = tuple(wheel for wheel, rms in given["plate_rms_m"].items() if rms > 0.0)
        statistics = Statistics(
            engine=solver["engine"],
            callback=solver["callback"],
            timestep=solver["timestep_s"],
            steps=solver["steps"],
            wall_time=solver["wall_s"],
            warnings=tuple(solver["warnings"]),
            energies=None,
        )
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise DataError(
            f"{folder / 'summary.json'}: is damaged ({type(error).__name__}: {error}); run it again"
        ) from None
    for kind, path in places.items():
        if not path.is_file():
            raise DataError(f"{path}: missing, though summary.json lists it as {kind}; run it again")
    if recording is None:
        record = read_columns(places["time"])
        recording = Recording(
            time=record.time,
            channels=record.channels,
            units=record.units,
            excited=excited,
            pose_time=np.empty(0),
            poses=np.empty((0, 0)),
            statistics=statistics,
        )
    own = car or _car(places["vehicle"], summary)
    frfs = _responses(places["frf"], own.vehicle.acceleration_channels, summary) if "frf" in places else ()
    return FinishedRun(
        name=(place or folder).resolve().name,
        folder=folder,
        place=place or folder,
        summary=summary,
        car=own,
        recording=recording,
        responses=frfs,
    )


def _car(path: Path, summary: dict[str, Any]) -> Car:
    """The car of a run; what its file names beside itself is looked for where that file lay."""
    origin = summary["vehicle"]["file"]
    car = Car(load_vehicle(path), folder=path.parent if origin is None else Path(origin).parent)
    car.origin = {"file": origin, "overrides": summary["vehicle"]["overrides"]}
    return car


def _responses(path: Path, channels: Sequence[str], summary: dict[str, Any]) -> tuple[MotionResponse, ...]:
    """FRFs of the table to each motion of the plates, with what the summary says of their estimate."""
    table, about = read_frf(path), summary["frf"]
    motions = [one["plates"] for one in about.get("to", ())] or [{summary["input"]["wheel"]: 1.0}]
    found = []
    for index, motion in enumerate(motions):
        ending = f"_to_{next(iter(motion))}" if index else ""
        missing = [name for name in channels if name + ending not in table.channels]
        if missing:
            raise DataError(f"{path}: no FRFs of {missing[0] + ending}, which the car of the run has; run it again")
        rows = [table.channels.index(name + ending) for name in channels]
        response = FrequencyResponse(
            frequency=table.frequency,
            response=table.response[rows],
            coherence=table.coherence[rows],
            random_error=table.random_error[rows],
            averages=np.full((len(rows), table.frequency.size), np.nan),
            segments=0,
            window=about["window"],
            estimator=about["estimator"],
            resolution_hz=about["resolution_hz"],
            reasons=(),
        )
        found.append(MotionResponse(motion=motion, response=response))
    return tuple(found)
