"""A complete car on a shaker or a road, on MuJoCo.

>>> from vehicle import Car, compare, read, road, sweep, tune
>>> car = Car.load("focus_road", {"body.mass": 1300})
>>> car
Car(focus_road, wheels fr, fl, rr, rl, body.mass=1300)
>>> parameter = car["front.damper.viscous"]
>>> parameter.value, parameter.unit
(2250.0, 'N s/m')
>>> [found.path for found in car.search("front damper coulomb")]
['front.damper.coulomb_friction']
>>> softer = car.with_({"front.damper.viscous": 1800})
>>> run = car.run("low.csv", engine="reduced")
>>> run.frf("seat rail z").names
('seat_rail_acc_z',)
>>> axes = run.frf("seat rail z").plot()
>>> axes = softer.run("low.csv", engine="reduced").frf("seat rail z").plot(ax=axes)
>>> run.comfort()
seat rail: unweighted ... m/s2 (2 to 50 Hz), weighted ... m/s2 (ISO 2631-1)
>>> run.psd("seat rail z").plot().shape
(3,)
>>> run.save("low").name, run.report("low.html").name
('low', 'low.html')
>>> read("low")["seat_rail_acc_z"].unit
'm/s2'
>>> compare(softer.run("low.csv", engine="reduced"), "low/frf.csv").plot("compare_frf_seat_rail").shape
(3, 3)
>>> drive = car.run(road("C", 80, duration=4), engine="reduced")
>>> drive
Run(road_C_80, 4 s, reduced, Car(focus_road, ...))
>>> table = sweep(car, {"front.damper.viscous": [1800, 2250]}, road("C", 80, duration=4), engine="reduced")
>>> table.to_dataframe()["weighted [m/s2]"].shape
(2,)
>>> bool(abs(table.column("weighted")[1] / drive.comfort().weighted.overall - 1) < 5e-4)  # a sweep has steps of 0.5 ms
True

Names are imported at their first use; `help(vehicle.sweep)` prints the documentation of a name.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, Any

from vehicle.handed_down import HANDED

if TYPE_CHECKING:
    from vehicle.errors import ConfigurationError as ConfigurationError
    from vehicle.errors import DataError as DataError
    from vehicle.errors import MissingPartError as MissingPartError
    from vehicle.errors import OutputError as OutputError
    from vehicle.errors import SimulationError as SimulationError
    from vehicle.errors import VehicleError as VehicleError
    from vehicle.handover.fmu.fmu_file import write_fmu as write_fmu
    from vehicle.handover.page.report_file import write_report as write_report
    from vehicle.handover.page.shaken_run import shake as shake
    from vehicle.model.laws.friction_by_address import register_friction as register_friction
    from vehicle.model.laws.law_by_address import register_law as register_law
    from vehicle.model.parameters.shipped import shipped_cars as shipped_cars
    from vehicle.runs.car.car import Car as Car
    from vehicle.runs.car.car_data import CarData as CarData
    from vehicle.runs.car.order_points import OrderPoints as OrderPoints
    from vehicle.runs.car.order_points import order_points as order_points
    from vehicle.runs.car.profile_value import over_profile as over_profile
    from vehicle.runs.car.road import Road as Road
    from vehicle.runs.car.road import road as road
    from vehicle.runs.car.run import Run as Run
    from vehicle.runs.comparison.compared_run import compare as compare
    from vehicle.runs.comparison.comparison import Comparison as Comparison
    from vehicle.runs.comparison.diagnosis import diagnose as diagnose
    from vehicle.runs.comparison.mode_comparison import compare_modes as compare_modes
    from vehicle.runs.output.comparison_files import save_comparison as save_comparison
    from vehicle.runs.output.own_files import save_car as save_car
    from vehicle.runs.output.saved_run import load_run as load_run
    from vehicle.runs.output.saved_run import save_run as save_run
    from vehicle.signals.excitation.input_files import shipped_inputs as shipped_inputs
    from vehicle.signals.excitation.signal import Signal as Signal
    from vehicle.signals.excitation.signal_file import read_signal as read_signal
    from vehicle.signals.excitation.signal_file import write_signal as write_signal
    from vehicle.signals.formats.reader import read as read
    from vehicle.signals.records.choice import Choice as Choice
    from vehicle.signals.records.measured import read_measured as read_measured
    from vehicle.signals.records.record_comfort import RecordComfort as RecordComfort
    from vehicle.signals.records.record_comfort import evaluate_comfort as evaluate_comfort
    from vehicle.studies.dampers.fitted_damper import FittedDamper as FittedDamper
    from vehicle.studies.dampers.fitted_damper import fit_damper as fit_damper
    from vehicle.studies.diagnosis.car_diagnosis import CarDiagnosis as CarDiagnosis
    from vehicle.studies.mounts.mount_fit import MountFit as MountFit
    from vehicle.studies.mounts.mount_fit import fit_mount as fit_mount
    from vehicle.studies.optimisation.car_search import optimise as optimise
    from vehicle.studies.optimisation.search_result import FoundCars as FoundCars
    from vehicle.studies.replication.drive_files import save_drive as save_drive
    from vehicle.studies.replication.drive_search import FoundDrive as FoundDrive
    from vehicle.studies.replication.drive_search import replicate_drive as replicate_drive
    from vehicle.studies.sweeps.effects import Effects as Effects
    from vehicle.studies.sweeps.indices import SobolIndices as SobolIndices
    from vehicle.studies.sweeps.measure import ComfortMeasure as ComfortMeasure
    from vehicle.studies.sweeps.parameter_effects import parameter_effects as parameter_effects
    from vehicle.studies.sweeps.plan import sweep as sweep
    from vehicle.studies.sweeps.sobol_sweep import sobol as sobol
    from vehicle.studies.sweeps.sweep_table import SweepTable as SweepTable
    from vehicle.studies.tuning.car_fit import tune as tune
    from vehicle.studies.tuning.fit_result import TuningResult as TuningResult
    from vehicle.studies.tuning.measured_targets import measured_histories as measured_histories
    from vehicle.studies.tuning.measured_targets import measured_responses as measured_responses

_MODULES = {
    "Car": "vehicle.runs.car.car",
    "CarData": "vehicle.runs.car.car_data",
    "CarDiagnosis": "vehicle.studies.diagnosis.car_diagnosis",
    "Choice": "vehicle.signals.records.choice",
    "ComfortMeasure": "vehicle.studies.sweeps.measure",
    "Comparison": "vehicle.runs.comparison.comparison",
    "ConfigurationError": "vehicle.errors",
    "DataError": "vehicle.errors",
    "Effects": "vehicle.studies.sweeps.effects",
    "FittedDamper": "vehicle.studies.dampers.fitted_damper",
    "FoundCars": "vehicle.studies.optimisation.search_result",
    "FoundDrive": "vehicle.studies.replication.drive_search",
    "MissingPartError": "vehicle.errors",
    "MountFit": "vehicle.studies.mounts.mount_fit",
    "OrderPoints": "vehicle.runs.car.order_points",
    "OutputError": "vehicle.errors",
    "RecordComfort": "vehicle.signals.records.record_comfort",
    "Road": "vehicle.runs.car.road",
    "Run": "vehicle.runs.car.run",
    "Signal": "vehicle.signals.excitation.signal",
    "SimulationError": "vehicle.errors",
    "SobolIndices": "vehicle.studies.sweeps.indices",
    "SweepTable": "vehicle.studies.sweeps.sweep_table",
    "TuningResult": "vehicle.studies.tuning.fit_result",
    "VehicleError": "vehicle.errors",
    "compare": "vehicle.runs.comparison.compared_run",
    "compare_modes": "vehicle.runs.comparison.mode_comparison",
    "diagnose": "vehicle.runs.comparison.diagnosis",
    "evaluate_comfort": "vehicle.signals.records.record_comfort",
    "fit_damper": "vehicle.studies.dampers.fitted_damper",
    "fit_mount": "vehicle.studies.mounts.mount_fit",
    "load_run": "vehicle.runs.output.saved_run",
    "measured_histories": "vehicle.studies.tuning.measured_targets",
    "measured_responses": "vehicle.studies.tuning.measured_targets",
    "optimise": "vehicle.studies.optimisation.car_search",
    "order_points": "vehicle.runs.car.order_points",
    "over_profile": "vehicle.runs.car.profile_value",
    "parameter_effects": "vehicle.studies.sweeps.parameter_effects",
    "read": "vehicle.signals.formats.reader",
    "read_measured": "vehicle.signals.records.measured",
    "read_signal": "vehicle.signals.excitation.signal_file",
    "register_friction": "vehicle.model.laws.friction_by_address",
    "register_law": "vehicle.model.laws.law_by_address",
    "replicate_drive": "vehicle.studies.replication.drive_search",
    "road": "vehicle.runs.car.road",
    "save_car": "vehicle.runs.output.own_files",
    "save_comparison": "vehicle.runs.output.comparison_files",
    "save_drive": "vehicle.studies.replication.drive_files",
    "save_run": "vehicle.runs.output.saved_run",
    "shake": "vehicle.handover.page.shaken_run",
    "shipped_cars": "vehicle.model.parameters.shipped",
    "shipped_inputs": "vehicle.signals.excitation.input_files",
    "sobol": "vehicle.studies.sweeps.sobol_sweep",
    "sweep": "vehicle.studies.sweeps.plan",
    "tune": "vehicle.studies.tuning.car_fit",
    "write_fmu": "vehicle.handover.fmu.fmu_file",
    "write_report": "vehicle.handover.page.report_file",
    "write_signal": "vehicle.signals.excitation.signal_file",
}
"""Public name to the module that defines it; the block for type checkers above lists the same."""

__all__ = list(_MODULES)


def __getattr__(name: str) -> Any:
    """Return a public name, imported at its first use."""
    if name not in _MODULES:
        near = import_module("vehicle.wording").choose_from(name, _MODULES)
        raise AttributeError(f"module 'vehicle' has no attribute {name!r}{near}")
    value = getattr(import_module(_MODULES[name]), name)
    globals()[name] = value
    return value


def _handed(name: str) -> Callable[..., Any]:
    """Return a public function that is imported at its first call."""
    return lambda *given, **options: __getattr__(name)(*given, **options)


HANDED |= {name: _handed(name) for name in ("load_run", "save_car", "save_run", "write_report")}
HANDED["diagnose_car"] = lambda *given, **options: import_module("vehicle.studies.diagnosis.diagnosis").diagnose_car(
    *given, **options
)
HANDED["steady_run"] = lambda *given: import_module("vehicle.runs.car.steady_run").car_steady(*given)
HANDED["figure_of"] = lambda run, name: import_module("vehicle.runs.figures.value").figure_of(run, name)


def __dir__() -> list[str]:
    """Return the public names."""
    return sorted(__all__)
