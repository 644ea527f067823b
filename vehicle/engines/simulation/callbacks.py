"""MuJoCo's process-wide callbacks: compiled where that can be had and proved, installed for one model, removed."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.compiler import numba_module
from vehicle.engines.simulation.rows import Rows
from vehicle.errors import SimulationError

if TYPE_CHECKING:
    from vehicle.engines.simulation.compiled import CompiledRows

SLOWER = "the run used the Python form, which is slower and gives the same results"

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


@contextmanager
def installed(rows: Rows, compiled: CompiledRows | None = None) -> Iterator[None]:
    """Install the callbacks of one simulation for the time of a `with` block.

    Callbacks are global to the process: they are refused while others are installed, they check which model calls
    them, and they never outlive the block, so that no other model meets them.

    Args:
        rows: of the model that will be stepped inside the block.
        compiled: their compiled form, to be installed instead; it acts on the states that it is attached to,
            and is detached from them at the end.

    Raises:
        SimulationError: other callbacks are installed already.
    """
    if mujoco.get_mjcb_control() is not None:
        raise SimulationError(
            "mjcb_control is taken by another simulation in this process; finish that one first, or use a process each"
        )

    def control(model: mujoco.MjModel, data: mujoco.MjData) -> None:
        if model is rows.model or model._address == rows.model._address:
            rows(model, data)

    mujoco.set_mjcb_control(control if compiled is None else compiled.control)
    mujoco.set_mjcb_act_gain(rows.actuator_gain if compiled is None else compiled.gain)
    mujoco.set_mjcb_act_bias(rows.actuator_bias if compiled is None else compiled.bias)
    log = mujoco.MjLogConfig.get()
    written = (log.logto_console, log.logto_file)
    # MuJoCo would print its warnings and append them to a file in the user's folder; the run reads its counters.
    _write_log(log, console=False, file=False)
    try:
        yield
    finally:
        _write_log(log, console=written[0], file=written[1])
        mujoco.set_mjcb_control(None)
        mujoco.set_mjcb_act_gain(None)
        mujoco.set_mjcb_act_bias(None)
        if compiled is not None:
            compiled.detach()


def _write_log(log: mujoco.MjLogConfig, *, console: bool, file: bool) -> None:
    """Switch where MuJoCo writes its messages."""
    log.logto_console, log.logto_file = console, file
    mujoco.MjLogConfig.set(log)


def compiled_rows(rows: Rows) -> CompiledRows | str:
    """The compiled callbacks of a simulation, verified against the Python form.

    Args:
        rows: of a prepared model, before the run; the callbacks share their records.

    Returns:
        The callbacks, or a sentence that says why the run has to do without them.
    """
    try:
        numba_module()
    except ImportError:
        return f"compiled callbacks need numba, which is missing (pip install numba); {SLOWER}"
    # A broken or unwritable installation of the compiler shows here, in many kinds of errors; none must stop a run.
    try:
        from vehicle.engines.simulation.compiled import CompiledRows

        probe = mujoco.MjData(rows.model)
        probe.time = rows.weights.timestep
        mujoco.mj_fwdPosition(rows.model, probe)
        compiled = CompiledRows(rows, probe)
    except Exception as error:
        return f"compiled callbacks are not available ({type(error).__name__}: {error}); {SLOWER}"
    structure = _structure(rows)
    if structure in PROVED:
        return compiled
    difference = _difference(rows, compiled)
    if not difference:
        PROVED.add(structure)
    return f"compiled callbacks gave another {difference} than the Python form; {SLOWER}" if difference else compiled


PROVED: set[bytes] = set()
"""Structures of cars for which this process has found both forms equal: a sweep need not prove each of its cars."""


def _structure(rows: Rows) -> bytes:
    """What the path through the compiled code depends on: sizes of all arrays, and all integers; not the numbers."""
    model, found = rows.model, hashlib.sha256()
    found.update(repr((model.nq, model.nv, model.nu, model.neq, model.ntendon, model.nbody)).encode())

    def take(value: Any) -> None:
        if isinstance(value, tuple):
            for entry in value:
                take(entry)
        elif isinstance(value, np.ndarray):
            found.update(repr((value.shape, value.dtype.str)).encode())
            for name in value.dtype.names or ():
                take(np.ascontiguousarray(value[name]))
            if value.dtype.kind in "bui":
                found.update(value.tobytes())
            elif value.dtype.kind == "f":
                found.update((value == 0.0).tobytes())
        elif isinstance(value, (int, bool)):
            found.update(repr(value).encode())

    take(tuple(rows.layout))
    return found.digest()


def _difference(rows: Rows, compiled: CompiledRows) -> str:
    """Name of the first value in which both forms differ in a moved state; empty where there is none."""
    expected, found = _evaluate(rows.anew(), None), _evaluate(rows, compiled)
    rows.reset()
    for name, value in expected.items():
        allowed = SOLVED if name == "qvel" else ROUND_OFF
        if not np.max(np.abs(found[name] - value), initial=0.0) <= allowed * np.max(np.abs(value), initial=0.0):
            return name
    return ""


def _evaluate(rows: Rows, compiled: CompiledRows | None) -> Values:
    """What the callbacks make of two moved states, one step apart, and the step makes of the second."""
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
            state.plate_acceleration[:, 2] = 1.0 - 3.0 * np.arange(len(state.plate_velocity))
            if compiled is None:
                mujoco.mj_step(model, data)
            else:
                compiled.step(data)
    values = {name: np.array(getattr(data, name)) for name in (*COMPARED, "qvel")}
    return values | {name: array.copy() for name, array in state._asdict().items()}
