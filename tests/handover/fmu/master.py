"""Master of an FMU in tests: FMPy drives the library of this platform step by step."""

import shutil
import tempfile
import weakref
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import numpy.typing as npt

from vehicle.engines.reduced.plate_samples import plate_samples
from vehicle.handover.fmu.fmu_file import write_fmu
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal

Vector = npt.NDArray[np.float64]

STEP = 2e-4
"""Internal time step of the FMUs in tests [s]."""


class Fmu:
    """An unpacked FMU."""

    def __init__(self, path: Path) -> None:
        self.path, self.description = path, fmpy.read_model_description(str(path), validate=True)
        self.folder = tempfile.mkdtemp()
        fmpy.extract(str(path), self.folder)
        weakref.finalize(self, shutil.rmtree, self.folder, ignore_errors=True)
        self.references = {entry.name: entry.valueReference for entry in self.description.modelVariables}
        self.second = self.description.fmiVersion == "2.0"

    def names(self, causality: str) -> list[str]:
        """Return the names of the variables of a causality."""
        return [entry.name for entry in self.description.modelVariables if entry.causality == causality]


class Instance:
    """An instance of an FMU; its messages are kept.

    Args:
        fmu: the FMU.
        started: set up, initialized at rest and ready for steps.
        token: text in the place of that of the model description.
    """

    def __init__(self, fmu: Fmu, *, started: bool = True) -> None:
        self.fmu, self.messages = fmu, list[str]()
        self.slave: Any = fmpy.instantiate_fmu(
            fmu.folder, fmu.description, "CoSimulation", logger=self._logger(), debug_logging=True
        )
        self.time = 0.0
        if started:
            self.begin()
            self.end_initialization()

    def _logger(self) -> Any:
        """Return the function that takes the messages, in the form of the standard."""
        if self.fmu.second:
            return lambda environment, name, status, category, message: self.messages.append(message.decode())
        from fmpy.fmi3 import fmi3LogMessageCallback

        return fmi3LogMessageCallback(lambda environment, status, category, text: self.messages.append(text.decode()))

    def begin(self) -> None:
        """Set up and enter the initialization mode."""
        if self.fmu.second:
            self.slave.setupExperiment(startTime=0.0)
            self.slave.enterInitializationMode()
        else:
            self.slave.enterInitializationMode(startTime=0.0)

    def end_initialization(self) -> None:
        """Leave the initialization mode."""
        self.slave.exitInitializationMode()

    def set(self, values: Mapping[str, float]) -> None:
        """Set variables by name."""
        call = self.slave.setReal if self.fmu.second else self.slave.setFloat64
        call([self.fmu.references[name] for name in values], [float(value) for value in values.values()])

    def get(self, names: Sequence[str]) -> list[float]:
        """Return variables by name."""
        call = self.slave.getReal if self.fmu.second else self.slave.getFloat64
        found: list[float] = call([self.fmu.references[name] for name in names])
        return found

    def step(self, length: float) -> None:
        """Do a communication step."""
        self.slave.doStep(currentCommunicationPoint=self.time, communicationStepSize=length)
        self.time += length

    def close(self) -> None:
        """Free the instance."""
        self.slave.freeInstance()


def written(car: Car, folder: Path, **options: Any) -> Fmu:
    """Write a car as an FMU with the step of the tests, and unpack it."""
    path = folder / "car.fmu"
    write_fmu(car, path, **{"step": STEP, **options})
    return Fmu(path)


def plates_of(signal: Signal, duration: float, step: float = STEP) -> Vector:
    """Return (z, z', slope excess of the next step) of the driven plates at all steps up to a time of the signal."""
    whole = plate_samples(signal, step, round(signal.duration / step), 0)[:]
    rows = np.array(whole[: round(duration / step) + 1]).reshape(-1, len(signal.wheels), 3)
    rows[..., 0] += [signal.displacement[wheel][0] for wheel in signal.wheels]
    return rows


def drive(
    instance: Instance,
    signal: Signal,
    plates: Vector,
    outputs: Sequence[str],
    every: int,
    length: float = STEP,
    forces: Mapping[str, Callable[[float], float]] | None = None,
) -> Vector:
    """Drive a fresh instance over the plates.

    Args:
        instance: instance that is not initialized.
        signal: whose wheels are driven.
        plates: (z, z', slope excess) of each driven plate at the communication points.
        outputs: names of the outputs.
        every: communication steps from one sample of the outputs to the next.
        length: communication step [s].
        forces: applied forces over time [s] by the name of their variables.

    Returns:
        Outputs at the samples; (outputs, samples).
    """
    names = [f"plate_{wheel}_{quantity}" for wheel in signal.wheels for quantity in ("displacement", "velocity")]
    rolling = [f"plate_{wheel}_slope_excess" for wheel in signal.wheels if signal.slope_velocity]
    pushed = forces or {}
    instance.begin()
    instance.set(dict(zip(names, plates[0, :, :2].ravel(), strict=True)))
    instance.set({name: force(0.0) for name, force in pushed.items()})
    instance.end_initialization()
    rows = [instance.get(outputs)]
    for k, (before, plate) in enumerate(pairwise(plates), start=1):
        instance.set(dict(zip(names, plate[:, :2].ravel(), strict=True)))
        instance.set(dict(zip(rolling, before[:, 2], strict=False)))
        instance.set({name: force(k * length) for name, force in pushed.items()})
        instance.step(length)
        if k % every == 0:
            rows.append(instance.get(outputs))
    return np.array(rows).T
