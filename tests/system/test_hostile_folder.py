"""Nothing in a folder is obeyed: journals, lists, links and rows that somebody has put beside the results of a user."""

import itertools
import os
import shutil
import stat
from pathlib import Path

import pytest

from tests.faults.commands import run_words
from tests.system.conftest import write_short
from vehicle import Car, Run
from vehicle.__main__ import main
from vehicle.commands.command_line import FAULT
from vehicle.errors import ConfigurationError, OutputError
from vehicle.leftovers import FINISHED_ROWS, REPLACED
from vehicle.runs.output.folder import output_folder, study_folder, write_text, write_together
from vehicle.runs.output.locks import folder_lock
from vehicle.runs.output.model_files import write_mjcf
from vehicle.runs.output.written_files import MARKER
from vehicle.studies.optimisation.car_table import CARS
from vehicle.studies.sweeps.store import ROWS

pytestmark = pytest.mark.skipif(os.name == "nt", reason="links need a right under Windows")

JOURNALS = (".vehicle-complete", ".vehicle-unfinished", REPLACED, MARKER)
TEXTS = {
    "empty": b"",
    "torn": b"fol",
    "zeros": b"\0" * 512,
    "of files": b"files\n\n",
    "of a folder": b"folder\n\n",
    "with rows": b"folder\nrows.jsonl\n",
    "foreign": b"folder\n../../victim/rows.jsonl\n",
    "bytes": bytes(range(256)) * 20,
    "long": b"a" * 300_000,
    "a list": b"rows.jsonl\n../victim/letter.txt\nlink/letter.txt\nletter.txt\n/etc/hosts\n",
}
KINDS = ("file", "link", "link to nothing", "second name", "folder", "pipe")


def tree(folder: Path) -> dict[str, object]:
    """Return every name in a folder and below with its type, and with its content or target; links are not followed."""
    found: dict[str, object] = {}
    for path in sorted(folder.rglob("*")):
        mode = path.lstat().st_mode
        content: object = path.readlink() if stat.S_ISLNK(mode) else path.read_bytes() if stat.S_ISREG(mode) else ""
        found[path.relative_to(folder).as_posix()] = (stat.S_IFMT(mode), content)
    return found


def victim_of(folder: Path) -> Path:
    victim = folder / "victim"
    victim.mkdir()
    (victim / "letter.txt").write_text("mine")
    (victim / "rows.jsonl").write_text("mine\n")
    return victim


def put(path: Path, kind: str, content: bytes, victim: Path) -> None:
    """Put a journal into a folder: a file, a link, a folder, a pipe."""
    if kind in ("link", "second name"):
        target = victim / "letter.txt"
        path.symlink_to(target) if kind == "link" else path.hardlink_to(target)
    elif kind == "link to nothing":
        path.symlink_to(victim / "new.txt")
    elif kind == "folder":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)
    else:
        path.write_bytes(content)


HIDDEN = [
    *((f".o.partial/{name}", "file", text) for name, text in itertools.product(JOURNALS, TEXTS)),
    *((f"{folder}/{name}", kind, "") for folder, name, kind in itertools.product((".o.partial", "o"), JOURNALS, KINDS)),
    *((f"o/{JOURNALS[0]}", "file", text) for text in TEXTS),
    *((name, kind, "torn") for name, kind in itertools.product((".o.partial", ".o.old", ".o.lock"), KINDS)),
]


@pytest.mark.parametrize(("name", "kind", "text"), HIDDEN, ids=lambda part: str(part) or "-")
def test_what_lies_beside_results_is_not_obeyed_and_rows_are_kept(name, kind, text, tmp_path, monkeypatch, capsys):
    """Damaged, empty, torn, foreign and linked journals: one sentence, rows kept, nothing moved, nothing crashes."""
    home, victim = tmp_path / "home", victim_of(tmp_path)
    (home / name).parent.mkdir(parents=True)
    (home / "o").mkdir(exist_ok=name.startswith("o/"))
    if name != ".o.partial":
        (home / ".o.partial").mkdir(exist_ok=True)
        (home / ".o.partial" / "rows.jsonl").write_text("1\n2\n")
        (home / ".o.partial" / "link").symlink_to(victim)
    put(home / name, kind, TEXTS.get(text, b""), victim)
    outside, before = tree(victim), tree(home)
    monkeypatch.chdir(home)
    assert main(["inspect", "o"]) == 2 and tree(home) == before
    capsys.readouterr()
    for option in ("", "--resume", "--force"):
        code = run_words(["door", "study", "3", option])
        said = capsys.readouterr().err
        assert tree(victim) == outside
        assert code in (0, 2, 6) and said.count("error: ") == bool(code), said
        assert "Traceback" not in said and FAULT not in said and said.count("notice: ") <= 3
        kept = [path for path in home.rglob("rows.jsonl") if path.read_text().startswith("1\n2\n")]
        assert kept or name == ".o.partial" or (option == "--force" and "finished rows" in said)


def test_rows_that_are_links_are_not_continued(tmp_path, capsys):
    victim = victim_of(tmp_path)
    outside = tree(victim)
    assert {*FINISHED_ROWS} == {ROWS, CARS}
    for link in (tmp_path / ".study.partial" / ROWS, tmp_path / "study" / ROWS):
        link.parent.mkdir()
        link.symlink_to(victim / "rows.jsonl")
    with pytest.raises(ConfigurationError, match=r"rows\.jsonl: is a link, or no file, so --resume cannot continue it"):
        study_folder(tmp_path / "study", force=False, resume=True, rows=(ROWS,)).__enter__()
    (tmp_path / "study" / ROWS).unlink()
    with study_folder(tmp_path / "study", force=False, resume=True, rows=(ROWS,)) as work:
        assert not (work / ROWS).exists()
    assert tree(victim) == outside and ".study.partial does not" in capsys.readouterr().err


def test_nothing_is_written_through_a_link_below_the_output(tmp_path):
    victim, out = victim_of(tmp_path), tmp_path / "out"
    outside = tree(victim)
    out.mkdir()
    (out / "meshes").symlink_to(victim)
    with pytest.raises(ConfigurationError, match="meshes: is a link"):
        write_mjcf(out, {"car.xml": b"<mujoco/>", "meshes/letter.stl": b"1"})
    (out / "templates").symlink_to(victim)
    with pytest.raises(ConfigurationError, match="templates: is a link"):
        write_together([out / "car.toml", out / "templates" / "a.toml"], ["a", "b"])
    (out / MARKER).unlink()
    (out / MARKER).symlink_to(victim / "letter.txt")
    with pytest.raises(OutputError, match=f"{MARKER}: must be a file, not a link"):
        write_text(out / "a.csv", "1")
    with pytest.raises((ConfigurationError, OutputError)), output_folder(out, force=True) as work:
        write_text(work / "a.csv", "1")
    assert tree(victim) == outside


def test_without_locks_of_the_file_system_a_second_command_refuses(tmp_path, monkeypatch):
    """The second command deleted the folder in which the first one wrote."""

    def missing(*_):
        raise OSError(38, "Function not implemented")

    monkeypatch.setattr("fcntl.flock", missing)
    with output_folder(tmp_path / "run", force=False) as work:
        write_text(work / "a.csv", "1")
        with pytest.raises(ConfigurationError, match=r"if it has ended, remove \.run\.lock"):
            output_folder(tmp_path / "run", force=True).__enter__()
        assert (work / "a.csv").read_text() == "1"
    assert (tmp_path / "run" / "a.csv").read_text() == "1" and not (tmp_path / ".run.lock").exists()
    (tmp_path / ".run.lock").write_text("999999\n")
    with (
        pytest.raises(ConfigurationError, match="process 999999 is writing there; if it has ended"),
        folder_lock(tmp_path / "run"),
    ):
        pass
    assert (tmp_path / ".run.lock").exists()


RUN = ("shaker", "--engine", "reduced", "--no-figures", "--channels", "loads", "--quiet")


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A folder with a signal and a run of it."""
    folder = tmp_path_factory.mktemp("finished")
    write_short(folder / "short.csv")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        assert main([*RUN, "--input", "short.csv", "--output", "runs/low"]) == 0
    return folder


@pytest.fixture
def beside(tmp_path, finished, monkeypatch):
    """A run of the user, with an archive unpacked beside it and in its folder: journals, links, lists, rows."""
    monkeypatch.chdir(tmp_path)
    shutil.copytree(finished, tmp_path, dirs_exist_ok=True)
    victim = victim_of(tmp_path)
    (tmp_path / "notes.txt").write_text("mine")
    for folder in (tmp_path, tmp_path / "runs", tmp_path / "runs" / "low"):
        for name in ("x", "low", "time.npz", "summary.json", "notes.txt", "short.csv", "sweep", "vehicle.toml"):
            work = folder / f".{name}.partial"
            work.mkdir()
            (work / JOURNALS[0]).write_text("files\n\n")
            (work / MARKER).write_text("notes.txt\nsummary.json\n../notes.txt\nlink/letter.txt\n")
            (work / "notes.txt").write_text("evil")
            (work / "summary.json").write_text("{}")
            (work / "link").symlink_to(victim)
            (folder / f".{name}.old").symlink_to(victim)
        (folder / ".y.partial").symlink_to(victim)
        (folder / ".z.partial").mkdir()
        (folder / ".z.partial" / "rows.jsonl").write_text("[" * 3000)
    return tmp_path


READING = [
    ("show", "runs/low/vehicle.toml"),
    ("inspect", "runs/low/time.npz"),
    ("inspect", "short.csv"),
    ("loads", "runs/low"),
    ("spectra", "runs/low"),
    ("modes", "--vehicle", "runs/low/vehicle.toml"),
    ("report", "runs/low"),
    (
        "compare",
        "runs/low",
        "--measured",
        "runs/low/time.npz",
        "--map",
        "seat_rail_acc_z=seat_rail_acc_z",
        "--no-figures",
    ),
    ("comfort", "--input", "runs/low/time.npz", "--channel", "seat_rail"),
    ("kinematics", "--vehicle", "runs/low/vehicle.toml", "--axle", "front", "--travel", "0:10:10"),
]
"""Commands that read; those that write too are given an --output elsewhere."""


@pytest.mark.parametrize("words", READING, ids=" ".join)
def test_a_command_that_reads_changes_nothing_outside_its_output(words, beside, capsys):
    output = {"report": "out/report.html"}.get(words[0], "out")
    more = [] if words[0] in ("show", "inspect", "modes", "comfort") else ["--output", output]
    before = tree(beside)
    code = main([*words, *more])
    after = {name: found for name, found in tree(beside).items() if Path(name).parts[0] != "out"}
    assert after == before
    said = capsys.readouterr().err
    assert code == 0 and "a killed command left" in said and "Traceback" not in said, said


def test_reading_in_python_changes_nothing(beside, capsys):
    before = tree(beside)
    run, car = Run.load("runs/low"), Car.load("runs/low/vehicle.toml")
    assert run.time.size and car.vehicle.name and tree(beside) == before
    said = capsys.readouterr().err.splitlines()
    assert len(said) == len(set(said)) and all("a killed command left" in line for line in said) and said


WRITING = [
    (*RUN, "--input", "short.csv", "--output", "runs/low", "--force"),
    ("mjcf", "--output", "runs/low", "--force"),
    ("loads", "runs/low", "--output", "runs/low", "--force"),
    ("new", "x", "--from", "sedan", "--kerb-mass", "1450", "--wheelbase", "2.65", "--front-axle-load", "800"),
    ("sweep", "--vary", "damper.viscous=2000", "--engine", "reduced", "--input", "short.csv", "--skip", "0.5",
     "--executor", "tests.faults.commands:InProcess", "--output", "runs/sweep", "--resume"),
]  # fmt: skip


@pytest.mark.parametrize("words", WRITING, ids=lambda words: words[0])
def test_a_command_that_writes_changes_nothing_of_other_folders(words, beside, capsys):
    before = tree(beside)
    output = words[words.index("--output") + 1] if "--output" in words else words[1]
    code = main(list(words))
    said = capsys.readouterr().err
    assert code in (0, 2) and "Traceback" not in said, said

    def others(found: dict[str, object]) -> dict[str, object]:
        name = Path(output).name
        own = (output, f"{Path(output).parent / name}.left", str(Path(output).with_name(f".{name}.")))
        return {path: content for path, content in found.items() if not path.startswith(own)}

    assert others(tree(beside)) == others(before)
    assert (beside / "notes.txt").read_text() == "mine"
