"""Lists in the headers of the core: the records and laws that Python and C share."""

import re
from functools import cache
from pathlib import Path

SOURCES = Path(__file__).parent / "source"


@cache
def _text(header: str) -> str:
    """Return a header without comments and continued lines."""
    text = (SOURCES / header).read_text(encoding="utf-8")
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.DOTALL)
    # A compiler takes blanks behind the backslash too.
    return re.sub(r"\\[ \t]*\n", " ", text)


def listed(header: str, macro: str, entry: str) -> list[tuple[str, ...]]:
    """Return the entries of a macro of a header: the arguments of each F(...), S(...) or A(...).

    Raises:
        KeyError: the header lacks the macro.
    """
    definition = re.search(rf"^\s*#\s*define\s+{macro}\({entry}\)(.*)$", _text(header), flags=re.MULTILINE)
    if definition is None:
        raise KeyError(f"{SOURCES / header} has no line '#define {macro}({entry})'")
    return [
        tuple(each.strip() for each in arguments.split(","))
        for arguments in re.findall(rf"\b{entry}\(([^)]*)\)", definition[1])
    ]
