"""What a killed command leaves: results of before or new ones, whole, and a sentence of the next command."""

import os
import shutil
from functools import partial
from pathlib import Path

import pytest

from tests.faults.commands import DOOR, run_words
from tests.faults.user import KILLED, dies_at, in_fork, judged, kills
from vehicle import replacement
from vehicle.errors import ConfigurationError, OutputError
from vehicle.leftovers import REPLACED, mention
from vehicle.runs.output import work_folder
from vehicle.runs.output.folder import check_study, output_folder, study_folder, whole_files, write_text
from vehicle.runs.output.work_folder import put_in_order
from vehicle.runs.output.written_files import MARKER, note

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="a killed command is a forked process here")


def results(folder: Path, content: str) -> None:
    with output_folder(folder, force=folder.exists()) as work:
        write_text(work / "a.csv", content)
        write_text(work / "b.csv", content)


def read(folder: Path) -> list[str]:
    return [(folder / name).read_text() for name in ("a.csv", "b.csv")]


def visible(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir() if path.name != MARKER)


def killed(number: int, job, folder: Path) -> None:
    """Run a job in a process that ends before its n-th rename, exchange or removal; after it if n is negative."""
    assert in_fork(dies_at(number, job), folder.with_name("said.txt"))[0] == KILLED


@pytest.mark.parametrize("kind", DOOR)
def test_what_a_user_does_after_a_kill_is_kept(kind, tmp_path):
    """At every rename: the user edits, adds or removes a file, then the same command, another one, or a reading one."""
    before, case = tmp_path / "before", tmp_path / "case"
    before.mkdir()
    case.mkdir()

    def at(folder, *words):
        def job():
            os.chdir(folder)
            return run_words(words)

        return job

    def reads():
        for name in ("a", "a.csv", "."):
            mention(case / name)

    assert in_fork(at(before, "door", kind, "old"), tmp_path / "said.txt")[0] == 0
    new, other = at(case, "door", kind, "new"), {"study": "folder", "folder": "study"}.get(kind, kind)
    ways = [[at(case, "door", kind, "new", "")], [reads, new], [at(case, "door", other, "other")]]
    ways += [[at(case, "door", kind, "new", "--resume")]] if kind == "study" else []
    cases, wrong = judged(before, case, new, ways, new, every={"file": 7, "files": 23}.get(kind, 29))
    assert cases > 10 and not wrong


@pytest.mark.parametrize(("exchange", "number"), [(True, 1), (True, -1), (False, 1), (False, -3), (False, -4)])
def test_a_killed_exchange_leaves_results_that_a_reader_finds(exchange, number, tmp_path, capsys, monkeypatch):
    results(tmp_path / "run", "old")
    if not exchange:
        monkeypatch.setattr(work_folder, "exchange", lambda *_: False)
    killed(number, lambda: results(tmp_path / "run", "new"), tmp_path)
    names = visible(tmp_path)
    mention(tmp_path / "run")
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and "a killed command left" in said and visible(tmp_path) == names
    mention(tmp_path / "run")
    assert capsys.readouterr().err == ""
    put_in_order(tmp_path / "run")
    assert read(tmp_path / "run") == 2 * ["new" if number in (-1, -4) else "old"]
    assert visible(tmp_path) == ["run"] and "notice" in capsys.readouterr().err
    put_in_order(tmp_path / "run")
    assert capsys.readouterr().err == ""


def test_earlier_results_between_two_renames_come_back_to_a_command_that_writes(tmp_path, capsys, monkeypatch):
    """Without an exchange in one step, the name is free for a moment."""
    results(tmp_path / "run", "old")
    monkeypatch.setattr(work_folder, "exchange", lambda *_: False)
    killed(4, lambda: results(tmp_path / "run", "new"), tmp_path)
    assert visible(tmp_path) == [".run.lock", ".run.old", ".run.partial"]
    with pytest.raises(ConfigurationError, match="exists; give --force"):
        output_folder(tmp_path / "run", force=False).__enter__()
    assert read(tmp_path / "run") == ["old", "old"]
    assert "had moved the earlier results away; they were put back" in capsys.readouterr().err
    # Not over a folder that somebody has made meanwhile, and not half of them.
    killed(4, lambda: results(tmp_path / "run", "new"), tmp_path)
    (tmp_path / "run").mkdir()
    put_in_order(tmp_path / "run")
    assert visible(tmp_path / "run") == [] and read(tmp_path / "run.left") == ["old", "old"]
    (tmp_path / "run").rmdir()
    (tmp_path / "run.left").rename(tmp_path / ".run.old")
    (tmp_path / ".run.old" / "a.csv").unlink()
    put_in_order(tmp_path / "run")
    assert visible(tmp_path) == ["run.left"] and visible(tmp_path / "run.left") == ["b.csv"]


def test_a_failing_exchange_leaves_the_results_of_before(tmp_path, monkeypatch):
    results(tmp_path / "run", "old")

    def fails(*_):
        raise OSError(5, "Input/output error")

    monkeypatch.setattr(work_folder, "exchange", fails)
    with pytest.raises(OutputError, match=r"cannot be written: Input/output error; the earlier results are unchanged$"):
        results(tmp_path / "run", "new")
    assert read(tmp_path / "run") == ["old", "old"] and visible(tmp_path) == ["run"]


def test_a_folder_without_a_right_to_write_in_is_replaced(tmp_path, monkeypatch):
    """Its own names cannot change: no mark, nothing removed; the exchange needs the folder above only."""
    results(tmp_path / "run", "old")
    opened = os.open

    def refused(path, flags, *mode):
        if Path(path).name == REPLACED:
            raise PermissionError(13, "Permission denied", str(path))
        return opened(path, flags, *mode)

    with monkeypatch.context() as patch:
        patch.setattr(os, "open", refused)
        results(tmp_path / "run", "new")
    assert read(tmp_path / "run") == ["new", "new"] and visible(tmp_path) == ["run"]


def test_undeletable_old_results_are_no_error(tmp_path, monkeypatch, capsys):
    results(tmp_path / "run", "old")

    def fails(*_):
        raise OSError(5, "Input/output error")

    with monkeypatch.context() as patch:
        patch.setattr(work_folder, "discard", fails)
        results(tmp_path / "run", "new")
    assert read(tmp_path / "run") == ["new", "new"]
    assert "removes .run.old" in capsys.readouterr().err
    put_in_order(tmp_path / "run")
    assert visible(tmp_path) == ["run"] and "left .run.old; it was removed" in capsys.readouterr().err


def test_several_files_are_whole_and_the_next_reader_says_that_they_are_mixed(tmp_path, capsys):
    files = [tmp_path / "a.csv", tmp_path / "b.csv"]

    def write(content):
        with whole_files(files) as work:
            for path in work:
                write_text(path, content)

    write("old")
    killed(-1, partial(write, "new"), tmp_path)
    assert [path.read_text() for path in files] == ["new", "old"]
    mention(tmp_path)
    said = capsys.readouterr().err
    assert "a.csv: a killed command left .a.csv.partial, and of files that it wrote together " in said
    write("new")
    assert [path.read_text() for path in files] == ["new", "new"] and visible(tmp_path) == ["a.csv", "b.csv"]


ROWS = ("rows.jsonl", "plan.json")


def study(folder: Path, row: str, **ways) -> None:
    with study_folder(folder, rows=ROWS, **{"force": False, "resume": False, **ways}) as work:
        write_text(work / "plan.json", "plan")
        note(work / "rows.jsonl")
        with (work / "rows.jsonl").open("a") as file:
            file.write(f"{row}\n")
        write_text(work / "table.csv", "half")
        (work / "table.csv").replace(work / "table.csv")


def test_a_killed_study_goes_on_where_it_was(tmp_path, capsys):
    folder = tmp_path / "study"
    killed(1, partial(study, folder, "1"), tmp_path)
    assert not folder.exists()
    with pytest.raises(ConfigurationError, match=r"holds finished runs; .*--resume.*--force"):
        check_study(folder, force=False, rows=ROWS)
    for ways in ({}, {"resume": True}):
        with pytest.raises(ConfigurationError, match=r"holds rows\.jsonl of another killed command"):
            check_study(folder, force=False, rows=("cars.csv",), **ways)
    with pytest.raises(ConfigurationError, match="a killed command left finished rows there"):
        results(folder, "of another command")
    mention(folder)
    assert "left finished rows in .study.partial/rows.jsonl; continue with --resume" in capsys.readouterr().err
    study(folder, "2", resume=True)
    assert (folder / "rows.jsonl").read_text() == "1\n2\n" and visible(tmp_path) == ["study"]
    # A killed --force: the old results stay, and --resume continues the new ones.
    (folder / "notes.txt").write_text("mine")
    killed(5, partial(study, folder, "3", resume=True), tmp_path)  # after both copies
    assert (folder / "rows.jsonl").read_text() == "1\n2\n"
    study(folder, "4", resume=True)
    assert (folder / "rows.jsonl").read_text() == "1\n2\n3\n4\n" and (folder / "notes.txt").read_text() == "mine"
    (folder / "notes.txt").unlink()
    killed(1, partial(study, folder, "new", force=True), tmp_path)
    assert (folder / "rows.jsonl").read_text() == "1\n2\n3\n4\n"
    study(folder, "5", resume=True)
    assert (folder / "rows.jsonl").read_text() == "new\n5\n" and visible(tmp_path) == ["study"]
    # --force says how many rows it deletes: those of a killed command, and those of the folder.
    killed(1, partial(study, folder, "6", force=True), tmp_path)
    capsys.readouterr()
    study(folder, "7", force=True)
    said = capsys.readouterr().err
    assert ".study.partial with 1 finished rows; it was removed" in said and "2 finished rows of the earlier" in said


def test_rows_that_a_killed_force_has_replaced_are_not_continued(tmp_path, capsys):
    """Between the exchange and the next rename, the earlier rows have the name of unfinished ones."""
    folder = tmp_path / "study"
    study(folder, "1\n2")
    # Calls: replaced files of the new folder, its exchange.
    for number in range(1, 9):
        killed(-number, partial(study, folder, "new", force=True), tmp_path)
        if (folder / "rows.jsonl").read_text() == "new\n":
            break
    assert (tmp_path / ".study.partial" / "rows.jsonl").read_text() == "1\n2\n"
    mention(folder)
    assert "left .study.partial; the next command" in capsys.readouterr().err
    study(folder, "3", resume=True)
    assert (folder / "rows.jsonl").read_text() == "new\n3\n" and visible(tmp_path) == ["study"]
    assert "left .study.old with 2 finished rows; it was removed" in capsys.readouterr().err


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


def test_rows_with_several_names_are_continued_and_a_link_is_refused(tmp_path):
    """A backup of hard links, `cp -al`, gives each file a second name, which must not change."""
    folder, backup = tmp_path / "study", tmp_path / "backup.jsonl"
    study(folder, "1")
    backup.hardlink_to(folder / "rows.jsonl")
    study(folder, "2", resume=True)
    assert (folder / "rows.jsonl").read_text() == "1\n2\n" and backup.read_text() == "1\n"
    killed(1, partial(study, folder, "new", force=True), tmp_path)
    (tmp_path / "second.jsonl").hardlink_to(tmp_path / ".study.partial" / "rows.jsonl")
    study(folder, "3", resume=True)
    assert (folder / "rows.jsonl").read_text() == "new\n3\n" and (tmp_path / "second.jsonl").read_text() == "new\n"
    (folder / "rows.jsonl").unlink()
    (folder / "rows.jsonl").symlink_to(backup)
    with pytest.raises(ConfigurationError, match=r"rows.jsonl: is a link, or no file, .* put a copy there$|edited"):
        study(folder, "4", resume=True)
    assert visible(tmp_path) == ["backup.jsonl", "second.jsonl", "study"]


def test_a_kill_of_a_resume_loses_no_row(tmp_path, monkeypatch):
    """In the copy of the rows, and at every rename, exchange or removal."""
    folder, rows = tmp_path / "before" / "study", "".join(f"{row}\n" for row in range(5))
    folder.parent.mkdir()

    def halfway(old, new):
        new.write(old.read(4))
        new.flush()
        os._exit(KILLED)

    study(folder, "0\n1\n2\n3\n4")
    with monkeypatch.context() as patch:
        patch.setattr(shutil, "copyfileobj", halfway)
        assert in_fork(partial(study, folder, "5", resume=True), tmp_path / "said.txt")[0] == KILLED
    study(folder, "5", resume=True)
    assert (folder / "rows.jsonl").read_text() == f"{rows}5\n"
    case, found = tmp_path / "case" / "study", set()
    for _ in kills(folder.parent, case.parent, partial(study, case, "6", resume=True)):
        study(case, "7", resume=True)
        found.add((case / "rows.jsonl").read_text())
        assert visible(case.parent) == ["study"]
    assert found == {f"{rows}5\n7\n", f"{rows}5\n6\n7\n"}
