"""Beam computed with ANSYS: matrices in the formats of ANSYS give the frequencies in its result file."""

from pathlib import Path

import numpy as np
import pytest
import scipy

from tests.validation import validated
from vehicle.errors import DataError
from vehicle.model.flexbody.sources.free_body_modes import free_modes
from vehicle.model.flexbody.sources.matrix_files import read_matrices

DATA = Path(__file__).parents[2] / "data" / "ansys" / "beam.npz"
INCH, SLINCH = 0.0254, 175.126835
LABELS = ("UX", "UY", "UZ")


def harwell_boeing(path, matrix):
    """Write a matrix like HBMAT: Fortran formats, D exponents, column by column."""
    lower = matrix.tocsc()
    lower.sort_indices()
    blocks = []
    for values, form, each in (
        (lower.indptr + 1, "{:10d}", 8),
        (lower.indices + 1, "{:10d}", 8),
        (lower.data, "{:26.16E}", 3),
    ):
        fields = [form.format(value) for value in values.tolist()]
        blocks.append(["".join(fields[i : i + each]) for i in range(0, len(fields), each)])
    counts = [len(block) for block in blocks]
    size = matrix.shape[0]
    head = [f"{'Matrix as written by HBMAT':<72}{'KEY':<8}"]
    head += ["".join(f"{n:14d}" for n in (sum(counts), *counts, 0))]
    head += [f"{'RSA':<14}" + "".join(f"{n:14d}" for n in (size, size, lower.nnz, 0))]
    head += [f"{'(8I10)':<16}{'(8I10)':<16}{'(3D26.16)':<20}{'':<20}"]
    path.write_text("\n".join([*head, *blocks[0], *blocks[1], *(row.replace("E", "D") for row in blocks[2])]) + "\n")


@pytest.fixture(scope="module")
def export(tmp_path_factory):
    """Write Matrix Market, Harwell-Boeing, mapping and nodes of the beam; return the frequencies of ANSYS [Hz]."""
    folder = tmp_path_factory.mktemp("ansys")
    held = np.load(DATA)
    size = 3 * len(held["node"])
    # The order of the equations is arbitrary; here reversed.
    equations = [(int(node), label) for node in held["node"] for label in LABELS][::-1]
    for name in ("stiffness", "mass"):
        row, column = (size - 1 - held[f"{name}_{axis}"].astype(int) for axis in ("row", "column"))
        matrix = scipy.sparse.coo_matrix((held[name], (row, column)), shape=(size, size))
        harwell_boeing(folder / f"{name}.matrix", matrix)
        scipy.io.mmwrite(folder / f"{name}.mtx", matrix, symmetry="symmetric", precision=17)
    lines = [f"{i:10d}{node:10d}   {label}" for i, (node, label) in enumerate(equations, 1)]
    (folder / "beam.mapping").write_text("\n".join(["Matrix Eqn      Node  DOF", *lines]) + "\n")
    nodes = zip(held["node"], held["position"].astype(float).tolist(), strict=True)
    (folder / "nodes.csv").write_text("\n".join(f"{node},{x},{y},{z}" for node, (x, y, z) in nodes) + "\n")
    return folder, held["frequency"]


@pytest.mark.parametrize("suffix", ["mtx", "matrix"])
def test_the_six_modes_of_ansys_to_its_digits(export, suffix):
    folder, want = export
    body = read_matrices(
        folder / f"stiffness.{suffix}", folder / f"mass.{suffix}", folder / "beam.mapping", folder / "nodes.csv"
    ).scaled(INCH, SLINCH)
    modes = free_modes(body, 21000.0)
    assert want[0] == pytest.approx(7366.495, abs=5e-4)
    # Sixteen digits in the result file; the entries of K were kept to 1e-14 of the largest, which is worth 2e-11.
    validated(
        "Body models", f"six frequencies of a beam, matrices of ANSYS as .{suffix}", modes.frequencies, want, rel=1e-10,
        unit="Hz", source="foreign code: ANSYS, frequencies of its result file",
    )  # fmt: skip
    volume, density = 5.0 * INCH**3, 4.1408e-4 * SLINCH / INCH**3  # titanium
    validated(
        "File readers", f"mass of a beam, matrices of ANSYS as .{suffix}", modes.rigid.mass, volume * density, rel=1e-9,
        unit="kg", source="closed form: volume times density",
    )  # fmt: skip


@pytest.mark.parametrize(("file", "old", "new", "said"), [
    ("stiffness.matrix", "RSA", "RZA", r"type is RZA .* RSA or RUA \(real"),
    ("stiffness.matrix", "(8I10)", "(what)", "is not a Fortran format of numbers"),
    ("stiffness.matrix", "(3D26.16)", "(3D25.16)", "cannot be read as a Harwell-Boeing"),
    ("beam.mapping", "UX\n", "TEMP\n", "found 'TEMP'; a row must be equation"),
    ("beam.mapping", "        10", "        11", "equations must be 1 to 963 in"),
])  # fmt: skip
def test_broken_exports_are_refused(export, tmp_path, file, old, new, said):
    folder, _ = export
    for source in folder.iterdir():
        (tmp_path / source.name).symlink_to(source)
    (tmp_path / file).unlink()
    (tmp_path / file).write_text((folder / file).read_text().replace(old, new, 1))
    names = ("stiffness.matrix", "mass.matrix", "beam.mapping", "nodes.csv")
    with pytest.raises(DataError, match=said):
        read_matrices(*(tmp_path / name for name in names))
