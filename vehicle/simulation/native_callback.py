"""MuJoCo's callbacks as compiled C functions: how they find their arrays, and that they meet only their own model.

`mjData.userdata` of a simulation holds the address of its table and a stamp. The table has a column for each array:
address (or offset of the pointer in mjData), rows and columns. The first columns hold the model and single offsets.
"""

from __future__ import annotations

import ctypes
import functools
import hashlib
from pathlib import Path
from typing import Any

import mujoco
import numba
import numpy as np

from vehicle.simulation.element_rows import EMPTY_ROW, ElementRows
from vehicle.simulation.native_arrays import Constants, Fields, Indices, State, constants_of, indices_of, share_state
from vehicle.simulation.native_fields import pointer_offsets, scalar_offsets, step_address, user_size_offset
from vehicle.simulation.native_pointer import field, float_table, floats, integer_table, integers, small_integer
from vehicle.simulation.native_rows import LOOSENED, rewrite

USER_SIZE = 2
"""Numbers of userdata that the callbacks need: address of the table, stamp."""

HEAD = 3
"""Column 0: model, number of rows; column 1: offsets of time and number of rows; column 2: velocity of the dampers."""
FIRST_INDEX = HEAD + len(Fields._fields)
FIRST_CONSTANT = FIRST_INDEX + len(Indices._fields)
FIRST_STATE = FIRST_CONSTANT + len(Constants._fields)
WIDTH = FIRST_STATE + len(State._fields)
VISCOUS = FIRST_CONSTANT + Constants._fields.index("viscous")


@functools.cache
def stamp() -> int:
    """A number that changes with the sources of the compiled form: the compiler's cache does not look across files."""
    digest = hashlib.sha256(repr((mujoco.__version__, np.__version__)).encode())
    for path in sorted(Path(__file__).parent.glob("native*.py")):
        digest.update(path.read_bytes())
    return int.from_bytes(digest.digest()[:6], "big")


def _fields(t: Any, data: int) -> Fields:
    """The fields of one mjData, in the order of their names."""
    return Fields(
        field(t, data, 3), field(t, data, 4), field(t, data, 5), field(t, data, 6), field(t, data, 7),
        field(t, data, 8), field(t, data, 9), field(t, data, 10), field(t, data, 11), field(t, data, 12),
        field(t, data, 13), field(t, data, 14), field(t, data, 15), field(t, data, 16), field(t, data, 17),
        field(t, data, 18),
    )  # fmt: skip


def _indices(t: Any, a: int) -> Indices:
    """The indices, in the order of their names."""
    return Indices(
        integer_table(t, a), integer_table(t, a + 1), integer_table(t, a + 2), integer_table(t, a + 3),
        integer_table(t, a + 4), integer_table(t, a + 5), integer_table(t, a + 6), integer_table(t, a + 7),
        integer_table(t, a + 8), integer_table(t, a + 9), integer_table(t, a + 10), integer_table(t, a + 11),
        integer_table(t, a + 12), integer_table(t, a + 13), integer_table(t, a + 14), integer_table(t, a + 15),
        integer_table(t, a + 16),
    )  # fmt: skip


def _constants(t: Any, a: int) -> Constants:
    """The constants, in the order of their names."""
    return Constants(
        float_table(t, a), float_table(t, a + 1), float_table(t, a + 2), float_table(t, a + 3),
        float_table(t, a + 4), float_table(t, a + 5), float_table(t, a + 6), float_table(t, a + 7),
        float_table(t, a + 8), float_table(t, a + 9), float_table(t, a + 10), float_table(t, a + 11),
        float_table(t, a + 12), float_table(t, a + 13), float_table(t, a + 14), float_table(t, a + 15),
        float_table(t, a + 16), float_table(t, a + 17), float_table(t, a + 18), float_table(t, a + 19),
        float_table(t, a + 20), float_table(t, a + 21), float_table(t, a + 22), float_table(t, a + 23),
        float_table(t, a + 24), float_table(t, a + 25), float_table(t, a + 26), float_table(t, a + 27),
        float_table(t, a + 28),
    )  # fmt: skip


def _state(t: Any, a: int) -> State:
    """The state, in the order of its names."""
    return State(
        float_table(t, a), float_table(t, a + 1), float_table(t, a + 2), float_table(t, a + 3),
        float_table(t, a + 4), float_table(t, a + 5), float_table(t, a + 6), float_table(t, a + 7),
        float_table(t, a + 8), float_table(t, a + 9), float_table(t, a + 10), float_table(t, a + 11),
        float_table(t, a + 12), float_table(t, a + 13), float_table(t, a + 14),
    )  # fmt: skip


def _table_address(model: int, data: int, user_size: int, user_data: int, mark: int) -> int:
    """Address of the table of the simulation that a callback is called for; 0 where the model is another's."""
    if integers(model + user_size, 1, 1)[0, 0] < USER_SIZE:
        return 0
    user = floats(integers(data + user_data, 1, 1)[0, 0], 1, USER_SIZE)
    if user[0, 1] != mark:
        return 0
    address = int(user[0, 0])
    return address if integers(address, 1, 1)[0, 0] == model else 0


table_address = numba.njit(_table_address)
fields_at, indices_at = numba.njit(_fields), numba.njit(_indices)
constants_at, state_at = numba.njit(_constants), numba.njit(_state)


@functools.cache
def compile_callbacks(user_size: int, user_data: int, mark: int) -> tuple[Any, Any, Any]:
    """Compile the callbacks for control, gain and bias.

    Args:
        user_size: offset of `nuserdata` in mjModel [bytes].
        user_data: offset of `userdata` in mjData [bytes].
        mark: the stamp. What these functions close over is part of the key of the compiler's cache.

    Returns:
        `mjcb_control`, `mjcb_act_gain`, `mjcb_act_bias` as C functions of numba, which live as long as the process.
    """

    def control(model: int, data: int) -> None:
        address = table_address(model, data, user_size, user_data, mark)
        if address == 0:
            return
        t = integers(address, 3, WIDTH)
        fields = fields_at(t, data)
        if small_integer(data + t[1, 1]) != t[1, 0]:
            # Other rows than those the table was made for: the guard of the run finds a state that is not finite.
            fields.qfrc_applied[:] = np.nan
            return
        time = floats(data + t[0, 1], 1, 1)[0, 0]
        constants, state = constants_at(t, FIRST_CONSTANT), state_at(t, FIRST_STATE)
        rewrite(time, fields, indices_at(t, FIRST_INDEX), constants, state)

    def gain(model: int, data: int, index: int) -> float:
        return 0.0

    def bias(model: int, data: int, index: int) -> float:
        address = table_address(model, data, user_size, user_data, mark)
        if address == 0:
            return 0.0
        t = integers(address, 3, WIDTH)
        force: float = -float_table(t, VISCOUS)[index, 0] * field(t, data, 2)[index, 0]
        return force

    word, number = numba.types.intp, numba.types.float64
    law = number(word, word, numba.types.int32)
    options = {"cache": True, "fastmath": LOOSENED, "boundscheck": False, "error_model": "numpy"}
    return (
        numba.cfunc(numba.types.void(word, word), **options)(control),
        numba.cfunc(law, **options)(gain),
        numba.cfunc(law, **options)(bias),
    )


class NativeCallback:
    """The compiled callbacks of one simulation, sharing the state of its element rows.

    Args:
        rows: element rows of a model with `nuserdata` of at least two; their state starts anew.
        probe: any state of that model after a forward evaluation.

    Raises:
        LookupError: the structures of MuJoCo are not as its declarations say, or the model has no user data.
    """

    def __init__(self, rows: ElementRows, probe: mujoco.MjData) -> None:
        model = rows.model
        if model.nuserdata < USER_SIZE:
            raise LookupError("mjModel.nuserdata, which is too small")
        time, count = scalar_offsets(probe)
        offsets = pointer_offsets(probe, (*Fields._fields, "actuator_velocity", "efc_force", "userdata"))
        shapes = _field_shapes(model, rows.elements.row_count)
        self.state = share_state(rows)
        self.arrays = (*indices_of(rows), *constants_of(rows, EMPTY_ROW), *self.state)
        table = np.zeros((3, WIDTH), dtype=np.int64)
        table[:, 0] = model._address, rows.elements.row_count, 0
        table[:, 1] = time, count, 0
        table[:, 2] = offsets["actuator_velocity"], model.nu, 1
        for column, name in enumerate(Fields._fields, start=HEAD):
            table[:, column] = offsets[name], *shapes[name]
        for column, array in enumerate(self.arrays, start=FIRST_INDEX):
            table[:, column] = array.ctypes.data, *array.shape
        self.table = table
        self.model = model
        self.attached: list[mujoco.MjData] = []
        self.offsets = offsets
        self.step_address = step_address()
        compiled = compile_callbacks(user_size_offset(model), offsets["userdata"], stamp())
        self.control, self.gain, self.bias = (function.ctypes for function in compiled)

    def attach(self, data: mujoco.MjData) -> None:
        """Let the callbacks act on a state of the model."""
        data.userdata[:USER_SIZE] = self.table.ctypes.data, stamp()
        self.attached.append(data)

    def detach(self) -> None:
        """Leave no address behind in a state."""
        for data in self.attached:
            data.userdata[:USER_SIZE] = 0.0
        self.attached.clear()

    def rewrite(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Rewrite the rows of an attached state, as `ElementRows.__call__` does."""
        self.control(model._address, data._address)

    def step(self, data: mujoco.MjData) -> None:
        """One step of an attached state, the way the compiled loop takes it."""
        ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)(self.step_address)(self.model._address, data._address)

    def reset(self) -> None:
        """Forget the past, as `ElementRows.reset` does."""
        for name, array in zip(State._fields, self.state, strict=True):
            if name not in ("plate_velocity", "plate_acceleration", "limits"):
                array[...] = 0.0
        self.state.last_time[...] = -1.0


def _field_shapes(model: mujoco.MjModel, count: int) -> dict[str, tuple[int, int]]:
    """Rows and columns of the fields."""
    row = dict.fromkeys((name for name in Fields._fields if name.startswith("efc_")), (count, 1))
    return row | {
        "qpos": (model.nq, 1),
        "qvel": (model.nv, 1),
        "xmat": (model.nbody, 9),
        "site_xpos": (model.nsite, 3),
        "site_xmat": (model.nsite, 9),
        "subtree_com": (model.nbody, 3),
        "cdof": (model.nv, 6),
        "efc_J": (count, model.nv),
        "efc_KBIP": (count, 4),
        "qfrc_applied": (1, model.nv),
    }
