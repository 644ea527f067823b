"""An FMU in libcosim, a foreign master in C++ that loads FMUs with the FMI Library of the FMU compliance checker."""

import numpy as np
import pytest

pytest.importorskip("fmpy", reason="FMPy is missing: pip install 'vehicle-on-shaker[oracles]'")
pytest.importorskip("libcosimpy", reason="libcosim is missing: pip install 'vehicle-on-shaker[oracles]'")

from tests.handover.fmu.master import Instance, written
from tests.validation import foreign, validated
from vehicle.runs.car import Car

OUTPUTS = ("seat_rail_displacement_z", "seat_rail_acc_z", "tyre_fl_force_z", "damper_fl_velocity", "damper_fr_force")
STEPS = 500


def plate(step: int) -> dict[str, float]:
    """Return the left plate at the end of a communication step of 1 ms."""
    phase = 40e-3 * (step + 1)
    return {"plate_fl_displacement": 0.002 * np.sin(phase), "plate_fl_velocity": 0.08 * np.cos(phase)}


def test_libcosim_gives_the_motion_of_fmpy(tmp_path):
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    fmu = written(Car.load("focus"), tmp_path)
    instance, expected = Instance(fmu), []
    for step in range(STEPS):
        instance.set(plate(step))
        instance.step(1e-3)
        expected.append(instance.get(OUTPUTS))
    instance.close()

    execution = CosimExecution.from_step_size(1_000_000)  # in nanoseconds
    # The objects of libcosim live as long as the execution.
    slave, inputs = CosimLocalSlave(fmu_path=str(fmu.path), instance_name="car"), CosimManipulator.create_override()
    observer = CosimObserver.create_last_value()
    index = execution.add_local_slave(slave)
    execution.add_manipulator(inputs)
    execution.add_observer(observer)
    rows = []
    for step in range(STEPS):
        values = plate(step)
        inputs.slave_real_values(index, [fmu.references[name] for name in values], [*values.values()])
        assert execution.step()
        rows.append([*observer.last_real_values(index, [fmu.references[name] for name in OUTPUTS])])
    found, wanted = np.array(rows).T, np.array(expected).T
    assert np.all(np.ptp(wanted, axis=1) > 1e-3)
    validated(
        "Exported FMUs", "FMI 2.0 in libcosim: deviation from FMPy over the peak",
        np.max(np.abs(found - wanted), axis=1) / np.max(np.abs(wanted), axis=1), 0.0, abs=1e-12,
        source=foreign("libcosimpy", "with the FMI Library"),
    )  # fmt: skip
