"""Controller of a semi-active damper in an FMU: FMI 2.0 or 3.0 co-simulation, an instance for each damper and run.

An FMU is native code, which runs with all rights of the user. So it is loaded only if its digest is in the list of
this user (`vehicle.core.trusted_code`), and it unpacks within limits.

At the communication point t_k = k T the FMU gets its sensors, does the communication step from t_k to t_k + T, and
returns the damper coefficient c that holds over this step. T is the control period, a multiple of the time step.

    body_velocity      vb      velocity of the damper end on the body, along the damper [m/s]
    wheel_velocity     vw      likewise on the wheel
    damper_velocity    vb - vw, rate of extension
    body_acceleration  (vb(t_k) - vb(t_k - T)) / T, mean over the last communication step; 0 in the first [m/s2]
    wheel_acceleration likewise of vw

Variables with a unit in the model description are converted (`controller_units.py`); others are in SI.
The core calls the functions of the FMU by their addresses (`controller.c`). After a failed call the controller is not
called again in this run, and the last coefficient holds; the engine then raises. Each instance has its own copy of the
library, so that a library with global variables serves several dampers. An instance is made at the beginning of a run
and freed at its end, so that runs are independent. FMPy reads and loads the FMU; it is imported only for a car with
such a controller.
"""

import ctypes
import hashlib
import io
import shutil
import tempfile
import zipfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.core.library import core
from vehicle.core.records import Packed, packed
from vehicle.core.trusted_code import trusted
from vehicle.errors import ConfigurationError, DataError, MissingPartError, SimulationError
from vehicle.model.laws.controller_units import UNITS_OF_CONTROL, Conversion, conversion_of, converting
from vehicle.model.parameters.semi_active_damper import CONTROLLER_PARAMETERS, FMU, SemiActiveDamper
from vehicle.signals.formats.unpacked_size import require_archive

LARGEST = 200e6
"""Maximum size of an FMU, packed and unpacked [byte]: libraries for all platforms have some 10 MB."""

REALS = ("Real", "Float64")
"""Types of the variables in FMI 2.0 and 3.0."""

UNITS_OF_SENSORS = dict.fromkeys(("body_velocity", "wheel_velocity", "damper_velocity"), "m/s") | dict.fromkeys(
    ("body_acceleration", "wheel_acceleration"), "m/s2"
)
"""Names of the inputs of a controller FMU, in the order of their values in the core, and their units."""

SENSORS = tuple(UNITS_OF_SENSORS)
"""Names of the inputs."""

COEFFICIENT = "coefficient"
"""Name of the output of a controller FMU [N s/m]."""

WARNING = 1
"""Maximum status of a successful call of FMI."""
NOT_FINITE, TERMINATED = 10, 11
"""Further status: a coefficient that is not a finite number; a controller that ends the simulation."""

STATUS = {
    2: "discards the step",
    3: "reports an error",
    4: "reports a fatal error",
    5: "has not finished its step (asynchronous steps are not supported)",
    NOT_FINITE: f"returns a {COEFFICIENT} that is not a finite number",
    TERMINATED: "requests the end of the simulation",
}
"""Meaning of the status of a failed """


@dataclass(frozen=True, kw_only=True, slots=True)
class ControllerFile:
    """Checked FMU of a controller.

    Attributes:
        path: the file.
        content: its bytes.
        description: model description of FMPy.
        sensors: index in `SENSORS` of each input. inputs: value references of the inputs.
        output: value reference of the coefficient.
        parameters: value references of the parameters with a name in `CONTROLLER_PARAMETERS`.
        conversions: conversion between its declared unit and SI of each variable of these, by name.
    """

    path: Path
    content: bytes
    description: Any
    sensors: tuple[int, ...]
    inputs: tuple[int, ...]
    output: int
    parameters: Mapping[str, int]
    conversions: Mapping[str, Conversion]

    @property
    def in_si(self) -> bool:
        """True if all inputs and the output are in SI."""
        names = (*(SENSORS[index] for index in self.sensors), COEFFICIENT)
        return all(self.conversions[name] == Conversion() for name in names)


def read_controller(path: Path, digest: str | None) -> ControllerFile:
    """Read and check the FMU of a controller.

    Args:
        path: the file.
        digest: SHA-256 that the file must have, in hexadecimal digits; None: any.

    Raises:
        ConfigurationError: the file is missing, has another digest, or is not in the user's list of trusted code.
        DataError: the file is too large, no FMU for co-simulation, its variables have other names or units, or it has
            no library for this platform.
        MissingPartError: FMPy is not installed.
    """
    fmpy = _fmpy()
    if not path.is_file():
        raise ConfigurationError(f"controller {path}: the file does not exist; give the path of an FMU")
    if path.stat().st_size > LARGEST:
        raise DataError(
            f"controller {path}: the file has {path.stat().st_size / 1e6:.4g} MB, but at most {LARGEST / 1e6:g} MB "
            "are allowed"
        )
    content = path.read_bytes()
    actual_digest = hashlib.sha256(content).hexdigest()
    if digest is not None and digest.lower() != actual_digest:
        raise ConfigurationError(
            f"controller {path}: the FMU has changed: its SHA-256 is {actual_digest}, but fmu_sha256 in the "
            f"vehicle file is {digest}; if the new FMU is meant, set fmu_sha256 to the new value"
        )
    if actual_digest not in trusted():
        raise ConfigurationError(
            f"controller {path}: an FMU is native code, which runs with all your rights, and you have not allowed "
            f'this one; if you trust its source, type: python -m vehicle trust "{path}"'
        )
    try:
        require_archive("its archive", io.BytesIO(content), limit=LARGEST)
        description = fmpy.read_model_description(str(path), validate=False)
        platforms = fmpy.supported_platforms(str(path))
    except Exception as error:
        raise DataError(
            f"controller {path}: cannot be read as an FMU ({error}); export it as FMI 2.0 or 3.0 co-simulation"
        ) from None
    if description.fmiVersion == "1.0" or description.coSimulation is None:
        form = "of FMI 1.0" if description.fmiVersion == "1.0" else "not for co-simulation"
        raise DataError(f"controller {path}: the FMU is {form}; export it as FMI 2.0 or 3.0 co-simulation")
    if fmpy.platform not in platforms:
        raise DataError(
            f"controller {path}: the FMU has no library for {fmpy.platform}, but for {_listed(platforms)}; "
            "export it on this platform, or compile its sources: python -m fmpy compile FILE.fmu"
        )
    return _with_variables(path, content, description)


def _with_variables(path: Path, content: bytes, description: Any) -> ControllerFile:
    """Return a controller with the references of its variables; raise if one is missing or has another name or type."""
    variables = {entry.name: entry for entry in description.modelVariables}
    numbers = {name: entry for name, entry in variables.items() if entry.type in REALS and not entry.dimensions}
    inputs = [name for name, entry in variables.items() if entry.causality == "input"]
    outputs = [name for name, entry in numbers.items() if entry.causality == "output"]
    wrong = [name for name in inputs if name not in SENSORS or name not in numbers]
    if wrong or not inputs or COEFFICIENT not in outputs:
        raise DataError(
            f"controller {path}: found inputs {_listed(inputs)} and outputs {_listed(outputs)}; must be inputs "
            f"among {', '.join(SENSORS)} and an output {COEFFICIENT} [N s/m], all real numbers; rename the "
            "variables in the tool that made the controller"
        )
    parameters = {
        name: numbers[name].valueReference
        for name in CONTROLLER_PARAMETERS
        if name in numbers and numbers[name].causality == "parameter"
    }
    units = {name: UNITS_OF_SENSORS[name] for name in inputs} | {COEFFICIENT: "N s/m"}
    units |= {name: UNITS_OF_CONTROL[name] for name in parameters}
    return ControllerFile(
        path=path,
        content=content,
        description=description,
        sensors=tuple(SENSORS.index(name) for name in inputs),
        inputs=tuple(numbers[name].valueReference for name in inputs),
        output=numbers[COEFFICIENT].valueReference,
        parameters=parameters,
        conversions={name: conversion_of(path, numbers[name], description, unit) for name, unit in units.items()},
    )


def _listed(names: Sequence[str]) -> str:
    """Return names for a message."""
    return ", ".join(names) or "none"


class Controller:
    """Instance of a controller FMU for one damper and run, initialized at time 0.

    Args:
        file: the FMU.
        damper: name of the damper.
        control: values of its table.
        period: communication step [s].
        messages: list to which the messages of the FMU are appended.

    Raises:
        SimulationError: the library cannot be loaded, or the FMU refuses to start.
    """

    def __init__(
        self, file: ControllerFile, damper: str, control: SemiActiveDamper, period: float, messages: list[str]
    ) -> None:
        self.file, self.damper, self.period, self.messages = file, damper, period, messages
        self.record: Packed | None = None
        self.folder = tempfile.mkdtemp(prefix="controller-")
        self.slave: Any = None
        self.converted: tuple[Any, ...] = ()
        try:
            self._start(control)
        except Exception as error:
            self.close()
            raise SimulationError(
                f"{damper}: controller {file.path.name} cannot be started ({error}){self._last_message()}; try "
                f"the FMU alone: python -m fmpy simulate {file.path.name}"
            ) from None

    def _start(self, control: SemiActiveDamper) -> None:
        """Load and initialize the FMU, and write the memory for the calls."""
        fmpy, file, second = _fmpy(), self.file, self.file.description.fmiVersion == "2.0"
        with zipfile.ZipFile(io.BytesIO(file.content)) as archive:  # what was checked, not what is there now
            archive.extractall(self.folder)
        slave = self.slave = fmpy.instantiate_fmu(
            self.folder, file.description, "CoSimulation", logger=self._logger(second), require_functions=False
        )
        if file.parameters:
            write = slave.setReal if second else slave.setFloat64
            values = {
                reference: file.conversions[name].to_unit(value)
                for name, reference in file.parameters.items()
                if (value := getattr(control, name)) is not None
            }
            write([*values], [*values.values()])
        if second:
            slave.setupExperiment(startTime=0.0)
            slave.enterInitializationMode()
        else:
            slave.enterInitializationMode(startTime=0.0)
        slave.exitInitializationMode()
        names = ("fmi2SetReal", "fmi2DoStep", "fmi2GetReal") if second else (
            *("fmi3SetFloat64", "fmi3DoStep", "fmi3GetFloat64"),
        )  # fmt: skip
        functions = [ctypes.cast(getattr(slave.dll, name), ctypes.c_void_p).value or 0 for name in names]
        if not file.in_si:
            inputs = [file.conversions[SENSORS[index]] for index in file.sensors]
            write_inputs = converting(functions[0], inputs, to_fmu=True)
            read_output = converting(functions[2], [file.conversions[COEFFICIENT]], to_fmu=False)
            self.converted = write_inputs, read_output
            functions[::2] = [ctypes.cast(each, ctypes.c_void_p).value or 0 for each in self.converted]
        record = self.record = packed(
            "Controller",
            {
                "call": {"function": ctypes.cast(core().core_controller_step, ctypes.c_void_p).value or 0, "memory": 0},
                **dict(zip(("set", "step", "get"), functions, strict=True)),
                "instance": int(getattr(slave.component, "value", slave.component)),
                "status": 0,
                "readings": 0,
                "period": self.period,
                "coefficient": control.minimum_damping,
                "measured": np.zeros(len(SENSORS)),
                "sources": np.array(file.sensors, dtype=np.int64),
                "inputs": np.zeros(len(file.inputs)),
                "references": np.array([*file.inputs, file.output], dtype=np.uint32),
                "results": np.zeros(4, dtype=np.int64),
            },
        )
        record.memory.call.memory = record.address

    @property
    def address(self) -> int:
        """Return the address of the record of the controller for the core."""
        return self.record.address if self.record else 0

    def _logger(self, second: bool) -> Callable[..., None]:
        """Return the function that takes the messages of warnings and errors."""
        # FMPy gives the messages of all FMI 2.0 instances to the newest instance: all instances have the same list.
        if second:
            return lambda environment, name, status, category, text: self.messages.append(text.decode(errors="replace"))
        from fmpy.fmi3 import fmi3LogMessageCallback

        return fmi3LogMessageCallback(  # type: ignore[no-any-return]
            lambda environment, status, category, text: self.messages.append(text.decode(errors="replace"))
        )

    def _last_message(self) -> str:
        """Return the last message of the FMU for an error."""
        return f", with the message {self.messages[-1].strip()!r}" if self.messages else ""

    def check(self) -> None:
        """Check that all calls have succeeded.

        Raises:
            SimulationError: a call has failed; with damper, time and the last message of the FMU.
        """
        memory = self.record.memory if self.record else None
        if memory is None or memory.status <= WARNING:
            return
        status = int(memory.status)
        step_size = getattr(self.file.description.defaultExperiment, "stepSize", None)
        hint = f"its communication step is control_period = {self.period:g} s"
        if step_size:
            hint += f", the step in its model description {step_size} s"
        raise SimulationError(
            f"{self.damper}: controller {self.file.path.name} "
            f"{STATUS.get(status, f'returns the status {status}')} at t = {memory.readings * self.period:.4f} "
            f"s{self._last_message()}; {hint}; check step and inputs"
        )

    def close(self) -> None:
        """Free the instance, and remove its copy of the library."""
        slave, self.slave = self.slave, None
        if slave is not None:
            slave.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)


@contextmanager
def controllers(
    laws: npt.NDArray[Any], dampers: Sequence[tuple[str, SemiActiveDamper]], timestep: float
) -> Iterator[Callable[[], None]]:
    """Start the controller FMUs of a run, and free them at its end.

    Args:
        laws: records of the controlled dampers; the addresses of the controllers are in them during the run; (k,).
        dampers: name and control of each of them.
        timestep: time step of the engine [s].

    Yields:
        Function that raises a SimulationError if a controller has failed.

    Raises:
        ConfigurationError, DataError, MissingPartError, SimulationError: see `read_controller` and `Controller`.
    """
    files: dict[tuple[str, str | None], ControllerFile] = {}
    messages: list[str] = []
    with ExitStack() as stack:
        started = []
        stack.callback(laws["controller"].fill, 0.0)
        for index, (name, control) in enumerate(dampers):
            if control.law == FMU and control.fmu is not None:
                key = control.fmu, control.fmu_sha256
                if key not in files:
                    files[key] = read_controller(Path(control.fmu), control.fmu_sha256)
                period = float(laws["period"][index]) * timestep
                controller = Controller(files[key], name, control, period, messages)
                stack.callback(controller.close)
                started.append(controller)
                laws["controller"][index] = float(controller.address)

        def check() -> None:
            for controller in started:
                controller.check()

        yield check


def require_controllers(controls: Iterable[SemiActiveDamper | None]) -> None:
    """Check the FMUs of controllers before a run.

    Raises:
        ConfigurationError, DataError, MissingPartError: see `read_controller`.
    """
    chosen = [control for control in controls if control and control.law == FMU]
    for path, digest in dict.fromkeys((control.fmu, control.fmu_sha256) for control in chosen):
        read_controller(Path(path or ""), digest)


def _fmpy() -> Any:
    """Import FMPy; raise if it is not installed."""
    try:
        import fmpy
    except ImportError:
        raise MissingPartError(
            "a controller in an FMU needs FMPy, which is not installed; install it with: pip install "
            "'vehicle-on-shaker[fmu]'"
        ) from None
    return fmpy
