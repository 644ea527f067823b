"""Findings on a record: notices with the options that cure the fault."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import Self

from vehicle.errors import DataError

LIMITS = {"--from": max, "--to": min}
"""Options of time limits, of which the narrower one counts."""


class Finding(str):
    """Notice on a record, as text, with the options that cure the fault.

    Attributes:
        kind: name of the fault, for example "sign", "unit", "gravity", "offset", "exchanged", "delay", "constant".
        options: words of the command line, as ("--turn", "seat_acc_z"); empty if no option cures the fault.
    """

    kind: str
    options: tuple[str, ...]

    def __new__(cls, text: str, fault: str = "", options: Sequence[str] = ()) -> Self:
        """Return the text as a finding."""
        finding = super().__new__(cls, text)
        finding.kind, finding.options = fault, tuple(options)
        return finding

    def within(self, prefix: str) -> Finding:
        """Return the finding with a prefix of its text."""
        return Finding(prefix + self, self.kind, self.options)


class FindingError(DataError):
    """Error for a record whose findings have to be accepted, or cured by hand, before it is used.

    Args:
        where: file or channel; may be empty.
        findings: the findings.
    """

    def __init__(self, where: object, findings: Iterable[Finding]) -> None:
        self.where, self.findings = where, tuple(findings)
        super().__init__(f"{where}: {'; '.join(self.findings)}" if where else "; ".join(self.findings))

    def __reduce__(self) -> tuple[type[Self], tuple[object, tuple[Finding, ...]]]:
        """Return the class and its arguments for `pickle`, which keeps the text alone by default."""
        return type(self), (self.where, self.findings)


def findings_of(notices: Iterable[str], *, kinds: Collection[str] = ()) -> list[Finding]:
    """Return the findings among notices, without repetition.

    Args:
        kinds: kinds of the findings; by default all.
    """
    return [each for each in dict.fromkeys(notices) if isinstance(each, Finding) and (not kinds or each.kind in kinds)]


def parts_of(options: Sequence[str]) -> list[tuple[str, str]]:
    """Return the options of words as pairs of option and value; the value is empty for a switch."""
    parts: list[tuple[str, str]] = []
    for word in options:
        if word.startswith("--"):
            option, _, value = word.partition("=")
            parts.append((option, value))
        else:
            parts.append((parts.pop()[0], word))
    return parts


def added(arguments: Sequence[str], options: Sequence[str]) -> list[str]:
    """Return the words of a command line with further options, which replace those of the same role.

    An option --turn that is there already is taken out: the channel is turned back. Of two limits of time the narrower
    one counts.
    """
    result = list(arguments)
    for option, value in parts_of(options):
        if not value:
            result += [] if option in result else [option]
            continue
        previous: list[str] = []
        for index in reversed(range(len(result))):
            word, equals, text = result[index].partition("=")
            if word == option and not equals and index + 1 < len(result):
                text = result[index + 1]
            if word == option and _role(option, text) == _role(option, value):
                previous.append(text)
                del result[index : index + (1 if equals else 2)]
        if option in LIMITS:
            value = f"{LIMITS[option](map(float, (value, *previous))):.9g}"
        if not (option == "--turn" and previous):
            result += [option, value]
    return result


def _role(option: str, value: str) -> str:
    """Return the role in the value ROLE=VALUE of an option."""
    return value if option == "--turn" else value.partition("=")[0] if "=" in value else ""
