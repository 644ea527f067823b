"""Option --accept-advice: run a command again with the options that the findings on its records state."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable

from vehicle.errors import ConfigurationError
from vehicle.signals.records.finding import Finding, FindingError, added, findings_of, parts_of

OPTION = "--accept-advice"

ROUNDS = 8
"""Maximum number of times that a command begins again; then its findings are the error."""


def advice_option(parser: argparse._ActionsContainer) -> None:
    """Add --accept-advice."""
    parser.add_argument(
        OPTION,
        action="store_true",
        help="apply the options that the findings on the record name (units, offsets, channels, signs, delays, "
        "constant parts), and print each finding",
    )


def require_one_file(options: argparse.Namespace) -> None:
    """Refuse --accept-advice with several files, whose findings differ.

    Raises:
        ConfigurationError: --accept-advice.
    """
    if options.accept_advice:
        raise ConfigurationError(f"{OPTION} needs a single file; run the command once for each file")


def accept(options: argparse.Namespace, notices: Iterable[str]) -> None:
    """Raise the findings among notices that --accept-advice has to apply, so that the command begins again with them.

    Raises:
        FindingError: findings with options that were not yet applied, with --accept-advice only.
    """
    findings = findings_of(notices)
    if getattr(options, "accept_advice", False) and any(_new(each, options) for each in findings):
        raise FindingError("", findings)


def retried(error: FindingError, options: argparse.Namespace) -> list[str] | None:
    """Return the words of a command line with the new options of the findings of an error; None without any.

    An option that was accepted before is left out: a second --turn would turn the channel back.
    """
    new = [_new(finding, options) for finding in error.findings]
    if not getattr(options, "accept_advice", False) or not any(new):
        return None
    arguments = list(options.words)
    for finding, is_new in zip(error.findings, new, strict=True):
        parts = [part for part in parts_of(finding.options) if part not in options.accepted]
        options.accepted.update(parts)
        arguments = added(arguments, [word for part in parts for word in part if word])
        if not getattr(options, "quiet", False):
            print(f"{'accepted' if is_new else 'found'}: {finding}", file=sys.stderr, flush=True)
    return arguments


def _new(finding: Finding, options: argparse.Namespace) -> bool:
    """Return True for a finding with an option that was not yet applied."""
    return not set(parts_of(finding.options)) <= options.accepted
