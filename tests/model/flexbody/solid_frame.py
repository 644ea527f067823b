"""A car-size frame of solid elements with point masses, as an input deck of CalculiX."""

import itertools
import subprocess

from tests.patience import HANG

CELL = 0.3
NX, NY, NZ = 13, 5, 5
DENSITY, POINT_MASS = 100.0, 16.4
CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
MIDDLES = [(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)]
MIDDLES += [(0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]


def bar(first, last):
    """Return the cells of a straight bar between two cells."""
    return itertools.product(*(range(min(a, b), max(a, b) + 1) for a, b in zip(first, last, strict=True)))


def cells():
    occupied = set()
    for j in (0, NY - 1):
        occupied |= {*bar((0, j, 0), (NX - 1, j, 0)), *bar((3, j, NZ - 1), (NX - 1, j, NZ - 1))}
        occupied |= {cell for i in (0, 1, 3, 8, NX - 1) for cell in bar((i, j, 0), (i, j, 2 if i < 3 else NZ - 1))}
        occupied |= {*bar((0, j, 2), (3, j, 2))}
    occupied |= {cell for i in (0, 1, 2, 3, 5, 6, 8, 10, NX - 1) for cell in bar((i, 0, 0), (i, NY - 1, 0))}
    occupied |= {cell for i in (3, 8, NX - 1) for cell in bar((i, 0, NZ - 1), (i, NY - 1, NZ - 1))}
    occupied |= {cell for i in (0, 1, 3) for cell in bar((i, 0, 2), (i, NY - 1, 2))}
    occupied |= {cell for i in range(NX) for cell in bar((i, 0, 0), (i, NY - 1, 0))}  # floor
    occupied |= {cell for j in (0, NY - 1) for k in range(3) for cell in bar((0, j, k), (2, j, k))}  # aprons
    occupied |= {cell for k in range(3) for cell in bar((3, 0, k), (3, NY - 1, k))}  # bulkhead
    return sorted(occupied)


def mesh():
    """Return node positions in half cells -> node number from 1, and elements of twenty nodes."""
    nodes: dict[tuple[int, ...], int] = {}
    elements = []
    for cell in cells():
        positions = [tuple(2 * c + d for c, d in zip(cell, corner, strict=True)) for corner in CORNERS + MIDDLES]
        elements.append([nodes.setdefault(position, len(nodes) + 1) for position in positions])
    return nodes, elements


def mass():
    nodes, elements = mesh()
    return len(elements) * CELL**3 * DENSITY + len(range(0, len(nodes), 41)) * POINT_MASS


def write_deck(path, modulus=1.7e8, matrices=True):
    """Write the deck in m, kg and N, to store K and M (`matrices`) or to compute modes."""
    nodes, elements = mesh()
    lines = ["*NODE,NSET=NALL"]
    for (i, j, k), number in nodes.items():
        x, y, z = 0.35 + i * CELL / 2, (j - NY) * CELL / 2, 0.42 + k * CELL / 2
        lines.append(f"{number},{x:.6f},{y:.6f},{z:.6f}")
    lines.append("*ELEMENT,TYPE=C3D20,ELSET=EALL")
    for number, element_nodes in enumerate(elements, 1):
        lines += [f"{number},{','.join(map(str, element_nodes[:10]))},", ",".join(map(str, element_nodes[10:]))]
    lines.append("*ELEMENT,TYPE=MASS,ELSET=POINTS")
    heavy = list(nodes.values())[::41]
    lines += [f"{len(elements) + i},{node}" for i, node in enumerate(heavy, 1)]
    lines += ["*MASS,ELSET=POINTS", f"{POINT_MASS}", "*MATERIAL,NAME=FOAM", "*ELASTIC", f"{modulus:g},0.3"]
    lines += ["*DENSITY", f"{DENSITY}", "*SOLID SECTION,ELSET=EALL,MATERIAL=FOAM", "*STEP"]
    lines += [f"*FREQUENCY{',SOLVER=MATRIXSTORAGE' if matrices else ''}", "40", "*NODE FILE", "U", "*END STEP"]
    path.write_text("\n".join(lines) + "\n")


def run(folder, name):
    """Run CalculiX on a deck; on failure, show the end of its output."""
    done = subprocess.run(["ccx", name], cwd=folder, capture_output=True, text=True, timeout=HANG)
    assert "Job finished" in done.stdout, done.stdout[-2000:]
