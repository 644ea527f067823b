"""Files that the bench writes on a click: vehicle file, run and report of what is shown."""

from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from vehicle.handover.bench.drive import BenchDrive
from vehicle.handover.bench.state import BenchState
from vehicle.handover.page.report_file import write_report
from vehicle.runs.car import Car, Run
from vehicle.runs.output.folder import output_folder, write_text
from vehicle.runs.output.free_names import free_file, free_folder
from vehicle.runs.output.own_files import parameters_text, write_own_files
from vehicle.runs.output.saved_run import save_run


def write_car(state: BenchState, folder: Path) -> Path:
    """Write the vehicle file of B, with its templates and body model, into the first free folder `car`, `car-2` ...

    Returns:
        The vehicle file.

    Raises:
        VehicleError: the file cannot be written.
    """
    with ExitStack() as held:
        path = free_folder(held, folder / "car")
        with output_folder(path, force=False) as work:
            write_text(work / "vehicle.toml", parameters_text(state.present[0], f"made on the bench: {state.car!r}"))
            write_own_files(work, state.present[0])
    return path / "vehicle.toml"


def write_run(state: BenchState, folder: Path) -> Path:
    """Write the run of B with all channels into the first free folder `run`, `run-2` ...; see `write_car`."""
    with ExitStack() as held:
        path = free_folder(held, folder / "run")
        save_run(_run(state.present[0], state.drive), path)
    return path


def write_comparison(state: BenchState, folder: Path) -> Path:
    """Write the report of B, compared with A if A is another car; see `write_car`.

    Returns:
        The first free file of `report.html`, `report-2.html` ...
    """
    with ExitStack() as held, TemporaryDirectory() as work:
        path = free_file(held, folder / "report.html")
        cars = {"A": state.reference[0]}
        if state.reference[0].overrides != state.present[0].overrides:
            cars["B"] = state.present[0]
        runs = [save_run(_run(car, state.drive), Path(work) / name) for name, car in cars.items()]
        write_report(runs, path)
    return path


def _run(car: Car, drive: BenchDrive) -> Run:
    """Return the run of a car on the excerpt, with all default channels."""
    drive = drive.under(car)
    return replace(car.run(drive.record, engine="reduced", skip=drive.skip), road=drive.road)
