"""Effects of single parameters: those of single runs, their ranking, their error, and the sentence on them."""

import csv
import io
import re
from dataclasses import replace

import numpy as np
import pytest

from scenarios.signals.bump import bump
from vehicle import Car, road
from vehicle.commands.sweep import main
from vehicle.errors import ConfigurationError, DataError
from vehicle.studies.sweeps.case import parameter_cells
from vehicle.studies.sweeps.case_result import Result
from vehicle.studies.sweeps.differences import DifferencesWriter
from vehicle.studies.sweeps.effects import Effect, Effects, effect_sentence, write_effects
from vehicle.studies.sweeps.parameter_effects import effects_of, parameter_effects, single_changes, varied_parameters
from vehicle.studies.sweeps.plan import plan_sweep
from vehicle.studies.sweeps.sweep_settings import SweepSettings

NAN = float("nan")


@pytest.mark.parametrize(
    ("name", "ride", "groups"),
    [
        ("sedan", road("B", 80, duration=2.5), ("rear.damper.viscous", "front.main_spring.stiffness")),
        ("focus", bump(amplitude=7.5e-3, wheel="fr", duration=1.5, start=0.3),
         ("damper.coulomb_friction", "body.mass")),
        ("focus_road_seated", road("A", 60, duration=2.5),
         ("driver.bushings.cushion.stiffness", "front.damper.viscous")),
    ],
)  # fmt: skip
def test_changes_are_those_of_single_runs_and_ranked_by_brute_force(name, ride, groups):
    car = Car.load(name)
    found = parameter_effects(car, ride, groups=groups, share=0.1, engine="reduced")

    def comfort(changed):
        values = changed.run(ride, engine="reduced").comfort()
        return (values.cushion or values).weighted.overall

    base, largest = comfort(car), {}
    # At the step of a sweep, 0.5 ms, weighted comfort is up to 0.022 % off, 0.002 % between cars.
    assert found.base == pytest.approx(base, rel=3e-4)
    for each in found.effects:
        assert (each.low, each.high) == pytest.approx((0.9 * each.value, 1.1 * each.value))
        single = [100.0 * (comfort(car.with_({each.path: value})) / base - 1.0) for value in (each.low, each.high)]
        assert (each.change_low, each.change_high) == pytest.approx(single, abs=6e-3)
        largest[each.path] = max(map(abs, single))
    assert [each.path for each in found.effects] == sorted(largest, key=lambda path: -largest[path])
    assert {*largest, *found.without} == set(varied_parameters(car.vehicle, groups))


def test_error_of_a_change_is_that_of_the_differences_of_the_sweep():
    car = Car.load("sedan")
    parameters = varied_parameters(car.vehicle, ("rear.damper.viscous",))
    changes, without = single_changes(car.vehicle, parameters, 0.2)
    assert without == () and changes[0] == ()
    table = plan_sweep(car, changes, road("B", 80, duration=3), SweepSettings(engine="reduced")).run()
    file, paths = io.StringIO(), table.paths()
    writer = DifferencesWriter(file, paths, table.units)
    for case, row in zip(table.cases, table.rows(), strict=True):
        writer.add(case, parameter_cells(case, paths), row)
    writer.finish()
    rows = list(csv.DictReader(io.StringIO(file.getvalue())))
    widths = [float(row["weighted_half_width_95 [m/s2]"]) for row in rows[1:]]
    (effect,) = effects_of(table, parameters, 0.2).effects
    expected = 100.0 * max(widths) / float(rows[0]["weighted [m/s2]"])
    assert effect.half_width == pytest.approx(expected, rel=1e-4)


def test_each_input_counts_by_its_relative_change():
    """By hand: the mean of the changes on a smooth and on a rough road, 16 times as loud."""
    car, ways = Car.load("sedan"), [road("A", 80, duration=3), road("D", 80, duration=3)]
    both = parameter_effects(car, ways, groups=("rear.damper.viscous",), engine="reduced")
    alone = [parameter_effects(car, way, groups=("rear.damper.viscous",), engine="reduced") for way in ways]
    expected = [np.mean([each.effects[0].change_low for each in alone])]
    assert [both.effects[0].change_low] == pytest.approx(expected, abs=2e-3)
    # The ratio of the means would be that of the loud road.
    loud = alone[1].effects[0].change_low
    assert abs(expected[0] - loud) > 0.05 and both.inputs == 2


def test_groups():
    vehicle = Car.load("sedan").vehicle
    every = varied_parameters(vehicle)
    assert {unit for _, unit in every.values()} <= {"N/m", "N s/m", "N", "N m/rad", "N/rad", "kg"} and len(every) > 60
    assert all(value != 0.0 for value, _ in every.values()) and not any("smoothing" in path for path in every)
    assert set(varied_parameters(vehicle, ("rear.damper",))) >= {"rear.damper.viscous", "rear.damper.coulomb_friction"}
    assert all(path.startswith("rear.damper.") for path in varied_parameters(vehicle, ("rear.damper",)))
    assert set(varied_parameters(vehicle, ("coulomb_friction",))) == {
        "front.damper.coulomb_friction", "rear.damper.coulomb_friction"
    }  # fmt: skip
    with pytest.raises(ConfigurationError, match=r"--vary rear.damber: .*--search rear.damber"):
        varied_parameters(vehicle, ("rear.damber",))
    for share in (0.0, 1.0, -0.1, NAN):
        with pytest.raises(ConfigurationError, match=r"--each .* below 100 %"):
            single_changes(vehicle, every, share)


def test_the_forces_of_a_curve_are_one_parameter():
    vehicle = Car.load("sedan").vehicle
    parameters = varied_parameters(vehicle)
    curve = vehicle.table["front"]["damper"]["force"]
    assert parameters["front.damper.force"] == (max(map(abs, curve)), "N")
    chosen = {"front.damper.force": parameters["front.damper.force"]}
    (_, (softer,), (harder,)), _ = single_changes(vehicle, chosen, 0.2)
    for text, factor in ((softer, 0.8), (harder, 1.2)):
        changed = Car.load("sedan", [text]).vehicle.table["front"]["damper"]["force"]
        assert changed == pytest.approx([factor * force for force in curve], rel=1e-12)


def test_parameters_without_effect_are_named():
    """The Stribeck parameters of Coulomb friction have none; alone they are refused."""
    vehicle = Car.load("focus").vehicle
    parameters = varied_parameters(vehicle, ("damper.stribeck_friction", "damper.viscous"))
    changes, without = single_changes(vehicle, parameters, 0.2)
    assert without == ("front.damper.stribeck_friction",) and len(changes) == 3
    with pytest.raises(ConfigurationError, match=r"--vary: .*front.damper.stribeck_friction"):
        single_changes(vehicle, varied_parameters(vehicle, ("damper.stribeck_friction",)), 0.2)


def test_of_an_undefined_figure_there_is_no_change_in_percent():
    """It was called without effect; so was a parameter whose changed cars have no value."""
    car = Car.load("sedan")
    parameters = varied_parameters(car.vehicle, ("rear.damper.viscous", "front.main_spring.stiffness"))
    changes, _ = single_changes(car.vehicle, parameters, 0.2)
    table = plan_sweep(
        car, changes, road("B", 80, duration=2.5), SweepSettings(engine="reduced", measure="travel")
    ).run()

    def of_values(*values):
        results = [Result(values={"travel": value}) for value in values]
        return effects_of(replace(table, results=results), parameters, 0.2)

    for base, found in ((NAN, "undefined"), (0.0, "is 0")):
        with pytest.raises(DataError, match=f"--each: travel .* road_B_80 .*{found}"):
            of_values(*[base] * len(changes))
    found = of_values(1.0, *[NAN] * (len(changes) - 1))
    assert len(found.effects) == len(parameters) and found.without == ()
    assert "travel" in effect_sentence(found) and "table.csv" in effect_sentence(found)
    assert of_values(*[1.0] * len(changes)).without == tuple(parameters)


def test_parameters_are_ranked_by_one_figure(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    words = ["--input", "bump_7p5mm.csv", "--vary", "damper.viscous", "--each", "10%"]
    assert main([*words, "--measure", "travel", "--measure", "tyre_load"]) == 2
    assert "found 2; give one --measure" in capsys.readouterr().err
    for measure in (["travel", "tyre_load"], {"a": "travel", "b": "tyre_load"}):
        with pytest.raises(ConfigurationError, match="found 2; give one --measure"):
            parameter_effects(Car.load(), "bump_7p5mm.csv", measure=measure)


def effect(path, low, high, half_width=NAN):
    return Effect(path=path, unit="N", value=10.0, low=8.0, high=12.0, step="20 %", change_low=low, change_high=high,
                  half_width=half_width)  # fmt: skip


def of(*effects, without=()):
    return Effects(effects=effects, name="weighted", base=0.5, without=without)


def test_a_coordinate_is_moved_by_a_length_whatever_its_origin():
    """Its percentage would depend on the origin: 3.6 m of x by 72 cm, and y = 0 not at all."""
    vehicle = Car.load("sedan").vehicle
    groups = ("hardpoints.body_front", "rear.damper.viscous")
    parameters = varied_parameters(vehicle, groups)
    assert parameters["hardpoints.body_front.y"] == (0.0, "m") and len(parameters) == 4
    changes, _ = single_changes(vehicle, {path: parameters[path] for path in list(parameters)[:2]}, 0.2)
    texts = [each[0].split("=") for each in changes[1:]]
    assert [path for path, _ in texts] == ["hardpoints.body_front.x"] * 2 + ["hardpoints.body_front.y"] * 2
    assert [float(value) for _, value in texts] == pytest.approx([0.34, 0.36, -0.01, 0.01])
    with pytest.raises(ConfigurationError, match=r"--each 300 mm: .* at most 100 mm"):
        single_changes(vehicle, parameters, 0.2, 0.3)
    groups, ride = ("seat_rail", "rear.damper.viscous"), road("B", 80, duration=2.5)
    found = parameter_effects(Car.load("sedan"), ride, groups=groups, shift=0.005, engine="reduced")
    assert {each.path: each.ends for each in found.effects} == {
        "rear.damper.viscous": ("-20 %", "+20 %"), "hardpoints.seat_rail.x": ("-5 mm", "+5 mm"),
        "hardpoints.seat_rail.y": ("-5 mm", "+5 mm"), "hardpoints.seat_rail.z": ("-5 mm", "+5 mm"),
    }  # fmt: skip
    assert str(found).splitlines()[0].split() == ["parameter", "value", "step", "down", "up", "+-"]


@pytest.mark.parametrize(
    ("effects", "parts"),
    [
        ((effect("a", -4.0, 3.0), effect("b", 1.0, -1.0), effect("c", 0.1, 0.0)),
         ["a matters most: -20 % makes the ride 4 % smoother, +20 % makes the ride 3 % rougher", "next come b and c."]),
        ((effect("a", NAN, 3.0),), ["a matters most: +20 % makes the ride 3 % rougher."]),
        ((effect("a", -1.0, 0.9, 1.2),), ["No effect exceeds its error"]),
        # 3.0 and 2.5 differ by less than sqrt(0.5^2 + 0.4^2); 2.5 and 0.9 by more than sqrt(0.4^2 + 0.3^2).
        ((effect("a", -9.0, 9.0, 1.0), effect("b", 3.0, -1.0, 0.5), effect("c", 2.5, -1.0, 0.4)),
         ["9 % rougher", "next come b and c", "ranks of b and c may change"]),
        ((effect("a", -9.0, 9.0, 1.0), effect("b", 2.5, -1.0, 0.4), effect("c", 0.9, -0.3, 0.3)),
         ["9 % rougher", "next come b and c."]),
        # An effect inside its error does not come next, but may be larger than the one that does.
        ((effect("a", -3.0, 3.0, 0.5), effect("b", 2.8, -1.0, 3.5)), ["3 % rougher", "rank of a may change"]),
        ((), ["No varied parameter changes the comfort here."]),
    ],
)  # fmt: skip
def test_sentence(effects, parts):
    said = effect_sentence(of(*effects)).split("; ")
    assert len(said) == len(parts) and all(part in text for part, text in zip(parts, said, strict=True)), said


def test_effects_without_a_sense_are_marked():
    marks = [effect("a", *values).mark for values in ((0.2, 0.1, 2.8), (0.2, 0.1, NAN), (-1.0, 0.9, 0.5))]
    assert marks == ["within +-", "same sign", ""]
    lines = str(of(effect("a", -4.0, 3.0, 0.5), effect("b", 2.0, 1.0, 0.5))).splitlines()
    assert [line.split()[-1] for line in lines[1:3]] == ["0.50", "sign"]


def test_table_file_and_picture(tmp_path):
    effects = of(effect("a", -4.0, NAN, 0.5), effect("b", 1.0, -1.0), without=("c",))
    write_effects(tmp_path / "effects.csv", effects)
    assert (tmp_path / "effects.csv").read_text(encoding="utf-8").splitlines() == [
        "parameter,unit,value,low,high,change_low [%],change_high [%],half_width_95 [%]",
        "a,N,10,8,12,-4,,0.5",
        "b,N,10,8,12,1,-1,",
        "c,,,,,0,0,",
    ]
    text = str(effects)
    assert "no value" in text and "1 parameter (c)" in text and "-4.00 %" in text
    axes = effects.plot()
    labels = [label.get_text() for label in axes.get_yticklabels()]
    assert labels == ["a  10 N", "b  10 N"]
    widths = np.array([bar.get_width() for bar in axes.patches])
    np.testing.assert_allclose(widths, [-4.0, 1.0, 0.0, -1.0])


def test_command(tmp_path, capsys, monkeypatch):
    """Table, sentence, files and report of the command; what it refuses; a resumed sweep has the same table."""
    monkeypatch.chdir(tmp_path)
    words = [
        "--input",
        "bump_7p5mm.csv",
        "--engine",
        "reduced",
        "--vary",
        "coulomb_friction",
        "--vary",
        "damper.viscous",
    ]
    assert main([*words, "--each", "10%", "--output", "each", "--report"]) == 0
    said = capsys.readouterr().out
    assert "front.damper.coulomb_friction matters most: -10 % makes the ride" in said and "+10 %" in said
    table = (tmp_path / "each" / "effects.csv").read_text(encoding="utf-8")
    assert table.splitlines()[1].startswith("front.damper.coulomb_friction,N,")
    assert (tmp_path / "each" / "effects.png").is_file()
    page = (tmp_path / "each" / "report.html").read_text(encoding="utf-8")
    assert "front.damper.coulomb_friction matters most" in page and "front damper Coulomb friction" in page
    assert main([*words, "--each", "10", "--output", "each", "--resume", "--quiet"]) == 0
    assert (tmp_path / "each" / "effects.csv").read_text(encoding="utf-8") == table
    # Another figure has its name and its unit, in table, file and report.
    measured = [*words[:6], "--each", "10%", "--measure", "travel", "--output", "travel", "--report"]
    assert main(measured) == 0 and "change in 'travel'" in capsys.readouterr().out
    page = (tmp_path / "travel" / "report.html").read_text(encoding="utf-8")
    assert "'travel'" in page and re.search(r"unchanged car: [0-9.]+ m\)", page)
    for wrong, message in (
        (["--each", "much"], "--each 'much': "),
        (["--each", "120%"], "--each 120 %: "),
        (["--each", "10%", "--sobol", "8"], "--sobol"),
    ):
        assert main([*words, *wrong, "--output", "wrong"]) == 2
        assert message in capsys.readouterr().err
