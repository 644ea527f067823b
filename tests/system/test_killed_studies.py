"""A run, a sweep and a search are killed at a rename, a user changes a file, commands follow: a sample of all cases."""

import os

import pytest

from tests.faults.commands import run_words
from tests.faults.jobs import signal_file
from tests.faults.user import in_fork, judged
from vehicle.leftovers import mention

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="a killed command is a forked process here")

COMMON = ("--engine", "reduced", "--output", "a", "--quiet")
COMMANDS = {
    "shaker": ("shaker", *COMMON, "--no-figures"),
    "sweep": ("sweep", *COMMON, "--vary", "damper.coulomb_friction=50,100",
              "--executor", "tests.faults.commands:InProcess"),
    "optimise": ("optimise", *COMMON, "--vary", "damper.coulomb_friction=50:100", "--minimise", "weighted",
                 "--cars", "8", "--population", "8"),
}  # fmt: skip
OTHER = {"shaker": "sweep", "sweep": "shaker", "optimise": "sweep"}
"""Another command with the same output."""


@pytest.mark.parametrize(("name", "every", "step"), [("shaker", 83, 5), ("sweep", 79, 6), ("optimise", 89, 7)])
def test_what_a_user_does_after_a_kill_is_kept(name, every, step, tmp_path, monkeypatch):
    first, second = signal_file(tmp_path / "first.csv", 3.0), signal_file(tmp_path / "second.csv", 4.0)
    before, case = tmp_path / "before", tmp_path / "case"
    for folder in (before, case):
        folder.mkdir()

    def at(folder, command, *more, file=second):
        def job():
            os.chdir(folder)
            return run_words([*COMMANDS[command], "--input", str(file), *more])

        return job

    def reads():
        for path in ("a", "a/rows.jsonl", "."):
            mention(case / path)

    monkeypatch.chdir(tmp_path)
    assert run_words([*COMMANDS[name], "--input", str(first), "--force"]) == 0  # once, not in each fork
    assert in_fork(at(before, name, file=first), tmp_path / "said.txt")[0] == 0
    new = at(case, name, "--force")
    ways = [[at(case, name)], [reads, new], [at(case, OTHER[name])]]
    ways += [[at(case, name, "--resume")]] if name != "shaker" else []
    cases, wrong = judged(before, case, new, ways, new, every=every, step=step)
    assert cases >= 2 and not wrong
