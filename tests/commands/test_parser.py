"""The argument parser of all commands: groups of options that act, values with a minus, one meaning for each word."""

import argparse
import contextlib
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from vehicle.commands import COMMANDS, module_of
from vehicle.commands.console import Console
from vehicle.commands.parser import Parser, idle_options
from vehicle.errors import ConfigurationError

TRIAL = "--trial"
LINES: dict[str, dict[str, tuple[list[str], list[str]]]] = {
    "shaker": {
        "a file of signals": (["--road", "C", "--speed", "80"], ["--input", "low.csv"]),
        "a road": (["--input", "low.csv"], ["--road", "C"]),
        "a road of a class": (["--road", "road.csv"], ["--road", "C"]),
        "a film": (["--input", "low.csv"], ["--input", "low.csv", "--video"]),
        "a measurement": (["--input", "low.csv"], ["--input", "low.csv", "--measured", "m.uff"]),
        "a report": (["--input", "low.csv"], ["--input", "low.csv", "--report"]),
        "a file of signals or a recorded road": (["--road", "C"], ["--road", "r.csv", "--speed", "channel:v"]),
        "a file of signals or of a measurement": (["--road", "C"], ["--road", "C", "--measured", "m.uff"]),
    },
    "report": {"a film": (["A", "B"], ["A", "B", "--video"])},
    "sweep": {
        "a file of signals": (["--road", "C", "--road", "D"], ["--input", "low.csv"]),
        "a road": (["--input", "low.csv"], ["--road", "C"]),
        "a road of a class": (["--road", "a.csv", "--road", "b.csv"], ["--road", "a.csv", "--road", "C"]),
        "a report": ([], ["--report"]),
        "going on": ([], ["--resume"]),
    },
    "optimise": {
        "a file of signals": (["--road", "C"], ["--input", "low.csv"]),
        "cars as they are made": ([], ["--tolerance", "body.mass=1%"]),
    },
    "road": {"a road of a class": (["--profile", "p.csv"], ["--class", "C"])},
    "kinematics": {"loads on the wheels": (["--ideal"], []), "files": ([], ["--output", "axle"])},
    "modes": {"files": ([], ["--uff", "m.uff"]), "a decoupling": ([], ["--decoupling", "engine"])},
}
"""Command to its groups: a command line on which each does nothing, and one on which it acts."""


def parser_of(name: str) -> Parser:
    parser: Parser = import_module(module_of(name)).parser()
    return parser


@pytest.mark.parametrize(("name", "group"), [(name, group) for name, groups in LINES.items() for group in groups])
def test_a_new_option_of_a_group_is_refused_where_the_group_does_nothing(name, group):
    """The option is known to nobody but its group."""
    idle, active = LINES[name][group]
    parser = parser_of(name)
    scope = parser.scopes[group]
    container = next(one for one in parser._action_groups if one.title == group)
    container.add_argument(TRIAL, type=float)
    assert parser.parse_args([*active, TRIAL, "2"]).trial == 2.0
    with pytest.raises(ConfigurationError, match=f"^{TRIAL}: belongs to ") as refused:
        parser.parse_args([*idle, f"{TRIAL}=2"])
    assert scope.needs in str(refused.value)
    parser.parse_args(idle)


def test_all_groups_with_a_condition_are_tested_or_left_to_the_command():
    for name in LINES:
        left = {title for title, scope in parser_of(name).scopes.items() if scope.active} - LINES[name].keys()
        assert left <= ({"a road", "a road of a class", "going on"} if name in ("optimise", "road") else set()), name


def test_a_group_that_only_the_command_can_judge():
    parser = Parser()
    parser.scoped_group("shapes", needs="mode shapes", active=None).add_argument("--damper", default="stuck")
    assert not idle_options(parser.parse_args([]))
    console = Console(idle=idle_options(parser.parse_args(["--damper", "stuck"])))
    console.refuse_idle("further shapes")
    with pytest.raises(ConfigurationError, match=r"^--damper: belongs to mode shapes$"):
        console.refuse_idle("shapes")


@pytest.mark.parametrize(
    ("name", "words", "place", "value"),
    [
        ("kinematics", ["--travel", "-60:60:20"], "travel", "-60:60:20"),
        ("kinematics", ["--contact-force", "x=-5", "--travel", "-1e-3:2"], "travel", "-1e-3:2"),
        ("body", ["import", "f.sti", "--output", "b.npz", "--axes", "-x,-y,z"], "axes", "-x,-y,z"),
        ("body", ["import", "f.sti", "--output", "b.npz", "--origin", "-1.2,0,.3"], "origin", "-1.2,0,.3"),
        ("shaker", ["--input", "low.csv", "--from", "-2.5"], "first", -2.5),
        ("compare", ["runs/low", "--measured", "m.uff", "--delay", "-1e-3"], "delay", ["-1e-3"]),
        ("inspect", ["-my file.csv"], "files", ["-my file.csv"]),
    ],
)
def test_values_that_begin_with_a_minus(name, words, place, value):
    assert getattr(parser_of(name).parse_args(words), place) == value


def test_a_single_minus_before_an_option_is_told():
    with pytest.raises(ConfigurationError, match=r"^-travel=1:2: options begin with two hyphens; type --travel=1:2$"):
        parser_of("kinematics").parse_args(["-travel=1:2"])


def options_of(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    found = []
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            found += [one for inner in action.choices.values() for one in options_of(inner)]
        elif action.option_strings and action.dest != "help":
            found.append(action)
    return found


SAME_IDEA = {
    "--output": "the results, as a folder or a file",
    "--vary": "parameters that are varied: single values, or bounds",
    "--channel": "a channel of a file, for a role or for an axis",
    "--channels": "channels by name; the shaker has groups of them too",
    "--wheel": "a wheel of the car",
    "--speed": "speed of the car; on a road also a channel of its record",
    "--video": "a film",
    "--table": "a table of parameters: cases of a sweep, or a car of the user",
    "--road": "a road; over several speeds it is a class or level",
    "--rpm": "speeds of the crankshaft: one, a run-up, or steady points",
    "--from": "where something begins: at a time of a file, or with a template car",
}
"""Options whose values are written in several ways, and the one meaning that they have."""


def test_an_option_has_one_meaning_in_all_commands():
    """The way in which the value is written stands for the meaning."""
    ways: dict[str, set[tuple[object, ...]]] = {}
    for name in COMMANDS:
        for one in options_of(parser_of(name)):
            kind = (type(one).__name__ == "_StoreTrueAction", str(one.metavar), tuple(one.choices or ()))
            ways.setdefault(one.option_strings[0], set()).add(kind)
    several = {option for option, kinds in ways.items() if len(kinds) > 1}
    assert len(ways) > 100 and several <= SAME_IDEA.keys(), {option: ways[option] for option in several - {*SAME_IDEA}}


@pytest.mark.parametrize(
    ("name", "words", "today"),
    [
        ("kinematics", ["--force", "x=1000"], "--contact-force AXIS=VALUE"),
        ("kinematics", ["--replace"], "--force"),
        ("shaker", ["--input", "low.csv", "--road"], "--any-level"),
        ("shaker", ["--road", "--input", "low.csv"], "--any-level"),
        ("drive", ["--target", "a.csv", "--tolerance", "5"], "--target-error PERCENT"),
        ("body", ["import", "f.sti", "--output", "b.npz", "--tolerance=5"], "--point-distance MM"),
        ("body", ["import", "f.sti", "--output", "b.npz", "--map", "points.csv"], "--point-nodes FILE"),
        ("body", ["participation", "--place", "seat_rail_acc_z"], "--response CHANNEL"),
    ],
)
def test_a_former_word_names_that_of_today(name, words, today):
    with pytest.raises(ConfigurationError, match=today):
        parser_of(name).parse_args(words)


@pytest.mark.parametrize("name", COMMANDS)
def test_no_message_shows_the_name_of_a_function(name):
    """The message of argparse for a ValueError ends with the name of the type, which is none that a user knows."""

    def types(parser: argparse.ArgumentParser) -> list[Any]:
        found: list[Any] = []
        for action in parser._actions:
            inner = action.choices.values() if isinstance(action, argparse._SubParsersAction) else ()
            found += [action.type, *(kind for each in inner for kind in types(each))]
        return [kind for kind in found if kind not in (None, str, int, float, Path)]

    for kind in types(parser_of(name)):
        with contextlib.suppress(ConfigurationError, argparse.ArgumentTypeError):
            kind("x=")


@pytest.mark.parametrize(
    ("name", "typed", "message"),
    [
        ("shaker", "low.csv", "low.csv: .* --input low.csv; see "),
        ("modes", "sedan", "sedan: .* --vehicle sedan; see "),
        ("shaker", "--input low.csv --out x", "--out: .* --output"),
        ("shaker", "--input low.csv --gravity 9", "--gravity: no such option; see "),
        ("shaker", "--road B --duration 60s", "--duration '60s': must be a number "),
        ("shaker", "--road B --seed 1.5", "--seed '1.5': must be a whole number "),
        ("shaker", "--input low.csv --engine fast", "--engine 'fast': must be one of mujoco, reduced, auto; see "),
        ("shaker", "--input", "--input: needs a value; see "),
        ("shaker", "--input low.csv --set body.mass = 900", "= 900: write PATH=VALUE "),
        ("sweep", "body.mass 800 900", "body.mass 800 900: "),
        ("compare", "runs/low", "missing: --measured; .*python -m vehicle report "),
        ("tune", "sedan --measured a.csv", "--measured: .*--frf FILE.*--record FILE"),
        ("tune", "sedan --vary body.mass=800:900", ".*--parameters PATH=LOW:HIGH"),
    ],
)
def test_a_mistake_of_typing_names_what_to_type(name, typed, message):
    with pytest.raises(ConfigurationError, match=f"^{message}"):
        parser_of(name).parse_args(typed.split())
