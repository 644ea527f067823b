"""Modes from a result file of CalculiX (.frd, text): nodes, elements and displacements of `*FREQUENCY`."""

from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.model.flexbody.sources.body_matrices import BodyNodes
from vehicle.model.flexbody.sources.deck import LINES
from vehicle.model.flexbody.sources.mode_shapes import GivenModes
from vehicle.model.flexbody.sources.text_matrices import text_of

_CORNERS = {1: 8, 4: 8, 2: 6, 5: 6, 3: 4, 6: 4}
"""Element type number of the format -> number of corners."""


def read_frd(path: Path, length: float, mass: float = 1.0) -> GivenModes:
    """Read the modes at all nodes of a job.

    Args:
        path: result file.
        length: unit of length of the job [m].
        mass: unit of mass of the job [kg].

    Raises:
        DataError: the file has no frequency step, is truncated, or is binary.

    Source: G. Dhondt, CalculiX CrunchiX user's manual, "Format of the frd file"; fields of twelve columns.
    """
    lines = text_of(path, "; write *NODE FILE, not *NODE OUTPUT").splitlines()
    positions: dict[int, list[float]] = {}
    edges: set[tuple[int, int]] = set()
    shapes: list[dict[int, list[float]]] = []
    frequencies: list[float] = []
    masses: list[float] = []
    block, head, corners, generalised, value = "", "", 0, np.nan, np.nan
    element: list[int] = []
    try:
        for line in lines:
            if line.startswith("    2C"):
                block = "nodes"
            elif line.startswith("    3C"):
                block = "elements"
            elif line.startswith("    1PGM"):
                generalised = float(line[24:].split()[0])
            elif line.startswith("  100C"):
                block, head, value = "", line, float(line[12:24])
            elif line.startswith(" -4"):
                block = "shape" if line[5:13].strip() == "DISP" and "MODAL" in head else ""
                if block:
                    frequencies.append(value)
                    masses.append(mass * generalised)
                    shapes.append({})
            elif line.startswith(" -3"):
                block = ""
            elif line.startswith(" -1") and block == "nodes":
                positions[int(line[3:13])] = [float(line[i : i + 12]) for i in (13, 25, 37)]
            elif line.startswith(" -1") and block == "elements":
                corners, element = _CORNERS.get(int(line[13:18]), 0), []
            elif line.startswith(" -2") and block == "elements":
                element += [int(word) for word in line[3:].split()]
                if corners and len(element) >= corners:
                    edges |= {tuple(sorted((element[a], element[b]))) for a, b in LINES[corners]}  # type: ignore[misc]
                    corners = 0
            elif line.startswith(" -1") and block == "shape":
                shapes[-1][int(line[3:13])] = [float(line[i : i + 12]) for i in (13, 25, 37)]
    except (ValueError, IndexError) as error:
        raise DataError(f"{path}: {line[:60]!r} is not a line of a result file ({error}).") from error
    if not shapes:
        raise DataError(f"{path}: contains no modes; write *NODE FILE with U in a *FREQUENCY step.")
    if not lines or lines[-1].strip() != "9999" or any(len(shape) != len(shapes[0]) for shape in shapes):
        raise DataError(
            f"{path}: is truncated; the job did not end, or the file was copied only in part. Run the job again, "
            "or copy the file again."
        )
    numbers = sorted(shapes[0])
    unplaced = [number for number in numbers if number not in positions]
    if unplaced:
        raise DataError(f"{path}: node {unplaced[0]} of the modes has no position. Write all nodes.")
    index = {number: i for i, number in enumerate(numbers)}
    count = len(numbers)
    return GivenModes(
        body=BodyNodes(
            nodes=tuple(map(str, numbers)),
            positions=length * np.array([positions[number] for number in numbers]),
            node=np.repeat(np.arange(count), 3),
            direction=np.tile(np.arange(3), count),
            edges=np.array([(index[a], index[b]) for a, b in sorted(edges) if a in index and b in index], dtype=int),
            source=f"modes of {path.name} (CalculiX)",
        ),
        frequencies=np.array(frequencies),
        damping_ratio=np.full(len(shapes), np.nan),
        vectors=np.array([[shape[number] for number in numbers] for shape in shapes]).reshape(len(shapes), -1).T,
        modal_mass=np.array(masses),
    )
