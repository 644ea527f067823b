"""Lists in the headers of the core: the records and laws that Python and C share."""

import re
from functools import cache
from pathlib import Path

SOURCES = Path(__file__).parent / "source"


@cache
def _text(header: str) -> str:
    """Return a header without comments and continued lines."""
    text = (SOURCES / header).read_text(encoding="utf-8")
    return re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL).replace("\\\n", " ")


def listed(header: str, macro: str, entry: str) -> list[tuple[str, ...]]:
    """Return the entries of a macro of a header: the arguments of each F(...), S(...) or A(...).

    Raises:
        KeyError: the header lacks the macro.
    """
    definition = re.search(rf"^#define {macro}\({entry}\)(.*)$", _text(header), flags=re.MULTILINE)
    if definition is None:
        raise KeyError(macro)
    return [tuple(re.split(r",\s*", arguments)) for arguments in re.findall(rf"\b{entry}\(([^)]*)\)", definition[1])]
