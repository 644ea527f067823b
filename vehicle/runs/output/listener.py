"""Who is told of the progress and the results of a long computation: nobody, or the console of a command."""

from collections.abc import Callable, Iterable
from typing import Protocol


class Listener(Protocol):
    """Object that is told of the progress and the results of a computation."""

    def progress(self, work: str) -> Callable[[float], None]:
        """Return the function that is called with the finished fraction [-] of a part of the work."""
        ...

    def say(self, text: object) -> None:
        """Take a line of the results."""
        ...

    def notice(self, text: object) -> None:
        """Take a notice."""
        ...

    def accept(self, notices: Iterable[str]) -> None:
        """Take the findings on a record; raise `FindingError` to begin again with their options."""
        ...


class Nobody:
    """Listener that ignores all."""

    def progress(self, work: str) -> Callable[[float], None]:
        """Return a function that does nothing."""
        return lambda fraction: None

    def say(self, text: object) -> None:
        """Do nothing."""

    def notice(self, text: object) -> None:
        """Do nothing."""

    def accept(self, notices: Iterable[str]) -> None:
        """Do nothing."""
