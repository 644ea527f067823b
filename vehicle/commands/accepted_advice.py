"""Option --accept-advice: run a command again with the options that the findings on its records state."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable

from vehicle.signals.records.finding import Finding, FindingError, added, findings_of, parts_of

OPTION = "--accept-advice"


def advice_option(parser: argparse._ActionsContainer) -> None:
    """Add --accept-advice."""
    parser.add_argument(
        OPTION,
        action="store_true",
        help="apply the options that the findings on the record name (units, offsets, channels, signs, delays, "
        "constant parts), and print each finding",
    )


def accept(options: argparse.Namespace, notices: Iterable[str]) -> None:
    """Raise the findings among notices that --accept-advice has to apply, so that the command begins again with them.

    Raises:
        FindingError: findings with options that were not yet applied, with --accept-advice only.
    """
    findings = findings_of(notices)
    if getattr(options, "accept_advice", False) and any(_new(each, options) for each in findings):
        raise FindingError("", findings)


def retried(error: FindingError, options: argparse.Namespace) -> list[str] | None:
    """Return the words of a command line with the options of the findings of an error; None without new options."""
    new = [_new(finding, options) for finding in error.findings]
    if not getattr(options, "accept_advice", False) or not any(new):
        return None
    arguments = list(options.words)
    for finding, is_new in zip(error.findings, new, strict=True):
        options.accepted.update(parts_of(finding.options))
        arguments = added(arguments, finding.options)
        if not getattr(options, "quiet", False):
            print(f"{'accepted' if is_new else 'found'}: {finding}", file=sys.stderr, flush=True)
    return arguments


def _new(finding: Finding, options: argparse.Namespace) -> bool:
    """Return True for a finding with an option that was not yet applied."""
    return not set(parts_of(finding.options)) <= options.accepted
