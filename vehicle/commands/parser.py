"""Argument parser of all commands: negative values, options of earlier versions, options without effect."""

import argparse
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from itertools import pairwise
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.shipped import CARS

Condition = Callable[[argparse.Namespace], bool]


@dataclass(frozen=True, slots=True)
class Scope:
    """Object on which a group of options acts.

    Attributes:
        active: True if the parsed options contain the object of the group; None if only the command can decide it
            and calls `Console.refuse_idle`.
        needs: completes "belongs to ...", for the message.
        options: options of the group.
    """

    active: Condition | None
    needs: str
    options: list[argparse.Action] = field(default_factory=list)


class _ScopedGroup(argparse._ArgumentGroup):
    """Group of options with a scope; they are rejected if the scope is not active."""

    scope: Scope

    def _add_action(self, action: Any) -> Any:
        self.scope.options.append(action)
        return super()._add_action(action)


class _Version(argparse.Action):
    """Print the version of the package, which is read only here."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object, **__: object) -> None:
        from vehicle.version import package_version

        print(package_version())
        parser.exit()


class Parser(argparse.ArgumentParser):
    """Argument parser whose errors are one message and exit code 2.

    A word that begins with a single minus is a value, except -h, the only short option.

    Attributes:
        advice: text in the help and at the end of each message about usage.
        scopes: title of a group to the object of its options.
        former_words: pattern of an option of an earlier version, and the message with its replacement.
    """

    def __init__(self, *args: Any, **keywords: Any) -> None:
        super().__init__(*args, **keywords)
        self.advice = ""
        self.scopes: dict[str, Scope] = {}
        self.former_words: list[tuple[re.Pattern[str], str]] = []

    def add_version(self) -> None:
        """Add --version, which prints the version of the package."""
        self.add_argument("--version", action=_Version, nargs=0, help="print the version and exit")

    def advise(self, advice: str) -> None:
        """Add the command for a similar task to the help and to each message about usage."""
        self.advice = advice
        self.epilog = f"{advice[0].upper()}{advice[1:]}. {self.epilog or ''}"

    def scoped_group(self, title: str, *, needs: str, active: Condition | None) -> argparse._ArgumentGroup:
        """Add a group of options that act on an object which not every command line contains.

        Args:
            title: of the group in the help.
            needs: completes the message "--option: belongs to ...", with the option that makes the group act.
            active: True if the parsed options contain that object; None if only the command can decide it. The
                options of a group that is not active are rejected.
        """
        group = _ScopedGroup(self, title)
        group.scope = Scope(active, needs)
        self.scopes[title] = group.scope
        self._action_groups.append(group)
        return group

    def former(self, pattern: str, message: str) -> None:
        """Reject an option of an earlier version.

        Args:
            pattern: regular expression, matched with each word and its successor, separated by a blank.
            message: error message with the option that replaces it.
        """
        self.former_words.append((re.compile(pattern), message))

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse the arguments; reject options of earlier versions and of groups that are not active."""
        arguments = [str(word) for word in (args or ())]
        for first, second in pairwise([*arguments, ""]):
            for pattern, message in self.former_words:
                if pattern.match(f"{first} {second}"):
                    raise ConfigurationError(message)
        options, unknown = super().parse_known_args(args, namespace)
        typed = self._given(arguments)
        for scope in self.scopes.values():
            if scope.active is not None and not scope.active(options) and (message := _refusal(scope, typed)):
                raise ConfigurationError(message)
        # Options and scopes of a subparser are in the namespace already.
        options.given = typed | getattr(options, "given", {})
        options.scopes = self.scopes | getattr(options, "scopes", {})
        return options, unknown

    def _given(self, arguments: Sequence[str]) -> dict[str, str]:
        """Return the options of a command line: destination to the option as typed."""
        options: dict[str, str] = {}
        for word in arguments:
            if word == "--":
                break
            option = word.partition("=")[0]
            if action := self._option_string_actions.get(option):
                options[action.dest] = option
        return options

    def _parse_optional(self, arg_string: str) -> Any:
        """Parse a word with a single minus as a value; argparse does this for plain numbers only."""
        if not arg_string.startswith("--") and arg_string not in self._option_string_actions:
            if f"-{arg_string.partition('=')[0]}" in self._option_string_actions:
                raise ConfigurationError(f"{arg_string}: options begin with two hyphens; type -{arg_string}")
            return None
        return super()._parse_optional(arg_string)

    def _plain(self, message: str) -> str:
        """Return a message of argparse in words of the user: option, value, what it must be."""
        if matched := re.fullmatch(r"argument (--[\w-]+)(?:/\S+)?: (.*)", message, re.DOTALL):
            option, text = matched.groups()
            if wrong := re.fullmatch(r"invalid (float|int) value: (.*)", text, re.DOTALL):
                return f"{option} {wrong[2]}: must be a {'whole ' if wrong[1] == 'int' else ''}number without a unit"
            if wrong := re.fullmatch(r"invalid choice: (.*) \(choose from (.*)\)", text, re.DOTALL):
                choices = wrong[2].replace("'", "")
                return f"{option} {wrong[1]}: must be one of {choices}"
            return f"{option}: {text.replace('expected one argument', 'needs a value')}"
        message = message.replace("the following arguments are required", "missing")
        typed = message.removeprefix("unrecognized arguments: ")
        return message if typed == message else self._of_unknown(typed)

    def _of_unknown(self, typed: str) -> str:
        """Return the message for words that belong to no option, with the option that was probably meant."""
        word = typed.split()[0]
        if word == "=":
            return f"{typed}: write PATH=VALUE without spaces around '='"
        options = [option for option in self._option_string_actions if option.startswith("--")]
        if word.startswith("--"):
            name = word.partition("=")[0]
            near = [option for option in options if option.startswith(name)] or get_close_matches(
                name, options, n=1, cutoff=0.75
            )
            return f"{word}: no such option" + (f"; did you mean {' or '.join(near)}?" if near else "")
        if "--vehicle" in options and (word in CARS or word.endswith(".toml")):
            return f"{typed}: name the car with --vehicle {word}"
        if "--input" in options and (re.fullmatch(r"\.\w{2,3}", Path(word).suffix) or Path(word).is_file()):
            return f"{typed}: name the measurement with --input {word}"
        return f"{typed}: does not belong to any option; put names that need no option before the options"

    def error(self, message: str) -> None:  # type: ignore[override]
        """Raise a ConfigurationError with the message and the advice; argparse would end the process."""
        message = self._plain(message)
        raise ConfigurationError(f"{message}; {f'{self.advice}; ' if self.advice else ''}see {self.prog} --help")


def idle_options(options: argparse.Namespace) -> dict[str, str]:
    """Return the refusals of groups that only the command can find without effect: title to message.

    Only groups of which an option is on the command line.
    """
    return {
        title: message
        for title, scope in options.scopes.items()
        if scope.active is None and (message := _refusal(scope, options.given))
    }


def _refusal(scope: Scope, typed: dict[str, str]) -> str:
    """Return the message on the first option of a group on the command line, or an empty text."""
    word = next((typed[action.dest] for action in scope.options if action.dest in typed), "")
    return word and f"{word}: belongs to {scope.needs}"
