"""Callbacks of the core on the records of a simulation, and its stepping loop."""

import ctypes
from typing import Any

import mujoco

from vehicle.core.records import Packed, packed
from vehicle.engines.simulation.rows import Rows
from vehicle.engines.simulation.simulation_record import functions, packed_simulation
from vehicle.engines.simulation.sparse_rows import Pattern
from vehicle.engines.simulation.structures import offsets
from vehicle.errors import SimulationError

USER_SIZE = 2
"""Length of the userdata that the callbacks read: address of the records, mark."""

_STEP = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)


class CompiledRows:
    """Callbacks of the core in a simulation: C functions that MuJoCo calls without Python.

    Args:
        rows: rows of a model with `nuserdata` of at least two.

    Raises:
        MissingPartError: there is no core, or a structure of MuJoCo differs from its declaration.
        SimulationError: the model has no user data.
    """

    def __init__(self, rows: Rows) -> None:
        if rows.model.nuserdata < USER_SIZE:
            raise SimulationError(
                f"the model has {rows.model.nuserdata} entries of user data; the compiled callbacks need {USER_SIZE}"
            )
        self.rows, self.model = rows, rows.model
        self.attached: list[tuple[mujoco.MjData, Packed]] = []
        self.library = functions()
        self.control, self.gain = self.library.core_control_d, self.library.core_gain_d
        self.bias = self.library.core_bias_d

    def attach(self, data: mujoco.MjData, *, sparse: bool = False) -> None:
        """Make the callbacks act on a state of the model, with the present state of the rows.

        Args:
            data: the state.
            sparse: until `detach`, store the rows in MuJoCo's sparse format and solve for the acceleration of each
                step; for runs. Otherwise MuJoCo's rows are dense, for code that reads them.
        """
        pattern = None
        if sparse:
            self.model.opt.jacobian = mujoco.mjtJacobian.mjJAC_SPARSE
            pattern = Pattern.of(self.model, self.rows.layout)
        record = packed_simulation(self.rows, data, pattern)
        self.library.core_attach_d(record.address, data._address)
        self.attached.append((data, record))

    def detach(self) -> None:
        """Take the records from all attached states, give them MuJoCo's own rows back, and store rows dense again."""
        for data, record in self.attached:
            self.library.core_detach_d(record.address, data._address)
        self.model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        self.attached.clear()

    def __call__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Rewrite the rows of an attached state."""
        self.control(model._address, data._address)

    def step(self, data: mujoco.MjData) -> None:
        """Take a step of an attached state by the address of `mj_step`, like the loop."""
        _STEP(offsets().step)(self.model._address, data._address)


class SteppingLoop:
    """Plates, steps and samples of a run in the core."""

    def __init__(self, **loop: Any) -> None:
        self.record = packed("Loop", loop)
        self.library = functions()

    def move_plates(self, index: int) -> None:
        """Set the plate heights of a step, and the plate motion of the tyre rows."""
        self.library.core_set_plates_d(self.record.address, index)

    def keep_sample(self, row: int, half: float) -> None:
        """Store forces, rates and positions of the present time in a row of the buffers.

        MuJoCo's velocity is that of the middle of a step: `half`, minus half a step after a step and half a step after
        an evaluation [s], times the acceleration extrapolates to the present.
        """
        self.library.core_keep_row_d(self.record.address, row, half)

    def advance(self, first: int, last: int, row: int) -> int:
        """Take the steps first..last, with samples from a row of the buffers on; return the number of stored poses."""
        return int(self.library.core_run_steps_d(self.record.address, first, last, row))
