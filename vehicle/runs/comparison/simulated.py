"""Time histories and frequency responses of a run for a comparison, from a `Run` or the folder of a run."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.runs.car import Run
from vehicle.signals.formats.frf_file import FrfData, frf_data
from vehicle.signals.formats.reader import read_columns
from vehicle.signals.formats.table import Record
from vehicle.signals.records.measured import estimated_frf
from vehicle.signals.records.run_frf import run_frf
from vehicle.signals.records.run_summary import available_summary
from vehicle.signals.records.settling import settling_time

Responses = Callable[[Sequence[str], float | None], FrfData | None]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Simulated:
    """Simulated data of a comparison."""

    name: str  # name of the input
    record: Record  # all time histories; the first sample is at time 0
    # function of names of accelerations and of the length of Hann windows [s] or None; returns the responses to each
    # independent motion of the plates, or None
    responses: Responses
    tyres: str = ""  # state of the tyres, "standing" or "rolling at ..."; empty if unknown
    settled: float = 0.0  # time after which the run, which begins at rest, follows a measurement in motion [s]


def of_run(run: Run) -> Simulated:
    """Return the simulated data of a run."""

    def responses(names: Sequence[str], window: float | None) -> FrfData:
        return frf_data(run.frfs(names, window=window), names)

    record = Record(time=run.time, channels=run.recording.channels, units=run.recording.units)
    return Simulated(
        name=run.signal.source,
        record=record,
        responses=responses,
        tyres=run.car.vehicle.driving.words,
        settled=run.skip or settling_time(run.signal.notices),
    )


def of_folder(folder: Path) -> Simulated:
    """Read the simulated data of the folder of a run.

    Raises:
        ConfigurationError: the folder has no time histories.
        DataError: a file of it is damaged.
    """
    file = next((folder / name for name in ("time.npz", "time.csv") if (folder / name).is_file()), None)
    if file is None:
        raise ConfigurationError(f"{folder}: contains no time.npz or time.csv; give the folder of a run, or an input")
    record = read_columns(file)
    summary = available_summary(folder)

    def responses(names: Sequence[str], window: float | None) -> FrfData | None:
        if window is not None:
            estimate = estimated_frf(record, window)
            return None if estimate is None else estimate[0]
        return run_frf(folder / "frf.csv", summary) if (folder / "frf.csv").is_file() else None

    tyres, settled = "", 0.0
    if summary is not None:
        tyres, settled = summary.tyre, summary.evaluated_from or settling_time(summary.notices)
    return Simulated(name=folder.name, record=record, responses=responses, tyres=tyres, settled=settled)
