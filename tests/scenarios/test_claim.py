"""Result rows, output folder and command line shared by the lumped studies."""

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

import scenarios
from scenarios.__main__ import main as print_list
from scenarios.claims import (
    FITTED,
    NOT_TESTABLE,
    PREDICTED,
    STATUSES,
    TABLE,
    Claim,
    Findings,
    Kind,
    Status,
    claim_table,
    headline,
    interval_claim,
    spread_claim,
)
from scenarios.study import STUDIES, LumpedSettings, lumped_study, main_of
from scenarios.verdict import verdict
from vehicle.errors import ConfigurationError, OutputError, SimulationError
from vehicle.runs.output.folder import check_study, study_folder, write_text
from vehicle.runs.output.written_files import MARKER

HOME = Path(scenarios.__file__).parent


def test_number_row():
    row = PREDICTED.number("peak [Hz]", 2.0, 2.5, 0.4, "because")
    assert (row.deviation, row.within) == (0.25, False)
    assert FITTED.number("peak [Hz]", 2.0, 2.5, 0.5, "because").within is True


def test_an_extreme_agrees_inside_its_interval():
    inside, below, above = (interval_claim("a", (-0.8, -0.6), ours, "w") for ours in (-0.6, -1.0, -0.3))
    assert (inside.within, inside.deviation, inside.published) == (True, 0.0, "-0.8 to -0.6")
    assert not below.within and below.deviation == pytest.approx(-0.25)
    assert not above.within and above.deviation == pytest.approx(0.5)
    below_zero = interval_claim("a", (0.0, 0.5), -0.1, "w")
    assert below_zero.deviation is None and below_zero.within is False  # no share of 0
    open_end = interval_claim("a", (0.5, float("inf")), 70.0, "w")
    assert open_end.within and open_end.published == "0.5 or more" and open_end.source == "axis interval"


@pytest.mark.parametrize(("interval", "ours", "outside"), [((0.0, 0.5), 0.2, 0.6), ((-300.0, 0.0), -20.0, -310.0)])
def test_an_interval_that_reaches_to_0_is_a_bound_alone(interval, ours, outside):
    """Half of the size, or a hundredth of it, lies inside too: such a row can contradict and never agree."""
    row = interval_claim("a", interval, ours, "w", status="chosen")
    assert (row.status, row.within, row.inside) == ("not testable", None, True) and row.why.startswith("w; only one")
    assert interval_claim("a", interval, 0.01 * ours, "w").within is None
    row = interval_claim("a", interval, outside, "w", status="chosen")
    assert (row.status, row.within, row.inside, row.why) == ("chosen", False, False, "w")


def test_a_spread_agrees_where_the_interval_is_probable_and_prints_the_probability():
    narrow = [0.45, 0.46, 0.47, 0.46, 0.45, 0.47, 0.46, 0.46]  # within one tick
    inside = spread_claim("a", (0.4, 0.6), narrow, "w").at("figure 3.13", "seat_rail.png")
    assert inside.within and inside.probability == pytest.approx(1.0, abs=1e-4)
    assert inside.ours == "0.46 +- 0.0076 (8 values)"
    assert inside.why == "probability of the interval 100 %, must be above 5 %; w"
    assert (inside.place, inside.picture) == ("figure 3.13", "seat_rail.png")
    outside = spread_claim("a", (0.5, 0.6), narrow, "w")
    assert outside.within is False and outside.probability is not None and 0.0 < outside.probability < 0.05
    wide = spread_claim("a", (0.5, 0.6), [0.1, 0.9, 0.3, 0.7, 0.5, 0.4, 0.6, 0.2], "w")
    assert wide.within and wide.probability is not None and 0.05 < wide.probability < 0.2


def test_a_row_that_no_one_can_test_has_no_verdict_and_is_not_counted():
    rows = [
        NOT_TESTABLE.number("a", 1.0, 1.0, 0.1, "input unknown"),
        NOT_TESTABLE.statement("b", "x", "y", True, "w"),
        interval_claim("c", (0.0, 1.0), 0.5, "w", status="not testable"),
        spread_claim("d", (0.0, 1.0), [0.5, 0.6], "w", status="not testable"),
    ]
    assert [row.within for row in rows] == [None] * 4
    rows.append(made("predicted", True))
    assert headline([asdict(row) for row in rows]) == "1 of 1 predicted rows agree; in addition 4 not testable"
    assert "| not testable | not testable |" in claim_table([asdict(rows[0])])


def made(status: Status, within: bool) -> Claim:
    return Kind(status, "text").statement("a", "b", "c", within, "w")


def test_the_headline_counts_predicted_rows_only():
    claims = [made(status, within) for status in STATUSES for within in (True, False, False)]
    assert headline([asdict(claim) for claim in [*claims, made("predicted", True)]]) == (
        "2 of 4 predicted rows agree; in addition 3 fitted (1 agree), 3 chosen (1 agree), 3 own check (1 agree), "
        "3 duplicate (1 agree), 3 not testable"
    )


def test_both_counts_of_the_rows_with_an_interval():
    near = [0.61, 0.62, 0.6, 0.59, 0.63, 0.61, 0.6, 0.62]  # outside, yet not improbable
    rows = [
        interval_claim("a", (0.1, 1.0), 0.5, "w"),
        spread_claim("b", (0.4, 0.6), near, "w"),
        interval_claim("c", (0.1, 1.0), 2.0, "w", status="fitted"),
        interval_claim("d", (0.1, 1.0), 0.5, "w", status="duplicate"),
        made("predicted", True),
    ]
    assert [row.inside for row in rows] == [True, False, False, True, None]
    assert headline([asdict(row) for row in rows]) == (
        "3 of 3 predicted rows agree; in addition 1 fitted (0 agree), 1 duplicate (1 agree); of 3 rows with a printed "
        "interval our value is inside in 1, not contradicted at 5 % in 2"
    )


def test_a_verdict_holds_at_both_ends_of_the_interval():
    for holds in (lambda value: value > 1.0, lambda value: value < 3.0):  # either end may decide
        assert verdict(holds, 2.0, 0.4) is True
        assert verdict(holds, 2.0, 0.6) is None
    assert verdict(lambda value: value > 4.0, 2.0, 0.4) is False


def test_a_verdict_that_the_seeds_turn_is_undecided():
    values = np.array([0.61, 0.66, 0.6, 0.71, 0.64, 0.61, 0.69, 0.62])
    ends = [spread_claim("a", (0.4, high), values, "w").within for high in np.linspace(0.45, 0.65, 81)]
    # From NO to yes as the interval grows, undecided between.
    assert [ends.index(one) for one in (False, None, True)] == sorted(ends.index(one) for one in (False, None, True))
    assert ends == sorted(ends, key=[False, None, True].index)
    row = PREDICTED.number("a", 1.0, 1.09, 0.1, "w", error=0.01)
    assert (row.within, PREDICTED.number("a", 1.0, 1.09, 0.1, "w", error=0.004).within) == (None, True)
    assert headline([asdict(row)]) == "0 of 1 predicted rows agree, 1 undecided"
    assert "| undecided | predicted |" in claim_table([asdict(row)])


def test_files_hold_rows_notes_and_data(tmp_path):
    rows = [
        TABLE.number("a | b", 2.0, 2.1, 0.2, "w"),
        made("fitted", False),
        interval_claim("c", (95.0, float("inf")), 90.0, "v").at("figure 4.12"),
    ]
    Findings(title="Title", claims=rows, notes=["A note."], data={"extra": [1.0, float("inf")]}).write(tmp_path)
    text = (tmp_path / "results.md").read_text(encoding="utf-8")
    assert (
        "\n1 of 2 predicted rows agree; in addition 1 fitted (0 agree); of 1 rows with a printed interval our value is "
        "inside in 0, not contradicted at 5 % in 0." in text
    )
    assert "| a \\| b |  | 2 | 2.1 | +5.0 % |  | yes | predicted | table | w |" in text
    assert "| a |  | b | c |  |  | NO | fitted | text | w |" in text
    assert "| c | figure 4.12 | 95 or more | 90 | -5.3 % | no | NO | predicted | axis interval | v |" in text
    assert text.endswith("A note.\n")
    content = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert set(content["rows"][0]) == {
        "name", "published", "ours", "deviation", "within", "why", "status", "source", "interval",
        "place", "picture", "probability", "inside", "evidence",
    }  # fmt: skip
    assert [row["interval"] for row in content["rows"]] == [None, None, [95.0, None]]
    assert content["rows"][0]["deviation"] == pytest.approx(0.05)
    assert content["extra"] == [1.0, None]
    assert {path.name for path in tmp_path.iterdir()} - {MARKER} == {"results.md", "results.json"}


def test_empty_folder_is_taken_and_a_full_one_refused(tmp_path):
    folder = tmp_path / "new" / "deep"
    folder.mkdir(parents=True)
    assert check_study(folder, force=False) == folder
    with study_folder(folder, force=False) as made:
        write_text(made / "a.txt", "a")
    with pytest.raises(ConfigurationError, match="holds files; give another folder, or --force to overwrite"):
        check_study(folder, force=False)
    assert check_study(folder, force=True) == folder


def test_file_in_the_way_of_a_folder_is_an_output_error(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match=r"--output .*file: "):
        check_study(tmp_path / "file", force=True)


def failing(error):
    def study(parameters: None, folder: Path, settings: LumpedSettings) -> Findings:
        raise error

    return study


def run(study, folder, *more):
    return lumped_study("x", lambda settings: None, study, LumpedSettings)(["--output", str(folder), *more])


@pytest.mark.parametrize(
    ("error", "code"),
    [(ConfigurationError("c"), 2), (SimulationError("s"), 4), (OutputError("o"), 6), (KeyboardInterrupt(), 130)],
)
def test_errors_become_exit_codes(error, code, tmp_path, capsys):
    assert run(failing(error), tmp_path) == code
    assert capsys.readouterr().out == ""


def test_the_list_holds_every_study_and_no_other(capsys):
    assert print_list() == 0
    shown = capsys.readouterr().out
    names = {path.stem for path in HOME.glob("*.py") if "__main__" in path.read_text(encoding="utf-8")}
    names |= {path.parent.name for path in HOME.glob("*/__main__.py")}
    assert names - {"__main__", "study"} == set(STUDIES)
    assert all(f"\n{name} " in shown and callable(main_of(name)) for name in STUDIES)
