"""Notices about what earlier commands left, on standard error; the logger `vehicle.results` of `logging`."""

import logging
import sys

_NOTICES = logging.getLogger("vehicle.results")
_NOTICES.addHandler(logging.lastResort or logging.StreamHandler(sys.stderr))
_NOTICES.propagate = False


def say(*sentences: str) -> None:
    """Print sentences, a line for each."""
    for sentence in sentences:
        _NOTICES.warning("notice: %s", sentence)
