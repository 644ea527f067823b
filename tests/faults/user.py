"""A command is killed at a rename or removal, a user changes a file, other commands follow: what must be true then."""

import os
import re
import shutil
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from unittest import mock

from tests.faults.cases import hidden_in
from vehicle.leftovers import FINISHED_ROWS, REPLACED
from vehicle.runs.output import work_folder
from vehicle.runs.output.written_files import MARKER

MINE = b"mine\n"
"""Content that the user gives to a file."""

KILLED = 137
"""Exit code of a process that ends as a killed one."""

Job = Callable[[], object]


def in_fork(job: Job, said: Path) -> tuple[int, str]:
    """Run a job in a forked process; return its exit code, and what it printed on standard error."""
    process = os.fork()
    if not process:
        code = 1
        try:
            os.dup2(os.open(said, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), 2)
            os.dup2(2, 1)
            sys.stdout = sys.stderr = open(2, "w", closefd=False, buffering=1)  # noqa: SIM115
            code = int(job() or 0)  # type: ignore[call-overload]
        except BaseException:
            traceback.print_exc()
        finally:
            sys.stderr.flush()
            os._exit(code)
    code = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
    return code, said.read_text(errors="replace")


def dies_at(number: int, job: Job) -> Job:
    """Return the job, which ends as by a kill before its n-th rename, exchange or removal, or after it if n < 0."""

    def dying() -> object:
        calls = 0

        def counted(real: Callable[..., object]) -> Callable[..., object]:
            def call(*arguments: object, **named: object) -> object:
                nonlocal calls
                calls += 1
                if calls == number:
                    os._exit(KILLED)
                try:
                    return real(*arguments, **named)
                finally:
                    if calls == -number:
                        os._exit(KILLED)

            return call

        for name in ("rename", "replace", "unlink", "rmdir"):
            mock.patch.object(os, name, counted(getattr(os, name))).start()
        mock.patch.object(work_folder, "exchange", counted(vars(work_folder)["exchange"])).start()
        return job()

    return dying


def kills(before: Path, case: Path, job: Job, step: int = 1) -> Iterator[int]:
    """Yield the numbers of each `step`-th kill of a job; the state after each is in the folder of the case."""
    for number in range(1, 1000, step):
        for sign in (1, -1):
            shutil.rmtree(case, ignore_errors=True)
            shutil.copytree(before, case, symlinks=True)
            if in_fork(dies_at(sign * number, job), case.with_name("said.txt"))[0] != KILLED:
                return
            yield sign * number


def faults(name: str, path: Path, case: Path, runs: Sequence[tuple[int, str]]) -> list[str]:
    """Return what is wrong after the commands that followed the change of a user.

    Args:
        name: see `changes`.
        case: folder of the case.
        runs: exit code and messages of each command.
    """
    said = "".join(text for _, text in runs)
    wrong = [f"exit code {code}" for code, text in runs if code not in (0, 2, 3)]
    wrong += ["traceback"] if "Traceback" in said or "a fault of the program" in said else []
    if name == "remove":
        return wrong
    found = [each for each in case.rglob("*") if each.is_file() and MINE in each.read_bytes()]
    moved = [each for each in found if each.relative_to(case).parts[0] in said]
    grows = path.name in FINISHED_ROWS and "finished rows" in said  # is the program's, and the message counts the rows
    if not grows and path not in found and not (moved and any(part[0] == "." for part in path.relative_to(case).parts)):
        wrong.append(f"{name} of {path.relative_to(case)} is lost, or was moved without a sentence")
    return wrong


def judged(
    before: Path, case: Path, job: Job, ways: Sequence[Sequence[Job]], last: Job, *, every: int = 1, step: int = 1
) -> tuple[int, list[str]]:
    """Kill a job at every call, change a file, run other jobs after it; return the number of cases, and what is wrong.

    Args:
        before: folder with the results of before.
        case: folder of the case, the working folder of the jobs.
        job: command that is killed.
        ways: commands that follow, each way from the same state.
        last: command that must work when the user has moved what is theirs.
        every: only each n-th case is tried.
        step: only each n-th call is killed.
    """
    state, said = case.with_name("state"), case.with_name("said.txt")
    wrong, cases = [], 0
    for number in kills(before, case, job, step):
        shutil.rmtree(state, ignore_errors=True)
        shutil.copytree(case, state, symlinks=True)
        for name, path in list(_named(state, case)):
            for way, jobs in enumerate(ways):
                cases += 1
                if cases % every:
                    continue
                shutil.rmtree(case)
                shutil.copytree(state, case, symlinks=True)
                _change(name, path)
                runs = [in_fork(each, said) for each in jobs]
                texts = faults(name, path, case, runs)
                _take_away(case)
                code, text = in_fork(last, said)
                texts += [f"the last command: exit code {code}: {text[-300:]}"] if code else []
                texts += [f"left: {', '.join(left)}"] if (left := hidden_in(case)) else []
                wrong += [f"kill {number}, {name} {path.relative_to(case)}, way {way}: {text}" for text in texts]
    return cases // every, wrong


def _named(state: Path, case: Path) -> Iterator[tuple[str, Path]]:
    """Yield what a user may do after a kill: edit, add or remove a file."""
    everything = sorted(state.rglob("*"))
    own = re.compile(rf"\.lock$|\.\d+\.partial|^({re.escape(MARKER)}|{re.escape(REPLACED)})$")
    files = [path for path in everything if path.is_file() and not own.search(path.name)]
    folders = [state, *(path for path in everything if path.is_dir())]
    for path in files:
        yield "edit", case / path.relative_to(state)
        yield "remove", case / path.relative_to(state)
    for path in folders:
        yield "add", case / path.relative_to(state) / "mine.txt"


def _change(name: str, path: Path) -> None:
    if name == "remove":
        path.unlink()
    else:
        with path.open("ab") as file:
            file.write(MINE)


def _take_away(case: Path) -> None:
    """Remove the files of the user, as somebody does who follows the message."""
    for path in list(case.rglob("*")):
        with suppress(FileNotFoundError):
            if path.is_file() and MINE in path.read_bytes():
                path.unlink()
