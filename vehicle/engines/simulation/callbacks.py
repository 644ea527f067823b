"""Process-wide callbacks of MuJoCo, installed for one model only.

A run has functions of the core in their place; single states have Python functions, which call the core and let errors
through.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import mujoco

from vehicle.engines.simulation.damper_force import fill_sensors
from vehicle.engines.simulation.rows import Rows
from vehicle.errors import SimulationError
from vehicle.model.laws.law_exceptions import exceptions_of_laws

if TYPE_CHECKING:
    from vehicle.engines.simulation.compiled import CompiledRows


@contextmanager
def installed(rows: Rows, compiled: CompiledRows | None = None) -> Iterator[Callable[[], None]]:
    """Install the callbacks of one simulation for the time of a `with` block.

    Callbacks are global to the process. Installing them while others are installed is an error, they act on a single
    model, and they are removed at the end of the block.

    Args:
        rows: rows of the model that is stepped inside the block.
        compiled: callbacks of the core, installed in place of the Python functions; they act on attached states, and
            are detached from them at the end.

    Yields:
        Function that raises the first exception in a law of the user, see `exceptions_of_laws`.

    Raises:
        SimulationError: other callbacks are installed already, or a law of the user raised an exception.
    """
    if mujoco.get_mjcb_control() is not None:
        raise SimulationError(
            "mjcb_control is taken by another simulation in this process; finish it first, or use "
            "a process for each simulation"
        )

    def control(model: mujoco.MjModel, data: mujoco.MjData) -> None:
        if model is rows.model or model._address == rows.model._address:
            rows(model, data)

    # A run switches sensors off, so that its steps never enter Python.
    def sensors(model: mujoco.MjModel, data: mujoco.MjData, stage: int) -> None:
        if model is rows.model or model._address == rows.model._address:
            fill_sensors(rows, data, stage)

    mujoco.set_mjcb_control(control if compiled is None else compiled.control)
    mujoco.set_mjcb_act_gain(rows.actuator_gain if compiled is None else compiled.gain)
    mujoco.set_mjcb_act_bias(rows.actuator_bias if compiled is None else compiled.bias)
    mujoco.set_mjcb_sensor(sensors)
    log = mujoco.MjLogConfig.get()
    written = (log.logto_console, log.logto_file)
    # MuJoCo would print warnings and append them to a file in the working folder; the run reads the counters instead.
    _write_log(log, console=False, file=False)
    try:
        with exceptions_of_laws() as check_laws:
            yield check_laws
    finally:
        _write_log(log, console=written[0], file=written[1])
        mujoco.set_mjcb_control(None)
        mujoco.set_mjcb_act_gain(None)
        mujoco.set_mjcb_act_bias(None)
        mujoco.set_mjcb_sensor(None)
        if compiled is not None:
            compiled.detach()


def standing_data(rows: Rows) -> mujoco.MjData:
    """Return a state of a car in its design position, evaluated with its rows."""
    data = mujoco.MjData(rows.model)
    with installed(rows):
        mujoco.mj_forward(rows.model, data)
    return data


def _write_log(log: mujoco.MjLogConfig, *, console: bool, file: bool) -> None:
    """Switch the console and file output of MuJoCo's messages."""
    log.logto_console, log.logto_file = console, file
    mujoco.MjLogConfig.set(log)
