"""Cases of the fault table: a command in a forked process with one fault, and what is true afterwards."""

import ctypes
import errno
import os
import random
import re
import shutil
import signal
import sys
import time
import traceback
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

from tests.faults.commands import Written, run_words
from tests.patience import HANG
from vehicle.runs.output.work_folder import put_in_order
from vehicle.runs.output.written_files import MARKER, is_own

OPEN, WRITE, FSYNC, RENAME, UNLINK, MMAP, CLOSE, MKDIR, READ = (1 << bit for bit in range(9))
"""Kinds of system calls, as in faults.c."""

ALL = (1 << 9) - 1

TIMED = {"summary.json", "timing.csv", "rows.jsonl", "report.html"}
"""Files of results with the time that was computed; all others are the same twice, byte for byte."""

LIST = "calls.txt"
"""File of the counted calls."""


@dataclass(frozen=True)
class Fault:
    """A fault of the n-th call."""

    calls: int  # kinds of calls that are counted
    error: int  # error number; 0 kills the process
    lasting: bool = False  # all later calls fail too, as on a full disk


FAULTS = {
    "killed": Fault(ALL, 0),
    "disk full": Fault(OPEN | WRITE | FSYNC | MKDIR, errno.ENOSPC, lasting=True),
    "no space once": Fault(OPEN | WRITE | FSYNC | MKDIR | RENAME, errno.ENOSPC),
    "input/output error": Fault(ALL, errno.EIO),
    "interrupted call": Fault(OPEN | READ | WRITE | FSYNC | CLOSE, errno.EINTR),
    "no permission": Fault(OPEN | READ | MKDIR | RENAME | UNLINK, errno.EACCES),
}


@dataclass(frozen=True)
class Outcome:
    """What a case showed; `wrong` is empty if all that must hold does."""

    command: str
    fault: str
    number: int
    results: str
    code: int
    wrong: str
    said: str


def files_of(folder: Path) -> dict[str, bytes]:
    """Return the visible files of a folder and below with their content."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and not any(part.startswith(".") for part in path.relative_to(folder).parts)
    }


def hidden_in(folder: Path) -> list[str]:
    """Return the hidden files and folders except the lists of files."""
    return sorted(
        path.relative_to(folder).as_posix()
        for path in folder.rglob("*")
        if path.name.startswith(".") and path.name != MARKER
    )


def _state(path: Path, name: str) -> str:
    """Return the name of what is left, without the number of its process, with the content of a list or journal."""
    content = path.read_text(errors="replace") if path.is_file() and path.name.startswith(".vehicle-") else ""
    return re.sub(r"\.\d+\.partial", ".partial", name) + "".join(content.splitlines()[:2])


class Bench:
    """A command with its results of before and its new results, and cases of it.

    Args:
        folder: empty folder of this bench.
    """

    def __init__(self, command: Written, folder: Path) -> None:
        self.command, self.folder = command, folder
        self.before, self.case = folder / "before", folder / "case"
        self.library = ctypes.CDLL(None)
        self.before.mkdir(parents=True)
        # In this process, unless it draws: later ones need no imports, and the cars of the cases are kept.
        self._first(self.before, command.old)
        self.old = files_of(self.before)
        self._prepare()
        self._first(self.case, command.new)
        os.chdir(folder)
        references = []
        for _ in range(2):
            self._prepare()
            began = time.monotonic()
            code, said = self.run(self.case, command.new, Fault(ALL, 0), -1)
            assert code == 0, said
            self.duration = time.monotonic() - began
            self.calls = [
                (int(kind), path)
                for kind, _, path in (line.partition(" ") for line in (folder / LIST).read_text().splitlines())
            ]
            references.append(files_of(self.case))
        self.new = references[0]
        self.same = {name for name in self.new if references[1].get(name) == self.new[name]}
        assert self.new != self.old
        timed = {name for name in self.new if Path(name).name in TIMED}
        assert self.new.keys() - timed <= self.same, "results that are not the same twice"
        self.judged: dict[tuple[str, ...], list[str]] = {}

    def _first(self, folder: Path, words: Sequence[str]) -> None:
        os.chdir(folder)
        code, said = self.run(folder, words) if self.command.draws else (run_words(words), "")
        assert code == 0, said

    def numbers(self, fault: Fault) -> tuple[int, list[int]]:
        """Return the number of calls that a fault can meet, and the numbers of those to try.

        Of calls of one kind in a row for one file, the first, the middle one and the last are tried: between them, only
        the length of an unfinished file differs.
        """
        met = [call for call in self.calls if call[0] & fault.calls]
        tried: list[int] = []
        for _, group in groupby(enumerate(met, start=1), key=lambda numbered: numbered[1]):
            row = [number for number, _ in group]
            tried += sorted({row[0], row[len(row) // 2], row[-1]})
        return len(met), tried

    def outcome(self, name: str, number: int) -> Outcome:
        """Run a case with a fault, and the command again without it if something is left; judge both."""
        fault = FAULTS[name]
        self._prepare()
        code, said = self.run(self.case, self.command.new, fault, number)
        left = hidden_in(self.case)
        wrong, results = [], self._results_for_a_reader(left)
        if results == "wrong":
            wrong.append("the results are neither those of before nor the new ones")
        if "Traceback" in said or "a fault of the program" in said:
            wrong.append("traceback, or a fault of the program")
        if fault.error:
            if code not in (0, 2, 3, 6) or (code == 0 and results != "new"):
                wrong.append(f"exit code {code} with results {results}")
            if code and len(re.findall("^error: ", said, re.MULTILINE)) != 1:
                wrong.append("not one message of an error")
            if results == "mixed" and "is new already" not in said:
                wrong.append("new and earlier files, and the message does not say so")
            if "unchanged" in said and results != "old":
                wrong.append("the message says unchanged")
            if left and not re.search("next command|left|kept|again", said):
                wrong.append(f"not mentioned: {', '.join(left)}")
        wrong += self._afterwards(left, results)
        return Outcome(self.command.name, name, number, results, code, "; ".join(wrong), said[-400:] if wrong else "")

    def killed(self, number: int, chance: random.Random) -> Outcome:
        """Kill the command at a random time, every second time while another process writes to the same folder."""
        self._prepare()
        pair = number % 2 == 1
        processes = [self.start(self.case, self.command.new, f"output{i}.txt") for i in range(2 if pair else 1)]
        time.sleep(chance.uniform(0.0, 1.05 * self.duration))
        with suppress(ProcessLookupError):
            os.kill(processes[0], signal.SIGKILL)
        code, said = [self.wait(process, f"output{i}.txt") for i, process in enumerate(processes)][-1]
        left = hidden_in(self.case)
        wrong, results = [], self._results_for_a_reader(left)
        if results == "wrong":
            wrong.append("the results are neither those of before nor the new ones")
        if pair and (code not in (0, 2) or (code == 0 and results != "new") or "Traceback" in said):
            wrong.append(f"the other process: exit code {code} with results {results}")
        wrong += self._afterwards(left, results)
        name = "two processes, one killed at a random time" if pair else "killed at a random time"
        return Outcome(self.command.name, name, number, results, code, "; ".join(wrong), said[-400:] if wrong else "")

    def _afterwards(self, left: Sequence[str], results: str) -> list[str]:
        """Run the command again where something is left, once for all equal remains; returns what is wrong then."""
        silent_is_right = not hidden_in(self.case)  # `put_in_order` was called before
        if not left and results not in ("wrong", "mixed"):
            return []  # a state that was judged before
        state = (results, str(silent_is_right), *(_state(self.case / name, name) for name in left))
        if state not in self.judged:
            self.judged[state] = self._next_command(left, silent_is_right=silent_is_right)
        return self.judged[state]

    def _next_command(self, left: Sequence[str], *, silent_is_right: bool) -> list[str]:
        code, said = self.run(self.case, self.command.new)
        wrong = []
        if code or self._results() != "new":
            wrong.append(f"the next command: exit code {code}, {self._results()}: {said[-300:]}")
        if left and "notice: " not in said and not silent_is_right:
            wrong.append(f"the next command is silent about {', '.join(left)}")
        if remains := hidden_in(self.case):
            wrong.append(f"remains after the next command: {', '.join(remains)}")
        return wrong

    def _results_for_a_reader(self, left: Sequence[str]) -> str:
        """Return the results, after a kill between two renames as a command that writes finds them first."""
        if any(name.endswith(".old") for name in left):
            put_in_order(self.case / "a")
        return self._results()

    def _prepare(self) -> None:
        shutil.rmtree(self.case, ignore_errors=True)
        shutil.copytree(self.before, self.case)

    def _results(self) -> str:
        """Return "old", "new", "mixed" for files of both, each whole, or "wrong"."""
        files = files_of(self.case)
        if not all(is_own(self.case / name) for name in files):
            return "wrong"
        if files == self.old:
            return "old"
        if files.keys() == self.new.keys() and all(files[name] == self.new[name] for name in self.same):
            return "new"
        each = all(files[name] in (self.old.get(name), self.new.get(name)) for name in files.keys() & self.same)
        return "mixed" if each and self.old.keys() <= files.keys() and not (self.case / "a").is_dir() else "wrong"

    def run(self, folder: Path, words: Sequence[str], fault: Fault | None = None, number: int = 0) -> tuple[int, str]:
        """Run a command in a forked process; returns its exit code, negative for a signal, and its messages."""
        return self.wait(self.start(folder, words, "output.txt", fault, number), "output.txt")

    def start(
        self, folder: Path, words: Sequence[str], output: str, fault: Fault | None = None, number: int = 0
    ) -> int:
        """Start a command in a forked process; returns its number."""
        process = os.fork()
        if not process:
            self._child(folder, words, self.folder / output, fault, number)
        return process

    def wait(self, process: int, output: str) -> tuple[int, str]:
        """Wait for a process of `start`; returns as `run`."""
        late = time.monotonic() + HANG
        while True:
            finished, status = os.waitpid(process, os.WNOHANG)
            text = self.folder / output
            if finished:
                said = text.read_text(errors="replace") if text.exists() else ""
                return os.waitstatus_to_exitcode(status), said
            if time.monotonic() > late:
                os.kill(process, signal.SIGKILL)
                os.waitpid(process, 0)
                return 124, f"error: hangs\n{text.read_text(errors='replace')}"
            time.sleep(0.002)

    def _child(self, folder: Path, words: Sequence[str], output: Path, fault: Fault | None, number: int) -> None:
        code = 1
        try:
            os.chdir(folder)
            descriptor = os.open(output, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
            os.dup2(descriptor, 1)
            os.dup2(descriptor, 2)
            sys.stdout = open(1, "w", closefd=False)  # noqa: SIM115
            sys.stderr = open(2, "w", closefd=False, buffering=1)  # noqa: SIM115
            if fault is not None:
                error = -1 if number < 0 else fault.error
                if number < 0:
                    self.library.faults_list(os.fsencode(self.folder / LIST))
                self.library.faults_arm(os.fsencode(folder), fault.calls, ctypes.c_long(number), error, fault.lasting)
            code = run_words(words)
            self.library.faults_disarm()
            sys.stdout.flush()
        except BaseException:
            self.library.faults_disarm()
            traceback.print_exc()
        finally:
            sys.stderr.flush()
            os._exit(code)
