"""Result rows, output folder and command line shared by the lumped studies."""

import argparse
import json

import pytest

from scenarios.claim import number_claim, statement_claim, write_claims
from scenarios.output_folder import prepare_folder, write_text
from scenarios.study_command import run_study, study_parser
from vehicle.errors import ConfigurationError, OutputError, SimulationError


def test_number_row():
    row = number_claim("peak [Hz]", 2.0, 2.5, 0.4, "because")
    assert (row.deviation, row.within) == (0.25, False)
    assert number_claim("peak [Hz]", 2.0, 2.5, 0.5, "because").within is True


def test_files_hold_rows_notes_and_data(tmp_path):
    rows = [number_claim("a | b", 2.0, 2.1, 0.2, "w"), statement_claim("c", "rises", "falls", False, "v")]
    write_claims(tmp_path, "Title", rows, ["A note."], {"extra": [1.0, float("inf")]})
    text = (tmp_path / "results.md").read_text(encoding="utf-8")
    assert "1 of 2 statements, printed or our own check, agree." in text
    assert "| a \\| b | 2 | 2.1 | +5.0 % | yes | w |" in text
    assert "| c | rises | falls |  | NO | v |" in text
    assert text.endswith("A note.\n")
    content = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert content["rows"][0]["deviation"] == pytest.approx(0.05)
    assert content["extra"] == [1.0, None]
    assert {path.name for path in tmp_path.iterdir()} == {"results.md", "results.json"}


def test_empty_folder_is_taken_and_a_full_one_refused(tmp_path):
    assert prepare_folder(tmp_path / "new" / "deep", force=False).is_dir()
    assert prepare_folder(tmp_path / "new" / "deep", force=False).is_dir()
    write_text(tmp_path / "new" / "deep" / "a.txt", "a")
    with pytest.raises(ConfigurationError, match="holds files already; give another folder, or --force to overwrite"):
        prepare_folder(tmp_path / "new" / "deep", force=False)
    assert prepare_folder(tmp_path / "new" / "deep", force=True).is_dir()


def test_file_in_the_way_of_a_folder_is_an_output_error(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match=r"--output .*file: cannot be made: File exists; give another folder"):
        prepare_folder(tmp_path / "file", force=True)


def test_failed_write_leaves_nothing(tmp_path):
    (tmp_path / "a").mkdir()
    with pytest.raises(OutputError, match="cannot be written"):
        write_text(tmp_path / "a", "text")
    assert [path.name for path in tmp_path.iterdir()] == ["a"]


@pytest.mark.parametrize(
    ("error", "code"),
    [(ConfigurationError("c"), 2), (SimulationError("s"), 4), (OutputError("o"), 6), (KeyboardInterrupt(), 130)],
)
def test_errors_become_exit_codes(error, code, capsys):
    def fail(options: argparse.Namespace) -> str:
        raise error

    assert run_study(study_parser("x", "x"), fail, []) == code
    assert capsys.readouterr().out == ""


def test_debug_shows_the_traceback(capsys):
    def fail(options: argparse.Namespace) -> str:
        raise ConfigurationError("c")

    assert run_study(study_parser("x", "x"), fail, ["--debug"]) == 2
    assert "Traceback" in capsys.readouterr().err


def test_default_folder_is_named_after_the_study():
    assert str(study_parser("half_car_rider", "x").parse_args([]).output) == "runs/half_car_rider"
