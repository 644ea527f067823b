"""Body models with a single fault each: rejected with a one-line message and the exit code of the fault."""

import shutil
import zipfile

import numpy as np
import pytest
import scipy

from tests.model.flexbody.modal_test import POINTS
from tests.model.flexbody.model_files import (
    Case,
    array,
    cut,
    gone,
    heave,
    holds,
    larger,
    line,
    modes,
    nothing,
    scalar,
    shapes,
    still,
    text,
    twin,
    write_all,
)
from vehicle.commands import body as command
from vehicle.commands.command_line import FAULT

RESIDUAL = "residual_flexibility_m_per_n = [[1e-07"
SHOW = ("show", "FILE")
MARKET = ("import", "K.mtx", "--mass", "M.mtx", "--dofs", "dofs.csv", "--nodes", "nodes.csv")
ABAQUS = ("import", "K.txt", "--mass", "M.txt", "--nodes", "nodes.csv")
MATLAB = ("--mass", "both.mat:M", "--dofs", "dofs.csv", "--nodes", "nodes.csv")
JOB = ("import", "job.sti")
UFF = ("import", "modes.uff")


def toml(change, says):
    return Case("box.toml", change, SHOW, says)


def npz(change, says):
    return Case("box.npz", change, SHOW, says)


def head_of_array(head):
    """Give the frequencies of an npz another head."""

    def change(path):
        with zipfile.ZipFile(path) as archive:
            members = {name: archive.read(name) for name in archive.namelist()}
        members["frequency_hz.npy"] = b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little") + head
        with zipfile.ZipFile(path, "w") as archive:
            for name, content in members.items():
                archive.writestr(name, content)

    return change


def option(*arguments, says, code=2):
    return Case("modes.uff", nothing, (*UFF, *arguments), says, code)


CASES = {
    "no CoG": toml(line("cog_m", None), "key 'cog_m' is missing; set all of mass_kg, cog_m, inertia_kg_m2"),
    "no inertia": toml(line("inertia_kg_m2", None), "key 'inertia_kg_m2' is missing"),
    "no mass": toml(line("mass_kg", None), "key 'mass_kg' is missing; set all of mass_kg, cog_m"),
    "inertia of three": toml(
        line("inertia", "inertia_kg_m2 = [1.0, 2.0, 3.0]"), "must have the shape (3, 3), not (3,)"
    ),
    "mass not finite": toml(line("mass_kg", "mass_kg = nan"), "give a positive mass"),
    "mass negative": toml(line("mass_kg", "mass_kg = -275.0"), "give a positive mass"),
    "CoG in mm": toml(line("cog_m", "cog_m = [980.0, 0.0, 600.0]"), "m is far outside the nodes"),
    "inertia of a needle": toml(
        line("inertia", "inertia_kg_m2 = [[1.0, 0.0, 0.0], [0.0, 5.0, 0.0], [0.0, 0.0, 900.0]]"),
        "the sum of the two smaller must be at least the largest",
    ),
    "residual one-sided": toml(text(RESIDUAL + ", 0.0", RESIDUAL + ", 1e-08"), "is not symmetric"),
    "residual negative": toml(text(RESIDUAL, "residual_flexibility_m_per_n = [[-1e-07"), "must be at least 0 (below"),
    "residual in mm": toml(text(RESIDUAL, "residual_flexibility_m_per_n = [[1e-03"), "probably in mm/N, or the node"),
    "residual of words": toml(text(RESIDUAL, 'residual_flexibility_m_per_n = [["a"'), "must be numbers"),
    "rotation rows": toml(line("rotation", "rotation_per_m_sqrt_kg = [[0.0, 0.0, 0.0]]"), "4 rows of three finite"),
    "rotation NaN": toml(text("[[0.01, 0.01", "[[nan, 0.01"), "4 rows of three finite"),
    "mass of one node": toml(text("position_m", "mass_kg = 30.0\nposition_m"), "node 2: key 'mass_kg' is missing"),
    "masses twice": Case(
        "masses.toml",
        text(
            "edges",
            "mass_kg = 275.0\ncog_m = [1.0, 0.0, 0.8]\ninertia_kg_m2 = [[90, 0, 0], [0, 300, 0], [0, 0, 300]]\nedges",
        ),
        SHOW,
        "found both; give mass, CoG and inertia, or the mass of every node.",
    ),
    "rigid mode": toml(shapes(heave), "mode 1 (8.50209 Hz) is a rigid motion (share 100.0000%"),
    "twin modes": toml(shapes(twin), "have the same shape (MAC 1.0000)"),
    "still mode": toml(shapes(still), "mode 3 is zero at all nodes"),
    "shapes of mm and tonnes": toml(shapes(larger), "from mm and tonnes: divide by sqrt(1000)"),
    "shape a number": toml(scalar("shape_per_sqrt_kg"), "mode 1, shape_per_sqrt_kg: found 0 rows"),
    "edges a number": toml(scalar("edges"), "edges: 5 is not a pair of node names"),
    "edge of lists": toml(text('["corner_0", "corner_1"]', '["corner_0", ["corner_1"]]'), "is not a pair of node"),
    "TOML cut off": toml(cut(0.6), "not valid TOML, perhaps cut off: Unclosed"),
    "TOML of format 7": toml(text("superelement 2", "superelement 7"), "format is 'modal superelement 7'"),
    "npz cut off": npz(cut(0.7), "not a valid npz, perhaps truncated"),
    "npz damaged": npz(
        lambda path: path.write_bytes(path.read_bytes()[:900] + b"\x07" * 40 + path.read_bytes()[940:]),
        "not a valid npz",
    ),
    # An archive that is whole, with an array whose head is not: NumPy raises errors of its parser.
    "npz damaged head": npz(head_of_array(b"((((\n"), "not a valid npz, perhaps truncated (TokenError: "),
    "npz nested head": npz(head_of_array(b"[" * 3000), "not a valid npz, perhaps truncated ("),
    "npz renamed array": npz(array(frequency_hz=None), "'frequency_hz' is mi"),
    "npz unknown array": npz(array(shape=np.zeros(3)), "unknown array 'shape'; did you mean"),
    "npz of objects": npz(array(nodes=lambda names: names.astype(object)), "Object arrays cannot be loaded"),
    "npz shape": npz(
        array(shape_per_sqrt_kg=lambda table: table[:, :-1]),
        "has the shape (4, 7, 3) but must have (4, 8, 3) for 8 nodes",
    ),
    "npz edges": npz(array(edges=np.arange(3)), "array 'edges': shape (3,)"),
    "npz names": npz(array(nodes=lambda names: names.reshape(2, 4)), "array 'nodes': shape (2, 4)"),
    "npz words": npz(array(frequency_hz=np.array(["a"] * 4)), "array 'frequency_hz': found type <U1, must be numbers"),
    "npz residuals": npz(array(residual_nodes=np.array(["corner_1", "corner_2"])), "1 arrays for 2 nodes"),
    "npz of format 7": npz(array(head=lambda head: str(head).replace("ment 2", "ment 7")), "'modal superelement 7'"),
    "npz without head": npz(array(head="nothing"), "not a valid npz"),
    "npz of text": npz(holds(b"node,x,y,z\n1,2,3\n"), "not valid TOML, perhaps cut"),
    "npz of a picture": npz(holds(b"\x89PNG\r\n\x1a\n"), "cannot be read as UTF-8 text"),
    "no model": npz(gone, "the file does not exist. Give"),
    "frd cut off": Case("modes.frd", cut(0.9), ("import", "FILE"), "is not a line of a result file"),
    "frd without its end": Case("modes.frd", text(" 9999\n", ""), ("import", "FILE"), "truncated; the job did not end"),
    "frd without modes": Case("modes.frd", cut(0.45), ("import", "FILE"), "no modes; write *NODE FILE with U"),
    "frd binary": Case("modes.frd", holds(b"    1C\n\xff\x80\x00"), ("import", "FILE"), "cannot be read as text"),
    "frd broken line": Case(
        "modes.frd", text("-1.00000E-02 0.0", "-1.0000*E-02 0.0"), ("import", "FILE"), "is not a line of a"
    ),
    "frd node nowhere": Case("modes.frd", line(" -1         9-1", None), ("import", "FILE"), "node 9 of the modes"),
    "frd of a static step": Case("modes.frd", text("MODAL", "STATI"), ("import", "FILE"), "no modes; write *NODE FILE"),
    "no .mas": Case("job.mas", gone, JOB, " mas is missing. CalculiX"),
    "no .dof": Case("job.dof", gone, JOB, " dof is missing. CalculiX"),
    ".sti empty": Case("job.sti", holds(b""), JOB, "0 rows"),
    ".sti NaN": Case("job.sti", line("1 1 ", "1 1 nan"), JOB, "row 1 contains a number that is not finite"),
    ".sti cut off": Case("job.sti", cut(0.501), JOB, "job.sti: stiffness: degree of freedom 1 of node 51 has no"),
    ".mas one number": Case("job.mas", holds(b"1\n2\n"), JOB, "found 1 numbers in each of 2 rows"),
    ".sti half rows": Case("job.sti", line("1 1 ", "1.5 1 3.0"), JOB, "(node, direction, row), not 1.5"),
    ".dof direction 7": Case("job.dof", line("1.6", "1.7"), JOB, "directions 1 to 7, must be 1 to 6"),
    ".dof of another job": Case("job.dof", holds(b"1.1\n1.2\n1.3\n"), JOB, "the number of degrees of freedom."),
    ".dof twice": Case("job.dof", line("1.6", "1.5"), JOB, "degree of freedom 5 of node 1 occurs twice"),
    ".dof of words": Case("job.dof", line("1.1", "one.x"), JOB, "cannot be read as rows of"),
    ".inp without nodes": Case("job.inp", holds(b"*HEADING\n"), JOB, "job.inp: contains no nodes."),
    ".inp broken": Case("job.inp", line("1,0.0", "1,0.0,west,0.4"), JOB, "is not a line of *node"),
    "market cut off": Case("K.mtx", cut(0.5), MARKET, "the matrix cannot be read"),
    "market head": Case("K.mtx", text("coordinate", "spiral"), MARKET, "the matrix cannot be read"),
    "market complex": Case(
        "M.mtx",
        holds(b"%%MatrixMarket matrix coordinate complex symmetric\n48 48 1\n1 1 1 2\n"),
        MARKET,
        "must be a matrix of real",
    ),
    "market wrong size": Case(
        "M.mtx", lambda p: scipy.io.mmwrite(p, scipy.sparse.eye(7)), MARKET, "7 rows and 7 columns"
    ),
    "abaqus cut off": Case("K.txt", cut(0.502), ABAQUS, "cannot be read as rows of numbers, or"),
    "abaqus direction": Case("K.txt", line("1,1,1,1", "1,0,1,1,5.0"), ABAQUS, "K.txt: found directions 0 to"),
    "mat truncated": Case("both.mat", cut(0.4), ("import", "both.mat:K", *MATLAB), "both.mat: "),
    "mat of text": Case("both.mat", nothing, ("import", "both.mat:text", *MATLAB), "must be a matrix of real numbers"),
    "mat complex": Case("both.mat", nothing, ("import", "both.mat:complex", *MATLAB), "must be a matrix of real"),
    "mat unknown": Case("both.mat", nothing, ("import", "both.mat:KK", *MATLAB), "no variable 'KK'; choose from K, M"),
    "mat no choice": Case("both.mat", nothing, ("import", "both.mat", *MATLAB), "choose one of them with"),
    "nodes of two numbers": Case("nodes.csv", line("1,", "1,0.0,0.4"), MARKET, "is not a line of *node"),
    "nodes NaN": Case("nodes.csv", line("1,", "1,nan,0.0,0.4"), MARKET, "a coordinate is not finite"),
    "node at two places": Case("nodes.csv", line("1,", "11,9.0,0.0,0.4"), MARKET, "node 11 is also at [9.0, 0.0, 0.4]"),
    "node missing": Case("nodes.csv", line("1,", None), MARKET, "nodes of the matrices have no position in the"),
    "no nodes given": Case("K.mtx", nothing, MARKET[:4], "set --nodes FILE too", 2),
    "no dofs given": Case("K.mtx", nothing, (*MARKET[:4], *MARKET[6:]), "freedom are missing; give", 2),
    "no mass given": Case(
        "K.mtx", nothing, ("import", "K.mtx"), "is a stiffness matrix; give --mass, --dofs and --nodes", 2
    ),
    "map of three": Case(
        "map.csv", text("fr,1", "fr,1,2"), (*UFF, "--point-nodes", "map.csv"), "is not a line point,node"
    ),
    "map of an unknown point": Case(
        "map.csv", text("strut", "nose"), (*UFF, "--point-nodes", "map.csv"), "the car has no point 'nose_top_fr'"
    ),
    "map to no node": Case("map.csv", text("fr,1", "fr,999"), (*UFF, "--point-nodes", "map.csv"), "node '999'"),
    "map twice": Case(
        "map.csv",
        text("strut_top_fr,1", "seat,1\nseat,2"),
        (*UFF, "--point-nodes", "map.csv"),
        "point 'seat' occurs twice",
    ),
    "no map": Case("map.csv", gone, (*UFF, "--point-nodes", "map.csv"), "map.csv: cannot be read"),
    "uff without nodes": Case("modes.uff", modes(with_positions=False), UFF, "20 of them have no position. Export"),
    "uff without modal mass": Case("modes.uff", modes(modal_mass=0.0), UFF, "the modal mass is missing, so the"),
    "uff without modes": Case("modes.uff", modes(count=0), UFF, "modes.uff"),
    "uff in radians": Case("modes.uff", modes(speed=2.0 * np.pi), (*UFF, "--up-to", "300"), "probably rad/s"),
    "uff in millimetres": Case("modes.uff", modes(modal_mass=1e-6), UFF, "Use shapes with modal masses of 1 kg"),
    "uff cut off": Case("modes.uff", cut(0.7), UFF, "modes.uff"),
    "uff without points": Case("modes.uff", modes(points=POINTS[5:]), UFF, "points of the car have no node of the"),
    "no file": Case("modes.uff", gone, UFF, "modes.uff", 2),
    "up to nan": option("--up-to", "nan", says="--up-to nan: must be above 0"),
    "up to below": option("--up-to", "-5", says="--up-to -5"),
    "up to too low": option("--up-to", "4", says="no mode between 3 and 4 Hz", code=3),
    "damping": option("--damping", "2", says="--damping 2: must be 0 to 0.3"),
    "tolerance nan": option("--point-distance", "nan", says="--point-distance nan: must be above 0 and up to 50"),
    "tolerance wide": option("--point-distance", "80", says="--point-distance 80"),
    "spread": option("--spread", "-1", says="--spread -1: must be at least 0"),
    "modal mass": option("--modal-mass", "0", says="--modal-mass 0: must be above 0"),
    "axes mirrored": option("--axes", "x,y,-z", says="three different, right-handed source axes"),
    "axes of words": option("--axes", "forward", says="three different, right-handed source axes"),
    "origin of two": option("--origin", "1,2", says="must be three numbers [m]"),
    "origin nan": option("--origin", "1,nan,0", says="must be three numbers [m]"),
    "unit": option("--length-unit", "furlong", says="--length-unit 'furlong': must be one of "),
    "unit of a universal file": option("--length-unit", "mm", says="a universal file states its units in dataset"),
    "matrices in mm": Case("K.mtx", nothing, (*MARKET, "--length-unit", "mm"), "Set --length-unit m."),
    "matrices in t": Case("K.mtx", nothing, (*MARKET, "--mass-unit", "t"), 'Set --mass-unit "kg".'),
    "job in g": Case("job.sti", nothing, (*JOB, "--mass-unit", "g"), "mass: found 0.275 kg with lengths in m"),
    "frd in mm": Case("modes.frd", nothing, ("import", "FILE", "--length-unit", "mm"), "Set --length-unit m."),
    "frd in t": Case("modes.frd", nothing, ("import", "FILE", "--mass-unit", "t"), 'Set --mass-unit "kg".'),
    "method of modes": option("--method", "rubin", says="--method: belongs to stiffness and mass"),
    "modal mass of matrices": Case("K.mtx", nothing, (*MARKET, "--modal-mass", "1"), "--modal-mass: belongs to", 2),
    "nodes of a job": Case("job.sti", nothing, (*JOB, "--nodes", "nodes.csv"), "--nodes: belongs to stiffness", 2),
    "nodes of modes": option("--nodes", "nodes.csv", says="--nodes: belongs to stiffness and mass in separate"),
    "attachment modes": option("--attachment-modes", "200", says="belongs to --method rubin or craig-bampton"),
    "output as text": option("--output", "body.txt", says="must end in .toml or .npz"),
    "output exists": option("--output", "box.toml", says="exists; give --force to replace it, or another name"),
    "output in a file": option("--output", "map.csv/body.toml", says="map.csv is a file, not a folder"),
}
REFUSED = {"run.op2": "Nastran OP2", "run.RST": "ANSYS", "file.full": "HBMAT,k", "a.odb": "*MATRIX OUTPUT",
           "b.mnf": "Adams modal neutral file"}  # fmt: skip
CASES |= {name: Case("modes.uff", nothing, ("import", name), says) for name, says in REFUSED.items()}


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    """Return a folder with a valid file in every format."""
    folder = tmp_path_factory.mktemp("good")
    write_all(folder)
    return folder


@pytest.mark.parametrize("name", CASES)
def test_a_broken_model_is_refused_in_one_sentence(good, tmp_path, monkeypatch, capsys, name):
    case = CASES[name]
    for file in good.iterdir():
        shutil.copy(file, tmp_path)
    monkeypatch.chdir(tmp_path)
    case.change(tmp_path / case.file)
    arguments = [case.file if argument == "FILE" else argument for argument in case.arguments]
    if arguments[0] == "import" and "--output" not in arguments:
        arguments += ["--output", "made.toml"]
    before = {file.name for file in tmp_path.iterdir()}
    assert command.main(arguments) == case.code
    printed = capsys.readouterr()
    assert case.says in printed.err and FAULT not in printed.err, printed.err
    assert printed.err.strip().count("\n") == 0 and not printed.out
    assert {file.name for file in tmp_path.iterdir()} == before  # no incomplete file


@pytest.mark.parametrize("arguments", [SHOW, UFF])
def test_the_files_are_good_before(good, tmp_path, monkeypatch, capsys, arguments):
    monkeypatch.chdir(good)
    if arguments is SHOW:
        for file in ("box.toml", "box.npz", "masses.toml"):
            assert command.main(["show", file]) == 0
    else:
        assert command.main([*UFF, "--output", str(tmp_path / "made.toml")]) == 0
    assert not capsys.readouterr().err


@pytest.mark.parametrize("arguments", [JOB, MARKET, ABAQUS, ("import", "both.mat:K", *MATLAB), ("import", "modes.frd")])
def test_good_matrices_get_as_far_as_the_points_of_the_car(good, tmp_path, monkeypatch, capsys, arguments):
    """The nodes of the box do not match the points of the car, so the import ends there."""
    monkeypatch.chdir(good)
    assert command.main([*arguments, "--output", str(tmp_path / "made.toml")]) == 3
    assert "points of the car have no node of the body within" in capsys.readouterr().err
