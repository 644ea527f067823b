"""A record in words of 64 bits: what compiled code finds at the addresses in it."""

from __future__ import annotations

import ctypes
import struct
from typing import Any, NamedTuple

import numpy as np
import pytest

from vehicle.engines.simulation import record_pointers as pointers
from vehicle.engines.simulation.element_records import Indices, Table, Vector


class Inner(NamedTuple):
    """A record inside another."""

    place: int
    rows: Indices


class Outer(NamedTuple):
    """Numbers, arrays, and a record between them."""

    number: int
    step: float
    values: Vector
    inner: Inner
    table: Table


def outer(**other: Any) -> Outer:
    """A record whose arrays have no equal sizes."""
    inner = Inner(place=-7, rows=np.arange(6).reshape(3, 2))
    return Outer(number=3, step=-0.1, values=np.array([1.5, 2.5, 3.5]), inner=inner, table=np.ones((2, 4)))._replace(
        **other
    )


def array_in(words: list[int], kind: Any, dimensions: int) -> tuple[Any, list[int]]:
    """The array that the next words describe, read from memory, and the words behind it."""
    (*owners, size, item, address), rest = words[:5], words[5:]
    shape, strides, rest = rest[:dimensions], rest[dimensions : 2 * dimensions], rest[2 * dimensions :]
    assert owners == [0, 0] and item == 8 and size == np.prod(shape)
    memory = memoryview((ctypes.c_char * (item * size)).from_address(address))
    return np.ndarray(shape, dtype=kind, buffer=memory, strides=strides), rest


def test_a_record_is_read_back_from_its_words():
    record = outer()
    number, step, *words = pointers.packed(record).tolist()
    assert number == 3 and struct.unpack("d", struct.pack("q", step)) == (-0.1,)
    values, words = array_in(words, np.float64, 1)
    place, *words = words
    rows, words = array_in(words, np.int64, 2)
    table, words = array_in(words, np.float64, 2)
    assert place == -7 and not words
    assert np.array_equal(values, record.values) and np.array_equal(rows, record.inner.rows)
    assert np.array_equal(table, record.table)
    record.values[1] = 9.0  # the memory of the record itself, not a copy
    assert values[1] == 9.0


@pytest.mark.parametrize(
    ("name", "array"),
    [
        ("values", np.zeros(3, dtype=np.float32)),
        ("values", np.zeros((3, 1))),
        ("values", np.zeros(6)[::2]),
        ("table", np.zeros((4, 2)).T),
        ("table", np.zeros((2, 4), dtype=np.int64)),
    ],
)
def test_an_array_of_another_kind_is_refused(name, array):
    with pytest.raises(TypeError, match=rf"Outer\.{name}"):
        pointers.packed(outer(**{name: array}))


def test_a_record_inside_is_asked_too():
    rows: Any = np.zeros((3, 2))
    with pytest.raises(TypeError, match=r"Inner\.rows"):
        pointers.packed(outer(inner=Inner(place=0, rows=rows)))
