"""The report as a file: complete, self-contained, the same numbers as the summary, and refused where it cannot be."""

import dataclasses
import json
import re
from html import unescape
from html.parser import HTMLParser

import mujoco
import numpy as np
import pytest

from vehicle.commands.body import main as body_command
from vehicle.commands.report import main
from vehicle.commands.shaker import main as shaker
from vehicle.drawing.rendering.wireframe import GROUPS, car_wireframe, unit_factor
from vehicle.runs.car import Car
from vehicle.runs.report.answer import answer, counterpart
from vehicle.runs.report.band_causes import main_path, paths
from vehicle.runs.report.base_run import base_run
from vehicle.runs.report.comfort_class import reactions
from vehicle.runs.report.differences import changed_parameters, difference, parameter_words, shipped_origin
from vehicle.runs.report.finished_run import read_run
from vehicle.runs.report.main_band import main_band, weighted_bands
from vehicle.runs.report.modes_section import FULL, modes_of

EMPTY = {"meta", "link", "input", "img", "br"}


class Outline(HTMLParser):
    """Checks that elements are closed in their order; keeps what is linked and what is said."""

    def __init__(self):
        super().__init__()
        self.open, self.links, self.words, self.titles = [], [], [], []

    def handle_starttag(self, tag, attrs):
        self.links += [value for name, value in attrs if name in ("src", "href", "xlink:href", "data", "action")]
        if tag not in EMPTY:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.links += [value for name, value in attrs if name in ("src", "href", "xlink:href")]

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.open[-1] not in ("script", "style"):
            self.words.append(data)
        if self.open and self.open[-1] == "h2":
            self.titles.append(data)


@pytest.fixture(scope="module")
def outline(reported):
    found = Outline()
    found.feed(reported.text)
    found.close()
    assert found.open == []
    return found


def test_the_page_is_whole_and_asks_nobody(reported, outline):
    assert reported.page.stat().st_size < 6e6
    assert outline.links and all(link.startswith(("#", "data:")) for link in outline.links)
    assert not re.search(r"url\((?!#)|@import|<iframe|<object|<base", reported.text)
    assert "default-src 'none'" in unescape(reported.text)
    wanted = ["Result", "This run", "Frequency responses", "Car, signal, engine", "Try it", "Findings", "Notices"]
    wanted += ["Dampers", "Time histories", "Comfort", "Modes", "Spectra", "The car"]
    assert outline.titles == [*wanted, "All values", "How to repeat the run"]
    assert reported.text.count("<svg ") == 6  # change, FRFs, time histories, bands of the comfort, spectra, car


def test_the_page_says_the_numbers_of_the_summary(reported, outline):
    summary = json.loads((reported.folder / "summary.json").read_text())
    words = " ".join(outline.words)
    total = summary["comfort"]["seat_rail"]["iso2631"]["vector_sum"]["weighted_rms"]
    assert f"{total:.3g} m/s²" in words and reactions(total)[0] in words
    assert f"{100 * summary['slip_share']['fl']:.2f} %" in words
    top = max(summary["peaks"]["knuckle_fl_acc_z"], key=lambda peak: peak["magnitude"])
    assert f"The highest vertical resonance at the knuckle is at {top['frequency_hz']:.1f} Hz" in words
    assert "front.damper.coulomb_friction" in words and "a<b>&c.csv" in words
    general = [notice for notice in summary["notices"] if "inertia tensor" in notice or "has no seat" in notice]
    assert len(general) == 2, "true of every run of this car"
    assert all((notice in words) == (notice not in general) for notice in summary["notices"])
    assert summary["command"].startswith("python -m vehicle.shaker --input ") and summary["command"] in words
    assert summary["files"]["report"] == "report.html"


def test_a_report_of_the_folder_is_that_of_the_command(reported, tmp_path, capsys):
    """The same bytes again, from the files alone: the car is built from vehicle.toml."""
    again = tmp_path / "again.html"
    options = ["--project", "Ride", "--author", "A. Engineer"]
    assert main([str(reported.folder), "--output", str(again), "--quiet", *options]) == 0
    assert again.read_bytes() == reported.page.read_bytes()
    assert main([str(reported.folder), "--output", str(again), "--quiet"]) == 2
    assert "exists; give --force" in capsys.readouterr().err


@pytest.mark.usefixtures("no_figures")
def test_runs_stand_beside_each_other(reported, tmp_path, monkeypatch, capsys):
    """The figures of each run are those of a single one, and are left out here, as is the film of both."""

    def film(folders, path, take, **options):
        assert list(folders) == [reported.folder] * 2 and take["slow"] == 4.0
        path.write_bytes(b"film")
        return "as they are"

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("vehicle.runs.report.pair_film.film_of_two", film)
    monkeypatch.setattr("vehicle.drawing.rendering.backend.require_film", lambda: "osmesa")
    page = tmp_path / "two.html"
    assert main([*[str(reported.folder)] * 2, "--output", str(page), "--video", "--slow-motion", "4"]) == 0
    assert "video       film.mp4: as they are" in capsys.readouterr().out
    found = Outline()
    found.feed(page.read_text(encoding="utf-8"))
    wanted = ["Result", "Video", "Comparison of the runs", "Frequency responses and spectra", "Time histories"]
    assert found.titles[:5] == wanted and found.titles[6:] == ["Modes", "Each run"]
    assert "None: the cars have equal parameters." in found.words
    assert page.stat().st_size < 6e6


def test_author_and_project_are_in_the_head_of_the_report_of_a_run(reported, tmp_path, capsys):
    assert "Ride, A. Engineer, 20" in unescape(reported.page.read_text(encoding="utf-8"))
    assert shaker(["--input", "low.csv", "--output", str(tmp_path / "out"), "--author", "A. Engineer"]) == 2
    assert "--author: belongs to --report" in capsys.readouterr().err


@pytest.mark.usefixtures("no_figures")
def test_first_screen_answers_the_question(reported, tmp_path):
    """What changed, by how much, and where in frequency: a car with half the spring stiffness on the same signal."""
    summary = json.loads((reported.folder / "summary.json").read_text())
    softer = tmp_path / "softer"
    words = ["--input", summary["command"].split(" --input ")[1].split(" --output")[0].strip("'")]
    words += ["--output", str(softer), "--engine", "reduced", "--quiet", "--set", "damper.coulomb_friction=100"]
    assert shaker([*words, "--set", "main_spring.stiffness=12000"]) == 0
    page = tmp_path / "two.html"
    assert main([str(reported.folder), str(softer), "--output", str(page), "--author", "A. <b>", "--project", "P"]) == 0
    text = unescape(page.read_text(encoding="utf-8"))
    assert "P, A. <b>, 20" in text and "vehicle-on-shaker 0." in text
    summaries = [json.loads((folder / "summary.json").read_text()) for folder in (reported.folder, softer)]
    before, after = (each["comfort"]["seat_rail"]["iso2631"]["vector_sum"]["weighted_rms"] for each in summaries)
    told = text.partition('<p class="answer">')[2].partition("<")[0]
    word = "rises" if after > before else "falls"
    assert "front main spring stiffness 12000 instead of " in told
    assert f"{word} from {before:.3g} to {after:.3g} m/s²" in told
    assert re.search(
        r"% of the change of the mean square is (fore-aft|lateral|vertical) between [\d.]+ and [\d.]+ Hz", told
    )
    moved = re.search(r"mainly by the mode of ([a-z ,]+), which moves from ([\d.]+) to ([\d.]+) Hz", told)
    assert moved is not None and moved[2] != moved[3]
    for folder, frequency in ((reported.folder, moved[2]), (softer, moved[3])):
        modes = Car.load(folder / "vehicle.toml").modes("sliding")
        assert [mode for mode in modes if f"{mode.frequency:.3g}" == frequency and moved[1] in mode.description]
    # The path is that of the mode, and none is named if none carries most of it.
    first = read_run(reported.folder)
    band = main_band(*(weighted_bands(each) for each in (read_run(softer), first)))
    assert band is not None
    mode = next(each for each in first.car.modes("sliding") if f"{each.frequency:.3g}" == moved[2])
    path = main_path(paths(first, band.axis, mode))
    assert (f"carried into the body by {path}" in told) if path else ("carried into the body" not in told)
    assert not re.search(r"_f[lr]\b", told), "words instead of names of the model"


def test_a_changed_car_is_compared_with_the_unchanged_one(reported, tmp_path):
    """The value before the change is that of a run of the unchanged car by the command."""
    summary = json.loads((reported.folder / "summary.json").read_text())
    unchanged = tmp_path / "unchanged"
    signal = summary["command"].split(" --input ")[1].split(" --output")[0].strip("'")
    assert shaker(["--input", signal, "--output", str(unchanged), "--engine", "reduced", "--quiet"]) == 0
    before, after = (
        json.loads((folder / "summary.json").read_text())["comfort"]["seat_rail"]["iso2631"]["vector_sum"]
        for folder in (unchanged, reported.folder)
    )
    told = unescape(reported.text).partition('<p class="answer">')[2].partition("<")[0]
    small = 5e-4 <= abs(after["weighted_rms"] / before["weighted_rms"] - 1.0) <= 0.11
    assert ("Industrial Health 40, 2002" in reported.text) == small
    assert told.startswith("run against the unchanged focus (front damper Coulomb friction 100 instead of 125 N): ")
    assert f"from {before['weighted_rms']:.3g} to {after['weighted_rms']:.3g} m/s²" in told
    assert base_run(read_run(unchanged)) is None, "an unchanged car has no other to be compared with"


@pytest.mark.parametrize(
    ("shares", "words"),
    [
        ({"suspension_mount_fl": 0.6, "suspension_mount_fr": 0.1}, "the front left suspension mount (60 %)"),
        ({"suspension_mount_fl": 0.4, "suspension_mount_fr": 0.3}, "the front suspension mount, left and right (70 %)"),
        ({"pivot_rl": 0.5, "linear_mount": 0.6}, "the engine mount (60 %)"),
        ({"stab_body_fl": 0.5, "stab_body_fr": -0.4}, "the front left anti-roll bar bearing (50 %)"),
        ({"suspension_mount_fl": 1.1, "pivot_rl": -0.1}, "the front left suspension mount"),
        ({"damper_mount_rl": 0.28, "suspension_mount_fl": 0.2, "suspension_mount_fr": 0.2}, ""),
        ({"suspension_mount_fl": 1.6, "pivot_rl": -0.6}, ""),
        ({}, ""),
    ],
)
def test_the_main_path_is_in_the_words_of_the_car(shares, words):
    assert main_path(shares) == words


def test_what_follows_a_parameter_is_not_named(reported, tmp_path):
    """A heavier body has another inertia: its moments follow the mass, which alone is named."""
    signal = json.loads((reported.folder / "summary.json").read_text())["command"].split(" --input ")[1]
    heavier = tmp_path / "heavier"
    words = ["--input", signal.split(" --output")[0].strip("'"), "--output", str(heavier), "--engine", "reduced"]
    changes = ["--set", "body.mass=900", "--set", "suspension_mount.stiffness.z=6e5"]
    assert shaker([*words, "--quiet", *changes]) == 0
    run = read_run(heavier)
    base = base_run(run)
    assert base is not None
    assert len(changed_parameters([base.car.vehicle, run.car.vehicle])) > 3
    wanted = "(body mass 900 instead of 813 kg, front suspension mount stiffness z 600000 instead of 700000 N/m)"
    assert wanted in answer([base, run], [modes_of(base), modes_of(run)])
    # Parameters that the first run sets, and the second does not, are named too; a word has no unit.
    wanted = "(body mass 813 instead of 900 kg, front suspension mount stiffness z 700000 instead of 600000 N/m)"
    assert wanted in answer([run, base], [modes_of(run), modes_of(base)])
    law = {"front.damper.friction_law": "presliding", "front.damper.presliding_stiffness": 1e6}
    other = dataclasses.replace(base, car=base.car.with_(law))
    assert "friction law presliding instead of coulomb, front" in answer([base, other], [modes_of(base)] * 2)


def test_parameters_are_in_words():
    words = {
        "front.damper.coulomb_friction": "front damper Coulomb friction",
        "engine.parts.engine.mass": "engine mass",
        "front.bushings.suspension_mount.stiffness.z": "front suspension mount stiffness z",
        "body.cog.x": "body cog x",
    }
    assert {path: parameter_words(path) for path in words} == words


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["nowhere"], "nowhere: is not a folder; give the folder of a run"),
        (["."], "contains no summary.json; give the folder of a run"),
        (["{run}", "--output", "page.txt"], "--output page.txt: the name must end in .html"),
        (["{run}", "--video"], "--video: needs two runs, found 1"),
        (
            ["{run}", "--output", "mine.html", "--force"],
            "--output mine.html: was not written by this program, or was changed since",
        ),
    ],
)
def test_what_cannot_be_reported_is_refused(words, message, reported, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.html").write_text("<html>mine</html>")
    assert main([word.format(run=reported.folder) for word in words]) == 2
    assert message in capsys.readouterr().err
    assert (tmp_path / "mine.html").read_text() == "<html>mine</html>"


def test_a_damaged_run_is_refused(reported, tmp_path, capsys):
    (tmp_path / "summary.json").write_text('{"files": {}}')
    assert main([str(tmp_path)]) == 3
    assert "summary.json: is damaged (comfort: missing); run the simulation again" in capsys.readouterr().err
    content = json.loads((reported.folder / "summary.json").read_text())
    content["comfort"]["seat_rail"]["rms_2_50_hz"]["x"] = "0.5"
    (tmp_path / "summary.json").write_text(json.dumps(content))
    assert main([str(tmp_path)]) == 3
    assert "(comfort.seat_rail.rms_2_50_hz.x: found '0.5', must be float)" in capsys.readouterr().err
    del content["input"]["wheel"]
    (tmp_path / "summary.json").write_text(json.dumps(content))
    assert main([str(tmp_path)]) == 3 and "(input.wheel: missing)" in capsys.readouterr().err
    (tmp_path / "summary.json").write_text((reported.folder / "summary.json").read_text())
    assert main([str(tmp_path)]) == 3
    assert "vehicle.toml: is missing, although summary.json lists it as vehicle" in capsys.readouterr().err


def test_reactions_are_those_of_the_standard():
    """ISO 2631-1:1997, C.2.3, with the overlaps and the open ends."""
    told = {
        0.0: ("not uncomfortable",),
        0.3149: ("not uncomfortable",),
        0.315: ("a little uncomfortable",),
        0.55: ("a little uncomfortable", "fairly uncomfortable"),
        0.7: ("fairly uncomfortable",),
        0.9: ("fairly uncomfortable", "uncomfortable"),
        1.3: ("uncomfortable", "very uncomfortable"),
        2.0: ("very uncomfortable",),
        2.2: ("very uncomfortable", "extremely uncomfortable"),
        3.0: ("extremely uncomfortable",),
    }
    assert {value: reactions(value) for value in told} == told


def test_a_time_and_a_share_have_differences_and_no_ratio():
    assert difference(3.57, 28.2, "s") == "+24.6 s" and difference(2.0, 5.5, "%") == "+3.5 points"
    assert difference(2.0, 3.0, "m/s²") == "+50 %" and difference(None, 3.0, "s") == "–"


def test_changed_parameters_are_those_that_were_set():
    cars = [
        Car.load().vehicle,
        Car.load(overrides=["damper.coulomb_friction=100", "engine.parts.engine.mass=200"]).vehicle,
    ]
    assert [(path, unit, values) for path, unit, values in changed_parameters(cars)] == [
        ("engine.parts.engine.mass", "kg", ["220", "200"]),
        ("front.damper.coulomb_friction", "N", ["125", "100"]),
    ]
    assert changed_parameters([cars[0], cars[0]]) == []


@pytest.mark.parametrize(("name", "lines"), [("focus", 2 * 4 + 2 * 8), ("focus_road", 4 * 4)])
def test_a_body_without_rear_wheels_is_drawn_on_stands(name, lines):
    wire = car_wireframe(Car.load(name).model)
    ground = wire.lines[wire.groups == GROUPS.index("ground")]
    assert len(ground) == lines and not wire.motion[np.unique(ground)].any()
    assert wire.points[ground.ravel(), 0].max() > 3.4  # under the rear axle


def test_points_move_as_the_car_moves():
    """Against MuJoCo's own kinematics of a small motion: bodies, and the sites of the flexible body by their places."""
    car = Car.load().model
    wire = car_wireframe(car)
    model, data = car.model, mujoco.MjData(car.model)
    rng, step = np.random.default_rng(1), 1e-6
    motion = rng.standard_normal(model.nv)
    mujoco.mj_kinematics(model, data)
    centres = {wheel.part: data.body(wheel.part).xpos.copy() for wheel in car.vehicle.composition.wheels}
    mujoco.mj_integratePos(model, data.qpos, motion, step)
    mujoco.mj_kinematics(model, data)
    moved = wire.displacement(motion.astype(complex)).real
    for wheel in car.vehicle.composition.wheels:
        # The hub of the drawing is the centre of the wheel, at which its body sits.
        hub = int(np.argmin(np.linalg.norm(wire.points - np.asarray(wheel.center), axis=1)))
        assert np.allclose(wire.points[hub], centres[wheel.part], atol=1e-9)
        expected = (data.body(wheel.part).xpos - centres[wheel.part]) / step
        assert np.allclose(moved[hub], expected, rtol=1e-4, atol=1e-4)
    # A node of the body: its rigid motion and the sum of its mode shapes.
    modal = [int(model.jnt_dofadr[j]) for j in range(model.njnt) if model.joint(j).name.startswith("mode_")]
    alone = np.zeros(model.nv)
    alone[modal] = motion[modal]
    nodes = len(car.superelement.positions)
    expected = np.einsum("m,mni->ni", motion[modal], np.asarray(car.superelement.shapes))
    assert np.allclose(wire.displacement(alone.astype(complex)).real[:nodes], expected, atol=1e-12)


def test_a_mode_of_the_page_is_that_of_the_car(reported):
    data = json.loads(reported.text.split('id="mode-data">')[1].split("</script>")[0])
    car = Car.load(reported.folder / "vehicle.toml")
    assert {state: len(found) for state, found in data["cars"][0]["states"].items()} == {
        state: len(car.modes(state)) for state in ("stuck", "sliding")
    }
    mode, shown = car.modes("stuck")[5], data["cars"][0]["states"]["stuck"][5]
    assert shown["hz"] == pytest.approx(mode.frequency, abs=1e-4)
    moved = car_wireframe(car.model).displacement(mode.shape)
    told = (np.array(shown["re"]) + 1j * np.array(shown["im"])).reshape(-1, 3) / FULL
    overlap = abs(np.vdot(told, moved)) ** 2 / (np.vdot(told, told).real * np.vdot(moved, moved).real)
    assert overlap > 0.99999
    assert np.linalg.norm(unit_factor(moved) * moved, axis=1).max() == pytest.approx(1.0)


def test_what_makes_the_seat_rail_loud_is_said_with_the_shares_of_the_command(reported, capsys):
    text = unescape(re.sub(r"<[^>]+>", "", reported.text))
    start = "the largest contributions to the vertical acceleration at the seat rail are"
    told = re.findall(rf"At ([\d.]+) Hz {start} (.+?) [+-]\d+ %", text)
    assert 1 <= len(told) <= 3
    peaks = json.loads((reported.folder / "summary.json").read_text())["peaks"]["seat_rail_acc_z"]
    highest = max(peaks, key=lambda peak: peak["magnitude"])["frequency_hz"]
    first = next(name for at, name in told if float(at) == pytest.approx(highest, abs=0.051))
    (state,) = re.findall(r"Shares: linear car, dampers (\w+). More: python -m vehicle body participation", text)
    words = ["participation", "--at", str(highest), "--damper", state, "--json"]
    assert body_command([*words, "--vehicle", str(reported.folder / "vehicle.toml")]) == 0
    parts = {one["name"]: one["share"] for one in json.loads(capsys.readouterr().out)["contributions"]}
    assert first in parts and abs(parts[first]) == max(map(abs, parts.values()))
    assert f"are {first} {100 * parts[first]:+.0f} %" in text


def test_a_car_is_compared_with_the_shipped_one_that_it_was_made_from():
    sedan = Car.load("sedan", ["name=mine", "body.mass=1300"]).vehicle
    origin = shipped_origin(sedan)
    assert origin is not None and origin.name == "sedan"
    assert len(changed_parameters([origin, sedan])) == 6  # name, mass, four moments and products
    # Most of it is of no shipped car: nothing is claimed.
    table = dict(sedan.table)
    table["front"], table["rear"] = {f"key_{number}": number for number in range(100)}, {}
    assert shipped_origin(dataclasses.replace(sedan, table=table)) is None


def test_a_mode_is_compared_with_the_same_motion_of_the_other_car(tmp_path):
    """With a mount more, the wheel hop of a rolling car stays near its frequency; no other mode takes its place.

    Without the mass matrix the angles of the rolling wheels decide, and the pitch mode at 1.47 Hz is the most similar.
    """
    mount = (
        '[connection.mount]\nmoving = "engine"\ncarrier = "body"\nat = [0.75, 0.3, 0.6]\n'
        "stiffness = [2e5, 2e5, 1e5]\ndamping = [200, 200, 200]\nrotational_stiffness = 0.0\n"
    )
    (tmp_path / "vehicle.toml").write_text(f'base = "sedan"\nname = "mine"\n{mount}', encoding="utf-8")
    cars = [Car.load(name, ["driving.speed=22.2"]) for name in ("sedan", tmp_path)]
    modes = [each.modes("sliding") for each in cars]
    hop = next(mode for mode in modes[0] if mode.description.startswith("front wheel hop, sides in phase"))
    partner = counterpart(hop, modes[1], cars[0].matrices.system.mass)
    assert partner is not None and partner.frequency == pytest.approx(hop.frequency, rel=0.05)
