"""Pages name every command, only options that exist, and no block that no test runs."""

import argparse
from importlib import import_module

import pytest

import vehicle
from tests.documentation.pages import BLOCK, ROOT, blocks, pages, prose_commands
from vehicle.commands import COMMANDS, module_of

NOT_RUN = {
    "git clone": "needs the network",
    "python3 -m venv": "the environment in which this test runs",
    "pip install": "needs the network; tests/commands/test_wheel.py installs the package",
    "make shaker": "sets up the environment in which this test runs",
    "make test": "this test runs in it",
    "make docs": "test_site.py runs its command",
    "python -m vehicle bench": "serves a page until Ctrl-C; tests/handover/bench/test_page.py opens it",
}
"""Beginning of a command of a `sh` block to the reason why no test of pages runs it."""


def test_python_examples_show_every_public_function():
    text = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    functions = [name for name in vehicle.__all__ if name[0].islower()]
    assert [name for name in functions if f"{name}(" not in text] == []


def test_the_readme_is_short_and_its_example_has_eight_lines():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 100 and len(text.split()) <= 700
    (example,) = blocks("README.md", "python")
    assert len([line for line in example.splitlines() if line]) <= 8


def test_every_command_has_a_page():
    listed = (ROOT / "docs" / "howto" / "index.md").read_text(encoding="utf-8")
    for name in COMMANDS:
        assert f"]({name}.md)" in listed
        assert any(f"vehicle {name}" in block for block in blocks(f"docs/howto/{name}.md", "console"))


@pytest.mark.parametrize("page", pages())
def test_blocks_are_of_known_languages_and_closed(page):
    text = (ROOT / page).read_text(encoding="utf-8")
    known = {"console", "python", "diff", "c", "toml", "csv", "text", "sh", ""}
    assert {match[2] for match in BLOCK.finditer(text)} <= known, "write a language of this list behind the fence"
    assert "```" not in BLOCK.sub("", text)
    for block in blocks(page, "sh"):
        for line in block.splitlines():
            assert line.startswith(tuple(NOT_RUN)), f"{page}: {line!r} runs in no test; make it a console block"


def options_of(name):
    """Names of all options of a command, with those of its subcommands."""
    found, parsers = set(), [import_module(module_of(name)).parser()]
    while parsers:
        parser = parsers.pop()
        found |= set(parser._option_string_actions)
        for action in parser._actions:
            if isinstance(action, argparse._SubParsersAction):
                parsers += action.choices.values()
    return found


@pytest.mark.parametrize("page", pages())
def test_commands_in_prose_have_options_that_exist(page):
    for words in prose_commands(page):
        module, *rest = words[2:] if words[:2] == ["python", "-m"] else words
        name = rest[0] if module == "vehicle" else module.removeprefix("vehicle.")
        if name not in COMMANDS:
            known = name.isupper() or name in ("--schema", "--version", "--print-completion")
            assert known, f"{page}: {' '.join(words)}"
            continue
        options = {word.partition("=")[0] for word in words if word.startswith("--")}
        assert options <= options_of(name), f"{page}: {' '.join(words)}"
