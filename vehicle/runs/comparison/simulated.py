"""What a run gives to be compared: its time histories and frequency responses, by itself or by its files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.runs.car import Run
from vehicle.signals.records.frf_file import FrfData, read_frf
from vehicle.signals.records.measured import estimated_frf
from vehicle.signals.records.reader import read_columns
from vehicle.signals.records.run_summary import run_summary
from vehicle.signals.records.table import Record

Responses = Callable[[Sequence[str], float | None], FrfData | None]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Simulated:
    """A run.

    Attributes:
        name: of its input.
        record: all its time histories; the first sample is at time 0.
        responses: names of accelerations, and the length of Hann windows [s] or None, to the responses to the plate;
            None where there are none.
        tyres: what the tyres of its car do; empty where no summary says it.
    """

    name: str
    record: Record
    responses: Responses
    tyres: str = ""


def of_run(run: Run) -> Simulated:
    """A finished run."""

    def responses(names: Sequence[str], window: float | None) -> FrfData:
        found = run.frf(names, window=window)
        return FrfData(
            frequency=found.frequency,
            channels=tuple(names),
            response=found.response,
            coherence=found.coherence,
            random_error=found.random_error,
        )

    record = Record(time=run.time, channels=run.recording.channels, units=run.recording.units)
    return Simulated(name=run.signal.source, record=record, responses=responses, tyres=run.car.vehicle.driving.words)


def of_folder(folder: Path) -> Simulated:
    """The files of a run.

    Raises:
        ConfigurationError: the folder holds no time histories.
        DataError: a file of it is damaged.
    """
    file = next((folder / name for name in ("time.npz", "time.csv") if (folder / name).is_file()), None)
    if file is None:
        raise ConfigurationError(f"{folder}: holds no time.npz or time.csv; give the folder of a run, or an input")
    record = read_columns(file)

    def responses(names: Sequence[str], window: float | None) -> FrfData | None:
        if window is not None:
            found = estimated_frf(record, window)
            return None if found is None else found[0]
        return read_frf(folder / "frf.csv") if (folder / "frf.csv").is_file() else None

    tyres = str(run_summary(folder).get("tyre", ""))
    return Simulated(name=folder.name, record=record, responses=responses, tyres=tyres)
