"""`python -m vehicle optimise` as a user runs it."""

import argparse
import json
import shlex
import shutil
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from scenarios.signals.random_road import random_road
from tests.studies.sweeps.sweep_samples import rows_of
from vehicle.commands.optimise import main, parser, settings_of
from vehicle.model.parameters.ranges import Range
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.output.destination import Destination
from vehicle.signals.excitation.signal_file import write_signal
from vehicle.studies.optimisation.problem import parsed_tolerance
from vehicle.studies.optimisation.search_settings import SearchSettings
from vehicle.studies.optimisation.search_study import SearchStudy, TargetStudy
from vehicle.studies.sweeps.case import SignalFile
from vehicle.studies.sweeps.case_evaluation import evaluate
from vehicle.studies.sweeps.case_table import table_cases
from vehicle.studies.sweeps.measure import chosen_measure
from vehicle.studies.sweeps.sweep_inputs import InputChoice

LOOSE = "damper.coulomb_friction=10"
SKIP = 1.0
TRADE = ["--minimise", "unweighted", "--minimise", "tyre_load"]


def test_the_options_are_one_object():
    """Of the parsed options nothing but a study goes on, and Python makes the same."""
    typed = ["--vary", "damper.viscous=400:6000", "--output", "out", "--jobs", "2"]

    def of(*words):
        return settings_of(parser().parse_args([*typed, *words], argparse.Namespace(held=ExitStack())))

    where = Destination(output=Path("out"))
    ranges = (Range(path="damper.viscous", low=400.0, high=6000.0),)
    changed = of("--targets", "t.toml", "--cost", "damper.viscous=2", "--duration", "4")
    assert (changed.vary[0].path, changed.vary[0].low, changed.vary[0].high) == ("damper.viscous", 400.0, 6000.0)
    assert replace(changed, vary=ranges) == TargetStudy(
        vary=ranges, targets=Path("t.toml"), cost=(("damper.viscous", 2.0),), duration=4.0, jobs=2, destination=where
    )
    tolerances = (parsed_tolerance("damper.viscous=20%"),)
    found = of("--input", "low.csv", *TRADE, "--tolerance", "damper.viscous=20%", "--cars", "8")
    assert replace(found, vary=ranges) == SearchStudy(
        vary=ranges,
        inputs=InputChoice(input=("low.csv",)),
        minimise=("unweighted", "tyre_load"),
        settings=SearchSettings(cars=8, jobs=2, tolerances=tolerances),
        destination=where,
    )


@pytest.fixture(scope="module")
def road(tmp_path_factory):
    path = tmp_path_factory.mktemp("roads") / "road.csv"
    write_signal(path, random_road(rms=1e-3, seed=1, wheel="fl", duration=2.5), ["a road"])
    return path


def arguments(road, output, *more):
    fixed = ["--input", str(road), "--set", LOOSE, "--skip", str(SKIP), "--output", str(output), "--population", "8"]
    return [*fixed, "--vary", "damper.viscous=400:6000", *more]


@pytest.fixture(scope="module")
def searched(road, tmp_path_factory):
    folder = tmp_path_factory.mktemp("search") / "out"
    assert main(arguments(road, folder, *TRADE, "--cars", "40", "--limit", "travel<=0.05", "--quiet")) == 0
    return folder


DAMPING, COMFORT, LOAD = "damper.viscous [N s/m]", "unweighted [m/s2]", "tyre_load [-]"


def test_the_front_ends_where_a_sweep_has_its_minima(road, searched):
    """Vary one parameter: each damper between the best for comfort and the best for the tyre is a compromise."""
    damping = np.linspace(600.0, 3000.0, 13)
    measure = chosen_measure(("unweighted", "tyre_load"), load_vehicle(), SKIP)
    cases = table_cases(["damper.viscous"], [(c,) for c in damping], [SignalFile(path=road, wheel="fl")], fixed=[LOOSE])
    results = evaluate(cases, measure)
    best = {}
    for name in ("unweighted", "tyre_load"):
        values = np.array([result.values[name] for result in results])
        fine = np.linspace(damping[0], damping[-1], 2401)
        best[name] = float(fine[np.argmin(CubicSpline(damping, values)(fine))])
    front = rows_of(searched / "front.csv")
    dampings = [float(row[DAMPING]) for row in front]
    # The curves are flat at their minima, and 40 cars are few: 6 % of damping is 0.2 % of comfort.
    assert dampings[0] == pytest.approx(best["unweighted"], rel=0.06)
    assert dampings[-1] == pytest.approx(best["tyre_load"], rel=0.06)
    assert dampings == sorted(dampings) and best["unweighted"] < 0.9 * best["tyre_load"]
    minimum = min(result.values["unweighted"] for result in results)
    assert float(front[0][COMFORT]) <= minimum * 1.0001
    assert next(row["name"] for row in front if row["name"]) == "best unweighted"


def test_files_of_a_search(road, searched):
    summary = json.loads((searched / "summary.json").read_text(encoding="utf-8"))
    assert (searched / "front.png").read_bytes()[:4] == b"\x89PNG"
    assert summary["cars"]["tried"] == 40 == len(rows_of(searched / "cars.csv")) - 1
    assert set(summary["points"]) == {"best unweighted", "best tyre_load", "knee"}
    # The unmodified car is the first row; its damping is that of its vehicle file.
    base = rows_of(searched / "cars.csv")[0]
    assert base[DAMPING] == "" and float(base[COMFORT]) == summary["base"]["unweighted"]
    assert rows_of(searched / "cars.csv")[1][DAMPING] == "2250.0"
    # The vehicle file of the knee point and its overrides give its values.
    knee = summary["points"]["knee"]
    (result,) = evaluate(
        table_cases([], [()], [SignalFile(path=road, wheel="fl")], vehicle=searched / knee["vehicle"]),
        chosen_measure("unweighted", load_vehicle(), SKIP),
    )
    assert result.values["unweighted"] == pytest.approx(knee["numbers"]["unweighted"], rel=1e-9)
    damping = knee["parameters"]["damper.viscous"]
    assert knee["overrides"] == [LOOSE, f"front.damper.viscous={damping!r}"]


def test_an_interrupted_search_is_continued(road, searched, tmp_path, capsys):
    folder = tmp_path / "out"
    shutil.copytree(searched, folder)
    lines = (folder / "cars.csv").read_text(encoding="utf-8").splitlines()
    (folder / "cars.csv").write_text("\n".join(lines[:37]) + "\n37,5,2", encoding="utf-8")  # cut off
    more = [*TRADE, "--cars", "40", "--limit", "travel<=0.05", "--quiet"]
    for options, message in (((), "--resume"), (("--resume", "--search-seed", "2"), "another search")):
        assert main(arguments(road, folder, *more, *options)) == 2
        assert message in capsys.readouterr().err
    assert main(arguments(road, folder, *more, "--resume")) == 0
    for name in ("cars.csv", "front.csv", "knee.toml"):
        assert (folder / name).read_bytes() == (searched / name).read_bytes()


def test_tolerances_and_another_front_beside(road, searched, tmp_path, capsys):
    more = ["--tolerance", "damper.viscous=20%", "--tolerance", "damper.coulomb_friction=5", "--samples", "2"]
    folder = tmp_path / "out"
    options = [*TRADE, *more, "--quantile", "1", "--cars", "8", "--beside", str(searched)]
    assert main(arguments(road, folder, *options)) == 0
    said = capsys.readouterr().out
    assert "worst of 2 cars" in said and "of 64 fresh cars" in said
    sample = json.loads((folder / "summary.json").read_text(encoding="utf-8"))["made_cars"]
    assert sample["statistic"] == "worst of 2 cars" and sample["new_cars"] == 64
    # Two thirds to three quarters are expected to be no worse than the worst of two.
    assert 0.3 < sample["share_as_good"]["knee"]["unweighted"] < 1.0
    assert f"front of {searched}: hypervolume +" in said
    assert "8 cars, " in said and "knee: --set damper.coulomb_friction=10 --set front.damper.viscous=" in said
    for row in rows_of(folder / "front.csv"):
        assert float(row[COMFORT]) > 0.0 and row["unweighted without tolerances [m/s2]"]
    beside = json.loads((folder / "summary.json").read_text(encoding="utf-8"))["beside"]
    # With all cars within tolerances the worst of them is worse than the best without.
    assert beside["hypervolume_change"] > 0.0 and beside["mean_distance"] > 0.0


@pytest.mark.parametrize(
    ("more", "code", "said"),
    [
        ("", 2, "--minimise"),
        ("--minimise comfrt", 2, "--minimise 'comfrt': "),
        ("--vary damper.viscos=1:2", 2, "--vary damper.viscos: "),
        ("--vary damper.friction_law=1:2", 2, "damper.friction_law: is not a number"),
        ("--vary front.damper.viscous=1:2", 2, "front.damper.viscous: set by 2 of"),
        ("--vary body.mass=-5:900", 2, "--vary body.mass=-5:900: body.mass: found -5.0 kg"),
        ("--cars 2", 2, "--cars 2: must be at least 8"),
        ("--samples 4", 2, "--samples: belongs to --tolerance"),
        ("--tolerance body.mass=1% --quantile 2", 2, "--quantile 2: "),
        ("--tolerance body.mass=1% --quantile 0.99 --samples 8", 2, "--samples 128"),
        ("--beside nowhere", 3, "--beside nowhere: "),
        ("--limit travel<=1e-9 --cars 8", 4, "none of 8 cars"),
    ],
)
def test_bad_input_is_one_sentence(road, tmp_path, capsys, more, code, said):
    goal = [] if more.startswith("--minimise") or not more else ["--minimise", "unweighted"]
    assert main(arguments(road, tmp_path / "out", *goal, *more.split())) == code
    error = capsys.readouterr().err
    lines = [line for line in error.splitlines() if not line.startswith("notice: ")]  # finished rows are kept
    assert said in error and error.splitlines()[-1].startswith("error: ") and len(lines) == 1


def test_help_has_units(capsys):
    with pytest.raises(SystemExit):
        main(["--help"])
    said = " ".join(capsys.readouterr().out.split())
    assert "travel [m]" in said and "PATH=LOW:HIGH" in said
    assert shlex.split("--limit 'travel<=0.06'")[1] in said
