"""MuJoCo's process-wide callbacks, installed for one model and always removed again."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import mujoco

from vehicle.errors import SimulationError
from vehicle.simulation.element_rows import ElementRows

if TYPE_CHECKING:
    from vehicle.simulation.native_callback import NativeCallback


def _write_log(log: mujoco.MjLogConfig, *, console: bool, file: bool) -> None:
    """Switch where MuJoCo writes its messages."""
    log.logto_console, log.logto_file = console, file
    mujoco.MjLogConfig.set(log)


@contextmanager
def installed(rows: ElementRows, native: NativeCallback | None = None) -> Iterator[None]:
    """Install the callbacks of one simulation for the time of a `with` block.

    Callbacks are global to the process: they are refused while others are installed, they check which model calls
    them, and they never outlive the block, so that no other model meets them.

    Args:
        rows: element laws of the model that will be stepped inside the block.
        native: their compiled form, to be installed instead; it acts on the states that it is attached to,
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

    mujoco.set_mjcb_control(control if native is None else native.control)
    mujoco.set_mjcb_act_gain(rows.actuator_gain if native is None else native.gain)
    mujoco.set_mjcb_act_bias(rows.actuator_bias if native is None else native.bias)
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
        if native is not None:
            native.detach()
