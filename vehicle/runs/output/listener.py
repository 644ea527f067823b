"""Receiver of the progress, the results and the notices of a long computation."""

from collections.abc import Callable, Iterable


class Listener:
    """Receiver that ignores everything; the console of a command prints it."""

    def progress(self, work: str, *, runs: int = 0) -> Callable[[float], None]:
        """Return the function that is called with the finished fraction [-] of the work."""
        return lambda fraction: None

    def say(self, text: object) -> None:
        """Receive a line of the results."""

    def notice(self, text: object) -> None:
        """Receive a notice."""

    def accept(self, notices: Iterable[str]) -> None:
        """Receive the findings on a record; may raise `FindingError` to begin again with their options."""
