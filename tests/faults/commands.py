"""What a case runs: a command, or a way of writing alone."""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any
from unittest import mock

from vehicle.__main__ import main
from vehicle.commands.command_line import run_command
from vehicle.runs.car import Car
from vehicle.runs.output.folder import check_files, output_folder, study_folder, whole_files, write_text
from vehicle.runs.output.written_files import note


@dataclass(frozen=True)
class Written:
    """A command that writes."""

    name: str  # name in the table
    old: Sequence[str]  # arguments that make the results of before
    new: Sequence[str]  # arguments that replace them
    # it draws frames of a film, whose threads are lost in a forked process: it runs in forked ones only
    draws: bool = False


def run_words(words: Sequence[str]) -> int:
    """Run a command, or with the word "door" only its way of writing, with small files; returns the exit code."""
    return run_command(partial(_write_only, *words[1:])) if words[0] == "door" else main(list(words))


def _write_only(kind: str, content: str, option: str = "--force") -> None:
    """Replace results by files with a content, as the commands do; the kind "renames" has no exchange in one step."""
    force, resume = option == "--force", option == "--resume"
    if kind == "renames":
        mock.patch("vehicle.runs.output.work_folder.exchange", lambda *_: False).start()
    if kind in ("file", "files"):
        paths = [Path(name) for name in ("a.csv", "b.csv", "c.csv")[: 1 if kind == "file" else 3]]
        check_files(Path(), [path.name for path in paths], force=force)
        with whole_files(paths) as temporary:
            for path in temporary:
                write_text(path, content)
        return
    rows = ("rows.jsonl",) if kind == "study" else ()
    made = (
        study_folder(Path("a"), force=force, resume=resume, rows=rows)
        if rows
        else output_folder(Path("a"), force=force)
    )
    with made as folder:
        for name in rows:
            note(folder / name)
            with (folder / name).open("a") as file:
                file.write(f"{content}\n")
        write_text(folder / "a.csv", content)
        write_text(folder / "below" / "b.csv", content)


DOOR = {
    "file": "one file",
    "files": "several files among others",
    "folder": "a folder",
    "renames": "a folder by two renames",
    "study": "a folder with finished rows",
}


def writing_alone(kind: str) -> str:
    """Return the name of a kind of `DOOR` in the table."""
    return f"only writing: {DOOR[kind]}"


def keep_cars() -> None:
    """Let commands of this process, and those forked from it, load each car once, with what was computed of it.

    Most of the time of a short run is the preparation of its car, which touches no result.
    """
    load = Car.load
    cars: dict[str, Car] = {}

    def kept(*arguments: Any, **named: Any) -> Car:
        key = repr((arguments, named))
        if key not in cars:
            cars[key] = load(*arguments, **named)
        return cars[key]

    mock.patch.object(Car, "load", kept).start()


class InProcess(Executor):
    """Executor of a sweep that computes at once, in this process."""

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        future: Future[Any] = Future()
        try:
            future.set_result(function(*arguments, **named))
        except Exception as error:
            future.set_exception(error)
        return future
