"""Every command and example of README.md and docs/ runs, and prints what its page shows."""

import json

import pytest

import vehicle
from tests.documentation.gallery import FOLDER as GALLERY
from tests.documentation.pages import Site, blocks, pages
from vehicle.drawing.rendering.backend import film_available
from vehicle.model.parameters.paths import value_of

NEEDS = {
    "docs/howto/add/own-law.md": ("cffi",),
    "docs/python.md": ("pymoo", "pandas"),
    "docs/tutorials/study.md": ("pymoo",),
    "docs/tutorials/thirty-minutes.md": ("asammdf",),
    "docs/howto/optimise.md": ("pymoo",),
    "docs/howto/loads.md": ("rainflow",),
    "docs/howto/shaker.md": ("rainflow", "h5py"),
}
"""Extras of the examples of a page."""

FILMS = ("docs/howto/shaker.md", "docs/howto/modes.md")
"""Pages that render a film."""

EXECUTED = [page for page in pages() if blocks(page, "console", "python", "diff") and not page.startswith(GALLERY)]
"""Pages that this file runs; `test_gallery.py` runs the others."""


@pytest.fixture(scope="session")
def site(tmp_path_factory):
    return Site(tmp_path_factory.mktemp("pages"))


def prepared(page):
    for name in NEEDS.get(page, ()):
        pytest.importorskip(name)
    if page in FILMS and film_available():
        pytest.skip("no off-screen OpenGL library")


@pytest.mark.parametrize("page", EXECUTED)
def test_a_page_runs_and_prints_what_it_shows(page, site):
    prepared(page)
    site.execution(page)


def test_python_examples_compute_what_the_page_says(site):
    prepared("docs/python.md")
    execution = site.execution("docs/python.md")
    names = execution.names
    assert names["ride"].skip >= 2.0 and names["ride"].car.vehicle.driving.speed == pytest.approx(80 / 3.6)
    comfort = names["table"].column("unweighted")
    again = (
        names["sedan"]
        .with_({"front.damper.coulomb_friction": 120})
        .run(vehicle.road("B", 80, duration=6), engine="reduced")
    )
    assert comfort[1] == pytest.approx(again.comfort().unweighted.overall, rel=1e-3) and comfort[0] != comfort[1]
    (response,) = names["comparison"].responses
    assert 0.5 < response.frac < 0.9999
    path = "bushings.suspension_mount.stiffness.z"
    assert value_of(names["tuned"].vehicle, path) == names["result"].values[path] == pytest.approx(6.8e5, rel=0.02)
    assert names["damper"].values["damper.viscous"] == pytest.approx(2000.0, rel=1e-3)
    assert names["drive"].error < 0.5 and "best weighted" in str(names["found"])
    rms = names["run"].comfort().weighted
    assert names["seat"].overall == pytest.approx(rms.overall, rel=1e-9)
    assert names["seat"].weighted_rms["z"] == pytest.approx(rms.z, rel=1e-9)
    for name in ("runs/high/summary.json", "runs/compared/compare.json", "report.html", "runs/drive/drive.csv"):
        assert (execution.folder / name).is_file()


def test_the_tutorial_finds_the_stiffness_of_the_bench(site):
    names = site.execution("docs/tutorials/own-measurement.md").names
    assert names["result"].values["bushings.suspension_mount.stiffness.z"] == pytest.approx(5.0e5, rel=0.05)


def test_the_newcomer_finds_the_parameters_of_both_files(site):
    prepared("docs/tutorials/thirty-minutes.md")
    execution = site.execution("docs/tutorials/thirty-minutes.md")
    fitted = json.loads((execution.folder / "runs" / "tune" / "tune.json").read_text(encoding="utf-8"))
    for row in fitted["parameters"]:
        assert abs(row["value"] - execution.names["real"][row["path"]]) < 3.0 * row["standard_error"]
        assert row["standard_error"] < 0.01 * row["value"]
    assert "front damper Coulomb friction 45 instead of" in (execution.folder / "a_or_b.html").read_text(
        encoding="utf-8"
    )
