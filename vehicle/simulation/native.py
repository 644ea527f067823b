"""The compiled form of the callbacks: whether it can be had, and the proof that it agrees with the Python form."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.compiler_cache import prepare_compiler_cache
from vehicle.simulation.callbacks import installed
from vehicle.simulation.element_rows import ElementRows

if TYPE_CHECKING:
    from vehicle.simulation.native_callback import NativeCallback

SLOWER = "the run used the Python form, which is slower and gives the same results"

ROUND_OFF = 1e-12
"""Largest relative difference between both forms. Sums of up to a hundred terms in another order differ by 1e-14."""

COMPARED = (
    "efc_J", "efc_pos", "efc_vel", "efc_aref", "efc_D", "efc_R", "efc_frictionloss", "qfrc_applied", "actuator_force",
)  # fmt: skip
"""Fields of mjData that the callbacks write, and the force they return."""

SOLVED = 1e-6
"""Largest relative difference of the velocities after the step. An iterative solver stops anywhere in its tolerance;
a step taken by another copy of the library, without callbacks, differs in the first digits."""

REMEMBERED = ("residual", "rate", "explicit", "branch_past", "branch_force", "limits")
"""Fields of the element rows that the recorder reads or the next step needs."""

Values = dict[str, npt.NDArray[np.float64]]


def native_callback(rows: ElementRows) -> NativeCallback | str:
    """The compiled callbacks of a simulation, verified against the Python form.

    Args:
        rows: element rows of a prepared model, before the run; the callbacks share their state.

    Returns:
        The callbacks, or a sentence that says why the run has to do without them.
    """
    prepare_compiler_cache()
    try:
        importlib.import_module("numba")
    except ImportError:
        return f"compiled callbacks need numba, which is missing (pip install numba); {SLOWER}"
    # A broken or unwritable installation of the compiler shows here, in many kinds of errors; none must stop a run.
    try:
        from vehicle.simulation.native_callback import NativeCallback

        probe = mujoco.MjData(rows.model)
        probe.time = rows.step
        mujoco.mj_fwdPosition(rows.model, probe)
        callback = NativeCallback(rows, probe)
    except Exception as error:
        return f"compiled callbacks are not available ({type(error).__name__}: {error}); {SLOWER}"
    difference = _difference(rows, callback)
    return f"compiled callbacks gave another {difference} than the Python form; {SLOWER}" if difference else callback


def _difference(rows: ElementRows, callback: NativeCallback) -> str:
    """Name of the first value in which both forms differ in a moved state; empty where there is none."""
    reference = rows.anew()
    expected = _evaluate(reference, None)
    found = _evaluate(rows, callback)
    callback.reset()
    for name, value in expected.items():
        allowed = SOLVED if name == "qvel" else ROUND_OFF
        if not np.max(np.abs(found[name] - value), initial=0.0) <= allowed * np.max(np.abs(value), initial=0.0):
            return name
    return ""


def _evaluate(rows: ElementRows, callback: NativeCallback | None) -> Values:
    """What the callbacks make of two moved states, one step apart, and the step makes of the second."""
    model = rows.model
    data = mujoco.MjData(model)
    if callback is not None:
        callback.attach(data)
    with installed(rows, callback):
        for visit in range(2):
            way = np.sin(1.7 * np.arange(model.nv) + visit)
            data.qpos[:] = model.qpos0
            mujoco.mj_integratePos(model, data.qpos, way, 1e-3)
            data.qvel[:] = 0.1 * way
            data.time = visit * rows.step
            rows.plate_velocity[:, 2] = 0.1 + 0.2 * np.arange(len(rows.plate_velocity))
            rows.plate_acceleration[:, 2] = 1.0 - 3.0 * np.arange(len(rows.plate_velocity))
            if callback is None:
                mujoco.mj_step(model, data)
            else:
                callback.step(data)
    rows.plate_velocity[:] = 0.0
    rows.plate_acceleration[:] = 0.0
    values = {name: np.array(getattr(data, name)) for name in (*COMPARED, "qvel")}
    return values | {name: np.array(getattr(rows, name)) for name in REMEMBERED}
