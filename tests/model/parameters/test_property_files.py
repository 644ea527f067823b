"""Property files of Adams Car in a vehicle file: numbers, units, signs, sources, and files that are refused."""

from pathlib import Path

import numpy as np
import pytest

from tests.property_file_set import BUMP, CURVES, DAMPER, DAMPING, FILES, FRONT_TABLES, property_file, write_car
from vehicle import Car
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.parameter_list import parameter_list
from vehicle.model.parameters.vehicle import load_vehicle

INCH, POUND = 0.0254, 4.4482216152605


def numbers(file, path):
    table = load_vehicle(file).table
    for key in path.split("."):
        table = table[key]
    return table


def test_a_damper_file_has_the_signs_and_units_of_the_vehicle_file(tmp_path):
    damper = numbers(write_car(tmp_path), "front.damper")
    x = np.linspace(-0.999, 0.999, 401)
    velocity, force = np.array(DAMPER, dtype=float).T
    expected = np.interp(1e3 * x, velocity, force)
    assert np.interp(x, damper["velocity"], damper["force"]) == pytest.approx(expected)


def test_a_spring_file_is_positive_in_compression(tmp_path):
    spring = numbers(write_car(tmp_path), "front.main_spring")
    assert spring["stiffness"] == pytest.approx(30e3)
    table = spring["table"]
    # The vehicle file counts extension positive: 160 mm of compression are 4500 N + 10 mm * 70 N/mm.
    assert np.interp(-0.16, table["displacement"], table["force"]) == pytest.approx(-5200.0)
    assert np.interp(0.05, table["displacement"], table["force"]) == pytest.approx(1500.0)


def test_a_linear_spring_file_is_a_number_without_rows_of_the_solver(tmp_path):
    linear = property_file("spr", {"CURVE": [(x, 30 * x) for x in range(-100, 101, 10)]})
    spring = numbers(write_car(tmp_path, files={**FILES, "front.spr": linear}), "front.main_spring")
    assert set(spring) == {"stiffness"} and spring["stiffness"] == pytest.approx(30e3)


def test_a_bushing_file_has_the_law_of_each_axis(tmp_path):
    bushing = numbers(write_car(tmp_path), "front.bushings.arm_front")
    assert bushing["stiffness"] == pytest.approx([1e6, 8e5, 5e5])
    assert bushing["damping"] == pytest.approx([400.0, 300.0, 200.0])
    # 1000 N mm/deg
    assert bushing["rotational_stiffness"] == pytest.approx(np.rad2deg(1.0))
    assert bushing["table_x"] == {"displacement": pytest.approx([-2e-3, -1e-3, 1e-3, 2e-3]),
                                  "force": pytest.approx([-4e3, -1e3, 1e3, 4e3])}  # fmt: skip
    assert "table_y" not in bushing


def test_stops_act_from_their_clearances_on(tmp_path):
    stop = numbers(write_car(tmp_path), "front.damper.stop")
    at = np.array([-0.075, -0.06, -0.05, 0.0, 0.06, 0.065])
    assert np.interp(at, stop["displacement"], stop["force"]) == pytest.approx([-4000, -500, 0, 0, 0, 1500])


def test_stops_without_clearance_act_from_the_design_position_on(tmp_path):
    tables = {**FRONT_TABLES, "damper": FRONT_TABLES["damper"].replace("0.05", "0.0").replace("0.06", "0.0")}
    stop = numbers(write_car(tmp_path, tables), "front.damper.stop")
    assert stop["displacement"].count(0.0) == 1 and "-0.0" not in map(str, stop["displacement"] + stop["force"])
    # The forces of the test with clearances, each that much nearer to the design position.
    at = np.array([-0.025, -0.01, 0.0, 0.005])
    assert np.interp(at, stop["displacement"], stop["force"]) == pytest.approx([-4000, -500, 0, 1500])


def test_a_bump_stop_alone_leaves_extension_free(tmp_path):
    tables = {**FRONT_TABLES, "damper": FRONT_TABLES["damper"].partition("rebound =")[0]}
    stop = numbers(write_car(tmp_path, tables), "front.damper.stop")
    assert stop["force"][-2:] == [0.0, 0.0] and stop["displacement"][-2] == pytest.approx(-0.05)


def test_units_are_those_of_the_file(tmp_path):
    units = {"LENGTH": "inch", "ANGLE": "radians", "FORCE": "pound_force", "TIME": "millisecond"}
    rows = {f"{name}_CURVE": [(-1, -2), (1, 2)] for name in CURVES}
    files = {**FILES, "arm.bus": property_file("bus", rows, DAMPING, units)}
    bushing = numbers(write_car(tmp_path, files=files), "front.bushings.arm_front")
    assert bushing["stiffness"] == pytest.approx([2 * POUND / INCH] * 3)
    assert bushing["damping"] == pytest.approx([c * POUND / INCH * 1e-3 for c in (0.4, 0.3, 0.2)])
    assert bushing["rotational_stiffness"] == pytest.approx(2 * POUND * INCH)


def test_the_source_of_each_number_is_the_file(tmp_path):
    file = write_car(tmp_path)
    sources = {entry.path: entry.source for entry in parameter_list(load_vehicle(file), file)}
    units = "mm, newton, second, degrees"
    assert sources["front.damper.force"] == f"front.dpr (dpr; {units})"
    assert sources["front.main_spring.table.force"] == f"front.spr (spr; {units})"
    assert sources["front.bushings.arm_front.damping"] == f"arm.bus (bus; {units})"
    assert sources["front.damper.stop.force"] == f"front.bum (bum; {units}); front.reb (reb; {units})"
    assert sources["front.damper.coulomb_friction"] != sources["front.damper.force"]


def test_a_file_over_a_base_names_a_file_alone(tmp_path):
    write_car(tmp_path)
    (tmp_path / "other.dpr").write_text(dpr([(-500, -900), (500, 1100)]))
    (tmp_path / "mine.toml").write_text('base = "vehicle.toml"\n[front.damper]\ncurve = "other.dpr"\n')
    file = tmp_path / "mine.toml"
    sources = {entry.path: entry.source for entry in parameter_list(load_vehicle(file), file)}
    assert numbers(file, "front.damper.force") == [-900.0, 1100.0]
    assert sources["front.damper.force"].startswith("other.dpr")
    assert sources["front.main_spring.stiffness"].startswith("front.spr")


def test_a_file_replaces_the_numbers_of_the_base_and_numbers_its_file(tmp_path):
    """Keys of the base counted as given by the user beside the file: "without force in the same section"."""
    write_car(tmp_path)
    (tmp_path / "bench.csv").write_text("velocity [m/s],force [N]\n-1,-2000\n0,0\n1,1000\n")
    (tmp_path / "spring.csv").write_text("displacement [m],force [N]\n-0.2,-9000\n-0.1,-3000\n0,0\n0.1,3000\n")
    (tmp_path / "numbers.toml").write_text(
        'base = "vehicle.toml"\n[front.damper]\nvelocity = [-1, 0, 1]\nforce = [-900, 0, 700]\n'
        "[front.damper.stop]\ndisplacement = [-0.06, -0.05, 1]\nforce = [-500, 0, 0]\n"
        "[front.main_spring]\nstiffness = 2e4\n"
        "[front.bushings.arm_front]\nstiffness = [1e6, 1e6, 1e6]\ndamping = [9, 9, 9]\nrotational_stiffness = 7\n"
    )
    over_files, base = numbers(tmp_path / "numbers.toml", "front"), numbers(tmp_path / "vehicle.toml", "front")
    assert over_files["damper"]["force"] == [-900, 0, 700] and over_files["damper"]["stop"]["force"] == [-500, 0, 0]
    assert over_files["main_spring"] == {"stiffness": 2e4}
    assert "table_x" not in over_files["bushings"]["arm_front"]
    (tmp_path / "files.toml").write_text(
        'base = "numbers.toml"\n[front.damper]\ncurve = "bench.csv"\n[front.main_spring]\ncurve = "spring.csv"\n'
        + FRONT_TABLES["damper"].partition("[front.damper.stop]")[2].join(["[front.damper.stop]", "\n"])
        + FRONT_TABLES["bushings.arm_front"]
    )
    over_numbers = numbers(tmp_path / "files.toml", "front")
    assert over_numbers["damper"]["velocity"] == [-1.0, 0.0, 1.0]
    assert over_numbers["damper"]["force"] == [-2000.0, 0.0, 1000.0]
    assert over_numbers["damper"]["stop"] == base["damper"]["stop"]
    assert over_numbers["main_spring"]["table"]["force"][0] == -9000.0
    assert over_numbers["bushings"]["arm_front"] == base["bushings"]["arm_front"]


def test_a_file_of_an_override_replaces_the_numbers_of_the_car(tmp_path):
    (tmp_path / "bench.csv").write_text("velocity [m/s],force [N]\n-1,-2000\n0,0\n1,1000\n")
    words = ["front.damper.viscous_law=table", f'front.damper.curve="{tmp_path / "bench.csv"}"']
    damper = load_vehicle(Path("sedan"), words).table["front"]["damper"]
    assert damper["force"] == [-2000.0, 0.0, 1000.0] and "curve" not in damper
    varied = Car.load("sedan").with_(words)
    assert varied.vehicle.table["front"]["damper"]["force"] == damper["force"]


def test_a_spring_of_a_test_bench_is_a_table(tmp_path):
    (tmp_path / "bench.csv").write_text("displacement [m],force [N]\n-0.2,-9000\n-0.1,-3000\n0,0\n0.1,3000\n")
    tables = {"main_spring": '[front.main_spring]\ncurve = "bench.csv"'}
    spring = numbers(write_car(tmp_path, tables), "front.main_spring")
    assert spring["stiffness"] == pytest.approx(3e4) and spring["table"]["force"][0] == -9000.0


def test_a_number_beside_a_bushing_file_takes_precedence(tmp_path):
    rows = {f"{name}_CURVE": rows for name, rows in CURVES.items()} | {"TZ_CURVE": [(-20, -5000), (20, 5000)]}
    files = {**FILES, "arm.bus": property_file("bus", rows, DAMPING)}
    with pytest.raises(ConfigurationError, match=r"57\.3, 57\.3, 14\.32 N m/rad.*set rotational_stiffness"):
        load_vehicle(write_car(tmp_path, files=files))
    table = FRONT_TABLES["bushings.arm_front"] + "\nrotational_stiffness = 40.0"
    file = write_car(tmp_path, {**FRONT_TABLES, "bushings.arm_front": table}, files)
    assert numbers(file, "front.bushings.arm_front.rotational_stiffness") == 40.0


def dpr(rows=DAMPER, **more):
    return property_file("dpr", {"CURVE": rows}, **more)


BAD = {
    "no units": ("front.dpr", dpr().replace("[UNITS]", "[MODEL]"), (r"front\.dpr: the block \[UNITS\] "
                                                                   r"is missing.*add it")),
    "no length": ("front.dpr", dpr(units={"FORCE": "newton", "TIME": "s"}), r"\[UNITS\] has no LENGTH; add a line"),
    "unit": ("front.dpr", dpr(units={"LENGTH": "furlong", "FORCE": "newton", "TIME": "s"}), "LENGTH = 'furlong'"),
    "no curve": ("front.dpr", property_file("dpr", {}), ("the block \\[CURVE\\] is missing")),
    "twice": ("front.dpr", dpr() + "[CURVE]\n0 0\n", r"the block \[CURVE\] appears twice"),
    "unsorted": ("front.dpr", dpr([(-1, -1), (-2, -2), (1, 1)]), "has -2 after -1 but must be ascending"),
    "NaN": ("front.dpr", dpr([(-1, -1), (0, float("nan")), (1, 1)]), "has 'nan' instead of a finite number"),
    "word": ("front.dpr", dpr().replace("-300", "fast"), "has 'fast' instead of a finite number"),
    "columns": ("front.dpr", dpr().replace("-300", "-300 0.0"), r"a row of 3 columns instead of 2"),
    "a point": ("front.dpr", dpr([(0, 0)]), "has 1 points, but at least 2"),
    "falling": ("front.dpr", dpr([(-1, 1), (1, -1)]), ("front.damper.force: found -1.0 N after 1.0 N, must not "
        "decrease")),
    "another": ("front.dpr", FILES["front.spr"], r"a spring \('spr'\), not for a damper \('dpr'\)"),
    "damper as spring": ("front.spr", dpr(), r"a damper \('dpr'\), not for a spring \('spr'\)"),
    "tyre": ("front.spr", dpr().replace("'dpr'", "'tir'"), r"type 'tir', not for a spring"),
    "bracket": ("front.dpr", dpr().replace("[CURVE]", "[CURVE"), r"'\[CURVE' has no ']' at its end"),
    "no damping": ("arm.bus", FILES["arm.bus"].replace("FZ_DAMPING", "FZ_D"), r"\[DAMPING\] lacks FX_DAMPING.*set da"),
    "no axis": ("arm.bus", FILES["arm.bus"].replace("[FZ_CURVE]", "[FW_CURVE]"), r"the block \[FZ_CURVE\] is missing"),
    "stop with force": ("front.bum", property_file("bum", {"CURVE": BUMP[1:]}), "a stop must have 0 N at its contact"),
    "rebound as bump": ("front.bum", FILES["front.reb"], r"a rebound stop \('reb'\), not for a bump stop"),
    "one side": ("front.spr", property_file("spr", {"CURVE": [(10, 300), (100, 3000)]}), "must contain 0"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_a_wrong_property_file_is_refused_by_name(case, tmp_path):
    name, content, message = BAD[case]
    with pytest.raises(ConfigurationError, match=message) as caught:
        load_vehicle(write_car(tmp_path, files={**FILES, name: content}))
    assert "front." in str(caught.value)


TABLES = {
    "both": ("main_spring", FRONT_TABLES["main_spring"] + "\nstiffness = 3e4", "without stiffness in the same section"),
    "points": ("main_spring", '[front.main_spring]\nstiffness = 3e4\ntable = { curve = "front.spr" }',
               "one level higher: front.main_spring.curve"),
    "clearance": ("damper", FRONT_TABLES["damper"].replace(", clearance = 0.05", ""), "curve .a file. and clearance"),
    "negative": ("damper", FRONT_TABLES["damper"].replace("0.05", "-0.05"),
                 r"stop\.bump\.clearance: found -0\.05"),
    "stop": ("damper", FRONT_TABLES["damper"].split("[front.damper.stop]")[0] + 'stop = { curve = "front.bum" }',
             r"front\.damper\.stop\.bump\.curve"),
    "missing": ("main_spring", '[front.main_spring]\ncurve = "none.spr"', "front.main_spring.curve: .*none.spr"),
    "csv": ("bushings.arm_front", '[front.bushings.arm_front]\ncurve = "axis.csv"', "is not a property file"),
}  # fmt: skip


@pytest.mark.parametrize("case", TABLES)
def test_a_wrong_table_is_refused_by_its_path(case, tmp_path):
    name, table, message = TABLES[case]
    (tmp_path / "axis.csv").write_text("displacement [m],force [N]\n-1,-1\n1,1\n")
    with pytest.raises(ConfigurationError, match=message):
        load_vehicle(write_car(tmp_path, {**FRONT_TABLES, name: table}))


def test_an_xml_property_file_is_refused_with_the_mend(tmp_path):
    files = {**FILES, "front.dpr": "<?xml version='1.0'?>\n<!-- [MDI_HEADER] -->"}
    with pytest.raises(ConfigurationError, match="XML property file; save it in TeimOrbit format"):
        load_vehicle(write_car(tmp_path, files=files))


def test_a_file_that_is_not_beside_the_car_is_in_the_working_folder(tmp_path, monkeypatch):
    """As an option `--set ...curve=FILE` is typed; a file of this name beside the vehicle file comes first."""
    beside = numbers(write_car(tmp_path), "front.damper")
    car, work = tmp_path / "car", tmp_path / "work"
    car.mkdir()
    work.mkdir()
    for path in tmp_path.iterdir():
        if path.is_file():
            path.rename((car if path.suffix == ".toml" else work) / path.name)
    file = next(car.glob("*.toml"))
    with pytest.raises(ConfigurationError, match="does not exist"):
        load_vehicle(file)
    monkeypatch.chdir(work)
    assert numbers(file, "front.damper") == beside
    damper = next(work.glob("*.dpr"))
    (car / damper.name).write_text("not a property file")
    with pytest.raises(ConfigurationError, match=damper.name):
        load_vehicle(file)
