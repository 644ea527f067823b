"""Counts of work, without a clock: `python -m tests.benchmarks.counts [--write]`.

Each is equal on every machine: steps, states and table sizes of what users call, calls of MuJoCo and of matrix solvers
below them, samples of the second order, bytes written and modules imported. `counts.json` is the committed baseline; a
count that grows by more than `GROWTH` fails `tests/benchmarks/test_counts.py`, which names it. After a growth with a
reason, write the baseline anew.
"""

import argparse
import json
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from types import FrameType
from typing import Any
from unittest.mock import patch

import numpy as np

from tests.benchmarks.speed import on_four_plates, piece
from vehicle.commands.shaker import main as shaker
from vehicle.engines.reduced import batch_simulation
from vehicle.engines.reduced.group_run import GroupRun
from vehicle.engines.reduced.second_order import SecondOrder
from vehicle.engines.simulation.callbacks import standing_data
from vehicle.engines.simulation.rows import Rows
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal
from vehicle.studies.sweeps.case_evaluation import measured_batch
from vehicle.studies.sweeps.measure import comfort_measure

BASELINE = Path(__file__).with_name("counts.json")
"""Committed counts."""

GROWTH = 1.1
"""Maximum count over its baseline: a tenth of a piece is what a paired measurement of time can show, too."""

SOLVERS = {"eig", "eigh", "eigvals", "solve", "inv", "pinv", "svd", "lstsq"}
"""Functions of `numpy.linalg` that are counted."""

STARTS = {"import vehicle": "vehicle", "shaker": "vehicle.commands.shaker", "car": "vehicle.runs.car"}
"""Pieces to the modules that they import."""


def calls(function: Callable[[], object]) -> dict[str, int]:
    """Return the calls of MuJoCo, of matrix solvers and of Fourier transforms in a function."""
    found: Counter[str] = Counter()

    def count(frame: FrameType, event: str, argument: Any) -> None:
        if event == "c_call" and argument.__name__.startswith("mj_"):
            found["MuJoCo"] += 1
        elif event == "call":
            code = frame.f_code
            if code.co_name in SOLVERS and "linalg" in code.co_filename:
                found["solvers"] += 1
            elif code.co_name == "_raw_fft":
                found["transforms"] += 1

    sys.setprofile(count)
    try:
        function()
    finally:
        sys.setprofile(None)
    return {name: found[name] for name in ("MuJoCo", "solvers", "transforms")}


def run_counts(name: str, signal: Signal) -> dict[str, int]:
    """Return the counts of runs of a car: with MuJoCo, with the reduced engine for the first time and again."""
    car, found, samples = Car.load(name), dict[str, int](), list[int]()
    recording = car.run(signal).recording
    found |= {"MuJoCo, steps": recording.statistics.steps, "MuJoCo, calls": calls(lambda: car.run(signal))["MuJoCo"]}
    data = standing_data(Rows(car.model.model, car.model.static.preload))
    found |= {"rows": int(data.nefc), "degrees of freedom": int(car.model.model.nv)}
    # The second order belongs to the car: a further run finds it.
    found |= {f"first reduced run, {key}": value for key, value in calls(lambda: car.run(signal, "reduced")).items()}
    for stated in (True, False):
        head = f"reduced run {'with' if stated else 'without'} stated errors"
        run = calls(lambda stated=stated: car.run(signal, "reduced", stated_errors=stated))  # type: ignore[misc]
        found |= {f"{head}, {key}": value for key, value in run.items()}
    response = SecondOrder.response

    def counted(self: SecondOrder, coordinates: Any, *more: Any) -> Any:
        samples.append(coordinates.size)
        return response(self, coordinates, *more)

    with patch.object(SecondOrder, "response", counted):
        statistics = car.run(signal, "reduced").recording.statistics
    found |= {"stated errors, coordinates": sum(samples), "reduced, steps": statistics.steps}
    found["recorded bytes"] = sum(values.nbytes for values in recording.channels.values())
    return found


def batch_counts(name: str, signal: Signal, path: str, values: list[float]) -> dict[str, int]:
    """Return the counts of a batch of cars of a sweep in which a parameter varies."""
    base = Car.load(name)
    base.with_({path: 2.0 * values[-1]}).check("reduced")
    measure, found, tables = comfort_measure(base.vehicle, 0.0), dict[str, int](), list[Any]()
    with patch.object(batch_simulation, "GroupRun", _watched(GroupRun, tables)):

        def swept() -> None:
            cars = [base.with_({path: value}) for value in values]
            for car in cars:
                car.check("reduced")
            assert all(measured_batch(cars, signal, measure, accept_invalid=True))

        found |= calls(swept)
    found["states"] = sum(group.cars.states for group in tables)
    arrays = [array for group in tables for array in vars(group.cars).values() if isinstance(array, np.ndarray)]
    found["table bytes"] = sum(array.nbytes for array in arrays)
    found["steps"] = round(signal.duration / tables[0].timestep)
    return found


def _watched(made: Any, tables: list[Any]) -> Any:
    def make(*arguments: Any, **named: Any) -> Any:
        tables.append(made(*arguments, **named))
        return tables[-1]

    return make


def command_counts() -> dict[str, int]:
    """Return the bytes that the command `shaker` writes, and the modules that programs import."""
    with TemporaryDirectory() as folder:
        words = ["--input", "bump_1p5mm.csv", "--engine", "reduced", "--no-figures", "--quiet"]
        if shaker([*words, "--output", f"{folder}/run"]):
            raise RuntimeError("the command failed")
        found = {"shaker, bytes": sum(file.stat().st_size for file in Path(folder, "run").iterdir())}
    for name, module in STARTS.items():
        text = subprocess.run(
            [sys.executable, "-c", f"import sys; import {module}; print(*sys.modules)"],
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        # Those of Python itself, and of the installation, differ between machines.
        packages = {word.partition(".")[0] for word in text.split()} - sys.stdlib_module_names - {"sitecustomize"}
        found[f"{name}, modules"] = sum(word.startswith("vehicle") for word in text.split())
        found[f"{name}, packages"] = sum(not package.startswith("_") for package in packages)
    return found


def counts() -> dict[str, int]:
    """Return all counts by piece."""
    signal = piece(1.0)
    found = command_counts()
    for name, plates in (("focus", signal), ("focus_road", on_four_plates(signal))):
        found |= {f"{name}: {key}": value for key, value in run_counts(name, plates).items()}
    four = on_four_plates(signal)
    for path, value in (("front.damper.coulomb_friction", 60.0), ("front.damper.viscous", 1500.0)):
        values = [value * (1.0 + 0.05 * index) for index in range(8)]
        swept = batch_counts("focus_road", four, path, values)
        found |= {f"8 cars, {path.rpartition('.')[2]}: {key}": value for key, value in swept.items()}
    return found


def grown(found: Mapping[str, int], baseline: Mapping[str, int]) -> list[str]:
    """Return a sentence for each count that has grown by more than `GROWTH`, or has no baseline."""
    sentences = [f"{name}: no baseline" for name in found if name not in baseline]
    sentences += [f"{name}: not counted any more" for name in baseline if name not in found]
    return sentences + [
        f"{name}: {found[name]} instead of {count}"
        for name, count in baseline.items()
        if found.get(name, 0) > GROWTH * count
    ]


def main() -> int:
    """Print the counts, or write the baseline."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.counts", description=__doc__)
    parser.add_argument("--write", action="store_true", help="write the baseline anew")
    found = counts()
    if parser.parse_args().write:
        BASELINE.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    print(json.dumps(found, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
