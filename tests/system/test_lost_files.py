"""No file is lost that a run did not write: folders, films, links, two runs at once."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

import pytest

from vehicle.errors import ConfigurationError, OutputError
from vehicle.output.destination import free_file, free_files, free_folder
from vehicle.output.folder import check_file, folder_lock, output_folder, prepare_folder, write_text, write_whole
from vehicle.output.model_files import write_mjcf
from vehicle.output.written_files import MARKER, discard, foreign, note, written

ROOT = Path(__file__).resolve().parents[2]
FILM = b"\x00\x00\x00\x20ftypisom"


def put(folder: Path, *names: str, force: bool = False) -> None:
    with output_folder(folder, force=force) as made:
        for name in names:
            write_text(made / name, name)


def test_only_what_a_run_wrote_is_replaced(tmp_path):
    run = tmp_path / "run"
    put(run, "a.csv", "b.png")
    with pytest.raises(ConfigurationError, match="exists; give --force"):
        put(run, "a.csv")
    put(run, "a.csv", force=True)
    assert {path.name for path in run.iterdir()} == {"a.csv", MARKER}
    (run / "thesis.tex").write_text("mine")
    (run / "notes").mkdir()
    (run / "notes" / "one.txt").write_text("mine")
    with pytest.raises(ConfigurationError, match=r"no run wrote: notes/one.txt, thesis.tex;"):
        put(run, "a.csv", force=True)
    assert (run / "thesis.tex").exists() and (run / "notes" / "one.txt").exists()
    assert [path.name for path in tmp_path.iterdir()] == ["run"]


def test_a_file_that_comes_during_the_run_is_kept(tmp_path):
    put(tmp_path / "run", "a.csv")
    with (
        pytest.raises(ConfigurationError, match=r"no run wrote: late\.txt"),
        output_folder(tmp_path / "run", force=True),
    ):
        (tmp_path / "run" / "late.txt").write_text("mine")
    assert (tmp_path / "run" / "late.txt").exists() and [path.name for path in tmp_path.iterdir()] == ["run"]


def test_a_folder_without_a_list_is_no_run(shaker, short_signal, tmp_path):
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "chapter.tex").write_text("mine")
    outcome = shaker("--input", "short.csv", "--output", "thesis", "--force")
    assert outcome.code == 2 and "holds files that no run wrote: chapter.tex" in outcome.err
    assert (tmp_path / "thesis" / "chapter.tex").read_text() == "mine"


def test_the_vehicle_file_beside_the_run_is_kept(shaker, short_signal, tmp_path):
    car = tmp_path / "cars" / "car.toml"
    car.parent.mkdir()
    car.write_text((ROOT / "vehicle/vehicles/focus/vehicle.toml").read_text())
    outcome = shaker("--input", "short.csv", "--vehicle", "cars/car.toml", "--output", "cars", "--force")
    assert outcome.code == 2 and "holds the input cars/car.toml" in outcome.err and car.exists()


def test_folders_of_earlier_versions_are_recognised(tmp_path):
    run = tmp_path / "run"
    run.mkdir()
    (run / "summary.json").write_text(json.dumps({"files": {"frf": "frf.csv", "video": "/elsewhere/film.mp4"}}))
    (run / "frf.csv").write_text("")
    assert set(written(run)) == {"summary.json", "frf.csv"} and foreign(run) == []
    put(run, "frf.csv", force=True)
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "summary.json").write_text("{}")
    assert foreign(tmp_path / "other") == ["summary.json"]


def test_discarding_leaves_the_files_of_others(tmp_path):
    put(tmp_path / "run", "a.csv")
    (tmp_path / "run" / f".{os.getpid()}.a.csv").write_text("what a killed process left")
    assert foreign(tmp_path / "run") == []
    (tmp_path / "run" / "mine.txt").write_text("mine")
    discard(tmp_path / "run")
    assert [path.name for path in (tmp_path / "run").iterdir()] == ["mine.txt"]


def test_studies_keep_the_same_list(tmp_path):
    folder = prepare_folder(tmp_path / "study", force=False)
    write_text(folder / "results.md", "text")
    write_text(folder / "sub" / "one.csv", "text")
    assert set(written(folder)) == {"results.md", "sub/one.csv", MARKER}
    prepare_folder(folder, force=True)
    (folder / "mine.txt").write_text("mine")
    with pytest.raises(ConfigurationError, match=r"no run wrote: mine\.txt"):
        prepare_folder(folder, force=True)


def test_a_single_file_replaces_nothing_but_what_was_written_there(tmp_path):
    film = tmp_path / "film.mp4"
    check_file(film, "--video", ending=".mp4", force=False)
    write_whole(film, lambda path: path.write_bytes(FILM))
    with pytest.raises(ConfigurationError, match=r"--video .*: exists; give --force"):
        check_file(film, "--video", force=False)
    check_file(film, "--video", force=True)
    write_whole(film, lambda path: path.write_bytes(FILM + b"again"))
    # What somebody changed is theirs; so is a film of theirs that takes the name, and one that was moved here.
    for content in (FILM + b"cut", b"a letter to my mother"):
        film.write_bytes(content)
        with pytest.raises(ConfigurationError, match="is not as this program wrote it there"):
            check_file(film, "--video", force=True)
        with pytest.raises(ConfigurationError, match="is not as this program wrote it there"):
            write_text(film, "mine")
        assert film.read_bytes() == content
    film.write_bytes(FILM)  # as it was written once
    write_text(film, "ours")
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "film.mp4").symlink_to(film)
    with pytest.raises(ConfigurationError, match="is not as this program wrote it there"):
        check_file(tmp_path / "elsewhere" / "film.mp4", force=True)


def test_files_that_were_changed_since_are_kept(tmp_path):
    put(tmp_path / "run", "a.csv", "b.csv")
    (tmp_path / "run" / "b.csv").write_text("edited by hand")
    with pytest.raises(ConfigurationError, match=r"files that were changed since a run wrote them: b\.csv; --force"):
        put(tmp_path / "run", "a.csv", force=True)
    study = prepare_folder(tmp_path / "study", force=False, rows="rows.jsonl")
    note(study / "rows.jsonl")  # grows: every content is the program's
    (study / "rows.jsonl").write_text("{}\n")
    write_text(study / "table.csv", "1")
    prepare_folder(study, force=False, resume=True, rows="rows.jsonl")
    (study / "table.csv").write_text("edited by hand")
    for ways in ({"force": False, "resume": True}, {"force": True}):
        with pytest.raises(ConfigurationError, match=r"changed since a run wrote them: table\.csv"):
            prepare_folder(study, rows="rows.jsonl", **ways)
    assert (tmp_path / "run" / "b.csv").read_text() == (study / "table.csv").read_text() == "edited by hand"


def test_the_next_free_name_and_two_runs_at_once(tmp_path):
    runs = tmp_path / "runs"
    with ExitStack() as first, ExitStack() as second:
        assert free_folder(first, runs / "low") == runs / "low"
        assert free_folder(second, runs / "low") == runs / "low-2"  # the first is being written, not there yet
        with output_folder(runs / "low", force=False):
            pass
        assert free_folder(first, runs / "low") == runs / "low-3"
        assert free_file(first, runs / "road.csv") == runs / "road.csv"
        assert free_file(second, runs / "road.csv") == runs / "road-2.csv"
        assert free_files(second, runs / "low", ["a.csv", "a.png"]) == [runs / "low/a.csv", runs / "low/a.png"]
        (runs / "low" / "a-2.png").write_text("mine")
        names = [path.name for path in free_files(first, runs / "low", ["a.csv", "a.png"])]
        assert names == ["a-3.csv", "a-3.png"]
    assert sorted(path.name for path in runs.iterdir()) == ["low"]  # no lock is left
    with ExitStack() as held:
        assert free_folder(held, runs / "low") == runs / "low-2"


def test_processes_at_once_take_names_of_their_own(tmp_path):
    work = (
        "import sys; from contextlib import ExitStack; from pathlib import Path\n"
        "from vehicle.output.destination import free_folder; from vehicle.output.folder import output_folder\n"
        "with ExitStack() as held:\n"
        "    path = free_folder(held, Path('runs/low'))\n"
        "    print('ready', flush=True); sys.stdin.readline()\n"
        "    with output_folder(path, force=False) as folder: (folder / 'a').write_text('')"
    )
    several = [
        subprocess.Popen(
            [sys.executable, "-c", work],
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            text=True,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )
        for _ in range(3)
    ]
    for one in several:
        assert one.stdout and one.stdout.readline() == "ready\n"
    for one in several:
        one.communicate("go\n")
    assert [one.returncode for one in several] == [0, 0, 0]
    assert sorted(path.name for path in (tmp_path / "runs").iterdir()) == ["low", "low-2", "low-3"]


def test_a_link_leads_to_the_folder_that_is_replaced(tmp_path):
    put(tmp_path / "real", "a.csv")
    (tmp_path / "link").symlink_to("real")
    put(tmp_path / "link", "b.csv", force=True)
    assert (tmp_path / "link").is_symlink() and (tmp_path / "real" / "b.csv").exists()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["link", "real"]
    (tmp_path / "round").symlink_to("round")
    with pytest.raises((ConfigurationError, OutputError), match=r"--output .*round"):
        put(tmp_path / "round", "a.csv", force=True)


@pytest.mark.parametrize("name", [".", "..", "/"])
def test_the_working_folder_is_no_output(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ConfigurationError, match="is the working folder, or holds it"):
        put(Path(name), "a.csv", force=True)


def test_two_runs_in_one_folder(tmp_path):
    put(tmp_path / "run", "a.csv")
    with folder_lock(tmp_path / "run"), pytest.raises(ConfigurationError, match=f"process {os.getpid()} is writing"):
        put(tmp_path / "run", "b.csv", force=True)
    # A killed process leaves its lock file and its half-written folder behind; neither stops the next run.
    killed = (
        "import os; from pathlib import Path; from vehicle.output.folder import output_folder\n"
        "with output_folder(Path('run'), force=True) as made: os.kill(os.getpid(), 9)"
    )
    subprocess.run([sys.executable, "-c", killed], cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(ROOT)})
    assert (tmp_path / ".run.lock").exists() and list(tmp_path.glob(".run.*.partial"))
    put(tmp_path / "run", "b.csv", force=True)
    assert [path.name for path in tmp_path.iterdir()] == ["run"]


def test_model_files_replace_only_model_files(tmp_path):
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "statue.stl").write_text("mine")
    with pytest.raises(ConfigurationError, match=r"meshes/statue\.stl: is not as this program wrote it there"):
        write_mjcf(tmp_path, {"car.xml": b"<mujoco/>"})
    assert (tmp_path / "meshes" / "statue.stl").exists()
