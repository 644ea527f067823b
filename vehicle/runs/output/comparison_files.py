"""Files of a comparison: tables, and a picture for each output point."""

from pathlib import Path

from vehicle.runs.car import Run
from vehicle.runs.comparison.compared_run import comparison_of
from vehicle.runs.comparison.comparison import Comparison
from vehicle.runs.comparison.named_pictures import pictures_of
from vehicle.runs.comparison.simulated import of_run
from vehicle.runs.output.folder import output_folder, write_json, write_text, write_whole
from vehicle.signals.records.measured import Measured
from vehicle.signals.records.run_summary import MeasuredSummary


def save_comparison(
    comparison: Comparison,
    folder: Path | str,
    *,
    force: bool = False,
    figures: bool = True,
    protect: tuple[Path, ...] = (),
) -> Path:
    """Write the tables of a comparison and a picture for each output point into a new folder.

    Args:
        comparison: result of `compare`.
        folder: name of the folder.
        force: replace files of an earlier run.
        figures: False writes no pictures.
        protect: input files; a folder that holds one of them is never replaced.

    Returns:
        The folder.

    Raises:
        ConfigurationError: the folder exists without `force`, or holds other files.
        OutputError: a file cannot be written.
    """
    with output_folder(Path(folder), force=force, protect=protect) as work:
        write_comparison(work, comparison, figures=figures)
    return Path(folder)


def write_comparison(folder: Path, comparison: Comparison, *, figures: bool = True) -> dict[str, str]:
    """Write the tables and a picture for each output point.

    Args:
        figures: False writes no pictures.

    Returns:
        Name of each file by its purpose.
    """
    write_text(folder / "compare.csv", comparison.csv())
    write_json(folder / "compare.json", comparison.summary())
    files = {"compare": "compare.json", "compare_table": "compare.csv"}
    for name, picture in pictures_of(comparison).items() if figures else ():
        write_whole(folder / f"{name}.png", picture.write)
        files[name] = f"{name}.png"
    return files


def write_beside(
    folder: Path, measured: Measured, run: Run, files: dict[str, str], *, figures: bool = True
) -> MeasuredSummary:
    """Compare a measurement with a run, and write the files into the folder of the run.

    Args:
        files: name of each file by its purpose; the new files are added.
        figures: False writes no pictures.
    """
    comparison = comparison_of(measured, of_run(run), command="python -m vehicle compare, after the run")
    files |= write_comparison(folder, comparison, figures=figures)
    content = comparison.summary()
    return MeasuredSummary(file=comparison.measured, table=content["table"], notices=content["notices"])
