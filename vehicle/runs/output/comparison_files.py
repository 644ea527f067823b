"""Files of a measurement beside a run: tables, and a picture for each place."""

from __future__ import annotations

from pathlib import Path

from vehicle.runs.car import Run
from vehicle.runs.comparison.compared_run import comparison_of
from vehicle.runs.comparison.comparison import Comparison
from vehicle.runs.comparison.named_pictures import drawings_of
from vehicle.runs.comparison.simulated import of_run
from vehicle.runs.output.folder import output_folder, write_json, write_text, write_whole
from vehicle.signals.records.measured import Measured
from vehicle.signals.records.run_summary import MeasuredSummary


def save_comparison(
    comparison: Comparison, folder: Path | str, *, force: bool = False, protect: tuple[Path, ...] = ()
) -> Path:
    """Write the tables of a comparison and a picture for each output point into a folder of their own.

    Args:
        comparison: result of `compare_run`.
        folder: name of the folder.
        force: replace what was written there before.
        protect: input files; a folder that holds one of them is never replaced.

    Returns:
        The folder.

    Raises:
        ConfigurationError: the folder exists without `force`, or holds other files.
        OutputError: a file cannot be written.
    """
    with output_folder(Path(folder), force=force, protect=protect) as work:
        write_comparison(work, comparison)
    return Path(folder)


def write_comparison(folder: Path, comparison: Comparison) -> dict[str, str]:
    """Write the tables and a picture for each place.

    Args:
        folder: where to.
        comparison: what to write.

    Returns:
        Kind of file to its name.
    """
    write_text(folder / "compare.csv", comparison.csv())
    write_json(folder / "compare.json", comparison.summary())
    files = {"compare": "compare.json", "compare_table": "compare.csv"}
    for name, draw in drawings_of(comparison).items():
        write_whole(folder / f"{name}.png", draw)
        files[name] = f"{name}.png"
    return files


def write_beside(folder: Path, measured: Measured, run: Run, files: dict[str, str]) -> MeasuredSummary:
    """Put a measurement beside a run, in the folder of the run.

    Args:
        folder: of the run.
        measured: the measurement.
        run: the run.
        files: kind of file to its name; what is written is added.

    Returns:
        What the summary says of it.
    """
    comparison = comparison_of(measured, of_run(run), command="python -m vehicle compare, after the run")
    files |= write_comparison(folder, comparison)
    told = comparison.summary()
    return {"file": comparison.measured, "table": told["table"], "notices": told["notices"]}
