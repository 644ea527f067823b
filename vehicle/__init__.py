"""A complete car on a shaker or a road, on MuJoCo.

    from vehicle import Car, Road

    car = Car.load("focus", {"damper.coulomb_friction": 93.75})
    run = car.run("low.csv")

Names are imported at their first use; `help(vehicle.run_sweep)` prints the documentation of a name. No function has the
name of a module of `python -m vehicle.NAME`: the import of the module would replace the function.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from vehicle.errors import ConfigurationError as ConfigurationError
    from vehicle.errors import DataError as DataError
    from vehicle.errors import MissingPartError as MissingPartError
    from vehicle.errors import OutputError as OutputError
    from vehicle.errors import SimulationError as SimulationError
    from vehicle.errors import VehicleError as VehicleError
    from vehicle.model.parameters.shipped import shipped_cars as shipped_cars
    from vehicle.runs.car.car import Car as Car
    from vehicle.runs.car.car_data import CarData as CarData
    from vehicle.runs.car.road import Road as Road
    from vehicle.runs.car.run import Run as Run
    from vehicle.runs.comparison.compared_run import compare_run as compare_run
    from vehicle.runs.comparison.comparison import Comparison as Comparison
    from vehicle.runs.comparison.mode_comparison import compare_modes as compare_modes
    from vehicle.runs.fmu.fmu_file import write_fmu as write_fmu
    from vehicle.runs.output.comparison_files import save_comparison as save_comparison
    from vehicle.runs.output.saved_run import save_run as save_run
    from vehicle.runs.report.report_file import write_report as write_report
    from vehicle.signals.excitation.input_files import shipped_inputs as shipped_inputs
    from vehicle.signals.excitation.signal import Signal as Signal
    from vehicle.signals.excitation.signal_file import read_signal as read_signal
    from vehicle.signals.excitation.signal_file import write_signal as write_signal
    from vehicle.signals.records.choice import Choice as Choice
    from vehicle.signals.records.measured import read_measured as read_measured
    from vehicle.signals.records.reader import read_record as read_record
    from vehicle.signals.records.record_comfort import RecordComfort as RecordComfort
    from vehicle.signals.records.record_comfort import evaluate_comfort as evaluate_comfort
    from vehicle.studies.optimisation.car_search import optimise_car as optimise_car
    from vehicle.studies.optimisation.search_result import FoundCars as FoundCars
    from vehicle.studies.replication.drive_files import save_drive as save_drive
    from vehicle.studies.replication.drive_search import FoundDrive as FoundDrive
    from vehicle.studies.replication.drive_search import replicate_drive as replicate_drive
    from vehicle.studies.sweeps.measure import ComfortMeasure as ComfortMeasure
    from vehicle.studies.sweeps.plan import run_sweep as run_sweep
    from vehicle.studies.sweeps.sweep_table import SweepTable as SweepTable
    from vehicle.studies.tuning.car_fit import tune_car as tune_car
    from vehicle.studies.tuning.fit_result import TuningResult as TuningResult
    from vehicle.studies.tuning.measured_targets import measured_histories as measured_histories
    from vehicle.studies.tuning.measured_targets import measured_responses as measured_responses

_MODULES = {
    "Car": "vehicle.runs.car.car",
    "CarData": "vehicle.runs.car.car_data",
    "Choice": "vehicle.signals.records.choice",
    "ComfortMeasure": "vehicle.studies.sweeps.measure",
    "Comparison": "vehicle.runs.comparison.comparison",
    "ConfigurationError": "vehicle.errors",
    "DataError": "vehicle.errors",
    "FoundCars": "vehicle.studies.optimisation.search_result",
    "FoundDrive": "vehicle.studies.replication.drive_search",
    "MissingPartError": "vehicle.errors",
    "OutputError": "vehicle.errors",
    "RecordComfort": "vehicle.signals.records.record_comfort",
    "Road": "vehicle.runs.car.road",
    "Run": "vehicle.runs.car.run",
    "Signal": "vehicle.signals.excitation.signal",
    "SimulationError": "vehicle.errors",
    "SweepTable": "vehicle.studies.sweeps.sweep_table",
    "TuningResult": "vehicle.studies.tuning.fit_result",
    "VehicleError": "vehicle.errors",
    "compare_modes": "vehicle.runs.comparison.mode_comparison",
    "compare_run": "vehicle.runs.comparison.compared_run",
    "evaluate_comfort": "vehicle.signals.records.record_comfort",
    "measured_histories": "vehicle.studies.tuning.measured_targets",
    "measured_responses": "vehicle.studies.tuning.measured_targets",
    "optimise_car": "vehicle.studies.optimisation.car_search",
    "read_measured": "vehicle.signals.records.measured",
    "read_record": "vehicle.signals.records.reader",
    "read_signal": "vehicle.signals.excitation.signal_file",
    "replicate_drive": "vehicle.studies.replication.drive_search",
    "run_sweep": "vehicle.studies.sweeps.plan",
    "save_comparison": "vehicle.runs.output.comparison_files",
    "save_drive": "vehicle.studies.replication.drive_files",
    "save_run": "vehicle.runs.output.saved_run",
    "shipped_cars": "vehicle.model.parameters.shipped",
    "shipped_inputs": "vehicle.signals.excitation.input_files",
    "tune_car": "vehicle.studies.tuning.car_fit",
    "write_fmu": "vehicle.runs.fmu.fmu_file",
    "write_report": "vehicle.runs.report.report_file",
    "write_signal": "vehicle.signals.excitation.signal_file",
}
"""Public name to the module that defines it; the block for type checkers above lists the same."""

__all__ = list(_MODULES)


def __getattr__(name: str) -> Any:
    """Return a public name, imported at its first use."""
    if name not in _MODULES:
        raise AttributeError(f"module 'vehicle' has no attribute {name!r}; public names are {', '.join(_MODULES)}")
    value = getattr(import_module(_MODULES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the public names."""
    return sorted(__all__)
