"""A complete car on a shaker or a road, on MuJoCo.

    from vehicle import Car, Road

    car = Car.load("focus", {"damper.coulomb_friction": 93.75})
    run = car.run("low.csv")

Names are imported at their first use; `help(vehicle.run_sweep)` explains one. A function is never named as a module of
`python -m vehicle.NAME`, whose import would replace it.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from vehicle.car.car import Car as Car
    from vehicle.car.road import Road as Road
    from vehicle.car.run import Run as Run
    from vehicle.comparison.compared_run import compare_run as compare_run
    from vehicle.comparison.mode_comparison import compare_modes as compare_modes
    from vehicle.comparison.tables import Comparison as Comparison
    from vehicle.errors import ConfigurationError as ConfigurationError
    from vehicle.errors import DataError as DataError
    from vehicle.errors import MissingPartError as MissingPartError
    from vehicle.errors import OutputError as OutputError
    from vehicle.errors import SimulationError as SimulationError
    from vehicle.errors import VehicleError as VehicleError
    from vehicle.excitation.input_files import shipped_inputs as shipped_inputs
    from vehicle.excitation.signal import Signal as Signal
    from vehicle.excitation.signal_file import read_signal as read_signal
    from vehicle.excitation.signal_file import write_signal as write_signal
    from vehicle.optimisation.car_search import optimise_car as optimise_car
    from vehicle.optimisation.found_cars import FoundCars as FoundCars
    from vehicle.output.comparison_files import save_comparison as save_comparison
    from vehicle.output.drive_files import save_drive as save_drive
    from vehicle.output.saved_run import save_run as save_run
    from vehicle.parameters.shipped import shipped_cars as shipped_cars
    from vehicle.records.choice import Choice as Choice
    from vehicle.records.measured import read_measured as read_measured
    from vehicle.records.reader import read_record as read_record
    from vehicle.records.record_comfort import RecordComfort as RecordComfort
    from vehicle.records.record_comfort import evaluate_comfort as evaluate_comfort
    from vehicle.replication.found_drive import FoundDrive as FoundDrive
    from vehicle.replication.found_drive import replicate_drive as replicate_drive
    from vehicle.report.report_file import write_report as write_report
    from vehicle.sweeps.measure import ComfortMeasure as ComfortMeasure
    from vehicle.sweeps.plan import run_sweep as run_sweep
    from vehicle.sweeps.table import SweepTable as SweepTable
    from vehicle.tuning.car_fit import tune_car as tune_car
    from vehicle.tuning.measured_targets import measured_histories as measured_histories
    from vehicle.tuning.measured_targets import measured_responses as measured_responses
    from vehicle.tuning.result import TuningResult as TuningResult

_MODULES = {
    "Car": "vehicle.car.car",
    "Choice": "vehicle.records.choice",
    "ComfortMeasure": "vehicle.sweeps.measure",
    "Comparison": "vehicle.comparison.tables",
    "ConfigurationError": "vehicle.errors",
    "DataError": "vehicle.errors",
    "FoundCars": "vehicle.optimisation.found_cars",
    "FoundDrive": "vehicle.replication.found_drive",
    "MissingPartError": "vehicle.errors",
    "OutputError": "vehicle.errors",
    "RecordComfort": "vehicle.records.record_comfort",
    "Road": "vehicle.car.road",
    "Run": "vehicle.car.run",
    "Signal": "vehicle.excitation.signal",
    "SimulationError": "vehicle.errors",
    "SweepTable": "vehicle.sweeps.table",
    "TuningResult": "vehicle.tuning.result",
    "VehicleError": "vehicle.errors",
    "compare_modes": "vehicle.comparison.mode_comparison",
    "compare_run": "vehicle.comparison.compared_run",
    "evaluate_comfort": "vehicle.records.record_comfort",
    "measured_histories": "vehicle.tuning.measured_targets",
    "measured_responses": "vehicle.tuning.measured_targets",
    "optimise_car": "vehicle.optimisation.car_search",
    "read_measured": "vehicle.records.measured",
    "read_record": "vehicle.records.reader",
    "read_signal": "vehicle.excitation.signal_file",
    "replicate_drive": "vehicle.replication.found_drive",
    "run_sweep": "vehicle.sweeps.plan",
    "save_comparison": "vehicle.output.comparison_files",
    "save_drive": "vehicle.output.drive_files",
    "save_run": "vehicle.output.saved_run",
    "shipped_cars": "vehicle.parameters.shipped",
    "shipped_inputs": "vehicle.excitation.input_files",
    "tune_car": "vehicle.tuning.car_fit",
    "write_report": "vehicle.report.report_file",
    "write_signal": "vehicle.excitation.signal_file",
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
