"""Roads and curves of tests from files of other programs: their units, their formats, and what is refused."""

import numpy as np
import pytest
from scipy.io import savemat

from vehicle.errors import ConfigurationError, DataError
from vehicle.model.parameters.curves import with_curve_files
from vehicle.signals.excitation.measured_road import read_road
from vehicle.signals.formats.named_columns import named_columns
from vehicle.studies.sweeps.sweep_table import read_variations

DISTANCE = np.arange(0.0, 5.0, 0.5)
PROFILE = "Profilometer 7\nDistance [m];Left [mm];Right [mm]\n"
ROWS = "\n".join(f"{d:g};{1e3 * 0.01 * d:.3f};{-1e3 * 0.02 * d:.3f}".replace(".", ",") for d in DISTANCE)


def test_a_road_of_a_logger(tmp_path):
    path = tmp_path / "profile.txt"
    path.write_text(PROFILE + ROWS + "\n")
    road = read_road(path, 1.5)
    np.testing.assert_allclose(road.distance, DISTANCE)
    np.testing.assert_allclose(road.left, 0.01 * DISTANCE, atol=1e-12)
    np.testing.assert_allclose(road.right, -0.02 * DISTANCE, atol=1e-12)
    path.write_text(PROFILE + ROWS.replace("1;", "0;") + "\n")
    with pytest.raises(DataError, match="the distance must increase from row to row"):
        read_road(path, 1.5)


def test_a_road_as_structures_of_matlab(tmp_path):
    def signal(values, unit):
        about = {"increment": 1.0, "number_of_values": float(values.size), "quantity": {"label": "s"}}
        return {"x_values": about, "y_values": {"values": values, "quantity": {"label": unit}}}

    path = tmp_path / "profile.mat"
    savemat(path, {"distance": signal(DISTANCE, "m"), "left": signal(DISTANCE, "cm"), "right": signal(DISTANCE, "mm")})
    road = read_road(path, 1.5)
    np.testing.assert_allclose([road.left[-1], road.right[-1]], [0.045, 0.0045])


def test_the_curve_of_a_damper_test_in_its_own_units(tmp_path):
    (tmp_path / "damper.txt").write_text("machine\nVelocity (mm/s)\tForce (kN)\n-100\t-0.5\n0\t0\n100\t0.7\n500\t1.2\n")
    found = with_curve_files({"viscous_law": "table", "curve": "damper.txt"}, tmp_path)
    np.testing.assert_allclose(found["velocity"], [-0.1, 0.0, 0.1, 0.5])
    np.testing.assert_allclose(found["force"], [-500.0, 0.0, 700.0, 1200.0])
    (tmp_path / "damper.txt").write_text("machine\nVelocity (mm)\tForce (kN)\n-100\t-0.5\n0\t0\n100\t0.7\n500\t1.2\n")
    with pytest.raises(ConfigurationError, match="curve: "):
        with_curve_files({"viscous_law": "table", "curve": "damper.txt"}, tmp_path)


@pytest.mark.parametrize(
    ("head", "message"),
    [
        ("a [m];b [m]", r"0 columns 'left' instead of one \[m\]; found 'a' \[m\], 'b"),
        ("left [m];Left [m]", "2 columns 'left'"),
        ("left [s];b [m]", "column 'left' has the unit 's' but must have one of m, cm, mm"),
        ("left;b", "column 'left' has the unit ''"),
    ],
)
def test_what_is_no_such_column_is_refused(tmp_path, head, message):
    path = tmp_path / "x.csv"
    path.write_text(head + "\n" + "\n".join(f"{n}.0;{n}.5" for n in range(6)) + "\n")
    with pytest.raises(DataError, match=message):
        named_columns(path, {"left": "m"})


def test_a_table_of_variations_of_a_spreadsheet(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    for row in (["damper.viscous", "damper.friction_law"], [1500.5, "coulomb"], [None, None], [2000, "stribeck"]):
        book.active.append(row)
    book.save(tmp_path / "variations.xlsx")
    expected = (["damper.viscous", "damper.friction_law"], [("1500.5", "coulomb"), ("2000", "stribeck")])
    assert read_variations(tmp_path / "variations.xlsx") == expected
