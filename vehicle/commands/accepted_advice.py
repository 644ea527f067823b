"""Option --accept-advice: run a command again with the options that the findings on its records state."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from vehicle.signals.records.finding import Finding, FindingError, added, parts_of

if TYPE_CHECKING:
    from vehicle.commands.console import Console

OPTION = "--accept-advice"

ROUNDS = 8
"""Maximum number of times that a command begins again; then its findings are the error."""


def advice_option(parser: argparse._ActionsContainer) -> None:
    """Add --accept-advice."""
    parser.add_argument(
        OPTION,
        action="store_true",
        help="apply the options that the checks of the record recommend (units, offsets, channels, signs, delays, "
        "constant parts), and print each finding",
    )


def retried(error: FindingError, console: Console) -> list[str] | None:
    """Return the words of a command line with the new options of the findings of an error; None without any.

    An option that was accepted before is left out: a second --turn would turn the channel back.
    """
    new = [is_new(finding, console) for finding in error.findings]
    if not console.accept_advice or not any(new):
        return None
    arguments = list(console.words)
    for finding, fresh in zip(error.findings, new, strict=True):
        parts = [part for part in parts_of(finding.options) if part not in console.accepted]
        console.accepted.update(parts)
        arguments = added(arguments, [word for part in parts for word in part if word])
        if not console.quiet:
            print(f"{'accepted' if fresh else 'found'}: {finding}", file=sys.stderr, flush=True)
    return arguments


def is_new(finding: Finding, console: Console) -> bool:
    """Return True for a finding with an option that --accept-advice has not yet applied."""
    return not set(parts_of(finding.options)) <= console.accepted
