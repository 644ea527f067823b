"""Real finite elements: a car-size frame of solids that CalculiX computes, against what is imported of it."""

from __future__ import annotations

import re
import shutil
from collections import defaultdict

import numpy as np
import pytest
import scipy

from tests.flexbody import solid_frame
from vehicle.analysis.modal_assurance import mac
from vehicle.commands import body as command
from vehicle.errors import DataError
from vehicle.flexbody.sources.calculix import read_calculix
from vehicle.flexbody.sources.frd import read_frd
from vehicle.flexbody.sources.interfaces import interfaces
from vehicle.flexbody.sources.mode_shapes import normalised
from vehicle.flexbody.sources.reduction import free_modes
from vehicle.flexbody.sources.superelement_of import modes_of_matrices, superelement_of
from vehicle.flexbody.superelement_file import read_superelement
from vehicle.parameters.vehicle import load_vehicle

pytestmark = pytest.mark.skipif(shutil.which("ccx") is None, reason="needs CalculiX: apt-get install calculix-ccx")

SPREAD = 0.3  # one cell of the mesh


@pytest.fixture(scope="module")
def job(tmp_path_factory):
    folder = tmp_path_factory.mktemp("ccx")
    for name, matrices in (("stored", True), ("modes", False)):
        solid_frame.write_deck(folder / f"{name}.inp", matrices=matrices)
        solid_frame.run(folder, name)
    return folder


@pytest.fixture(scope="module")
def body(job):
    return read_calculix(job / "stored.sti")


@pytest.fixture(scope="module")
def places(body):
    return interfaces(body, load_vehicle(None).composition.attachments(), tolerance=1e-3, spread=SPREAD)


@pytest.fixture(scope="module")
def modes(body, places):
    return modes_of_matrices(body, 80.0, places)


def printed(job):
    """Frequencies as CalculiX prints them [Hz]."""
    rows = re.findall(r"^ +\d+ +(\S+) +\S+ +(\S+) +\S+$", (job / "modes.dat").read_text(), re.MULTILINE)
    return np.array([float(frequency) for _, frequency in rows][6:])


def test_frequencies_mass_and_rigid_motions(job, body, modes):
    want = printed(job)
    count = int(np.sum(want <= 80.0))
    assert count > 15 and len(modes.frequencies) == count
    np.testing.assert_allclose(modes.frequencies, want[:count], rtol=1e-6)  # seven digits are printed
    assert modes.rigid.mass == pytest.approx(solid_frame.mass(), rel=1e-12)
    motions = body.rigid_motions(modes.rigid.cog)
    assert np.abs(body.stiffness @ motions).max() < 1e-9 * (abs(body.stiffness) @ abs(motions)).max()
    assert free_modes(body, 80.0).orthogonality < 1e-9


@pytest.fixture(scope="module")
def accelerance(body, places):
    """-w^2 (K - w^2 M)^-1 of the full matrices at three points, 5 to 50 Hz: (w^2, point) to (3, 3)."""
    found = {}
    for frequency in np.linspace(5.0, 50.0, 10):
        square = float(2.0 * np.pi * frequency) ** 2
        factor = scipy.sparse.linalg.splu((body.stiffness - square * body.mass).tocsc())
        for place in places:
            if place.name in ("strut_top_fr", "hydromount", "arm_rear_fl"):
                found[square, place.name] = square * place.moved.T @ factor.solve(place.moved.toarray())
    return found


@pytest.mark.parametrize(
    ("up_to", "method", "allowed"),
    [(80.0, "free-free", 0.025), (120.0, "free-free", 0.01), (80.0, "rubin", 0.01)],
)
def test_driving_point_frf_of_modes_and_residual_against_the_matrices(
    body, places, accelerance, up_to, method, allowed
):
    """Accelerance up to 50 Hz by modes and residual; far worse without the residual.

    A mode at 81 Hz that answers statically is wrong by (50/81)^2 / (1 - (50/81)^2) = 60 % of its own share at 50 Hz,
    one at 121 Hz by 21 %. Modes of the attachments carry the mass of that share.
    """
    modes = modes_of_matrices(body, up_to, places, method)
    motions, _ = modes.rigid.rigid_motions(body.positions)
    rigid = np.zeros((len(body.node), 6))
    moving = body.direction < 3
    rigid[moving] = motions[:, body.node[moving], body.direction[moving]].T
    moved = {place.name: place.moved for place in places}
    total: dict[str, float] = defaultdict(float)
    wrong: dict[bool, dict[str, float]] = {True: defaultdict(float), False: defaultdict(float)}
    for (square, name), whole in accelerance.items():
        at, carried = moved[name].T @ modes.vectors, moved[name].T @ rigid
        reduced = (at / ((2.0 * np.pi * modes.frequencies) ** 2 - square)) @ at.T - carried @ carried.T / square
        total[name] += np.sum(whole**2)
        for with_residual in (True, False):
            found = square * (reduced + (modes.residual[name] if with_residual else 0.0))
            wrong[with_residual][name] += np.sum((found - whole) ** 2)
    with_it, without = (np.sqrt([wrong[kind][name] / total[name] for name in total]) for kind in (True, False))
    assert with_it.max() < allowed, with_it
    assert without.min() > (5.0 if method == "free-free" else 2.0) * with_it.max(), without


def test_modes_of_the_result_file_are_the_same(job, modes):
    found = normalised(read_frd(job / "modes.frd", 1.0), modes.rigid, None, 80.0)
    np.testing.assert_allclose(found.frequencies, modes.frequencies, rtol=1e-6)
    shapes = found.body.displacements(found.vectors)
    assert np.all(np.diag(mac(shapes, modes.body.displacements(modes.vectors))) > 1.0 - 1e-6)
    scale = np.linalg.norm(found.vectors, axis=0) / np.linalg.norm(modes.vectors, axis=0)
    np.testing.assert_allclose(scale, 1.0, rtol=1e-4)  # six digits in the file


def test_the_command_writes_the_model_and_lists_the_points(job, modes, places, tmp_path, capsys):
    output = tmp_path / "body.npz"
    options = ["import", str(job / "stored.sti"), "--spread", "300", "--up-to", "80", "--output", str(output)]
    assert command.main(options) == 0
    said = capsys.readouterr().out
    assert "points of the car" in said and "strut_top_fr" in said
    written = read_superelement(output)
    want = superelement_of(modes, places, name="stored", damping=0.02)
    np.testing.assert_array_equal(written.shapes, want.shapes)
    assert written.provenance == want.provenance
    assert command.main(options) == 2 and "exists" in capsys.readouterr().err
    assert command.main(["import", str(job / "stored.sti"), "--output", str(tmp_path / "b.npz")]) == 3
    assert "points of the car have no node within 1 mm; the nearest are" in capsys.readouterr().err


def test_a_support_is_refused(job, tmp_path):
    text = (job / "stored.inp").read_text().replace("*STEP", "*BOUNDARY\n1,1,3\n5,1,3\n9,1,3\n*STEP")
    (tmp_path / "held.inp").write_text(text)
    solid_frame.run(tmp_path, "held")
    with pytest.raises(DataError, match="rigid motions are held, at 1"):
        free_modes(read_calculix(tmp_path / "held.sti"), 80.0)


def test_expanded_shells_are_refused(tmp_path):
    """Shell elements are expanded to solids, with nodes of their own and constraints between them."""
    lines = ["*NODE,NSET=NALL"]
    lines += [f"{1 + i + 11 * j},{0.4 * i},{0.3 * j},{0.02 * i * j}" for j in range(6) for i in range(11)]
    lines += ["*ELEMENT,TYPE=S4,ELSET=EALL"]
    corners = [(1 + i + 11 * j, 2 + i + 11 * j, 13 + i + 11 * j, 12 + i + 11 * j) for j in range(5) for i in range(10)]
    lines += [f"{n},{','.join(map(str, own))}" for n, own in enumerate(corners, 1)]
    lines += ["*MATERIAL,NAME=S", "*ELASTIC", "2e11,0.3", "*DENSITY", "7800.", "*SHELL SECTION,ELSET=EALL,MATERIAL=S"]
    lines += ["0.002", "*STEP", "*FREQUENCY,SOLVER=MATRIXSTORAGE", "10", "*END STEP"]
    (tmp_path / "shell.inp").write_text("\n".join(lines) + "\n")
    solid_frame.run(tmp_path, "shell")
    with pytest.raises(DataError, match=r"150 so.*expands shells and beams"):
        read_calculix(tmp_path / "shell.sti")
