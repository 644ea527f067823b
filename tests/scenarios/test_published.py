"""The table of everything: rows collected, none left out, finished studies read, pictures copied."""

import importlib
import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from PIL import Image, ImageDraw

import scenarios.published.__main__ as published
from scenarios import evidence
from scenarios.published.pictures import LARGEST, write_copy
from scenarios.published.sources import SOURCES, THESIS, place_of, section_of
from scenarios.published.statements import STATEMENTS
from scenarios.study import STUDIES


def row(name, within=True, **changes):
    return {
        "name": name, "published": 1.0, "ours": 1.02, "deviation": 0.02, "within": within, "why": "5 %",
        "status": "predicted", "source": "text", "interval": None,
        "place": "figure 3.3", "picture": "", "probability": None, "inside": None, "evidence": "", **changes,
    }  # fmt: skip


KEYS = set(row(""))

CONTENT = {
    "levels": [
        row("slip share of the right damper, high [%]", place="table 3.2", picture="slip.png"),
        row("vertical wheel mode, low [Hz]", within=False, place="section 3.2.1.2", picture="never_written.png"),
    ],
    "quarter_car": [
        row("stick modes [Hz]", published="4.8 | 25", ours="4.8, 25.1", deviation=None, place="section 2.2.4"),
        row("table B.1 [m/s2]", within=None, status="not testable", place="table B.1"),
    ],
    "half_car_rider": [row("VDV with speed", status="chosen", place="figures 5 and 6")],
}


def replace_studies(monkeypatch, module):
    """Have `scenarios.NAME` be what `module(NAME)` returns."""
    real = importlib.import_module

    def instead(name, package=None):
        return module(name.split(".")[1]) if name.startswith("scenarios.") else real(name, package)

    monkeypatch.setattr("importlib.import_module", instead)


@pytest.fixture
def studies(monkeypatch, tmp_path):
    """Three studies that write a file and count their runs."""
    calls: dict[str, list[list[str]]] = {name: [] for name in CONTENT}

    def module(name):
        def main(arguments):
            calls[name].append(arguments)
            folder = Path(arguments[1])
            assert folder in (tmp_path / "runs" / name, tmp_path / "runs" / f"{name}_beside")
            folder.mkdir(parents=True, exist_ok=True)
            content: dict[str, Any] = {"title": f"title of {name}", "rows": CONTENT[name], "notes": [f"made by {name}"]}
            if name == "levels":
                content["not_judged"] = {"smallest line of the FRFs, mid": "too short"}
                Image.new("RGB", (1200, 600), "white").save(folder / "slip.png")
            (folder / "results.json").write_text(json.dumps(content), encoding="utf-8")
            return 0

        return SimpleNamespace(main=main)

    monkeypatch.setattr(published, "STUDIES", tuple(CONTENT))
    replace_studies(monkeypatch, module)
    return calls


def command(tmp_path, *more):
    return published.main(["--output", str(tmp_path / "table"), "--runs", str(tmp_path / "runs"), *more])


def written(tmp_path):
    return (tmp_path / "table" / "published-results.md").read_text(encoding="utf-8")


def test_every_row_of_every_study_is_in_the_table_and_on_the_page(studies, tmp_path, capsys):
    assert command(tmp_path, "--quick", "--jobs", "2") == 0
    assert studies["levels"] == [["--output", str(tmp_path / "runs" / "levels"), "--force", "--jobs", "2", "--quick"]]
    rows = json.loads((tmp_path / "table" / "results.json").read_text(encoding="utf-8"))["rows"]
    assert [row["name"] for row in rows] == [f"{study}: {row['name']}" for study in CONTENT for row in CONTENT[study]]
    assert all(set(row) == {*KEYS, "beside"} for row in rows)
    text, messages = written(tmp_path), capsys.readouterr()
    counts = "2 of 3 predicted rows agree; in addition 1 chosen (1 agree), 1 not testable"
    assert f"**{counts}.**" in text and counts in messages.out
    assert "| vertical wheel mode, low [Hz] | 1 | 1.02 | NO | predicted | 5 % |" in text
    assert "| stick modes [Hz] | 4.8 \\| 25 | 4.8, 25.1 | yes | predicted | 5 % |" in text
    assert "| table B.1 [m/s2] | 1 | 1.02 | not testable | not testable | 5 % |" in text
    assert "| all | 2 of 3 |  | 1 of 1 |  |  | 1 |" in text
    assert "| thesis of Bommer, 2006 | 2 of 3 |  |  |  |  | 1 |" in text
    assert "Made with `--quick`: short signals, other numbers, 1 rows left open." in text
    assert "levels/never_written.png: picture of a row, but the study did not write it" in messages.err
    assert "![Table 3.2](figures/levels_slip.png)" in text and "never_written" not in text
    assert [path.name for path in (tmp_path / "table" / "figures").iterdir()] == ["levels_slip.png"]


def test_the_page_follows_the_order_of_the_sources(studies, tmp_path):
    assert command(tmp_path) == 0
    heads = [line for line in written(tmp_path).split("\n") if line.startswith(("## T", "## H", "###"))]
    assert heads == [
        "## Thesis of Bommer, 2006",
        "### 2.2 Linear quarter-car models", "#### Section 2.2.4",
        "### 3.2.1 Frequency-domain tuning", "#### Section 3.2.1.2",
        "### 3.3 Validation of the complete-car model", "#### Table 3.2",
        "### B Smooth friction parameter", "#### Table B.1",
        "## Half car with rider", "#### Figures 5 and 6",
    ]  # fmt: skip


def test_rows_that_do_not_agree_stand_at_the_top_with_a_link(studies, tmp_path):
    assert command(tmp_path) == 0
    text = written(tmp_path)
    top = text[text.index("## Rows that do not agree") : text.index("## Rows that are undecided")]
    link = "[Thesis of Bommer, 2006: section 3.2.1.2](#bommer-section-3-2-1-2)"
    assert f"| {link} | vertical wheel mode, low [Hz] | 1 | 1.02 | predicted | 5 % |" in top
    assert top.count("\n| ") == 2 and '<a id="bommer-section-3-2-1-2"></a>' in text
    assert "[Section 3.2.1.2](#bommer-section-3-2-1-2) (1 NO)" in text


@pytest.mark.parametrize(
    ("text", "heading", "section"),
    [
        ("figure 3.17", "Figure 3.17", "3.2.2"),
        ("section 2.3.2.4, figure 2.13", "Figure 2.13", "2.3.2"),
        ("figures 3.19, 3.20", "Figures 3.19, 3.20", "3.2.2"),
        ("table 3.2", "Table 3.2", "3.3"),
        ("section 3.2.1.1", "Section 3.2.1.1", "3.2.1"),
        ("section 3.2", "Section 3.2", "3.2.1"),
        ("chapter 4", "Chapter 4", "4.1"),
        ("appendices C and D", "Appendices C and D", "C"),
        ("figure D.5", "Figure D.5", "D"),
        ("figures 4.10 to 4.12", "Figures 4.10 to 4.12", "4.3"),
        ("", "", None),
        ("summary", "Summary", None),
    ],
)
def test_a_place_has_a_heading_and_a_section(text, heading, section):
    location = place_of(text)
    section_found = section_of(THESIS, location)
    assert (location.text, section_found and section_found.number) == (heading, section)


def test_figures_are_in_the_order_of_their_numbers():
    texts = ["figure 3.12", "figure 3.9", "table 3.1", "section 3.2.1"]
    assert sorted(texts, key=lambda text: place_of(text).sort_key) == texts[::-1]


def test_every_study_of_a_source_exists():
    assert {study for source in SOURCES for study in source.studies} <= set(STUDIES)


def test_statements_without_a_row_are_named_on_the_page(studies, tmp_path):
    assert command(tmp_path) == 0
    line = written(tmp_path).split("Statements that no row answers: ")[1].split(".\n")[0]
    others = line.split("; ")
    answered = {
        "complete car: slip share, low / mid / high",
        "complete car: vertical wheel mode",
        "complete car: FRFs, axes",  # left open
        "quarter car: modes with the damper slipping and sticking",
        "quarter car: smoothing parameter eps",
        "half car with rider: VDV with speed",
    }
    assert others == [statement for statement in STATEMENTS if statement not in answered]


def test_finished_studies_are_read_and_missing_ones_run(studies, tmp_path):
    assert command(tmp_path) == 0
    (tmp_path / "runs" / "levels" / "results.json").unlink()
    assert command(tmp_path, "--reuse", "--force") == 0
    assert {name: len(calls) for name, calls in studies.items()} == {"levels": 3, "quarter_car": 1, "half_car_rider": 1}


def test_the_second_car_has_a_column_and_a_count(studies, tmp_path, monkeypatch):
    untested = row("seat", within=None, status="not testable", place="section 5.2")
    monkeypatch.setitem(CONTENT, "levels", [*CONTENT["levels"], untested])
    assert command(tmp_path) == 0
    first, second = studies["levels"]
    assert second == [*first[:1], f"{first[1]}_beside", *first[2:], "--vehicle", "focus_measured_roll"]
    text = written(tmp_path)
    assert "| statement | published | ours | agrees | Ixx 1080 | status | why |" in text
    assert "| slip share of the right damper, high [%] | 1 | 1.02 | yes | 1.02: yes | predicted | 5 % |" in text
    assert "| seat | 1 | 1.02 | not testable | 1.02: not testable | not testable | 5 % |" in text
    assert "Of 2 predicted rows computed with both cars, 1 agree with the printed Ixx 1000 and 1 with Ixx 1080." in text


def test_a_row_of_the_choice_says_its_half(studies, tmp_path, monkeypatch):
    used, held = (
        next(key for key in evidence.EVIDENCE if (key.key in evidence.USED) == half) for half in (True, False)
    )
    rows = [row("a", status="chosen", evidence=used.key, inside=False), row("b", evidence=held.key, inside=True)]
    monkeypatch.setitem(CONTENT, "levels", rows)
    assert command(tmp_path, "--quick") == 0
    text = written(tmp_path)
    assert "| a | 1 | 1.02 | no | yes | chosen (used) | 5 % |" in text
    assert "| b | 1 | 1.02 | yes | yes | predicted (held out) | 5 % |" in text


def test_the_notes_of_the_choice_are_the_last_section(studies, tmp_path, monkeypatch):
    monkeypatch.setattr(published, "CHOICE", "quarter_car")
    assert command(tmp_path) == 0
    last = written(tmp_path).rpartition("\n## What was chosen, and on what\n")[2]
    assert "<summary>1 note</summary>\n\nmade by quarter_car\n" in last and last.count("<details") == 1


def test_a_picture_that_no_row_names_any_more_is_removed(studies, tmp_path, monkeypatch):
    assert command(tmp_path) == 0
    monkeypatch.setattr(published, "STUDIES", ("quarter_car",))
    assert command(tmp_path, "--reuse", "--force") == 0
    assert not list((tmp_path / "table" / "figures").iterdir())


def test_the_full_table_writes_the_page_of_the_documents(studies, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert published.main(["--runs", str(tmp_path / "runs")]) == 0
    assert "](../renders/published/figures/levels_slip.png)" in published.PAGE.read_text(encoding="utf-8")
    assert {path.name for path in published.HOME.iterdir()} >= {"results.json", "figures"}


def test_the_kept_results_may_be_replaced_with_their_list_alone(studies, tmp_path):
    """A clone has the list of written files; without it nothing shows that the program wrote them."""
    assert command(tmp_path) == 0
    assert command(tmp_path, "--reuse", "--force") == 0
    (tmp_path / "table" / ".vehicle-files").unlink()
    assert command(tmp_path, "--reuse", "--force") == 2


def test_a_failed_study_ends_the_command(studies, tmp_path, monkeypatch, capsys):
    replace_studies(monkeypatch, lambda name: SimpleNamespace(main=lambda arguments: 3))
    assert command(tmp_path) == 4
    assert "scenarios.levels: ended with exit code 3" in capsys.readouterr().err


def test_a_broken_file_is_named(studies, tmp_path, capsys):
    assert command(tmp_path) == 0
    (tmp_path / "runs" / "levels" / "results.json").write_text("{", encoding="utf-8")
    assert command(tmp_path, "--reuse", "--force") == 3
    assert "results.json: cannot be read" in capsys.readouterr().err


def test_a_noisy_picture_is_made_smaller_until_it_fits(tmp_path):
    noise = np.random.default_rng(1).integers(0, 255, (900, 1500, 3), dtype=np.uint8)
    Image.fromarray(np.repeat(np.repeat(noise[::6, ::6], 6, axis=0), 6, axis=1)).save(tmp_path / "large.png")
    write_copy(tmp_path / "large.png", tmp_path / "small.png")
    with Image.open(tmp_path / "small.png") as small:
        assert (tmp_path / "small.png").stat().st_size <= LARGEST and 300 < small.width < 1000
        assert small.width / small.height == pytest.approx(5.0 / 3.0, rel=0.01)


def test_a_short_red_line_keeps_its_colour_beside_blue_ones(tmp_path):
    picture = Image.new("RGB", (1200, 500), "white")
    draw = ImageDraw.Draw(picture)
    for height in range(20, 480, 23):
        draw.line([(20, height), (1180, height + 9)], fill=(26, 115, 196), width=2)
    draw.line([(900, 250), (960, 230)], fill=(179, 38, 30), width=2)
    picture.save(tmp_path / "a.png")
    write_copy(tmp_path / "a.png", tmp_path / "b.png")
    with Image.open(tmp_path / "b.png") as copy:
        red, _, blue = np.moveaxis(np.asarray(copy.convert("RGB"), dtype=int), -1, 0)
    assert np.sum(red > blue + 60) > 20
