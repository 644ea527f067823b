"""Options in the texts of errors and notices: those of the command in a command, the arguments of Python elsewhere.

A message is written once, with the options of the command line, and worded where it is read.

>>> in_words("low.csv: 60 s; set --skip 2, --tyre standing or --set solver.record_rate=500, or pass --force")
'low.csv: 60 s; set skip=2, tyre="standing" or solver.record_rate=500, or pass force=True'
>>> in_words("set --rate HZ, or --channel time=NAME")
'set rate=HZ, or channels={"time": "NAME"}'
"""

import difflib
import re
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager

ARGUMENTS = {
    "channel": "channels",
    "dbc": "databases",
    "each": "share",
    "from": "first",
    "to": "last",
    "input": "inputs",
    "limit": "limits",
    "map": "channels",
    "output": "folder",
    "search-seed": "seed",
    "tolerance": "tolerances",
    "turn": "inverted",
    "unit": "units",
    "vehicle": "car",
}
"""Option to the argument of Python, where the names differ in more than hyphens."""

SWITCHES = {"any-level", "check", "detrend", "force", "interpolate", "remove-mean", "resume", "retry-failed", "stuck"}
"""Options without a value."""

OTHERS = {"no-forces": "apply_forces=false", "video": "run.film"}
"""Options that Python has in another form."""

PAIRS = {"channel", "delay", "map", "parameters", "tolerance", "unit", "vary"}
"""Options whose values ROLE=VALUE are a dictionary in Python."""

NUMBER = r"-?\d[\d.]*(?:e[-+]?\d+)?"
WORDS = "mujoco reduced auto standing rolling level keep remove loads all extension compression patch stiffness m/s2 g"
CARS = r"(?:focus|sedan)\w*"
VALUE = "|".join(
    (
        rf"{NUMBER}:{NUMBER}",
        rf"{NUMBER}(?=[\s:;,.)]|$)",
        r"[\w./*-]+=[^\s;,)]*[^\s;,.:)]",
        r"[A-Z][A-Z_/]*(?::[A-Z_]+)?\b",
        "channel:[A-Z]+",
        "'[^']*'",
        r"\S*\.\w{2,4}\b",
        CARS,
        rf"(?:{'|'.join(WORDS.split())})\b",
    )
)
"""Values of an option in a message: a number, a range, a pair, a placeholder, a file, or a word of the commands."""

COMMAND = re.compile(r"(?:python -m vehicle|vehicle show|vehicle trust|dask worker) [^;`)]*")
OPTION = re.compile(rf"(?<![\w-])--([a-z][a-z0-9-]*)(?:[ =]({VALUE}))?")
HEAD = re.compile(r"^--([a-z][a-z0-9-]*) (\S+?)(?=: )")
"""Option with any value at the beginning of a message."""

_commands = 0
"""Number of running commands in this process."""


@contextmanager
def in_command() -> Iterator[None]:
    """Word messages with options while a command runs."""
    global _commands
    _commands += 1
    try:
        yield
    finally:
        _commands -= 1


def is_command() -> bool:
    """True if a command runs in this process."""
    return _commands > 0


def speak_options() -> None:
    """Keep the options in all messages of this process: a worker of a command, or the tests."""
    global _commands
    _commands += 1


def in_words(text: str) -> str:
    """Return a text with the arguments of Python for its options, except in a whole command line.

    In a command the text is unchanged.
    """
    if _commands or "--" not in text:
        return text
    parts, end = list[str](), 0
    text = HEAD.sub(_argument, text.removeprefix("--output "))
    for line in COMMAND.finditer(text):
        parts += [OPTION.sub(_argument, text[end : line.start()]), line[0]]
        end = line.end()
    return "".join([*parts, OPTION.sub(_argument, text[end:])])


def did_you_mean(name: str, names: Iterable[str], cutoff: float = 0.0) -> str:
    """Return "; did you mean X?" with the known name of the most similar spelling, or an empty text.

    Args:
        cutoff: least similarity, 0 to 1; 0 accepts any name.
    """
    similar = difflib.get_close_matches(name, list(names), n=1, cutoff=cutoff)
    return f"; did you mean {similar[0]}?" if similar else ""


def choose_from(name: str, names: Collection[str]) -> str:
    """Return "; did you mean X?" if a known name is similar, otherwise "; choose from" and all of them."""
    return did_you_mean(name, names, cutoff=0.6) or f"; choose from {', '.join(names)}"


def _argument(option: re.Match[str]) -> str:
    """Return the argument of Python for an option with its value."""
    name, value = option[1], option[2] or ""
    if name == "set":
        return value or "overrides"
    if name in OTHERS or name in SWITCHES:
        return (OTHERS.get(name) or f"{name.replace('-', '_')}=True") + (f" {value}" if value else "")
    if name == "vehicle" and value:
        return f"Car.load({_quoted(value)})"
    argument = ARGUMENTS.get(name, name.replace("-", "_"))
    if not value:
        return argument
    role, equals, content = value.partition("=")
    if name in PAIRS and (equals or name == "unit"):
        return f"{argument}={{{_quoted(role if equals else '')}: {_quoted(content if equals else value)}}}"
    return f"{argument}={_quoted(value, placeholder=name != 'road')}"


def _quoted(value: str, *, placeholder: bool = False) -> str:
    """Return a value in the notation of Python: number, placeholder, tuple of two numbers, or quoted text."""
    if re.fullmatch(rf"{NUMBER}:{NUMBER}|FROM:TO|LOW:HIGH", value):
        return f"({value.replace(':', ', ')})"
    plain = re.fullmatch(NUMBER, value) or (placeholder and re.fullmatch(r"[A-Z_/]+", value))
    return value if plain else f'"{value.strip(chr(39))}"'
