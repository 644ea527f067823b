"""`python -m vehicle`: the list, the same command under both of its names, the same options everywhere."""

import argparse
import json
import re
import sys
from importlib import import_module
from pathlib import Path

import pytest

from scenarios.comfort_sensitivity.__main__ import main as comfort_sensitivity
from scenarios.study import study_parser
from tests.patience import process
from vehicle.__main__ import main
from vehicle.commands import COMMANDS, OLDER, module_of

ROOT = Path(__file__).resolve().parents[2]


def parsers() -> dict[str, argparse.ArgumentParser]:
    """Every command of the package, a study, and the study with options of its own."""
    found = {name: import_module(module_of(name)).parser() for name in COMMANDS}
    study = study_parser("levels", quick="short")
    return {**found, "study": study, "comfort_sensitivity": comfort_sensitivity.parser}


def test_the_list_has_a_line_for_each_command(capsys):
    for arguments in ([], ["--help"]):
        assert main(arguments) == 0
        lines = capsys.readouterr().out.splitlines()
        assert [line.split()[0] for line in lines[2 : 2 + len(COMMANDS)]] == list(COMMANDS) and all(
            len(line) < 121 for line in lines
        )
    assert main(["mode"]) == 2
    said = capsys.readouterr()
    assert said.err == f"error: unknown command 'mode'; must be one of {', '.join(COMMANDS)}; did you mean modes?\n"
    assert said.out == ""


def test_a_command_has_the_same_answer_under_both_names(capsys):
    answers = []
    for command in (main, import_module("vehicle.modes").main):
        arguments = ["--damper", "sliding", "--json", "--set", "damper.coulomb_friction=100"]
        assert command(["modes", *arguments] if command is main else arguments) == 0
        answers.append(capsys.readouterr().out)
    assert answers[0] == answers[1] and json.loads(answers[0])["damper"] == "sliding"


@pytest.mark.parametrize("option", ["--vehicle", "--set", "--engine", "--force", "--jobs", "--quiet", "--debug"])
def test_an_option_means_the_same_everywhere(option, monkeypatch):
    monkeypatch.setenv("COLUMNS", "1000")
    texts = [parser.format_help() for parser in parsers().values()]
    lines = [line.split() for text in texts for line in text.splitlines() if line.startswith(f"  {option} ")]
    # The default may differ: one run is MuJoCo's, many are left to the program, and so are the processes of a sweep.
    assert len(lines) > 1 and len({" ".join(line).partition("; default")[0] for line in lines}) == 1


def test_numbers_of_processes_are_checked_alike(capsys):
    for name in ("vehicle.commands.sweep", "scenarios.levels"):
        assert import_module(name).main(["--jobs", "0", *(["--input", "low.csv"] if "sweep" in name else [])]) == 2
        assert capsys.readouterr().err == "error: --jobs 0: must be at least 1\n"


@pytest.mark.parametrize("name", COMMANDS)
def test_modules_run_as_commands(name, tmp_path):
    """One fresh interpreter each; what the commands do is tested in this process."""
    module = [f"vehicle.{name}"] if name in OLDER else ["vehicle", name]
    done = process(sys.executable, "-m", *module, "--nonsense", cwd=tmp_path)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.startswith("error: ") and done.stderr.endswith(f"see python -m vehicle {name} --help\n")


def options_of(parser: argparse.ArgumentParser) -> set[str]:
    """Return the long options of a command and of its subcommands."""
    names = {name for action in parser._actions for name in action.option_strings if name.startswith("--")}
    inner = [action.choices for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    return names.union(*(options_of(each) for choices in inner for each in choices.values()))


def test_every_option_is_on_a_page():
    """A page names both axles as `--track-front`, `-rear`."""
    pages = "\n".join(page.read_text(encoding="utf-8") for page in (ROOT / "docs").rglob("*.md"))
    written = set(re.findall(r"--[a-z][a-z-]*", pages))
    written |= {name.removesuffix("-front") + "-rear" for name in written if name.endswith("-front")}
    options = set().union(*(options_of(import_module(module_of(name)).parser()) for name in COMMANDS))
    assert options - written == {"--debug"}, "name the option on the page of its command"
