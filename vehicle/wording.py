"""Options in the texts of errors and notices: those of the command in a command, the arguments of Python elsewhere.

A message is written once, with the options of the command line, and worded where it is read.

>>> in_words("low.csv: 60 s; set --skip 2, --tyre standing or --set solver.record_rate=500, or pass --force")
'low.csv: 60 s; set skip=2, tyre="standing" or solver.record_rate=500, or pass force=True'
>>> in_words("set --rate HZ, or --channel time=NAME")
'set rate=HZ, or channels={"time": "NAME"}'
>>> in_words("set --map seat_acc_z=3 --map knuckle_fl_acc_z='acc front left', or --delay seat_acc_z=12.3ms")
'set channels={"seat_acc_z": "3", "knuckle_fl_acc_z": "acc front left"}, or delay={"seat_acc_z": 0.0123}'

Options that Python lacks stay, and names of the user too.

>>> in_words("'a --skip 2.csv': killed; continue with --resume")
"'a --skip 2.csv': killed; continue with --resume"
"""

import difflib
import re
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager

SAME = (
    "band bands cars channels coherence contact damper delay drift duration engine highpass jobs maximise measure "
    "measured minimise offset orders parameters patch pattern rail rate resample road rpm samples seed signal skip "
    "speed stretch tyre vary wheel window"
)
ARGUMENTS = {name: name for name in SAME.split()} | {
    "channel": "channels",
    "condition": "conditions",
    "dbc": "databases",
    "from": "first",
    "to": "last",
    "limit": "limits",
    "map": "channels",
    "output": "folder",
    "place": "contact",
    "positive": "compression",
    "search-seed": "seed",
    "tolerance": "tolerances",
    "turn": "inverted",
    "unit": "units",
    "vehicle": "car",
}
"""Option to the argument of Python; other options stay."""

SWITCHES = {"any-level", "check", "detrend", "force", "interpolate", "remove-mean", "retry-failed", "stuck"}
"""Options without a value."""

OTHERS = {"no-forces": "apply_forces=false"}
"""Options that Python has as a parameter of the car."""

PAIRS = {"channel", "condition", "delay", "map", "parameters", "tolerance", "unit", "vary"}
"""Options whose values ROLE=VALUE are a dictionary in Python."""

TEXTS = {"channel", "condition", "map", "unit"}
"""Options of which Python takes even a number as text."""

LISTS = {"channels", "dbc", "limit", "maximise", "minimise", "turn"}
"""Options whose values are a list in Python."""

SECONDS = {"ms": "e-3", "us": "e-6", "s": ""}

NUMBER = r"-?\d[\d.]*(?:e[-+]?\d+)?"
WORDS = "mujoco reduced auto standing rolling level keep remove loads all extension compression patch stiffness m/s2 g"
CARS = r"(?:focus|sedan)\w*"
VALUE = "|".join(
    (
        rf"{NUMBER}(?::{NUMBER})+",
        rf"{NUMBER}(?=[\s:;,.)]|$)",
        r"[\w./*-]+='[^']*'",
        r'[\w./*-]+="[^"]*"',
        r"[\w./*-]+=[^\s;,)]*[^\s;,.:)]",
        r"[A-Z][A-Z_/]*(?::[A-Z_]+)*\b",
        "channel:[A-Z]+",
        "'[^']*'",
        r"[a-z]+(?:_[a-z0-9]+)+\b",
        r"\S*\.\w{2,4}\b",
        CARS,
        rf"(?:{'|'.join(WORDS.split())})\b",
    )
)
"""Values of an option in a message: a number, a range, a pair, a placeholder, a channel, a file, or a word."""

COMMAND = r"(?:python -m vehicle|vehicle show|vehicle trust|dask worker) [^;`)]*"
ONE = r"\b(?:compare|orders|report|shaker|sweep|tune) --[a-z][a-z-]*"
"""Option of a command that is named before it."""
HEAD = r"^--([a-z][a-z0-9-]*) (\S+?)(?=: )"
"""Option with any value at the beginning of a message."""
OPTION = rf"(?<![\w./\\-])--([a-z][a-z0-9-]*)(?:[ =]({VALUE}))?"
QUOTED = r"""(?<!\w)'[^'\n]*'(?!\w)|(?<!\w)"[^"\n]*"(?!\w)"""
PART = re.compile("|".join((COMMAND, ONE, HEAD, OPTION, QUOTED)))
MORE = re.compile(r"(--(?:channel|unit) )(\w+=[^\s;,]+)(,? or |, )(?=\w+=)")
"""Pair of an option that further pairs follow, as --unit z=m/s2 or z=g."""
EACH = re.compile(rf"^--each ({NUMBER}) (%|mm)(?=: )")
MERGED = re.compile(r"\b(\w+=)([{[])([^][{}]*)[]}] \1[{[]")
"""Two dictionaries or lists of one argument."""

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
    text = _repeated(MORE, r"\1\2\3\1", EACH.sub(_share, text.removeprefix("--output ")))
    return _repeated(MERGED, r"\1\2\3, ", PART.sub(_argument, text))


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


def _repeated(pattern: re.Pattern[str], new: str, text: str) -> str:
    """Return a text with a pattern replaced until it is not found any more."""
    count = 1
    while count:
        text, count = pattern.subn(new, text)
    return text


def _share(each: re.Match[str]) -> str:
    """Return the argument of Python for the share or the shift of `--each`."""
    return f"share={float(each[1]) / 100.0:g}" if each[2] == "%" else f"shift={float(each[1]) / 1000.0:g}"


def _argument(part: re.Match[str]) -> str:
    """Return a part of a text with the argument of Python for an option."""
    name, value = part[1] or part[3] or "", _bare(part[2] or part[4] or "")
    role, equals, content = value.partition("=")
    if name == "set":
        return value or "overrides"
    if name in OTHERS or name in SWITCHES:
        return (OTHERS.get(name) or f"{name.replace('-', '_')}=True") + (f" {value}" if value else "")
    if name == "vehicle" and value:
        return f"Car.load({_quoted(value)})"
    if name not in ARGUMENTS:
        return part[0]
    argument = "mapping" if role == "POINT" else ARGUMENTS[name]
    if not value:
        return argument
    if name in PAIRS and (equals or name == "unit"):
        key, of = (role, _bare(content)) if equals else ("", value)
        new = _value(name, of)
        return f"{argument}={{{_quoted(key)}: {new}}}" if new else part[0]
    if name == "channel" and value == "POINT":
        return "point=POINT"
    if name in PAIRS - {"delay"}:
        return part[0]
    if name in LISTS:
        return f"{argument}=[{', '.join(_quoted(each) for each in value.split(','))}]"
    new = _value(name, value)
    return f"{argument}={new}" if new else part[0]


def _value(name: str, value: str) -> str:
    """Return the value of an option in the notation and unit of Python; empty: unknown."""
    number = re.fullmatch(f"({NUMBER})(ms|us|s)?", value)
    if value == "...":
        return value
    if name in TEXTS:
        return f'"{value}"'
    if name == "positive":
        return {"compression": "True", "extension": "False"}.get(value, "")
    if name == "delay" and number:
        return repr(float(number[1] + SECONDS[number[2]])) if number[2] else value
    if name == "drift":
        return f"{value}e-6" if number and "e" not in value else ""
    if name in ("delay", "from", "to") and not (number or re.fullmatch("[A-Z]+", value)):
        return ""
    if name in ("orders", "rpm") or value.count(":") > 1:
        return ""
    return _quoted(value, placeholder=name != "road")


def _bare(value: str) -> str:
    """Return a value without the quotation marks around it."""
    return value[1:-1] if len(value) > 1 and value[0] in "'\"" and value[-1] == value[0] else value


def _quoted(value: str, *, placeholder: bool = False) -> str:
    """Return a value in the notation of Python: number, placeholder, tuple of numbers, or quoted text."""
    if re.fullmatch(rf"{NUMBER}(?:[:,]{NUMBER})+|FROM:TO|LOW:HIGH", value):
        return f"({value.replace(':', ',').replace(',', ', ')})"
    plain = re.fullmatch(NUMBER, value) or (placeholder and re.fullmatch(r"[A-Z_/]+", value))
    return value if plain else f'"{value}"'
