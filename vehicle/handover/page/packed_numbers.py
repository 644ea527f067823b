"""Numbers of a car and samples of a track as compressed text for a page.

The file of a car consists of words of 8 bytes. A run of words is stored with its most significant bytes alone, rounded:
4 bytes of a double have a relative error of at most 2^-21, 3 bytes of 2^-13, 2 bytes of 2^-5. The bytes of equal
significance are stored together, so that signs and exponents compress.
"""

import base64
import zlib
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.engines.reduced.table_layout import BLOCK
from vehicle.handover.fmu.car_numbers import CarNumbers
from vehicle.signals.analysis.samples import Vector

WORD, PARTS = 8, 4
"""Size of a word [byte]; words of a row of a table."""

EXACT, SHORT = 8, 4
"""Bytes of a coefficient of the car of the run, and of further cars."""

CANCELLING = 5
"""Bytes of a coefficient of outputs and mean plate velocities of further cars, whose terms cancel: 4 bytes give errors
of 0.1 % of the lateral acceleration of the seat rail of `focus_road`, 5 bytes of 0.001 %."""

START = 3
"""Bytes of a coefficient of the states at rest of further cars, in which the plates hardly move."""

COARSE = {EXACT: 3, SHORT: 2}
"""Bytes of a coefficient of watched quantities and of the moving picture, for each of these. Measured for `focus_road`:
errors of 0.01 % and 3 % of the peak."""

ALPHABET = bytes.maketrans(b"<", b",")
"""Change of the letters of base 85: a page needs no escape for them."""

ORDERS = range(2, 7)
"""Orders of the differences of heights; the order with the shortest text is taken."""

LEVELS = 32767
"""Maximum integer of a height in the page: steps of 1/32767 of the peak, 90 dB below it."""


def text(content: bytes) -> str:
    """Return compressed bytes as text: deflate, then base 85 with "," for "<"."""
    return base64.b85encode(zlib.compress(content, 9)).translate(ALPHABET).decode()


def byte_runs(numbers: CarNumbers, coarse_outputs: int, *, exact: bool) -> list[tuple[int, int, int]]:
    """Return the runs of words of the numbers of a car: count, bytes of each word, and how often it is there.

    Factors of the poles, effects of the forces, and rows of outputs are rounded; all else stays exact.

    Args:
        coarse_outputs: number of outputs at the end that are stored with `COARSE`.
        exact: all other coefficients in double precision; otherwise with the bytes of further cars.
    """
    short, cancelling = (EXACT, EXACT) if exact else (SHORT, CANCELLING)
    cars, sizes = numbers.table, np.full(len(numbers.content) // WORD, WORD)

    def of(path: str) -> npt.NDArray[np.int_]:
        """Return the sizes of the words of an array."""
        offset, size = numbers.extents[path]
        return sizes[offset // WORD :][: size // WORD]

    for path in ("start", "sensor_start", "rows", "by_force", "by_slope", "by_law"):
        of(path)[:] = short
    of("start")[:] = EXACT if exact else START
    # Inputs of the poles: damper forces, their slopes, scalar elements, z' and mean z' of the plates, then others.
    before = 2 * cars.dampers + len(cars.cars[0].strokes) + cars.plates
    poles = of("march.poles").reshape(-1, 1 + cars.inputs + cars.sums, BLOCK * PARTS)
    poles[:] = short
    poles[:, 1 + before :][:, : cars.plates] = cancelling
    table, rows = of("march.table").reshape(-1, PARTS), cars.rows
    table[rows["slip"] : rows["full"]] = table[rows["direct"] : rows["rest"]] = short
    outputs = of("rows").reshape(-1, cars.states * PARTS)
    outputs[: len(numbers.outputs)] = cancelling
    outputs[len(numbers.outputs) - coarse_outputs :] = COARSE[short]
    # The parts of a row of the table are equal, except for sums over the poles.
    times = np.ones_like(sizes)
    offset = numbers.extents["march.table"][0] // WORD
    parts = np.frombuffer(numbers.content, dtype="<u8")[offset:][: table.size].reshape(-1, PARTS)
    times[offset:][: table.size] = np.repeat(np.where(np.all(parts == parts[:, :1], axis=1), PARTS, 1), PARTS)
    ends = [*(np.flatnonzero(np.diff(sizes) | np.diff(times)) + 1).tolist(), len(sizes)]
    return [
        ((end - begin) // int(times[begin]), int(sizes[begin]), int(times[begin]))
        for begin, end in zip([0, *ends], ends, strict=False)
    ]


def packed(content: bytes, runs: Sequence[tuple[int, int, int]]) -> dict[str, Any]:
    """Return words as text for the page.

    Args:
        content: the words.
        runs: see `byte_runs`, of all words in their order.
    """
    integers_of_words = np.frombuffer(content, dtype="<u8")
    offsets = np.cumsum([0, *(count * times for count, _, times in runs)])
    planes = []
    for first, last, (_, size, times) in zip(offsets, offsets[1:], runs, strict=False):
        rounded = integers_of_words[first:last:times]
        if size < WORD:
            rounded = rounded + np.uint64(1 << (8 * (WORD - size) - 1))
        parts = np.ascontiguousarray(rounded).view(np.uint8).reshape(-1, WORD)
        planes.append(parts[:, WORD - size :].T.tobytes())
    return {"text": text(b"".join(planes)), "runs": [list(run) for run in runs]}


def integers(values: Vector) -> tuple[npt.NDArray[np.int16], float]:
    """Return heights as integers, and the step of the integers [m]."""
    step = float(np.max(np.abs(values), initial=0.0)) / LEVELS or 1.0
    return np.rint(values / step).astype("<i2"), step


def track(values: Vector) -> dict[str, Any]:
    """Return the heights of a track: step [m], and differences of the integers modulo 2^16, low bytes first."""
    samples, step = integers(values)
    texts = {}
    for order in ORDERS:
        changes = np.diff(samples, order, prepend=np.zeros(order, dtype="<i2"))
        texts[order] = text(changes.view(np.uint8).reshape(-1, 2).T.tobytes())
    order = min(texts, key=lambda order: len(texts[order]))
    return {"step": step, "order": order, "changes": texts[order]}
