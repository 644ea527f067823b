"""The command of the quarter-car study as a user runs it, and its table."""

import json
from dataclasses import fields

import numpy as np
import pytest

from scenarios.claims import Claim
from scenarios.lumped.quarter_car_parameters import load_quarter_car
from scenarios.quarter_car.__main__ import main
from scenarios.quarter_car.claims import findings
from scenarios.quarter_car.figures import FIGURES
from scenarios.quarter_car.runs import HIGH, LEVELS, STEP, UPPER_EDGE_HZ, Runs, peak
from scenarios.quarter_car.sine_claims import stuck_bound
from tests.scenarios.kept_table import contradictions
from tests.validation import validated
from vehicle.runs.output.written_files import MARKER

TENFOLD = "sine 1 mm, from rest: body acceleration"


@pytest.fixture(scope="module")
def quick():
    """The runs of the quick study."""
    return Runs(car=load_quarter_car(), quick=True)


@pytest.mark.parametrize("name", ["2.5", "2.6", "2.10"])
def test_a_figure_is_drawn(tmp_path, quick, name):
    FIGURES[name](quick, tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_one_figure_is_written_whole(tmp_path, capsys):
    folder = tmp_path / "new" / "runs"
    assert main(["--figure", "2.20", "--quick", "--output", str(folder)]) == 0
    assert {path.name for path in folder.iterdir()} == {"figure_2_20.png", MARKER}
    assert (folder / "figure_2_20.png").read_bytes().startswith(b"\x89PNG")
    assert capsys.readouterr().out.startswith(f"{folder}: 1 figure;")


def test_a_bad_parameter_file_is_refused_by_name(tmp_path, capsys):
    bad = tmp_path / "car.toml"
    bad.write_text("[body]\nmass = -1.0\n", encoding="utf-8")
    assert main(["--figure", "2.20", "--output", str(tmp_path / "x"), "--parameters", str(bad)]) == 2
    assert capsys.readouterr().err == "error: body.mass: found -1.0 kg, must be greater than 0.0\n"


class Short(Runs):
    """Four seconds of one road."""

    @property
    def duration(self) -> float:
        return 4.0

    @property
    def roads(self) -> int:
        return 1


def test_the_table_holds_every_published_row(tmp_path, quick):
    findings(quick).write(tmp_path)
    assert contradictions("quarter_car", tmp_path) == []
    results = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    names = [row["name"] for row in results["rows"]]
    pictures = {f"figure_{name.replace('.', '_').lower()}.png" for name in FIGURES}
    for wanted in (
        "slip mode",
        "stick mode",
        "switch and smooth law",
        "sine 1 mm",
        "sine 50 mm",
        "resonances move down",
        "first resonance",
        "elastomer against linear mount",
        "degressive damper, low",
        "degressive damper, high",
        "angle of the strut",
        "table B.1, eps 1e+04",
        "engine alone",
        "loss angle",
        "body behind the road [deg]",
        "swing in 30 s",
        "share of sticking",
        "influence on the low against the high road",
        "longitudinal damping 0, 550, 1100",
        "effect of the transitions",
        "engine and wheel, both relative",
        "sine 50 mm: highest velocity of the damper",
        "sine 1 mm: lowest acceleration relative to the body",
    ):
        assert any(wanted in name for name in names), wanted
    for row in results["rows"]:
        assert set(row) == {field.name for field in fields(Claim)}
        assert row["why"]
        assert row["place"]
        assert row["picture"] == "" or row["picture"] in pictures
    blind = [row for row in results["rows"] if row["status"] == "not testable"]
    assert all(row["within"] is None for row in blind)
    # Its input is not printed; the others are axes with one label and 0.
    assert sum(row["place"] == "table B.1" for row in blind) == 6
    assert all(0.0 in row["interval"] for row in blind if row["place"] != "table B.1") and len(blind) == 12
    table = (tmp_path / "results.md").read_text(encoding="utf-8")
    assert all(f"| {name} |" in table for name in names)
    exact = {row["name"]: row["ours"] for row in results["rows"]}
    # Rows that no road enters must be right whatever the length of the roads.
    assert exact["slip mode 1 [Hz]"] == pytest.approx(1.99, abs=0.005)
    assert exact["stick mode 2 [Hz]"] == pytest.approx(25.13, abs=0.005)
    assert exact["engine alone, damping [%]"] == pytest.approx(15.0, abs=0.05)
    validated(
        "Bushings, springs and stops", "loss angle of the elastomer mount of Bommer 2006 at 9 Hz",
        exact["elastomer, loss angle at 9 Hz [deg]"], 9.93, abs=0.005, unit="deg",
        source="closed form: printed parameters of section 2.3.3.1, by hand",
    )  # fmt: skip
    validated(
        "Bushings, springs and stops", "corner frequency of the elastomer mount of Bommer 2006",
        exact["elastomer, K2 / (2 pi De) [Hz]"], 8.93, abs=0.005, unit="Hz",
        source="closed form: printed parameters of section 2.3.3.1, by hand",
    )  # fmt: skip
    bound = next(row for row in results["rows"] if "bound of the body" in row["name"])
    assert bound["within"] is True
    assert "8.30 times the 0.0524 m/s2" in next(
        row["why"] for row in results["rows"] if row["name"].startswith(TENFOLD)
    )


def test_a_stuck_strut_passes_what_the_friction_holds():
    # At |u| = Fd / Kd spring and mount pull the body: (Km + Kd) Fd / Kd / Mb.
    car = load_quarter_car()
    validated(
        "Quarter and half cars", "largest body acceleration over a stuck strut", stuck_bound(car),
        (30e3 + 700e3) * 75.0 / 700e3 / 180.0, rel=1e-6, unit="m/s2", source="closed form: (Km + Kd) Fd / (Kd Mb)",
    )  # fmt: skip
    assert stuck_bound(car) == pytest.approx(0.4345, abs=5e-5)


def test_a_short_road_has_the_velocity_density_of_a_whole_one():
    # A flat density: the mean square of the velocity over the width of the band.
    short, whole = (
        np.mean([np.var(np.diff(runs.road_profile(0.01, seed=i)) / STEP) for i in range(40)])
        / (UPPER_EDGE_HZ - 1.0 / runs.duration)
        for runs in (Short(car=load_quarter_car(), quick=True), Runs(car=load_quarter_car(), quick=False))
    )
    assert short == pytest.approx(whole, rel=0.05)  # 40 seeds; with the RMS of the whole road it would be 7 times


class Shorter(Short):
    """Two seconds: no spectrum has to fit in."""

    @property
    def duration(self) -> float:
        return 2.0


def test_the_march_of_the_spectra_is_the_stiff_solution():
    runs = Shorter(car=load_quarter_car(), quick=False)
    # Two seconds of the roads of 5 and 50 mm have an RMS of 1.3 and 13 mm.
    for family, engine, level in (("no engine", "none", LEVELS[2]), ("linear mount", "linear", HIGH)):
        marched = runs.marched(family, level).acceleration[0]
        stiff = runs.road(level, engine=engine).acceleration("body")
        error = np.sqrt(np.mean((marched - stiff) ** 2) / np.mean(stiff**2))
        # Steps of 0.5 ms: see the tests of the march for its order; the road is a spline there and straight here.
        assert error < 0.05


def test_peak_is_the_largest_line_of_its_band():
    frequency = np.array([1.0, 2.0, 3.0, 4.0, 5.0])
    assert peak(frequency, np.array([9.0, 1.0, 4.0, 3.0, 8.0]), (2.0, 4.0)) == (3.0, 4.0)
