"""Read datasets 55 and 2414 of a universal file: normal and complex mode shapes at nodes.

Source: Universal File Datasets, University of Cincinnati SDRL, datasets 55 and 2414.
"""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from vehicle.signals.formats.geometry import ModeShape
from vehicle.signals.formats.uff_blocks import check_values, numbers, refuse, text_of, wholes
from vehicle.signals.formats.uff_function import KINDS
from vehicle.signals.formats.uff_geometry import Nodes, Units

NORMAL, COMPLEX = (2,), (3, 7)
"""Analysis types of modes: normal, and complex of first or second order."""

VECTORS = {2: 3, 3: 6}
"""Data characteristic -> number of components per node: translations, or translations and rotations."""


def read_shape(path: Path, number: int, where: str, lines: list[bytes], nodes: Nodes, units: Units) -> ModeShape | str:
    """Read a dataset of results at nodes as a mode shape in global axes.

    Returns:
        Mode shape, or the description of a result other than a mode.
    """
    try:
        return _shape(path, where, _head55(lines) if number == 55 else _head2414(lines), nodes, units)
    except (ValueError, IndexError, KeyError) as error:
        refuse(path, where, error)


_Head = tuple[str, list[int], int, float, float, Mapping[str, complex], list[bytes]]
"""Name; six type numbers; mode number; frequency [Hz]; damping ratio; masses; lines of the values."""


def _head55(lines: list[bytes]) -> _Head:
    type_numbers, counts = wholes(lines[5]), wholes(lines[6])
    mode = counts[3] if type_numbers[1] in (*NORMAL, *COMPLEX) else 0
    real: list[float] = []
    index = 7
    while len(real) < counts[1]:
        real += numbers([lines[index]])
        index += 1
    name = text_of(lines[3]) or text_of(lines[0])
    if type_numbers[1] in COMPLEX:
        pole = complex(real[0], real[1])
        masses = {"a": complex(real[2], real[3])} if len(real) > 3 else {}
        return name, type_numbers, mode, *_pole(pole), masses, lines[index:]
    real += [0.0] * 4
    return name, type_numbers, mode, real[0], real[2] or 0.5 * real[3], {"m": real[1]}, lines[index:]


def _head2414(lines: list[bytes]) -> _Head:
    location, type_numbers = wholes(lines[2])[0], wholes(lines[8])
    if location != 1:
        type_numbers[1] = 0  # not at nodes: stresses, element forces
    mode = wholes(lines[9])[5]
    real, name = numbers(lines[11:13]) + [0.0] * 12, text_of(lines[1]) or text_of(lines[3])
    if type_numbers[1] in COMPLEX:
        return name, type_numbers, mode, *_pole(complex(real[6], real[7])), {"a": complex(real[8], real[9])}, lines[13:]
    return name, type_numbers, mode, real[1], real[4] or 0.5 * real[5], {"m": real[3]}, lines[13:]


def _pole(pole: complex) -> tuple[float, float]:
    """Return natural frequency [Hz] and damping ratio of a pole in rad/s."""
    size = abs(pole)
    return size / (2.0 * np.pi), (-pole.real / size if size > 0.0 else 0.0)


def _shape(path: Path, where: str, head: _Head, nodes: Nodes, units: Units) -> ModeShape | str:
    name, type_numbers, mode, frequency, damping, masses, lines = head
    _, analysis, characteristic, result, data_type, count = type_numbers[:6]
    if analysis not in (*NORMAL, *COMPLEX) or characteristic not in VECTORS or data_type not in (2, 4, 5, 6):
        return f"result of analysis {analysis} and characteristic {characteristic}"
    if count != VECTORS[characteristic]:
        raise ValueError(
            f"{count} values per node instead of {VECTORS[characteristic]} for data characteristic {characteristic}"
        )
    width = count * (2 if data_type > 4 else 1)
    labels, rows, index = [], [], 0
    body = [line for line in lines if line.strip()]
    while index < len(body):
        (label,) = wholes(body[index])
        index += 1
        row: list[float] = []
        while len(row) < width:
            row += numbers([body[index]])
            index += 1
        if len(row) > width:
            raise ValueError(f"{len(row)} numbers at node {label} instead of {width}")
        labels.append(label)
        rows.append(row)
    if not rows:
        return "mode without nodes"
    table = np.array(rows)
    check_values(path, where, np.append(table.ravel(), (frequency, damping)))
    if frequency < 0.0:
        raise ValueError(f"frequency {frequency:g} Hz")
    values = table[:, 0::2] + 1j * table[:, 1::2] if data_type > 4 else table.astype(complex)
    shape = np.zeros((len(labels), 6), dtype=complex)
    for row_number, label in enumerate(labels):
        axes = nodes.directions(label)
        shape[row_number, :3] = axes @ values[row_number, :3]
        if count == 6:
            shape[row_number, 3:] = units.length * (axes @ values[row_number, 3:])
    return ModeShape(
        number=mode,
        frequency=frequency,
        damping_ratio=damping,
        modal_mass=float(masses.get("m", 0.0).real) / units.mass,
        modal_a=masses.get("a", 0j),
        points=tuple(str(label) for label in labels),
        shape=shape,
        name=name,
        is_complex=analysis in COMPLEX,
        quantity=KINDS.get(result, ""),
    )
