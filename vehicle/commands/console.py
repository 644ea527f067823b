"""Console of a command: its progress, its results and notices, and the command line that was typed."""

from __future__ import annotations

import json
import math
import re
import shlex
import sys
import threading
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from vehicle.commands.accepted_advice import OPTION, is_new
from vehicle.digits import duration
from vehicle.errors import ConfigurationError
from vehicle.runs.output.listener import Listener
from vehicle.signals.records.finding import FindingError, findings_of


@dataclass(frozen=True, kw_only=True, slots=True)
class Console(Listener):
    """Console of a command.

    Attributes:
        words: arguments of the command.
        quiet: print errors only.
        json: print results as JSON.
        accept_advice: apply the options that findings name.
        accepted: options that were applied, with their values.
        idle: title of a group of options to the error message, for groups that only the command can judge.
    """

    words: tuple[str, ...] = ()
    quiet: bool = False
    json: bool = False
    accept_advice: bool = False
    accepted: set[tuple[str, str]] = field(default_factory=set)
    idle: Mapping[str, str] = field(default_factory=dict)

    def command(self, name: str) -> str:
        """Return the command line of a command, for example "vehicle sweep"."""
        return shlex.join(["python", "-m", *name.split(), *self.words])

    def progress(self, work: str, *, runs: int = 0) -> ProgressLine:
        """Return the progress of a long computation."""
        return ProgressLine(work, enabled=not self.quiet, runs=runs)

    def result(self, content: Any, text: object) -> None:
        """Print the content as JSON with --json, else the text, which --quiet leaves out."""
        if self.json:
            print(json.dumps(content, indent=2, allow_nan=False), flush=True)
        else:
            self.say(text)

    def say(self, text: object) -> None:
        """Print a text, which --quiet leaves out."""
        if not self.quiet:
            print(text, flush=True)

    def notice(self, text: object) -> None:
        """Print a notice on the error output."""
        print(f"notice: {text}", file=sys.stderr, flush=True)

    def accept(self, notices: Iterable[str]) -> None:
        """Raise the findings among notices that --accept-advice has to apply: the command begins again with them."""
        findings = findings_of(notices)
        if self.accept_advice and any(is_new(each, self) for each in findings):
            raise FindingError("", findings)

    def require_one_file(self) -> None:
        """Refuse --accept-advice with several files, whose findings differ."""
        if self.accept_advice:
            raise ConfigurationError(f"{OPTION} needs a single file; run the command once for each file")

    def refuse_idle(self, title: str) -> None:
        """Reject the options of a group that the command found to be without effect."""
        if title in self.idle:
            raise ConfigurationError(self.idle[title])


CHOSEN = re.compile(r"(notice: )?(\S+\.\w+: )?([\w/]+): (channel \d+ '([^']*)'( \[[^\]]*\])?)")
"""Notice of the channel of a file that was chosen for a channel of the car."""

CONTENT = re.compile(r"(notice: )?(\S+\.\w+: )?\d+ nodes, \d+ lines and elements")
"""Notice of what else a file contains, which `inspect` prints."""

NAMED_CHANNELS = 4
"""Maximum number of chosen channels that are printed; the files of results contain all."""


def folded(lines: Iterable[str]) -> list[str]:
    """Return lines of results with one line for all chosen channels of another name or unit."""
    kept, chosen, place = list[str](), list[re.Match[str]](), 0
    for line in lines:
        match = CHOSEN.fullmatch(line)
        if match is None:
            kept += [] if CONTENT.fullmatch(line) else [line]
        elif match[6] or match[5].replace(" ", "") != match[3]:
            place = place if chosen else len(kept)
            chosen.append(match)
    if chosen:
        head, named = chosen[0], ", ".join(f"{each[3]} is {each[4]}" for each in chosen[:NAMED_CHANNELS])
        more = f" and {len(chosen) - NAMED_CHANNELS} more" if len(chosen) > NAMED_CHANNELS else ""
        kept.insert(place, f"{head[1] or ''}{head[2] or ''}{named}{more}")
    return kept


asked_to_end = threading.Event()
"""Set by SIGINT and SIGTERM: a KeyboardInterrupt can be lost in a Python callback that C code calls."""


class ProgressLine:
    """Progress of a long computation: a bar on a terminal, a new line every half minute in a file.

    The bar moves every second even if no part of the computation ends: the time left counts down, or without an
    estimate the time so far counts up.

    Args:
        runs: number of runs of the computation; the line then has the number of finished runs too.
    """

    def __init__(self, work: str, *, enabled: bool = True, runs: int = 0) -> None:
        self.what = work
        self.runs = runs
        self.enabled = enabled
        self.moving = sys.stderr.isatty()
        self.started = time.monotonic()
        self.last = self.started - (MOVING_EVERY if self.moving else 0.0)
        self.first: tuple[float, float] | None = None
        self.fraction, self.end = 0.0, math.nan  # expected time of the end
        self._ended = threading.Event()
        if enabled and self.moving:
            moving_lines.add(self)
            threading.Thread(target=self._beat, daemon=True).start()

    def __call__(self, fraction: float) -> None:
        """Print a finished fraction [-]; raise KeyboardInterrupt after a lost interruption."""
        if asked_to_end.is_set():
            raise KeyboardInterrupt
        now = time.monotonic()
        if self.first is None:
            self.first = (now, fraction)  # the time left is estimated without compiling and reading
        begun, done = self.first
        if fraction > done:
            self.end = now + (now - begun) * (1.0 - fraction) / (fraction - done)
        self.fraction = fraction
        due = now - self.last >= (MOVING_EVERY if self.moving else LINE_EVERY) or (self.moving and fraction >= 1.0)
        # The first estimate of many runs comes at once: it shows whether to wait.
        due = due or (bool(self.runs) and self.last == self.started and self.end - now > LINE_EVERY)
        if not (self.enabled and due) or self._ended.is_set():
            return
        self.last = now
        if self.moving:
            self._draw(now)
        else:
            left = "" if math.isnan(self.end) else f", {duration(self.end - now)} left"
            counted = f", {self._counted()}" if self.runs else ""
            sys.stderr.write(f"{self.what.strip()}: {100 * fraction:.0f} %{counted}{left}\n")
            sys.stderr.flush()
        if fraction >= 1.0:
            self.stop()

    def stop(self) -> None:
        """End the movement of the bar, because the computation has ended or failed."""
        self._ended.set()
        moving_lines.discard(self)

    def _beat(self) -> None:
        """Draw the bar every second until the computation ends."""
        while not self._ended.wait(BEAT):
            now = time.monotonic()
            if now - self.last >= BEAT:
                self._draw(now)

    def _draw(self, now: float) -> None:
        """Draw the bar with the time left [s], or without an estimate with the time so far."""
        bar = "#" * round(30 * self.fraction)
        newline = "\n" if self.fraction >= 1.0 else ""
        elapsed = f"after {now - self.started:.0f} s"
        remark = elapsed if math.isnan(self.end) else f"{duration(max(self.end - now, 0.0))} left"
        counted = f"  {self._counted()}" if self.runs else ""
        stream = getattr(sys.stderr, "stream", sys.stderr)  # the carriage return is intended
        stream.write(f"\r{self.what} [{bar:<30}] {100 * self.fraction:3.0f} %{counted}  {remark:>12} {newline}")
        sys.stderr.flush()

    def _counted(self) -> str:
        """Return the number of finished runs of all."""
        return f"{round(self.fraction * self.runs)} of {self.runs} runs"


moving_lines: set[ProgressLine] = set()
"""Bars that move on a terminal; the end of a command stops them."""

MOVING_EVERY, LINE_EVERY = 0.2, 30.0
"""Minimum time between two outputs on a terminal and in a file [s]."""

BEAT = 1.0
"""Time after which the bar of a terminal moves without a finished part [s]."""
