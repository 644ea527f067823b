"""Folder of a run, with the same files as the command `shaker`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.runs.car import Run
from vehicle.runs.output.folder import output_folder
from vehicle.runs.output.run_files import write_run


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
            f"{folder}: the run has no channel {missing[0]}, which its files need; run the car without channels=[...]"
        )
    with output_folder(Path(folder), force=force) as work:
        write_run(work, run, time_format=time_format, formats=formats, figures=figures)
    return Path(folder)
