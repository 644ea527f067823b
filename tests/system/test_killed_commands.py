"""What a killed command leaves: results of before or new ones, whole, and a sentence of the next command."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from vehicle import replacement
from vehicle.errors import ConfigurationError, OutputError
from vehicle.runs.output import work_folder
from vehicle.runs.output.folder import check_study, output_folder, study_folder, whole_files, write_text
from vehicle.runs.output.work_folder import put_in_order
from vehicle.runs.output.written_files import MARKER, note

ROOT = Path(__file__).resolve().parents[2]
HEAD = """
import os, signal
from pathlib import Path
from vehicle.runs.output import work_folder
from vehicle.runs.output.folder import output_folder, study_folder, whole_files, write_text
from vehicle.runs.output.written_files import note

def kill(*arguments, **named):
    os.kill(os.getpid(), signal.SIGKILL)
"""


def killed(folder: Path, text: str) -> None:
    """Run a Python program that kills itself."""
    process = subprocess.run(
        [sys.executable, "-c", HEAD + text],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
    )
    assert process.returncode == -9, process.stderr


def results(folder: Path, content: str) -> None:
    with output_folder(folder, force=folder.exists()) as work:
        write_text(work / "a.csv", content)
        write_text(work / "b.csv", content)


def read(folder: Path) -> list[str]:
    return [(folder / name).read_text() for name in ("a.csv", "b.csv")]


def visible(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir() if path.name != MARKER)


@pytest.mark.parametrize(
    ("killer", "content", "said"),
    [
        ("work_folder.synchronise_folder", "old", "left unfinished results; they were removed"),
        ("work_folder._put_in_place", "new", "the complete results of a killed command were put in place"),
        ("work_folder._retire", "new", "the complete results of a killed command were put in place"),
        ("work_folder.discard", "new", "the complete results of a killed command were put in place"),
    ],
)
@pytest.mark.parametrize("exchange", [True, False])
def test_a_killed_exchange_is_brought_to_its_end(killer, content, said, exchange, tmp_path, capsys):
    results(tmp_path / "run", "old")
    without = "" if exchange else "work_folder.exchange = lambda *_: False\n"
    killed(
        tmp_path,
        f"{without}{killer} = kill\n"
        "with output_folder(Path('run'), force=True) as work:\n"
        "    write_text(work / 'a.csv', 'new'); write_text(work / 'b.csv', 'new')\n",
    )
    put_in_order(tmp_path / "run")
    assert (
        capsys.readouterr().err
        == f"notice: {tmp_path / 'run'}: {'a killed command ' if content == 'old' else ''}{said}\n"
    )
    assert read(tmp_path / "run") == [content, content] and visible(tmp_path) == ["run"]
    put_in_order(tmp_path / "run")
    assert capsys.readouterr().err == ""


def test_results_between_two_renames_come_back(tmp_path, capsys, monkeypatch):
    """Without an exchange in one step, the old name is free for a moment."""
    results(tmp_path / "run", "old")
    killed(
        tmp_path,
        "work_folder.exchange = lambda *_: False\nrename = Path.rename\n"
        "def renamed(path, target):\n    rename(path, target)\n    if str(target).endswith('.old'): kill()\n"
        "Path.rename = renamed\n"
        "with output_folder(Path('run'), force=True) as work:\n    write_text(work / 'a.csv', 'new')\n",
    )
    assert visible(tmp_path) == [".run.lock", ".run.old", ".run.partial"]
    with pytest.raises(ConfigurationError, match="exists; give --force"):
        results_again = output_folder(tmp_path / "run", force=False)
        results_again.__enter__()
    assert (tmp_path / "run" / "a.csv").read_text() == "new" and visible(tmp_path) == ["run"]
    assert "the complete results of a killed command were put in place" in capsys.readouterr().err


def test_a_failing_exchange_leaves_the_results_of_before(tmp_path, monkeypatch):
    results(tmp_path / "run", "old")

    def fails(*_):
        raise OSError(5, "Input/output error")

    monkeypatch.setattr(work_folder, "exchange", fails)
    with pytest.raises(OutputError, match=r"cannot be written: Input/output error; the earlier results are unchanged$"):
        results(tmp_path / "run", "new")
    assert read(tmp_path / "run") == ["old", "old"] and visible(tmp_path) == ["run"]


def test_undeletable_old_results_are_no_error(tmp_path, monkeypatch, capsys):
    results(tmp_path / "run", "old")

    def fails(*_):
        raise OSError(5, "Input/output error")

    with monkeypatch.context() as patch:
        patch.setattr(work_folder, "discard", fails)
        results(tmp_path / "run", "new")
    assert read(tmp_path / "run") == ["new", "new"]
    assert "is complete; files of the earlier results remain" in capsys.readouterr().err
    put_in_order(tmp_path / "run")
    assert visible(tmp_path) == ["run"] and "were put in place" in capsys.readouterr().err


@pytest.mark.parametrize("touched", [0, 1, 2])
def test_several_files_are_all_new_or_all_old(touched, tmp_path, capsys):
    """The next command that touches one of the files, or their folder, moves all of them."""
    files = [tmp_path / "a.csv", tmp_path / "b.csv"]
    with whole_files(files) as work:
        for path in work:
            write_text(path, "old")
    program = (
        "replace, moved = Path.replace, []\n"
        "def replaced(path, target):\n"
        "    if Path(target).suffix == '.csv' and moved: kill()\n"
        "    moved.append(target) if Path(target).suffix == '.csv' else None\n    return replace(path, target)\n"
        "Path.replace = replaced\n"
        "with whole_files([Path('a.csv').absolute(), Path('b.csv').absolute()]) as work:\n"
        "    for path in work: write_text(path, 'new')\n"
    )
    killed(tmp_path, program)
    assert [path.read_text() for path in files] == ["new", "old"]
    put_in_order(files[touched] if touched < 2 else tmp_path)
    assert [path.read_text() for path in files] == ["new", "new"] and visible(tmp_path) == ["a.csv", "b.csv"]
    assert "were put in place" in capsys.readouterr().err


ROWS = ("rows.jsonl", "plan.json")
STUDY = (
    "with study_folder(Path('study'), force={force}, resume={resume}, rows=('rows.jsonl', 'plan.json')) as work:\n"
    "    write_text(work / 'plan.json', 'plan'); note(work / 'rows.jsonl')\n"
    "    with (work / 'rows.jsonl').open('a') as file: file.write('{row}\\n')\n"
    "    write_text(work / 'table.csv', 'half')\n    kill()\n"
)


def test_a_killed_study_goes_on_where_it_was(tmp_path, capsys):
    killed(tmp_path, STUDY.format(force=False, resume=False, row=1))
    folder = tmp_path / "study"
    assert not folder.exists()
    with pytest.raises(
        ConfigurationError, match="holds finished runs; continue them with --resume, or start again with --force"
    ):
        check_study(folder, force=False, rows=ROWS)
    assert (
        "a killed command left finished rows in .study.partial/rows.jsonl; continue with --resume"
    ) in capsys.readouterr().err
    with pytest.raises(ConfigurationError, match="a killed command left finished rows there"):
        results(folder, "of another command")
    with study_folder(folder, force=False, resume=True, rows=ROWS) as work:
        assert visible(work) == [".vehicle-unfinished", "plan.json", "rows.jsonl"]
        assert (work / "rows.jsonl").read_text() == "1\n"
        with (work / "rows.jsonl").open("a") as file:
            file.write("2\n")
    assert (folder / "rows.jsonl").read_text() == "1\n2\n" and visible(tmp_path) == ["study"]
    # A killed --force: the old results stay, and --resume continues the new ones.
    (folder / "notes.txt").write_text("mine")
    killed(tmp_path, STUDY.format(force=False, resume=True, row=3))
    assert (folder / "rows.jsonl").read_text() == "1\n2\n"
    with study_folder(folder, force=False, resume=True, rows=ROWS) as work:
        assert (work / "rows.jsonl").read_text() == "1\n2\n3\n"
    assert visible(folder) == ["notes.txt", "plan.json", "rows.jsonl"] and (folder / "notes.txt").read_text() == "mine"
    (folder / "notes.txt").unlink()
    killed(tmp_path, STUDY.format(force=True, resume=False, row="new"))
    assert (folder / "rows.jsonl").read_text() == "1\n2\n3\n"
    with study_folder(folder, force=False, resume=True, rows=ROWS) as work:
        assert (work / "rows.jsonl").read_text() == "new\n"
    assert (folder / "rows.jsonl").read_text() == "new\n" and visible(tmp_path) == ["study"]


def test_half_a_line_of_a_list_ends_before_the_next(tmp_path):
    write_text(tmp_path / "a.csv", "a")
    with (tmp_path / MARKER).open("a") as file:
        file.write("0123456")
    note(tmp_path / "b.csv")
    lines = (tmp_path / MARKER).read_text().splitlines()
    assert lines[-2:] == ["0123456", "b.csv"]


def test_the_exchange_of_the_system(tmp_path):
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        (tmp_path / name / name).write_text("")
    if replacement.exchange(tmp_path / "a", tmp_path / "b"):
        assert (tmp_path / "a" / "b").exists() and (tmp_path / "b" / "a").exists()
        with pytest.raises(FileNotFoundError):
            replacement.exchange(tmp_path / "a", tmp_path / "missing")
    else:
        assert (tmp_path / "a" / "a").exists()
