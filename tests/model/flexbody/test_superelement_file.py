"""Data file: round trip to the last digit; damaged, incomplete or misspelt files are rejected."""

import re

import numpy as np
import pytest

from tests.model.flexbody.box_body import box_fields
from vehicle.errors import DataError, OutputError
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.flexbody.superelement_file import read_superelement, write_superelement


@pytest.fixture
def path(tmp_path):
    file = tmp_path / "box.toml"
    write_superelement(file, Superelement(**box_fields()))
    return file


def test_round_trip_keeps_every_digit(path):
    written, read = Superelement(**box_fields()), read_superelement(path)
    for name in ("positions", "edges", "node_mass", "frequencies", "damping_ratio", "shapes"):
        np.testing.assert_array_equal(getattr(read, name), getattr(written, name))
    for name in ("name", "nodes", "mode_names", "provenance"):
        assert getattr(read, name) == getattr(written, name)
    assert {k: v.tolist() for k, v in read.residual.items()} == {"corner_1": np.diag([1e-7, 5e-8, 4e-8]).tolist()}
    assert [file.name for file in path.parent.iterdir()] == ["box.toml"]


BAD = {
    "misspelt key": ("mass_kg = 30.0", "mas_kg = 30.0", "node 1: unknown key 'mas_kg'; did you mean mass_kg?"),
    "misspelt top key": ("provenance =", "provenence =", "unknown key 'provenence'; did you mean provenance?"),
    "key missing": ("damping_ratio = 0.02\n", "", "mode 1: key 'damping_ratio' is missing"),
    "mode count": ("mode_count = 4", "mode_count = 9", "sections [[mode]], but mode_count = 9. The"),
    "node count": ("node_count = 8", "node_count = 43", "sections [[node]], but node_count = 43. The"),
    "not a number": ("mass_kg = 30.0", 'mass_kg = "heavy"', "node 1, mass_kg: must be numbers, not 'heavy'"),
    "true is no number": ("mass_kg = 30.0", "mass_kg = true", "node 1, mass_kg: must be numbers, not 'True'"),
    "NaN": ("mass_kg = 30.0", "mass_kg = nan", "node_mass[0]: found nan, every number must be finite."),
    "two numbers": (
        "position_m = [0.0, -0.5, 0.4]",
        "position_m = [0.0, -0.5]",
        "node 2, position_m: shape (3,), must be (2,)",
    ),
    "edge": ('["corner_0", "corner_1"]', '["corner_0", "nose"]', "edges: ['corner_0', 'nose'] is not a pair of"),
    "format": ("modal superelement 2", "modal superelement 7", "format is 'modal superelement 7'"),
    "node renamed, edges not": ('"corner_7"\n', '"corner_6"\n', "edges: "),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_files_are_refused_with_path_and_place(path, case):
    old, new, message = BAD[case]
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(DataError, match=re.escape(f"{path}: ") + ".*" + re.escape(message)):
        read_superelement(path)


def test_a_file_that_cannot_be_written_leaves_nothing_behind(tmp_path):
    (tmp_path / "taken.toml").mkdir()
    for target in (tmp_path / "nowhere" / "box.toml", tmp_path / "taken.toml"):
        with pytest.raises(OutputError, match="cannot be written"):
            write_superelement(target, Superelement(**box_fields()))
    assert [entry.name for entry in tmp_path.iterdir()] == ["taken.toml"]
