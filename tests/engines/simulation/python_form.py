"""Oracle of the compiled code: the Python form of the element laws and of the stepping loop."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt
import pytest

from vehicle.engines.simulation import stepping
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.compiled import CompiledRows
from vehicle.engines.simulation.element_records import copy_row
from vehicle.engines.simulation.recording import Recording
from vehicle.engines.simulation.rows import Rows
from vehicle.engines.simulation.sampling import Loop, keep_sample, move_plates
from vehicle.signals.excitation.signal import Signal

ROUND_OFF = 1e-12
"""Largest relative difference between both forms. Sums of up to a hundred terms in another order differ by 1e-14."""

SOLVED = 1e-6
"""Largest relative difference of the velocities after the step. An iterative solver stops anywhere in its tolerance;
a step taken by another copy of the library, without callbacks, differs in the first digits."""

COMPARED = (
    "efc_J", "efc_pos", "efc_vel", "efc_aref", "efc_D", "efc_R", "efc_frictionloss", "qfrc_applied", "actuator_force",
)  # fmt: skip
"""Fields of mjData that the callbacks write, and the force they return."""

Values = dict[str, npt.NDArray[np.float64]]


class PythonRows:
    """The callbacks and the loop of a run without compiled code, with the interface of `CompiledRows`."""

    def __init__(self, rows: Rows) -> None:
        self.rows, self.gain, self.bias = rows, rows.actuator_gain, rows.actuator_bias

    def control(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Rewrite the rows of a state of the model."""
        if model._address == self.rows.model._address:
            self.rows(model, data)

    def attach(self, data: mujoco.MjData, *, sparse: bool) -> None:
        """Store the state that the loop steps; its rows stay dense."""
        self.data = data

    def detach(self) -> None:
        """Leave the state as it is."""

    def loop(self, loop: Loop) -> Callable[[int, int, int], int]:
        """Return the function that takes the steps first..last."""
        order, s, b = loop.order, loop.sources, loop.samples

        def advance(first: int, last: int, row: int) -> int:
            posed = 0
            for index in range(first, last + 1):
                move_plates(index, loop.plates)
                recorded = index % order.every == 0
                if recorded and (index // order.every) % order.pose_every == 0:
                    copy_row(b.poses[posed], s.position)
                    posed += 1
                mujoco.mj_step(self.rows.model, self.data)
                if recorded:
                    keep_sample(row, order.half, order, s, self.data.efc_force, b)
                    row += 1
            return posed

        return advance


def python_run(car: CarModel, signal: Signal, **options: Any) -> Recording:
    """Run a car with the Python form."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(stepping, "compiled_rows", PythonRows)
        return stepping.simulate(car, signal, **options)


def difference(rows: Rows, compiled: CompiledRows) -> str:
    """Return the name of the first value in which both forms differ in a moved state; empty where they agree."""
    expected, found = _evaluate(rows.anew(), None), _evaluate(rows, compiled)
    rows.reset()
    for name, value in expected.items():
        allowed = SOLVED if name == "qvel" else ROUND_OFF
        if not np.max(np.abs(found[name] - value), initial=0.0) <= allowed * np.max(np.abs(value), initial=0.0):
            return name
    return ""


def _evaluate(rows: Rows, compiled: CompiledRows | None) -> Values:
    """Evaluate two moved states, one step apart; the values contain the step from the second."""
    model, state = rows.model, rows.state
    data = mujoco.MjData(model)
    if compiled is not None:
        compiled.attach(data)
    with installed(rows, compiled):
        for visit in range(2):
            way = np.sin(1.7 * np.arange(model.nv) + visit)
            data.qpos[:] = model.qpos0
            mujoco.mj_integratePos(model, data.qpos, way, 1e-3)
            data.qvel[:] = 0.1 * way
            data.time = visit * rows.weights.timestep
            state.plate_velocity[:, 2] = 0.1 + 0.2 * np.arange(len(state.plate_velocity))
            state.slope_velocity[:] = 0.3 - 0.1 * np.arange(len(state.slope_velocity))
            state.plate_acceleration[:, 2] = 1.0 - 3.0 * np.arange(len(state.plate_velocity))
            if compiled is None:
                mujoco.mj_step(model, data)
            else:
                compiled.step(data)
    values = {name: np.array(getattr(data, name)) for name in (*COMPARED, "qvel")}
    return values | {name: array.copy() for name, array in state._asdict().items()}
