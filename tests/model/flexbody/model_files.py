"""Valid files of body models in every format, and changes that make them invalid."""

from dataclasses import dataclass

import numpy as np
import scipy

from tests.model.flexbody.box_body import POSITIONS, box_fields, box_matrices
from tests.model.flexbody.modal_test import write_modes
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.flexbody.superelement_file import write_superelement

FRD = """    1C
    2C                             4                                     1
 -1         1 0.00000E+00 0.00000E+00 0.00000E+00
 -1         2 2.00000E+00 0.00000E+00 0.00000E+00
 -1         3 0.00000E+00 1.00000E+00 0.00000E+00
 -1         9-1.00000E+00-1.00000E+00-1.00000E+00
 -3
    1PGM                1.000000E+00
  100CL  107 2.50000E+01           4                     2    1MODAL       1
 -4  DISP        4    1
 -1         1 1.00000E-02 0.00000E+00 0.00000E+00
 -1         2-1.00000E-02 0.00000E+00 0.00000E+00
 -1         3 0.00000E+00 0.00000E+00 1.00000E-02
 -1         9 0.00000E+00 2.00000E-02 0.00000E+00
 -3
 9999
"""


def box(**changes):
    """Return a body with mass properties instead of node masses."""
    fields = box_fields()
    rigid = Superelement(**fields).rigid
    turns = {"corner_1": np.full((4, 3), 0.01)}
    return Superelement(**fields | {"node_mass": None, "mass_properties": rigid, "rotations": turns} | changes)


def write_all(folder):
    """Write a valid file in every format."""
    for suffix in ("toml", "npz"):
        write_superelement(folder / f"box.{suffix}", box())
    write_superelement(folder / "masses.toml", Superelement(**box_fields()))
    (folder / "modes.frd").write_text(FRD)
    write_modes(folder / "modes.uff")
    body = box_matrices()
    identity = [int(body.nodes[i]) for i in body.node]
    pairs = list(zip(identity, (body.direction + 1).tolist(), strict=True))
    nodes = [f"{name},{','.join(map(str, at))}" for name, at in zip(body.nodes, POSITIONS.tolist(), strict=True)]
    (folder / "job.inp").write_text("\n".join(["*NODE", *nodes, "*STEP"]) + "\n")
    (folder / "job.dof").write_text("".join(f"{node}.{direction}\n" for node, direction in pairs))
    (folder / "nodes.csv").write_text("\n".join(["node,x,y,z", *nodes]) + "\n")
    (folder / "dofs.csv").write_text("".join(f"{node},{direction}\n" for node, direction in pairs))
    (folder / "map.csv").write_text("point,node\nstrut_top_fr,1\n")
    both = {"K": body.stiffness, "M": body.mass}
    scipy.io.savemat(folder / "both.mat", both | {"text": "K", "complex": np.eye(48) * 1j})
    for (name, matrix), suffix in zip(both.items(), ("sti", "mas"), strict=True):
        scipy.io.mmwrite(folder / f"{name}.mtx", scipy.sparse.tril(matrix), symmetry="symmetric")
        entries = scipy.sparse.triu(matrix).tocoo()
        triples = list(zip(entries.row.tolist(), entries.col.tolist(), entries.data.tolist(), strict=True))
        (folder / f"job.{suffix}").write_text("".join(f"{i + 1} {j + 1} {value!r}\n" for i, j, value in triples))
        abaqus = "".join(f"{pairs[i][0]},{pairs[i][1]},{pairs[j][0]},{pairs[j][1]},{v!r}\n" for i, j, v in triples)
        (folder / f"{name}.txt").write_text(abaqus)


@dataclass
class Case:
    """Invalid model: file of the folder, change of the file, command, expected message and exit code."""

    file: str
    change: object
    arguments: tuple[str, ...]
    says: str
    code: int = 3


def text(old, new, count=1):
    def change(path):
        content = path.read_text()
        assert old in content, old
        path.write_text(content.replace(old, new, count))

    return change


def cut(share):
    return lambda path: path.write_bytes(path.read_bytes()[: int(share * path.stat().st_size)])


def holds(content):
    return lambda path: path.write_bytes(content)


def gone(path):
    path.unlink()


def nothing(path):
    assert path.is_file()


def line(start, new):
    """Replace the first line with a given beginning; None deletes the line."""

    def change(path):
        lines = path.read_text().splitlines()
        at = next(i for i, content in enumerate(lines) if content.startswith(start))
        path.write_text("\n".join([*lines[:at], *([] if new is None else [new]), *lines[at + 1 :]]) + "\n")

    return change


def scalar(key):
    """Replace the first multi-line list of a key by a number."""

    def change(path):
        before, _, after = path.read_text().partition(f"{key} = [\n")
        path.write_text(f"{before}{key} = 5\n{after.partition(chr(10) + ']' + chr(10))[2]}")

    return change


def array(**changes):
    """Replace arrays of an npz file; None deletes an array."""

    def change(path):
        with np.load(path) as file:
            content = dict(file)
        for name, value in changes.items():
            content[name] = value(content[name]) if callable(value) else value
        np.savez(path, **{name: value for name, value in content.items() if value is not None})

    return change


def shapes(change):
    def changed(path):
        table = box().shapes.copy()
        change(table)
        lines, rows = path.read_text().splitlines(), iter(table.reshape(-1, 3).tolist())
        inside = False
        for i, content in enumerate(lines):
            if inside and content != "]":
                lines[i] = f"  {next(rows)},"
            inside = content == "shape_per_sqrt_kg = [" or (inside and content != "]")
        path.write_text("\n".join(lines))

    return changed


def heave(table):
    table[0] = [0.0, 0.0, 0.06]


def twin(table):
    table[1] = -table[0]


def still(table):
    table[2] = 0.0


def larger(table):
    table *= 1000.0**0.5 * 10.0


def modes(**options):
    return lambda path: write_modes(path, **options)
