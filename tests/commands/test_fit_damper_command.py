"""`python -m vehicle fit-damper`: printed summary, files, and lines that are the fitted law in a vehicle file."""

import dataclasses
import json
import tomllib
from pathlib import Path

import numpy as np
import pytest

from vehicle.commands.fit_damper import main
from vehicle.errors import ConfigurationError
from vehicle.model.laws.damper import damper_law
from vehicle.model.laws.jenkins import Jenkins
from vehicle.model.laws.presliding import presliding_elements
from vehicle.model.parameters.force_elements import Damper
from vehicle.model.parameters.toml_file import build
from vehicle.studies.dampers.damper_fit import DamperFit
from vehicle.studies.dampers.damper_law import DamperLaw
from vehicle.studies.dampers.damper_test import read_test
from vehicle.studies.dampers.damper_text import notice_lines, vehicle_lines
from vehicle.studies.dampers.fitted_damper import FittedDamper, fit_damper
from vehicle.studies.dampers.over_condition import control_lines

HEAD = "time [s],displacement [mm],velocity [mm/s],force [N]"


def records(folder, damping=(1200.0,), current=("",)):
    """Two sines of a viscous damper with Coulomb friction and gas, 2 % noise, for each damping constant."""
    rng, paths = np.random.default_rng(5), []
    for c, name in zip(damping, current, strict=True):
        for amplitude, frequency in ((0.02, 1.0), (0.004, 5.0)):
            t = np.arange(400) / (100.0 * frequency)
            x, v = (amplitude * f(2.0 * np.pi * frequency * t) for f in (np.sin, np.cos))
            v = 2.0 * np.pi * frequency * v
            force = c * v + 60.0 * np.tanh(v / 1e-4) - 150.0
            force += 0.02 * np.std(force) * rng.standard_normal(t.size)
            paths.append(folder / f"sine{1e3 * amplitude:.0f}{name}.csv")
            np.savetxt(
                paths[-1], np.column_stack([t, 1e3 * x, 1e3 * v, force]), delimiter=",", header=HEAD, comments=""
            )
    return [str(path) for path in paths]


def test_files_and_summary(tmp_path, capsys):
    folder = tmp_path / "out"
    assert main([*records(tmp_path), "--output", str(folder)]) == 0
    said = capsys.readouterr().out
    assert "chosen: linear damping + Coulomb friction" in said
    assert "next: a sine of " in said and "would reduce the uncertainty of the force from" in said
    assert "not determined: friction at rest" in said and "126 mm/s" in said and "10 mm/s" in said
    damper = build(Damper, tomllib.loads((folder / "damper.toml").read_text()), "damper")
    assert damper.viscous == pytest.approx(1200.0, rel=0.02) and damper.coulomb_friction == pytest.approx(60.0, abs=3.0)
    assert damper.gas_force == pytest.approx(150.0, abs=2.0) and damper.friction_law == "coulomb"
    assert damper.tested is not None
    # Two sines: 20 mm at 1 Hz and 4 mm at 5 Hz have 0.126 m/s both.
    assert damper.tested.velocity == pytest.approx((0.04 * np.pi, 0.04 * np.pi), rel=1e-3)
    assert damper.tested.amplitude == pytest.approx((0.004, 0.02), rel=1e-3)
    assert damper.tested.frequency == pytest.approx((1.0, 5.0), rel=0.01) and damper.tested.current is None
    assert (folder / "damper.png").stat().st_size > 20_000
    assert (folder / "damper_tests.csv").read_text().count("\n") == 3


def test_a_current_gives_a_fit_each_and_the_limits_of_a_semi_active_damper(tmp_path, capsys):
    files = records(tmp_path, (800.0, 2400.0), ("_0A", "_1A"))
    assert main([*files, "--pattern", "*_{current}A", "--json", "--output", str(tmp_path / "out")]) == 0
    found = json.loads(capsys.readouterr().out)
    assert {test["condition"] for test in found["next_tests"]} == {"current 0", "current 1"}
    assert all(test["after"] <= test["before"] for test in found["next_tests"])
    names = {path.name for path in (tmp_path / "out").iterdir() if path.suffix in (".toml", ".png", ".csv")}
    assert names == {"damper_tests.csv", "damper_control.toml", "damper_control.png"} | {
        f"damper_{name}current_{current}.{ending}"
        for current in (0, 1)
        for name, ending in (("", "toml"), ("", "png"), ("band_", "csv"), ("band_", "png"))
    }
    control = tomllib.loads((tmp_path / "out" / "damper_control.toml").read_text())
    assert control == pytest.approx({"minimum_damping": 800.0, "maximum_damping": 2400.0}, rel=0.02)
    assert found["control"] == [f"damper.control.{name}={value!r}" for name, value in control.items()]
    laws = [tomllib.loads((tmp_path / "out" / f"damper_current_{n}.toml").read_text()) for n in (0, 1)]
    assert [law["tested"]["current"] for law in laws] == [[0.0, 0.0], [1.0, 1.0]]
    assert "# tested.current = [0.0, 1.0]" in (tmp_path / "out" / "damper_control.toml").read_text()
    page = (tmp_path / "out" / "report.html").read_text()
    for text in ("Law at current 0", "Law at current 1", "maximum_damping", "friction_law", "sine20_1A"):
        assert text in page
    settings = [line.split() for line in (tmp_path / "out" / "damper_control.toml").read_text().splitlines()[3:5]]
    assert [float(words[4]) for words in settings] == pytest.approx([60.0, 60.0], abs=3.0)  # friction


def test_typed_conditions(tmp_path):
    """A value for each file, or for all; the law is that of the files with that condition."""
    files = records(tmp_path, (800.0, 2400.0), ("_a", "_b"))
    fits = fit_damper(files, conditions={"current": "0,0,1.5,1.5", "temperature": "20"})
    assert [dict(each.conditions) for each in fits] == [
        {"current": current, "temperature": 20.0} for current in (0.0, 1.5)
    ]
    assert [each.curve_damping() for each in fits] == pytest.approx([800.0, 2400.0], rel=0.02)
    with pytest.raises(ConfigurationError, match="found 3 values for 4 files"):
        fit_damper(files, conditions={"current": "0,1,2"})


LAWS = {
    DamperLaw(bends=1): [150.0, 5000.0, 1200.0, 0.06],
    DamperLaw(bends=2, own_sides=True): [150.0, 6e3, 3e3, 900.0, 0.05, 0.04, 4e3, 2e3, 700.0, 0.06, 0.05],
    DamperLaw(bends=1, friction="stribeck"): [150.0, 5000.0, 1200.0, 0.06, 50.0, 80.0, 0.01],
    DamperLaw(friction="presliding", elements=3): [90.0, 1500.0, 40.0, 1e-4, 30.0, 2e-3, 20.0, 5e-4],
    DamperLaw(friction="coulomb", gas_stiffness=True): [90.0, 1500.0, 40.0, 3000.0],
}


def test_a_notice_of_several_tests_is_said_once(tmp_path):
    tests = [read_test(Path(path)) for path in records(tmp_path)]
    tests = [dataclasses.replace(tests[0], notices=("a", "b")), dataclasses.replace(tests[1], notices=("a",))]
    fit = DamperFit(law=DamperLaw(), parameters=np.array([150.0, 1200.0]))
    lines = notice_lines(FittedDamper(conditions={}, tests=tests, fit=fit, compared=[fit]))
    assert lines == ["sine20, sine4: a", "sine20: b"]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.title)
def test_the_lines_are_the_fitted_law(law, tmp_path):
    parameters = np.array(LAWS[law])
    test = read_test(Path(records(tmp_path)[0]))
    fit = DamperFit(law=law, parameters=parameters, errors=0.01 * parameters)
    fitted = FittedDamper(conditions={}, tests=[test], fit=fit, compared=[fit])
    damper = build(Damper, tomllib.loads(vehicle_lines(fitted)), "damper")
    force = damper_law(damper).force(test.velocity)
    if damper.friction_law == "presliding":
        stiffness, limit = (
            damper.coulomb_friction * presliding_elements(damper).T[1],
            presliding_elements(damper).T[0],
        )
        elements = Jenkins(stiffness=limit, limit=stiffness)
        smooth = damper_law(build(Damper, tomllib.loads(vehicle_lines(fitted)) | {"coulomb_friction": 0.0}, "damper"))
        force = smooth.force(test.velocity) + elements.path(test.displacement - test.displacement[0])
    if damper.stop is not None:
        force = force + np.interp(test.displacement, damper.stop.displacement, damper.stop.force)
    # The smooth friction of arrays is an arcus tangent, 4 % low at 1 mm/s; the clamped line is that of the car.
    moving = np.abs(test.velocity) > 0.02
    np.testing.assert_allclose(force[moving], fit.force(test)[moving], atol=2.0)
    assert control_lines([fitted, fitted]).startswith("# damping: constant with the work of the curve in the tests")


@pytest.mark.parametrize(("stiffness", "line"), [(2e7, "stiffness.z = 20000000.0"), (1e9, "no series stiffness")])
def test_only_a_stiffness_that_the_tests_show_is_for_the_mount(stiffness, line, tmp_path):
    law, test = DamperLaw(friction="coulomb", series=True), read_test(Path(records(tmp_path)[0]))
    fit = DamperFit(law=law, parameters=np.array([150.0, 1200.0, 60.0, stiffness]), errors=np.ones(4))
    text = vehicle_lines(FittedDamper(conditions={}, tests=[test], fit=fit, compared=[fit]))
    assert line in text and ("stiffness.z" in text) == (stiffness < 1e9)


def test_wrong_files_are_named(tmp_path, capsys):
    path = records(tmp_path)[0]
    assert main([path, path, "--output", str(tmp_path / "out")]) == 2
    assert "found 2 files of tests; name at least one, each once" in capsys.readouterr().err


def headless(folder, columns, factor=1e3):
    """The same tests without a header, with or without the velocity, in millimetres or other units."""
    paths = []
    for path in records(folder):
        table = np.loadtxt(path, delimiter=",", skiprows=1)
        table[:, 1:3] *= 1e-3 * factor
        paths.append(str(Path(path).with_suffix(".txt")))
        np.savetxt(paths[-1], table[:, columns], fmt="%.7e")
    return paths


def fitted(capsys, words):
    assert main([*words, "--json", "--force"]) == 0
    return json.loads(capsys.readouterr().out)


@pytest.mark.parametrize("columns", [[0, 1, 2, 3], [0, 1, 3]], ids=["with velocity", "without velocity"])
def test_files_without_a_header(tmp_path, capsys, columns):
    """Time, displacement [mm], perhaps velocity [mm/s], force [N]; the JSON has law, parameters and errors."""
    paths = headless(tmp_path, columns)
    found = fitted(capsys, [*paths, "--output", str(tmp_path / "out")])
    assert [test["file"] for test in found["tests"]] == ["sine20", "sine4"]
    assert all(test["rms_relative"] < 0.05 and test["left_out"] < 0.1 for test in found["tests"])
    values = {each["path"]: each for each in found["parameters"]}
    assert values["damper.damping_1"]["value"] == pytest.approx(1200.0, rel=0.05)
    assert values["damper.damping_1"]["unit"] == "N s/m" and values["damper.damping_1"]["standard_error"] > 0.0
    assert any(text.startswith("damper.coulomb_friction=") for text in found["set"]) and found["chosen"]
    assert any(
        ("the file has no header; the columns are read as time [s], displacement [mm]") in text
        for text in found["notices"]
    )


def test_units_of_columns_and_metres_without_a_unit(tmp_path, capsys):
    """A displacement below 1 may be in metres: it is asked for; a unit may name its column."""
    paths = headless(tmp_path, [0, 1, 2, 3], factor=1.0)
    words = [*paths, "--output", str(tmp_path / "out")]
    assert main(words) == 3
    assert "--unit displacement=m or --unit displacement=mm" in capsys.readouterr().err
    by_role = fitted(capsys, [*words, "--unit", "displacement=m", "--unit", "velocity=m/s"])
    by_column = fitted(capsys, [*words, "--unit", "2=m", "--unit", "column 3=m/s"])
    assert by_column == by_role
    values = {each["path"]: each["value"] for each in by_role["parameters"]}
    assert values["damper.damping_1"] == pytest.approx(1200.0, rel=0.05)
    assert main([*words, "--unit", "displacement=m", "--unit", "load=N"]) == 2
    assert "--unit load=N: " in capsys.readouterr().err
