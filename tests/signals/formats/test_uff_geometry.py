"""Nodes, lines, axis systems and mode shapes of universal files: the foreign library's, real ones, by hand, our own."""

import contextlib
import io
from pathlib import Path

import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import DataError
from vehicle.signals.formats.geometry import Geometry, ModeShape
from vehicle.signals.formats.reader import read_record
from vehicle.signals.formats.uff_writer import write

DATA = Path(__file__).resolve().parents[2] / "data" / "uff"
POINTS = np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 3.0], [-4.0, 5.5, 0.25], [1e3, -1e-3, 7.0]])


def dataset(number, *rows):
    return "\n".join(["    -1", f"{number:6d}", *rows, "    -1", ""])


def read(tmp_path, *blocks):
    path = tmp_path / "any.uff"
    path.write_text("".join(blocks))
    return read_record(path)


def units(length, force=1.0):
    return dataset(
        164,
        f"{9:10d}{'USER_DEFINED':<20}{0:10d}",
        f"{length:25.16e}{force:25.16e}{1.0:25.16e}".replace("e", "D"),
        f"{0.0:25.16e}",
    )


def node(label, at, *, definition=0, motion=0):
    return f"{label:10d}{definition:10d}{motion:10d}{11:10d}" + "".join(f"{value:13.5e}" for value in at)


def test_sets_of_the_foreign_library(tmp_path):
    pyuff = pytest.importorskip("pyuff")
    path, zeros, labels = tmp_path / "foreign.uff", np.zeros(4, dtype=int), np.array([1, 2, 7, 9])
    file = pyuff.UFF(str(path))
    rows = {"def_cs": zeros, "disp_cs": zeros, "color": zeros}
    x, y, z = POINTS.T
    motion = np.arange(1.0, 13.0).reshape(4, 3)
    mode = {
        "model_type": 1,
        "analysis_type": 2,
        "data_ch": 2,
        "spec_data_type": 8,
        "data_type": 2,
        "load_case": 1,
        "mode_n": 3,
        "freq": 12.5,
        "modal_m": 2.5,
        "modal_damp_vis": 0.02,
        "modal_damp_his": 0.0,
        "node_nums": labels,
        "r1": motion[:, 0],
        "r2": motion[:, 1],
        "r3": motion[:, 2],
    }
    complex_one = mode | {
        "analysis_type": 3,
        "data_type": 5,
        "eig": -1.0 + 50.0j,
        "modal_a": 2.0 + 1.0j,
        "modal_b": 1j,
        "r1": motion[:, 0] * 1j,
        "r2": motion[:, 1] * (1.0 + 2.0j),
        "r3": motion[:, 2] + 0j,
    }
    with contextlib.redirect_stdout(io.StringIO()):
        file.write_sets(
            [
                pyuff.prepare_15(node_nums=labels, **rows, x=x, y=y, z=z),
                pyuff.prepare_82(trace_num=1, n_nodes=5, color=0, id="frame", nodes=np.array([1, 2, 0, 7, 9])),
                pyuff.prepare_55(**mode),
                pyuff.prepare_55(**complex_one),
            ],
            mode="overwrite",
        )
    found = read_record(path)
    assert list(found.geometry.points) == ["1", "2", "7", "9"]
    np.testing.assert_allclose(list(found.geometry.points.values()), POINTS, rtol=1e-5)
    assert found.geometry.lines == [["1", "2"], ["7", "9"]]
    normal, other = found.shapes
    assert (normal.number, normal.frequency, normal.damping_ratio, normal.modal_mass) == (3, 12.5, 0.02, 2.5)
    assert not normal.is_complex and normal.points == ("1", "2", "7", "9")
    np.testing.assert_allclose(normal.shape[:, :3], motion)
    assert other.is_complex and other.modal_a == 2.0 + 1.0j
    validated(
        "File readers", "frequency of a complex mode of a universal file", other.frequency,
        np.hypot(1.0, 50.0) / (2.0 * np.pi), rel=1e-6, unit="Hz",
        source="closed form: |s| / (2 pi) of the eigenvalue -1 + 50 i",
    )  # fmt: skip
    validated(
        "File readers", "damping ratio of a complex mode of a universal file", other.damping_ratio,
        1.0 / np.hypot(1.0, 50.0), rel=1e-6, source="closed form: -Re s / |s| of the eigenvalue -1 + 50 i",
    )  # fmt: skip
    np.testing.assert_allclose(other.shape[:, :3], motion * [1j, 1.0 + 2.0j, 1.0])


def test_nodes_and_motions_in_their_own_axes(tmp_path):
    """Against rotations written out by hand: x' = y, y' = -x about (1, 0, 0), and a cylinder."""
    systems = dataset(
        18,
        f"{5:10d}{0:10d}{0:10d}{0:10d}{1:10d}",
        "turned",
        f"{1.0:13.5e}{0.0:13.5e}{0.0:13.5e}{1.0:13.5e}{1.0:13.5e}{0.0:13.5e}",
        f"{1.0:13.5e}{0.0:13.5e}{1.0:13.5e}",
        f"{6:10d}{1:10d}{0:10d}{0:10d}{1:10d}",
        "round",
        f"{0.0:13.5e}{0.0:13.5e}{0.0:13.5e}{1.0:13.5e}{0.0:13.5e}{0.0:13.5e}",
        f"{0.0:13.5e}{0.0:13.5e}{1.0:13.5e}",
    )
    nodes = dataset(
        15, node(1, (2.0, 3.0, 4.0), definition=5, motion=5), node(2, (2.0, 90.0, 1.0), definition=6, motion=6)
    )
    shape = dataset(
        55,
        *["NONE"] * 5,
        "".join(f"{n:10d}" for n in (1, 2, 3, 8, 2, 6)),
        "".join(f"{n:10d}" for n in (2, 4, 1, 1)),
        f"{5.0:13.5e}{4.0:13.5e}{0.0:13.5e}{0.04:13.5e}",
        f"{1:10d}",
        "".join(f"{value:13.5e}" for value in (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)),
        f"{2:10d}",
        "".join(f"{value:13.5e}" for value in (1.0, 2.0, 3.0, 0.0, 0.0, 0.0)),
    )
    found = read(tmp_path, shape, systems, nodes, units(1000.0))  # the shape stands before what turns it
    np.testing.assert_allclose(found.geometry.points["1"], [1e-3 * (1.0 - 3.0), 2e-3, 4e-3], atol=1e-15)
    np.testing.assert_allclose(found.geometry.points["2"], [0.0, 2e-3, 1e-3], atol=1e-15)
    (mode,) = found.shapes
    # Hysteretic damping of 4 % is a damping ratio of 2 %. In mm and N a mass of 4 is 4000 kg, 1 rad/mm is 1000 rad/m.
    assert (mode.damping_ratio, mode.modal_mass) == (0.02, pytest.approx(4000.0))
    np.testing.assert_allclose(mode.shape[0], [0.0, 1.0, 0.0, -1000.0, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(mode.shape[1, :3], [-2.0, 1.0, 3.0], atol=1e-12)


def test_long_nodes_elements_and_results(tmp_path):
    nodes = dataset(
        2411,
        *(
            row
            for label, at in zip((3, 4, 5), POINTS, strict=False)
            for row in (
                f"{label:10d}{0:10d}{0:10d}{11:10d}",
                "".join(f"{value:25.16E}" for value in at).replace("E", "D"),
            )
        ),
    )
    elements = dataset(
        2412,
        f"{1:10d}{91:10d}{1:10d}{1:10d}{7:10d}{3:10d}",
        f"{3:10d}{4:10d}{5:10d}",
        f"{2:10d}{21:10d}{1:10d}{1:10d}{7:10d}{2:10d}",
        f"{0:10d}{1:10d}{1:10d}",
        f"{3:10d}{5:10d}",
    )
    result = dataset(
        2414,
        f"{1:10d}",
        "mode",
        f"{1:10d}",
        *["NONE"] * 5,
        "".join(f"{n:10d}" for n in (1, 2, 2, 8, 2, 3)),
        "".join(f"{n:10d}" for n in (0, 0, 0, 0, 0, 4, 0, 0)),
        f"{0:10d}{0:10d}",
        "".join(f"{value:13.5e}" for value in (0.0, 30.0, 0.0, 2.0, 0.01, 0.0)),
        "".join([f"{0.0:13.5e}"] * 6),
        f"{4:10d}",
        "".join(f"{value:13.5e}" for value in (0.5, -1.0, 0.25)),
    )
    found = read(tmp_path, nodes, elements, result)
    np.testing.assert_array_equal(list(found.geometry.points.values()), POINTS[:3])
    assert found.geometry.lines == [["3", "4", "5", "3"], ["3", "5"]]
    (mode,) = found.shapes
    assert (mode.number, mode.frequency, mode.damping_ratio, mode.modal_mass, mode.points) == (
        4,
        30.0,
        0.01,
        2.0,
        ("4",),
    )
    np.testing.assert_array_equal(mode.shape[0, :3].real, [0.5, -1.0, 0.25])


def test_a_direction_in_the_axes_of_its_node_is_told_in_the_global_ones(tmp_path):
    from tests.signals.formats.test_uff import function

    systems = dataset(
        18,
        f"{5:10d}{0:10d}{0:10d}{0:10d}{1:10d}",
        "turned",
        f"{0.0:13.5e}{0.0:13.5e}{0.0:13.5e}{0.0:13.5e}{0.0:13.5e}{-1.0:13.5e}",
        f"{1.0:13.5e}{0.0:13.5e}{0.0:13.5e}",
    )
    data = function(np.ones(8), node=12, direction=1)
    path = tmp_path / "turned.uff"
    path.write_bytes(data + (systems + dataset(15, node(12, (0.0, 0.0, 0.0), motion=5))).encode())
    (channel,) = read_record(path).channels
    assert (channel.direction, channel.remark) == ("-Z", "+X of the local axes of the node")


def test_real_foreign_files():
    """Files of the project pyuff (MIT)."""
    testlab = read_record(DATA / "testlab_geometry.uff")
    assert testlab.program == "LMS Test.Lab Rev project-15A" and len(testlab.geometry.points) == 36
    assert testlab.geometry.lines[0] == ["2", "5", "6", "3", "4", "1", "2", "3"]
    assert testlab.geometry.lines[1] == ["7", "8", "11", "14", "17", "18"]
    modes = read_record(DATA / "uff55_translation.uff").shapes
    assert [one.frequency for one in modes] == [10.0, 12.0, 13.0]
    np.testing.assert_array_equal(modes[0].shape[3, :3], 0.724863)
    mixed = read_record(DATA / "mesh_test_uff2412_mixed.uff").geometry
    assert mixed.points["11"] == (1.0, 1.0, 1.0) and mixed.lines[1] == ["3", "4", "11", "3"]


def modes():
    shape = np.zeros((2, 6), dtype=complex)
    shape[:, :3] = [[1.0, 0.5j, -1.0], [2.0 - 1.0j, 0.0, 0.25]]
    real = ModeShape(
        number=1, frequency=8.5, damping_ratio=0.03, modal_mass=12.0, points=("a", "b"), shape=shape.real + 0j
    )
    return real, ModeShape(
        number=2,
        frequency=20.0,
        damping_ratio=0.1,
        modal_a=3.0 - 4.0j,
        points=("a", "b"),
        shape=shape,
        is_complex=True,
        name="wheel",
    )


def test_what_is_written_comes_back_and_is_read_by_the_foreign_library(tmp_path):
    path, geometry = (
        tmp_path / "modes.uff",
        Geometry(points={"a": (0.0, 1.0, 2.0), "b": (3.0, 4.0, 5.0)}, lines=[("a", "b")]),
    )
    write(path, (), "modes", geometry, modes())
    found = read_record(path)
    assert found.geometry.points == {"1": (0.0, 1.0, 2.0), "2": (3.0, 4.0, 5.0)} and found.geometry.lines == [
        ["1", "2"]
    ]
    for ours, other in zip(modes(), found.shapes, strict=True):
        assert (other.number, other.is_complex, other.name) == (ours.number, ours.is_complex, ours.name)
        assert (other.frequency, other.damping_ratio) == pytest.approx((ours.frequency, ours.damping_ratio), rel=1e-5)
        assert (other.modal_mass, other.modal_a) == (ours.modal_mass, ours.modal_a)
        np.testing.assert_allclose(other.shape, ours.shape, atol=1e-5)
    pyuff = pytest.importorskip("pyuff")
    with contextlib.redirect_stdout(io.StringIO()):
        file = pyuff.UFF(str(path))
        normal, other = file.read_sets(4), file.read_sets(5)
    assert (normal["freq"], normal["modal_m"], normal["modal_damp_vis"], normal["mode_n"]) == (8.5, 12.0, 0.03, 1)
    assert other["modal_a"] == 3.0 - 4.0j and other["eig"] == pytest.approx(
        40.0 * np.pi * complex(-0.1, 0.99**0.5), rel=1e-5
    )
    np.testing.assert_allclose(other["r2"], modes()[1].shape[:, 1], atol=1e-5)


@pytest.mark.parametrize(
    ("block", "message"),
    [
        (dataset(15, node(1, (1.0, 2.0, 3.0))[:-13]), r"dataset 15 at byte 0 .*node \[1\] with 2 coordinates"),
        (dataset(15, node(1, (1.0, 2.0, 3e35))), "node .1. with 3 coordinates"),
        (dataset(82, f"{1:10d}{4:10d}{0:10d}", "NONE", f"{1:10d}{2:10d}"), "4 nodes are stated, but 2 are present"),
        (
            dataset(18, f"{1:10d}{0:10d}{0:10d}{0:10d}{1:10d}", "x", "1 1 1 1 1 1", "1 1 1"),
            "its three points are on a line",
        ),
        (
            dataset(18, f"{1:10d}{2:10d}{0:10d}{0:10d}{1:10d}", "x", "0 0 0 1 0 0", "0 0 1"),
            "axis system 1 has type 2 but must",
        ),
        (dataset(2412, f"{1:10d}{91:10d}{1:10d}{1:10d}{7:10d}{3:10d}", f"{3:10d}"), "a line is missing or too short"),
        (dataset(55, *["NONE"] * 5, "1 2 2 8 2 3", "2 4 1 1", "5 1 0 0", "1", "1.0 2.0"), "a line is missing"),
        (
            dataset(55, *["NONE"] * 5, "1 2 2 8 2 3", "2 4 1 1", "5 1 0 0", "1", "1.0 x 2.0"),
            r"not a number\); it is truncated",
        ),
        (dataset(55, *["NONE"] * 5, "1 2 2 8 2 9", "2 4 1 1", "5 1 0 0", "1", "1 1 1"), "9 values per node"),
        (dataset(55, *["NONE"] * 5, "1 2 2 8 2 3", "2 4 1 1", "5e40 1 0 0", "1", "1 1 1"), "above 1e.30"),
        (units(0.0), "has no valid factors of length and force"),
    ],
)
def test_damaged_geometry_is_refused(tmp_path, block, message):
    with pytest.raises(DataError, match=message):
        read(tmp_path, block, dataset(15, node(5, (0.0, 0.0, 0.0))))
