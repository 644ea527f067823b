"""Body models from matrices and from modes: closed forms, modes by a second method, invalid sources."""

import re
from dataclasses import replace

import numpy as np
import pytest
import scipy

from tests.model.flexbody.box_body import MASSES, POSITIONS, box_matrices, box_stiffness, matrices
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.flexbody.beam import BeamSection
from vehicle.model.flexbody.frame_modes import free_free_modes
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.sources.free_body_modes import free_modes
from vehicle.model.flexbody.sources.interfaces import interfaces
from vehicle.model.flexbody.sources.matrix_files import read_matrices
from vehicle.model.flexbody.sources.mode_shapes import GivenModes, normalised
from vehicle.model.flexbody.sources.superelement_of import modes_of_matrices, superelement_of
from vehicle.model.flexbody.sources.text_matrices import rows_of_numbers

PLACES = {"a": tuple(POSITIONS[1]), "b": tuple(POSITIONS[6])}


@pytest.fixture(scope="module")
def box():
    return box_matrices()


def modes_of(body, up_to=60.0):
    return modes_of_matrices(body, up_to, interfaces(body, PLACES, tolerance=1e-3))


def test_modes_and_residuals_are_those_of_the_condensed_frame(box):
    body_modes = modes_of(box)
    frequencies, shapes = free_free_modes(box_stiffness(), MASSES, POSITIONS, 18)
    kept = len(body_modes.frequencies)
    np.testing.assert_allclose(body_modes.frequencies, frequencies[:kept], rtol=1e-9)  # round-off
    left_out = shapes[kept:, 1].T / (2.0 * np.pi * frequencies[kept:]) ** 2 @ shapes[kept:, 1]
    np.testing.assert_allclose(body_modes.residual["a"], left_out, rtol=1e-7, atol=1e-7 * left_out.max())
    points = MassProperties.of_points(MASSES, POSITIONS)
    assert body_modes.rigid.mass == pytest.approx(275.0, rel=1e-12)
    np.testing.assert_allclose(body_modes.rigid.cog, points.cog, rtol=1e-10)
    np.testing.assert_allclose(body_modes.rigid.inertia, points.inertia, rtol=1e-9, atol=1e-9)
    model = superelement_of(body_modes, interfaces(box, PLACES, tolerance=1e-3), name="box", damping=0.02)
    np.testing.assert_allclose(np.abs(model.shape_at("a")), np.abs(shapes[:kept, 1].T), atol=1e-8)
    assert model.node_mass is None and set(model.rotations) == {"a", "b"}


def test_units_and_axes_of_the_source_do_not_matter(box):
    """Matrices in mm, tonnes and seconds, with x forward, y to the left and another origin, give the same body."""
    want = modes_of(box)
    turn = np.where(box.direction % 3 < 2, -1.0, 1.0)
    length, mass = 1e-3, 1e3
    scale = scipy.sparse.diags(turn * np.where(box.direction < 3, length, 1.0))
    energy = mass * length**2
    other = replace(
        box,
        stiffness=(scale @ box.stiffness @ scale / energy).tocsc(),
        mass=(scale @ box.mass @ scale / energy).tocsc(),
        positions=(box.positions - [1.0, 0.2, 0.3]) * [-1.0, -1.0, 1.0] / length,
    )
    body_modes = modes_of(other.scaled(length, mass).placed("-x,-y,z", (1.0, 0.2, 0.3)))
    np.testing.assert_allclose(body_modes.frequencies, want.frequencies, rtol=1e-9)
    np.testing.assert_allclose(body_modes.rigid.inertia, want.rigid.inertia, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(body_modes.residual["b"], want.residual["b"], rtol=1e-7, atol=1e-14)
    swapped = box.placed("z,x,y", (0.0, 0.0, 0.0))  # the z axis of the source is the x axis of the vehicle
    np.testing.assert_array_equal(swapped.positions[:, 0], box.positions[:, 2])
    np.testing.assert_allclose(free_modes(swapped, 60.0).frequencies, want.frequencies, rtol=1e-9)


@pytest.mark.parametrize("axes", ["x,y,-z", "x,x,z", "y,x,z", "x,y", "a,b,c", ""])
def test_mirrored_and_unknown_axes_are_refused(box, axes):
    with pytest.raises(ConfigurationError, match="three different, right-handed source axes"):
        box.placed(axes, (0.0, 0.0, 0.0))


def test_free_beam_in_closed_form():
    """Bending of a slender free-free beam: f = (k L)^2 / (2 pi L^2) sqrt(EI / (m/L)), cos kL cosh kL = 1; Lanczos."""
    length, count, line = 4.0, 81, 50.0
    positions = np.column_stack([np.linspace(0.0, length, count), np.zeros(count), np.zeros(count)])
    section = BeamSection(axial=1e9, torsion=1e5, bending_y=4e6, bending_z=9e6)
    masses = np.full(count, line * length / (count - 1))
    masses[[0, -1]] /= 2.0
    body = matrices(positions, [(i, i + 1) for i in range(count - 1)], section, masses)
    inertia = np.zeros((count, 6))
    inertia[:, 3] = 0.05  # a line has none about itself
    body = replace(body, mass=(body.mass + scipy.sparse.diags(inertia.ravel())).tocsc())
    beam_modes = free_modes(body, 360.0)
    want = [
        (k**2 / (2.0 * np.pi * length**2)) * np.sqrt(stiffness / line)
        for k in (4.730040744862704, 7.853204624095838)
        for stiffness in (4e6, 9e6)
    ]
    for frequency in want:
        gap = np.abs(beam_modes.frequencies / frequency - 1.0).min()
        assert gap < 2e-3, frequency  # point masses at 80 pieces: (pi n / 80)^2 / 6 and less
    assert beam_modes.orthogonality < 1e-9 and beam_modes.rigid_frequency < 1e-3
    ends = {"front": (0.0, 0.0, 0.0), "middle": (2.0, 0.0, 0.0), "rear": (length, 0.0, 0.0)}
    held = modes_of_matrices(body, 3000.0, interfaces(body, ends, tolerance=1e-3), "craig-bampton", 360.0)
    count = len(beam_modes.frequencies)
    np.testing.assert_allclose(held.frequencies[:count], beam_modes.frequencies, rtol=2e-3)
    assert np.all(held.frequencies[:count] > beam_modes.frequencies * (1.0 - 1e-9))


def test_nodes_around_a_place_carry_it_together(box):
    """Four corners of a face in rigid motion carry displacement and rotation of the middle of the face."""
    middle = {"middle": (2.0, 0.0, 0.85)}
    (interface,) = interfaces(box, middle, tolerance=1e-3, spread=0.8)
    motion = box.rigid_motions(np.array([0.3, 0.4, 0.5]))
    shift, turn = np.array([0.1, 0.2, 0.3]), np.array([0.01, -0.02, 0.03])
    vector = motion @ np.concatenate([shift, turn])
    arm = np.array(middle["middle"]) - [0.3, 0.4, 0.5]
    np.testing.assert_allclose(interface.moved.T @ vector, shift + np.cross(turn, arm), atol=1e-12)
    np.testing.assert_allclose(interface.turned.T @ vector, turn, atol=1e-12)
    assert interface.nodes == 4


def held(body):
    extra = scipy.sparse.lil_matrix(body.stiffness.shape)
    extra[0, 0] = 1e4
    return replace(body, stiffness=(body.stiffness + extra).tocsc())


def without(name, factor):
    return lambda body: replace(body, **{name: (factor * getattr(body, name)).tocsc()})


def lopsided(body):
    stiffness = body.stiffness.tolil()
    stiffness[0, 1] += 1e6
    return replace(body, stiffness=stiffness.tocsc())


def loose(body):
    keep = scipy.sparse.diags((np.arange(48) != 9).astype(float))
    return replace(body, stiffness=(keep @ body.stiffness @ keep).tocsc())


def line(body):
    mass = np.zeros((8, 6))
    mass[:2, :3] = 10.0
    return replace(body, mass=scipy.sparse.diags(mass.ravel()).tocsc())


def not_finite(body):
    mass = body.mass.copy()
    mass.data[3] = np.nan
    return replace(body, mass=mass)


def one_direction(body):
    mass = body.mass.copy()
    mass[0, 0] = 0.0
    return replace(body, mass=mass)


BROKEN = {
    "a support": (held, "the body is not free: its rigid motions have"),
    "no stiffness": (without("stiffness", 0.0), "stiffness: all entries are zero"),
    "no mass": (without("mass", 0.0), "mass: all entries are zero"),
    "negative mass": (without("mass", -1.0), "along x, y and z, must be equal and positive"),
    "not symmetric": (lopsided, "stiffness: is not symmetric"),
    "loose": (loose, "degree of freedom 4 of node 11 has no stiffness"),
    "all mass on a line": (line, "principal moments of inertia"),
    "NaN": (not_finite, "mass: contains 1 entries that are not finite"),
    "a mass in two directions": (one_direction, "kg along x, y and z"),
    "fewer rows": (lambda b: replace(b, node=b.node[:-1], direction=b.direction[:-1]), "48 columns but must have 47"),
    "twice": (lambda b: replace(b, direction=np.where(np.arange(48) == 1, 0, b.direction)), "occurs twice"),
    "stiff as steel": (without("stiffness", 1e9), "no elastic mode up to 60 Hz; the first is at"),
}


@pytest.mark.parametrize("case", BROKEN)
def test_broken_matrices_are_refused(box, case):
    change, message = BROKEN[case]
    with pytest.raises(DataError, match=re.escape(message)):
        free_modes(change(box), 60.0)


def test_far_nodes_are_listed_with_their_distances(box):
    with pytest.raises(DataError, match=r"1 points of the car .* far: node 11, 500\.0 mm"):
        interfaces(box, {"far": (0.0, -0.5, 1.8)}, tolerance=1e-3)
    (interface,) = interfaces(box, {"far": (0.0, -0.5, 1.8)}, tolerance=1e-3, named={"far": "11"})
    assert interface.distance == pytest.approx(0.5)
    with pytest.raises(DataError, match="node '5'"):
        interfaces(box, {"far": (0.0, -0.5, 1.8)}, tolerance=1e-3, named={"far": "5"})
    with pytest.raises(DataError, match="the car has no point 'nose'"):
        interfaces(box, {"far": (0.0, -0.5, 1.8)}, tolerance=1e-3, named={"nose": "11"})
    with pytest.raises(DataError, match="2 nodes on one line, too few to define a rotation"):
        interfaces(box, {"edge": (1.0, -0.5, 0.4)}, tolerance=1e-3, spread=1.05)
    # All faults in one message: a chosen node, a far point, two points without enough nodes.
    several = {"edge": (1.0, -0.5, 0.4), "far": (0.0, -0.5, 9.0), "lost": (0.0, 0.0, 0.0), "other": (1.0, 0.5, 0.4)}
    with pytest.raises(DataError) as caught:
        interfaces(box, several, tolerance=1e-3, spread=1.05, named={"lost": "5"})
    said = str(caught.value)
    assert "node '5', chosen for lost" in said and "1 points of the car have no node" in said
    assert "2 points cannot be carried" in said and "edge: 2 nodes on one line" in said and "other: 2 nodes" in said


def given(box, scale=1.0, phase=0.0, imaginary=0.0):
    exact = free_modes(box, 60.0)
    vectors = np.hstack([box.rigid_motions(exact.rigid.cog), exact.vectors]) * scale
    noise = np.random.default_rng(2).standard_normal(vectors.shape) * np.linalg.norm(vectors, axis=0)
    return exact, GivenModes(
        body=box,
        frequencies=np.concatenate([np.linspace(0.1, 1.8, 6), exact.frequencies]),
        damping_ratio=np.full(6 + len(exact.frequencies), 0.03),
        vectors=(vectors + 1j * imaginary * noise / np.sqrt(len(vectors))) * np.exp(1j * phase),
        modal_mass=np.full(6 + len(exact.frequencies), scale**2),
    )


def test_given_modes_are_made_real_and_mass_normalised(box):
    exact, source = given(box, scale=37.0, phase=0.7)
    modes = normalised(source, exact.rigid, None, 60.0)
    np.testing.assert_allclose(modes.frequencies, exact.frequencies, rtol=1e-12)
    np.testing.assert_allclose(np.abs(modes.vectors), np.abs(exact.vectors), atol=1e-10 * np.abs(exact.vectors).max())
    assert modes.remarks[0] == "6 modes up to 3 Hz are left out as rigid-body modes"
    assert "mode shapes are divided by the square root of their modal masses, 1369 to 1369 kg" in modes.remarks
    _, source = given(box, imaginary=0.1)
    assert "complex mode shapes are made" in " ".join(normalised(source, exact.rigid, None, 60.0).remarks)
    _, source = given(box, imaginary=0.8)
    with pytest.raises(DataError, match="the shape is complex: its imaginary part is"):
        normalised(source, exact.rigid, None, 60.0)
    bare = replace(source, modal_mass=np.full(len(source.modal_mass), np.nan), vectors=source.vectors.real)
    with pytest.raises(DataError, match="the modal mass is missing, so the shape has no scale"):
        normalised(bare, exact.rigid, None, 60.0)
    np.testing.assert_allclose(
        np.abs(normalised(bare, exact.rigid, 4.0, 60.0).vectors), np.abs(exact.vectors) / 2.0, atol=1e-9
    )


def test_matrices_come_from_matrix_market_matlab_and_abaqus(box, tmp_path):
    want = free_modes(box, 60.0).frequencies
    identity = [int(box.nodes[i]) for i in box.node]
    nodes, dofs = tmp_path / "nodes.csv", tmp_path / "dofs.csv"
    rows = [
        f"{name},{','.join(map(str, position))}"
        for name, position in zip(box.nodes, box.positions.tolist(), strict=True)
    ]
    nodes.write_text("node,x,y,z\n" + "\n".join(rows))
    dofs.write_text(
        "\n".join(f"{node},{direction + 1}" for node, direction in zip(identity, box.direction, strict=True))
    )
    both = {"K": box.stiffness, "M": box.mass}
    for name, matrix in both.items():
        scipy.io.mmwrite(tmp_path / f"{name}.mtx", scipy.sparse.tril(matrix), symmetry="symmetric")
        entries = scipy.sparse.triu(matrix).tocoo()
        lines = [
            f"{identity[i]}, {box.direction[i] + 1}, {identity[j]}, {box.direction[j] + 1}, {value!r}"
            for i, j, value in zip(entries.row, entries.col, entries.data.tolist(), strict=True)
        ]
        (tmp_path / f"{name}.txt").write_text("** Abaqus\n" + "\n".join(lines))
    scipy.io.savemat(tmp_path / "both.mat", both)
    for pair in (("K.mtx", "M.mtx"), ("both.mat:K", "both.mat:M"), ("K.txt", "M.txt")):
        listed = None if pair[0].endswith("txt") else dofs
        body = read_matrices(tmp_path / pair[0], tmp_path / pair[1], listed, nodes)
        np.testing.assert_allclose(free_modes(body, 60.0).frequencies, want, rtol=1e-9, err_msg=pair[0])
    with pytest.raises(ConfigurationError, match="freedom are missing; give"):
        read_matrices(tmp_path / "K.mtx", tmp_path / "M.mtx", None, nodes)
    with pytest.raises(DataError, match="2 square matrices"):
        read_matrices(tmp_path / "both.mat", tmp_path / "both.mat", dofs, nodes)
    nodes.write_text("\n".join(rows[:-1]))
    with pytest.raises(DataError, match="nodes of the matrices have no position"):
        read_matrices(tmp_path / "K.mtx", tmp_path / "M.mtx", dofs, nodes)


def test_one_line_of_names_stands_above_numbers(tmp_path):
    path = tmp_path / "dofs.csv"
    for first in ("node,direction\n", "Node  Dir_1\n", "", "# node,direction\n"):
        path.write_text(f"{first}7,1\n7,3\n")
        assert rows_of_numbers(path, 2).tolist() == [[7.0, 1.0], [7.0, 3.0]]
    for first in ("node,x [mm]\n", "nan,nan\n", "node,direction\nnode,direction\n"):
        path.write_text(f"{first}7,1\n7,3\n")
        with pytest.raises(DataError, match="number"):
            rows_of_numbers(path, 2)
