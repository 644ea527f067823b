"""Folder of a run, with the same files as the command `shaker`: written from a run, and read as a run."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from vehicle.engines.simulation.recording import Energies, Recording, Statistics
from vehicle.errors import ConfigurationError, DataError
from vehicle.leftovers import mention
from vehicle.names import in_order
from vehicle.runs.car import Car, Run
from vehicle.runs.car.run_twin import repeats_after
from vehicle.runs.output.folder import output_folder
from vehicle.runs.output.run_files import write_run
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.formats.reader import read_columns
from vehicle.signals.records.run_summary import SUMMARY_FILE, RunSummary, read_summary


def save_run(
    run: Run,
    folder: Path | str,
    *,
    force: bool = False,
    time_format: str = "npz",
    formats: Sequence[str] = (),
    figures: bool = True,
) -> Path:
    """Write the files of a run: summary, parameters as used, time histories, FRFs, pictures.

    Args:
        run: the run, with all default channels.
        folder: name of the folder.
        force: replace a run that was written there before.
        time_format: format of the time histories, "npz" or "csv".
        formats: further formats: "csv", "npz", "mat", "uff", "rpc", "h5".
        figures: False writes no pictures.

    Returns:
        The folder; `write_report` and `compare` take it.

    Raises:
        ConfigurationError: the folder exists without `force`, or holds files that no run wrote; or the run has not all
            default channels.
        DataError: the record is too short for an FRF, or a plate repeats the motion of another with a delay.
        OutputError: a file cannot be written.
    """
    missing = [name for name in run.car.vehicle.channels if name not in run.recording.channels]
    if missing:
        raise ConfigurationError(
            f"{folder}: channel {missing[0]} was not recorded, but the files of the run need it; run again "
            "with all channels (leave out channels=[...])"
        )
    with output_folder(Path(folder), force=force) as work:
        write_run(work, run, time_format=time_format, formats=formats, figures=figures)
    return Path(folder)


def load_run(folder: Path | str) -> Run:
    """Read the folder of a run, written by `save_run` or by the command `shaker`, as a run.

    The car is that of `vehicle.toml` in the folder, with all values as used; the signal is the recorded displacement of
    the plates, at the rate of the recording. Channels, FRFs, comfort and slip are those of the run that was saved.
    Poses for a film and the road profile of the displacements are not saved.

    Args:
        folder: the folder.

    Returns:
        The run.

    Raises:
        ConfigurationError: the folder is not of a run, or its car is wrong.
        DataError: a file of it is missing or damaged.
    """
    folder = Path(folder)
    mention(folder)
    summary = read_summary(folder)
    car, recording = Car.load(file_of_run(folder, summary, "vehicle")), read_recording(folder, summary)
    return Run(
        car=car,
        signal=recorded_signal(summary, recording),
        recording=recording,
        engine_reason=summary.solver.engine_reason,
        skip=summary.evaluated_from,
        road=summary.input.road,
    )


def recorded_signal(summary: RunSummary, recording: Recording) -> Signal:
    """Return the recorded displacements of the plates of a run; zeros under its wheel if no plate moves.

    Raises:
        ConfigurationError: the run records no displacement of a moving plate.
    """
    excitation = summary.input
    moving = recording.excited or (excitation.wheel,)
    return Signal(
        time=recording.time,
        displacement={wheel: recording[f"plate_{wheel}_displacement"] for wheel in moving},
        source=excitation.file,
        sha256=excitation.sha256,
        highest=excitation.highest_hz,
        repeats_after=repeats_after(excitation.road),
    )


def file_of_run(folder: Path, summary: RunSummary, purpose: str) -> Path:
    """Return the path of a file in the folder of a run.

    Args:
        purpose: key of the file in the summary, as "vehicle".

    Raises:
        DataError: the summary does not name the file, or it is missing.
    """
    if purpose not in summary.files:
        raise DataError(f"{folder / SUMMARY_FILE}: is damaged (files.{purpose} is missing); run the simulation again")
    path = folder / summary.files[purpose]
    if not path.is_file():
        raise DataError(f"{path}: is missing, although summary.json lists it as {purpose}; run the simulation again")
    return path


def read_recording(folder: Path, summary: RunSummary) -> Recording:
    """Read the time histories in the folder of a run; without poses.

    Raises:
        DataError: the file is missing or damaged.
    """
    record, solver = read_columns(file_of_run(folder, summary, "time")), summary.solver
    work, lost, stored = solver.work_in_j, solver.dissipated_j, solver.stored_j
    return Recording(
        time=record.time,
        channels=record.channels,
        units=record.units,
        excited=in_order(wheel for wheel, rms in summary.input.plate_rms_m.items() if rms > 0.0),
        pose_time=np.empty(0),
        poses=np.empty((0, 0)),
        statistics=Statistics(
            engine=solver.engine,
            callback=solver.callback,
            timestep=solver.timestep_s,
            steps=solver.steps,
            wall_time=solver.wall_s,
            warnings=tuple(solver.warnings),
            energies=None
            if work is None or lost is None or stored is None
            else Energies(work_in=work, dissipated=lost, stored=stored),
            notices=tuple(summary.notices),
        ),
    )
