"""Process-wide callbacks of MuJoCo: compiled for a run, in Python for single states; installed for one model only."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import mujoco

from vehicle.engines.simulation.rows import Rows
from vehicle.errors import MissingPartError, SimulationError

if TYPE_CHECKING:
    from vehicle.engines.simulation.compiled import CompiledRows


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


def compiled_rows(rows: Rows) -> CompiledRows:
    """Return the compiled callbacks of a simulation.

    Args:
        rows: rows of a prepared model, before the run; the callbacks work on their records.

    Returns:
        The callbacks, attached to no state yet.

    Raises:
        MissingPartError: numba cannot be imported, or the installed MuJoCo does not fit its declarations.
    """
    try:
        from vehicle.engines.simulation.compiled import CompiledRows
    except ImportError as error:
        raise MissingPartError(
            f"a run needs numba, which cannot be imported ({error}); install it: pip install --force-reinstall numba"
        ) from None
    return CompiledRows(rows)
