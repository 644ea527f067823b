"""Standard streams of a command: characters that steer a terminal are shown as escapes.

Names of channels, units and files come from other people's files. Printed raw, "\\x1b[2J" in a name would clear the
screen, and a right-to-left mark would change how a line reads.
"""

import sys
import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

STEERING = ("Cc", "Cf")
"""Unicode categories of control and format characters; line feed and tabulator stay."""


class PrintableStream:
    """Text stream that writes control and format characters as escapes; everything else is unchanged."""

    def __init__(self, stream: Any) -> None:
        self.stream = stream

    def write(self, text: str) -> int:
        """Write a text; returns the number of its characters."""
        self.stream.write(printable(text))
        return len(text)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.stream, name)


def printable(text: str) -> str:
    """Return a text whose control and format characters are escapes as in Python, for example \\x1b."""
    if text.replace("\n", "").replace("\t", "").isprintable():
        return text
    return "".join(
        letter.encode("unicode_escape").decode("ascii")
        if unicodedata.category(letter) in STEERING and letter not in "\n\t"
        else letter
        for letter in text
    )


@contextmanager
def printable_streams() -> Iterator[None]:
    """Let standard output and standard error be printable streams; progress bars write to their `stream`."""
    streams = sys.stdout, sys.stderr
    # In a nested command the streams are printable already.
    sys.stdout, sys.stderr = (
        stream if isinstance(stream, PrintableStream) else PrintableStream(stream) for stream in streams
    )
    try:
        yield
    finally:
        sys.stdout, sys.stderr = streams
