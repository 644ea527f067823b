"""A run of a script as a folder, as the command `shaker` writes it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from vehicle.car import Run
from vehicle.output.folder import output_folder
from vehicle.output.run_files import write_run


def save_run(
    run: Run, folder: Path | str, *, force: bool = False, time_format: str = "npz", formats: Sequence[str] = ()
) -> Path:
    """Write the files of a run: summary, parameters as used, time histories, FRFs, pictures.

    Args:
        run: the run, with all default channels.
        folder: name of the folder.
        force: replace a run that was written there before.
        time_format: format of the time histories, "npz" or "csv".
        formats: further formats: "csv", "npz", "mat", "uff", "rpc", "h5".

    Returns:
        The folder; `write_report` and `compare_run` take it.

    Raises:
        ConfigurationError: the folder exists without `force`, or holds files that no run wrote.
        DataError: the record is too short for an FRF, or a plate moves as another one with a delay.
        OutputError: a file cannot be written.
    """
    with output_folder(Path(folder), force=force) as work:
        write_run(work, run, time_format=time_format, formats=formats)
    return Path(folder)
