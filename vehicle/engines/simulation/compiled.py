"""Compiled code of MuJoCo's callbacks and of the stepping loop.

`mjData.userdata` of a simulation contains the address of its records in compiled form and a stamp. The callbacks act on
a state only if the stamp and the address of the model match. Import this module lazily: it imports numba.
"""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt
from llvmlite import ir

from vehicle.compiler import OPTIONS, numba_module, stamp
from vehicle.engines.simulation.element_records import copy_row
from vehicle.engines.simulation.kernel import damper_force, rewrite
from vehicle.engines.simulation.predicted_acceleration import predict_acceleration
from vehicle.engines.simulation.record_pointers import at, packed
from vehicle.engines.simulation.rows import Rows
from vehicle.engines.simulation.sampling import Loop, keep_sample, move_plates
from vehicle.engines.simulation.sparse_rows import Mask, nonzero_columns, solution_of, sparse_rows
from vehicle.engines.simulation.step_records import Efc, Simulation, SparseRows, Ticket
from vehicle.engines.simulation.structures import offsets
from vehicle.errors import SimulationError
from vehicle.model.laws.function_address import address_as_pointer

numba = numba_module()
types, intrinsic = numba.types, numba.extending.intrinsic

USER_SIZE = 2
"""Length of the userdata that the callbacks read: address of the records, stamp."""


def _call_step(typing_context: Any, function: Any, model: Any, data: Any) -> Any:
    """Call a C function `void f(mjModel*, mjData*)` by its address."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        pointer = ir.IntType(8).as_pointer()
        signature_type = ir.FunctionType(ir.VoidType(), [pointer, pointer])
        target = builder.inttoptr(arguments[0], signature_type.as_pointer())
        builder.call(target, [builder.inttoptr(argument, pointer) for argument in arguments[1:]])
        return context.get_dummy_value()

    return types.void(types.int64, types.int64, types.int64), generate


simulation_at, loop_at = at(Simulation), at(Loop)
as_pointer, call_step = intrinsic(address_as_pointer), intrinsic(_call_step)


@numba.njit
def words(address, size):  # type: ignore[no-untyped-def]
    """Return an array of 64-bit integers at an address."""
    return numba.carray(as_pointer(address), size, numba.int64)


@numba.njit
def vector(address, size):  # type: ignore[no-untyped-def]
    """Return an array of 64-bit floats at an address."""
    return numba.carray(as_pointer(address), size, numba.float64)


@numba.njit
def record_address(model, data, user_size, user_data, mark):  # type: ignore[no-untyped-def]
    """Return the address of the records of a simulation; 0 for a model without records."""
    if words(model + user_size, 1)[0] < USER_SIZE:
        return 0
    user = vector(words(data + user_data, 1)[0], USER_SIZE)
    if user[1] != mark:
        return 0
    address = int(user[0])
    return address if words(address, 1)[0] == model else 0


@numba.njit
def integers_at(address, size):  # type: ignore[no-untyped-def]
    """Return an array of 32-bit integers at an address."""
    return numba.carray(as_pointer(address), size, numba.int32)


@numba.njit
def jacobian_at(data, t, velocities):  # type: ignore[no-untyped-def]
    """Return all columns of the rows: those of mjData if dense, else a copy."""
    n, s = t.rows, t.sparse
    if s.jacobian.shape[0] == 0:
        return vector(words(data + t.efc[0], 1)[0], n * velocities).reshape(n, velocities)
    counts, starts = integers_at(words(data + s.offsets[0], 1)[0], n), integers_at(words(data + s.offsets[1], 1)[0], n)
    size = starts[n - 1] + counts[n - 1]
    columns, values = (
        integers_at(words(data + s.offsets[3], 1)[0], size),
        vector(words(data + s.offsets[4], 1)[0], size),
    )
    for row in range(n):
        for entry in range(starts[row], starts[row] + counts[row]):
            s.jacobian[row, columns[entry]] = values[entry]
    return s.jacobian


@numba.njit
def store_sparse(data, s):  # type: ignore[no-untyped-def]
    """Make MuJoCo use the nonzero columns of the rewritten rows."""
    flat = s.jacobian.reshape(-1)
    for entry in range(s.values.shape[0]):
        s.values[entry] = flat[s.places[entry]]
    for pointer in range(s.offsets.shape[0]):
        address = words(data + s.offsets[pointer], 1)
        s.replaced[pointer], address[0] = address[0], s.addresses[pointer]
    size = integers_at(data + s.size, 1)
    s.replaced[-1], size[0] = size[0], s.values.shape[0]


@numba.njit
def rows_at(data, t, velocities):  # type: ignore[no-untyped-def]
    """Return the fields of mjData over the rows at their present addresses."""
    n, o = t.rows, t.efc
    return Efc(
        jacobian_at(data, t, velocities),
        vector(words(data + o[1], 1)[0], 4 * n).reshape(n, 4),
        vector(words(data + o[2], 1)[0], n),
        vector(words(data + o[3], 1)[0], n),
        vector(words(data + o[4], 1)[0], n),
        vector(words(data + o[5], 1)[0], n),
        vector(words(data + o[6], 1)[0], n),
        vector(words(data + o[7], 1)[0], n),
    )


@contextmanager
def compiler_settings() -> Iterator[None]:
    """Set the optimisation level of the compiler to 1, with vector operations for neighbouring sums.

    Level 1 takes four fifths of the compiling time of level 3, and a step takes the same time within 2 %. Vector
    operations for the four sums of a tile halve the time of the factorisation.
    """
    config = numba.config
    before = config.OPT, config.SLP_VECTORIZE
    config.OPT, config.SLP_VECTORIZE = type(config.OPT)(1), 1
    try:
        yield
    finally:
        config.OPT, config.SLP_VECTORIZE = before


@functools.cache
def _callbacks(user_size: int, user_data: int, mark: int) -> tuple[Any, Any, Any]:
    """Compile `mjcb_control`, `mjcb_act_gain` and `mjcb_act_bias` as C functions.

    The functions close over the offsets of `nuserdata` in mjModel and `userdata` in mjData and over the stamp, because
    closure values are the key of the compiler's cache.
    """

    def control(model: int, data: int) -> None:
        address = record_address(model, data, user_size, user_data, mark)
        if address == 0:
            return
        simulation = simulation_at(address)
        if numba.carray(as_pointer(data + simulation.ticket.row_count), 1, numba.int32)[0] != simulation.ticket.rows:
            # The number of rows differs from the records: make the state invalid, so that the run stops.
            simulation.fields.qfrc_applied[:] = np.nan
            return
        efc = rows_at(data, simulation.ticket, simulation.fields.qvel.shape[0])
        rewrite(
            vector(data + simulation.ticket.time, 1)[0],
            simulation.fields,
            efc,
            simulation.layout,
            simulation.weights,
            simulation.state,
        )
        if simulation.solution.size > 0:
            predict_acceleration(simulation.fields, efc, simulation.layout, simulation.state, simulation.solution)
            store_sparse(data, simulation.ticket.sparse)

    def gain(model: int, data: int, index: int) -> float:
        return 0.0

    def bias(model: int, data: int, index: int) -> float:
        address = record_address(model, data, user_size, user_data, mark)
        if address == 0:
            return 0.0
        simulation = simulation_at(address)
        return damper_force(index, simulation.fields, simulation.layout, simulation.state)

    word = types.intp
    law = types.float64(word, word, types.int32)
    with compiler_settings():
        return (
            numba.cfunc(types.void(word, word), cache=True, **OPTIONS)(control),
            numba.cfunc(law, cache=True, **OPTIONS)(gain),
            numba.cfunc(law, cache=True, **OPTIONS)(bias),
        )


@functools.cache
def _loop(mark: int) -> Any:
    """Compile the stepping loop; `mark` invalidates the compiler's cache after a change of the sources."""

    def advance(address: int, first: int, last: int, row: int) -> int:
        """Take the steps first..last and return the number of stored poses."""
        loop = loop_at(address)
        order, s, b = loop.order, loop.sources, loop.samples
        posed = 0 if mark else -1
        for index in range(first, last + 1):
            move_plates(index, loop.plates)
            recorded = index % order.every == 0
            if recorded and (index // order.every) % order.pose_every == 0:
                copy_row(b.poses[posed], s.position)
                posed += 1
            call_step(order.step, order.model, order.data)
            if recorded:
                # The constraint forces are in the arena, at an address that may change in each step.
                solved = vector(words(order.data + order.force_offset, 1)[0], b.solved.shape[1])
                keep_sample(row, order.half, order, s, solved, b)
                row += 1
        return posed

    word = types.int64
    with compiler_settings():
        return numba.njit(word(word, word, word, word), cache=True, nogil=True, **OPTIONS)(advance)


def restore_rows(data: mujoco.MjData, s: SparseRows) -> None:
    """Return MuJoCo's own rows to a state after a run; the arrays of the car may be deleted then."""
    pointers = [ctypes.c_int64.from_address(data._address + int(offset)) for offset in s.offsets]
    if pointers and [pointer.value for pointer in pointers] == s.addresses.tolist():
        for pointer, address in zip(pointers, s.replaced[:-1], strict=True):
            pointer.value = int(address)
        ctypes.c_int32.from_address(data._address + s.size).value = int(s.replaced[-1])


class CompiledRows:
    """Compiled callbacks of a simulation, working on the records of its rows.

    Args:
        rows: rows of a model with `nuserdata` of at least two.

    Raises:
        MissingPartError: a structure of MuJoCo differs from its declaration.
        SimulationError: the model has no user data.
    """

    def __init__(self, rows: Rows) -> None:
        model = rows.model
        if model.nuserdata < USER_SIZE:
            raise SimulationError(f"the model has {model.nuserdata} user data, compiled callbacks need {USER_SIZE}")
        self.rows, self.model, self.offsets = rows, model, offsets()
        located = self.offsets
        self.attached: list[tuple[mujoco.MjData, Simulation, npt.NDArray[np.int64], tuple[object, ...]]] = []
        functions = _callbacks(located.user_size, located.pointers["userdata"], stamp())
        self.control, self.gain, self.bias = (function.ctypes for function in functions)

    def attach(self, data: mujoco.MjData, *, sparse: bool = False) -> None:
        """Make the callbacks act on a state of the model, with the present state of the rows.

        Args:
            data: the state.
            sparse: until `detach`, store the rows in MuJoCo's sparse format and solve for the acceleration of each
                step; for runs. Otherwise MuJoCo's rows are dense, for code that reads them.
        """
        rows, model, located = self.rows, self.model, self.offsets
        nonzero: Mask | None = None
        if sparse:
            model.opt.jacobian = mujoco.mjtJacobian.mjJAC_SPARSE
            nonzero = nonzero_columns(model, rows.layout)
        record, pattern = sparse_rows(nonzero, located)
        solution = solution_of(model, rows.layout, nonzero)
        efc = np.array([located.pointers[f"efc_{name}"] for name in Efc._fields], dtype=np.int64)
        ticket = Ticket(model._address, rows.layout.row_count, located.row_count, located.time, efc, record)
        simulation = Simulation(ticket, rows.fields(data), rows.layout, rows.weights, rows.state, solution)
        memory = packed(simulation)
        data.userdata[:USER_SIZE] = memory.ctypes.data, stamp()
        # Keep references: the memory contains addresses of these arrays.
        self.attached.append((data, simulation, memory, pattern))

    def detach(self) -> None:
        """Clear the addresses in all attached states, and let MuJoCo store rows dense again."""
        for data, simulation, *_ in self.attached:
            data.userdata[:USER_SIZE] = 0.0
            restore_rows(data, simulation.ticket.sparse)
        self.model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        self.attached.clear()

    def __call__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Rewrite the rows of an attached state."""
        self.control(model._address, data._address)

    def step(self, data: mujoco.MjData) -> None:
        """Take a step of an attached state by the address of `mj_step`, like the compiled loop."""
        step = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)(self.offsets.step)
        step(self.model._address, data._address)

    def loop(self, loop: Loop) -> Callable[[int, int, int], int]:
        """Return the function that takes the steps first..last of an attached state.

        Args:
            loop: records of the run; this method sets the addresses in `loop.order`.

        Returns:
            Function of the first and the last step and of the first row in the buffers; it returns the number of
            stored poses.
        """
        order = loop.order._replace(step=self.offsets.step, force_offset=self.offsets.pointers["efc_force"])
        compiled, loop = _loop(stamp()), loop._replace(order=order)
        memory = packed(loop)

        def advance(first: int, last: int, row: int) -> int:
            # The closure keeps the arrays alive whose addresses the memory contains.
            return int(compiled(memory.ctypes.data, first, last, row)) if loop else 0

        # Compile now, with an empty range of steps, so that the measured time of the run excludes it.
        advance(1, 0, 0)
        return advance
