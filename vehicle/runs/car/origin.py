"""Vehicle file and changed parameters that make a car."""

from typing import TypedDict


class Origin(TypedDict):
    """Vehicle file of a car (None for the default car) and its changed parameters as "path=value"."""

    file: str | None
    overrides: list[str]
