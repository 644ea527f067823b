"""A figure that is added to the catalogue alone appears in sweep, search, targets, bench, report, page, Python."""

import csv
import json
import re
from dataclasses import replace

import pytest

from tests.documentation.test_figures_page import PAGE, rows, table_of
from vehicle import Car, road, save_run, sweep
from vehicle.commands.bench import main as bench
from vehicle.commands.optimise import main as optimise
from vehicle.commands.report import main as report
from vehicle.commands.sweep import main as sweep_command
from vehicle.errors import ConfigurationError
from vehicle.handover.bench.drive import bench_drive
from vehicle.handover.bench.numbers import numbers
from vehicle.runs.figures.catalogue import FIGURES
from vehicle.runs.targets.verdict import read_targets

NAME, WORDS = "crest_of_load", "crest of the load"
ROAD = ["--vehicle", "sedan", "--road", "C", "--speed", "80", "--duration", "4", "--engine", "reduced", "--quiet"]


@pytest.fixture(scope="module")
def car():
    return Car.load("sedan")


@pytest.fixture(scope="module")
def run(car):
    return car.run(road("C", 80, duration=8), engine="reduced")


@pytest.fixture(scope="module")
def saved(run, tmp_path_factory):
    """Two folders of the run."""
    folder = tmp_path_factory.mktemp("runs")
    return [str(save_run(run, folder / name, figures=False)) for name in ("run", "other")]


@pytest.fixture
def added(monkeypatch):
    """A new record, with the definition of `tyre_load_crest` under another name."""
    monkeypatch.setitem(FIGURES, NAME, replace(FIGURES["tyre_load_crest"], words=WORDS))


def rows_of(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.usefixtures("added")
def test_python_and_bench(car, run):
    value = run.figure(NAME)
    forces = {wheel: run[f"tyre_{wheel}_force_z"][run.evaluated] - load for wheel, load in car.static.tyre_load.items()}
    assert value == pytest.approx(max(abs(each).max() / (each**2).mean() ** 0.5 for each in forces.values()), rel=1e-12)
    table = sweep(car, {"rear.damper.viscous": [1500.0, 2000.0]}, road("C", 80, duration=4), measure=NAME)
    assert table.units == {NAME: "-", f"{NAME}_error": "-"} and table.column(NAME).shape == (2,)
    drive = bench_drive(car, road("C", 80), seconds=6.0)
    found = numbers(car.with_(drive.overrides), drive, [NAME, f"{NAME}_fr"]).table
    assert found[WORDS][1] == "-" and found[WORDS][0] >= found[f"{WORDS}, fr"][0] > 2.0


@pytest.mark.usefixtures("added")
def test_sweep_and_search(tmp_path, capsys):
    both = ["--measure", NAME, "--measure", f"{NAME}_fr"]
    loud = [word for word in ROAD if word != "--quiet"]
    vary = ["--vary", "rear.damper.viscous=1500,2500"]
    assert sweep_command([*loud, *vary, *both, "--output", str(tmp_path / "a")]) == 0
    table = rows_of(tmp_path / "a" / "table.csv")
    assert float(table[0][f"{NAME} [-]"]) >= float(table[0][f"{NAME}_fr [-]"])
    assert f"{NAME}_fr [-]" in capsys.readouterr().out
    each = ["--each", "20%", "--vary", "rear.damper.viscous", "--measure", NAME, "--output", str(tmp_path / "b")]
    assert sweep_command([*loud, *each]) == 0
    said = capsys.readouterr().out
    assert f"change in '{NAME}'" in said and "no +-" in said
    assert re.search(rf"-20 % (raises|lowers) {NAME} by", said)
    bounds = ["--vary", "rear.damper.viscous=1500:2500", "--vary", "front.bushings.tyre.stiffness.z=2e5:2.5e5"]
    assert (
        sweep_command(
            [*ROAD, "--sobol", "64", *bounds, "--measure", NAME, "--jobs", "1", "--output", str(tmp_path / "c")]
        )
        == 0
    )
    assert {row["value"] for row in rows_of(tmp_path / "c" / "sobol.csv")} == {NAME}
    search = ["--minimise", NAME, "--limit", "travel<=1", "--cars", "8", "--population", "8"]
    assert optimise([*ROAD, *search, *bounds[:2], "--output", str(tmp_path / "d")]) == 0
    assert f"{NAME} [-]" in rows_of(tmp_path / "d" / "front.csv")[0]


@pytest.mark.usefixtures("added")
def test_targets_report_and_page(run, saved, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "targets.toml"
    file.write_text(f'[crest]\nquantity = "{NAME}"\nroad = "C"\nspeed = 80\nunit = "-"\n', encoding="utf-8")
    with pytest.raises(ConfigurationError, match="set exactly one of at_most and at_least"):
        read_targets(file)
    file.write_text(f"{file.read_text(encoding='utf-8')}at_most = 1\n", encoding="utf-8")
    asked = ["--measure", NAME, "--measure", "peak_to_peak:seat rail z"]
    assert report([saved[0], "--targets", str(file), *asked, "--quiet", "--output", "a.html"]) == 0
    page = (tmp_path / "a.html").read_text(encoding="utf-8")
    value = f"{run.figure(NAME):.3g}"
    # In the verdict, which judges it on a random road without knowing its error, and in the table of figures.
    assert "<td>crest</td>" in page and f"{value} ± ?" in page and page.count(f'<td class="number">{value}</td>') == 1
    assert f"<td>{WORDS}</td>" in page and "misses crest" in page
    found = re.search(r'id="trial-data"[^>]*>(.*?)</script>', page, re.DOTALL)
    assert found is not None
    data = json.loads(found[1])
    assert [each["words"] for each in data["figures"]] == [WORDS, "peak to peak, seat rail acc z"]
    assert report([*saved, *asked, "--quiet", "--output", "b.html"]) == 0
    assert f"<td>{WORDS}</td>" in (tmp_path / "b.html").read_text(encoding="utf-8")


def test_an_unknown_name_ends_report_and_bench_at_once(saved, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("vehicle.commands.report._film", lambda *_: pytest.fail("the film was rendered"))
    assert report([*saved, "--video", "--measure", "foo", "--quiet"]) == 2
    monkeypatch.setattr("vehicle.handover.bench.server.open_server", lambda *_: pytest.fail("the bench was opened"))
    assert bench(["sedan", "--road", "C", "--speed", "80", "--measure", "foo"]) == 2
    assert capsys.readouterr().err.count("--measure 'foo': sedan has no figure 'foo'") == 2


@pytest.mark.usefixtures("added")
def test_the_list_of_the_documentation_lacks_it():
    assert set(rows()) - set(table_of(PAGE.read_text(encoding="utf-8"))) == {
        f"| `{NAME}[:WHEELS]` | {FIGURES[NAME].meaning} | less |"
    }


def lift(run):
    return {"highest": run["seat rail z"][run.evaluated].max(), "lowest": run["seat rail z"][run.evaluated].min()}


def test_a_sweep_takes_a_function_of_a_run(car):
    ride = road("C", 80, duration=4)
    table = sweep(car, {"rear.damper.viscous": [1500.0, 2000.0]}, ride, measure=lift, engine="reduced")
    assert table.units == {"highest": "?", "lowest": "?"}
    run = car.with_({"rear.damper.viscous": 2000.0}).run(ride, engine="reduced")
    assert table.column("highest")[1] == pytest.approx(lift(run)["highest"], rel=1e-6)
    alone = sweep(car, {"rear.damper.viscous": [1500.0, 2000.0]}, ride, measure=max_force, engine="reduced")
    assert alone.column("max_force")[1] == pytest.approx(max_force(run), rel=1e-6)


def max_force(run):
    return run["damper_fr_force"].max()
