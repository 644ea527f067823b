"""Matrices punched by Nastran: DMIG in three formats, nodes as GRID, and rejected files."""

import re
from dataclasses import replace

import numpy as np
import pytest
import scipy

from tests.model.flexbody.box_body import box_matrices
from tests.validation import validated
from vehicle.commands import body as command
from vehicle.errors import DataError
from vehicle.model.flexbody.sources.matrix_files import read_matrices

HEAD = {"small": "DMIG    {:<8}       0       6       2       0", "free": "DMIG,{},0,6,2,0"}
HEAD["large"] = HEAD["small"]  # as a punch file has it
"""Form 6, symmetric: one triangle; type 2, real of double precision."""


def body():
    """Return the box with rotational inertia, so that the matrices have no zero row."""
    box = box_matrices()
    inertia = scipy.sparse.diags(np.where(box.direction < 3, 0.0, 0.01))
    return replace(box, mass=(box.mass + inertia).tocsc())


def dmig(name, box, matrix, form):
    """Format a triangle of a matrix as DMIG, column by column."""
    lines = [HEAD[form].format(name)]
    lower = scipy.sparse.tril(matrix).tocsc()
    at = [(int(box.nodes[node]), int(axis) + 1) for node, axis in zip(box.node, box.direction, strict=True)]
    for column in range(len(at)):
        entries = range(lower.indptr[column], lower.indptr[column + 1])
        rows = [(*at[lower.indices[i]], float(lower.data[i])) for i in entries]
        if not rows:
            continue
        node, axis = at[column]
        if form == "large":
            lines.append(f"{'DMIG*':<8}{name:<16}{node:16d}{axis:16d}")
            lines += [f"{'*':<8}{n:16d}{a:16d}{value:16.9E}".replace("E", "D") for n, a, value in rows]
            lines[-1] = f"{lines[-1]:<72}      17"  # columns after the 72nd are a line number
        elif form == "free":
            fields = [f"{n},{a},{value!r}," for n, a, value in rows]
            lines.append(f"DMIG,{name},{node},{axis},,{fields[0]}")
            lines += ["," + ",".join(fields[i : i + 2]) for i in range(1, len(fields), 2)]
        else:
            fields = [f"{n:8d}{a:8d}{small(value)}{'':8}" for n, a, value in rows]
            lines.append(f"DMIG    {name:<8}{node:8d}{axis:8d}{'':8}{fields[0]}")
            lines += [f"{'':8}{''.join(fields[i : i + 2])}" for i in range(1, len(fields), 2)]
    return lines


def small(value):
    """Format a real number in 8 columns without the E of its exponent: -1.234+5."""
    mantissa, exponent = f"{value:.3E}".split("E")
    return f"{mantissa}{int(exponent):+d}".rjust(8)


def grids(box, form="free"):
    nodes = zip(box.nodes, box.positions.tolist(), strict=True)
    if form == "large":
        return [line for n, (x, y, z) in nodes for line in (f"GRID   *{n:>16}{0:16d}{x:16}{y:16}", f"{'*':<8}{z:16}")]
    return [f"GRID,{node},,{x!r},{y!r},{z!r}" for node, (x, y, z) in nodes]


def punch(path, form):
    box = body()
    lines = ["$ stiffness and mass", *grids(box, form), *dmig("KAAX", box, box.stiffness, form)]
    path.write_text("\n".join([*lines, *dmig("MAAX", box, box.mass, form), ""]))
    return path


@pytest.mark.parametrize(("form", "digits"), [("free", 1e-15), ("large", 1e-9), ("small", 1e-3)])
def test_both_matrices_come_from_one_file(tmp_path, form, digits):
    box = body()
    matrices = read_matrices(punch(tmp_path / "job.pch", form), None, None, None)
    order = [
        int(np.flatnonzero((box.node == box.nodes.index(matrices.nodes[n])) & (box.direction == axis))[0])
        for n, axis in zip(matrices.node, matrices.direction, strict=True)
    ]
    for name in ("stiffness", "mass"):
        mine, theirs = getattr(matrices, name), getattr(box, name)[order][:, order]
        validated(
            "File readers", f"{name} matrix of a Nastran punch file, {form} fields", mine.toarray(), theirs.toarray(),
            peak=digits, source="second derivation: the matrix that was written, by the digits of the format",
        )  # fmt: skip
    np.testing.assert_array_equal(matrices.positions, box.positions)
    assert "Nastran, K and M of job.pch" in matrices.source


def test_nodes_and_names_may_be_given(tmp_path):
    path = punch(tmp_path / "job.pch", "free")
    (tmp_path / "job.bdf").write_text("\n".join(["BEGIN BULK", *grids(body()), "ENDDATA"]) + "\n")
    text = path.read_text().replace("DMIG,KAAX", "DMIG,KGG")
    path.write_text("\n".join(line for line in text.splitlines() if not line.startswith("GRID")) + "\n")
    matrices = read_matrices(tmp_path / "job.pch:KGG", tmp_path / "job.pch:MAAX", None, tmp_path / "job.bdf")
    assert len(matrices.node) == 48
    with pytest.raises(DataError, match="DMIG matrices KGG, MAAX, must be two"):
        read_matrices(tmp_path / "job.pch:KAAX", None, None, tmp_path / "job.bdf")
    with pytest.raises(DataError, match="nodes of the matrices have no position in the list of nodes; the first"):
        read_matrices(path, None, None, None)


@pytest.mark.parametrize(("old", "new", "message"), [
    ("DMIG,KAAX,0,6,2", "DMIG,KAAX,0,9,2", "KAAX is another matrix: the matrix form is 9 but must be 6"),
    ("DMIG,KAAX,0,6,2", "DMIG,KAAX,0,6,4", "the number type is 4 but must be 1 or 2 (real)"),
    ("DMIG,KAAX,0,6,2,0\n", "", "matrix column comes before the header line of its"),
    ("DMIG,KAAX,1,1,,1,1,", "DMIG,KAAX,1,1,,1,0,", "component 0 of 1, must be 1 to 6. Component 0 is a scalar"),
    ("DMIG,KAAX,1,1,,1,1,", "DMIG,KAAX,1,1,,1,1,x", "could not convert string to float"),
    ("DMIG,KAAX,1,1,,1,1,", "DMIG,KAAX,1,1,,1,1,inf,,1,2,", "inf is not finite"),
    ("DMIG,KAAX,1,2,", "DMIG,KAAX,1,1,", "occurs twice"),
    ("GRID,1,,", "GRID,1,7,", "position is in coordinate system 7"),
])  # fmt: skip
def test_broken_punch_files_are_refused(tmp_path, old, new, message):
    path = punch(tmp_path / "job.pch", "free")
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(DataError, match=re.escape(message)):
        read_matrices(path, None, None, None)


LOAD = f"""\
DMIG    PAX            0       9       2       0                       1
DMIG*   PAX             {1:16d}{1:16d}
*       {1:16d}{3:16d} 1.000000000D+00
"""


@pytest.mark.parametrize("head", ["9       2", "2       2", "6       3"])
def test_a_matrix_of_another_form_beside_k_and_m_is_not_read(tmp_path, head):
    path = punch(tmp_path / "job.pch", "large")
    plain = read_matrices(path, None, None, None)
    path.write_text(path.read_text() + LOAD.replace("9       2", head))
    with_load = read_matrices(path, None, None, None)
    np.testing.assert_array_equal(with_load.stiffness.toarray(), plain.stiffness.toarray())
    with pytest.raises(DataError, match=r"found DMIG matrices KAAX, MAAX, .* PAX is another matrix: the"):
        read_matrices(path.with_name("job.pch:PAX"), None, None, None)


@pytest.mark.parametrize("support", [0.0, 1e6])
def test_ten_digits_of_a_stiff_element_are_no_support(tmp_path, support):
    """An element of 3.1e12 N/m along x between two nodes; entries of ten digits leave a rigid motion some N/m.

    A spring to the ground of 1 MN/m is refused: its stiffness is above that of the rounding.
    """
    box = body()
    direction = box.positions[1] - box.positions[0]
    axis = int(np.argmax(np.abs(direction)))
    ends = [int(np.flatnonzero((box.node == node) & (box.direction == axis))[0]) for node in (0, 1)]
    element = scipy.sparse.lil_matrix(box.stiffness.shape)
    element[np.ix_(ends, ends)] = np.pi * 1e12 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    element[ends[0], ends[0]] += support
    stiff = replace(box, stiffness=(box.stiffness + element).tocsc())
    lines = [*grids(box, "large"), *dmig("KAAX", box, stiff.stiffness, "large"), *dmig("MAAX", box, box.mass, "large")]
    (tmp_path / "job.pch").write_text("\n".join([*lines, ""]))
    matrices = read_matrices(tmp_path / "job.pch", None, None, None)
    assert matrices.rounding == pytest.approx(0.5e-9)
    rigid = matrices.mass_properties()
    found, limit = matrices.rigid_frequency(rigid), matrices.rounding_frequency(rigid)
    if support:
        with pytest.raises(DataError, match="the body is not free"):
            matrices.require_free(found, 20.0, limit)
    else:
        with pytest.raises(DataError, match="the body is not free"):
            matrices.require_free(found, 20.0)
        matrices.require_free(found, 20.0, limit)


def test_the_command_reads_a_punch_file(tmp_path, capsys):
    path = punch(tmp_path / "job.pch", "large")
    arguments = ["import", str(path), "--up-to", "60", "--output", str(tmp_path / "body.toml")]
    assert command.main(arguments) == 3
    assert "points of the car have no node of the body within" in capsys.readouterr().err
