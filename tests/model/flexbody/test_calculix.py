"""Finite elements: a car-size frame of solids computed by CalculiX, against the imported body."""

import re
import shutil
from collections import defaultdict
from dataclasses import replace

import numpy as np
import pytest
import scipy

from tests.model.flexbody import solid_frame
from tests.validation import validated
from vehicle.commands import body as command
from vehicle.errors import DataError
from vehicle.model.flexbody.sources.body_units import units_of
from vehicle.model.flexbody.sources.calculix import read_calculix
from vehicle.model.flexbody.sources.frd import read_frd
from vehicle.model.flexbody.sources.free_body_modes import free_modes
from vehicle.model.flexbody.sources.interfaces import interfaces
from vehicle.model.flexbody.sources.mode_shapes import normalised
from vehicle.model.flexbody.sources.superelement_of import modes_of_matrices, superelement_of
from vehicle.model.flexbody.superelement_file import read_superelement
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.signals.analysis.modal_assurance import mac

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
def attachments(body):
    return interfaces(body, load_vehicle(None).composition.attachments(), tolerance=1e-3, spread=SPREAD)


@pytest.fixture(scope="module")
def modes(body, attachments):
    return modes_of_matrices(body, 80.0, attachments)


def printed(job):
    """Read the frequencies printed by CalculiX [Hz]."""
    rows = re.findall(r"^ +\d+ +(\S+) +\S+ +(\S+) +\S+$", (job / "modes.dat").read_text(), re.MULTILINE)
    return np.array([float(frequency) for _, frequency in rows][6:])


def test_frequencies_mass_and_rigid_motions(job, body, modes):
    want = printed(job)
    count = int(np.sum(want <= 80.0))
    assert count > 15 and len(modes.frequencies) == count
    # seven digits are printed
    validated(
        "Body models", "frequencies of a car-size frame of solids to 80 Hz", modes.frequencies, want[:count], rel=1e-6,
        unit="Hz", source="foreign code: CalculiX, frequencies as printed",
    )  # fmt: skip
    validated(
        "Body models", "mass of a car-size frame of solids", modes.rigid.mass, solid_frame.mass(), rel=1e-12, unit="kg",
        source="closed form: volume times density",
    )  # fmt: skip
    motions = body.rigid_motions(modes.rigid.cog)
    assert np.abs(body.stiffness @ motions).max() < 1e-9 * (abs(body.stiffness) @ abs(motions)).max()
    assert free_modes(body, 80.0).orthogonality < 1e-9


@pytest.fixture(scope="module")
def accelerance(body, attachments):
    """Compute -w^2 (K - w^2 M)^-1 of the full matrices at three points, 5 to 50 Hz: (w^2, point) -> (3, 3)."""
    result = {}
    for frequency in np.linspace(5.0, 50.0, 10):
        square = float(2.0 * np.pi * frequency) ** 2
        factor = scipy.sparse.linalg.splu((body.stiffness - square * body.mass).tocsc())
        for attachment in attachments:
            if attachment.name in ("strut_top_fr", "hydromount", "arm_rear_fl"):
                result[square, attachment.name] = square * attachment.moved.T @ factor.solve(attachment.moved.toarray())
    return result


@pytest.mark.parametrize(
    ("up_to", "method", "allowed"), [(80.0, "free-free", 0.025), (120.0, "free-free", 0.01), (80.0, "rubin", 0.01)]
)
def test_driving_point_frf_of_modes_and_residual_against_the_matrices(
    body, attachments, accelerance, up_to, method, allowed
):
    """Accelerance up to 50 Hz is that of modes and residual; the error without the residual is far larger.

    The static share of a mode at 81 Hz has an error of (50/81)^2 / (1 - (50/81)^2) = 60 % at 50 Hz, that of a mode at
    121 Hz 21 %. Attachment modes include the inertia of this share.
    """
    modes = modes_of_matrices(body, up_to, attachments, method)
    motions, _ = modes.rigid.rigid_motions(body.positions)
    rigid = np.zeros((len(body.node), 6))
    moving = body.direction < 3
    rigid[moving] = motions[:, body.node[moving], body.direction[moving]].T
    moved = {attachment.name: attachment.moved for attachment in attachments}
    total: dict[str, float] = defaultdict(float)
    wrong: dict[bool, dict[str, float]] = {True: defaultdict(float), False: defaultdict(float)}
    for (square, name), whole in accelerance.items():
        at, carried = moved[name].T @ modes.vectors, moved[name].T @ rigid
        reduced = (at / ((2.0 * np.pi * modes.frequencies) ** 2 - square)) @ at.T - carried @ carried.T / square
        total[name] += np.sum(whole**2)
        for with_residual in (True, False):
            accelerance_of_modes = square * (reduced + (modes.residual[name] if with_residual else 0.0))
            wrong[with_residual][name] += np.sum((accelerance_of_modes - whole) ** 2)
    with_it, without = (
        np.sqrt([wrong[has_residual][name] / total[name] for name in total]) for has_residual in (True, False)
    )
    validated(
        "Body models",
        f"driving-point accelerance of a frame of solids, 5 to 50 Hz, {method} modes to {up_to:g} Hz, error", with_it,
        0.0, abs=allowed, source="foreign code: CalculiX, full matrices K and M",
    )  # fmt: skip
    assert without.min() > (5.0 if method == "free-free" else 2.0) * with_it.max(), without


def test_modes_of_the_result_file_are_the_same(job, modes):
    file_modes = normalised(read_frd(job / "modes.frd", 1.0), modes.rigid, None, 80.0)
    np.testing.assert_allclose(file_modes.frequencies, modes.frequencies, rtol=1e-6)
    shapes = file_modes.body.displacements(file_modes.vectors)
    assert np.all(np.diag(mac(shapes, modes.body.displacements(modes.vectors))) > 1.0 - 1e-6)
    scale = np.linalg.norm(file_modes.vectors, axis=0) / np.linalg.norm(modes.vectors, axis=0)
    # six digits in the file
    validated(
        "File readers", "scale of the modes of a CalculiX result file", scale, 1.0, rel=1e-4,
        source="second derivation: modes of the matrices",
    )  # fmt: skip


def test_the_command_writes_the_model_and_lists_the_points(job, modes, attachments, tmp_path, capsys):
    output = tmp_path / "body.npz"
    options = ["import", str(job / "stored.sti"), "--spread", "300", "--up-to", "80", "--output", str(output)]
    assert command.main(options) == 0
    said = capsys.readouterr().out
    assert "points of the car" in said and "strut_top_fr" in said
    written = read_superelement(output)
    units = f"{modes.body.source}, {units_of(None, None).words}"
    want = superelement_of(
        replace(modes, body=replace(modes.body, source=units)), attachments, name="stored", damping=0.02
    )
    np.testing.assert_array_equal(written.shapes, want.shapes)
    assert written.provenance == want.provenance
    assert command.main(options) == 2 and "exists" in capsys.readouterr().err
    assert command.main(["import", str(job / "stored.sti"), "--output", str(tmp_path / "b.npz")]) == 3
    assert "points of the car have no node of the body within 1 mm; nearest nodes" in capsys.readouterr().err


def test_millimetres_tonnes_and_newtons_are_the_same_body(job, tmp_path, capsys):
    """Import K in N/mm, M in t and positions in mm: the unit of length determines those of mass and stiffness."""
    for suffix, factor in (("sti", 1e-3), ("mas", 1e-3)):
        table = np.loadtxt(job / f"stored.{suffix}")
        np.savetxt(tmp_path / f"mm.{suffix}", table * [1.0, 1.0, factor], fmt=["%d", "%d", "%.17g"])
    shutil.copy(job / "stored.dof", tmp_path / "mm.dof")
    deck = (job / "stored.inp").read_text()
    head, elements_block = deck.split("*ELEMENT", 1)
    rows = [[float(word) for word in line.split(",")] for line in head.splitlines()[1:]]
    node_lines = [f"{int(row[0])},{','.join(repr(1e3 * value) for value in row[1:])}" for row in rows]
    (tmp_path / "mm.inp").write_text("\n".join(["*NODE", *node_lines]) + "\n*ELEMENT" + elements_block)
    common = ["--spread", "300", "--up-to", "40", "--force", "--output"]
    assert command.main(["import", str(job / "stored.sti"), *common, str(tmp_path / "m.npz")]) == 0
    capsys.readouterr()
    millimetres = ["import", str(tmp_path / "mm.sti"), "--length-unit", "mm"]
    assert command.main([*millimetres, *common, str(tmp_path / "mm.npz")]) == 0
    notice = "lengths in mm, masses in t, which follows from mm, N and s"
    assert f"note: {notice}" in capsys.readouterr().out
    in_metres, in_millimetres = (read_superelement(tmp_path / f"{name}.npz") for name in ("m", "mm"))
    assert notice in in_millimetres.provenance
    assert in_millimetres.mass == pytest.approx(in_metres.mass, rel=1e-9)
    np.testing.assert_allclose(in_millimetres.frequencies, in_metres.frequencies, rtol=1e-7)
    for name, flexibility in in_metres.residual.items():
        np.testing.assert_allclose(in_millimetres.residual[name], flexibility, rtol=0.0, atol=1e-5 * flexibility.max())
    # The old reading of the same options: 0.86 kg.
    assert command.main([*millimetres, "--mass-unit", "kg", *common, str(tmp_path / "kg.npz")]) == 3
    said = capsys.readouterr().err
    assert "mass: found 0.8592 kg" in said and 'Set --mass-unit "t".' in said
    assert command.main(["import", str(tmp_path / "mm.sti"), *common, str(tmp_path / "kg.npz")]) == 3
    assert "Set --length-unit mm." in capsys.readouterr().err


def test_incompatible_modes_are_kept(tmp_path):
    """Bricks C3D8I have three nodes with mass and without position; the frequencies are those of CalculiX."""
    numbers = np.arange(1, 61).reshape(3, 4, 5)  # z, y, x
    lines = ["*NODE"]
    lines += [f"{numbers[k, j, i]},{0.6 * i},{0.4 * j},{0.4 * k}" for k in range(3) for j in range(4) for i in range(5)]
    lines.append("*ELEMENT,TYPE=C3D8I,ELSET=EALL")
    for n, (k, j, i) in enumerate(np.ndindex(2, 3, 4), 1):
        face = [(j, i), (j, i + 1), (j + 1, i + 1), (j + 1, i)]
        lines.append(",".join(map(str, [n, *(numbers[k + up, a, b] for up in (0, 1) for a, b in face)])))
    lines += ["*MATERIAL,NAME=S", "*ELASTIC", "2e7,0.3", "*DENSITY", "200.", "*SOLID SECTION,ELSET=EALL,MATERIAL=S"]
    for name, solver in (("stored", ",SOLVER=MATRIXSTORAGE"), ("modes", "")):
        end = ["*STEP", f"*FREQUENCY{solver}", "12", "*END STEP"]
        (tmp_path / f"{name}.inp").write_text("\n".join([*lines, *end]) + "\n")
        solid_frame.run(tmp_path, name)
    body = read_calculix(tmp_path / "stored.sti").scaled(1.0, 1.0).placed("-x,-y,z", (2.0, 0.0, 0.0))
    want = printed(tmp_path)
    body_modes = free_modes(body, float(want[4]) * 1.01)
    validated(
        "Body models", "frequencies of a block of C3D8I bricks", body_modes.frequencies[:5], want[:5],
        rel=1e-6, unit="Hz", source="foreign code: CalculiX, frequencies as printed",
    )  # fmt: skip
    assert body_modes.rigid.mass == pytest.approx(2.4 * 1.2 * 0.8 * 200.0, rel=1e-9)
    assert np.sum(body.direction >= 6) == 9 * 24
    inch = read_calculix(tmp_path / "stored.sti").scaled(0.0254, 1.0)
    np.testing.assert_allclose(free_modes(inch, float(want[4]) * 1.01).frequencies[:5], want[:5], rtol=1e-6)


def test_expanded_shells_are_refused(tmp_path):
    """Shell elements are expanded to solids, with additional nodes and constraints."""
    lines = ["*NODE,NSET=NALL"]
    lines += [f"{1 + i + 11 * j},{0.4 * i},{0.3 * j},{0.02 * i * j}" for j in range(6) for i in range(11)]
    lines += ["*ELEMENT,TYPE=S4,ELSET=EALL"]
    corners = [(1 + i + 11 * j, 2 + i + 11 * j, 13 + i + 11 * j, 12 + i + 11 * j) for j in range(5) for i in range(10)]
    lines += [f"{n},{','.join(map(str, element_nodes))}" for n, element_nodes in enumerate(corners, 1)]
    lines += ["*MATERIAL,NAME=S", "*ELASTIC", "2e11,0.3", "*DENSITY", "7800.", "*SHELL SECTION,ELSET=EALL,MATERIAL=S"]
    lines += ["0.002", "*STEP", "*FREQUENCY,SOLVER=MATRIXSTORAGE", "10", "*END STEP"]
    (tmp_path / "shell.inp").write_text("\n".join(lines) + "\n")
    solid_frame.run(tmp_path, "shell")
    with pytest.raises(DataError, match="150 nodes of the matrices have no position in the"):
        read_calculix(tmp_path / "shell.sti")
