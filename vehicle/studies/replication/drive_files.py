"""Files of a replicated drive: plate signals, target and response, iterations, pictures, parameters, summary."""

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.drawing.rendering.drive_plot import plot_convergence, plot_replication
from vehicle.runs.output.folder import Content, output_folder, write_files, write_json
from vehicle.runs.output.own_files import parameters_text, write_own_files
from vehicle.signals.excitation.signal_file import write_signal
from vehicle.signals.formats.csv_table import table_text
from vehicle.signals.formats.formats import write_record
from vehicle.signals.formats.table import Record
from vehicle.studies.replication.drive_search import FoundDrive
from vehicle.studies.replication.iteration import Replication

FILES = {
    "drive": "drive.csv",
    "response": "response.csv",
    "iterations": "iterations.csv",
    "response_plot": "response.png",
    "convergence_plot": "convergence.png",
    "vehicle": "vehicle.toml",
    "summary": "summary.json",
}


def save_drive(
    drive: FoundDrive, folder: Path | str, *, force: bool = False, figures: bool = True, protect: tuple[Path, ...] = ()
) -> dict[str, Any]:
    """Write the files of a drive: plate signals, response, iterations, pictures, parameters, summary.

    Args:
        drive: result of `replicate_drive`.
        folder: name of the folder.
        force: replace what was written there before.
        figures: False writes no pictures.
        protect: input files; a folder that holds one of them is never replaced.

    Returns:
        The content of `summary.json`.

    Raises:
        ConfigurationError: the folder exists without `force`, or holds other files.
        OutputError: a file cannot be written.
    """
    with output_folder(Path(folder), force=force, protect=protect) as work:
        return write_drive(work, drive, figures=figures)


def write_drive(folder: Path, drive: FoundDrive, *, figures: bool = True) -> dict[str, Any]:
    """Write all files of a drive to a folder of `output_folder`; result as in `save_drive`."""
    replication, plant, run = drive.replication, drive.plant, drive.run
    target = plant.target
    signal, low, high = plant.signal(replication.drive), *target.band
    errors = dict(
        zip(target.channels, min(replication.steps, key=lambda step: step.error).errors.tolist(), strict=True)
    )
    description = (
        f"{target.source.name}, {low:g} to {high:g} Hz; tyres {run.car.vehicle.driving.words}; "
        f"{run.recording.statistics.engine} engine; error "
        f"{100.0 * replication.error:.3g} % after {replication.steps[-1].number} runs"
    )
    header = [f"plate displacement replicated from {target.source.name}", f"{low:g} to {high:g} Hz"]
    channels: dict[str, np.ndarray] = {}
    for name, wanted, response in zip(target.channels, target.values, replication.response, strict=True):
        channels |= {f"target_{name}": wanted, name: response}
    record = Record(time=target.time, channels=channels, units=dict.fromkeys(channels, "m/s2"))
    contents: dict[str, Content] = {
        "drive": partial(write_signal, signal=signal, comments=header),
        "response": partial(write_record, name="csv", record=record, frame=description),
        "iterations": _table(replication, target.channels, description),
        "response_plot": partial(
            plot_replication,
            time=target.time,
            responses={name: (channels[f"target_{name}"], channels[name]) for name in target.channels},
            drive=dict(zip(plant.wheels, replication.drive, strict=True)),
            band=target.band,
            caption=description,
        ),
        "convergence_plot": partial(
            plot_convergence,
            errors=dict(zip(target.channels, np.array([step.errors for step in replication.steps]).T, strict=True)),
            kept=np.array([step.kept for step in replication.steps]),
            caption=f"{description}; {replication.outcome}",
        ),
        "vehicle": parameters_text(plant.car, "parameters of this drive, as used"),
    }
    files = {name: file for name, file in FILES.items() if figures or not file.endswith(".png")}
    write_files(folder, {files[name]: content for name, content in contents.items() if name in files})
    summary = {
        "target": {
            "file": target.source.name,
            "sha256": target.sha256,
            "channels": list(target.channels),
            "duration_s": float(target.time[-1]),
            "band_hz": list(target.band),
        },
        "drive": {
            "wheels": list(plant.wheels),
            "rms_m": {wheel: signal.rms(wheel) for wheel in plant.wheels},
            "largest_m": {wheel: float(np.max(np.abs(signal.displacement[wheel]))) for wheel in plant.wheels},
        },
        "error": replication.error,
        "errors": errors,
        "reached": replication.reached,
        "outcome": replication.outcome,
        "engine": run.recording.statistics.engine,
        "engine_reason": run.engine_reason,
        "equivalent_damping": {
            damper.name: float(value) for damper, value in zip(plant.dampers, plant.damping, strict=True)
        },
        "iterations": [
            {"number": step.number, "gain": step.gain, "error": step.error, "kept": step.kept}
            for step in replication.steps
        ],
        "delays": [each.summary() for each in drive.delays],
        "notices": [*drive.notices, *plant.ramp, *run.recording.statistics.warnings],
        "files": files | write_own_files(folder, plant.car),
    }
    write_json(folder / FILES["summary"], summary)
    return summary


def _table(replication: Replication, channels: tuple[str, ...], description: str) -> str:
    """Return the table of the iterations as CSV."""
    heads = ["iteration", "gain", "kept", "error", *(f"error_{name}" for name in channels)]
    rows = [(step.number, f"{step.gain:g}", int(step.kept), step.error, *step.errors) for step in replication.steps]
    error = "error: RMS of target minus response, divided by RMS of target, in the band [-]"
    return table_text([heads, *rows], [description, error], digits=9)
