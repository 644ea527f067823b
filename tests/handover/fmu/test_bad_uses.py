"""What an FMU refuses, each with a sentence that says what is wrong and how to mend it."""

import ctypes
import math
import shutil
from pathlib import Path

import pytest

pytest.importorskip("fmpy", reason="FMPy is missing: pip install 'vehicle-on-shaker[oracles]'")

import fmpy

from tests.handover.fmu.master import Fmu, Instance, written
from vehicle.runs.car import Car

VALUES = {
    "plate_fl_displacement": (math.nan, "found nan, must be -1000 to 1000 m"),
    "plate_fr_displacement": (1e300, "found 1e+300, must be -1000 to 1000 m"),
    "plate_fl_velocity": (math.inf, "found inf, must be -100 to 100 m/s"),
    "plate_fr_velocity": (-101.0, "found -101, must be -100 to 100 m/s"),
    "damper_fl_force_command": (math.nan, "found nan, must be -1e+06 to 1e+06 N"),
    "damper_fr_force_command": (1e7, "found 1e+07"),
    "damper_fl_coefficient_command": (-math.inf, "found -inf"),
    "damper_fl_coulomb_friction": (-1.0, "found -1, must be 0 to 1e+06 N"),
    "damper_fr_coulomb_friction": (math.nan, "found nan"),
    "damper_fl_curve_scale": (-0.5, "found -0.5, must be 0 to 10"),
    "damper_fr_curve_scale": (11.0, "found 11, must be 0 to 10"),
    "seat_rail_acc_z": (1.0, "cannot be set"),
    "time": (1.0, "cannot be set"),
}


def said(instance: Instance, text: str) -> None:
    """Check the last message of an instance."""
    assert instance.messages and text in instance.messages[-1], instance.messages


def refused(instance: Instance, call, text: str) -> None:
    """Check that a call fails with a message."""
    with pytest.raises(fmpy.fmi1.FMICallException):
        call()
    said(instance, text)


def test_values(focus_fmu):
    instance = Instance(focus_fmu)
    for name, (value, text) in VALUES.items():
        before = instance.get([name])
        refused(instance, lambda name=name, value=value: instance.set({name: value}), text)
        assert instance.get([name]) == before and ("set" in text or name in instance.messages[-1])
        instance.step(1e-3)


def test_unknown_references_and_parameters_of_laws_that_the_car_does_not_have(focus_fmu):
    instance = Instance(focus_fmu)
    slave = instance.slave
    get, put = (slave.getReal, slave.setReal) if focus_fmu.second else (slave.getFloat64, slave.setFloat64)
    for reference in (1, 99, 104, 10004, 20000 + 12, 30000 + 5000, 2**32 - 1):
        refused(instance, lambda number=reference: get([number]), f"value reference {reference}")
        refused(instance, lambda number=reference: put([number], [0.0]), f"value reference {reference}")
    for parameter in (1, 2, 3, 5):
        text = "control law" if parameter == 5 else "friction of this damper"
        refused(instance, lambda number=parameter: put([20000 + number], [0.5]), text)


def test_steps(focus_fmu):
    instance = Instance(focus_fmu)
    for length, text in (
        (0.0, "step of 0 s: "), (-1e-3, "step of -0.001 s: "), (math.nan, "step of nan s: "), (math.inf, "multiple"),
        (1e300, "0.0002 s, up to 100000 times"), (1e-4, "step of 0.0001 s: "), (2.5e-4, "--step"), (1e-6, "multiple"),
    ):  # fmt: skip
        refused(instance, lambda length=length: instance.step(length), text)
        instance.time = 0.0
    instance.step(1e-3)


def test_points_in_time(focus_fmu):
    instance = Instance(focus_fmu)
    instance.step(1e-3)
    for time in (0.0, 2e-3, math.nan, 1e300, -1.0):
        instance.time = time
        refused(instance, lambda: instance.step(1e-3), "the car is at 0.001 s")
    instance.time = 1e-3
    instance.step(1e-3)


@pytest.mark.parametrize("remainder", [1e-300, 1e-13, 1e-7])
def test_a_remainder_of_round_off_before_the_stop_time(remainder, focus_fmu):
    """OMSimulator adds up its time and ends with a step of about 1e-13 s: it is accepted, and the car stays."""
    instance = Instance(focus_fmu)
    instance.set({"plate_fl_displacement": 1e-4, "plate_fl_velocity": 0.1})
    instance.step(1e-3)
    before = instance.get(["seat_rail_acc_z"])
    instance.step(remainder)
    assert instance.get(["seat_rail_acc_z"]) == before
    instance.time = 1e-3 + remainder
    instance.step(1e-3)
    assert instance.get(["seat_rail_acc_z"]) != before
    assert instance.messages == []


def test_remainders_do_not_add_up(focus_fmu):
    instance = Instance(focus_fmu)
    instance.step(1.5e-7)
    instance.step(1.5e-7)
    refused(instance, lambda: instance.step(1.5e-7), "3e-07 s: ")


def test_a_plate_that_moves_without_velocity(focus_fmu):
    instance = Instance(focus_fmu)
    for k in range(49):
        instance.set({"plate_fl_displacement": 1e-5 * (k + 1)})
        instance.step(1e-3)
    instance.set({"plate_fl_displacement": 1e-3})
    refused(instance, lambda: instance.step(1e-3), "plate_fl_velocity has been 0 for 50 steps")
    standing = Instance(focus_fmu)
    for _ in range(100):
        standing.step(1e-3)
    assert standing.messages == []


def test_a_damper_that_drives_the_car(focus_fmu):
    instance = Instance(focus_fmu)
    instance.set({"damper_fl_coefficient_command": -9e5})
    refused(instance, lambda: instance.step(1e-3), "damper_fl_coefficient_command: -900000 N s/m with curve_scale 1")
    instance.time = 0.0
    instance.set({"damper_fl_coefficient_command": 0.0})
    instance.step(1e-3)


def test_order_of_calls(focus_fmu):
    instance = Instance(focus_fmu, started=False)
    slave = instance.slave
    refused(instance, lambda: instance.step(1e-3), "do step: the instance is instantiated, but must be in step mode")
    refused(instance, instance.end_initialization, "exit initialization mode: the instance is instantiated")
    refused(instance, slave.terminate, "terminate: the instance is instantiated")
    if focus_fmu.second:
        refused(instance, slave.enterInitializationMode, "fmi2SetupExperiment must be called before")
    instance.begin()
    refused(instance, instance.begin, "before initialization" if focus_fmu.second else "is in initialization mode")
    instance.time = 0.0
    refused(instance, lambda: instance.step(1e-3), "do step: the instance is in initialization mode")
    instance.end_initialization()
    refused(instance, instance.end_initialization, "the instance is in step mode")
    slave.terminate()
    instance.time = 0.0
    refused(instance, lambda: instance.step(1e-3), "do step: the instance is terminated")
    refused(instance, lambda: instance.set({"plate_fl_velocity": 0.0}), "set values: the instance is terminated")


def test_start_time(focus_fmu):
    instance = Instance(focus_fmu, started=False)
    if focus_fmu.second:
        instance.slave.setupExperiment(startTime=math.nan)
        refused(instance, instance.slave.enterInitializationMode, "start time: found nan, must be finite")
    else:
        begin = instance.slave.enterInitializationMode
        refused(instance, lambda: begin(startTime=math.inf), "start time: found inf, must be finite")


def test_tokens_and_resources(focus_fmu, tmp_path):
    broken = Fmu(focus_fmu.path)
    folder = Path(broken.folder)

    def fails(text: str) -> None:
        with pytest.raises(Exception, match="instantiate"):
            Instance(broken, started=False)
        assert text in heard[-1], heard

    heard: list[str] = []
    own = Instance._logger

    def listening(self):
        self.messages = heard
        return own(self)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Instance, "_logger", listening)
        name = "guid" if broken.second else "instantiationToken"
        token = broken.description.guid if broken.second else broken.description.instantiationToken
        setattr(broken.description, name, "{0123}")
        fails("the token of the call is {0123}, that of the resources {")
        setattr(broken.description, name, token)
        file = folder / "resources" / "car.bin"
        content = file.read_bytes()
        for damaged in (content[:-9], content + b"\0", b"VEHFMU99" + content[8:], b"", content[:60]):
            file.write_bytes(damaged)
            fails("car.bin is damaged or of another version of this library")
        file.write_bytes(content[:56] + (10**9).to_bytes(8, "little") + content[64:])
        fails("car.bin is damaged")
        file.unlink()
        fails("cannot open")
        file.write_bytes(content)
        Instance(broken)
    other = tmp_path / "with blank and %41"
    shutil.copytree(folder, other)
    broken.folder = str(other)
    Instance(broken)


def test_states_of_other_cars(focus_fmu, tmp_path):
    other = written(Car.load("focus", ["front.damper.viscous=900"]), tmp_path, fmi=focus_fmu.description.fmiVersion[0])
    first = Instance(focus_fmu)
    kind = "state" if focus_fmu.second else "State"
    state = getattr(first.slave, f"getFMU{kind}")()
    stored = getattr(first.slave, f"serializeFMU{kind}")(state)
    read = "deSerializeFMUstate" if focus_fmu.second else "deserializeFMUState"
    refused(first, lambda: getattr(first.slave, read)(stored[:-8]), "the bytes are no state of this car")
    broken = bytearray(stored)
    broken[400:408] = b"\xff" * 8
    refused(first, lambda: getattr(first.slave, read)(bytes(broken)), "hold numbers that are not finite")
    # FMPy gives the messages of all FMI 2.0 instances to the newest.
    second = Instance(other)
    refused(second, lambda: getattr(second.slave, f"setFMU{kind}")(state), "set state: the state is of another car")
    refused(second, lambda: getattr(second.slave, read)(stored), "the bytes are no state of this car")


def test_functions_that_are_not_offered(focus_fmu):
    instance = Instance(focus_fmu)
    library, component = instance.slave.dll, ctypes.c_void_p(instance.slave.component)
    if focus_fmu.second:
        names = ["fmi2CancelStep"]
        assert library.fmi2GetInteger(component, None, ctypes.c_size_t(1), None) == 3
        said(instance, "fmi2GetInteger: not offered by this FMU, see its model description")
    else:
        names = ["fmi3EnterEventMode", "fmi3EnterStepMode", "fmi3EnterConfigurationMode", "fmi3EvaluateDiscreteStates"]
    for name in names:
        assert getattr(library, name)(component) == 3
        said(instance, f"{name}: not offered by this FMU")
    for name in ("DoStep", "Terminate", "Reset", "ExitInitializationMode"):
        function = getattr(library, f"fmi{2 if focus_fmu.second else 3}{name}")
        zeros = [ctypes.c_double(0.0), ctypes.c_double(1e-3), 0, None, None, None, None][: 7 if name == "DoStep" else 0]
        assert function(None, *zeros) == 3
