"""MuJoCo's callbacks and the stepping loop as compiled code: how they find their records, and only their own model.

`mjData.userdata` of a simulation holds the address of its records, as the compiler holds them, and a stamp. This module
imports numba at its head: it is loaded only by a run that compiles.
"""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable
from typing import Any, get_type_hints

import mujoco
import numpy as np
import numpy.typing as npt
from llvmlite import ir

from vehicle.compiler import OPTIONS, numba_module, stamp
from vehicle.laws.damper import RECORD
from vehicle.laws.semi_active import SETTING
from vehicle.simulation.kernel import damper_force, rewrite
from vehicle.simulation.recorder import Recorder
from vehicle.simulation.records import Efc, Simulation, Ticket
from vehicle.simulation.rows import Rows
from vehicle.simulation.sampling import Order, Plates, Samples, Sources, keep_sample, move_plates
from vehicle.simulation.structures import pointer_offsets, scalar_offsets, step_address, user_size_offset

numba = numba_module()
types, intrinsic = numba.types, numba.extending.intrinsic

USER_SIZE = 2
"""Numbers of userdata that the callbacks need: address of the records, stamp."""

ARRAYS = {
    "Vector": numba.float64[::1],
    "Table": numba.float64[:, ::1],
    "Index": numba.int64[::1],
    "Indices": numba.int64[:, ::1],
    "Records": types.Array(numba.from_dtype(RECORD), 1, "C"),
    "Settings": types.Array(numba.from_dtype(SETTING), 1, "C"),
    "int": numba.int64,
    "float": numba.float64,
}


def record_type(record: Any) -> Any:
    """The compiler's type of a record of `vehicle.simulation.records`, from the words of its fields."""
    inner = {name: kind for name, kind in get_type_hints(record).items() if hasattr(kind, "_fields")}
    members = [
        record_type(inner[name]) if name in inner else ARRAYS[record.__annotations__[name].__forward_arg__]
        for name in record._fields
    ]
    return types.NamedTuple(members, record)


SIMULATION = record_type(Simulation)

OWNERS = 2
"""Pointers at the head of an array that say who owns it: read as none, for nobody counts references here."""


def _leaves(builder: Any, address: Any, kind: Any, value: Any, place: list[int]) -> Any:
    """Read (value None) or write a value of a kind at an address, 8 bytes a leaf; returns the value read."""
    if not isinstance(kind, ir.LiteralStructType | ir.ArrayType):
        where = builder.add(address, ir.Constant(ir.IntType(64), 8 * place[0]))
        place[0] += 1
        pointer = builder.inttoptr(where, kind.as_pointer())
        return builder.load(pointer) if value is None else builder.store(value, pointer)
    members = kind.elements if isinstance(kind, ir.LiteralStructType) else [kind.element] * kind.count
    found = ir.Constant(kind, ir.Undefined)
    for index, member in enumerate(members):
        part = None if value is None else builder.extract_value(value, index)
        inner = _leaves(builder, address, member, part, place)
        if index < OWNERS and isinstance(member, ir.PointerType):
            inner = ir.Constant(member, None)
        found = builder.insert_value(found, inner, index) if value is None else found
    return found


def _load_simulation(typing_context: Any, address: Any) -> Any:
    """The records at an address; somebody else keeps their arrays alive."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return _leaves(builder, arguments[0], context.get_value_type(SIMULATION), None, [0])

    return SIMULATION(types.int64), generate


def _store_simulation(typing_context: Any, address: Any, simulation: Any) -> Any:
    """Write records to an address and return their size [bytes]; at address 0 nothing is written."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        place = [0]
        kind = context.get_value_type(SIMULATION)
        with builder.if_then(builder.icmp_unsigned("!=", arguments[0], ir.Constant(ir.IntType(64), 0))):
            _leaves(builder, arguments[0], kind, arguments[1], place)
        return ir.Constant(ir.IntType(64), 8 * place[0])

    return types.int64(types.int64, SIMULATION), generate


def _address_as_void_pointer(typing_context: Any, address: Any) -> Any:
    """An integer address as a pointer."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], ir.IntType(8).as_pointer())

    return types.voidptr(types.int64), generate


def _call_step(typing_context: Any, function: Any, model: Any, data: Any) -> Any:
    """Call a C function `void f(mjModel*, mjData*)` that is known by its address."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        pointer = ir.IntType(8).as_pointer()
        kind = ir.FunctionType(ir.VoidType(), [pointer, pointer])
        target = builder.inttoptr(arguments[0], kind.as_pointer())
        builder.call(target, [builder.inttoptr(argument, pointer) for argument in arguments[1:]])
        return context.get_dummy_value()

    return types.void(types.int64, types.int64, types.int64), generate


load_simulation, store_simulation = intrinsic(_load_simulation), intrinsic(_store_simulation)
as_pointer, call_step = intrinsic(_address_as_void_pointer), intrinsic(_call_step)


@numba.njit
def words(address, size):  # type: ignore[no-untyped-def]
    """Whole numbers at an address."""
    return numba.carray(as_pointer(address), size, numba.int64)


@numba.njit
def vector(address, size):  # type: ignore[no-untyped-def]
    """Numbers at an address."""
    return numba.carray(as_pointer(address), size, numba.float64)


@numba.njit
def record_address(model, data, user_size, user_data, mark):  # type: ignore[no-untyped-def]
    """Address of the records of the simulation that a callback is called for; 0 where the model is another's."""
    if words(model + user_size, 1)[0] < USER_SIZE:
        return 0
    user = vector(words(data + user_data, 1)[0], USER_SIZE)
    if user[1] != mark:
        return 0
    address = int(user[0])
    return address if words(address, 1)[0] == model else 0


@numba.njit
def rows_at(data, t, velocities):  # type: ignore[no-untyped-def]
    """The fields over the rows, where they lie now."""
    n, o = t.rows, t.efc
    return Efc(
        vector(words(data + o[0], 1)[0], n * velocities).reshape(n, velocities),
        vector(words(data + o[1], 1)[0], 4 * n).reshape(n, 4),
        vector(words(data + o[2], 1)[0], n),
        vector(words(data + o[3], 1)[0], n),
        vector(words(data + o[4], 1)[0], n),
        vector(words(data + o[5], 1)[0], n),
        vector(words(data + o[6], 1)[0], n),
        vector(words(data + o[7], 1)[0], n),
    )


@functools.cache
def _callbacks(user_size: int, user_data: int, mark: int) -> tuple[Any, Any, Any, Any]:
    """`mjcb_control`, `mjcb_act_gain`, `mjcb_act_bias` as C functions, and what writes records to an address.

    They close over the offsets of `nuserdata` in mjModel and `userdata` in mjData and over the stamp, for these are the
    key of the compiler's cache.
    """

    def control(model: int, data: int) -> None:
        address = record_address(model, data, user_size, user_data, mark)
        if address == 0:
            return
        one = load_simulation(address)
        if numba.carray(as_pointer(data + one.ticket.row_count), 1, numba.int32)[0] != one.ticket.rows:
            # Other rows than those the records were made for: the guard of the run finds a state that is not finite.
            one.fields.qfrc_applied[:] = np.nan
            return
        efc = rows_at(data, one.ticket, one.fields.qvel.shape[0])
        rewrite(vector(data + one.ticket.time, 1)[0], one.fields, efc, one.layout, one.weights, one.state)

    def gain(model: int, data: int, index: int) -> float:
        return 0.0

    def bias(model: int, data: int, index: int) -> float:
        address = record_address(model, data, user_size, user_data, mark)
        if address == 0:
            return 0.0
        one = load_simulation(address)
        return damper_force(index, one.fields, one.layout, one.state)

    def store(address: int, simulation: Simulation) -> int:
        size: int = store_simulation(address, simulation) if mark else 0
        return size

    word = types.intp
    law = types.float64(word, word, types.int32)
    return (
        numba.cfunc(types.void(word, word), cache=True, **OPTIONS)(control),
        numba.cfunc(law, cache=True, **OPTIONS)(gain),
        numba.cfunc(law, cache=True, **OPTIONS)(bias),
        numba.njit(types.int64(types.int64, SIMULATION), cache=True, **OPTIONS)(store),
    )


@functools.cache
def _loop(mark: int) -> Any:
    """The compiled loop; `mark` makes the compiler's cache notice a change of the sources."""

    def advance(order: Order, first: int, last: int, row: int, plates: Plates, s: Sources, b: Samples) -> int:
        """Take the steps first..last and return the number of poses that were kept."""
        posed = 0 if mark else -1
        for index in range(first, last + 1):
            move_plates(index, plates)
            recorded = index % order.every == 0
            if recorded and (index // order.every) % order.pose_every == 0:
                b.poses[posed] = s.position
                posed += 1
            call_step(order.step, order.model, order.data)
            if recorded:
                # The constraint forces live in the arena, where each step may put them elsewhere.
                solved = vector(words(order.data + order.force_offset, 1)[0], b.solved.shape[1])
                keep_sample(row, order.half, order, s, solved, b)
                row += 1
        return posed

    return numba.njit(cache=True, nogil=True, boundscheck=False, error_model="numpy")(advance)


class CompiledRows:
    """The compiled callbacks of one simulation; they work on the records of its rows.

    Args:
        rows: of a model with `nuserdata` of at least two.
        probe: any state of that model after a forward evaluation.

    Raises:
        LookupError: MuJoCo's structures are not as declared, or the model has no user data.
    """

    def __init__(self, rows: Rows, probe: mujoco.MjData) -> None:
        model = rows.model
        if model.nuserdata < USER_SIZE:
            raise LookupError("mjModel.nuserdata, which is too small")
        self.rows, self.model = rows, model
        time, count = scalar_offsets(probe)
        names = [f"efc_{name}" for name in Efc._fields]
        self.offsets = pointer_offsets(probe, (*names, "efc_force", "userdata"))
        efc = np.array([self.offsets[name] for name in names], dtype=np.int64)
        self.ticket = Ticket(model._address, rows.layout.row_count, count, time, efc)
        self.attached: list[tuple[mujoco.MjData, Simulation, npt.NDArray[np.int64]]] = []
        self.step_address = step_address()
        *functions, self._store = _callbacks(user_size_offset(model), self.offsets["userdata"], stamp())
        self.control, self.gain, self.bias = (function.ctypes for function in functions)

    def attach(self, data: mujoco.MjData) -> None:
        """Let the callbacks act on a state of the model, with the present state of the rows."""
        rows = self.rows
        simulation = Simulation(self.ticket, rows.fields(data), rows.layout, rows.weights, rows.state)
        memory = np.zeros(self._store(0, simulation) // 8, dtype=np.int64)
        self._store(memory.ctypes.data, simulation)
        data.userdata[:USER_SIZE] = memory.ctypes.data, stamp()
        # The memory holds addresses of these arrays.
        self.attached.append((data, simulation, memory))

    def detach(self) -> None:
        """Leave no address behind in a state."""
        for data, _, _ in self.attached:
            data.userdata[:USER_SIZE] = 0.0
        self.attached.clear()

    def __call__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Rewrite the rows of an attached state."""
        self.control(model._address, data._address)

    def step(self, data: mujoco.MjData) -> None:
        """One step of an attached state, the way the compiled loop takes it."""
        ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)(self.step_address)(self.model._address, data._address)

    def loop(self, recorder: Recorder, plates: Plates) -> Callable[[int, int], int]:
        """What takes steps first..last of an attached state into a recorder and returns how many poses it kept."""
        order = recorder.order._replace(step=self.step_address, force_offset=self.offsets["efc_force"])
        compiled = _loop(stamp())

        def advance(first: int, last: int) -> int:
            return int(compiled(order, first, last, recorder.filled, plates, recorder.sources, recorder.buffers))

        # No step at all: compiling is no part of the time of the run.
        advance(1, 0)
        return advance
